//! The tables of the page on the scene.

use super::keys::{Key, Table, tables, words};
use super::markdown::{code, table as markdown};
use super::source::enum_named;
use crate::scene::dimensions;
use moldwarp::plan::Quantity;

pub fn table(directive: &[&str]) -> String {
    match directive {
        ["keys", name] => keys(name),
        ["words", path, title] => {
            let rows: Vec<_> = words(path)
                .iter()
                .map(|w| [format!("`\"{}\"`", w.name), w.text()])
                .collect();
            markdown([title, "meaning"], &rows)
        }
        ["units"] => units(),
        ["quantities"] => quantities(),
        other => panic!("the page on the scene has no table {other:?}"),
    }
}

/// Names of the structs that have a table of their own on the page.
pub fn tables_of_the_page() -> Vec<&'static str> {
    let lines = include_str!("scene.md").lines();
    let directives = lines.filter_map(super::directive);
    directives
        .filter_map(|d| match d[..] {
            ["keys", name] => Some(name),
            _ => None,
        })
        .collect()
}

fn keys(name: &str) -> String {
    let tables = tables();
    let mut keys = Vec::new();
    collect(&tables, name, "", &mut keys);
    let kind = |key: &Key| key.kind.clone();
    let name = |key: &Key| format!("`{}`", key.name);
    if keys.iter().all(|k| k.only.is_empty()) {
        let row = |k: &Key| [name(k), kind(k), default(k), k.meaning.clone()];
        let rows: Vec<_> = keys.iter().map(row).collect();
        return markdown(["key", "type", "default", "meaning"], &rows);
    }
    let only = |key: &Key| match &key.only[..] {
        [] => "all".to_owned(),
        some => some.join(", "),
    };
    let row = |k: &Key| [name(k), only(k), kind(k), default(k), k.meaning.clone()];
    let rows: Vec<_> = keys.iter().map(row).collect();
    markdown(["key", "for", "type", "default", "meaning"], &rows)
}

/// The keys of a table with their paths; those of a table in it stand under its key, unless the
/// page shows them elsewhere.
fn collect(tables: &[Table], name: &str, prefix: &str, keys: &mut Vec<Key>) {
    let found = tables.iter().find(|t| t.name == name);
    let table = found.unwrap_or_else(|| panic!("there is no {name} in raw.rs"));
    for key in &table.keys {
        let entry = if key.named { ".<name>" } else { "" };
        let path = format!("{prefix}{}{entry}", key.name);
        if !key.kind.is_empty() {
            keys.push(Key {
                name: path.clone(),
                ..key.clone()
            });
        }
        let elsewhere = |inner: &String| tables_of_the_page().contains(&inner.as_str());
        if let Some(inner) = key.table.as_ref().filter(|inner| !elsewhere(inner)) {
            collect(tables, inner, &format!("{path}."), keys);
        }
    }
}

fn default(key: &Key) -> String {
    match key.default.starts_with('"') {
        true => format!("`{}`", key.default),
        false => key.default.clone(),
    }
}

fn units() -> String {
    let rows: Vec<_> = dimensions()
        .map(|d| {
            [
                d.name.to_owned(),
                d.units.to_owned(),
                code([format!("\"{}\"", d.example)], ""),
            ]
        })
        .collect();
    markdown(
        ["dimension", "units that fit, for example", "written as"],
        &rows,
    )
}

fn quantities() -> String {
    let variants = enum_named("crates/moldwarp/src/plan.rs", "Quantity");
    assert_eq!(variants.len(), Quantity::ALL.len());
    let rows: Vec<_> = Quantity::ALL
        .iter()
        .map(|(name, quantity)| {
            let variant = variants.iter().find(|v| v.name == *name);
            let variant = variant.unwrap_or_else(|| panic!("Quantity has no variant for `{name}`"));
            [
                format!("`\"{name}\"`"),
                quantity.components().join(" "),
                quantity.unit().to_owned(),
                variant.text(),
            ]
        })
        .collect();
    markdown(["quantity", "columns", "unit", "meaning"], &rows)
}

#[test]
fn each_table_of_the_scene_is_on_the_page_once() {
    let tables = tables();
    let mut shown = Vec::new();
    for name in tables_of_the_page() {
        shown.push(name.to_owned());
        below(&tables, name, &mut shown);
    }
    let mut names: Vec<String> = tables.into_iter().map(|t| t.name).collect();
    shown.sort();
    names.sort();
    assert_eq!(
        shown, names,
        "structs of raw.rs in scene.md, left, and all of them, right"
    );
}

/// The tables in this one that the page does not show elsewhere.
fn below(tables: &[Table], name: &str, shown: &mut Vec<String>) {
    for key in tables
        .iter()
        .filter(|t| t.name == name)
        .flat_map(|t| &t.keys)
    {
        let Some(inner) = &key.table else { continue };
        if !tables_of_the_page().contains(&inner.as_str()) {
            shown.push(inner.clone());
            below(tables, inner, shown);
        }
    }
}
