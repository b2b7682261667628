//! A block that falls flat on a floor of the same stuff, on a rigid base.
//!
//! Both are held by rollers on all sides, so that plane waves run in them, of speed c = √(E_c/ρ). With
//! gravity off and the block H high, the floor H/2 thick, d'Alembert's solution has the waves of the
//! impact meet at the interface when the block has unloaded (see `touch`): it parts with all of its
//! velocity v turned round and leaves the floor at rest. The coefficient of restitution is 1.

use super::{body, contact, mean};
use crate::setup;
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::mesh::box_mesh;
use moldwarp::plan::*;
use moldwarp::{Plan, Simulation, Vec3};

const HEIGHT: f64 = 0.2;
const FLOOR: f64 = 0.1;
const DENSITY: f64 = 2000.0;
/// Pa; with ν = 0, so that it is E_c.
const E: f64 = 1e6;
const SPEED: f64 = 0.5;
/// Distance at the start over the cells' size.
const GAP: f64 = 0.5;

fn wave_speed() -> f64 {
    (E / DENSITY).sqrt()
}

/// How long block and floor touch, s. The interface carries −ρ c v/2 at first. From below comes the
/// wave that the base has reflected, after H/c; it runs up in the block and is released at its top.
/// The block's own release comes from its top after 2H/c, passes down to the base, where it doubles,
/// and is back at the interface after 3H/c, together with the release of the other: then nothing is
/// left, and the block moves up with v.
fn touch() -> f64 {
    3.0 * HEIGHT / wave_speed()
}

fn plan(h: f64, gap_check: bool) -> Plan {
    let cells = [2, 2, ((HEIGHT + FLOOR + 0.1) / h).round() as usize];
    let size = Vec3::from_array(cells.map(|n| n as f64 * h));
    let mesh = box_mesh(size, cells).expect("a box is a good mesh");
    let end = GAP * h / SPEED + 1.3 * touch();
    let mut plan = setup::column(mesh, setup::elastic(E, 0.0, DENSITY), end);
    let word = if gap_check { "on" } else { "off" };
    plan.title = format!("gap check {word}, h = {h} m");
    setup::bound(&mut plan, &["z-min"], setup::FIXED);
    let between = |low: f64, high: f64| Region::Box {
        min: Vec3::new(0.0, 0.0, low),
        max: Vec3::new(size.x, size.y, high),
    };
    let bottom = FLOOR + GAP * h;
    plan.bodies = vec![
        body("floor", between(0.0, FLOOR)),
        body("block", between(bottom, bottom + HEIGHT)),
    ];
    plan.contacts = vec![Contact {
        gap_check,
        ..contact([0, 1], 0.0, ContactSurface::Free)
    }];
    plan.stages[0].initial_velocities = vec![(1, Vec3::new(0.0, 0.0, -SPEED))];
    plan
}

#[derive(Default)]
struct Outcome {
    /// Greatest overlap, m.
    overlap: f64,
    /// First and last time of a force, s.
    touched: Option<[f64; 2]>,
    restitution: f64,
    /// Kinetic and elastic energy at the end over the first.
    kept: f64,
    motion: Vec<(f64, f64)>,
}

fn compute(h: f64, gap_check: bool) -> (Outcome, setup::Balance) {
    let mut o = Outcome::default();
    let (mut depth, mut first): (Option<Vec<f64>>, _) = (None, None);
    let balance = setup::run(plan(h, gap_check), |s: &Simulation| {
        let p = s.particles();
        // Distance of each particle to the face that touches, at the start.
        let places = p.places_by_id();
        let depth = depth.get_or_insert_with(|| {
            let of = |place: &Option<u32>| {
                let i = place.expect("all are there") as usize;
                let z = p.position.at(i).z;
                if p.body[i] == 0 {
                    FLOOR - z
                } else {
                    z - FLOOR - GAP * h
                }
            };
            places.iter().map(of).collect()
        });
        let (mut top, mut bottom) = (f64::NEG_INFINITY, f64::INFINITY);
        for i in 0..p.len() {
            let (z, d) = (p.position.at(i).z, depth[p.id[i] as usize]);
            // Of the outermost layer only: farther in, strain moves the face that is inferred.
            if d < 0.3 * h {
                if p.body[i] == 0 {
                    top = top.max(z + d);
                } else {
                    bottom = bottom.min(z - d);
                }
            }
        }
        o.overlap = o.overlap.max(top - bottom);
        if s.contact_tallies()[0].normal.length() > 1e-9 {
            let touched = o.touched.get_or_insert([s.time(); 2]);
            touched[1] = s.time();
        }
        let v = mean(s, 1, |i| p.velocity.at(i)).z / SPEED;
        o.motion.push((s.time(), v));
        o.restitution = v;
        let e = s.energies();
        let first = *first.get_or_insert(e.kinetic);
        o.kept = (e.kinetic + e.elastic) / first;
    });
    (o, balance)
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "gap_check",
            "h_m",
            "overlap_over_h",
            "restitution",
            "energy_kept_%",
            "first_force_late_by_h",
            "touch_s",
            "exact_s",
            "contact_%",
            "numerical_%",
            "residual",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "A block falls flat on a floor",
        "time, s",
        "block's velocity over v",
    );
    for gap_check in [true, false] {
        for n in fidelity.pick(vec![4, 8, 16], vec![4, 8, 16, 32]) {
            let h = HEIGHT / f64::from(n);
            let (o, balance) = compute(h, gap_check);
            let [first, last] = o.touched.expect("the block falls on the floor");
            let late = SPEED * first / h - GAP;
            let word = if gap_check { "on" } else { "off" };
            report.table.row(&[
                &word,
                &h,
                &format!("{:.4}", o.overlap / h),
                &format!("{:.4}", o.restitution),
                &format!("{:.2}", 100.0 * o.kept),
                &format!("{late:.3}"),
                &format!("{:.5}", last - first),
                &format!("{:.5}", touch()),
                &format!("{:.3}", 100.0 * balance.contact),
                &format!("{:.3}", 100.0 * balance.numerical),
                &format!("{:.1e}", balance.residual),
            ]);
            let name = format!("gap check {word}; h = {h} m");
            let mut check = |what: &str, value: f64, limit: f64| {
                report.check(format!("{name}: {what}"), value, limit);
            };
            check("greatest overlap over h", o.overlap / h, 0.05);
            check("residual of the ledger", balance.residual, 1e-6);
            // Without the gap check coarse meshes have more; it is in the table.
            if gap_check {
                check("absolute numerical terms", balance.numerical, 0.05);
            }
            plot.line(format!("gap check {word}, h = {h} m"), o.motion);
        }
    }
    report.plots.push(("drop".to_owned(), plot));
    report
}
