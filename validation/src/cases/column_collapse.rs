//! Collapse of a cylinder of dry sand on a rough base, against experiments.
//!
//! Lube, Huppert, Sparks and Hallworth (2004, J. Fluid Mech. 508) found for columns of radius r₀ and
//! height a r₀, whatever the grains, a run-out (r∞ − r₀)/r₀ of 1.24 a for a < 1.7 and 1.6 √a above.
//! A sector of 20° with one cell around and n elements over r₀ is computed: φ = 30°, no cohesion, no
//! dilation, the base held, nothing calibrated and nothing damped. Gravity is there from the start.
//! Run-out is the radius that 99 % of the mass lies within; the largest of a grain stands beside it. On coarse meshes few
//! grains make the front, and a change of the last digits moves it by several per cent: there the figure is the mean of runs
//! whose gravity differs by 1e-13.

use crate::setup;
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::mesh::{CylinderSector, Split};
use moldwarp::plan::{BoundaryKind, Place, Region};
use moldwarp::{Plan, Simulation, Vec3};

const GRAVITY: f64 = 9.81;
const DENSITY: f64 = 1600.0;
/// From one run of the same column to the next.
const PERTURBATION: f64 = 1e-13;
/// Width of the rings of a deposit's profile, m.
const RING: f64 = 0.05;

/// Run-out over r₀ in the experiments.
fn measured(a: f64) -> f64 {
    if a < 1.7 { 1.24 * a } else { 1.6 * a.sqrt() }
}

/// A column of radius 1 m and height `a` in a mesh with room, run to `end`, for the `run`-th time.
fn plan(a: f64, n: usize, end: f64, run: u8) -> Plan {
    let rings = ((1.0 + 1.5 * measured(a)) * n as f64).ceil();
    let layers = ((a + 0.25) * n as f64).ceil();
    let sector = CylinderSector {
        outer: vec![
            [rings / n as f64, 0.0],
            [rings / n as f64, layers / n as f64],
        ],
        inner: None,
        angle: 20f64.to_radians(),
        radial: rings as usize,
        around: 1,
        vertical: vec![layers as usize],
        radial_grading: 1.0,
        vertical_grading: vec![1.0],
        split: Split::Six,
    };
    let mesh = sector.mesh().expect("a cylinder is a good mesh");
    let sand = setup::mohr_coulomb((5e6, 0.3), 0.0, 30.0, None, DENSITY);
    let mut plan = setup::free_body(mesh, sand, end);
    plan.title = format!("a = {a}, {n} elements");
    plan.bodies[0].place = Place::Region(Region::Cylinder {
        start: Vec3::ZERO,
        end: Vec3::new(0.0, 0.0, a),
        radius: 1.0,
    });
    let gravity = GRAVITY * (1.0 + f64::from(run) * PERTURBATION);
    plan.gravity = Vec3::new(0.0, 0.0, -gravity);
    setup::bound(&mut plan, &["z-min"], setup::FIXED);
    let sides = ["theta-min", "theta-max", "r-max"];
    setup::bound(&mut plan, &sides, BoundaryKind::Roller);
    plan
}

/// The deposit.
struct Deposit {
    /// Radius that 99 % of the mass lies within, and the largest, m.
    radius: [f64; 2],
    /// Largest height of grains within a quarter of the first radius, m.
    height: f64,
    /// Change of the soil's volume, without and with what has opened in tension.
    volume: [f64; 2],
    /// Radius and largest height in rings of 0.05 m.
    profile: Vec<(f64, f64)>,
}

fn deposit(s: &Simulation) -> Deposit {
    let p = s.particles();
    let radius = |i: usize| p.position.at(i).truncate().length();
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&i, &j| radius(i).total_cmp(&radius(j)));
    let whole: f64 = p.mass.iter().sum();
    let mut sum = 0.0;
    let quantile = order.iter().find(|&&i| {
        sum += p.mass[i];
        sum >= 0.99 * whole
    });
    let soil = &s.plan().materials[0].model;
    let first: f64 = p.initial_volume.iter().sum();
    let volume = |solid: bool| {
        let share = |i: usize| {
            if solid {
                soil.solid_share(&p.state.at(i))
            } else {
                1.0
            }
        };
        (0..p.len()).map(|i| p.volume[i] * share(i)).sum::<f64>() / first - 1.0
    };
    let mut profile: Vec<(f64, f64)> = Vec::new();
    for &i in &order {
        let ring = (radius(i) / RING).floor() as usize;
        while profile.len() <= ring {
            profile.push((RING * (profile.len() as f64 + 0.5), 0.0));
        }
        profile[ring].1 = profile[ring].1.max(p.position.at(i).z);
    }
    Deposit {
        radius: [
            radius(*quantile.unwrap_or(&0)),
            radius(order[order.len() - 1]),
        ],
        height: (0..p.len())
            .filter(|&i| radius(i) < 0.25)
            .map(|i| p.position.at(i).z)
            .fold(0.0, f64::max),
        volume: [volume(true), volume(false)],
        profile,
    }
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "a",
            "elements",
            "particles",
            "run_out",
            "experiments",
            "difference_%",
            "run_out_of_the_farthest",
            "height",
            "volume_change_%",
            "with_opening_%",
            "grid_kinetic_%",
            "numerical_%",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "Columns of dry sand collapse",
        "time over √(a r₀/g)",
        "run-out over r₀ (99 % of the mass)",
    );
    let mut deposits = Plot::new(
        "Deposits: largest height of a grain in rings",
        "distance from the axis over r₀",
        "height over r₀",
    );
    for a in fidelity.pick(vec![1.0], vec![0.5, 1.0, 2.0]) {
        let unit = (a / GRAVITY).sqrt();
        for n in fidelity.pick(vec![6, 8], vec![12, 24]) {
            let mut curve = Vec::new();
            let mut last = None;
            let mut kinetic = (0.0f64, 0.0);
            let mut next = 0.0;
            let balance = setup::run(plan(a, n, 6.0 * unit, 0), |s| {
                let grid = s.energies().kinetic_grid;
                kinetic = (kinetic.0.max(grid), grid);
                if s.time() >= next || s.finished() {
                    next += 0.1 * unit;
                    let d = deposit(s);
                    curve.push((s.time() / unit, d.radius[0] - 1.0));
                    last = Some((d, s.particles().len()));
                }
            });
            let (d, particles) = last.expect("a run has an end");
            let [run_out, farthest] = d.radius.map(|r| r - 1.0);
            let difference = |radius: f64| (radius - 1.0) / measured(a) - 1.0;
            let mut differences = vec![difference(d.radius[0])];
            for again in 1..fidelity.pick(8, 1) {
                setup::run(plan(a, n, 6.0 * unit, again), |s| {
                    if s.finished() {
                        differences.push(difference(deposit(s).radius[0]));
                    }
                });
            }
            let difference = differences.iter().sum::<f64>() / differences.len() as f64;
            report.table.row(&[
                &a,
                &n,
                &particles,
                &format!("{run_out:.3}"),
                &format!("{:.3}", measured(a)),
                &format!("{:.1}", 100.0 * difference),
                &format!("{farthest:.3}"),
                &format!("{:.3}", d.height),
                &format!("{:.2}", 100.0 * d.volume[0]),
                &format!("{:.2}", 100.0 * d.volume[1]),
                &format!("{:.3}", 100.0 * kinetic.1 / kinetic.0),
                &format!("{:.1}", 100.0 * balance.numerical),
            ]);
            report.check(
                format!("a = {a}; {n} elements: run-out against the experiments"),
                difference.abs(),
                if n == 12 { 0.4 } else { 0.2 },
            );
            report.check(
                format!("a = {a}; {n} elements: change of the soil's volume"),
                d.volume[0].abs(),
                0.02,
            );
            plot.line(format!("a = {a}, {n} elements"), curve);
            deposits.line(format!("a = {a}, {n} elements"), d.profile);
        }
        plot.dashed(
            format!("experiments, a = {a}"),
            vec![(0.0, measured(a)), (6.0, measured(a))],
        );
    }
    report.plots.push(("column-collapse".to_owned(), plot));
    (report.plots).push(("column-collapse-deposits".to_owned(), deposits));
    report
}
