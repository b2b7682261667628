//! Sectors of cylinders and symmetries: their plans and their messages.

use super::messages::entry;
use super::{SAMPLE, read};
use moldwarp::plan::LoadKind;
use moldwarp::symmetry::SymmetryKind;
use moldwarp::{Symmetry, Vec3};

const BOX: &str = "box = { size = [\"0.1 m\", \"0.1 m\", \"1 m\"], cells = [1, 1, 10] }";

/// A hollow sector of two segments.
const CYLINDER: &str = r#"[mesh.cylinder]
profile = [["50 cm", "0 m"], ["0.5 m", "1 m"], ["0.4 m", "1.5 m"]]
inner = [["0.1 m", "0 m"], ["0.1 m", "1 m"], ["0.2 m", "1.5 m"]]
angle = "20 deg"
cells = [4, 2, [6, 3]]
grading = [2, [0.5, 1]]
split = "symmetric"
"#;

const SYMMETRY: &str = r#"
[symmetry]
kind = "sector"
axis = "z"
angle = "20 deg"
"#;

/// The sample as a sector.
fn sector() -> String {
    let mesh = format!("{CYLINDER}{SYMMETRY}");
    SAMPLE
        .replace(&format!("[mesh]\n{BOX}\n"), &mesh)
        .replace("\"box\"", "\"cylinder\"")
        .replace(
            "[\"x-min\", \"x-max\", \"y-min\", \"y-max\"]",
            "[\"theta-min\", \"theta-max\"]",
        )
}

fn with(old: &str, new: &str) -> String {
    let text = sector();
    assert_eq!(text.matches(old).count(), 1, "{old:?} must be there once");
    text.replace(old, new)
}

fn case(title: &str, old: &str, new: &str) -> String {
    entry(title, &with(old, new), &[])
}

#[test]
fn a_sector_becomes_its_plan() {
    let scene = read(&sector(), &[]).unwrap();
    let mesh = &scene.plan.mesh;
    // Four bricks across, two around, nine up, all in 24.
    assert_eq!(mesh.tets.len(), 4 * 2 * 9 * 24);
    let [low, high] = mesh.bounds();
    assert_eq!((low.y, low.z, high.x, high.z), (0.0, 0.0, 0.5, 1.5));
    let symmetry = scene.plan.symmetry.unwrap();
    let angle = 20f64.to_radians();
    assert_eq!(symmetry.kind, SymmetryKind::Sector { angle });
    assert_eq!(symmetry.axis, 2);
    let share = (0.5 * angle).sin() / std::f64::consts::PI;
    assert!((symmetry.share / share - 1.0).abs() < 1e-13);
    assert!(scene.notes[0].starts_with("the mesh is a sector, 5.5274 % of the whole body"));

    let simple = "split = \"symmetric\"\n";
    let six = read(&with(simple, ""), &[]).unwrap();
    assert_eq!(six.plan.mesh.tets.len(), 4 * 2 * 9 * 6);
    let solid = read(&with("inner = ", "#"), &["mesh.cylinder.cells=[4, 2, 3]"]).unwrap();
    assert_eq!(solid.plan.mesh.tets.len(), 2 * 6 * (14 + 3 * 24));
}

#[test]
fn a_half_and_its_forces_become_their_plan() {
    let half = format!("{BOX}\n[symmetry]\nkind = \"half\"\naxis = \"y\"");
    let text = SAMPLE.replace(BOX, &half).replace(
        "traction = [\"0 kPa\", \"0 kPa\", \"-1 kPa\"]",
        "force = [\"1 kN\", 0, 0]",
    );
    let plan = read(&text, &[]).unwrap().plan;
    let (kind, share) = (SymmetryKind::Half, 0.5);
    assert_eq!(
        plan.symmetry,
        Some(Symmetry {
            kind,
            axis: 1,
            share
        })
    );
    assert_eq!(
        plan.loads[0].kind,
        LoadKind::Force(Vec3::new(1e3, 0.0, 0.0))
    );
}

#[test]
fn cylinders() {
    let lines = [
        case("no angle", "angle = \"20 deg\"\ncells", "cells"),
        case(
            "angle of zero",
            "angle = \"20 deg\"\ncells",
            "angle = 0\ncells",
        ),
        case(
            "whole ring",
            "angle = \"20 deg\"\ncells",
            "angle = \"360 deg\"\ncells",
        ),
        case(
            "wide cells",
            "angle = \"20 deg\"\ncells",
            "angle = \"180 deg\"\ncells",
        ),
        case(
            "descending",
            "[\"0.4 m\", \"1.5 m\"]",
            "[\"0.4 m\", \"0.9 m\"]",
        ),
        case(
            "one point",
            ", [\"0.5 m\", \"1 m\"], [\"0.4 m\", \"1.5 m\"]]",
            "]",
        ),
        case(
            "point without height",
            "[\"0.4 m\", \"1.5 m\"]",
            "[\"0.4 m\"]",
        ),
        case("tip", "[\"0.4 m\", \"1.5 m\"]", "[0, \"1.5 m\"]"),
        case(
            "inside out",
            "[\"0.2 m\", \"1.5 m\"]",
            "[\"0.4 m\", \"1.5 m\"]",
        ),
        case(
            "inner heights",
            "[\"0.2 m\", \"1.5 m\"]",
            "[\"0.2 m\", \"1.4 m\"]",
        ),
        case("inner points", ", [\"0.2 m\", \"1.5 m\"]]", "]"),
        case("closed inside", "[\"0.2 m\", \"1.5 m\"]", "[0, \"1.5 m\"]"),
        case(
            "no cells",
            "cells = [4, 2, [6, 3]]",
            "cells = [4, 0, [6, 3]]",
        ),
        case(
            "no cells up",
            "cells = [4, 2, [6, 3]]",
            "cells = [4, 2, [6, 0]]",
        ),
        case("two directions", "cells = [4, 2, [6, 3]]", "cells = [4, 2]"),
        case(
            "list across",
            "cells = [4, 2, [6, 3]]",
            "cells = [[4], 2, 6]",
        ),
        case(
            "segments",
            "cells = [4, 2, [6, 3]]",
            "cells = [4, 2, [6, 3, 2]]",
        ),
        case(
            "too many",
            "cells = [4, 2, [6, 3]]",
            "cells = [4000, 2, [600, 300]]",
        ),
        case(
            "grading of zero",
            "grading = [2, [0.5, 1]]",
            "grading = [0, 1]",
        ),
        case(
            "negative grading",
            "grading = [2, [0.5, 1]]",
            "grading = [1, [1, -1]]",
        ),
        case(
            "gradings",
            "grading = [2, [0.5, 1]]",
            "grading = [1, [1, 1, 1]]",
        ),
        case("one grading", "grading = [2, [0.5, 1]]", "grading = [1]"),
        case("split", "\"symmetric\"", "\"symetric\""),
        case(
            "two meshes",
            "[mesh.cylinder]",
            &format!("[mesh]\n{BOX}\n[mesh.cylinder]"),
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn symmetries() {
    let kind = "kind = \"sector\"";
    let angle = "axis = \"z\"\nangle = \"20 deg\"";
    let half = |axis: &str| {
        SYMMETRY
            .replace(kind, "kind = \"half\"")
            .replace(angle, axis)
    };
    let traction = "traction = [\"0 kPa\", \"0 kPa\", \"-1 kPa\"]";
    let lines = [
        case("other angle", angle, "axis = \"z\"\nangle = \"30 deg\""),
        case("other axis", angle, "axis = \"x\"\nangle = \"20 deg\""),
        case("angle of zero", angle, "axis = \"z\"\nangle = 0"),
        case("no angle", angle, "axis = \"z\""),
        case("no axis", angle, "angle = \"20 deg\""),
        case("unknown axis", angle, "axis = \"r\"\nangle = \"20 deg\""),
        case("unknown kind", kind, "kind = \"quarter\""),
        case("angle of a half", kind, "kind = \"half\""),
        case("no such plane", SYMMETRY, &half("axis = \"x\"")),
        case(
            "no body of revolution",
            &format!("{CYLINDER}{SYMMETRY}"),
            &format!("[mesh]\n{BOX}\n{}", SYMMETRY.replace("20 deg", "90 deg")),
        ),
        case("force across", traction, "force = [\"1 kN\", 0, 0]"),
        case(
            "gravity across",
            "gravity = [\"0 m/s2\"",
            "gravity = [\"1 m/s2\"",
        ),
        case(
            "gravity across halves",
            &format!("[\"0 m/s2\", \"0 m/s2\", \"0 m/s2\"]\n\n{CYLINDER}{SYMMETRY}"),
            &format!("[0, 1, 0]\n\n{CYLINDER}{}", half("axis = \"y\"")),
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}
