//! Three elastic blocks that stand on each other, the lowest on a rigid bottom.
//!
//! In plane strain, free at their sides. Gravity is there from the start; the stack comes to rest
//! under viscosity or under local damping, and then, without local damping, must stay. The bottom
//! carries the weight.

use super::{body, contact, mean};
use crate::setup;
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::mesh::box_mesh;
use moldwarp::plan::*;
use moldwarp::{Plan, Simulation, Vec3};

const G: f64 = 9.81;
const DENSITY: f64 = 2000.0;
/// Pa; with ν = 0.3.
const E: f64 = 1e6;
/// Of a block, m.
const WIDTH: f64 = 0.4;
const HEIGHT: f64 = 0.2;
const FRICTION: f64 = 0.5;
/// Of the stages, s.
const SETTLE: f64 = 1.5;
const STAY: f64 = 1.0;

/// What brings the stack to rest.
#[derive(Clone, Copy, PartialEq)]
enum Rest {
    /// A tenth of critical on the first mode, ω = 2π c_p/(4 · 3 HEIGHT); in both stages.
    Viscosity,
    /// 0.7, in the first stage.
    LocalDamping,
}

impl Rest {
    fn name(self) -> &'static str {
        match self {
            Rest::Viscosity => "viscosity",
            Rest::LocalDamping => "local damping",
        }
    }
}

fn plan(h: f64, surface: ContactSurface, rest: Rest) -> Plan {
    // Two cells of room at the sides and above.
    let size = Vec3::new(WIDTH + 4.0 * h, h, 3.0 * HEIGHT + 2.0 * h);
    let cells = (size / h).to_array().map(|n| n.round() as usize);
    let mesh = box_mesh(size, cells).expect("a box is a good mesh");
    let mut plan = setup::free_body(mesh, setup::elastic(E, 0.3, DENSITY), STAY);
    plan.gravity = Vec3::new(0.0, 0.0, -G);
    setup::bound(&mut plan, &["z-min"], setup::FIXED);
    setup::bound(&mut plan, &["y-min", "y-max"], BoundaryKind::Roller);
    setup::probe(&mut plan, "bottom", "z-min", &[Quantity::Reaction]);
    let block = |name, k: f64| {
        let min = Vec3::new(2.0 * h, 0.0, k * HEIGHT);
        let max = min + Vec3::new(WIDTH, h, HEIGHT);
        body(name, Region::Box { min, max })
    };
    plan.bodies = vec![block("low", 0.0), block("middle", 1.0), block("top", 2.0)];
    plan.contacts = vec![
        contact([0, 1], FRICTION, surface),
        contact([1, 2], FRICTION, surface),
    ];
    plan.title = format!("{surface:?}, {}, h = {h} m", rest.name()).to_lowercase();
    match rest {
        Rest::Viscosity => plan.numerics.viscosity = 2.9e-3,
        Rest::LocalDamping => plan.numerics.damping = 0.7,
    }
    plan.stages = vec![
        Stage::new("settle", Until::Duration(SETTLE)),
        Stage {
            damping: Some(0.0),
            reset_displacement: true,
            ..Stage::new("stay", Until::Duration(STAY))
        },
    ];
    plan
}

#[derive(Default)]
struct Outcome {
    /// Mean of the bottom's reaction over the weight while it stays, and its greatest deviation.
    reaction: f64,
    deviation: f64,
    /// Force of both contacts over the weight above, at the end.
    contacts: [f64; 2],
    /// Displacement of the top block in the undamped stage, and its greatest, m.
    creep: f64,
    moved: f64,
    curve: Vec<(f64, f64)>,
}

fn compute(h: f64, surface: ContactSurface, rest: Rest) -> (Outcome, setup::Balance) {
    let mut o = Outcome::default();
    let (mut sum, mut count) = (0.0, 0.0);
    let balance = setup::run(plan(h, surface, rest), |s: &Simulation| {
        if s.stage() == 0 {
            return;
        }
        let p = s.particles();
        let weight = p.total_mass() * G;
        let reaction = setup::value(s, "bottom.reaction.z") / weight;
        // At the stage's first instant the bottom has not been loaded by a kick of its own.
        if s.stage_time() > 0.0 && s.stage() == 1 {
            sum += reaction;
            count += 1.0;
            o.deviation = o.deviation.max((reaction - 1.0).abs());
        }
        let top = mean(s, 2, |i| p.displacement(i));
        o.moved = o.moved.max(top.length());
        if s.stage() == 1 {
            o.curve.push((s.stage_time(), top.z / h));
        }
        if s.finished() {
            o.creep = top.length() / STAY;
            let tallies = s.contact_tallies();
            let above = [2.0 / 3.0, 1.0 / 3.0];
            o.contacts = [0, 1].map(|k| {
                let force = tallies[k].normal + tallies[k].tangential;
                -force.z / (above[k] * weight)
            });
        }
    });
    o.reaction = sum / count;
    (o, balance)
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "surface",
            "rest_by",
            "h_m",
            "reaction_over_weight",
            "deviation",
            "contact_1",
            "contact_2",
            "creep_h/s",
            "moved_over_h",
            "numerical_%",
            "residual",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "A stack stays",
        "time without damping, s",
        "top block's z-displacement over h",
    );
    for (name, surface) in [
        ("aligned", ContactSurface::Aligned),
        ("free", ContactSurface::Free),
    ] {
        let meshes = fidelity.pick(vec![2], vec![2, 4, 8]);
        let rests = [Rest::Viscosity, Rest::LocalDamping];
        for (n, rest) in meshes.into_iter().flat_map(|n| rests.map(|r| (n, r))) {
            let h = HEIGHT / f64::from(n);
            let (o, balance) = compute(h, surface, rest);
            report.table.row(&[
                &name,
                &rest.name(),
                &h,
                &format!("{:.6}", o.reaction),
                &format!("{:.1e}", o.deviation),
                &format!("{:.6}", o.contacts[0]),
                &format!("{:.6}", o.contacts[1]),
                &format!("{:.1e}", o.creep / h),
                &format!("{:.1e}", o.moved / h),
                &format!("{:.3}", 100.0 * balance.numerical),
                &format!("{:.1e}", balance.residual),
            ]);
            let label = format!("{name}; {}; h = {h} m", rest.name());
            let mut check = |what: &str, value: f64, limit: f64| {
                report.check(format!("{label}: {what}"), value, limit);
            };
            check(
                "bottom's reaction less the weight; over the weight",
                (o.reaction - 1.0).abs(),
                1e-3,
            );
            check(
                "creep of the top block over h; in a second",
                o.creep / h,
                1e-3,
            );
            check("residual of the ledger", balance.residual, 1e-6);
            check("absolute numerical terms", balance.numerical, 0.05);
            // Every step is more than a picture shows.
            let every = o.curve.len().div_ceil(2000).max(1);
            plot.line(label, o.curve.into_iter().step_by(every).collect());
        }
    }
    report.plots.push(("stack".to_owned(), plot));
    report
}
