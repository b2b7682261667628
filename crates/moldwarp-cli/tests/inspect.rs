//! `moldwarp inspect`: runs at their end, on their way and cut off, and what is none.

mod common;

use common::{Bench, COLUMN};
use serde_json::Value;
use std::io::Write;
use std::process::Stdio;
use std::time::{Duration, Instant};

fn json(bench: &Bench, args: &[&str]) -> Value {
    let said = bench.done(&[&["inspect", "--json"], args].concat());
    serde_json::from_str(&said).unwrap()
}

#[test]
fn a_run_that_is_done() {
    let compare = "\n[[compare]]\ncolumn = \"bottom.displacement.z\"\nfile = \"exact.csv\"\n";
    let bench = Bench::with(&format!("{COLUMN}{compare}"));
    bench.write("column/exact.csv", "time,value\n0,0\n0.2,-0.005\n");
    bench.done(&["run", "column"]);
    let said = bench.done(&["inspect", "out/column"]);
    for part in [
        "A small column\nout/column: done, t = 0.2 s after ",
        "\nstages      `loading` 0 to 0.2 s\n",
        "\nframes      5, t = 0 to 0.2 s: out/column/particles.pvd\n",
        "\nhistory     21 rows\n",
        "\nparticles   extremes in the last frame, t = 0.2 s\n",
        "\nenergy      at the end; shares of the ",
        "\ncompare     bottom.displacement.z: at most ",
    ] {
        assert!(said.contains(part), "{part:?} in\n{said}");
    }
    assert!(
        !said.contains('\x1b') && !said.contains("checkpoints"),
        "{said}"
    );

    // The figures are those of the files.
    let run = json(&bench, &["out/column"]);
    let summary = bench.summary("out/column");
    assert_eq!(run["state"], "done");
    // Without the summary, units are known by the columns' names.
    std::fs::rename(
        bench.path("out/column/summary.json"),
        bench.path("summary.json"),
    )
    .unwrap();
    let before_its_end = json(&bench, &["out/column"]);
    std::fs::rename(
        bench.path("summary.json"),
        bench.path("out/column/summary.json"),
    )
    .unwrap();
    assert_eq!(before_its_end["state"], "cut-off");
    for column in before_its_end["columns"].as_array().unwrap() {
        assert_eq!(
            column["unit"],
            summary["units"][column["name"].as_str().unwrap()]
        );
    }
    assert_eq!(run["summary"], summary);
    assert_eq!(run["time"], summary["time"]);
    assert_eq!(run["stages"][0]["ends"], summary["time"]);
    for energy in run["energy"].as_array().unwrap() {
        assert_eq!(energy[1], summary["energy"][energy[0].as_str().unwrap()]);
    }
    let rows = bench.read("out/column/history.csv");
    let (header, rows) = rows.split_once('\n').unwrap();
    let at = header
        .split(',')
        .position(|c| c == "bottom.displacement.z")
        .unwrap();
    let values: Vec<[f64; 2]> = rows
        .lines()
        .map(|row| {
            let cells: Vec<f64> = row.split(',').map(|c| c.parse().unwrap()).collect();
            [cells[0], cells[at]]
        })
        .collect();
    let columns = run["columns"].as_array().unwrap();
    let column = columns
        .iter()
        .find(|c| c["name"] == "bottom.displacement.z")
        .unwrap();
    let least = values
        .iter()
        .copied()
        .reduce(|a, b| if b[1] < a[1] { b } else { a })
        .unwrap();
    assert_eq!(column["unit"], "m");
    assert_eq!(
        [&column["least_at"], &column["least"]].map(|v| v.as_f64().unwrap()),
        least
    );
    assert_eq!(column["last"].as_f64().unwrap(), values.last().unwrap()[1]);

    // The fields' extremes: the load's 1 kPa is in the stress, and some frame has more of it than the last.
    let greatest = |run: &Value, name: &str| {
        let fields = run["fields"].as_array().unwrap();
        let field = fields.iter().find(|f| f["name"] == name).unwrap();
        field["greatest"]["value"].as_f64().unwrap()
    };
    let all = json(&bench, &["out/column", "--frames"]);
    assert_eq!(
        [&run["frames_seen"], &all["frames_seen"]].map(|n| n.as_u64().unwrap()),
        [1, 5]
    );
    let pressure = greatest(&run, "mean_pressure");
    assert!((200.0..1000.0).contains(&pressure), "{pressure}");
    assert!(greatest(&all, "velocity.norm") >= greatest(&run, "velocity.norm"));

    // One frame by itself has the same.
    let fields = json(&bench, &["out/column/frames/particles_00004.vtu"]);
    assert_eq!(fields, run["fields"]);
}

#[test]
fn runs_that_are_stopped_interrupted_and_cut_off() {
    let until = "until = \"equilibrium\"\nduration = \"0.02 s\"";
    let bench = Bench::with(&COLUMN.replace("duration = \"0.2 s\"", until));
    bench.fails(5, &["run", "column"]);
    let said = bench.done(&["inspect", "out/column"]);
    assert!(
        said.contains("out/column: stopped, t = 0.02 s after "),
        "{said}"
    );
    assert!(said.contains("without equilibrium"), "{said}");
    assert!(said.contains("`loading` from 0 s, not completed"), "{said}");
    assert!(said.contains("checkpoints checkpoints/"), "{said}");

    // One that goes on for ever, looked at on its way and when it was interrupted.
    bench.write("long/scene.toml", &COLUMN.replace("\"0.2 s\"", "\"1e5 s\""));
    let mut run = bench
        .command(&["run", "long"])
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait(|| {
        bench.path("out/long/particles.pvd").exists()
            && bench.path("out/long/checkpoints/0.checkpoint").exists()
    });
    let going_on = json(&bench, &["out/long"]);
    assert_eq!(going_on["state"], "at-work");
    assert_eq!(going_on["summary"], Value::Null);
    let pid = run.id().to_string();
    assert!(
        std::process::Command::new("kill")
            .args(["-INT", &pid])
            .status()
            .unwrap()
            .success()
    );
    assert_eq!(run.wait().unwrap().code(), Some(130));
    // Such a run may have warnings, too.
    let log = std::fs::OpenOptions::new()
        .append(true)
        .open(bench.path("out/long/run.log"));
    writeln!(log.unwrap(), "     9.9 s  warning: of something").unwrap();
    let interrupted = json(&bench, &["out/long"]);
    assert_eq!(interrupted["state"], "interrupted");
    let checkpoint = &interrupted["checkpoints"][0];
    assert!(checkpoint["step"].as_u64() > Some(0));
    let said = bench.done(&["inspect", "out/long"]);
    assert!(
        said.contains("; `moldwarp resume out/long` goes on from its last checkpoint"),
        "{said}"
    );
    let path = checkpoint["path"].as_str().unwrap();
    let alone = bench.done(&["inspect", path]);
    assert!(alone.contains("of `long` by moldwarp"), "{alone}");

    // As after a crash: a row that is half written, and a log that says nothing.
    let history = bench.read("out/long/history.csv");
    bench.write("out/long/history.csv", &format!("{history}3.5,0"));
    let log = bench.read("out/long/run.log");
    let kept: Vec<&str> = log.lines().filter(|l| !l.contains("interrupted")).collect();
    bench.write("out/long/run.log", &(kept.join("\n") + "\n"));
    bench.write(path, "no checkpoint");
    let cut = json(&bench, &["out/long"]);
    assert_eq!(cut["state"], "cut-off");
    assert_eq!(cut["rows"], history.lines().count() - 1);
    assert_eq!(cut["checkpoint_problems"].as_array().unwrap().len(), 1);
}

fn wait(ready: impl Fn() -> bool) {
    let start = Instant::now();
    while !ready() {
        assert!(
            start.elapsed() < Duration::from_secs(20),
            "the run does not begin"
        );
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_sweep() {
    let bench = Bench::with(&COLUMN.replace("\"0.2 s\"", "\"0.02 s\""));
    bench.done(&["sweep", "column", "--vary", "numerics.courant=0.3,0.5"]);
    let said = bench.done(&["inspect", "out/column-sweep"]);
    assert!(
        said.contains("a sweep of 2 runs, 2 ended, 2 of them done"),
        "{said}"
    );
    assert!(said.contains("numerics.courant=0.5: done"), "{said}");
    let sweep = json(&bench, &["out/column-sweep"]);
    assert_eq!(sweep["runs"][1]["values"][0]["value"], "0.5");
}

#[test]
fn what_is_no_run() {
    let bench = Bench::with(&COLUMN.replace("\"0.2 s\"", "\"0.02 s\""));
    bench.done(&["run", "column"]);
    bench.write("notes/thesis.tex", "");
    let message = |path: &str| {
        let said = bench.fails(2, &["inspect", path]);
        let lines: Vec<&str> = said.trim_end().lines().map(str::trim_end).collect();
        lines.join("\n")
    };
    let lines = [
        message("out/colum"),
        message("nowhere"),
        message("out"),
        message("column"),
        message("notes"),
        message("out/column/frames"),
        message("out/column/history.csv"),
        message("column/scene.toml"),
    ];
    insta::assert_snapshot!(lines.join("\n"));
    bench.write("out/column/summary.json", "{");
    assert!(message("out/column").contains("summary.json is not readable"));
    bench.write("out/column/frames/particles_00000.vtu", "<VTKFile");
    assert!(message("out/column/frames/particles_00000.vtu").contains("no frame of moldwarp"));
}
