//! A cube that spins freely about its centre, in an empty mesh.
//!
//! Nothing acts on it: momentum stays zero to round-off and angular momentum should stay what it
//! was. A mesh of linear elements does not conserve angular momentum exactly; the loss over a turn
//! must be under 0.5 % and fall under refinement.

use crate::setup;
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::mesh::box_mesh;
use moldwarp::plan::{Place, Region};
use moldwarp::{Plan, Simulation, Vec3};

/// Half the mesh's side, in sides of the cube.
const ROOM: f64 = 1.5;
/// Angular velocity, rad/s, and wave speed, m/s: edges move at 7 % of it.
const SPIN: Vec3 = Vec3::new(0.0, 0.0, 1.0);
const SPEED: f64 = 10.0;

/// A cube of 1 m side, `n` elements along it, about the origin of a mesh three times as wide.
pub fn plan(n: usize, end: f64) -> Plan {
    let mesh = box_mesh(
        Vec3::new(2.0 * ROOM, 2.0 * ROOM, 2.0),
        [3 * n, 3 * n, 2 * n],
    )
    .expect("a box is a good mesh");
    let density = 1000.0;
    let mut plan = setup::free_body(
        mesh,
        setup::elastic(density * SPEED * SPEED, 0.2, density),
        end,
    );
    let centre = Vec3::new(ROOM, ROOM, 1.0);
    let half = Vec3::splat(0.5);
    plan.bodies[0].place = Place::Region(Region::Box {
        min: centre - half,
        max: centre + half,
    });
    plan
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "elements",
            "angular_momentum_change_%",
            "momentum_over_scale",
            "energy_change_%",
            "residual",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "A freely spinning cube",
        "turns",
        "angular momentum over the first",
    );
    let mut last = f64::INFINITY;
    for n in fidelity.pick(vec![3, 6], vec![4, 8, 12]) {
        let turn = 2.0 * std::f64::consts::PI / SPIN.z;
        let centre = Vec3::new(ROOM, ROOM, 1.0);
        let mut simulation = Simulation::new(plan(n, turn)).unwrap_or_else(|e| panic!("{e}"));
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
        let change = (end - 1.0).abs();
        report.table.row(&[
            &n,
            &format!("{:.4}", 100.0 * (end - 1.0)),
            &format!("{momentum:.1e}"),
            &format!("{:.3}", 100.0 * balance.numerical),
            &format!("{:.1e}", balance.residual),
        ]);
        if n > 3 {
            report.check(
                format!("{n} elements: change of angular momentum in a turn"),
                change,
                5e-3,
            );
        }
        report.check(
            format!("{n} elements: change relative to the coarser mesh's"),
            change / last,
            1.0,
        );
        report.check(
            format!("{n} elements: momentum over m ω b/2"),
            momentum,
            1e-12,
        );
        report.check(
            format!("{n} elements: residual of the ledger"),
            balance.residual,
            1e-6,
        );
        last = change;
        plot.line(format!("{n} elements along a side"), curve);
    }
    report.plots.push(("rotation".to_owned(), plot));
    report
}
