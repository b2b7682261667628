//! A rigid punch is pushed into elastic soil: with the mesh going along, and through a fixed mesh.
//!
//! Plane strain, half of it, no gravity. With an aligned contact the punch's boundary stays on faces of
//! elements, which go with it; with a free contact it goes through a mesh that rests. Both are
//! approximations of the same problem and must come to the same force as the mesh is refined. As long as
//! the punch has gone by a tenth of an element only, the aligned contact can do without mesh motion: forces
//! must then be the same to the difference that a mesh moved by so little makes.

use crate::cases::contact::{body, contact};
use crate::setup::{self, Balance};
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::material::Material;
use moldwarp::mesh::box_mesh;
use moldwarp::plan::*;
use moldwarp::{Plan, Simulation, Vec3};

/// Width and height of the soil, room above it, m.
const WIDTH: f64 = 1.0;
const SOIL: f64 = 0.8;
const ROOM: f64 = 0.4;
/// Half the width of the punch and its height, m.
const PUNCH: f64 = 0.3;
const HEIGHT: f64 = 0.2;
/// m/s, m. A wave goes 120 times as fast.
const SPEED: f64 = 0.5;
const WAY: f64 = 0.1;
/// Forces are averaged over this part of the way.
const WINDOW: f64 = WAY / 50.0;

#[derive(Clone, Copy, PartialEq)]
enum How {
    /// Aligned contact, and the mesh goes along.
    Moving,
    /// Free contact on a mesh that rests.
    Free,
    /// Aligned contact on a mesh that rests.
    Still,
}

impl How {
    fn name(self) -> &'static str {
        match self {
            How::Moving => "aligned, moving mesh",
            How::Free => "free, fixed mesh",
            How::Still => "aligned, fixed mesh",
        }
    }
}

/// `base` holds the soil below; `way` is how far the punch goes, m.
fn plan(how: How, h: f64, friction: f64, base: bool, way: f64) -> Plan {
    let size = Vec3::new(WIDTH, h, SOIL + ROOM);
    let cells = size.to_array().map(|l| (l / h).round() as usize);
    let mesh = box_mesh(size, cells).expect("a box is a good mesh");
    let punch = |x: Vec3| x.x < PUNCH && x.z > SOIL && x.z < SOIL + HEIGHT;
    let mesh = setup::with_volumes(&mesh, |x| match x {
        _ if punch(x) => "punch",
        _ if x.x < PUNCH + 0.2 && x.z > SOIL - 0.1 => "zone",
        _ => "rest",
    });
    // 3 % of critical on the layer's first mode.
    let soil = setup::elastic(5e6, 0.3, 2000.0);
    let mut plan = setup::free_body(mesh, soil, way / SPEED);
    plan.title = format!(
        "{}, μ = {friction}, h = {h} m, {way:.3} m{}",
        how.name(),
        if base { "" } else { ", soil on nothing" }
    );
    plan.numerics.viscosity = 5e-4;
    plan.materials.push(NamedMaterial {
        name: "steel".to_owned(),
        density: 2e8,
        model: Material::Rigid,
    });
    let layer = Region::Box {
        min: Vec3::ZERO,
        max: Vec3::new(WIDTH, h, SOIL),
    };
    let tool = Region::Box {
        min: Vec3::new(0.0, 0.0, SOIL),
        max: Vec3::new(PUNCH, h, SOIL + HEIGHT),
    };
    plan.bodies = vec![body("soil", layer), body("punch", tool)];
    plan.bodies[1].material = 1;
    let surface = match how {
        How::Free => ContactSurface::Free,
        How::Moving | How::Still => ContactSurface::Aligned,
    };
    plan.contacts = vec![Contact {
        gap_check: false,
        ..contact([1, 0], friction, surface)
    }];
    if how == How::Moving {
        let group = |name: &str| plan.mesh.volume_group(name).expect("the mesh has it");
        plan.mesh_motion = Some(MeshMotion {
            driver: 1,
            direction: -Vec3::Z,
            moving: vec![group("zone")],
            blend: vec![group("rest")],
        });
    }
    setup::bound(&mut plan, &setup::SIDES, BoundaryKind::Roller);
    if base {
        setup::bound(&mut plan, &["z-min"], setup::FIXED);
    }
    plan.stages[0].initial_velocities = vec![(1, Vec3::new(0.0, 0.0, -SPEED))];
    plan
}

#[derive(Default)]
struct Outcome {
    /// (Way, m; force on a metre of the whole punch, N/m), means over windows.
    force: Vec<(f64, f64)>,
    /// Momentum that soil and punch have gained together, over what the soil has gained.
    momentum: f64,
    /// Greatest residual of the ledger over the soil's elastic energy.
    residual: f64,
    /// Greatest distance by which a particle was put back, over h.
    put_back: f64,
}

fn compute(plan: Plan, h: f64, window: f64) -> (Outcome, Balance) {
    let mut o = Outcome::default();
    let (mut first, mut sum, mut residual) = (None, (0.0, 0.0), 0.0f64);
    let balance = setup::run(plan, |s: &Simulation| {
        let p = s.particles();
        let momentum = |body: u16| -> f64 {
            let own = (0..p.len()).filter(|&i| p.body[i] == body);
            own.map(|i| p.mass[i] * p.velocity.at(i).z).sum()
        };
        let tally = s.contact_tallies()[0];
        let push = (tally.normal + tally.tangential).z * s.time_step();
        sum = (sum.0 + push, sum.1 + s.time_step());
        if sum.1 * SPEED >= window {
            let punch = p.body.iter().position(|&b| b == 1).expect("it is there");
            let way = -p.displacement(punch).z;
            o.force
                .push((way - 0.5 * sum.1 * SPEED, 2.0 * sum.0 / sum.1 / h));
            sum = (0.0, 0.0);
        }
        residual = residual.max(s.energies().residual.abs());
        let [soil, own] = [0, 1].map(momentum);
        let start = *first.get_or_insert(soil + own);
        if s.finished() {
            o.momentum = (soil + own - start) / soil;
            o.residual = residual / s.energies().elastic;
            o.put_back = s.projections().greatest / h;
        }
    });
    (o, balance)
}

/// Of two curves of force the root mean square of the difference and the difference of the means in the
/// second half of the way, over the mean of the second.
fn difference(one: &[(f64, f64)], other: &[(f64, f64)]) -> [f64; 2] {
    let at = |x: f64| {
        let next = other.partition_point(|p| p.0 < x).clamp(1, other.len() - 1);
        let [a, b] = [other[next - 1], other[next]];
        a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0)
    };
    let half = 0.5 * one[one.len() - 1].0;
    let later: Vec<[f64; 2]> = one
        .iter()
        .filter(|p| p.0 > half)
        .map(|p| [p.1, at(p.0)])
        .collect();
    let count = later.len() as f64;
    let mean = later.iter().map(|p| p[1]).sum::<f64>() / count;
    let square = later.iter().map(|p| (p[0] - p[1]).powi(2)).sum::<f64>() / count;
    let shift = later.iter().map(|p| p[0] - p[1]).sum::<f64>() / count;
    [square.sqrt() / mean, shift / mean]
}

/// On a base, over the whole way.
fn long(how: How, h: f64, friction: f64) -> (Outcome, Balance) {
    compute(plan(how, h, friction, true, WAY), h, WINDOW)
}

/// Forces over a tenth of an element.
fn short(how: How, h: f64, friction: f64) -> Vec<(f64, f64)> {
    let way = 0.1 * h;
    compute(plan(how, h, friction, true, way), h, way / 10.0)
        .0
        .force
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "friction",
            "h_m",
            "moving_kN/m",
            "free_kN/m",
            "difference_rms_%",
            "difference_mean_%",
            "short_difference",
            "put_back_over_h",
            "momentum",
            "residual",
            "numerical_%",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "A punch goes into elastic soil",
        "way, m",
        "force on a metre, kN",
    );
    let sizes = fidelity.pick(vec![0.1, 0.05], vec![0.1, 0.05, 0.025]);
    for friction in [0.0, 0.3] {
        let mut differences = Vec::new();
        for &h in &sizes {
            let (moving, balance) = long(How::Moving, h, friction);
            let (free, _) = long(How::Free, h, friction);
            let [rms, shift] = difference(&moving.force, &free.force);
            differences.push(rms);
            let [near, _] = difference(
                &short(How::Moving, h, friction),
                &short(How::Still, h, friction),
            );
            // Soil that nothing holds is soon pushed out of the mesh.
            let (flying, _) = compute(plan(How::Moving, h, friction, false, 0.2 * WAY), h, WINDOW);
            let last = |o: &Outcome| o.force[o.force.len() - 1].1 / 1e3;
            report.table.row(&[
                &friction,
                &h,
                &format!("{:.1}", last(&moving)),
                &format!("{:.1}", last(&free)),
                &format!("{:.2}", 100.0 * rms),
                &format!("{:.2}", 100.0 * shift),
                &format!("{near:.1e}"),
                &format!("{:.4}", moving.put_back),
                &format!("{:.1e}", flying.momentum),
                &format!("{:.1e}", moving.residual.max(free.residual)),
                &format!("{:.3}", 100.0 * balance.numerical),
            ]);
            let name = format!("μ = {friction}; h = {h} m");
            let mut check = |what: &str, value: f64, limit: f64| {
                report.check(format!("{name}: {what}"), value, limit);
            };
            check("force; moving against free", rms, 0.25 * h / PUNCH);
            check(
                "force over a tenth of an element; moving against still",
                near,
                0.01,
            );
            check(
                "particles put back; greatest distance over h",
                moving.put_back,
                0.1,
            );
            check("momentum lost on the way", flying.momentum.abs(), 1e-8);
            check("residual of the ledger", moving.residual, 1e-9);
            check("residual of the ledger; free", free.residual, 1e-9);
            let kilo = |o: Outcome| o.force.into_iter().map(|p| (p.0, p.1 / 1e3)).collect();
            if friction == 0.3 {
                plot.line(format!("aligned, moving mesh, h = {h} m"), kilo(moving));
                plot.dashed(format!("free, fixed mesh, h = {h} m"), kilo(free));
            }
        }
        if let [first, .., last] = differences[..] {
            let what = format!("μ = {friction}: difference; finest mesh over coarsest");
            report.check(what, last / first, 1.0);
        }
    }
    report.plots.push(("moving-push".to_owned(), plot));
    report
}
