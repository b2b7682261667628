//! A shear wave that meets a dashpot.
//!
//! The column of `exact::column` with G and V_s in place of E_c and V_p: all nodes are held in y
//! and z, a shear traction acts on the top. α_s = 1 reflects nothing: the bottom moves with p/Z_s
//! from T on. α_s = 2.5 reflects (1.5/3.5)² = 18 % of the energy.

use crate::exact::column::{Bottom, Column};
use crate::setup;
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::Vec3;
use moldwarp::plan::{BoundaryKind, Quantity};

const DENSITY: f64 = 1800.0;
const G: f64 = 4e6;
const NU: f64 = 0.25;
const LOAD: f64 = 10.0;

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&["elements", "alpha_s", "error_%", "numerical_%", "residual"]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "Shear wave against a dashpot",
        "time over L/V_s",
        "displacement of the bottom over p L/G",
    );
    for n in fidelity.pick(vec![20], vec![20, 40, 80]) {
        for alpha in [1.0, 2.5] {
            let column = Column {
                load: LOAD,
                thickness: 1.0,
                modulus: G,
                density: DENSITY,
                bottom: Bottom::Dashpot { alpha },
            };
            let travel = column.travel_time();
            let end = 8.0 * travel;
            let exact = column.solve(end);
            let mut plan = setup::free_body(
                setup::column_mesh(n),
                setup::elastic(2.0 * (1.0 + NU) * G, NU, DENSITY),
                end,
            );
            plan.title = format!("{n} elements, α_s = {alpha}");
            let held = BoundaryKind::Fixed {
                directions: [false, true, true],
            };
            setup::bound(&mut plan, &[&setup::SIDES[..], &["z-max"]].concat(), held);
            setup::bound(
                &mut plan,
                &["z-min"],
                BoundaryKind::Absorbing {
                    alpha: [1.0, alpha],
                    virtual_thickness: None,
                },
            );
            setup::load(&mut plan, "z-max", Vec3::new(LOAD, 0.0, 0.0));
            setup::probe(&mut plan, "bottom", "z-min", &[Quantity::Displacement]);
            let mut curve = Vec::new();
            let balance = setup::run(plan, |s| {
                curve.push((s.time(), setup::value(s, "bottom.displacement.x")))
            });
            let whole = exact.bottom_displacement(end);
            let error = curve
                .iter()
                .map(|&(t, u)| (u - exact.bottom_displacement(t)).abs())
                .fold(0.0, f64::max)
                / whole;
            report.table.row(&[
                &n,
                &alpha,
                &format!("{:.3}", 100.0 * error),
                &format!("{:.4}", 100.0 * balance.numerical),
                &format!("{:.1e}", balance.residual),
            ]);
            report.check(
                format!("{n} elements; α_s = {alpha}: error over the displacement at 8T"),
                error,
                0.01,
            );
            report.check(
                format!("{n} elements; α_s = {alpha}: residual of the ledger"),
                balance.residual,
                1e-6,
            );
            report.check(
                format!("{n} elements; α_s = {alpha}: absolute numerical terms"),
                balance.numerical,
                1e-2,
            );
            if n == fidelity.pick(20, 80) {
                let scaled = |(t, u): (f64, f64)| (t / travel, u * G / LOAD);
                plot.line(
                    format!("moldwarp, α_s = {alpha}"),
                    curve.iter().map(|&p| scaled(p)).collect(),
                );
                plot.dashed(
                    format!("exact, α_s = {alpha}"),
                    curve
                        .iter()
                        .map(|&(t, _)| scaled((t, exact.bottom_displacement(t))))
                        .collect(),
                );
            }
        }
    }
    report.plots.push(("shear-wave".to_owned(), plot));
    report
}
