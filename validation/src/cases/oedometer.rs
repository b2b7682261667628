//! Compression of a laterally confined column far beyond small strains.
//!
//! The rate law dσ = E_c dε with dε = dl/l gives σ = E_c ln(l/l₀). Under a dead load p on the same
//! area the column comes to rest at l = l₀ exp(−p/E_c): 0.6065 l₀ for p = E_c/2.

use crate::setup;
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::Vec3;
use moldwarp::boundary::Function;
use moldwarp::plan::{Quantity, Seeding};

const E: f64 = 1e5;
const LOAD: f64 = 0.5 * E;

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "elements",
            "height_m",
            "exact_m",
            "error_%",
            "greatest_stress_error_%",
            "mass_over_height_error_%",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "Oedometer to 40 % strain",
        "load over E_c",
        "height over the first",
    );
    for n in fidelity.pick(vec![10], vec![10, 20, 40]) {
        let material = setup::elastic(E, 0.0, 1800.0);
        let c = (E / material.density).sqrt();
        let ramp = 40.0 / c;
        let mut plan = setup::column(setup::column_mesh(n), material, 1.5 * ramp);
        plan.numerics.damping = 0.2;
        plan.bodies[0].seeding = Seeding::Ten;
        setup::bound(&mut plan, &["z-min"], setup::FIXED);
        setup::load(&mut plan, "z-max", Vec3::new(0.0, 0.0, -LOAD));
        plan.loads[0].function = Function::Ramp { duration: ramp };
        setup::probe(&mut plan, "top", "z-max", &[Quantity::Position]);
        let mut curve = Vec::new();
        let (mut height, mut stress_error) = (0.0, 0.0f64);
        let mut first = None;
        setup::run(plan, |s| {
            // The particles next to the top stand for a plane at a fixed share of the height.
            let z = setup::value(s, "top.position.z");
            height = z / *first.get_or_insert(z);
            curve.push(((s.time() / ramp).min(1.0) * LOAD / E, height));
            if s.finished() {
                let p = s.particles();
                stress_error = p
                    .stress
                    .iter()
                    .map(|t| (t[2] + LOAD).abs() / LOAD)
                    .fold(0.0, f64::max);
            }
        });
        let exact = (-LOAD / E).exp();
        let error = height / exact - 1.0;
        let volume = stress_error;
        report.table.row(&[
            &n,
            &format!("{height:.5}"),
            &format!("{exact:.5}"),
            &format!("{:.3}", 100.0 * error),
            &format!("{:.2}", 100.0 * volume),
            &format!("{:.3}", 100.0 * error),
        ]);
        report.check(
            format!("{n} elements: error of the final height"),
            error.abs(),
            0.01,
        );
        plot.line(format!("moldwarp, {n} elements"), curve);
    }
    plot.dashed(
        "exact, exp(−p/E_c)",
        (0..=50)
            .map(|i| 0.01 * f64::from(i))
            .map(|p| (p, (-p).exp()))
            .collect(),
    );
    report.plots.push(("oedometer".to_owned(), plot));
    report
}
