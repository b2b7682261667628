//! A rigid rough strip footing on weightless clay (Tresca).
//!
//! Prandtl's bearing capacity is (2 + π) c_u = 5.1416 c_u over the width B. Half the footing is
//! computed in plane strain: the mesh nodes under it move down at a speed that rises to 3e-4 of
//! the shear wave's, with local damping 0.5, until the settlement is 0.16 % of B. The soil is stiff
//! (G = 3000 c_u), so that it fails before particles cross elements: the nodes of the footing stay
//! where they are while the soil goes down, and grains that rose beside its edge into elements above
//! would stick to it. It is nearly incompressible (ν = 0.49) and takes any tension. Elements are
//! cubes of h = B/(2n) near the footing, n over its half width; away from it they grow. The motion
//! under the footing fades over the element beside it, so that it acts half an element wider.

use crate::setup::{self, growing};
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::Vec3;
use moldwarp::boundary::Function;
use moldwarp::plan::{BoundaryKind, Place, Quantity, Region, Smoothing};

/// Undrained shear strength, Pa, shear modulus, Pa, and half width, m.
const STRENGTH: f64 = 1e3;
const SHEAR: f64 = 3e3 * STRENGTH;
const HALF: f64 = 1.0;
const DENSITY: f64 = 2000.0;
const POISSON: f64 = 0.49;
/// Settlement over B = 2 m at the end.
const SETTLEMENT: f64 = 0.0016;

const EXACT: f64 = 2.0 + std::f64::consts::PI;

/// (settlement over B, mean stress over c_u) of a footing on `n` elements over its half width.
fn load(n: usize, smoothing: Smoothing) -> Vec<(f64, f64)> {
    let h = HALF / n as f64;
    let depth = growing(0.0, h, n, 1.15, -2.5 * HALF);
    let bottom = depth[depth.len() - 1];
    let mut z: Vec<f64> = depth.into_iter().rev().collect();
    z.extend([h, 2.0 * h]);
    let x = growing(0.0, h, n + n / 2, 1.15, 6.0 * HALF);
    let right = x[x.len() - 1];
    let mesh = setup::graded_box([x, vec![0.0, h], z]);
    let mesh = setup::with_surface_at(&mesh, "footing", 0.0, |x| x.x < HALF + 1e-9);
    let soil = setup::mohr_coulomb(
        (2.0 * SHEAR * (1.0 + POISSON), POISSON),
        STRENGTH,
        0.0,
        Some(1e3 * STRENGTH),
        DENSITY,
    );
    let speed = 3e-4 * (SHEAR / DENSITY).sqrt();
    let ramp = 0.1 * SETTLEMENT * 2.0 * HALF / speed;
    let end = SETTLEMENT * 2.0 * HALF / speed + 0.5 * ramp;
    let mut plan = setup::free_body(mesh, soil, end);
    plan.bodies[0].place = Place::Region(Region::Box {
        min: Vec3::new(0.0, 0.0, bottom),
        max: Vec3::new(right, h, 0.0),
    });
    setup::bound(&mut plan, &["z-min"], setup::FIXED);
    setup::bound(&mut plan, &setup::SIDES, BoundaryKind::Roller);
    let kind = BoundaryKind::Prescribed {
        velocity: [Some(0.0), None, Some(-speed)],
        function: Function::Ramp { duration: ramp },
    };
    setup::bound(&mut plan, &["footing"], kind);
    let quantities = [Quantity::Reaction, Quantity::Displacement];
    setup::probe(&mut plan, "footing", "footing", &quantities);
    plan.numerics.damping = 0.5;
    plan.numerics.smoothing = smoothing;
    let mut curve = Vec::new();
    let area = HALF * h;
    let mut sum = (0.0, 0);
    setup::run(plan, |s| {
        sum.0 -= setup::value(s, "footing.reaction.z") / (area * STRENGTH);
        sum.1 += 1;
        if s.steps() % 20 == 0 {
            let settled = -setup::value(s, "footing.displacement.z") / (2.0 * HALF);
            curve.push((settled, sum.0 / f64::from(sum.1)));
            sum = (0.0, 0);
        }
    });
    curve
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "elements",
            "smoothing",
            "load_over_c_u",
            "over_exact_%",
            "last_rise_%",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "Rigid strip footing on Tresca soil",
        "settlement over B",
        "mean pressure over c_u",
    );
    let smoothed = fidelity.pick(vec![4, 8], vec![6, 12, 24, 48]);
    let plain = fidelity.pick(vec![4, 8], vec![6, 12, 24]);
    let mut coarser = f64::INFINITY;
    for (n, smoothing) in smoothed
        .iter()
        .map(|&n| (n, Smoothing::Strain))
        .chain(plain.iter().map(|&n| (n, Smoothing::Off)))
    {
        let name = if smoothing == Smoothing::Off {
            "off"
        } else {
            "on"
        };
        let curve = load(n, smoothing);
        let (end, before) = (mean(&curve, 0.9, 1.1), mean(&curve, 0.7, 0.9));
        let (error, rise) = (end / EXACT - 1.0, end / before - 1.0);
        report.table.row(&[
            &n,
            &name,
            &format!("{end:.4}"),
            &format!("{:.2}", 100.0 * error),
            &format!("{:.2}", 100.0 * rise),
        ]);
        if smoothing == Smoothing::Off {
            report.check(
                format!("{n} elements without smoothing: 20 % over the exact load; less this"),
                0.2 - error,
                0.0,
            );
            report.check(
                format!("{n} elements without smoothing: the load climbs; minus its rise"),
                -rise,
                0.0,
            );
        } else {
            report.check(
                format!("{n} elements: error over the coarser mesh's"),
                error / coarser,
                0.9,
            );
            report.check(format!("{n} elements: below the exact load"), -error, 0.01);
            coarser = error;
            if n == smoothed[smoothed.len() - 1] {
                report.check(
                    format!("{n} elements: above the exact load"),
                    error,
                    fidelity.pick(0.12, 0.05),
                );
            }
        }
        plot.line(format!("{n} elements, smoothing {name}"), curve);
    }
    plot.dashed("2 + π", vec![(0.0, EXACT), (SETTLEMENT, EXACT)]);
    report.plots.push(("strip-footing".to_owned(), plot));
    report
}

/// Mean load between two settlements, as shares of the last.
fn mean(curve: &[(f64, f64)], from: f64, to: f64) -> f64 {
    let part = curve
        .iter()
        .filter(|p| p.0 >= from * SETTLEMENT && p.0 <= to * SETTLEMENT);
    let values: Vec<f64> = part.map(|p| p.1).collect();
    values.iter().sum::<f64>() / values.len() as f64
}
