//! Runs that are killed, and checkpoints that are damaged or all that a guard has left.

use crate::common::{Bench, COLUMN};
use crate::{RARELY, assert_same, bench, results, resume, start, undisturbed, wait_for};
use std::time::Duration;

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
