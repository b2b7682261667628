//! `--set PATH=VALUE`: changes to the scene's text before it is read. A sweep's `--vary` makes the
//! same changes, one value at a time; messages name the option that the user wrote.
//!
//! The text itself is edited, so that everything after sees one text, errors point into it and
//! it can be stored as the scene that was run.

use super::document::Node;
use super::error::Fault;
use super::{suggest, syntax};
use std::ops::Range;
use std::str::FromStr;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};
use toml_edit::{DocumentMut, Item, Key, Value};

/// One `--set`, or one value of a `--vary`, applied.
#[derive(Clone, Debug)]
pub(super) struct Override {
    /// As the user wrote it, with the option.
    entry: String,
    path: Vec<String>,
    /// How many keys of the path were there before.
    known: usize,
}

/// Tables of names the user chose: one that is not there is a slip.
const NAMED: [&str; 3] = ["materials", "bodies", "probes"];
/// Lists: nothing is added to them by `--set`.
const LISTS: [&str; 4] = ["boundaries", "loads", "stages", "compare"];

/// The text with all entries applied in their order, those that are varied last.
pub(super) fn apply(
    text: &str,
    sets: &[String],
    varied: &[String],
) -> Result<(String, Vec<Override>), Fault> {
    if sets.is_empty() && varied.is_empty() {
        return Ok((text.to_owned(), Vec::new()));
    }
    syntax::table(text)?;
    let mut document = DocumentMut::from_str(text)
        .map_err(|e| Fault::new(format!("the scene is not valid TOML: {}", e.message())))?;
    let mut done = Vec::new();
    let sets = sets.iter().map(|entry| ("--set", entry));
    let varied = varied.iter().map(|entry| ("--vary", entry));
    for (option, entry) in sets.chain(varied) {
        done.push(set(document.as_item_mut(), option, entry)?);
    }
    Ok((document.to_string(), done))
}

fn set(root: &mut Item, option: &str, entry: &str) -> Result<Override, Fault> {
    let (path, value) = split(entry)?;
    let entry = &format!("{option} {entry}");
    let mut node = Node::Item(root);
    let mut known = path.len();
    for (depth, key) in path[..path.len() - 1].iter().enumerate() {
        if !node.has(key) {
            known = known.min(depth);
            if !may_create(&path, depth, &node) {
                return Err(no_such_path(entry, &path, depth, &node));
            }
            node.create(key, depth == 0);
        }
        node = match node.child(key) {
            Some(child) => child,
            None => return Err(not_settable(entry)),
        };
    }
    let last = &path[path.len() - 1];
    if !node.has(last) {
        known = known.min(path.len() - 1);
        if node.is_list() || (path.len() == 1 && LISTS.contains(&last.as_str())) {
            return Err(no_such_path(entry, &path, path.len() - 1, &node));
        }
    }
    if !node.put(last, value) {
        return Err(not_settable(entry));
    }
    Ok(Override {
        entry: entry.to_owned(),
        path,
        known,
    })
}

/// The path's keys and the value.
pub(super) fn split(entry: &str) -> Result<(Vec<String>, Value), Fault> {
    let how = "write --set PATH=VALUE, for example --set numerics.courant=0.4";
    let (path, text) = entry
        .split_once('=')
        .ok_or_else(|| Fault::new(format!("`--set {entry}` has no `=`")).help(how))?;
    let keys = keys(path).ok_or_else(|| no_path(&format!("--set {entry}"), path, how))?;
    Ok((keys, value(text)))
}

/// The keys of a path; none if it is no path.
pub(crate) fn keys(path: &str) -> Option<Vec<String>> {
    let keys = Key::parse(path.trim()).ok()?;
    Some(keys.iter().map(|k| k.get().to_owned()).collect())
}

/// What a user who wrote something else for a path should know.
pub(crate) fn no_path(entry: &str, path: &str, how: &str) -> Fault {
    Fault::new(format!("`{entry}`: `{path}` is not a path of keys")).help(format!(
        "{how}; keys with other signs than letters, digits, `-` and `_` stand in quotes"
    ))
}

/// TOML if it is, else a text.
pub(crate) fn value(text: &str) -> Value {
    let text = text.trim();
    Value::from_str(text).unwrap_or_else(|_| Value::from(text))
}

/// Optional tables may be left out of a scene, and be set all the same.
fn may_create(path: &[String], depth: usize, node: &Node) -> bool {
    let named = depth == 1 && NAMED.contains(&path[0].as_str());
    let top = depth == 0 && NAMED.iter().chain(&LISTS).any(|&l| l == path[0]);
    node.is_table() && !named && !top
}

fn no_such_path(entry: &str, path: &[String], depth: usize, node: &Node) -> Fault {
    let names = node.names();
    let missing = &path[depth];
    let there = path[..depth].join(".");
    let wrong = path[..=depth].join(".");
    let fault = Fault::new(format!("`{entry}`: the scene has no `{wrong}`"));
    let join = |name: &str| {
        let mut keys = path.to_vec();
        keys[depth] = name.to_owned();
        keys.join(".")
    };
    let near = match missing.parse::<usize>() {
        // One number is as near as another.
        Ok(_) => None,
        Err(_) => suggest::nearest(missing, names.iter().map(String::as_str)),
    };
    match near {
        Some(near) => fault.help(format!("did you mean `{}`?", join(near))),
        None if names.is_empty() => fault.help(format!("`{there}` is empty")),
        None if there.is_empty() => {
            let list = suggest::list(names.iter().map(String::as_str));
            fault.help(format!("the scene has {list}"))
        }
        None => {
            let list = suggest::list(names.iter().map(String::as_str));
            fault.help(format!("`{there}` has {list}"))
        }
    }
}

fn not_settable(entry: &str) -> Fault {
    Fault::new(format!("`{entry}`: there is nothing to set in this place"))
        .help("set one key of a table, or one whole value")
}

/// If the fault lies in something that was set, says so, and for a wrong key which path was
/// probably meant.
pub(super) fn blame(mut fault: Fault, text: &str, overrides: &[Override]) -> Fault {
    let Ok(table) = syntax::table(text) else {
        return fault;
    };
    let overlaps = |a: &Range<usize>, b: &Range<usize>| a.start < b.end && b.start < a.end;
    let labels = &fault.labels;
    let guilty = overrides.iter().rev().find_map(|o| {
        let places = o.places(&table);
        let hit = places
            .iter()
            .find(|p| labels.iter().any(|l| overlaps(&l.0, &p.1)))?;
        Some((o, hit.0))
    });
    let Some((set, depth)) = guilty else {
        return fault;
    };
    fault.message = format!("`{}`: {}", set.entry, fault.message);
    if let (Some(meant), Some(depth)) = (&fault.meant, depth) {
        let mut path = set.path.clone();
        path[depth] = meant.clone();
        fault.help = Some(format!("did you mean `{}`?", path.join(".")));
    }
    fault
}

impl Override {
    /// Places in the text that this made: keys that were not there before, with their number in
    /// the path, and the value.
    fn places(&self, root: &DeTable) -> Vec<(Option<usize>, Range<usize>)> {
        let mut places = Vec::new();
        let mut table = Some(root);
        let mut array = None;
        for (depth, key) in self.path.iter().enumerate() {
            let value = match (table, array) {
                (Some(t), _) => {
                    let Some((name, value)) = t.iter().find(|(k, _)| k.get_ref() == key) else {
                        break;
                    };
                    if depth >= self.known {
                        places.push((Some(depth), name.span()));
                    }
                    value
                }
                (None, Some(items)) => match item(items, key) {
                    Some(value) => value,
                    None => break,
                },
                (None, None) => break,
            };
            table = value.get_ref().as_table();
            array = value.get_ref().as_array();
            if depth + 1 == self.path.len() {
                places.push((None, value.span()));
            }
        }
        places
    }
}

/// A list's item by its number or name.
fn item<'a, 't>(items: &'a DeArray<'t>, key: &str) -> Option<&'a Spanned<DeValue<'t>>> {
    if let Ok(i) = key.parse::<usize>() {
        return items.get(i);
    }
    let name = |v: &DeValue| Some(v.as_table()?.get("name")?.get_ref().as_str()? == key);
    items.iter().find(|v| name(v.get_ref()) == Some(true))
}
