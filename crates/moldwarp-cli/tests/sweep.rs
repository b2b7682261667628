//! Sweeps: what they leave behind, and what they do when a run or a sweep ends early.

mod common;

use common::{Bench, COLUMN};
use moldwarp_io::output::csv::{self, Records};
use std::process::Stdio;
use std::time::{Duration, Instant};

const YOUNG: &str = "materials.soil.young_modulus=80 kPa,\"100 kPa\",120 kPa";
const COURANT: &str = "numerics.courant=0.3,0.4";
/// Half of the usual time suffices: the wave has come to the bottom.
const SHORT: [&str; 2] = ["--set", "stages.loading.duration=0.1 s"];

fn table(bench: &Bench, out: &str) -> Records {
    csv::read_text(&bench.path(out).join("sweep.csv")).unwrap()
}

/// The table without what differs from one time to the next.
fn but_wall_time(table: &Records) -> Vec<Vec<String>> {
    let wall = table.names.iter().position(|n| n == "wall_time").unwrap();
    let mut rows = table.rows.clone();
    for row in &mut rows {
        assert!(row[wall].parse::<f64>().unwrap() > 0.0);
        row.remove(wall);
    }
    rows
}

#[test]
fn every_combination_has_its_row_and_its_folder() {
    let bench = Bench::new();
    let sweep = ["sweep", "column", "--vary", YOUNG, "--vary", COURANT];
    let said = bench.done(&[&sweep[..], &SHORT].concat());
    assert_eq!(said.matches(": done in ").count(), 6, "{said}");
    assert!(
        said.starts_with("1/6  materials.soil.young_modulus=80 kPa, numerics.courant=0.3: done"),
        "{said}"
    );
    assert!(said.ends_with("\ntable: out/column-sweep/sweep.csv\n"));

    let found = table(&bench, "out/column-sweep");
    let column = |name: &str| found.column(name).unwrap();
    assert_eq!(
        found.names[..7].join(" "),
        "run folder materials.soil.young_modulus numerics.courant exit_code reason wall_time"
    );
    assert_eq!(column("run"), ["1", "2", "3", "4", "5", "6"]);
    assert_eq!(
        column("materials.soil.young_modulus"),
        [
            "80 kPa",
            "80 kPa",
            "\"100 kPa\"",
            "\"100 kPa\"",
            "120 kPa",
            "120 kPa"
        ]
    );
    assert_eq!(column("numerics.courant"), ["0.3", "0.4"].repeat(3));
    assert_eq!(column("exit_code"), ["0"; 6]);
    assert_eq!(column("reason"), [""; 6]);

    let folders = column("folder");
    assert_eq!(folders[3], "young_modulus-100-kPa_courant-0.4");
    assert_eq!(
        std::fs::read_dir(bench.path("out/column-sweep"))
            .unwrap()
            .count(),
        7
    );
    for (row, folder) in folders.iter().enumerate() {
        let path = bench.path("out/column-sweep").join(folder);
        let history = csv::read(&path.join("history.csv")).unwrap();
        for (name, values) in history.names.iter().zip(&history.columns) {
            let cell =
                |end: &str| -> f64 { column(&format!("{name}.{end}"))[row].parse().unwrap() };
            let greatest = values.iter().fold(0.0_f64, |g, v| g.max(v.abs()));
            assert_eq!(cell("last"), *values.last().unwrap(), "{name}");
            assert_eq!(cell("max").abs(), greatest, "{name}");
            assert!(values.contains(&cell("max")), "{name}");
        }
    }
    assert!(
        column("bottom.displacement.z.max")[0].starts_with('-'),
        "signs are kept"
    );

    // The fourth run is what `run` computes.
    let alone = [
        "run",
        "column",
        "--set",
        SHORT[1],
        "--set",
        "materials.soil.young_modulus=100 kPa",
        "--set",
        "numerics.courant=0.4",
    ];
    bench.done(&alone);
    let summary = bench.summary(&format!("out/column-sweep/{}", folders[3]));
    assert_eq!(
        summary["state_hash"],
        bench.summary("out/column")["state_hash"]
    );
    assert_eq!(summary["exit"], "done");
}

#[test]
fn results_do_not_depend_on_jobs_and_threads() {
    let bench = Bench::new();
    let sweep = |options: &[&str]| {
        let first = ["sweep", "column", "--vary", YOUNG, "--vary", COURANT];
        bench.moldwarp(&[&first[..], &SHORT, options].concat())
    };
    let tables = [
        &["--jobs", "1"][..],
        &["--jobs", "2", "--threads", "2"],
        &["--jobs", "9", "--threads", "1"],
    ]
    .map(|options| {
        let output = sweep(options);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{said}");
        let found = table(&bench, "out/column-sweep");
        (said, but_wall_time(&found))
    });
    assert!(!tables[0].0.contains("is replaced"), "{}", tables[0].0);
    assert!(
        tables[1]
            .0
            .contains("note: the earlier sweep in out/column-sweep is replaced")
            && tables[1]
                .0
                .contains("6 runs, 2 at a time sharing 2 threads, into out/column-sweep"),
        "{}",
        tables[1].0
    );
    assert_eq!(tables[0].1, tables[1].1);
    assert_eq!(tables[0].1, tables[2].1);
}

#[test]
fn a_run_that_stops_leaves_the_others_alone() {
    let launched =
        "duration = \"0.05 s\"\ninitial_velocity.layer = [\"0 m/s\", \"0 m/s\", \"0 m/s\"]";
    let bench = Bench::with(&COLUMN.replace("duration = \"0.2 s\"", launched));
    let velocity = "stages.loading.initial_velocity.layer=\
                    [\"0 m/s\", 0, 0],[0, 0, \"9 m/s\"],[0, 0, \"0.1 m/s\"]";
    let output = bench.moldwarp(&["sweep", "column", "--vary", velocity]);
    let (shown, said) = (
        String::from_utf8(output.stdout).unwrap(),
        String::from_utf8(output.stderr).unwrap(),
    );
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(
        said.contains("1 of 3 runs did not come to their end"),
        "{said}"
    );
    let second = shown.lines().nth(1).unwrap();
    assert!(
        second.contains(", code 3: ") && second.contains("left the mesh"),
        "{shown}"
    );

    let found = table(&bench, "out/column-sweep");
    assert_eq!(found.column("exit_code").unwrap(), ["0", "3", "0"]);
    let reasons = found.column("reason").unwrap();
    let summary = bench.summary(&format!("out/column-sweep/{}", found.rows[1][1]));
    assert_eq!(summary["exit"], reasons[1]);
    assert_eq!((reasons[0], reasons[2]), ("", ""));
    let time = found.column("time.last").unwrap();
    assert!(time[1].parse::<f64>().unwrap() < time[0].parse().unwrap());

    // It is over all the same, and may be replaced.
    bench.done(&["sweep", "column", "--vary", "numerics.courant=0.4"]);
    let left = std::fs::read_dir(bench.path("out/column-sweep")).unwrap();
    assert_eq!(left.count(), 2, "the table and one run");
}

#[test]
fn a_run_that_cannot_write_is_noted_with_its_code() {
    let bench = Bench::new();
    bench.write("out/column-sweep/courant-0.4/history.csv/in-the-way", "");
    let sweep = ["sweep", "column", "--vary", COURANT, "--force"];
    let said = bench.fails(4, &[&sweep[..], &SHORT].concat());
    assert!(said.contains("1 of 2 runs"), "{said}");
    let found = table(&bench, "out/column-sweep");
    assert_eq!(found.column("exit_code").unwrap(), ["0", "4"]);
    let reason = found.column("reason").unwrap()[1];
    assert!(reason.starts_with("cannot "), "{reason}");
    assert_eq!(found.column("time.last").unwrap()[1], "");
}

#[test]
fn an_interrupted_sweep_keeps_what_is_done_and_ends_its_runs() {
    let bench = Bench::with(&COLUMN.replace("frames = 4", "frame_interval = \"1 ms\""));
    let vary = "stages.loading.duration=0.01 s,1 h";
    let mut sweep = bench
        .command(&["sweep", "column", "--vary", vary])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let frames = bench.path("out/column-sweep/duration-1-h/frames");
    let written = || std::fs::read_dir(&frames).map_or(0, Iterator::count);
    let wait = |done: &dyn Fn() -> bool, what: &str| {
        let start = Instant::now();
        while !done() {
            assert!(start.elapsed() < Duration::from_secs(20), "{what}");
            std::thread::sleep(Duration::from_millis(20));
        }
    };
    wait(&|| written() > 3, "no frame appears");
    sweep.kill().unwrap();
    sweep.wait().unwrap();
    let still = || {
        let before = written();
        std::thread::sleep(Duration::from_millis(500));
        written() == before
    };
    wait(&still, "the run goes on without its sweep");

    let found = table(&bench, "out/column-sweep");
    assert_eq!(found.column("exit_code").unwrap(), ["0", ""]);
    assert_eq!(found.column("folder").unwrap()[1], "duration-1-h");
    assert_eq!(found.column("time.last").unwrap()[1], "");

    let again = [
        "sweep",
        "column",
        "--vary",
        "stages.loading.duration=0.01 s",
    ];
    insta::assert_snapshot!(bench.fails(2, &again));
    bench.done(&[&again[..], &["--force"]].concat());
    assert!(!frames.exists());
}

#[test]
fn foreign_files_and_single_runs_are_left_alone() {
    let bench = Bench::new();
    let sweep = |out| ["sweep", "column", "--vary", COURANT, "--out", out];
    bench.done(&[&["run", "column"][..], &SHORT].concat());
    insta::assert_snapshot!(bench.fails(2, &sweep("out/column")));
    insta::assert_snapshot!(bench.fails(2, &sweep("column")));
    insta::assert_snapshot!(bench.fails(2, &sweep("column/scene.toml")));
    assert_eq!(bench.summary("out/column")["exit"], "done");
    assert_eq!(bench.read("column/scene.toml"), COLUMN);
}
