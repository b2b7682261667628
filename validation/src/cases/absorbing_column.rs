//! The paper's Section 7, on three kinds of bottom and under refinement.
//!
//! Exact: `exact::column`. Expected at the default Courant number, as the greatest error of the
//! bottom's displacement over its peak of 6.811 mm: falling with refinement, at most 3.0, 1.5,
//! 1.3, 0.8 and 0.7 % for 10 to 160 elements over the height.

use crate::exact::column::{Bottom, Column};
use crate::setup::{self, Balance};
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::plan::{BoundaryKind, Quantity};
use moldwarp::{Plan, Simulation, Vec3};

const SPRING: Bottom = Bottom::DashpotAndSpring {
    alpha: 2.5,
    virtual_thickness: 0.5,
};
const DASHPOT: Bottom = Bottom::Dashpot { alpha: 2.5 };
/// Greatest error allowed, by elements over the height.
const LIMITS: [(usize, f64); 5] = [
    (10, 3.0e-2),
    (20, 1.5e-2),
    (40, 1.3e-2),
    (80, 0.8e-2),
    (160, 0.7e-2),
];

/// Downward displacements (m) of bottom and top, and pressure at the bottom (Pa), over time.
#[derive(Clone, Debug, Default)]
pub struct History {
    pub time: Vec<f64>,
    pub bottom: Vec<f64>,
    pub top: Vec<f64>,
    pub pressure: Vec<f64>,
}

/// The plan of the column of n elements' height with a load in Pa.
pub fn plan(n: usize, bottom: Bottom, load: f64, end: f64) -> Plan {
    let mut plan = setup::column(setup::column_mesh(n), setup::papers_soil(), end);
    plan.title = format!("{}, {n} elements, {load} Pa, {end} s", name(bottom));
    setup::bound(&mut plan, &["z-min"], boundary(bottom));
    setup::load(&mut plan, "z-max", Vec3::new(0.0, 0.0, -load));
    setup::probe(
        &mut plan,
        "bottom",
        "z-min",
        &[Quantity::Displacement, Quantity::Stress],
    );
    setup::probe(&mut plan, "top", "z-max", &[Quantity::Displacement]);
    plan
}

fn name(bottom: Bottom) -> String {
    match bottom {
        Bottom::Rigid => "rigid".to_owned(),
        Bottom::Dashpot { alpha } => format!("dashpot, α = {alpha}"),
        Bottom::DashpotAndSpring {
            alpha,
            virtual_thickness,
        } => format!("dashpot and spring, α = {alpha}, δ = {virtual_thickness} m"),
    }
}

fn boundary(bottom: Bottom) -> BoundaryKind {
    match bottom {
        Bottom::Rigid => setup::FIXED,
        Bottom::Dashpot { alpha } => BoundaryKind::Absorbing {
            alpha: [alpha; 2],
            virtual_thickness: None,
        },
        Bottom::DashpotAndSpring {
            alpha,
            virtual_thickness,
        } => BoundaryKind::Absorbing {
            alpha: [alpha; 2],
            virtual_thickness: Some([virtual_thickness; 2]),
        },
    }
}

/// Runs a column and keeps its history.
pub fn history(plan: Plan) -> (History, Balance) {
    let mut history = History::default();
    let mut values = Vec::new();
    let balance = setup::run(plan, |s: &Simulation| {
        values.clear();
        s.probe_values(&mut values);
        history.time.push(s.time());
        history.bottom.push(-values[2]);
        history.pressure.push(-values[5]);
        history.top.push(-values[11]);
    });
    (history, balance)
}

fn worst(time: &[f64], values: &[f64], exact: impl Fn(f64) -> f64) -> f64 {
    time.iter()
        .zip(values)
        .map(|(&t, v)| (v - exact(t)).abs())
        .fold(0.0, f64::max)
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "bottom",
            "elements",
            "error_bottom_%",
            "error_top_%",
            "numerical_%",
            "residual",
        ]),
        ..Report::default()
    };
    let count = fidelity.pick(3, 5);
    for &(n, limit) in &LIMITS[..count] {
        let error = refine(&mut report, n, SPRING, fidelity);
        report.check(
            format!("spring; {n} elements: error of the bottom's displacement over its peak"),
            error,
            limit,
        );
    }
    for (n, _) in LIMITS[..count].iter().filter(|l| l.0 <= 80) {
        refine(&mut report, *n, DASHPOT, fidelity);
        refine(&mut report, *n, Bottom::Rigid, fidelity);
    }
    small_strain(&mut report, fidelity);
    long_run(&mut report, fidelity);
    report
}

/// One row of the table; the relative error of the bottom's displacement.
fn refine(report: &mut Report, n: usize, bottom: Bottom, fidelity: Fidelity) -> f64 {
    let end = 1.6;
    let exact = Column::of_the_paper(bottom).solve(end);
    let (h, balance) = history(plan(n, bottom, 1e3, end));
    let peak = exact.bottom_peak(end);
    let error = match bottom {
        Bottom::Rigid => 0.0,
        _ => worst(&h.time, &h.bottom, |t| exact.bottom_displacement(t)) / peak,
    };
    let top = worst(&h.time, &h.top, |t| exact.top_displacement(t)) / 0.02;
    let name = match bottom {
        Bottom::Rigid => "rigid",
        Bottom::Dashpot { .. } => "dashpot",
        Bottom::DashpotAndSpring { .. } => "spring",
    };
    report.table.row(&[
        &name,
        &n,
        &format!("{:.3}", 100.0 * error),
        &format!("{:.3}", 100.0 * top),
        &format!("{:.3}", 100.0 * balance.numerical),
        &format!("{:.1e}", balance.residual),
    ]);
    report.check(
        format!("{name}; {n} elements: residual of the ledger"),
        balance.residual,
        1e-6,
    );
    if n == fidelity.pick(20, 80) {
        report.plots.push((
            format!("absorbing-column-{name}"),
            draw(name, n, &h, bottom, end),
        ));
    }
    error
}

fn draw(name: &str, n: usize, h: &History, bottom: Bottom, end: f64) -> Plot {
    let exact = Column::of_the_paper(bottom).solve(end);
    let instants: Vec<f64> = (0..=1600).map(|i| end * f64::from(i) / 1600.0).collect();
    let title = format!("Suddenly loaded layer, bottom: {name}, {n} elements over the height");
    if bottom == Bottom::Rigid {
        let mut plot = Plot::new(&title, "time (s)", "pressure at the bottom (kPa)");
        plot.line(
            "moldwarp",
            h.time
                .iter()
                .zip(&h.pressure)
                .map(|(&t, p)| (t, p / 1e3))
                .collect(),
        );
        plot.dashed(
            "exact",
            instants
                .iter()
                .map(|&t| (t, exact.bottom_pressure(t) / 1e3))
                .collect(),
        );
        return plot;
    }
    let mut plot = Plot::new(
        &title,
        "time (s)",
        "downward displacement of the bottom (mm)",
    );
    plot.line(
        "moldwarp",
        h.time
            .iter()
            .zip(&h.bottom)
            .map(|(&t, u)| (t, 1e3 * u))
            .collect(),
    );
    plot.dashed(
        "exact",
        instants
            .iter()
            .map(|&t| (t, 1e3 * exact.bottom_displacement(t)))
            .collect(),
    );
    plot
}

/// At a thousandth of the load nothing crosses elements: the numerical terms must be small.
fn small_strain(report: &mut Report, fidelity: Fidelity) {
    for bottom in [SPRING, DASHPOT] {
        let (_, balance) = history(plan(fidelity.pick(20, 40), bottom, 1.0, 1.6));
        let what =
            format!("{bottom:?}; 1 Pa: absolute numerical terms over the energy turned over");
        report.check(what, balance.numerical, 1e-2);
    }
}

/// The mean over the last 4T of six seconds must be p δ / E_c = 5 mm.
fn long_run(report: &mut Report, fidelity: Fidelity) {
    let end = 6.0;
    let (h, _) = history(plan(fidelity.pick(20, 40), SPRING, 1e3, end));
    let from = end - 4.0 * Column::of_the_paper(SPRING).travel_time();
    let (mut area, mut length) = (0.0, 0.0);
    for i in 1..h.time.len() {
        if h.time[i - 1] >= from {
            let dt = h.time[i] - h.time[i - 1];
            area += 0.5 * dt * (h.bottom[i] + h.bottom[i - 1]);
            length += dt;
        }
    }
    report.check(
        "6 s: mean bottom displacement of the last 4T from 5 mm (mm)",
        (1e3 * area / length - 5.0).abs(),
        0.02,
    );
}
