//! `moldwarp report`, `run --report` and `resume --report`.

mod common;

use common::Bench;

#[test]
fn a_report_is_written_where_it_is_wanted() {
    let bench = Bench::new();
    let said = bench.done(&["run", "column", "--report"]);
    assert!(said.contains("report:  out/column/report.html ("), "{said}");
    let page = bench.read("out/column/report.html");
    assert!(page.starts_with("<!doctype html>\n<!-- A report of moldwarp"));
    assert!(page.contains("The run was completed"));

    bench.done(&["report", "out/column"]);
    assert_eq!(bench.read("out/column/report.html"), page, "the same again");
    let said = bench.done(&[
        "report",
        "out/column",
        "--to",
        "mine.html",
        "--particles",
        "40",
        "--frames",
        "2",
    ]);
    assert!(
        said.contains("of 120 particles") || said.contains("particles, evenly"),
        "{said}"
    );
    assert!(said.contains("has 2 of 5 frames"), "{said}");
    assert!(bench.path("mine.html").is_file());

    // Results that are made anew have no report of the old ones.
    bench.done(&["run", "column"]);
    assert!(!bench.path("out/column/report.html").exists());
}

#[test]
fn a_run_that_was_stopped_has_a_report_and_one_that_goes_on_has_it_no_more() {
    let bench = Bench::new();
    // The limit of equilibrium is reached before it.
    let sets = [
        "--set",
        "stages.0.until=\"equilibrium\"",
        "--set",
        "stages.0.duration=\"0.02 s\"",
    ];
    bench.fails(5, &[&["run", "column", "--report"][..], &sets].concat());
    let page = bench.read("out/column/report.html");
    assert!(page.contains("The run was stopped at t = "));
    bench.fails(
        5,
        &[
            "resume",
            "out/column",
            "--set",
            "stages.0.duration=\"0.03 s\"",
        ],
    );
    assert!(!bench.path("out/column/report.html").exists());
    bench.fails(
        5,
        &[
            "resume",
            "out/column",
            "--set",
            "stages.0.duration=\"0.04 s\"",
            "--report",
        ],
    );
    assert!(bench.path("out/column/report.html").exists());
}

#[test]
fn what_is_no_run_is_refused_and_said() {
    let bench = Bench::new();
    let said = |args: &[&str]| {
        let text = bench.fails(2, args);
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert!(said(&["report", "out/column"]).contains("there is no folder out/column"));
    assert!(said(&["report", "column"]).contains("column is not the folder of a run"));
    assert!(said(&["report", "column/scene.toml"]).contains("is not the folder of a run"));
    bench.done(&["sweep", "column", "--vary", "numerics.courant=0.4,0.5"]);
    assert!(said(&["report", "out/column-sweep"]).contains("is the folder of a sweep"));
    bench.done(&["run", "column"]);
    bench.write("notes.txt", "mine");
    assert!(said(&["report", "out/column", "--to", "notes.txt"]).contains("is no report"));
    assert_eq!(bench.read("notes.txt"), "mine");
    assert!(said(&["report", "out/column", "--to", "column"]).contains("column is a folder"));
    assert!(
        said(&["report", "out/column", "--to", "nowhere/report.html"])
            .contains("cannot write nowhere/report.html")
    );
    assert!(said(&["report", "out/column", "--particles", "0"]).contains("--particles"));
    let frame = bench.path("out/column/frames/particles_00002.vtu");
    std::fs::write(&frame, "cut off").unwrap();
    let text = said(&["report", "out/column"]);
    assert!(
        text.contains("particles_00002.vtu is no frame of moldwarp")
            && text.contains("make the run again"),
        "{text}"
    );
    assert!(!bench.path("out/column/report.html").exists());
}
