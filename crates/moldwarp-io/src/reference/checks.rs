//! Whether the page on the scene says what the reader of scenes does: each key of its examples is
//! left out, set to its default, to a wrong unit, to a wrong word, and used where it does not
//! belong.

use super::PAGES;
use super::examples::{Folder, Use, changed, put_first, scenes, uses};
use super::keys::tables;
use super::markdown::code;
use super::source;
use crate::scene::{SceneError, dimensions};
use miette::Diagnostic;
use toml::Value;

/// Calls `check` for every key of the page's examples where it is used.
fn for_each_use(check: impl Fn(&Folder, &toml::Table, &Use)) {
    let folder = Folder::new();
    for (scene, about) in scenes() {
        for used in uses(&scene) {
            if about.contains(&used.path[0]) {
                check(&folder, &scene, &used);
            }
        }
    }
}

#[test]
fn the_examples_of_the_reference_are_read_and_use_every_key() {
    let folder = Folder::new();
    let mut used = Vec::new();
    for (scene, about) in scenes() {
        let read = folder.read(&scene);
        assert!(read.is_ok(), "the example of {about:?}: {:?}", read.err());
        used.extend(uses(&scene).into_iter().map(|u| (u.table, u.key.name)));
    }
    for table in tables() {
        for key in table.keys {
            let key = (table.name.clone(), key.name);
            assert!(used.contains(&key), "{key:?} is in no example of scene.md");
        }
    }
}

#[test]
fn the_keys_of_the_example_scenes_are_in_the_reference() {
    let page = PAGES[0].text();
    let mut count = 0;
    for case in std::fs::read_dir(source::file("examples")).unwrap() {
        for file in std::fs::read_dir(case.unwrap().path()).unwrap() {
            let file = file.unwrap().path();
            if file.extension().is_some_and(|e| e == "toml") {
                let text = std::fs::read_to_string(&file).unwrap();
                for used in uses(&toml::from_str(&text).unwrap()) {
                    let key = &used.key.name;
                    let shown = ["`", ".<name>`"].map(|end| format!("{key}{end}"));
                    let there = shown.iter().any(|shown| page.contains(shown));
                    assert!(there, "{key} of {}", file.display());
                }
                count += 1;
            }
        }
    }
    assert!(count > 0);
}

#[test]
fn dimensions_in_the_reference_are_those_that_are_asked_for() {
    for_each_use(|folder, scene, used| {
        let Some(expected) = dimension(&used.key.kind) else {
            return;
        };
        let table_instead = used.key.table.is_some();
        let wrong = changed(scene, &used.path, |table, key| match table_instead {
            true => table[key] = Value::String("1 kg*rad".to_owned()),
            false => put_first(&mut table[key], "1 kg*rad"),
        });
        let message = folder.read(&wrong).unwrap_err().to_string();
        let path = used.path.join(".");
        assert!(
            message.contains(&format!(" {expected}, found")),
            "{path} is said to be a {expected}, but: {message}"
        );
    });
}

/// The dimension that a type begins with, in the words of messages.
fn dimension(kind: &str) -> Option<&'static str> {
    if kind.starts_with("number") {
        return Some("number without unit");
    }
    let mut names = dimensions().map(|d| d.name);
    names.find(|name| {
        let rest = kind.strip_prefix(name);
        rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric()))
    })
}

#[test]
fn what_is_required_in_the_reference_is_and_defaults_are_right() {
    for_each_use(|folder, scene, used| {
        let path = used.path.join(".");
        let left_out = folder.read(&changed(scene, &used.path, |table, key| {
            table.remove(key);
        }));
        let literal = toml::from_str::<toml::Table>(&format!("x = {}", used.key.default));
        match (used.key.default.as_str(), literal) {
            ("required", _) => assert!(left_out.is_err(), "{path} is not required"),
            ("" | "–", _) => {}
            (default, _) if default.starts_with("required") => {}
            (default, Ok(literal)) => {
                let given = folder.read(&changed(scene, &used.path, |table, key| {
                    table.insert(key.to_owned(), literal["x"].clone());
                }));
                let same = match (&left_out, &given) {
                    (Ok(a), Ok(b)) => {
                        format!("{:?}{:?}", a.plan, a.output)
                            == format!("{:?}{:?}", b.plan, b.output)
                    }
                    // A region of another kind without its kind.
                    (Err(_), Err(_)) => true,
                    _ => false,
                };
                assert!(same, "{default} is not the default of {path}");
            }
            _ => {
                // What other parts of the example name is missed by them, whatever the default.
                let missed = |e: &SceneError| {
                    let message = e.to_string();
                    let what = ["there is no load ", "there is no boundary or load "];
                    what.iter().any(|start| message.starts_with(start))
                };
                let fine = left_out.is_ok() || left_out.as_ref().is_err_and(missed);
                assert!(fine, "{path} is required: {left_out:?}");
            }
        }
    });
}

#[test]
fn the_words_of_the_reference_are_those_there_are() {
    for_each_use(|folder, scene, used| {
        if used.key.words.is_empty() {
            return;
        }
        let wrong = changed(scene, &used.path, |table, key| {
            put_first(&mut table[key], "?")
        });
        let help = help(&folder.read(&wrong).unwrap_err());
        let there_is = help.split_once("what there is: ").map(|h| h.1);
        let path = used.path.join(".");
        assert_eq!(there_is, Some(&*code(&used.key.words, ", ")), "{path}");
    });
}

fn help(error: &SceneError) -> String {
    error.help().map_or_else(String::new, |h| h.to_string())
}

#[test]
fn keys_of_some_kinds_only_are_refused_for_the_others() {
    let tables = tables();
    for_each_use(|folder, scene, used| {
        if used.key.only.is_empty() {
            return;
        }
        let keys = &tables.iter().find(|t| t.name == used.table).unwrap().keys;
        let chooser = keys.iter().find(|k| ["kind", "model"].contains(&&*k.name));
        let chooser = chooser.expect("something has to tell the kinds apart");
        let unknown = used.key.only.iter().find(|o| !chooser.words.contains(o));
        let path = used.path.join(".");
        assert_eq!(unknown, None, "{path}: there is no such kind");
        for word in &chooser.words {
            let other = changed(scene, &used.path, |table, key| {
                let alone =
                    |k: &str| k == key || keys.iter().all(|o| o.name != k || o.only.is_empty());
                table.retain(|k, _| alone(k));
                table.insert(chooser.name.clone(), Value::String(word.clone()));
            });
            let error = folder.read(&other).err();
            let message = error.map_or_else(String::new, |e| e.to_string());
            let refused = message.contains("means nothing for kind");
            assert_eq!(
                refused,
                !used.key.only.contains(word),
                "{path}, {word}: {message}"
            );
        }
    });
}

#[test]
fn the_numbers_of_particles_are_those_there_are() {
    for_each_use(|folder, scene, used| {
        if used.key.name == "particles_per_element" {
            let wrong = changed(scene, &used.path, |table, key| {
                table[key] = Value::Integer(2);
            });
            let message = folder.read(&wrong).unwrap_err().to_string();
            assert!(message.ends_with(&used.key.kind), "{message}");
        }
    });
}
