//! What may be changed of a run that goes on.

use crate::common::{Bench, COLUMN};
use crate::{RARELY, assert_same, bench, interrupt, results, resume, start, undisturbed, wait_for};

/// Ctrl-C and SIGTERM write a checkpoint and end with codes of their own; the run goes on from there with
/// other threads, instructions, output and ends of stages, and its state is that of a run which has had
/// these from the beginning. Its input files are needed no more.
#[test]
fn an_interrupted_run_goes_on_with_other_output_and_another_end() {
    let bench = bench();
    let other = [
        "--set",
        "stages.loading.duration=3 s",
        "--set",
        "output.frames=2",
    ];
    undisturbed(&bench, &other);
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        assert_eq!(interrupt(&bench, signal), code);
        assert!(!bench.path("out/column/summary.json").exists());
        assert!(
            bench
                .read("out/column/run.log")
                .contains("interrupted by signal")
        );
        let scene = bench.path("column");
        std::fs::rename(&scene, bench.path("elsewhere")).unwrap();
        let history = [
            "--set",
            "output.history_interval=0.1 s",
            "--set",
            "output.checkpoint_interval=1 h",
        ];
        let with = ["resume", "out/column", "--threads", "1", "--simd", "scalar"];
        bench.done(&[&with[..], &other, &history].concat());
        std::fs::rename(bench.path("elsewhere"), &scene).unwrap();
        let (whole, own) = (bench.summary("whole"), bench.summary("out/column"));
        assert_eq!(whole["state_hash"], own["state_hash"]);
        assert_eq!(own["resumed_at"].as_array().unwrap().len(), 1);
        assert!(
            bench
                .read("out/column/scene.toml")
                .contains("duration = \"3 s\"")
        );
        let pvd = bench.read("out/column/particles.pvd");
        // Two of the way, the end, and perhaps one before it: how long the last stage takes is known only then.
        assert!(pvd.matches("<DataSet ").count() <= 5, "{pvd}");
    }
}

/// What may not change is refused, and so is an end that is over; nothing has changed then.
#[test]
fn only_ends_of_stages_and_output_may_change() {
    let bench = bench();
    assert_eq!(interrupt(&bench, "-INT"), 130);
    let before = results(&bench, "out/column");
    let refused = |set: &str| {
        let said = bench.fails(2, &["resume", "out/column", "--set", set]);
        format!("## {set}\n{said}\n")
    };
    let mut all: Vec<String> = [
        "materials.soil.young_modulus=\"1 MPa\"",
        "numerics.courant=0.4",
        "stages.loading.damping=0.5",
        "output.frame=3",
        "stages.loadin.duration=\"1 s\"",
        "output.frames=-1",
    ]
    .map(refused)
    .into();
    let said = refused("stages.loading.duration=\"0.001 ms\"");
    assert!(
        said.contains("stage `loading` has gone on for longer"),
        "{said}"
    );
    all.push(bench.fails(2, &["resume", "column"]));
    all.push(bench.fails(2, &["run", "column"]));
    insta::assert_snapshot!(all.concat());
    assert!(before == results(&bench, "out/column"));

    // A stage that is over: it ends after seven rows.
    let endless = ["--set", "stages.swinging.steps=1000000000"];
    let force = ["run", "column", "--force"];
    let mut child = start(&bench, &[&force[..], &endless].concat());
    wait_for(&bench.path("out/column/stages/00_loading.vtu"), 1);
    wait_for(&bench.path("out/column/history.csv"), 12);
    child.kill().unwrap();
    child.wait().unwrap();
    let said = bench.fails(
        2,
        &[
            "resume",
            "out/column",
            "--set",
            "stages.loading.duration=\"1 s\"",
        ],
    );
    assert!(said.contains("stage `loading` is over"), "{said}");
}

/// Of an earlier run that a run has begun with nothing is needed any more either.
#[test]
fn a_run_from_an_earlier_one_goes_on_without_it() {
    let bench = bench();
    bench.done(&[&["run", "column", "--out", "first"][..], &RARELY].concat());
    let from = ["--from", "first@loading"];
    undisturbed(&bench, &from);
    let mut child = start(&bench, &[&["run", "column"][..], &from].concat());
    wait_for(&bench.path("out/column/history.csv"), 2);
    child.kill().unwrap();
    child.wait().unwrap();
    std::fs::remove_dir_all(bench.path("first")).unwrap();
    resume(&bench);
    assert_same(&bench, "out/column");
    assert_eq!(bench.summary("out/column")["from"], "first@loading");
}

/// A stage that has reached its limit without equilibrium can be given more time.
#[test]
fn a_stage_that_has_not_come_to_rest_is_given_more_time() {
    let until = "duration = \"50 ms\"\nuntil = \"equilibrium\"\ndamping = 0.5";
    let scene = COLUMN.replace("duration = \"0.2 s\"", until);
    let bench = Bench::with(&scene);
    let said = bench.fails(5, &["run", "column"]);
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    let what_to_do = "`moldwarp resume out/column --set stages.NAME.duration=…`";
    assert!(said.contains(what_to_do), "{said}");
    bench.done(&[
        "resume",
        "out/column",
        "--set",
        "stages.loading.duration=1 h",
    ]);
    let summary = bench.summary("out/column");
    assert_eq!(summary["exit"], "done");
    assert!(summary["time"].as_f64().unwrap() > 0.05);
}

/// A run that is over is left as it is, file by file.
#[test]
fn a_run_that_is_over_is_left_alone() {
    let bench = bench();
    bench.done(&[&["run", "column"][..], &RARELY].concat());
    let all = |bench: &Bench| -> Vec<_> {
        let files = bench.files().into_iter();
        files
            .map(|f| (std::fs::metadata(&f).unwrap().modified().unwrap(), f))
            .collect()
    };
    let before = all(&bench);
    let said = bench.done(&["resume", "out/column"]);
    assert_eq!(said, "the run in out/column is over; nothing to do\n");
    let more = ["resume", "out/column", "--set", "output.frames=3"];
    let said = bench.fails(2, &more);
    assert!(said.contains("the run in out/column is over"), "{said}");
    assert_eq!(before, all(&bench));
}
