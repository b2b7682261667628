//! A part of a body is computed, the whole body reported.

mod common;

use common::Bench;
use moldwarp_io::output::csv;

/// A sector of a cylinder of soil that comes to rest under its weight and a force of 2 kN.
const SECTOR: &str = r#"version = 1
title = "A sector"
gravity = ["0 m/s2", "0 m/s2", "-9.81 m/s2"]

[mesh]
cylinder = { profile = [["0.5 m", "0 m"], ["0.5 m", "1 m"]], angle = "20 deg", cells = [2, 1, 4], split = "symmetric" }

[symmetry]
kind = "sector"
axis = "z"
angle = "20 deg"

[materials.soil]
model = "mohr-coulomb"
young_modulus = "10 MPa"
poisson_ratio = 0.3
cohesion = "100 kPa"
friction_angle = "30 deg"
density = "1800 kg/m3"

[bodies.column]
volume = "cylinder"
material = "soil"

[[boundaries]]
surface = ["theta-min", "theta-max", "z-min"]
kind = "roller"

[[loads]]
surface = "z-max"
force = [0, 0, "-2 kN"]

[probes.base]
surface = "z-min"
quantities = ["reaction", "displacement"]

[probes.plane]
surface = "theta-min"
quantities = "reaction"

# Reactions are read at rest, without damping.
[[stages]]
name = "rest"
duration = "0.4 s"
damping = 0.5

[[stages]]
name = "stand"
duration = "0.02 s"

[output]
frames = 1
history = 10
"#;

#[test]
fn mass_and_reactions_are_those_of_the_whole_cylinder() {
    let bench = Bench::with(SECTOR);
    bench.done(&["run", "column"]);
    let mass = 1800.0 * std::f64::consts::PI * 0.25;
    let summary = bench.summary("out/column");
    let reported = summary["mass"].as_f64().unwrap();
    assert!((reported / mass - 1.0).abs() < 1e-12, "{reported}");
    let said = bench.done(&["check", "column"]);
    assert!(said.contains("particles, 0.7854 m3, 1414 kg\n"), "{said}");
    let part = "note: the mesh is a sector, 5.4434 % of the whole body";
    assert!(said.contains(part), "{said}");
    assert!(bench.read("out/column/run.log").contains(&part[6..]));

    let history = csv::read(&bench.path("out/column/history.csv")).unwrap();
    let last = |name: &str| *history.column(name).unwrap().last().unwrap();
    let weight = mass * 9.81 + 2e3;
    let reaction = last("base.reaction.z");
    assert!(
        (reaction / weight - 1.0).abs() < 1e-4,
        "{reaction} {weight}"
    );
    for across in ["base.reaction.x", "plane.reaction.x", "plane.reaction.y"] {
        assert!(history.column(across).unwrap().iter().all(|&f| f == 0.0));
    }
}

/// Without the table the same part is computed, and reported as it is.
#[test]
fn the_part_itself_is_the_same_without_the_symmetry() {
    let symmetry = "[symmetry]\nkind = \"sector\"\naxis = \"z\"\nangle = \"20 deg\"\n";
    let force = "force = [0, 0, \"-2 kN\"]";
    let short = SECTOR
        .replace(force, "pressure = \"1 kPa\"")
        .replace("0.4 s", "0.02 s");
    let run = |scene: &str| {
        let bench = Bench::with(scene);
        bench.done(&["run", "column"]);
        let history = csv::read(&bench.path("out/column/history.csv")).unwrap();
        (bench.summary("out/column"), history)
    };
    let (whole, of_whole) = run(&short);
    let (part, of_part) = run(&short.replace(symmetry, ""));
    assert_eq!(whole["state_hash"], part["state_hash"]);
    assert_ne!(whole["scene_hash"], part["scene_hash"]);
    let share = (20f64.to_radians()).sin() / std::f64::consts::TAU;
    let last = |table: &csv::Table, name: &str| *table.column(name).unwrap().last().unwrap();
    for name in ["base.reaction.z", "energy.elastic", "energy.gravity"] {
        let ratio = last(&of_part, name) / last(&of_whole, name);
        assert!((ratio / share - 1.0).abs() < 1e-12, "{name}: {ratio}");
    }
    let turned_over = |summary: &serde_json::Value| summary["energy_turned_over"].as_f64().unwrap();
    assert!((turned_over(&part) / turned_over(&whole) / share - 1.0).abs() < 1e-12);
    let displacement = "base.displacement.x";
    assert_eq!(last(&of_part, displacement), last(&of_whole, displacement));
}

/// The column in two parts with a contact between them: its forces are those on the whole body, numbers
/// of nodes those of the part.
#[test]
fn forces_of_contacts_are_those_of_the_whole_body() {
    let symmetry = "[symmetry]\nkind = \"sector\"\naxis = \"z\"\nangle = \"20 deg\"\n";
    let half = "[symmetry]\nkind = \"half\"\naxis = \"y\"\n";
    let bodies = r#"[bodies.lower]
region = { min = ["0 m", "-1 m", "0 m"], max = ["1 m", "1 m", "0.5 m"] }
material = "soil"

[bodies.upper]
region = { min = ["0 m", "-1 m", "0.5 m"], max = ["1 m", "1 m", "1 m"] }
material = "soil"

[[contacts]]
name = "joint"
bodies = ["upper", "lower"]
friction = 0.3
surface = "aligned"

[[boundaries]]"#;
    let (before, after) = SECTOR.split_once("[bodies.column]").unwrap();
    let (_, after) = after.split_once("[[boundaries]]").unwrap();
    let scene = format!("{before}{bodies}{after}")
        .replace(
            "force = [0, 0, \"-2 kN\"]",
            "body = \"upper\"\npressure = \"1 kPa\"",
        )
        .replace("0.4 s", "0.02 s");
    let run = |scene: &str| {
        let bench = Bench::with(scene);
        bench.done(&["run", "column"]);
        csv::read(&bench.path("out/column/history.csv")).unwrap()
    };
    let last = |table: &csv::Table, what: &str| {
        let column = table.column(&format!("contact.joint.{what}"));
        *column.unwrap().last().unwrap()
    };
    let part = run(&scene.replace(symmetry, ""));
    assert!(last(&part, "normal.z") > 0.0);
    let sector = (20f64.to_radians()).sin() / std::f64::consts::TAU;
    for (kind, share, x) in [(symmetry, sector, 0.0), (half, 0.5, 2.0)] {
        let whole = run(&scene.replace(symmetry, kind));
        let same = |name: &str, factor: f64| {
            let [part, whole] = [&part, &whole].map(|table| last(table, name));
            let difference = (part * factor - whole).abs();
            assert!(difference <= 1e-12 * whole.abs(), "{name}: {part} {whole}");
        };
        for force in ["normal", "tangential"] {
            same(&format!("{force}.x"), x);
            same(&format!("{force}.y"), 0.0);
            same(&format!("{force}.z"), 1.0 / share);
        }
        for number in ["sticking", "sliding", "open"] {
            same(number, 1.0);
        }
    }
}
