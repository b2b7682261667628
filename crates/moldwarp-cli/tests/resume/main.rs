//! Runs that are cut off and go on, bit for bit.

#![cfg(unix)] // signals

mod changes;
#[path = "../common/mod.rs"]
mod common;
mod cut_off;
mod full;

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

/// Waits until a file is there with more than so many lines. With a second row in the history there is a
/// checkpoint.
fn wait_for(path: &Path, lines: usize) {
    let begun = Instant::now();
    let count = |text: Vec<u8>| text.iter().filter(|&&b| b == b'\n').count();
    let there = || std::fs::read(path).map_or(0, count);
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
    // Twice, as `timeout` does: to the process and to its group. The second may come too late.
    let kill = || {
        let mut kill = std::process::Command::new("kill");
        kill.args([signal, &child.id().to_string()]).status()
    };
    assert!(kill().unwrap().success());
    let _ = kill();
    child.wait().unwrap().code().unwrap()
}
