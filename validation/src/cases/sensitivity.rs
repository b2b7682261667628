//! The sensitivity study that the paper's Section 7 speaks of: α and δ.
//!
//! The reflected share of the first wave's energy is ((α − 1)/(α + 1))², the final displacement
//! p δ/E_c, the creep of a dashpot alone p/(α Z). Computed here: greatest displacement of the
//! bottom and what is still moving at 1.6 s, for α = 1, 1.75, 2.5 and δ = 0.1, 0.5, 5 m.

use super::absorbing_column::{history, plan};
use crate::exact::column::{Bottom, Column};
use crate::{Fidelity, Plot, Report, Table};

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "alpha",
            "delta_m",
            "reflected_energy_%",
            "peak_mm",
            "exact_peak_mm",
            "final_mm",
            "range_after_8T_mm",
            "error_%_of_pL/E",
        ]),
        ..Report::default()
    };
    let end = 1.6;
    let n = fidelity.pick(20, 80);
    let mut plot = Plot::new(
        &format!("Bottom of the layer for several α and δ, {n} elements over the height"),
        "time (s)",
        "downward displacement (mm)",
    );
    for alpha in [1.0f64, 1.75, 2.5] {
        for virtual_thickness in [0.1, 0.5, 5.0] {
            let bottom = Bottom::DashpotAndSpring {
                alpha,
                virtual_thickness,
            };
            let column = Column::of_the_paper(bottom);
            let exact = column.solve(end);
            let (h, _) = history(plan(n, bottom, 1e3, end));
            let peak = h.bottom.iter().copied().fold(0.0, f64::max);
            let error = h
                .time
                .iter()
                .zip(&h.bottom)
                .map(|(&t, u)| (u - exact.bottom_displacement(t)).abs())
                .fold(0.0, f64::max)
                / (column.load * column.thickness / column.modulus);
            let late: Vec<f64> = h
                .time
                .iter()
                .zip(&h.bottom)
                .filter(|(t, _)| **t > 8.0 * column.travel_time())
                .map(|(_, &u)| u)
                .collect();
            let range = late.iter().copied().fold(f64::NEG_INFINITY, f64::max)
                - late.iter().copied().fold(f64::INFINITY, f64::min);
            report.table.row(&[
                &alpha,
                &virtual_thickness,
                &format!("{:.1}", 100.0 * ((alpha - 1.0) / (alpha + 1.0)).powi(2)),
                &format!("{:.3}", 1e3 * peak),
                &format!("{:.3}", 1e3 * exact.bottom_peak(end)),
                &format!(
                    "{:.3}",
                    1e3 * column.load * virtual_thickness / column.modulus
                ),
                &format!("{:.3}", 1e3 * range),
                &format!("{:.2}", 100.0 * error),
            ]);
            report.check(
                format!("alpha {alpha}; delta {virtual_thickness} m: error over p L/E_c = 10 mm"),
                error,
                fidelity.pick(0.03, 0.015),
            );
            if virtual_thickness < 1.0 {
                let points = h
                    .time
                    .iter()
                    .zip(&h.bottom)
                    .map(|(&t, u)| (t, 1e3 * u))
                    .collect();
                plot.line(format!("α = {alpha}, δ = {virtual_thickness} m"), points);
            }
        }
    }
    report.plots.push(("sensitivity".to_owned(), plot));
    report
}
