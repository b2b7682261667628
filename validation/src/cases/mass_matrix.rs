//! What the lumped mass matrix does to the first mode (Section 2 of the paper, after Burgess et
//! al. 1992).
//!
//! Particles with the mode's velocities are mapped to the nodes and back. Lumped, v_i =
//! Σ m_p v_p N_i / m_i: of the kinetic energy of a wave with k h = π/(2n) a share (k h)²/6 · 2 is
//! lost in one mapping there and back, since the average takes (k h)²/6 of the amplitude. The
//! consistent matrix, M v = Σ m_p v_p N, loses only what linear shape functions cannot show,
//! (k h)⁴/720. FLIP never maps velocities back, only accelerations, so that a run loses neither:
//! its error is the period's, (k h)²/8 for plain lumping, taken back by the correction of the
//! remap (`step::remap`).

use super::first_mode::zero_crossings;
use crate::setup;
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::plan::MassMatrix;
use moldwarp::{Simulation, Vec3};

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "elements",
            "lost_in_one_mapping_lumped_%",
            "lost_in_one_mapping_consistent_%",
            "lost_in_ten_periods_lumped_%",
            "lost_in_ten_periods_corrected_%",
            "period_error_lumped_%",
            "period_error_corrected_%",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "First mode: error of the period",
        "elements over the height",
        "error (%)",
    );
    let mut errors = [Vec::new(), Vec::new()];
    for n in fidelity.pick(vec![5, 10], vec![5, 10, 20, 40]) {
        let [lumped, consistent] = lost_in_mapping(n);
        let runs = [MassMatrix::Lumped, MassMatrix::Corrected].map(|mass| free_vibration(n, mass));
        let kh = std::f64::consts::FRAC_PI_2 / n as f64;
        report.table.row(&[
            &n,
            &format!("{:.4}", 100.0 * lumped),
            &format!("{:.6}", 100.0 * consistent),
            &format!("{:.4}", 100.0 * runs[0].0),
            &format!("{:.4}", 100.0 * runs[1].0),
            &format!("{:.4}", 100.0 * runs[0].1),
            &format!("{:.4}", 100.0 * runs[1].1),
        ]);
        report.check(
            format!("{n} elements: one lumped mapping against (kh)²/3; relative"),
            (lumped / (kh * kh / 3.0) - 1.0).abs(),
            0.15,
        );
        report.check(
            format!("{n} elements: the consistent matrix loses; of the lumped"),
            consistent / lumped,
            0.02,
        );
        report.check(
            format!("{n} elements: period's error; corrected over lumped"),
            (runs[1].1 / runs[0].1).abs(),
            0.5,
        );
        for (errors, run) in errors.iter_mut().zip(runs) {
            errors.push((n as f64, 100.0 * run.1));
        }
    }
    let [lumped, corrected] = errors;
    plot.line("lumped", lumped);
    plot.line("corrected", corrected);
    report.plots.push(("mass-matrix".to_owned(), plot));
    report
}

/// Loss of energy in ten periods and the relative error of the period.
fn free_vibration(n: usize, mass: MassMatrix) -> (f64, f64) {
    let material = setup::papers_soil();
    let c = (1e5 / material.density).sqrt();
    let period = 4.0 / c;
    let mut plan = setup::column_with_room(n, material, 10.0 * period);
    plan.title = format!("{n} elements, {mass:?} mass").to_lowercase();
    plan.numerics.mass = mass;
    setup::bound(&mut plan, &["z-min"], setup::FIXED);
    let mut simulation = Simulation::new(plan).unwrap_or_else(|e| panic!("{e}"));
    let shape = |x: Vec3| (std::f64::consts::FRAC_PI_2 * x.z).sin();
    simulation
        .set_velocity(|x| Vec3::new(0.0, 0.0, 1e-5 * c * shape(x)))
        .unwrap_or_else(|e| panic!("{e}"));
    let first = simulation.energies().kinetic;
    let (mut signal, mut last) = (Vec::new(), 0.0);
    setup::run_from(simulation, |s| {
        let p = s.particles();
        signal.push((
            s.time(),
            (0..p.len())
                .map(|i| p.displacement(i).z * shape(p.position.at(i)))
                .sum(),
        ));
        last = s.energies().kinetic + s.energies().elastic;
    });
    (1.0 - last / first, zero_crossings(&signal) / period - 1.0)
}

/// Share of the mode's kinetic energy that is lost when velocities are mapped to the nodes and
/// back to the particles, with the lumped and with the consistent matrix. In one dimension: nodes
/// over the height, four particles per element at Gauss points.
fn lost_in_mapping(n: usize) -> [f64; 2] {
    let gauss = [
        (0.069_431_844_202_973_71, 0.173_927_422_568_726_9),
        (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    ];
    let points: Vec<(f64, f64)> = gauss
        .iter()
        .flat_map(|&(x, w)| [(x, w), (1.0 - x, w)])
        .collect();
    let shape = |z: f64| (std::f64::consts::FRAC_PI_2 * z).sin();
    let h = 1.0 / n as f64;
    let (mut diagonal, mut upper, mut momentum) =
        (vec![0.0; n + 1], vec![0.0; n], vec![0.0; n + 1]);
    let each = |visit: &mut dyn FnMut(usize, f64, f64, f64)| {
        for e in 0..n {
            for &(x, w) in &points {
                visit(e, x, w * h, shape((e as f64 + x) * h));
            }
        }
    };
    let mut energy = 0.0;
    each(&mut |e, x, m, v| {
        let (a, b) = (1.0 - x, x);
        diagonal[e] += m * a * a;
        diagonal[e + 1] += m * b * b;
        upper[e] += m * a * b;
        momentum[e] += m * a * v;
        momentum[e + 1] += m * b * v;
        energy += m * v * v;
    });
    let lumped: Vec<f64> = (0..=n)
        .map(|i| {
            let neighbours = [i.checked_sub(1), (i < n).then_some(i)];
            let mass = diagonal[i]
                + neighbours
                    .into_iter()
                    .flatten()
                    .map(|k| upper[k])
                    .sum::<f64>();
            momentum[i] / mass
        })
        .collect();
    let consistent = thomas(&diagonal, &upper, &momentum);
    [lumped, consistent].map(|mut nodes| {
        nodes[0] = 0.0;
        let mut back = 0.0;
        each(&mut |e, x, m, _| back += m * ((1.0 - x) * nodes[e] + x * nodes[e + 1]).powi(2));
        1.0 - back / energy
    })
}

/// Solves a symmetric tridiagonal system.
fn thomas(diagonal: &[f64], upper: &[f64], right: &[f64]) -> Vec<f64> {
    let n = diagonal.len();
    let (mut d, mut r) = (diagonal.to_vec(), right.to_vec());
    for i in 1..n {
        let factor = upper[i - 1] / d[i - 1];
        d[i] -= factor * upper[i - 1];
        r[i] -= factor * r[i - 1];
    }
    r[n - 1] /= d[n - 1];
    for i in (0..n - 1).rev() {
        r[i] = (r[i] - upper[i] * r[i + 1]) / d[i];
    }
    r
}
