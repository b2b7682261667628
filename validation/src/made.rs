//! At which commit results were made: `book/tools/age.py` tells from it which are older than the code.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// The commit that is computed, with a `+` if what decides the results has been changed since; `unknown`
/// without git.
pub fn commit() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let git = |arguments: &[&str]| {
        let mut git = Command::new("git");
        git.current_dir(&root).args(arguments).output().ok()
    };
    let sources = ["crates", "validation/src", "validation/meshes", "examples"];
    let changed = git(&[&["diff", "--quiet", "HEAD", "--"], &sources[..]].concat());
    let head = git(&["rev-parse", "--short=7", "HEAD"]).filter(|o| o.status.success());
    match (head, changed) {
        (Some(head), Some(changed)) => {
            let mark = if changed.status.success() { "" } else { "+" };
            format!("{}{mark}", String::from_utf8_lossy(&head.stdout).trim())
        }
        _ => "unknown".to_owned(),
    }
}

/// Notes in `folder/made.csv` that the results of `case` there are of `commit`. Other cases keep their row.
pub fn note(folder: &Path, case: &str, commit: &str) -> std::io::Result<()> {
    let path = folder.join("made.csv");
    let before = match std::fs::read_to_string(&path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(error),
        read => read.unwrap_or_default(),
    };
    let rows = before.lines().skip(1).filter_map(|l| l.split_once(','));
    let mut rows: BTreeMap<&str, &str> = rows.collect();
    rows.insert(case, commit);
    let rows = rows
        .iter()
        .map(|(case, commit)| format!("{case},{commit}\n"));
    std::fs::write(path, format!("case,commit\n{}", rows.collect::<String>()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_has_one_row_and_the_others_keep_theirs() {
        let folder = std::env::temp_dir().join(format!("moldwarp-made-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for (case, commit) in [
            ("heap", "1111111"),
            ("drop", "2222222+"),
            ("heap", "3333333"),
        ] {
            note(&folder, case, commit).unwrap();
        }
        let made = std::fs::read_to_string(folder.join("made.csv")).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(made, "case,commit\ndrop,2222222+\nheap,3333333\n");
    }
}
