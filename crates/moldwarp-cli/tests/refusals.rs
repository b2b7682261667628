//! Exit codes, messages, and what is left alone when something is wrong.

mod common;

use common::{Bench, COLUMN};
use std::process::Stdio;
use std::time::{Duration, Instant};

#[test]
fn wrong_arguments_and_scenes_write_nothing() {
    let bench = Bench::new();
    bench.fails(2, &["walk"]);
    bench.fails(2, &["run"]);
    bench.fails(2, &["run", "column", "--threads", "0"]);
    bench.fails(2, &["run", "nowhere"]);
    bench.fails(2, &["run", "column", "--set", "numerics.courant=\"1 kPa\""]);
    bench.fails(2, &["check", "column", "--set", "numerics.curant=0.1"]);
    bench.fails(2, &["run", "column", "--set", "numerics.time_step=\"1 s\""]);
    assert!(!bench.path("out").exists());
    assert!(!bench.path("nowhere").exists());
}

#[test]
fn a_reference_that_cannot_serve_is_refused_before_the_run() {
    let compare = "\n[[compare]]\ncolumn = \"bottom.displacement.z\"\nfile = \"exact.csv\"\n";
    let bench = Bench::with(&format!("{COLUMN}{compare}"));
    bench.write("column/exact.csv", "0,0\n1,1\n");
    insta::assert_snapshot!(bench.fails(2, &["run", "column"]));
    bench.write("column/exact.csv", "time,value\n0,0\n1,0\n");
    insta::assert_snapshot!(bench.fails(2, &["run", "column"]));
    assert!(!bench.path("out").exists());
}

#[test]
fn a_finished_run_is_replaced_and_says_so() {
    let bench = Bench::new();
    bench.done(&["run", "column"]);
    let again = bench.moldwarp(&["run", "column"]);
    let said = String::from_utf8(again.stderr).unwrap();
    assert!(
        said.contains("note: the earlier run in out/column is replaced"),
        "{said}"
    );
    assert_eq!(again.status.code(), Some(0));
}

#[test]
fn an_interrupted_run_can_be_opened_and_is_not_overwritten() {
    let long = COLUMN
        .replace("frames = 4", "frame_interval = \"1 ms\"")
        .replace("0.2 s", "1 h");
    let bench = Bench::with(&long);
    let mut run = bench
        .command(&["run", "column"])
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let start = Instant::now();
    let third = bench.path("out/column/frames/particles_00003.vtu");
    while !third.exists() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(5));
    }
    run.kill().unwrap();
    run.wait().unwrap();
    assert!(third.exists(), "no frame appears");
    let pvd = bench.read("out/column/particles.pvd");
    assert!(pvd.ends_with("</VTKFile>\n"));
    for line in pvd.lines().filter(|l| l.starts_with("<DataSet")) {
        let file = line
            .split("file=\"")
            .nth(1)
            .unwrap()
            .trim_end_matches("\"/>");
        let frame = bench.path("out/column").join(file);
        moldwarp_io::output::vtu_read::read(&frame).unwrap();
    }

    bench.write("column/scene.toml", COLUMN);
    insta::assert_snapshot!(bench.fails(2, &["run", "column"]));
    assert_eq!(pvd, bench.read("out/column/particles.pvd"));
    bench.done(&["run", "column", "--force"]);
    assert_eq!(bench.summary("out/column")["exit"], "done");
}

#[test]
fn foreign_files_are_left_alone() {
    let bench = Bench::new();
    bench.write("thesis/chapter.tex", "words");
    insta::assert_snapshot!(bench.fails(2, &["run", "column", "--out", "thesis"]));
    assert_eq!(std::fs::read_dir(bench.path("thesis")).unwrap().count(), 1);
    bench.done(&["run", "column", "--out", "thesis", "--force"]);
    assert_eq!(bench.read("thesis/chapter.tex"), "words");

    insta::assert_snapshot!(bench.fails(2, &["run", "column", "--out", "column", "--force"]));
    insta::assert_snapshot!(bench.fails(2, &["run", "column", "--out", "column/scene.toml"]));
    assert_eq!(bench.read("column/scene.toml"), COLUMN);
}

#[test]
fn a_guard_stops_with_what_was_computed() {
    let launched =
        "duration = \"0.2 s\"\ninitial_velocity.layer = [\"0 m/s\", \"0 m/s\", \"9 m/s\"]";
    let bench = Bench::with(&COLUMN.replace("duration = \"0.2 s\"", launched));
    let said = bench.fails(3, &["run", "column"]);
    assert!(said.contains("left the mesh"), "{said}");
    let summary = bench.summary("out/column");
    assert!(summary["exit"].as_str().unwrap().contains("left the mesh"));
    assert!(bench.read("out/column/run.log").contains("left the mesh"));
}

#[test]
fn a_file_that_cannot_be_written_is_another_exit_code() {
    let bench = Bench::new();
    bench.write("out/column/history.csv/in-the-way", "");
    let said = bench.fails(4, &["run", "column", "--force"]);
    assert!(
        said.contains("cannot create out/column/history.csv"),
        "{said}"
    );
}

#[test]
fn an_example_comes_out_of_the_binary() {
    let bench = Bench::new();
    let said = bench.fails(2, &["new", "absorbing-colum", "mine"]);
    assert!(said.contains("absorbing-column"), "{said}");
    assert!(!bench.path("mine").exists());
    bench.done(&["new", "absorbing-column", "mine"]);
    bench.done(&["check", "mine"]);
    bench.fails(2, &["new", "absorbing-column", "mine"]);
}
