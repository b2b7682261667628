//! Each case has the message that its snapshot says.

use crate::cases::{self, Case, root};
use std::collections::BTreeSet;
use std::fs;

fn snapshot(case: &Case) -> String {
    let name = case.name.replace('.', "-");
    let bytes = name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-');
    assert!(bytes, "{name}: letters, digits and `-` make a case's name");
    name
}

#[test]
fn each_case_says_what_it_did() {
    let mut wrong = Vec::new();
    for case in cases::all() {
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(root().join(case.kind).join("snapshots"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        settings.bind(|| {
            let (name, said) = (snapshot(case), &case.said);
            // All that changed are told at once.
            let same = std::panic::catch_unwind(|| insta::assert_snapshot!(name, said));
            if same.is_err() {
                wrong.push(format!("{}/{}", case.kind, case.name));
            }
        });
    }
    assert!(wrong.is_empty(), "other messages than before: {wrong:?}");
}

/// A snapshot whose case was renamed or removed would be kept for ever.
#[test]
fn each_snapshot_has_a_case() {
    let known: BTreeSet<String> = (cases::all().iter())
        .map(|c| format!("{}/{}.snap", c.kind, snapshot(c)))
        .collect();
    for kind in ["scenes", "meshes", "meridians"] {
        for entry in fs::read_dir(root().join(kind).join("snapshots")).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            let name = format!("{kind}/{name}");
            assert!(
                known.contains(&name) || name.ends_with(".snap.new"),
                "{name} is of no case: remove it"
            );
        }
    }
}

/// The least that the corpus is to have.
#[test]
fn there_are_many_cases() {
    let of = |kind: &str| cases::all().iter().filter(|c| c.kind == kind).count();
    assert!(of("scenes") >= 60, "{} scenes", of("scenes"));
    assert!(of("meshes") >= 25, "{} meshes", of("meshes"));
}
