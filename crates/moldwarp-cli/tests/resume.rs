//! Runs that are cut off and go on, bit for bit.

#![cfg(unix)] // signals

mod common;

use common::{Bench, COLUMN};
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A column with two stages and a comparison that writes checkpoints whenever it can.
fn bench() -> Bench {
    let stages = "name = \"loading\"\nduration = \"30 ms\"\n\n[[stages]]\nname = \"swinging\"\n\
                  steps = 5000\nreset = [\"displacement\"]\n\n[[compare]]\n\
                  column = \"bottom.displacement.z\"\nfile = \"expected.csv\"\n";
    let scene = COLUMN
        .replace("cells = [1, 1, 5]", "cells = [2, 2, 10]")
        .replace("name = \"loading\"\nduration = \"0.2 s\"\n", stages)
        .replace(
            "frames = 4\nhistory = 20",
            "frames = 9\nhistory_interval = \"5 ms\"\ncheckpoint_interval = \"1 ms\"",
        );
    let bench = Bench::with(&scene);
    bench.write("column/expected.csv", "time,value\n0,0\n0.5,-0.005\n");
    bench
}

/// A run that nothing disturbs, for comparison.
fn undisturbed(bench: &Bench, args: &[&str]) {
    let run = ["run", "column", "--out", "whole"];
    bench.done(&[&run[..], &RARELY, args].concat());
}

/// For what is not to be waited for.
const RARELY: [&str; 2] = ["--set", "output.checkpoint_interval=1 h"];

/// Goes on to the end.
fn resume(bench: &Bench) {
    bench.done(&[&["resume", "out/column"][..], &RARELY].concat());
}

/// All files of a run's results below its folder, without what tells of times and places.
fn results(bench: &Bench, out: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let root = bench.path(out);
    let own = bench.files().into_iter().filter(|f| f.is_file());
    let names = own.filter_map(|f| Some(f.strip_prefix(&root).ok()?.to_owned()));
    names
        .filter(|n| {
            !["run.log", "summary.json", "scene.toml"]
                .map(Path::new)
                .contains(&&**n)
        })
        .map(|name| {
            let content = std::fs::read(root.join(&name)).unwrap();
            (name, content)
        })
        .collect()
}

fn assert_same(bench: &Bench, out: &str) {
    let (whole, own) = (results(bench, "whole"), results(bench, out));
    let names = |files: &[(PathBuf, Vec<u8>)]| -> Vec<PathBuf> {
        files.iter().map(|f| f.0.clone()).collect()
    };
    assert_eq!(names(&whole), names(&own));
    for (a, b) in whole.iter().zip(&own) {
        assert!(a.1 == b.1, "{}", a.0.display());
    }
    let (whole, own) = (bench.summary("whole"), bench.summary(out));
    let figures = [
        "state_hash",
        "scene_hash",
        "energy",
        "steps",
        "time",
        "min_dt",
        "max_dt",
        "compare",
        "case",
        "title",
        "units",
        "exit",
    ];
    for key in figures {
        assert_eq!(whole[key], own[key], "{key}");
    }
}

fn start(bench: &Bench, args: &[&str]) -> Child {
    let mut command = bench.command(args);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().unwrap()
}

/// Waits until a file is there with at least so many lines.
fn wait_for(path: &Path, lines: usize) {
    let begun = Instant::now();
    let there = || std::fs::read(path).map_or(0, |text| text.split(|&b| b == b'\n').count());
    while there() <= lines {
        assert!(begun.elapsed() < Duration::from_secs(20), "{path:?}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Starts a run that checkpoints now and then, and stops it by a signal on the way.
fn interrupt(bench: &Bench, signal: &str) -> i32 {
    // A run that is over may be there.
    let _ = std::fs::remove_dir_all(bench.path("out/column"));
    let endless = ["--set", "stages.loading.duration=10 h"];
    let mut child = start(bench, &[&["run", "column"][..], &endless].concat());
    wait_for(&bench.path("out/column/history.csv"), 1);
    let said = bench.fails(2, &["resume", "out/column"]);
    assert!(said.contains("the run in out/column is going on"), "{said}");
    let mut kill = std::process::Command::new("kill");
    assert!(
        kill.args([signal, &child.id().to_string()])
            .status()
            .unwrap()
            .success()
    );
    child.wait().unwrap().code().unwrap()
}

/// SplitMix64: the same instants in every run of the test.
struct Random(u64);

impl Random {
    fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % end
    }
}

/// Killed twenty times, during steps, while a checkpoint is written, and while it begins to go on, a run
/// still writes what it would have written undisturbed.
#[test]
fn a_run_that_is_killed_goes_on_as_if_it_had_not_been() {
    let bench = bench();
    undisturbed(&bench, &[]);
    let mut random = Random(8);
    let mut child = start(&bench, &["run", "column"]);
    wait_for(&bench.path("out/column/history.csv"), 2);
    for kill in 0..20 {
        if kill > 0 {
            child = start(&bench, &["resume", "out/column"]);
        }
        std::thread::sleep(Duration::from_micros(random.below(60_000)));
        child.kill().unwrap();
        let code = child.wait().unwrap().code();
        assert_eq!(code, None, "it was over before kill {kill}");
    }
    resume(&bench);
    assert_same(&bench, "out/column");
    let resumed = bench.summary("out/column")["resumed_at"].clone();
    let resumed: Vec<u64> = serde_json::from_value(resumed).unwrap();
    assert!(
        resumed.is_sorted() && *resumed.last().unwrap() > 0,
        "{resumed:?}"
    );
    assert_eq!(bench.summary("whole")["resumed_at"], serde_json::json!([]));
    println!("resumed at {resumed:?}");
}

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

/// A damaged checkpoint is noticed wherever it is damaged, and the one before serves; without any, the
/// message says what to do.
#[test]
fn of_a_damaged_checkpoint_the_one_before_serves() {
    let bench = bench();
    undisturbed(&bench, &[]);
    let mut child = start(&bench, &["run", "column"]);
    wait_for(&bench.path("out/column/checkpoints/1.checkpoint"), 0);
    child.kill().unwrap();
    child.wait().unwrap();
    let files = [0, 1].map(|k| bench.path(&format!("out/column/checkpoints/{k}.checkpoint")));
    let newest = files
        .iter()
        .max_by_key(|f| std::fs::metadata(f).unwrap().modified().unwrap());
    let newest = newest.unwrap().clone();
    let mut bytes = std::fs::read(&newest).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    std::fs::write(&newest, &bytes).unwrap();
    let output = bench.moldwarp(&[&["resume", "out/column"][..], &RARELY].concat());
    let said = String::from_utf8(output.stderr).unwrap();
    let name = newest.file_name().unwrap().to_str().unwrap();
    let warning = format!("{name} cannot be used: it is damaged");
    assert!(said.contains(&warning), "{said}");
    assert_same(&bench, "out/column");
    std::fs::remove_file(bench.path("out/column/summary.json")).unwrap();
    for file in &files {
        std::fs::write(file, b"\x89MWC").unwrap();
    }
    let said = bench.fails(2, &["resume", "out/column"]);
    assert!(said.contains("there is no checkpoint in"), "{said}");
}

/// A guard leaves the last good checkpoint and a frame of the faulty state. To go on from there comes to
/// the same end.
#[test]
fn a_guard_leaves_a_checkpoint_and_a_frame_of_what_was_wrong() {
    let bench = Bench::with(&COLUMN.replace(
        "duration = \"0.2 s\"",
        "duration = \"0.2 s\"\ninitial_velocity.layer = [0, 0, 9]",
    ));
    let said = bench.fails(3, &["run", "column", "--out", "whole"]);
    assert!(said.contains("left the mesh"), "{said}");
    let times = |out: &str| -> Vec<f64> {
        let pvd = bench.read(&format!("{out}/particles.pvd"));
        let times = pvd.split("timestep=\"").skip(1);
        times
            .map(|t| t.split('"').next().unwrap().parse().unwrap())
            .collect()
    };
    let (frames, end) = (
        times("whole"),
        bench.summary("whole")["time"].as_f64().unwrap(),
    );
    assert!(frames.is_sorted_by(|a, b| a < b), "{frames:?}");
    assert!(*frames.last().unwrap() > end, "the step that went wrong");
    assert!(bench.path("whole/checkpoints/0.checkpoint").exists());

    bench.fails(3, &["run", "column"]);
    let again = bench.fails(3, &["resume", "out/column"]);
    let stopped = |said: &str| said.split("stopped after").nth(1).unwrap().to_owned();
    assert_eq!(stopped(&said), stopped(&again));
    let [whole, own] = ["whole", "out/column"].map(|out| {
        let mut all = results(&bench, out);
        all.retain(|f| !f.0.starts_with("checkpoints"));
        all
    });
    assert!(whole == own);
    let hash = |out: &str| bench.summary(out)["state_hash"].clone();
    assert_eq!(hash("whole"), hash("out/column"));
}

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
