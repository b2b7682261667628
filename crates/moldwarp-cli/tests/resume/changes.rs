//! What may be changed of a run that goes on.

use crate::common::Bench;
use crate::{RARELY, bench, interrupt, results, start, undisturbed, wait_for};

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
        assert!(pvd.matches("<DataSet ").count() <= 4, "{pvd}");
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

    // A stage that is over.
    let short = [
        "--set",
        "stages.loading.duration=10 h",
        "--set",
        "stages.swinging.steps=1000000000",
    ];
    let mut child = start(
        &bench,
        &[&["run", "column", "--force"][..], &short].concat(),
    );
    wait_for(&bench.path("out/column/history.csv"), 1);
    child.kill().unwrap();
    child.wait().unwrap();
    let mut child = start(
        &bench,
        &[
            "resume",
            "out/column",
            "--set",
            "stages.loading.duration=20 ms",
            "--set",
            "output.history_interval=1 ms",
        ],
    );
    let stage = bench.path("out/column/stages/00_loading.vtu");
    wait_for(&stage, 1);
    wait_for(&bench.path("out/column/history.csv"), 20);
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
