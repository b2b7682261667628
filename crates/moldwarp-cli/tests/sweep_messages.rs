//! What a user reads when a sweep is refused: exit code 2, and nothing is written.

mod common;

use common::{Bench, COLUMN};

/// The message of a sweep with these arguments.
fn refused(bench: &Bench, title: &str, args: &[&str]) -> String {
    let before = bench.files();
    let said = bench.fails(2, &[&["sweep", "column"], args].concat());
    assert_eq!(bench.files(), before, "{title}: files were written");
    let lines: Vec<&str> = said.trim_end().lines().map(str::trim_end).collect();
    format!("## {title}\n{}\n", lines.join("\n"))
}

#[test]
fn what_is_varied() {
    let bench = Bench::new();
    let vary = |title, entry| refused(&bench, title, &["--vary", entry]);
    let good = "numerics.courant=0.3,0.4";
    let lines = [
        refused(&bench, "no --vary", &[]),
        vary("no values", "numerics.courant="),
        vary("no path", "numerics.courant"),
        vary("wrong path", "numerics courant=0.3"),
        vary("nothing beside a comma", "numerics.courant=0.3,,0.4"),
        vary("bracket not closed", "gravity=[0, 0, -9.81"),
        vary("two equal values", "numerics.courant=0.3,0.4,0.30"),
        vary("a value twice", "materials.soil.young_modulus=1 kPa,1 kPa"),
        refused(
            &bench,
            "the same path twice",
            &["--vary", good, "--vary", "numerics . courant=0.5"],
        ),
        refused(
            &bench,
            "varied and set",
            &["--vary", good, "--set", "numerics.courant=0.5"],
        ),
        refused(&bench, "no jobs", &["--vary", good, "--jobs", "0"]),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn scenes() {
    let bench = Bench::new();
    let vary = |title, entry| refused(&bench, title, &["--vary", entry]);
    let second = COLUMN.replace(
        "volume = \"box\"",
        "region = { min = [0, 0, 0], max = [0.1, 0.1, 0.2] }",
    );
    let second = second.replace(
        "[[loads]]\nsurface = \"z-max\"\nbody = \"layer\"",
        "[bodies.top]\nregion = { min = [0, 0, 0.2], max = [0.1, 0.1, 0.5] }\nmaterial = \"soil\"\n\n\
         [[loads]]\nsurface = \"z-max\"\nbody = \"top\"",
    );
    let two = Bench::with(&second);
    let lines = [
        vary("unknown key", "numerics.curant=0.3,0.4"),
        vary("unknown body", "bodies.lair.material=soil"),
        vary(
            "wrong dimension of one value",
            "materials.soil.young_modulus=100 kPa,100 kN",
        ),
        vary("above the stable step", "numerics.time_step=0.001,0.1"),
        refused(
            &two,
            "wrong elsewhere than where it is varied",
            &["--vary", "bodies.top.region.min=[0, 0, 0.2],[0, 0, 0.1]"],
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
    let said = bench.fails(2, &["sweep", "colum", "--vary", "numerics.courant=0.3"]);
    insta::assert_snapshot!(said);
}
