//! What a run with contacts records.

mod common;

use common::Bench;
use moldwarp_io::output::csv;

/// A block on a floor, under its weight.
const BLOCK: &str = r#"version = 1
title = "A block on a floor"
gravity = [0, 0, "-9.81 m/s2"]

[mesh]
box = { size = ["0.4 m", "0.4 m", "0.4 m"], cells = [4, 4, 4] }

[materials.rubber]
model = "linear-elastic"
young_modulus = "1 MPa"
poisson_ratio = 0.3
density = "2 t/m3"

[bodies.floor]
region = { min = [0, 0, 0], max = ["0.4 m", "0.4 m", "0.1 m"] }
material = "rubber"

[bodies.block]
region = { min = ["0.1 m", "0.1 m", "0.1 m"], max = ["0.3 m", "0.3 m", "0.3 m"] }
material = "rubber"

[[boundaries]]
surface = ["x-min", "x-max", "y-min", "y-max"]
kind = "roller"

[[boundaries]]
surface = "z-min"
kind = "fixed"

[[contacts]]
name = "sole"
bodies = ["block", "floor"]
friction = 0.3

[[stages]]
name = "rest"
until = "equilibrium"
duration = "20 s"
damping = 0.7
equilibrium = { unbalanced = 1e-4, kinetic = 1e-6 }

[output]
frames = 0
history = 200
"#;

#[test]
fn a_block_presses_with_its_weight_on_the_floor() {
    let weight = 2000.0 * 0.2f64.powi(3) * 9.81;
    for surface in ["free", "aligned"] {
        let bench = Bench::with(BLOCK);
        let surface = format!("contacts.sole.surface={surface}");
        let state = |threads: &str| {
            let args = [
                "run",
                "column",
                "--force",
                "--set",
                &surface,
                "--threads",
                threads,
            ];
            bench.done(&args);
            bench.summary("out/column")["state_hash"].clone()
        };
        assert_eq!(state("1"), state("2"));

        let history = csv::read(&bench.path("out/column/history.csv")).unwrap();
        let at = |name: &str| history.names.iter().position(|n| n == name).unwrap();
        let first = at("contact.sole.normal.x");
        let columns = "normal.x normal.y normal.z tangential.x tangential.y tangential.z sticking \
                       sliding open";
        for (k, column) in columns.split(' ').enumerate() {
            assert_eq!(history.names[first + k], format!("contact.sole.{column}"));
        }
        assert_eq!(history.names[first - 1], "dt");
        assert_eq!(history.names[first + 9], "energy.kinetic");
        let units = &bench.summary("out/column")["units"];
        assert_eq!(units["contact.sole.tangential.y"], "N");
        assert_eq!(units["contact.sole.open"], "");

        let last = |what: &str| {
            let column = history.column(&format!("contact.sole.{what}"));
            *column.unwrap().last().unwrap()
        };
        let pressed = last("normal.z");
        assert!(
            (pressed / weight - 1.0).abs() < 1e-3,
            "{surface}: {pressed} N"
        );
        for along in ["normal.x", "normal.y", "tangential.x", "tangential.y"] {
            assert!(last(along).abs() < 3e-3 * weight, "{surface}: {along}");
        }
        // The block's sole has nine nodes.
        assert_eq!(last("sticking") + last("sliding") + last("open"), 9.0);
    }
}

#[test]
fn check_lists_the_columns_of_contacts() {
    let bench = Bench::with(BLOCK);
    let said = bench.done(&["check", "column"]);
    assert!(said.contains("dt contact.sole.normal.x "), "{said}");
    assert!(
        said.contains(" contact.sole.open energy.kinetic "),
        "{said}"
    );
}
