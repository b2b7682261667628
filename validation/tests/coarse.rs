//! The coarse cases as tests: every figure within its limit.

use moldwarp_validation::{Fidelity, cases};

fn run(name: &str) {
    let case = cases::find(name).expect("a case of that name");
    let report = (case.run)(Fidelity::Coarse);
    assert!(report.passed(), "{name}:\n{}", report.summary());
}

macro_rules! coarse {
    ($($test:ident = $name:literal),* $(,)?) => {
        $(#[test] fn $test() { run($name); })*

        #[test]
        fn every_case_is_tested() {
            let tested = [$($name),*];
            assert!(cases::ALL.iter().all(|c| tested.contains(&c.name)));
        }
    };
}

coarse! {
    absorbing_column = "absorbing-column",
    sensitivity = "sensitivity",
    gravity_column = "gravity-column",
    first_mode = "first-mode",
    oedometer = "oedometer",
    mass_matrix = "mass-matrix",
    rotation = "rotation",
    shear_wave = "shear-wave",
    strip_footing = "strip-footing",
    circular_footing = "circular-footing",
    column_collapse = "column-collapse",
    thick_cylinder = "thick-cylinder",
    heap = "heap",
    collapse_smoothing = "collapse-smoothing",
    sliding_block = "sliding-block",
    sliding_block_gmsh = "sliding-block-gmsh",
    spheres = "spheres",
    stack = "stack",
    penetration = "penetration",
    moving_ground = "moving-ground",
    moving_push = "moving-push",
    drop = "drop",
}
