//! The block on the incline of `sliding-block` in an unstructured mesh from Gmsh.
//!
//! The sides of the block cut elements, and its sole slides over triangles of all shapes. Gravity grows
//! while the nodes of the sides are held along x, then the block is free: a = g (sin θ − μ cos θ).

use super::{body, contact};
use crate::setup;
use crate::{Fidelity, Report, Table};
use moldwarp::mesh::Mesh;
use moldwarp::plan::*;
use moldwarp::{Plan, Vec3};
use std::path::Path;

const G: f64 = 9.81;
const SLOPE: f64 = std::f64::consts::FRAC_PI_6;
/// Size of the elements, m.
const H: f64 = 0.1;
const BASE: f64 = 0.1;
const WIDTH: f64 = 0.2;
const WAY: f64 = 1.05;
/// As in `sliding-block`.
const VISCOSITY: f64 = 4.9e-4;
const RAMP: f64 = 0.6;

fn mesh() -> Mesh {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/incline.msh");
    let file = moldwarp_io::mesh::read_gmsh(&path).unwrap_or_else(|e| panic!("{e}"));
    Mesh::new(file.raw).unwrap_or_else(|e| panic!("{e}"))
}

fn exact(friction: f64) -> f64 {
    G * (SLOPE.sin() - friction * SLOPE.cos())
}

fn plan(friction: f64, surface: ContactSurface) -> Plan {
    let time = (2.0 * WAY / exact(friction)).sqrt();
    let mut plan = setup::free_body(mesh(), setup::elastic(1e6, 0.3, 2000.0), time);
    plan.title = format!("{surface:?}, μ = {friction}").to_lowercase();
    plan.gravity = G * Vec3::new(SLOPE.sin(), 0.0, -SLOPE.cos());
    let min = Vec3::new(0.2, 0.0, BASE);
    let max = min + Vec3::new(0.4, WIDTH, 0.2);
    let base = plan.mesh.volume_group("base").expect("it is in the mesh");
    plan.bodies = vec![
        Body {
            place: Place::Volumes(vec![base]),
            ..body("base", Region::Box { min, max })
        },
        body("block", Region::Box { min, max }),
    ];
    plan.contacts = vec![contact([0, 1], friction, surface)];
    setup::bound(&mut plan, &["z-min"], setup::FIXED);
    setup::bound(&mut plan, &setup::SIDES, BoundaryKind::Roller);
    let directions = [true, false, false];
    setup::bound(
        &mut plan,
        &["y-min", "y-max"],
        BoundaryKind::Fixed { directions },
    );
    plan.probes = vec![Probe {
        name: "block".to_owned(),
        target: Target::Body(1),
        quantities: vec![Quantity::Displacement, Quantity::Velocity],
    }];
    plan.numerics.viscosity = VISCOSITY;
    let grow = Ramp {
        from: Some(0.0),
        to: 1.0,
        over: 0.5 * RAMP,
    };
    plan.stages = vec![
        Stage {
            levels: vec![(Level::Gravity, grow)],
            ..Stage::new("ramp", Until::Duration(RAMP))
        },
        Stage {
            off: vec![Item::Boundary(2)],
            reset_displacement: true,
            ..Stage::new("slide", Until::Duration(time))
        },
    ];
    plan
}

pub fn run(_: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "surface",
            "friction",
            "a_m/s2",
            "exact_m/s2",
            "error",
            "lift_over_h",
            "numerical_%",
        ]),
        ..Report::default()
    };
    for (surface, name, limit) in [
        (ContactSurface::Aligned, "aligned", 0.01),
        (ContactSurface::Free, "free", 0.03),
    ] {
        for friction in [0.0, 0.2, 0.5] {
            // Time, displacement along and normal to the incline, velocity.
            let mut path: Vec<[f64; 4]> = Vec::new();
            let balance = setup::run(plan(friction, surface), |s| {
                if s.stage() == 1 {
                    let mut v = Vec::new();
                    s.probe_values(&mut v);
                    path.push([s.stage_time(), v[0], v[2], v[3]]);
                }
            });
            let last = path[path.len() - 1];
            let half = path.iter().find(|p| p[1] > 0.5 * last[1]);
            let half = half.expect("the block slides");
            let a = (last[3] - half[3]) / (last[0] - half[0]);
            let error = (a - exact(friction)) / (G * SLOPE.sin());
            let lift = path.iter().map(|p| p[2].abs()).fold(0.0, f64::max) / H;
            report.table.row(&[
                &name,
                &friction,
                &format!("{a:.4}"),
                &format!("{:.4}", exact(friction)),
                &format!("{error:.5}"),
                &format!("{lift:.4}"),
                &format!("{:.3}", 100.0 * balance.numerical),
            ]);
            let what = format!("{name}; μ = {friction}");
            report.check(
                format!("{what}: error of a over g sin θ"),
                error.abs(),
                limit,
            );
            report.check(format!("{what}: change of the gap over h"), lift, 0.05);
            report.check(
                format!("{what}: residual of the ledger"),
                balance.residual,
                1e-6,
            );
            report.check(
                format!("{what}: absolute numerical terms"),
                balance.numerical,
                0.05,
            );
        }
    }
    report
}
