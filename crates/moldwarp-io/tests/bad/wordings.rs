//! Every message that the reader of scenes can give is given in some case.
//!
//! Faults of a scene are no enumeration: each is worded where it is found, by `Fault::new`. So the
//! places of these calls are the variants. They are looked up in the reader's text, and each error of
//! the corpus tells its own. What a sweep says of its options is no matter of files and is tested in
//! moldwarp-cli.

use crate::cases;
use moldwarp_io::run::RunError;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Wordings that no file of the corpus can bring out: file, a part of the call, and why.
const ELSEWHERE: &[(&str, &str, &str)] = &[
    (
        "earlier.rs",
        "",
        "needs an earlier run: tests/from.rs of moldwarp-cli",
    ),
    (
        "bodies.rs",
        "a body needs a place",
        "`exactly_one` has refused it",
    ),
    (
        "kept.rs",
        "",
        "of a run that is resumed: tests/resume of moldwarp-cli",
    ),
    (
        "loads.rs",
        "a load needs a size",
        "`exactly_one` has refused it",
    ),
    (
        "materials.rs",
        "a material needs a density",
        "`exactly_one` has refused it",
    ),
    (
        "mesh.rs",
        "the scene has no mesh",
        "`exactly_one` has refused it",
    ),
    (
        "probes.rs",
        "a probe needs a place",
        "`exactly_one` has refused it",
    ),
    (
        "stages.rs",
        "a stage needs an end",
        "`exactly_one` has refused it",
    ),
    (
        "bodies.rs",
        "volume `{}` is empty",
        "readers and generators leave empty volumes out",
    ),
    (
        "origin.rs",
        "Fault::new(error.to_string())), (SetupError::Load",
        "contacts.rs has \
     refused rigid bodies that hang together",
    ),
    (
        "overrides.rs",
        "the scene is not valid TOML",
        "`syntax::table` has read it before",
    ),
    (
        "syntax.rs",
        "Fault::new(message), \"here\"",
        "for what serde may come to say in a later version",
    ),
];

/// A call of `Fault::new`.
struct Wording {
    /// Below `src/scene`.
    file: String,
    line: usize,
    /// How the call begins, on one line.
    call: String,
}

fn wordings() -> Vec<Wording> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/scene");
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "rs") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("\n#[cfg(test)]\nmod tests {").next().unwrap();
        for (at, _) in code.match_indices("Fault::new(") {
            let call: Vec<&str> = code[at..].split_whitespace().take(30).collect();
            all.push(Wording {
                file: path.file_name().unwrap().to_string_lossy().into_owned(),
                line: 1 + code[..at].matches('\n').count(),
                call: call.join(" ").chars().take(120).collect(),
            });
        }
    }
    all
}

#[test]
fn each_wording_has_a_case() {
    let errors = cases::all().iter().filter_map(|c| c.error.as_ref());
    let given: BTreeSet<(String, usize)> = errors
        .filter_map(|error| match error {
            RunError::Scene(error) => Some(error.raised()),
            _ => None,
        })
        .map(|place| {
            let file = Path::new(place.file()).file_name().unwrap();
            (file.to_string_lossy().into_owned(), place.line() as usize)
        })
        .collect();
    let all = wordings();
    let covered = |w: &Wording| given.contains(&(w.file.clone(), w.line));
    let excuse = |w: &Wording| {
        let mut excuses = ELSEWHERE.iter();
        excuses.position(|(file, part, _)| w.file == *file && w.call.contains(part))
    };
    let missing: Vec<String> = (all.iter())
        .filter(|w| !covered(w) && excuse(w).is_none())
        .map(|w| format!("src/scene/{}:{}: {}", w.file, w.line, w.call))
        .collect();
    assert!(
        missing.is_empty(),
        "no file of tests/bad/scenes brings out these messages: add one each, or say in ELSEWHERE \
         why there is none\n{}",
        missing.join("\n")
    );
    for (number, (file, part, _)) in ELSEWHERE.iter().enumerate() {
        let needed = (all.iter()).any(|w| excuse(w) == Some(number) && !covered(w));
        assert!(needed, "nothing in {file} needs the excuse of `{part}`");
    }
}
