//! Compression of a laterally confined column far beyond small strains.
//!
//! The rate law dσ = E_c dε with dε = dl/l gives σ = E_c ln(l/l₀). Under a dead load p on the same
//! area the column comes to rest at l = l₀ exp(−p/E_c): 0.6065 l₀ for p = E_c/2. Every layer is
//! compressed alike; the particles of the loaded element, whose mesh is no longer full, are
//! reported by themselves.
//!
//! Only the state at rest is compared: during the ramp local damping holds the column back, the
//! more the finer the mesh, and the plotted curves lie above the exact one until the end.

use crate::setup;
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::Vec3;
use moldwarp::boundary::Function;
use moldwarp::plan::Quantity;

const E: f64 = 1e5;
const LOAD: f64 = 0.5 * E;

/// What the column has come to.
struct Rest {
    /// Present over first height of the particles from the column's middle half, mean.
    stretch: f64,
    /// Their mean pressure over the load.
    pressure: f64,
    /// The same as `stretch` for the particles next to the loaded surface.
    top: f64,
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "elements",
            "stretch",
            "exact",
            "error_%",
            "error_of_mean_stress_%",
            "error_next_to_the_load_%",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "Oedometer to 40 % strain",
        "load over E_c",
        "height over the first",
    );
    let exact = (-LOAD / E).exp();
    for n in fidelity.pick(vec![10, 20], vec![10, 20, 40, 80]) {
        let mut curve = Vec::new();
        let rest = compress(n, &mut curve);
        let (error, stress_error) = (rest.stretch / exact - 1.0, rest.pressure - 1.0);
        report.table.row(&[
            &n,
            &format!("{:.5}", rest.stretch),
            &format!("{exact:.5}"),
            &format!("{:.3}", 100.0 * error),
            &format!("{:.3}", 100.0 * stress_error),
            &format!("{:.3}", 100.0 * (rest.top / exact - 1.0)),
        ]);
        report.check(
            format!("{n} elements: error of the middle half's stretch"),
            error.abs(),
            2e-3,
        );
        report.check(
            format!("{n} elements: error of the middle half's mean stress"),
            stress_error.abs(),
            2e-3,
        );
        plot.line(format!("moldwarp, {n} elements"), curve);
    }
    let loads = (0..=50).map(|i| 0.01 * f64::from(i));
    plot.dashed(
        "exact, exp(−p/E_c)",
        loads.map(|p| (p, (-p).exp())).collect(),
    );
    report.plots.push(("oedometer".to_owned(), plot));
    report
}

/// Loads a column of n elements by a slow ramp and lets it come to rest.
fn compress(n: usize, curve: &mut Vec<(f64, f64)>) -> Rest {
    let material = setup::elastic(E, 0.0, 1800.0);
    let ramp = 40.0 / (E / material.density).sqrt();
    let mut plan = setup::column(setup::column_mesh(n), material, 1.5 * ramp);
    plan.title = format!("{n} elements");
    plan.numerics.damping = 0.2;
    setup::bound(&mut plan, &["z-min"], setup::FIXED);
    setup::load(&mut plan, "z-max", Vec3::new(0.0, 0.0, -LOAD));
    plan.loads[0].function = Function::Ramp { duration: ramp };
    setup::probe(&mut plan, "top", "z-max", &[Quantity::Position]);
    let mut rest = Rest {
        stretch: 0.0,
        pressure: 0.0,
        top: 1.0,
    };
    let mut first = None;
    setup::run(plan, |s| {
        let top = setup::value(s, "top.position.z");
        rest.top = top / *first.get_or_insert(top);
        let p = s.particles();
        let start = |i: usize| p.position.at(i).z - p.displacement(i).z;
        let middle: Vec<usize> = (0..p.len())
            .filter(|&i| (start(i) - 0.5).abs() < 0.25)
            .collect();
        let mean = |value: &dyn Fn(usize) -> f64| {
            middle.iter().map(|&i| value(i)).sum::<f64>() / middle.len() as f64
        };
        rest.stretch = mean(&|i| p.position.at(i).z / start(i));
        rest.pressure = mean(&|i| -p.stress.at(i)[2] / LOAD);
        curve.push(((s.time() / ramp).min(1.0) * LOAD / E, rest.stretch));
    });
    rest
}
