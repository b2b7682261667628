//! What a run leaves behind.

mod common;

use common::{Bench, COLUMN};
use moldwarp_io::output::{csv, vtu_read};

fn state_hash(bench: &Bench, args: &[&str]) -> String {
    let all: Vec<&str> = ["run", "column", "--force"]
        .iter()
        .chain(args)
        .copied()
        .collect();
    bench.done(&all);
    bench.summary("out/column")["state_hash"]
        .as_str()
        .unwrap()
        .to_owned()
}

#[test]
fn history_and_frames_are_read_back() {
    let bench = Bench::new();
    let said = bench.done(&["run", "column"]);
    assert!(said.contains("frames:  out/column/particles.pvd"), "{said}");
    assert!(said.contains("history: out/column/history.csv"), "{said}");
    assert!(said.contains("energy:  residual "), "{said}");

    let summary = bench.summary("out/column");
    let particles = summary["particles"].as_u64().unwrap() as usize;
    assert_eq!(summary["exit"], "done");
    assert_eq!(summary["units"]["bottom.displacement.z"], "m");
    assert!((summary["time"].as_f64().unwrap() - 0.2).abs() < 1e-12);

    let history = csv::read(&bench.path("out/column/history.csv")).unwrap();
    assert_eq!(
        history.names[..5],
        ["time", "stage", "stage_time", "step", "dt"]
    );
    let time = history.column("time").unwrap();
    assert_eq!((time.len(), time[0]), (21, 0.0));
    assert_eq!(time[20], summary["time"].as_f64().unwrap());
    assert!(history.column("stage").unwrap().iter().all(|&s| s == 0.0));
    for (i, &t) in time.iter().enumerate() {
        let (due, dt) = (0.01 * i as f64, summary["max_dt"].as_f64().unwrap());
        assert!(t >= due - 1e-9 && t < due + dt, "row {i} at {t} s");
    }
    assert!(history.column("bottom.displacement.z").unwrap()[20] < 0.0);
    assert!(history.column("energy.kinetic").is_some());

    let pvd = bench.read("out/column/particles.pvd");
    assert_eq!(pvd.matches("<DataSet ").count(), 5);
    let last = vtu_read::read(&bench.path("out/column/frames/particles_00004.vtu")).unwrap();
    assert_eq!(last.time, time[20]);
    assert_eq!(last.points.len(), particles);
    let mut ids = last.field("id").unwrap().values.clone();
    ids.sort_by(f64::total_cmp);
    assert!(ids.iter().enumerate().all(|(i, &id)| id == i as f64));
    assert_eq!(last.field("stress").unwrap().components, 6);
    let pressure = &last.field("mean_pressure").unwrap().values;
    assert!(
        pressure.iter().sum::<f64>() > 0.0,
        "compression is positive"
    );
    let mesh = vtu_read::read(&bench.path("out/column/frames/mesh_00004.vtu")).unwrap();
    assert_eq!(
        mesh.cell_nodes.len(),
        4 * summary["elements"].as_u64().unwrap() as usize
    );
    let mass: f64 = mesh.field("mass").unwrap().values.iter().sum();
    let expected = 0.1 * 0.1 * 0.5 * 18e3 / 9.81;
    assert!((mass - expected).abs() < 1e-9 * expected);
}

#[test]
fn the_state_does_not_depend_on_threads_or_output() {
    let bench = Bench::new();
    let one = state_hash(&bench, &["--threads", "1"]);
    let scene = bench.summary("out/column")["scene_hash"].clone();
    for others in [
        &["--threads", "2"][..],
        &["--threads", "8"],
        &["--set", "output.frames=0", "--set", "output.history=1"],
        &["--set", "output.frames=37"],
    ] {
        assert_eq!(one, state_hash(&bench, others), "{others:?}");
        assert_eq!(scene, bench.summary("out/column")["scene_hash"]);
    }
    let other = state_hash(
        &bench,
        &["--set", "materials.soil.young_modulus=\"101 kPa\""],
    );
    assert_ne!(one, other);
    assert_ne!(scene, bench.summary("out/column")["scene_hash"]);
}

#[test]
fn the_state_does_not_depend_on_threads_on_an_unstructured_mesh() {
    let scene = COLUMN
        .replace(
            "box = { size = [\"0.1 m\", \"0.1 m\", \"0.5 m\"], cells = [1, 1, 5] }",
            "file = \"column.msh\"",
        )
        .replace("volume = \"box\"", "volume = \"soil\"")
        .replace("\"z-min\"", "\"bottom\"")
        .replace("\"z-max\"", "\"top\"")
        .replace("0.2 s", "0.1 s");
    let bench = Bench::with(&scene);
    let mesh = include_str!("../../../examples/absorbing-column/column.msh");
    bench.write("column/column.msh", mesh);
    let one = state_hash(&bench, &["--threads", "1"]);
    assert!(bench.summary("out/column")["elements"].as_u64().unwrap() > 300);
    for threads in ["2", "8"] {
        assert_eq!(
            one,
            state_hash(&bench, &["--threads", threads]),
            "{threads}"
        );
    }
    let lumped = state_hash(&bench, &["--set", "numerics.mass=lumped"]);
    assert_ne!(one, lumped);

    // Elements are named as Gmsh names them.
    let said = bench.done(&["check", "column"]);
    let line = said
        .lines()
        .find(|l| l.contains("shortest altitude"))
        .unwrap();
    assert!(!line.contains("counted from 0"), "{line}");
    let tag = line
        .split("(element ")
        .nth(1)
        .unwrap()
        .split(')')
        .next()
        .unwrap();
    let record = format!("\n{tag} ");
    let elements = mesh.split("$Elements").nth(1).unwrap();
    assert!(elements.contains(&record), "{line}");
    assert!(bench.read("out/column/run.log").contains(line.trim()));
}

#[test]
fn no_frames_means_no_collection() {
    let bench = Bench::new();
    let said = bench.done(&["run", "column", "--set", "output.frames=0"]);
    assert!(!said.contains("particles.pvd"));
    assert!(!bench.path("out/column/particles.pvd").exists());
    assert_eq!(
        std::fs::read_dir(bench.path("out/column/frames"))
            .unwrap()
            .count(),
        0
    );
    assert!(bench.read("out/column/scene.toml").contains("frames = 0"));
}

#[test]
fn a_run_compared_with_itself_differs_by_nothing() {
    let bench = Bench::new();
    bench.done(&["run", "column"]);
    let history = csv::read(&bench.path("out/column/history.csv")).unwrap();
    let bottom = history.column("bottom.displacement.z").unwrap();
    let peak = bottom.iter().fold(0.0, |p: f64, v| p.max(v.abs()));
    let mut expected = "time,value\n".to_owned();
    for (t, v) in history.column("time").unwrap().iter().zip(bottom) {
        expected += &format!("{t:?},{v:?}\n");
    }
    bench.write("column/expected.csv", &expected);
    let compare = "\n[[compare]]\ncolumn = \"bottom.displacement.z\"\nfile = \"expected.csv\"\n";
    bench.write("column/scene.toml", &format!("{COLUMN}{compare}"));
    let said = bench.done(&["run", "column"]);
    assert!(
        said.contains("bottom.displacement.z: at most 0 % of the peak away from expected.csv"),
        "{said}"
    );
    let summary = bench.summary("out/column");
    assert_eq!(summary["compare"][0]["relative_difference"], 0.0);
    assert_eq!(summary["compare"][0]["reference_peak"], peak);
}

#[test]
fn check_says_the_plan_and_writes_nothing() {
    let bench = Bench::new();
    let said = bench.done(&["check", "column", "--threads", "1"]);
    for part in [
        "A small column\n",
        "mesh        30 elements, 24 nodes, mean edge 0.126 m\n",
        "shortest altitude 0.07071 m (element 12, counted from 0), worst edge over altitude 2.449 (",
        "body        `layer` of `soil`: 120 particles, 0.005 m3, 9.174 kg\n",
        " steps to t = 0.2 s\n",
        "with 1 thread (",
        "in 5 frames",
        "history     time stage stage_time step dt bottom.displacement.x ",
    ] {
        assert!(said.contains(part), "{part:?} is not in\n{said}");
    }
    assert!(!bench.path("out").exists());
}

/// The slope out of the binary, cut short: its own weight, then another strength.
#[test]
fn the_slope_is_computed() {
    let bench = Bench::new();
    bench.done(&["new", "slope", "mine"]);
    let scene = bench.read("mine/scene.toml");
    let (before, _) = scene.split_once("[[stages]]").unwrap();
    let short = "[[stages]]\nname = \"a\"\nsteps = 40\n[[stages]]\nname = \"b\"\nsteps = 10\n\
                 material.slope = \"weak\"\nreset = [\"displacement\"]\n";
    bench.write("mine/scene.toml", &format!("{before}{short}"));
    bench.done(&["run", "mine"]);
    let summary = bench.summary("out/mine");
    assert_eq!(summary["steps"].as_u64(), Some(50));
    assert!(summary["energy"]["plastic"].as_f64().unwrap() >= 0.0);
}

/// The face of the tunnel out of the binary, cut short: held by the ground's own pressure nothing comes
/// into the bore, and without it soil begins to. Its fine mesh has to be made first, and the message
/// says how.
#[test]
fn the_tunnel_face_is_computed() {
    let bench = Bench::new();
    bench.done(&["new", "tunnel-face", "mine"]);
    let short = ["--set", "stages.collapse.duration=0.15 s"];
    bench.done(
        &[
            &["run", "mine"][..],
            &short,
            &["--set", "output.frame_interval=1 s"],
        ]
        .concat(),
    );
    let summary = bench.summary("out/mine");
    assert_eq!(summary["particles"].as_u64(), Some(39120));
    let history = csv::read(&bench.path("out/mine/history.csv")).unwrap();
    let stage = history.column("stage").unwrap();
    let volume = history.column("bore.volume").unwrap();
    let inside = |of: f64| stage.iter().zip(volume).filter(move |s| *s.0 == of);
    assert!(inside(0.0).count() > 3 && inside(0.0).all(|(_, &v)| v == 0.0));
    assert!(*volume.last().unwrap() > 0.0, "{volume:?}");
    assert!(summary["energy"]["plastic"].as_f64().unwrap() > 0.0);

    let said = bench.fails(2, &["check", "mine/fine.toml"]);
    assert!(said.contains("gmsh"), "{said}");
}

/// The first 10 ms of the drop anchor out of the binary: it goes on with nearly the velocity of its
/// impact, 9.6 m/s, the mesh goes along with it, no particle is in another body's elements, and the
/// soil holds it back.
#[test]
fn the_drop_anchor_is_computed() {
    let bench = Bench::new();
    bench.done(&["new", "drop-anchor", "mine"]);
    let plan = bench.done(&["check", "mine"]);
    assert!(
        plan.contains("motion") && !plan.contains("warning"),
        "{plan}"
    );
    let short = ["--set", "stages.penetration.duration=10 ms"];
    bench.done(&[&["run", "mine"][..], &short, &["--set", "output.frames=1"]].concat());
    let summary = bench.summary("out/mine");
    assert_eq!(summary["foreign_particles"].as_u64(), Some(0));
    let turned_over = summary["energy_turned_over"].as_f64().unwrap();
    let residual = summary["energy"]["residual"].as_f64().unwrap();
    assert!(residual.abs() < 1e-9 * turned_over);
    let history = csv::read(&bench.path("out/mine/history.csv")).unwrap();
    let last = |name: &str| *history.column(name).unwrap().last().unwrap();
    let (way, velocity) = (last("anchor.penetration"), last("anchor.velocity.z"));
    assert!((way - 0.096).abs() < 0.001, "{way}");
    assert!(velocity < -9.5 && velocity > -9.7, "{velocity}");
    let tip = last("resistance-tip.contact.z");
    assert!(
        (tip - last("contact.anchor.normal.z") - last("contact.anchor.tangential.z")).abs() < 1.0
    );
    assert!(tip > 5e3 && tip < 50e3, "{tip}");

    let said = bench.fails(2, &["check", "mine/fine.toml"]);
    assert!(said.contains("gmsh -2"), "{said}");
}
