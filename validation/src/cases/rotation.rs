//! A ball and a cube that spin freely in an empty mesh.
//!
//! Nothing acts on them: momentum stays zero to round-off and angular momentum should stay what it
//! was. A mesh of linear elements does not conserve angular momentum exactly, since a node at a
//! body's surface stands for material that lies to one side of it; the loss over a turn falls
//! under refinement and is under 0.5 % with 18 elements over the ball's diameter.

use crate::setup;
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::mesh::box_mesh;
use moldwarp::plan::{Place, Region};
use moldwarp::{Plan, Simulation, Vec3};

/// Side of the mesh, m; bodies sit in its middle.
const ROOM: f64 = 5.0 / 3.0;
const RADIUS: f64 = 0.75;
/// Angular velocity, rad/s, and wave speed for ν = 0, m/s: the surface moves at 15 % of it.
const SPIN: Vec3 = Vec3::new(0.0, 0.0, 1.0);
const SPEED: f64 = 5.0;
/// Angular momentum that may be lost in a turn where the mesh is fine enough.
const LIMIT: f64 = 5e-3;

#[derive(Clone, Copy, PartialEq)]
enum Shape {
    Ball,
    /// With a side of 1 m.
    Cube,
}

impl Shape {
    fn name(self) -> &'static str {
        match self {
            Shape::Ball => "ball",
            Shape::Cube => "cube",
        }
    }

    fn region(self) -> Region {
        let centre = Vec3::splat(0.5 * ROOM);
        let half = Vec3::splat(0.5);
        match self {
            Shape::Ball => Region::Sphere {
                centre,
                radius: RADIUS,
            },
            Shape::Cube => Region::Box {
                min: centre - half,
                max: centre + half,
            },
        }
    }
}

/// A body in a mesh of `n` elements a metre.
fn plan(shape: Shape, n: usize, end: f64) -> Plan {
    let cells = (ROOM * n as f64).round() as usize;
    let mesh = box_mesh(Vec3::splat(ROOM), [cells; 3]).expect("a box is a good mesh");
    let density = 1000.0;
    let material = setup::elastic(density * SPEED * SPEED, 0.2, density);
    let mut plan = setup::free_body(mesh, material, end);
    plan.title = format!("{}, {n} elements a metre", shape.name());
    plan.bodies[0].place = Place::Region(shape.region());
    plan
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "body",
            "elements_per_m",
            "angular_momentum_change_%",
            "momentum_over_scale",
            "numerical_%",
            "residual",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "Freely spinning bodies",
        "turns",
        "angular momentum over the first",
    );
    for (shape, meshes) in [
        (Shape::Ball, fidelity.pick(vec![6, 12], vec![6, 12, 18])),
        (Shape::Cube, fidelity.pick(vec![6], vec![6, 12, 18])),
    ] {
        let mut last = f64::INFINITY;
        for n in meshes {
            let change = spin(&mut report, &mut plot, shape, n);
            let name = shape.name();
            if (shape == Shape::Ball && n >= 12) || n >= 18 {
                let what = format!("{name}; {n} elements a metre: angular momentum lost in a turn");
                report.check(what, change, LIMIT);
            }
            let what = format!("{name}; {n} elements a metre: loss over the coarser mesh's");
            report.check(what, change / last, 0.5);
            last = change;
        }
    }
    report.plots.push(("rotation".to_owned(), plot));
    report
}

/// One turn; the relative change of angular momentum.
fn spin(report: &mut Report, plot: &mut Plot, shape: Shape, n: usize) -> f64 {
    let turn = std::f64::consts::TAU / SPIN.z;
    let centre = Vec3::splat(0.5 * ROOM);
    let mut simulation = Simulation::new(plan(shape, n, turn)).unwrap_or_else(|e| panic!("{e}"));
    simulation
        .set_velocity(|x| SPIN.cross(x - centre))
        .unwrap_or_else(|e| panic!("{e}"));
    let first = simulation.particles().angular_momentum().z;
    let scale = simulation.particles().total_mass() * 0.5 * SPIN.z;
    let (mut curve, mut momentum, mut end) = (Vec::new(), 0.0f64, 0.0);
    let balance = setup::run_from(simulation, |s| {
        end = s.particles().angular_momentum().z / first;
        momentum = momentum.max(s.particles().momentum().length() / scale);
        curve.push((s.time() / turn, end));
    });
    let name = shape.name();
    report.table.row(&[
        &name,
        &n,
        &format!("{:.4}", 100.0 * (end - 1.0)),
        &format!("{momentum:.1e}"),
        &format!("{:.3}", 100.0 * balance.numerical),
        &format!("{:.1e}", balance.residual),
    ]);
    report.check(
        format!("{name}; {n} elements a metre: momentum over m ω/2"),
        momentum,
        1e-12,
    );
    report.check(
        format!("{name}; {n} elements a metre: residual of the ledger"),
        balance.residual,
        1e-6,
    );
    plot.line(format!("{name}, {n} elements a metre"), curve);
    (end - 1.0).abs()
}
