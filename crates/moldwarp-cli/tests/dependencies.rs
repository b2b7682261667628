//! What the solver, its files and its command depend on: under which licences, from where, and whether a
//! crate is there twice.
//!
//! Looked at is what `cargo metadata` resolves for the default members and this platform, and of that
//! what becomes part of the program or runs when it is built; crates of tests alone are left out. Nothing
//! is downloaded: whoever runs this test has all of it. Where other platforms' crates come from stands in
//! Cargo.lock, which is looked at as a whole.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::io::ErrorKind;
use std::process::Command;

/// Licences that allow anyone to use, change and pass on the program, for any purpose, with a notice at
/// most. A dependency must offer one of them, or several together.
const ALLOWED: [&str; 11] = [
    "MIT",
    "MIT-0",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "ISC",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
    "CC0-1.0",
];

/// Crates that are there in several versions, and why that is borne.
const SEVERAL_VERSIONS: [(&str, &str); 2] = [
    (
        "syn",
        "of derive macros, and so no part of the program; not all of them have moved to version 3",
    ),
    (
        "unicode-width",
        "miette still has 0.1, textwrap and indicatif have 0.2; they tell how wide a text is",
    ),
];

const REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

#[test]
fn licences_are_permissive() {
    let Some(graph) = Graph::of_the_default_members() else {
        return;
    };
    let bad = graph.dependencies().filter_map(|(name, package)| {
        let licence = package["license"].as_str();
        let allowed = licence.is_some_and(|expression| permits(expression, &ALLOWED));
        (!allowed).then(|| format!("{name}: {}", licence.unwrap_or("no licence is named")))
    });
    none(bad, "neither MIT nor as free as that");
}

#[test]
fn all_come_from_the_public_registry() {
    let Some(graph) = Graph::of_the_default_members() else {
        return;
    };
    let bad = graph.dependencies().filter_map(|(name, package)| {
        let source = package["source"].as_str();
        (source != Some(REGISTRY)).then(|| format!("{name}: {}", source.unwrap_or("a folder")))
    });
    none(bad, "not from crates.io");

    let lock = std::fs::read_to_string(format!("{ROOT}/Cargo.lock")).expect("Cargo.lock");
    let sources = lock.lines().filter_map(|l| l.strip_prefix("source = "));
    let other = sources.filter(|s| s.trim_matches('"') != REGISTRY);
    none(
        other.map(str::to_owned),
        "in Cargo.lock, not from crates.io",
    );
}

#[test]
fn no_crate_is_there_twice_without_a_reason() {
    let Some(graph) = Graph::of_the_default_members() else {
        return;
    };
    let mut versions: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (_, package) in graph.dependencies() {
        let [name, version] = ["name", "version"].map(|key| text(&package[key]));
        versions.entry(name).or_default().insert(version);
    }
    let listed = |name: &str| SEVERAL_VERSIONS.iter().any(|s| s.0 == name);
    let several = versions.iter().filter(|v| v.1.len() > 1);
    let bad = several.filter(|v| !listed(v.0));
    none(
        bad.map(|(name, versions)| format!("{name}: {versions:?}")),
        "in several versions; let them agree, or give the reason in SEVERAL_VERSIONS",
    );
    let single = |name: &str| versions.get(name).is_none_or(|v| v.len() == 1);
    let stale = SEVERAL_VERSIONS.iter().filter(|s| single(s.0));
    none(
        stale.map(|s| s.0.to_owned()),
        "in SEVERAL_VERSIONS, but there once at most: take it out",
    );
}

#[test]
fn licence_expressions_are_read_as_spdx_does() {
    let permits = |expression| permits(expression, &["MIT", "ISC", "MIT WITH x"]);
    assert!(permits("MIT"));
    assert!(permits("GPL-3.0-only OR MIT"));
    assert!(permits("GPL-3.0-only/MIT"));
    assert!(!permits("GPL-3.0-only AND MIT"));
    assert!(permits("(GPL-3.0-only OR MIT) AND ISC"));
    assert!(!permits("GPL-3.0-only OR MIT AND BSL-1.0"));
    assert!(permits("MIT WITH x"));
    assert!(!permits("ISC WITH x"));
    assert!(!permits(""));
}

/// Fails with the list of what is `wrong`.
fn none(bad: impl Iterator<Item = String>, wrong: &str) {
    let bad: Vec<String> = bad.collect();
    assert!(bad.is_empty(), "{wrong}:\n  {}", bad.join("\n  "));
}

fn text(value: &Value) -> &str {
    value.as_str().expect("a text in cargo's metadata")
}

fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

/// Packages of the workspace's default members and what they need, by id.
struct Graph {
    packages: BTreeMap<String, Value>,
}

impl Graph {
    /// None, with a word on standard error, where there is no cargo.
    fn of_the_default_members() -> Option<Graph> {
        let metadata = metadata()?;
        let by_id = |list: &Value, key: &str| -> BTreeMap<String, Value> {
            let items = self::list(list).map(|item| (text(&item[key]).to_owned(), item.clone()));
            items.collect()
        };
        let mut packages = by_id(&metadata["packages"], "id");
        let nodes = by_id(&metadata["resolve"]["nodes"], "id");
        let members = list(&metadata["workspace_default_members"]).map(text);
        let mut to_see: Vec<&str> = members.collect();
        assert!(!to_see.is_empty(), "a workspace has members");
        let mut seen = BTreeSet::new();
        while let Some(id) = to_see.pop() {
            if seen.insert(id) {
                let needed = list(&nodes[id]["deps"]).filter(|d| is_needed(d));
                to_see.extend(needed.map(|d| text(&d["pkg"])));
            }
        }
        packages.retain(|id, _| seen.contains(id.as_str()));
        Some(Graph { packages })
    }

    /// Names with versions, and packages, of all but the workspace's own crates.
    fn dependencies(&self) -> impl Iterator<Item = (String, &Value)> {
        let root = std::path::Path::new(ROOT).canonicalize();
        let root = root.expect("the workspace has a folder");
        let own = move |p: &Value| {
            let manifest = std::path::Path::new(text(&p["manifest_path"])).canonicalize();
            p["source"].is_null() && manifest.is_ok_and(|m| m.starts_with(&root))
        };
        let others = self.packages.values().filter(move |p| !own(p));
        others.map(|p| (format!("{} {}", text(&p["name"]), text(&p["version"])), p))
    }
}

/// Whether an edge of the graph is there for more than tests.
fn is_needed(dependency: &Value) -> bool {
    list(&dependency["dep_kinds"]).any(|kind| kind["kind"] != "dev")
}

fn metadata() -> Option<Value> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let platform = platform_of(&cargo)?;
    let output = Command::new(cargo)
        .args(["metadata", "--format-version", "1", "--locked", "--offline"])
        .args(["--filter-platform", &platform])
        .current_dir(ROOT)
        .output()
        .expect("cargo has just been there");
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "cargo metadata: {error}");
    Some(serde_json::from_slice(&output.stdout).expect("cargo writes JSON"))
}

/// The platform that cargo builds for when nothing is said.
fn platform_of(cargo: &std::ffi::OsStr) -> Option<String> {
    match Command::new(cargo).arg("-vV").output() {
        Ok(output) => {
            let text = String::from_utf8_lossy(&output.stdout);
            let host = text.lines().find_map(|l| l.strip_prefix("host: "));
            Some(host.expect("cargo names its host").to_owned())
        }
        Err(e) if e.kind() == ErrorKind::NotFound => {
            eprintln!("skipped: dependencies are known to cargo only, and there is none");
            None
        }
        Err(e) => panic!("cargo: {e}"),
    }
}

/// Whether an SPDX expression can be kept with licences of the list alone. AND binds more closely
/// than OR; `/` is an old way to write OR.
fn permits(expression: &str, allowed: &[&str]) -> bool {
    let spaced = expression.replace('/', " OR ");
    let spaced = spaced.replace('(', " ( ").replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = &words[..];
    any_of(&mut rest, allowed) && rest.is_empty()
}

fn any_of(rest: &mut &[&str], allowed: &[&str]) -> bool {
    let mut permitted = all_of(rest, allowed);
    while take(rest, "OR") {
        permitted |= all_of(rest, allowed);
    }
    permitted
}

fn all_of(rest: &mut &[&str], allowed: &[&str]) -> bool {
    let mut permitted = one(rest, allowed);
    while take(rest, "AND") {
        permitted &= one(rest, allowed);
    }
    permitted
}

fn one(rest: &mut &[&str], allowed: &[&str]) -> bool {
    if take(rest, "(") {
        let permitted = any_of(rest, allowed);
        return take(rest, ")") && permitted;
    }
    let Some((name, after)) = rest.split_first() else {
        return false;
    };
    *rest = after;
    match (take(rest, "WITH"), rest.split_first()) {
        (true, Some((exception, after))) => {
            *rest = after;
            allowed.contains(&format!("{name} WITH {exception}").as_str())
        }
        (true, None) => false,
        (false, _) => allowed.contains(name),
    }
}

/// Takes the next word if it is this one.
fn take(rest: &mut &[&str], word: &str) -> bool {
    let is_next = rest.first() == Some(&word);
    if is_next {
        *rest = &rest[1..];
    }
    is_next
}
