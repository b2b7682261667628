//! From TOML to the raw scene, and what TOML and serde say when that fails, in our words.

use super::error::Fault;
use super::raw::RawScene;
use super::suggest;
use serde::Deserialize;
use toml::de::{DeTable, DeValue};

const VERSION: &str = "1";

/// How to come by a scene.
pub(super) const BEGIN: &str =
    "`moldwarp new absorbing-column DIR` writes an example to begin with";

/// Reads the scene's shape. The version comes first: the keys of another one would only confuse.
pub(super) fn parse(text: &str) -> Result<RawScene, Fault> {
    let table = table(text)?;
    if table.is_empty() {
        return Err(Fault::new("the scene is empty").help(BEGIN));
    }
    check_version(&table)?;
    let deserializer = toml::Deserializer::parse(text).map_err(|e| not_toml(&e, text))?;
    RawScene::deserialize(deserializer).map_err(|e| explain(&e))
}

/// The text as TOML, with places.
pub(super) fn table(text: &str) -> Result<DeTable<'_>, Fault> {
    match DeTable::parse(text) {
        Ok(table) => Ok(table.into_inner()),
        Err(e) => Err(not_toml(&e, text)),
    }
}

fn not_toml(error: &toml::de::Error, text: &str) -> Fault {
    let said = error.message();
    let deep = said.contains("recursion") || said.contains("recurse");
    let said = if deep { "nested too deeply" } else { said };
    let Some(span) = error.span() else {
        return Fault::new("the scene is not valid TOML").help(said);
    };
    let there = text.get(span.clone()).unwrap_or_default();
    if said == "duplicate key" {
        return Fault::new(format!("`{there}` is given twice"))
            .at(span, "for the second time")
            .help("keep one of the two; what belongs to one table stands under one header");
    }
    let rest = text.get(span.start..).and_then(|rest| rest.lines().next());
    let nothing_follows = rest.is_none_or(|rest| rest.trim().is_empty());
    let label = match text.get(..span.start) {
        Some(before) if nothing_follows && before.trim_end_matches([' ', '\t']).ends_with('=') => {
            "a value is missing"
        }
        Some(before) if rest.is_some_and(|r| r.starts_with(',')) && ends_in_digit(before) => {
            "decimals stand behind a point, as in 0.5"
        }
        _ => said,
    };
    Fault::new("the scene is not valid TOML")
        .at(span, label)
        .help("TOML is `key = value` under `[table]` headers; texts stand in double quotes")
}

fn ends_in_digit(text: &str) -> bool {
    text.ends_with(|c: char| c.is_ascii_digit())
}

fn check_version(table: &DeTable) -> Result<(), Fault> {
    let Some(version) = table.get("version") else {
        return Err(Fault::new("the scene does not say its version")
            .at(0..0, "`version` is missing")
            .help("begin the file with `version = 1`"));
    };
    match version.get_ref() {
        DeValue::Integer(n) if n.as_str() == VERSION => Ok(()),
        _ => Err(
            Fault::new("this version of the scene format cannot be read")
                .at(version.span(), "not a version known here")
                .help("this program reads `version = 1`"),
        ),
    }
}

/// Serde's messages are the only way it tells which key it misses or does not know.
fn explain(error: &toml::de::Error) -> Fault {
    let message = error.message();
    let mut names = message.split('`').skip(1).step_by(2);
    let fault = if message.starts_with("unknown field") {
        let key = names.next().unwrap_or_default();
        return unknown_key(key, &names.collect::<Vec<_>>(), error);
    } else if message.starts_with("missing field") {
        let key = names.next().unwrap_or_default();
        let fault = Fault::new(format!("`{key}` is missing"));
        (fault.help(example(key)), format!("needs `{key}`"))
    } else if let Some((found, expected)) = expectation(message) {
        let (expected, found) = (wanted(expected), given(found));
        let fault = Fault::new(format!("expected {expected}, found {found}"));
        let fault = match expected {
            LIST if found == TABLE => fault.help("the header of an item of a list is [[…]]"),
            NAMES => fault.help("for example:\n[bodies.layer]\nvolume = \"soil\""),
            _ => fault,
        };
        (fault, "of the wrong kind".to_owned())
    } else {
        (Fault::new(message), "here".to_owned())
    };
    match (fault, error.span()) {
        ((fault, label), Some(span)) => fault.at(span, label),
        ((fault, _), None) => fault,
    }
}

fn expectation(message: &str) -> Option<(&str, &str)> {
    message
        .strip_prefix("invalid type: ")?
        .split_once(", expected ")
}

const LIST: &str = "a list";
const TABLE: &str = "a table";
/// As [`Named`](super::amount::Named) says it.
const NAMES: &str = "a table with a name for each entry";

/// What serde expects, in the words of TOML.
fn wanted(expected: &str) -> &str {
    match expected {
        "i64" => "a whole number",
        "a boolean" => "true or false",
        "a string" => "a text in double quotes",
        "a sequence" => LIST,
        other if other.starts_with("struct ") => TABLE,
        other => other,
    }
}

/// What serde found, in the words of TOML.
fn given(found: &str) -> String {
    let value = || found.split_once(' ').map_or("", |words| words.1);
    match found {
        "sequence" => LIST.to_owned(),
        "map" => TABLE.to_owned(),
        _ if found.ends_with(" as i128") || found.ends_with(" as u128") => {
            format!(
                "{}, which is too large",
                value().split(' ').next().unwrap_or("")
            )
        }
        _ if found.starts_with("integer ") => format!("the number {}", value()),
        _ if found.starts_with("floating point ") => {
            format!("the number {}", value().trim_start_matches("point "))
        }
        _ if found.starts_with("string ") => format!("the text {}", value()),
        other => other.to_owned(),
    }
}

fn unknown_key(key: &str, expected: &[&str], error: &toml::de::Error) -> Fault {
    let span = error.span().unwrap_or(0..0);
    let names = expected.iter().copied();
    let mut fault = Fault::new(format!("unknown key `{key}`"))
        .at(span, "no such key here")
        .help(suggest::help(key, "keys that belong here", names.clone()));
    fault.meant = suggest::nearest(key, names).map(str::to_owned);
    fault
}

/// A line that makes a missing key right.
fn example(key: &str) -> String {
    let line = match key {
        "gravity" => "gravity = [\"0 m/s2\", \"0 m/s2\", \"-9.81 m/s2\"]",
        "mesh" => "[mesh]\nfile = \"model.msh\"",
        "materials" => {
            "[materials.soil]\nmodel = \"linear-elastic\"\nyoung_modulus = \"100 kPa\"\n\
             poisson_ratio = 0.3\nunit_weight = \"18 kN/m3\""
        }
        "bodies" => "[bodies.layer]\nvolume = \"soil\"\nmaterial = \"soil\"",
        "model" => "model = \"linear-elastic\"",
        "material" => "material = \"soil\", the name of a [materials.…] table",
        "surface" => "surface = \"bottom\", or a list of surfaces",
        "kind" => "kind = \"roller\" of a boundary, kind = \"ramp\" of a function",
        "quantities" => "quantities = [\"displacement\", \"stress\"]",
        "name" => "name = \"loading\"",
        "size" => "size = [\"1 m\", \"1 m\", \"2 m\"]",
        "cells" => "cells = [4, 4, 8]",
        "profile" => {
            "profile = [[\"0.5 m\", \"0 m\"], [\"0.5 m\", \"1 m\"]], radius and height from the bottom up"
        }
        "angle" => "angle = \"20 deg\"",
        "axis" => "axis = \"z\"",
        "column" => "column = \"bottom.displacement.z\"",
        "file" => "file = \"exact.csv\"",
        "fraction" | "period" => "viscosity = { fraction = 0.05, period = \"0.5 s\" }",
        _ => return format!("add `{key} = …`"),
    };
    format!("for example:\n{line}")
}
