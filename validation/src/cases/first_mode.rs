//! Ten periods of a column's first mode, fixed base, free top, undamped.
//!
//! Exact: v = v₀ sin(πz/2L) cos ωt with ω = πc/(2L); the greatest strain is v₀/c. Kinetic and
//! stored energy add up to what was there at the start. Allowed drift over ten periods: 0.5 % at
//! a strain of 1e-4, 5 % at 4 %.

use crate::setup;
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::{Simulation, Vec3};

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "elements",
            "strain",
            "drift_%",
            "period_error_%",
            "numerical_%",
            "residual",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "Energy of the first mode",
        "periods",
        "kinetic and stored energy over the first",
    );
    for n in fidelity.pick(vec![20], vec![10, 20, 40]) {
        for (strain, limit) in [(1e-4, 5e-3), (0.04, 0.05)] {
            let mode = Mode::run(n, strain);
            report.table.row(&[
                &n,
                &strain,
                &format!("{:.3}", 100.0 * mode.drift),
                &format!("{:.3}", 100.0 * mode.period_error),
                &format!("{:.4}", 100.0 * mode.balance.numerical),
                &format!("{:.1e}", mode.balance.residual),
            ]);
            if n == 20 {
                report.check(
                    format!("{n} elements; strain {strain}: drift of the energy over ten periods"),
                    mode.drift,
                    limit,
                );
            }
            report.check(
                format!("{n} elements; strain {strain}: residual of the ledger"),
                mode.balance.residual,
                1e-6,
            );
            if strain < 0.01 {
                report.check(
                    format!("{n} elements; strain {strain}: absolute numerical terms"),
                    mode.balance.numerical,
                    1e-2,
                );
            }
            plot.line(format!("{n} elements, strain {strain}"), mode.energy);
        }
    }
    report.plots.push(("first-mode".to_owned(), plot));
    report
}

struct Mode {
    drift: f64,
    period_error: f64,
    balance: setup::Balance,
    energy: Vec<(f64, f64)>,
}

impl Mode {
    fn run(n: usize, strain: f64) -> Mode {
        let material = setup::papers_soil();
        let c = (1e5 / material.density).sqrt();
        let period = 4.0 / c;
        let mut plan = setup::column_with_room(n, material, 10.0 * period);
        plan.title = format!("{n} elements, strain {strain}");
        setup::bound(&mut plan, &["z-min"], setup::FIXED);
        let mut simulation = Simulation::new(plan).unwrap_or_else(|e| panic!("{e}"));
        let shape = |x: Vec3| (std::f64::consts::FRAC_PI_2 * x.z).sin();
        simulation
            .set_velocity(|x| Vec3::new(0.0, 0.0, strain * c * shape(x)))
            .unwrap_or_else(|e| panic!("{e}"));
        let first = simulation.energies().kinetic;
        let (mut energy, mut amplitude, mut drift) = (Vec::new(), Vec::new(), 0.0f64);
        let balance = setup::run_from(simulation, |s| {
            let e = s.energies();
            let whole = (e.kinetic + e.elastic) / first;
            drift = drift.max((whole - 1.0).abs());
            energy.push((s.time() / period, whole));
            let p = s.particles();
            let top: f64 = (0..p.len())
                .map(|i| p.displacement(i).z * shape(p.position.at(i)))
                .sum();
            amplitude.push((s.time(), top));
        });
        Mode {
            drift,
            period_error: zero_crossings(&amplitude) / period - 1.0,
            balance,
            energy,
        }
    }
}

/// Period from the upward zero crossings of a signal.
pub fn zero_crossings(signal: &[(f64, f64)]) -> f64 {
    let up: Vec<f64> = signal
        .windows(2)
        .filter(|w| w[0].1 < 0.0 && w[1].1 >= 0.0)
        .map(|w| w[0].0 - w[0].1 * (w[1].0 - w[0].0) / (w[1].1 - w[0].1))
        .collect();
    (up[up.len() - 1] - up[0]) / (up.len() - 1) as f64
}
