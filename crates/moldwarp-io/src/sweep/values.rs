//! `--vary PATH=V1,V2,…`: what a sweep varies.

use crate::scene::{Fault, SceneError, keys, no_path, value};
use toml_edit::Value;

/// A path of the scene and the values it is to have, one after the other.
#[derive(Clone, Debug)]
pub struct Variation {
    /// As the user wrote it.
    pub path: String,
    /// As the user wrote them; at least one, no two the same.
    pub values: Vec<String>,
    pub(super) keys: Vec<String>,
}

const HOW: &str =
    "write `--vary PATH=VALUE,VALUE,…`, for example `--vary numerics.courant=0.3,0.4,0.5`";

impl Variation {
    /// Reads all entries `PATH=V1,V2,…`; `sets` are the entries of `--set` beside them.
    ///
    /// # Errors
    ///
    /// What is no path or no list of values; equal values; a path that is varied twice, or varied
    /// and set. Whether the scene has the path is seen when it is read.
    pub fn parse_all(entries: &[String], sets: &[String]) -> Result<Vec<Variation>, SceneError> {
        let mut all: Vec<Variation> = Vec::new();
        for entry in entries {
            let variation = Variation::parse(entry).map_err(Fault::without_file)?;
            if all.iter().any(|v| v.keys == variation.keys) {
                return Err(twice(&variation.path));
            }
            all.push(variation);
        }
        let set = sets.iter().filter_map(|entry| entry.split_once('='));
        for keys in set.filter_map(|(path, _)| keys(path)) {
            if let Some(variation) = all.iter().find(|v| v.keys == keys) {
                return Err(also_set(&variation.path));
            }
        }
        Ok(all)
    }

    fn parse(entry: &str) -> Result<Variation, Fault> {
        let (path, list) = entry
            .split_once('=')
            .ok_or_else(|| Fault::new(format!("`--vary {entry}` has no `=`")).help(HOW))?;
        let keys = keys(path).ok_or_else(|| no_path(&format!("--vary {entry}"), path, HOW))?;
        if list.trim().is_empty() {
            return Err(Fault::new(format!("`--vary {entry}` has no values")).help(HOW));
        }
        let values = items(list).ok_or_else(|| open(entry))?;
        if values.contains(&"") {
            let what = format!("`--vary {entry}`: there is no value beside a comma");
            return Err(Fault::new(what).help("take the comma away; an empty text is `\"\"`"));
        }
        for (i, second) in values.iter().enumerate() {
            if let Some(first) = values[..i].iter().find(|v| meaning(v) == meaning(second)) {
                return Err(equal(entry, first, second));
            }
        }
        Ok(Variation {
            path: path.trim().to_owned(),
            values: values.into_iter().map(str::to_owned).collect(),
            keys,
        })
    }
}

fn twice(path: &str) -> SceneError {
    Fault::new(format!("`{path}` is varied twice"))
        .help("write all its values in one list, as in `--vary PATH=VALUE,VALUE`")
        .without_file()
}

fn also_set(path: &str) -> SceneError {
    Fault::new(format!("`{path}` is varied and set"))
        .help("leave out its `--set`, or its `--vary`")
        .without_file()
}

fn open(entry: &str) -> Fault {
    Fault::new(format!(
        "`--vary {entry}`: a bracket or a quote has no counterpart"
    ))
    .help(
        "brackets and quotes keep commas together, as in \
         `--vary 'gravity=[0, 0, -9.81],[0, 0, -1.62]'`; \
         keep the shell from taking quotes away with another kind of quotes around all",
    )
}

fn equal(entry: &str, first: &str, second: &str) -> Fault {
    let what = match first == second {
        true => format!("`{first}` stands twice"),
        false => format!("`{first}` and `{second}` are equal"),
    };
    Fault::new(format!("`--vary {entry}`: {what}"))
        .help("leave one of them out: their runs would be the same")
}

/// The list cut at its commas, but not within brackets, braces and quotes. None if one of these
/// has no counterpart. A quote within a text that does not begin with one is a letter.
fn items(list: &str) -> Option<Vec<&str>> {
    let mut items = Vec::new();
    let (mut start, mut depth, mut quote, mut escaped) = (0, 0_usize, None, false);
    for (at, c) in list.char_indices() {
        if std::mem::take(&mut escaped) {
            continue;
        }
        match (quote, c) {
            (Some('"'), '\\') => escaped = true,
            (Some(q), _) if c == q => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') if depth > 0 || list[start..at].trim().is_empty() => {
                quote = Some(c);
            }
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth = depth.checked_sub(1)?,
            (None, ',') if depth == 0 => {
                items.push(list[start..at].trim());
                start = at + 1;
            }
            (None, _) => {}
        }
    }
    items.push(list[start..].trim());
    (depth == 0 && quote.is_none()).then_some(items)
}

/// What the scene sees of a value: `1` and `1.0` are one number, `20 deg` and `"20 deg"` one text.
fn meaning(text: &str) -> String {
    match value(text) {
        Value::Integer(i) => format!("{:?}", *i.value() as f64),
        Value::Float(f) => format!("{:?}", f.value()),
        Value::String(s) => format!("\"{}\"", s.value()),
        other => other.to_string().split_whitespace().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_within_brackets_braces_and_quotes_stay() {
        for (list, expected) in [
            ("0.3, 0.4", &["0.3", "0.4"][..]),
            ("20 deg,30 deg", &["20 deg", "30 deg"]),
            ("\"20 deg\",'3,5'", &["\"20 deg\"", "'3,5'"]),
            ("[0,0,-9.81],[0,[1,2]]", &["[0,0,-9.81]", "[0,[1,2]]"]),
            ("{ a = \"}\", b = 1 },2", &["{ a = \"}\", b = 1 }", "2"]),
            ("\"a\\\",b\",c", &["\"a\\\",b\"", "c"]),
            ("don't,won't", &["don't", "won't"]),
            ("1,", &["1", ""]),
        ] {
            assert_eq!(items(list).unwrap(), expected, "{list}");
        }
        for list in ["[0,1", "0]", "\"20 deg", "{ a = 'b }"] {
            assert_eq!(items(list), None, "{list}");
        }
    }

    #[test]
    fn values_are_equal_if_the_scene_sees_the_same() {
        for (a, b) in [("1", "1.0"), ("20 deg", "\"20 deg\""), ("[0,1]", "[0, 1]")] {
            assert_eq!(meaning(a), meaning(b));
        }
        for (a, b) in [("1", "\"1\""), ("5 mPa", "5 MPa"), ("[0,1]", "[1,0]")] {
            assert_ne!(meaning(a), meaning(b));
        }
    }
}
