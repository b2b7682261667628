//! Gravity that is suddenly there: an elastic column on a rigid base.
//!
//! With κ_k = (2k+1)π/(2L) and ω_k = c κ_k the exact displacement (down positive) of the top is
//! Σ_k (−1)^k 2 ρ g / (E_c L κ_k³) (1 − cos ω_k t): between 0 and twice the static ρ g L²/(2 E_c),
//! period 4L/c. Damped, it comes to rest at the static value, with σ_zz = −ρ g (L − z).

use crate::setup;
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::plan::{Quantity, Stage, Until};
use moldwarp::{Plan, Simulation, Vec3};

/// Stiff, so that strains (1.8e-5 at rest) stay where the exact solution is linear.
const E: f64 = 1e9;
const DENSITY: f64 = 1800.0;
const G: f64 = 9.81;
const STATIC: f64 = DENSITY * G / (2.0 * E);

fn plan(n: usize, end: f64) -> Plan {
    let mut plan = setup::column(setup::column_mesh(n), setup::elastic(E, 0.0, DENSITY), end);
    plan.title = format!("{n} elements, undamped");
    plan.gravity = Vec3::new(0.0, 0.0, -G);
    setup::bound(&mut plan, &["z-min"], setup::FIXED);
    setup::probe(&mut plan, "top", "z-max", &[Quantity::Displacement]);
    plan
}

fn wave_speed() -> f64 {
    (E / DENSITY).sqrt()
}

/// Exact downward displacement of the point that the top's particles stand for: depth `d` below
/// the top, m.
fn exact(t: f64, d: f64) -> f64 {
    (0..400)
        .map(|k| {
            let kappa = (f64::from(k) + 0.5) * std::f64::consts::PI;
            let amplitude = 2.0 * DENSITY * G / (E * kappa.powi(3));
            amplitude * (kappa * (1.0 - d)).sin() * (1.0 - (wave_speed() * kappa * t).cos())
        })
        .sum()
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "elements",
            "error_%_of_amplitude",
            "period_error_%",
            "numerical_%",
            "residual",
        ]),
        ..Report::default()
    };
    let period = 4.0 / wave_speed();
    let mut last = f64::INFINITY;
    for n in fidelity.pick(vec![10, 20], vec![10, 20, 40, 80]) {
        let mut times = Vec::new();
        let depth = mean_depth_of_top(&plan(n, period));
        let balance = setup::run(plan(n, 5.0 * period), |s| {
            times.push((s.time(), -setup::value(s, "top.displacement.z")));
        });
        let error = times
            .iter()
            .map(|&(t, u)| (u - exact(t, depth)).abs())
            .fold(0.0, f64::max)
            / (2.0 * STATIC);
        let measured = measured_period(&times);
        report.table.row(&[
            &n,
            &format!("{:.3}", 100.0 * error),
            &format!("{:.3}", 100.0 * (measured / period - 1.0)),
            &format!("{:.4}", 100.0 * balance.numerical),
            &format!("{:.1e}", balance.residual),
        ]);
        report.check(
            format!("{n} elements: error over twice the static settlement; five periods"),
            error,
            if n > 15 { 0.02 } else { 0.04 },
        );
        report.check(
            format!("{n} elements: error relative to the coarser mesh's"),
            error / last,
            1.0,
        );
        report.check(
            format!("{n} elements: error of the period 4L/c"),
            (measured / period - 1.0).abs(),
            0.005,
        );
        report.check(
            format!("{n} elements: residual of the ledger"),
            balance.residual,
            1e-6,
        );
        report.check(
            format!("{n} elements: absolute numerical terms"),
            balance.numerical,
            1e-2,
        );
        last = error;
        if n == fidelity.pick(20, 40) {
            let mut plot = Plot::new(
                "Column under sudden gravity",
                "time over 4L/c",
                "top's displacement over ρgL²/(2E)",
            );
            plot.line(
                format!("moldwarp, {n} elements"),
                times
                    .iter()
                    .map(|&(t, u)| (t / period, u / STATIC))
                    .collect(),
            );
            plot.dashed(
                "exact",
                times
                    .iter()
                    .map(|&(t, _)| (t / period, exact(t, depth) / STATIC))
                    .collect(),
            );
            report.plots.push(("gravity-column".to_owned(), plot));
        }
    }
    at_rest(&mut report, fidelity);
    report
}

/// Mean depth of the particles that the top's probe looks at.
fn mean_depth_of_top(plan: &Plan) -> f64 {
    let mut plan = plan.clone();
    plan.probes[0].quantities = vec![Quantity::Position];
    let simulation = Simulation::new(plan).unwrap_or_else(|e| panic!("{e}"));
    1.0 - setup::value(&simulation, "top.position.z")
}

/// Mean distance of the maxima, after the first, each found by a parabola through three values.
fn measured_period(points: &[(f64, f64)]) -> f64 {
    // Only the great maxima: a dip under the static value must lie between two.
    let (mut maxima, mut best): (Vec<f64>, Option<usize>) = (Vec::new(), None);
    for i in 1..points.len() - 1 {
        if points[i].1 > 1.5 * STATIC && best.is_none_or(|b| points[i].1 > points[b].1) {
            best = Some(i);
        }
        if points[i].1 < 0.5 * STATIC {
            maxima.extend(best.take().map(|b| centre(points, b)));
        }
    }
    (maxima[maxima.len() - 1] - maxima[0]) / (maxima.len() - 1) as f64
}

/// Middle between the crossings of 1.5 times the static value on both sides of a maximum.
fn centre(points: &[(f64, f64)], top: usize) -> f64 {
    let level = 1.5 * STATIC;
    let crossing = |a: (f64, f64), b: (f64, f64)| a.0 + (b.0 - a.0) * (level - a.1) / (b.1 - a.1);
    let before = (1..=top)
        .rev()
        .find(|&i| points[i - 1].1 < level)
        .unwrap_or(1);
    let after = (top..points.len() - 1)
        .find(|&i| points[i + 1].1 < level)
        .unwrap_or(points.len() - 2);
    0.5 * (crossing(points[before - 1], points[before])
        + crossing(points[after], points[after + 1]))
}

fn at_rest(report: &mut Report, fidelity: Fidelity) {
    let n = fidelity.pick(10, 40);
    let period = 4.0 / wave_speed();
    let mut plan = plan(n, 25.0 * period);
    plan.title = format!("{n} elements, damped");
    let stage = Stage {
        damping: Some(0.4),
        ..plan.stages[0].clone()
    };
    let free = Stage::new("free", Until::Steps(10));
    plan.stages = vec![stage, free];
    let (mut worst, mut energies) = (0.0f64, None);
    setup::run(plan, |s| {
        if s.stage() == 2 {
            let p = s.particles();
            for (x, stress) in p.position.iter().zip(p.stress.iter()) {
                worst = worst.max((stress[2] + DENSITY * G * (1.0 - x.z)).abs());
            }
            energies = Some(s.energies());
        }
    });
    let e = energies.expect("the last stage ends");
    report.check(
        format!("damped; {n} elements: greatest error of a particle's σ_zz over ρgL"),
        worst / (DENSITY * G),
        0.5 / n as f64,
    );
    report.check(
        format!("damped; {n} elements: kinetic energy over the stored"),
        e.kinetic / e.elastic,
        1e-6,
    );
}
