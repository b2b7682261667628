//! Scenes that are right.

use super::{SAMPLE, read, with};
use crate::scene::{Every, load};
use moldwarp::Vec3;
use moldwarp::boundary::Function;
use moldwarp::material::{LinearElastic, Material};
use moldwarp::plan::{
    BoundaryKind, Integration, LoadKind, MassMatrix, Place, Quantity, Region, Seeding, Target,
    Until,
};

#[test]
fn the_sample_becomes_its_plan() {
    let scene = read(SAMPLE, &[]).unwrap();
    let plan = &scene.plan;
    assert_eq!(plan.title, "Suddenly loaded layer on an absorbing bottom");
    assert_eq!(plan.gravity, Vec3::ZERO);
    assert_eq!(plan.mesh.tets.len(), 60);
    assert_eq!(plan.materials[0].density, 18e3 / 9.81);
    let elastic = Material::LinearElastic(LinearElastic {
        young_modulus: 1e5,
        poisson_ratio: 0.0,
    });
    assert_eq!(plan.materials[0].model, elastic);
    let body = &plan.bodies[0];
    assert_eq!(
        (body.name.as_str(), &body.place),
        ("layer", &Place::Volumes(vec![0]))
    );
    assert_eq!((body.material, &body.seeding), (0, &Seeding::Four));
    assert_eq!(plan.boundaries[0].name, "sides");
    assert_eq!(plan.boundaries[0].surfaces, [0, 1, 2, 3]);
    assert!(matches!(plan.boundaries[0].kind, BoundaryKind::Roller));
    assert_eq!(plan.boundaries[1].name, "z-min");
    assert!(matches!(
        plan.boundaries[1].kind,
        BoundaryKind::Absorbing { alpha, virtual_thickness }
            if alpha == [2.5; 2] && virtual_thickness == Some([0.5; 2])
    ));
    let load = &plan.loads[0];
    assert_eq!((load.surfaces.as_slice(), load.body), (&[5][..], 0));
    assert_eq!(load.kind, LoadKind::Traction(Vec3::new(0.0, 0.0, -1e3)));
    assert_eq!(load.function, Function::Constant);
    assert_eq!(plan.probes[0].target, Target::Surface(4));
    assert_eq!(
        plan.probes[0].quantities,
        [Quantity::Displacement, Quantity::Stress]
    );
    assert_eq!(plan.numerics.integration, Integration::Mixed);
    assert_eq!(plan.stages[0].until, Until::Duration(2.0));
    assert_eq!(scene.output.frames, Every::Count(50));
    assert_eq!(scene.output.history, Every::Count(1000));
    assert_eq!(scene.text, SAMPLE);
    assert_eq!(scene.case, "column");
    assert!(scene.notes.is_empty());
}

#[test]
fn regions_are_read_in_all_their_kinds() {
    let at = |region: &str| {
        let text = with("volume = \"box\"", &format!("region = {region}"));
        // A region need not reach the loaded surface.
        let (before, rest) = text.split_once("[[loads]]").unwrap();
        let after = &rest[rest.find("[probes").unwrap()..];
        let plan = read(&format!("{before}{after}"), &[]).unwrap().plan;
        plan.bodies[0].place.clone()
    };
    let (min, max) = (Vec3::ZERO, Vec3::new(0.1, 0.1, 0.5));
    let half = Place::Region(Region::Box { min, max });
    assert_eq!(
        at("{ min = [0, 0, 0], max = [\"10 cm\", \"100 mm\", \"0.5 m\"] }"),
        half
    );
    assert_eq!(
        at("{ kind = \"box\", min = [0, 0, 0], max = [0.1, 0.1, 0.5] }"),
        half
    );
    assert_eq!(
        at("{ kind = \"sphere\", centre = [0, 0, 1], radius = \"20 cm\" }"),
        Place::Region(Region::Sphere {
            centre: Vec3::Z,
            radius: 0.2
        })
    );
    assert_eq!(
        at("{ kind = \"cylinder\", start = [0, 0, 0], end = [0, 0, 1], radius = 0.05 }"),
        Place::Region(Region::Cylinder {
            start: Vec3::ZERO,
            end: Vec3::Z,
            radius: 0.05
        })
    );
    assert_eq!(
        at("{ kind = \"half-space\", point = [0, 0, 0.5], normal = [0, 0, 1] }"),
        Place::Region(Region::HalfSpace {
            point: 0.5 * Vec3::Z,
            normal: Vec3::Z
        })
    );
}

#[test]
fn boundaries_are_read_in_all_their_kinds() {
    let kind = |lines: &str| {
        let absorbing = "kind = \"absorbing\"\nalpha = 2.5 # found by trial\n\
                         virtual_thickness = \"0.5 m\"";
        let text = with(absorbing, lines);
        read(&text, &[]).unwrap().plan.boundaries[1].kind.clone()
    };
    assert!(matches!(
        kind("kind = \"fixed\""),
        BoundaryKind::Fixed {
            directions: [true, true, true]
        }
    ));
    assert!(matches!(
        kind("kind = \"fixed\"\ndirections = [\"x\", \"z\"]"),
        BoundaryKind::Fixed {
            directions: [true, false, true]
        }
    ));
    let moved = "kind = \"prescribed\"\nvelocity = [\"free\", \"60 mm/min\", 0]\n\
                 function = { kind = \"ramp\", duration = \"10 ms\" }";
    assert!(matches!(
        kind(moved),
        BoundaryKind::Prescribed { velocity: [None, Some(y), Some(0.0)], function: Function::Ramp { duration } }
            if y == 0.001 && duration == 0.01
    ));
    assert!(matches!(
        kind("kind = \"absorbing\"\nalpha = [1, 0.5]\nvirtual_thickness = [\"1 m\", \"50 cm\"]"),
        BoundaryKind::Absorbing { alpha: [1.0, 0.5], virtual_thickness: Some([1.0, s]) } if s == 0.5
    ));
    assert!(matches!(
        kind("kind = \"absorbing\""),
        BoundaryKind::Absorbing {
            alpha: [1.0, 1.0],
            virtual_thickness: None
        }
    ));
}

#[test]
fn functions_are_read_in_all_their_kinds() {
    let function = |function: &str| {
        let text = with("{ kind = \"constant\" }", function);
        read(&text, &[]).unwrap().plan.loads[0].function.clone()
    };
    assert_eq!(
        function("{ kind = \"table\", points = [[0, 0], [\"10 ms\", 1], [\"1 s\", -0.5]] }"),
        Function::Table {
            points: vec![(0.0, 0.0), (0.01, 1.0), (1.0, -0.5)]
        }
    );
    let train = "{ kind = \"half-sine\", duration = \"5 ms\", period = \"1 s\", count = 3 }";
    assert_eq!(
        function(train),
        Function::HalfSine {
            duration: 0.005,
            period: 1.0,
            count: 3
        }
    );
    assert_eq!(
        function("{ kind = \"half-sine\", duration = \"5 ms\" }"),
        Function::HalfSine {
            duration: 0.005,
            period: 0.005,
            count: 1
        }
    );
}

#[test]
fn the_mass_matrix_is_corrected_unless_it_is_to_be_lumped() {
    let mass = |line: &str| {
        let text = with("smoothing = true", line);
        read(&text, &[]).unwrap().plan.numerics.mass
    };
    assert_eq!(mass("smoothing = true"), MassMatrix::Corrected);
    assert_eq!(mass("mass = \"corrected\""), MassMatrix::Corrected);
    assert_eq!(mass("mass = \"lumped\""), MassMatrix::Lumped);
}

#[test]
fn loads_are_pressures_and_forces_too() {
    let kind = |line: &str| {
        let text = with("traction = [\"0 kPa\", \"0 kPa\", \"-1 kPa\"]", line);
        read(&text, &[]).unwrap().plan.loads[0].kind
    };
    assert_eq!(kind("pressure = \"2 kPa\""), LoadKind::Pressure(2e3));
    assert_eq!(
        kind("force = [\"3 kN\", 0, \"1 N\"]"),
        LoadKind::Force(Vec3::new(3e3, 0.0, 1.0))
    );
}

#[test]
fn stages_end_by_steps_too_and_may_begin_with_a_throw() {
    let stage = "steps = 7\ndamping = 0.7\ninitial_velocity.layer = [0, 0, \"-2 m/s\"]";
    let plan = read(&with("duration = \"2 s\"", stage), &[]).unwrap().plan;
    let stage = &plan.stages[0];
    assert_eq!((stage.until, stage.damping), (Until::Steps(7), Some(0.7)));
    assert_eq!(stage.initial_velocities, [(0, Vec3::new(0.0, 0.0, -2.0))]);
}

#[test]
fn viscosity_is_a_time_or_a_fraction_at_a_period() {
    let viscosity = |value: &str| {
        let text = with("viscosity = 0.0", &format!("viscosity = {value}"));
        read(&text, &[]).unwrap().plan.numerics.viscosity
    };
    assert_eq!(viscosity("\"0.2 ms\""), 0.0002);
    let beta = viscosity("{ fraction = 0.05, period = \"0.5 s\" }");
    assert!((beta - 0.025 / std::f64::consts::PI).abs() < 1e-18);
}

#[test]
fn optional_parts_have_defaults() {
    let (start, rest) = SAMPLE.split_once("[numerics]").unwrap();
    let stages = &rest[rest.find("[[stages]]").unwrap()..rest.find("[output]").unwrap()];
    let text = format!("{start}{stages}").replace("body = \"layer\"\n", "");
    let scene = read(&text, &["title=\"\""]).unwrap();
    assert_eq!(scene.plan.numerics.courant, 0.5);
    assert_eq!(scene.output, Default::default());
    assert_eq!(scene.plan.loads[0].body, 0);
}

#[test]
fn unused_materials_are_noted() {
    let text = format!(
        "{SAMPLE}\n[materials.clay]\nmodel = \"linear-elastic\"\n\
        young_modulus = 1e6\npoisson_ratio = 0.3\ndensity = \"1.8 t/m3\"\n"
    );
    let notes = read(&text, &[]).unwrap().notes;
    assert_eq!(notes, ["no body is made of material `clay`"]);
}

#[test]
fn other_files_than_scene_toml_have_their_own_case() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("absorbing-column");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(folder.join("rigid.toml"), SAMPLE).unwrap();
    std::fs::write(folder.join("exact.csv"), "0,0\n").unwrap();
    let compare = "compare=[{ column = \"bottom.stress.zz\", file = \"exact.csv\" }]";
    let path = folder.join("rigid.toml");
    assert!(
        load(&path, &[compare.to_owned()]).is_err(),
        "lists are not added"
    );
    let text = format!("{SAMPLE}[[compare]]\ncolumn = \"bottom.stress.zz\"\nfile = \"exact.csv\"");
    std::fs::write(&path, text).unwrap();
    let scene = load(&path, &[]).unwrap();
    assert_eq!(scene.case, "absorbing-column-rigid");
    assert_eq!(scene.folder, folder);
    assert_eq!(scene.compare[0].file, folder.join("exact.csv"));
}

#[test]
fn values_are_set_in_place_and_comments_stay() {
    let sets = [
        "materials.soil.young_modulus=200 kPa",
        "boundaries.1.alpha=1.0",
        "boundaries.sides.kind=fixed",
        "loads.0.traction=[\"0 kPa\",\"0 kPa\",\"-2 kPa\"]",
        "loads.0.function.kind=constant",
        "mesh.box.cells.2=5",
        "numerics.max_time_step=1 ms",
        "title=changed",
    ];
    let scene = read(SAMPLE, &sets).unwrap();
    let plan = &scene.plan;
    assert_eq!(plan.materials[0].model.elasticity().young_modulus, 2e5);
    assert!(matches!(
        plan.boundaries[0].kind,
        BoundaryKind::Fixed { .. }
    ));
    assert_eq!(
        plan.loads[0].kind,
        LoadKind::Traction(Vec3::new(0.0, 0.0, -2e3))
    );
    assert_eq!(plan.mesh.tets.len(), 30);
    assert_eq!(plan.numerics.max_time_step, Some(1e-3));
    assert_eq!(plan.title, "changed");
    assert!(scene.text.contains("alpha = 1.0 # found by trial\n"));
    // The text as run is a scene of its own.
    assert_eq!(read(&scene.text, &[]).unwrap().text, scene.text);
}

#[test]
fn optional_keys_and_tables_can_be_set_where_they_are_absent() {
    let (start, rest) = SAMPLE.split_once("[numerics]").unwrap();
    let stages = &rest[rest.find("[[stages]]").unwrap()..rest.find("[output]").unwrap()];
    let text = format!("{start}{stages}");
    let sets = [
        "numerics.courant=0.4",
        "numerics.viscosity.fraction=0.05",
        "numerics.viscosity.period=1 s",
        "output.frames=0",
        "stages.loading.initial_velocity.layer=[1, 0, 0]",
    ];
    let scene = read(&text, &sets).unwrap();
    assert_eq!(scene.plan.numerics.courant, 0.4);
    assert_eq!(scene.output.frames, Every::Count(0));
    assert_eq!(scene.plan.stages[0].initial_velocities, [(0, Vec3::X)]);
}

#[test]
fn boundaries_that_do_not_disturb_each_other_may_share_a_surface() {
    let bottom = "kind = \"absorbing\"\nalpha = 2.5 # found by trial\n\
                  virtual_thickness = \"0.5 m\"";
    let both = |first: &str, second: &str| {
        let second = format!("{first}\n[[boundaries]]\nsurface = \"z-min\"\n{second}");
        read(&with(bottom, &second), &[])
    };
    let fixed = "kind = \"fixed\"\ndirections = \"x\"";
    let roller = "kind = \"roller\"";
    let moved = |v: &str| format!("kind = \"prescribed\"\nvelocity = {v}");
    let along = moved("[1, \"free\", \"free\"]");
    let across = moved("[\"free\", \"free\", 1]");
    let names = |first: &str, second: &str| -> Vec<String> {
        let plan = both(first, second).unwrap().plan;
        plan.boundaries.iter().map(|b| b.name.clone()).collect()
    };
    assert_eq!(names(fixed, roller), ["sides", "z-min", "z-min-2"]);
    assert_eq!(names(roller, &along), ["sides", "z-min", "z-min-2"]);
    assert_eq!(names(&along, &across), ["sides", "z-min", "z-min-2"]);
    assert!(both(roller, &across).is_err());
    assert!(both(fixed, &along).is_err());
    assert!(both("kind = \"absorbing\"", roller).is_err());
}
