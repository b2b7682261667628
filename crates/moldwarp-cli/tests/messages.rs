//! What a user reads when the input is wrong. Each message is that of the real command, which ends
//! with exit code 2 and has written nothing.

mod common;

use common::{Bench, COLUMN};

const BOX: &str = r#"box = { size = ["0.1 m", "0.1 m", "0.5 m"], cells = [1, 1, 5] }"#;

/// The message for the column with `old` replaced by `new`, as `run` says it; `check` agrees.
fn with(title: &str, old: &str, new: &str) -> String {
    let bench = Bench::with(&replaced(old, new));
    let said = refused(&bench, title, &["run", "column"]);
    assert_eq!(said, refused(&bench, title, &["check", "column"]));
    said
}

fn replaced(old: &str, new: &str) -> String {
    assert_eq!(COLUMN.matches(old).count(), 1, "{old:?} must be there once");
    COLUMN.replace(old, new)
}

/// The message of a command that is refused.
fn refused(bench: &Bench, title: &str, args: &[&str]) -> String {
    let before = bench.files();
    let said = bench.fails(2, args);
    assert_eq!(bench.files(), before, "{title}: files were written");
    assert!(!said.contains(bench.path("").to_str().unwrap()), "{said}");
    assert!(!said.contains('\x1b'), "{title}: there are colours");
    let lines: Vec<&str> = said.trim_end().lines().map(str::trim_end).collect();
    format!("## {title}\n{}\n", lines.join("\n"))
}

/// The message for a scene whose mesh is this file.
fn mesh(title: &str, content: &str) -> String {
    let bench = Bench::with(&replaced(BOX, "file = \"column.msh\""));
    bench.write("column/column.msh", content);
    refused(&bench, title, &["run", "column"])
}

/// Two tetrahedra; the second is inverted if its nodes are not `2 3 4 5`.
fn two_tetrahedra(second: &str) -> String {
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
         $Nodes\n5\n1 0 0 0\n2 0.1 0 0\n3 0 0.1 0\n4 0 0 0.1\n5 0.1 0.1 0.1\n$EndNodes\n\
         $Elements\n2\n11 4 2 1 1 1 2 3 4\n12 4 2 1 1 {second}\n$EndElements\n"
    )
}

#[test]
fn materials_and_names() {
    let lines = [
        with("unknown key", "young_modulus", "yuong_modulus"),
        with("misspelt group", "volume = \"box\"", "volume = \"bxo\""),
        with("misspelt surface", "\"y-max\"", "\"y_max\""),
        with("wrong unit", "\"100 kPa\"", "\"100 kN\""),
        with("negative stiffness", "\"100 kPa\"", "\"-100 kPa\""),
        with("ν of 0.5", "poisson_ratio = 0.0", "poisson_ratio = 0.5"),
        with(
            "body without elements",
            "volume = \"box\"",
            "region = { min = [2, 2, 2], max = [3, 3, 3] }",
        ),
        with(
            "two bodies in one volume",
            "[[loads]]",
            "[bodies.fill]\nvolume = \"box\"\nmaterial = \"soil\"\n\n[[loads]]",
        ),
        with(
            "two bodies that overlap",
            "[[loads]]",
            "[bodies.fill]\nregion = { kind = \"sphere\", centre = [0, 0, 0], radius = \"20 cm\" }\n\
             material = \"soil\"\n\n[[loads]]",
        ),
        with(
            "load on a surface its body does not touch",
            "volume = \"box\"",
            "region = { min = [0, 0, 0], max = [0.1, 0.1, 0.3] }",
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn meshes() {
    let whole = include_str!("../../../examples/absorbing-column/column.msh");
    let in_file = replaced(BOX, "file = \"column.msh\"");
    let missing = Bench::with(&in_file);
    let unmeshed = Bench::with(&in_file);
    unmeshed.write("column/column.geo", "// a box");
    let misspelt = Bench::with(&in_file);
    misspelt.write("column/colunm.msh", whole);
    misspelt.write("column/other.msh", whole);
    let run = ["run", "column"];
    let lines = [
        refused(&missing, "missing mesh", &run),
        refused(&unmeshed, "geometry not meshed", &run),
        refused(&misspelt, "misspelt mesh", &run),
        mesh("truncated mesh", &whole[..whole.len() / 2]),
        mesh(
            "mesh without elements",
            whole.split("$Elements").next().unwrap(),
        ),
        mesh("empty mesh", ""),
        mesh("inverted element", &two_tetrahedra("3 2 4 5")),
        mesh("flat element", &two_tetrahedra("2 3 4 2")),
        mesh("misspelt group of a mesh file", whole),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn steps_and_stages() {
    let forced = "[numerics]\ntime_step = \"1 s\"\n\n[output]";
    let bench = Bench::new();
    let set = |title, entry| refused(&bench, title, &["run", "column", "--set", entry]);
    let lines = [
        with("forced time step above the stable one", "[output]", forced),
        set("the same by --set", "numerics.time_step=0.1"),
        set("--set of an unknown path", "numerics.curant=0.1"),
        set("--set of an unknown body", "bodies.lair.material=soil"),
        set("--set without a value", "numerics.courant"),
        set("--set of a wrong unit", "numerics.courant=1 kPa"),
        with("stage without an end", "duration = \"0.2 s\"\n", ""),
        with("frames below zero", "frames = 4", "frames = -1"),
        with("no damper", "alpha = 2.5", "alpha = 0"),
        with(
            "gravity of two",
            "gravity = [\"0 m/s2\", \"0 m/s2\", \"0 m/s2\"]",
            "gravity = [\"0 m/s2\", \"-9.81 m/s2\"]",
        ),
        with(
            "probe on no surface",
            "[probes.bottom]\nsurface = \"z-min\"",
            "[probes.bottom]\nsurface = \"bottom\"",
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn files_and_folders() {
    let bench = Bench::new();
    bench.write("empty.toml", "");
    bench.write("column.msh", "$MeshFormat");
    bench.write("nothing/here", "");
    let compare = "\n[[compare]]\ncolumn = \"bottom.displacement.z\"\nfile = \"exact.csv\"\n";
    let against = Bench::with(&format!("{COLUMN}{compare}"));
    let missing = refused(&against, "missing reference", &["run", "column"]);
    against.write("column/exact.csv", "time,value\n0,0\n1,about 3\n");
    let below_a_file = "column/scene.toml/results";
    let lines = [
        refused(&bench, "no such scene", &["run", "colum"]),
        refused(&bench, "folder without a scene", &["run", "nothing"]),
        refused(&bench, "mesh for a scene", &["run", "column.msh"]),
        refused(&bench, "empty scene", &["run", "empty.toml"]),
        with("no value", "poisson_ratio = 0.0", "poisson_ratio ="),
        with("quote not closed", "\"18 kN/m3\"", "\"18 kN/m3"),
        with(
            "key given twice",
            "poisson_ratio = 0.0",
            "poisson_ratio = 0.0\npoisson_ratio = 0.3",
        ),
        with(
            "table given twice",
            "[bodies.layer]",
            "[materials.soil]\n[bodies.layer]",
        ),
        missing,
        refused(&against, "text in a reference", &["run", "column"]),
        refused(
            &bench,
            "output folder that cannot be written",
            &["run", "column", "--out", below_a_file],
        ),
        refused(&bench, "no threads", &["run", "column", "--threads", "0"]),
        refused(
            &bench,
            "no such instructions",
            &["run", "column", "--simd", "sse"],
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

/// The column at rest under gravity with initial stress, and `old` replaced by `new`.
fn ground(title: &str, old: &str, new: &str) -> String {
    let column = replaced("particles_per_element = 4", "k0 = 0.5")
        .replace("\"0 m/s2\"]", "\"-9.81 m/s2\"]")
        .replace("cells = [1, 1, 5]", "cells = [2, 2, 5]")
        .replace("surface = \"z-max\"", "surface = \"x-min\"")
        .replace(
            "[probes.bottom]",
            "[initial_stress]\nkind = \"k0\"\n\n[probes.bottom]",
        );
    assert_eq!(column.matches(old).count(), 1, "{old:?} must be there once");
    let bench = Bench::with(&column.replace(old, new));
    refused(&bench, title, &["run", "column"])
}

#[test]
fn initial_stress() {
    let sand = "model = \"mohr-coulomb\"\ncohesion = 0\nfriction_angle = \"15 deg\"";
    let slope = "region = { kind = \"half-space\", point = [0, 0, \"0.2 m\"], normal = [1, 0, 5] }";
    let step = "region = { min = [0, 0, 0], max = [\"0.05 m\", \"0.1 m\", \"0.5 m\"] }\n\
                material = \"soil\"\nk0 = 0.5\n[bodies.low]\n\
                region = { min = [\"0.05 m\", 0, 0], max = [\"0.1 m\", \"0.1 m\", \"0.3 m\"] }";
    let lines = [
        ground("K0 without gravity", "\"-9.81 m/s2\"]", "0]"),
        ground("K0 under a slope", "volume = \"box\"", slope),
        ground("K0 beside a step", "volume = \"box\"", step),
        ground("K0 beyond the strength", "model = \"linear-elastic\"", sand),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

/// A stage that does not come to rest within its limit: exit code 5, results are kept.
#[test]
fn no_equilibrium_is_code_5() {
    let until = "until = \"equilibrium\"\nduration = \"0.02 s\"";
    let bench = Bench::with(&replaced("duration = \"0.2 s\"", until));
    let said = bench.fails(5, &["run", "column"]);
    assert!(said.contains("out-of-balance ratio"), "{said}");
    assert!(
        bench
            .read("out/column/summary.json")
            .contains("without equilibrium")
    );
}
