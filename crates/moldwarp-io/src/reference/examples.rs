//! The examples of the page on the scene, as scenes that can be read, and the keys they use.

use super::keys::{Key, Table, tables};
use super::source;
use crate::scene::{Scene, SceneError, load};
use tempfile::TempDir;
use toml::Value;

/// A key where a scene uses it.
pub struct Use {
    /// Name of the struct of the table that has it.
    pub table: String,
    pub key: Key,
    /// Keys, and numbers of items, from the scene to it.
    pub path: Vec<String>,
}

/// Every block of TOML on the page as a whole scene, with the top-level keys that it is about. The
/// first block is a scene; the others replace its tables.
pub fn scenes() -> Vec<(toml::Table, Vec<String>)> {
    let blocks = include_str!("scene.md").split("```toml\n").skip(1);
    let blocks = blocks.filter_map(|b| Some(b.split_once("```")?.0));
    let mut scenes: Vec<(toml::Table, Vec<String>)> = Vec::new();
    for block in blocks {
        let block: toml::Table = toml::from_str(block).unwrap_or_else(|e| panic!("{block}: {e}"));
        let about = block.keys().cloned().collect();
        let mut scene = scenes
            .first()
            .map_or_else(toml::Table::new, |s| s.0.clone());
        if block.contains_key("bodies") {
            // The first scene's load would have nothing that bears it.
            scene.remove("loads");
        }
        scene.extend(block);
        scenes.push((scene, about));
    }
    scenes
}

/// A folder with the files that the examples name, where scenes are read.
pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Folder {
        let dir = tempfile::tempdir().unwrap();
        let mesh = source::read("examples/absorbing-column/column.msh")
            .replace("\"soil\"", "\"box\"")
            .replace("\"bottom\"", "\"z-min\"")
            .replace("\"top\"", "\"z-max\"");
        std::fs::write(dir.path().join("model.msh"), mesh).unwrap();
        let anchor = source::read("examples/drop-anchor/anchor.msh");
        std::fs::write(dir.path().join("anchor.msh"), anchor).unwrap();
        std::fs::write(dir.path().join("exact.csv"), "time,value\n0,0\n1,1\n").unwrap();
        Folder(dir)
    }

    pub fn read(&self, scene: &toml::Table) -> Result<Scene, SceneError> {
        let file = self.0.path().join("scene.toml");
        std::fs::write(&file, toml::to_string(scene).unwrap()).unwrap();
        load(&file, &[])
    }

    pub fn out(&self) -> std::path::PathBuf {
        self.0.path().join("out")
    }
}

/// The keys that a scene uses. Panics where one is not in the reference.
pub fn uses(scene: &toml::Table) -> Vec<Use> {
    let mut uses = Vec::new();
    walk(scene, "RawScene", &[], &tables(), &mut uses);
    uses
}

fn walk(table: &toml::Table, name: &str, path: &[String], tables: &[Table], uses: &mut Vec<Use>) {
    let known = tables.iter().find(|t| t.name == name).unwrap();
    for (word, value) in table {
        let path = below(path, word);
        let key = known.keys.iter().find(|k| k.name == *word);
        let key = key.unwrap_or_else(|| panic!("the reference has no key {}", path.join(".")));
        uses.push(Use {
            table: name.to_owned(),
            key: key.clone(),
            path: path.clone(),
        });
        let Some(inner) = &key.table else { continue };
        let mut enter = |value: &Value, path: &[String]| {
            if let Value::Table(table) = value {
                walk(table, inner, path, tables, uses);
            }
        };
        match value {
            Value::Table(entries) if key.named => {
                for (name, entry) in entries {
                    enter(entry, &below(&path, name));
                }
            }
            Value::Array(items) => {
                for (i, item) in items.iter().enumerate() {
                    enter(item, &below(&path, &i.to_string()));
                }
            }
            value => enter(value, &path),
        }
    }
}

fn below(path: &[String], step: &str) -> Vec<String> {
    let steps = path.iter().map(String::as_str).chain([step]);
    steps.map(str::to_owned).collect()
}

/// The scene with the table that holds the last key of the path changed.
pub fn changed(
    scene: &toml::Table,
    path: &[String],
    change: impl FnOnce(&mut toml::Table, &str),
) -> toml::Table {
    let mut scene = Value::Table(scene.clone());
    let (last, parents) = path.split_last().unwrap();
    let mut place = &mut scene;
    for step in parents {
        place = match place {
            Value::Array(items) => &mut items[step.parse::<usize>().unwrap()],
            Value::Table(table) => &mut table[step.as_str()],
            _ => panic!("{} leads nowhere", path.join(".")),
        };
    }
    change(place.as_table_mut().unwrap(), last);
    match scene {
        Value::Table(scene) => scene,
        _ => unreachable!("a scene stays a table"),
    }
}

/// Replaces a value, or the first one in it.
pub fn put_first(value: &mut Value, new: &str) {
    match value {
        Value::Array(items) => put_first(&mut items[0], new),
        Value::Table(table) => put_first(table.iter_mut().next().unwrap().1, new),
        value => *value = Value::String(new.to_owned()),
    }
}
