//! Disks that are full.

use crate::common::Bench;
use crate::{assert_same, bench, resume, undisturbed};

/// Rows of every step of a small column: a history that grows beyond anything else that is written.
const ROWS: [&str; 6] = [
    "--set",
    "output.checkpoint_interval=20 ms",
    "--set",
    "output.history_interval=0.1 ms",
    "--set",
    "mesh.box.cells=[1, 1, 5]",
];

/// A shell in the bench's folder in which `$0 $@` is `moldwarp run column` with [`ROWS`].
fn shell(bench: &Bench, wrap: &[&str], script: &str) -> std::process::Output {
    let words = [wrap, &["sh", "-c", script]].concat();
    let mut shell = std::process::Command::new(words[0]);
    shell.args(&words[1..]);
    shell
        .args([env!("CARGO_BIN_EXE_moldwarp"), "run", "column"])
        .args(ROWS);
    shell.current_dir(bench.path("")).env("NO_COLOR", "1");
    shell.output().unwrap()
}

/// Where files cannot grow any more the run ends with code 4 and says what to do; with more room it
/// goes on.
#[test]
fn a_limit_of_files_ends_the_run_with_a_checkpoint_to_go_on_from() {
    let bench = bench();
    undisturbed(&bench, &ROWS);
    let longest = std::fs::metadata(bench.path("whole/history.csv"))
        .unwrap()
        .len();
    // Blocks of 512 bytes in dash, of 1024 in bash: less than the history in either.
    let blocks = longest / 2500;
    let limit = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let output = shell(&bench, &[], &limit);
    let said = String::from_utf8(output.stderr).unwrap();
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(output.status.code(), Some(4), "{said}");
    assert!(
        said.contains("cannot write out/column/history.csv"),
        "{said}"
    );
    let what_to_do = "`moldwarp resume out/column` goes on from step ";
    assert!(said.contains(what_to_do), "{said}");
    resume(&bench);
    assert_same(&bench, "out/column");
    let resumed = bench.summary("out/column")["resumed_at"][0]
        .as_u64()
        .unwrap();
    assert!(resumed > 0, "it did not start over");
}

/// The same on a disk that is really full, where such a small one may be mounted: in a namespace of its
/// own, so that nothing is left of it.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_run_with_a_checkpoint_to_go_on_from() {
    let bench = bench();
    std::fs::create_dir(bench.path("out")).unwrap();
    let apart = ["unshare", "--map-root-user", "--mount"];
    let mount = "mount -t tmpfs -o size=500k none out";
    let may = std::process::Command::new(apart[0])
        .args(&apart[1..])
        .args(["sh", "-c", mount])
        .current_dir(bench.path(""))
        .output();
    if !may.is_ok_and(|m| m.status.success()) {
        eprintln!("not tested: no file system can be mounted here");
        return;
    }
    undisturbed(&bench, &ROWS);
    let script = format!(
        "{mount}; \"$0\" \"$@\"; echo $?; ls out/column/checkpoints; \
         mount -o remount,size=50m out; \"$0\" resume out/column; cp -r out/column kept"
    );
    let output = shell(&bench, &apart, &script);
    let said =
        String::from_utf8(output.stdout).unwrap() + &String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("No space left on device"), "{said}");
    assert!(
        said.starts_with("4\n0.checkpoint\n1.checkpoint\n"),
        "{said}"
    );
    assert_same(&bench, "kept");
    let resumed = bench.summary("kept")["resumed_at"][0].as_u64().unwrap();
    assert!(resumed > 0, "it did not start over");
}
