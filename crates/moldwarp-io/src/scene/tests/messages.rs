//! What a user reads when a scene is wrong.

use super::{SAMPLE, read, read_in, with};

/// The message for the sample with `old` replaced by `new`, under a title.
fn case(title: &str, old: &str, new: &str) -> String {
    entry(title, &with(old, new), &[])
}

/// The sample's soil as Mohr-Coulomb material with these strength parameters.
fn mohr_coulomb(title: &str, strength: &str) -> String {
    let model = format!("\"mohr-coulomb\"\n{strength}");
    case(title, "\"linear-elastic\"", &model)
}

pub(super) fn entry(title: &str, text: &str, sets: &[&str]) -> String {
    match read(text, sets) {
        Ok(_) => panic!("no error: {title}"),
        Err(failure) => format!("## {title}\n{}\n", failure.rendered()),
    }
}

fn set(entry_: &str) -> String {
    entry(&format!("--set {entry_}"), SAMPLE, &[entry_])
}

#[test]
fn shape() {
    let lines = [
        case("not TOML", "courant = 0.5", "courant = 0.5 s"),
        case("no version", "version = 1\n", ""),
        case("wrong version", "version = 1\n", "version = 2\n"),
        case("unknown key", "poisson_ratio", "poison_ratio"),
        case("unknown table", "[numerics]", "[numeric]"),
        case(
            "key for later",
            "duration = \"2 s\"",
            "until = \"equilibrium\"",
        ),
        case(
            "number and spacing of particles",
            "particles_per_element = 4",
            "particles_per_element = 4\nparticle_spacing = \"5 cm\"",
        ),
        case(
            "spacing without unit",
            "particles_per_element = 4",
            "particle_spacing = \"5\"",
        ),
        case(
            "spacing that goes back",
            "particles_per_element = 4",
            "particle_spacing = { start = [0, 0, 0], end = [0, 0, 1], points = [[1, 0.1], [1, 0.2]] }",
        ),
        case(
            "volume listed twice",
            "volume = \"box\"",
            "volume = [\"box\", \"box\"]",
        ),
        case(
            "no driver",
            "[numerics]",
            "[mesh_motion]\nmoving = \"box\"\n[numerics]",
        ),
        case(
            "misspelt driver",
            "[numerics]",
            "[mesh_motion]\ndriver = \"leyer\"\nmoving = \"box\"\n[numerics]",
        ),
        case(
            "misspelt zone",
            "[numerics]",
            "[mesh_motion]\ndriver = \"layer\"\nmoving = \"bx\"\n[numerics]",
        ),
        case(
            "moving and blended",
            "[numerics]",
            "[mesh_motion]\ndriver = \"layer\"\nmoving = \"box\"\nblend = \"box\"\n[numerics]",
        ),
        case(
            "motion without direction",
            "[numerics]",
            "[mesh_motion]\ndriver = \"layer\"\nmoving = \"box\"\n[numerics]",
        ),
        case(
            "penetration without gravity",
            "quantities = [\"displacement\"",
            "quantities = [\"penetration\", \"displacement\"",
        ),
        case(
            "gravity missing",
            "gravity = [\"0 m/s2\", \"0 m/s2\", \"0 m/s2\"]\n",
            "",
        ),
        case(
            "wrong kind of value",
            "smoothing = true",
            "smoothing = \"yes\"",
        ),
        case("number wanted", "courant = 0.5", "courant = true"),
        case(
            "missing stages",
            "[[stages]]\nname = \"loading\"\nduration = \"2 s\"\n",
            "",
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn quantities() {
    let lines = [
        case("wrong dimension", "\"100 kPa\"", "\"100 m\""),
        case("unknown unit", "\"100 kPa\"", "\"100 kpa\""),
        case("no unit", "\"2 s\"", "\"2\""),
        case(
            "unit where none belongs",
            "poisson_ratio = 0.0",
            "poisson_ratio = \"0.3 m\"",
        ),
        case("not finite", "\"2 s\"", "inf"),
        case("two entries", "gravity = [\"0 m/s2\", ", "gravity = ["),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn materials_and_bodies() {
    let lines = [
        case("negative stiffness", "\"100 kPa\"", "\"-100 kPa\""),
        case(
            "incompressible",
            "poisson_ratio = 0.0",
            "poisson_ratio = 0.5",
        ),
        case("no stiffness", "young_modulus = \"100 kPa\"\n", ""),
        case(
            "two densities",
            "unit_weight",
            "density = 1800\nunit_weight",
        ),
        case("no density", "unit_weight = \"18 kN/m3\"\n", ""),
        case("zero weight", "\"18 kN/m3\"", "0"),
        case("strength missing", "\"linear-elastic\"", "\"mohr-coulomb\""),
        mohr_coulomb(
            "friction of 90 degrees",
            "cohesion = 0\nfriction_angle = \"90 deg\"",
        ),
        mohr_coulomb(
            "more dilation than friction",
            "cohesion = 0\nfriction_angle = \"30 deg\"\ndilation_angle = \"31 deg\"",
        ),
        mohr_coulomb(
            "cut-off above the apex",
            "cohesion = \"1 kPa\"\nfriction_angle = \"45 deg\"\ntension_cutoff = \"1.1 kPa\"",
        ),
        mohr_coulomb(
            "Tresca without cut-off",
            "cohesion = \"10 kPa\"\nfriction_angle = 0",
        ),
        mohr_coulomb(
            "negative cohesion",
            "cohesion = \"-1 kPa\"\nfriction_angle = \"30 deg\"",
        ),
        mohr_coulomb(
            "no strength",
            "cohesion = 0\nfriction_angle = 0\ntension_cutoff = 0",
        ),
        case(
            "strength of an elastic material",
            "unit_weight",
            "cohesion = \"1 kPa\"\nunit_weight",
        ),
        case("misspelt model", "\"linear-elastic\"", "\"linear-elastc\""),
        case("misspelt volume", "volume = \"box\"", "volume = \"bax\""),
        case(
            "misspelt material",
            "material = \"soil\"",
            "material = \"sol\"",
        ),
        case(
            "body without elements",
            "volume = \"box\"",
            "region = { min = [2, 2, 2], max = [3, 3, 3] }",
        ),
        case(
            "region without kind",
            "volume = \"box\"",
            "region = { centre = [0, 0, 0], radius = 1 }",
        ),
        case(
            "two places",
            "volume = \"box\"",
            "volume = \"box\"\nregion = { min = [0,0,0], max = [1,1,1] }",
        ),
        case(
            "particles",
            "particles_per_element = 4",
            "particles_per_element = 8",
        ),
        case(
            "volume filled twice",
            "[[loads]]",
            "[bodies.other]\nvolume = \"box\"\nmaterial = \"soil\"\n[[loads]]",
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn mesh() {
    let sample = "box = { size = [\"0.1 m\", \"0.1 m\", \"1 m\"], cells = [1, 1, 10] }";
    let lines = [
        case("missing mesh", sample, "file = \"column.msh\""),
        case("no mesh", sample, ""),
        case(
            "two meshes",
            sample,
            &format!("file = \"column.msh\"\n{sample}"),
        ),
        case("no cells", "cells = [1, 1, 10]", "cells = [1, 0, 10]"),
        case("flat box", "\"0.1 m\", \"1 m\"]", "\"0.1 m\", \"0 m\"]"),
        case("unit of a box", "[mesh]", "[mesh]\nunit = \"mm\""),
        case("bad unit", sample, "file = \"column.msh\"\nunit = \"inch\""),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn files() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("column");
    std::fs::create_dir(&folder).unwrap();
    let empty = read_in(dir, &[]).unwrap_err();
    let mut lines = vec![format!("## no scene\n{}\n", empty.rendered())];
    std::fs::write(folder.join("column.geo"), "").unwrap();
    let sample = "box = { size = [\"0.1 m\", \"0.1 m\", \"1 m\"], cells = [1, 1, 10] }";
    let text = with(sample, "file = \"column.msh\"");
    std::fs::write(folder.join("scene.toml"), text).unwrap();
    let unmade = read_in(empty.dir, &[]).unwrap_err();
    lines.push(format!("## mesh not made\n{}\n", unmade.rendered()));
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn boundaries() {
    let alpha = "alpha = 2.5 # found by trial";
    let lines = [
        case("misspelt surface", "\"y-max\"", "\"ymax\""),
        case("surface listed twice", "\"y-max\"", "\"x-max\""),
        case("misspelt kind", "\"roller\"", "\"rollers\""),
        case("zero alpha", alpha, "alpha = 0"),
        case("negative thickness", "\"0.5 m\"", "[\"1 m\", \"-0.5 m\"]"),
        case(
            "key of another kind",
            "kind = \"absorbing\"",
            "kind = \"fixed\"",
        ),
        case("contradiction", "\"y-max\"]", "\"y-max\", \"z-min\"]"),
        case(
            "same name",
            "surface = \"z-min\"\nkind",
            "name = \"sides\"\nsurface = \"z-min\"\nkind",
        ),
        case(
            "free in all directions",
            "kind = \"roller\"",
            "kind = \"prescribed\"\nvelocity = [\"free\", \"free\", \"free\"]",
        ),
        case("no velocity", "kind = \"roller\"", "kind = \"prescribed\""),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn loads_and_probes() {
    let constant = "{ kind = \"constant\" }";
    let lines = [
        case("misspelt body", "body = \"layer\"", "body = \"lair\""),
        case(
            "exclusive keys",
            "traction =",
            "pressure = \"1 kPa\"\ntraction =",
        ),
        case(
            "no size",
            "traction = [\"0 kPa\", \"0 kPa\", \"-1 kPa\"]\n",
            "",
        ),
        case(
            "surface its body does not touch",
            "volume = \"box\"",
            "region = { min = [0, 0, 0], max = [0.1, 0.1, 0.55] }",
        ),
        case(
            "times do not increase",
            constant,
            "{ kind = \"table\", points = [[0, 0], [\"1 s\", 1], [\"1 s\", 2]] }",
        ),
        case(
            "pulses overlap",
            constant,
            "{ kind = \"half-sine\", duration = \"1 s\", period = \"0.5 s\", count = 2 }",
        ),
        case("ramp without duration", constant, "{ kind = \"ramp\" }"),
        case("misspelt quantity", "\"stress\"]", "\"strain\"]"),
        case(
            "reaction of a free surface",
            "surface = \"z-min\"\nquantities = [\"displacement\", \"stress\"]",
            "surface = \"z-max\"\nquantities = \"reaction\"",
        ),
        case(
            "point outside",
            "surface = \"z-min\"\nquantities",
            "point = [0, 0, 2]\nquantities",
        ),
        case(
            "dot in a name",
            "[probes.bottom]",
            "[probes.\"the.bottom\"]",
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn numerics_stages_output() {
    let lines = [
        case("courant", "courant = 0.5", "courant = 1.5"),
        case("mass matrix", "smoothing = true", "mass = \"consistent\""),
        case("damping", "damping = 0.0", "damping = 1"),
        case(
            "negative viscosity",
            "viscosity = 0.0",
            "viscosity = \"-1 ms\"",
        ),
        case(
            "half a viscosity",
            "viscosity = 0.0",
            "viscosity = { fraction = 0.05 }",
        ),
        case(
            "two steps",
            "courant = 0.5",
            "time_step = \"1 ms\"\nmax_time_step = \"1 ms\"",
        ),
        case("no time", "duration = \"2 s\"", "duration = \"0 s\""),
        case(
            "two ends",
            "duration = \"2 s\"",
            "duration = \"2 s\"\nsteps = 5",
        ),
        case(
            "initial velocity of nobody",
            "duration = \"2 s\"",
            "duration = \"2 s\"\ninitial_velocity.layers = [0, 0, 1]",
        ),
        case("negative frames", "frames = 50", "frames = -1"),
        case("no history", "history = 1000", "history = 0"),
        case(
            "checkpoints all the time",
            "history = 1000",
            "checkpoint_interval = \"0 min\"",
        ),
        case(
            "misspelt column",
            "[output]",
            "[[compare]]\ncolumn = \"bottom.stress.z\"\nfile = \"a.csv\"\n[output]",
        ),
        case(
            "energy for later",
            "[output]",
            "[[compare]]\ncolumn = \"energy.plastic\"\nfile = \"a.csv\"\n[output]",
        ),
        case(
            "misspelt energy",
            "[output]",
            "[[compare]]\ncolumn = \"energy.kinetik\"\nfile = \"a.csv\"\n[output]",
        ),
        case(
            "no file to compare with",
            "[output]",
            "[[compare]]\ncolumn = \"bottom.stress.zz\"\nfile = \"a.csv\"\n[output]",
        ),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn sets() {
    let lines = [
        set("numerics.courrant=0.4"),
        set("numerisc.courant=0.4"),
        set("materials.soi.young_modulus=1 kPa"),
        set("boundaries.side.kind=fixed"),
        set("boundaries.5.kind=fixed"),
        set("materials.soil.young_modulus=-200 kPa"),
        set("materials.soil.young_modulus=2 m"),
        set("boundaries.1.kind=fixed"),
        set("title.text=a"),
        set("numerics=3"),
        set("numerics.courant"),
        set("numerics..courant=1"),
    ];
    insta::assert_snapshot!(lines.join("\n"));
}

/// Whatever is cut out of a scene, the answer is a plan or a message, and the message can be
/// shown.
#[test]
fn mutilated_scenes_have_messages_too() {
    let try_out = |text: &str, sets: &[&str]| {
        if let Err(failure) = read(text, sets) {
            assert!(!failure.rendered().is_empty());
        }
    };
    let lines: Vec<&str> = SAMPLE.lines().collect();
    for i in 0..lines.len() {
        let rest = [&lines[..i], &lines[i + 1..]].concat();
        try_out(&rest.join("\n"), &[]);
        try_out(&rest.join("\r\n"), &["numerics.courant=0.4"]);
    }
    for end in (0..SAMPLE.len()).step_by(7) {
        try_out(&SAMPLE[..end], &[]);
    }
    for odd in [
        "",
        "=",
        "=3",
        "a",
        "a=",
        ".=1",
        "\"\"=1",
        "materials=1",
        "boundaries=1",
        "boundaries.0=1",
        "boundaries.0.surface.0=ä",
        "boundaries.-1.kind=fixed",
        "mesh.box.size=[−1, 2]",
        "title={ a = 1 }",
        "stages.loading.name=\"ü\"",
        "probes.new.surface=z-max",
        "version=2",
    ] {
        try_out(SAMPLE, &[odd]);
    }
}
