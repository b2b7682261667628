//! An elastic thick-walled cylinder under internal pressure, in plane strain, as a sector of 20°.
//!
//! Lamé's solution, tension positive, p inside at r = a, free outside at r = b:
//!
//! ```text
//! u_r = (1 + ν) p a²/(E (b² − a²)) [(1 − 2ν) r + b²/r]
//! σ_r = k (1 − b²/r²),  σ_θ = k (1 + b²/r²),  σ_z = 2ν k,  k = p a²/(b² − a²)
//! ```
//!
//! Cells grow outwards with the radius and are about as long as wide (n along the radius, n/4
//! around, one along z). Circles are polygons, an error of second order. The body fills the mesh:
//! its free outer surface moves 1e-5 of an element. The error of displacements should fall with
//! the square of n and that of stresses, one value per element or the mean of its neighbours, with
//! n or faster.

use crate::setup::{self, Balance};
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::boundary::Function;
use moldwarp::mesh::{CylinderSector, Split};
use moldwarp::plan::*;
use moldwarp::{Plan, Simulation};

/// Radii, m, Young's modulus and pressure, Pa, density, kg/m³.
const INNER: f64 = 1.0;
const OUTER: f64 = 4.0;
const YOUNG: f64 = 1e7;
const PRESSURE: f64 = 100.0;
const DENSITY: f64 = 2000.0;

/// A way to compute it.
#[derive(Clone, Copy)]
struct Way {
    split: Split,
    poisson: f64,
    smoothing: Smoothing,
}

impl Way {
    /// Local damping. With 0.7 and ν = 0.3 finer meshes come to rest slowly: |F| is then mostly that
    /// of short waves, against which the breathing of the ring creeps. With 0.3 and ν = 0.49, where
    /// the breathing is the slowest motion by far, it still swings at the end.
    fn damping(self) -> f64 {
        if self.poisson < 0.4 { 0.3 } else { 0.7 }
    }

    fn name(self) -> String {
        let split = match self.split {
            Split::Six => "six",
            Split::Symmetric => "symmetric",
        };
        let smoothing = self.smoothing_name();
        format!("{split}, ν = {}, smoothing {smoothing}", self.poisson)
    }

    fn smoothing_name(self) -> &'static str {
        match self.smoothing {
            Smoothing::Off => "off",
            _ => "on",
        }
    }
}

/// Displacement along r and σ_r, σ_θ, σ_z at radius r.
fn exact(poisson: f64, r: f64) -> (f64, [f64; 3]) {
    let k = PRESSURE * INNER * INNER / (OUTER * OUTER - INNER * INNER);
    let hole = OUTER * OUTER / (r * r);
    let u = (1.0 + poisson) * k / YOUNG * ((1.0 - 2.0 * poisson) * r + hole * r);
    (u, [k * (1.0 - hole), k * (1.0 + hole), 2.0 * poisson * k])
}

fn plan(way: Way, n: usize) -> Plan {
    let height = 1.4 * INNER / n as f64;
    let sector = CylinderSector {
        outer: vec![[OUTER, 0.0], [OUTER, height]],
        inner: Some(vec![[INNER, 0.0], [INNER, height]]),
        angle: 20f64.to_radians(),
        radial: n,
        around: n / 4,
        vertical: vec![1],
        // As many equal factors as there are steps from cell to cell: sizes go with r.
        radial_grading: (OUTER / INNER).powf(1.0 - 1.0 / n as f64),
        vertical_grading: vec![1.0],
        split: way.split,
    };
    let mesh = sector.mesh().expect("a sector is a good mesh");
    let soil = setup::elastic(YOUNG, way.poisson, DENSITY);
    // The slowest motion is the breathing of the ring, with about the shear wave's speed.
    let shear_speed = (YOUNG / (2.0 * (1.0 + way.poisson)) / DENSITY).sqrt();
    let ramp = 2.0 * OUTER / shear_speed;
    let mut plan = setup::free_body(mesh, soil, 5.0 * ramp);
    plan.title = format!("{}, {n} cells", way.name());
    let sides = ["theta-min", "theta-max", "z-min", "z-max"];
    setup::bound(&mut plan, &sides, BoundaryKind::Roller);
    plan.loads.push(Load {
        name: "pressure".to_owned(),
        surfaces: vec![plan.mesh.surface("r-min").expect("a hollow sector has it")],
        body: 0,
        kind: LoadKind::Pressure(PRESSURE),
        function: Function::Ramp { duration: ramp },
    });
    plan.numerics.damping = way.damping();
    plan.numerics.smoothing = way.smoothing;
    plan
}

/// What the cylinder has come to.
#[derive(Default)]
struct Rest {
    /// √(Σ V |error|² / Σ V |exact|²) of displacements and of stresses.
    displacement: f64,
    stress: f64,
    /// √(Σ V error² / Σ V) of the mean stress over p.
    mean_stress: f64,
    /// Greatest difference of u_r between particles of the same r and z, over the greatest u_r.
    spread: f64,
    /// Kinetic energy on the grid over the elastic.
    motion: f64,
    /// r, σ_r/p, σ_θ/p of all particles.
    profile: Vec<[f64; 3]>,
}

fn judge(s: &Simulation, poisson: f64) -> Rest {
    let p = s.particles();
    let (mut u_sum, mut s_sum, mut m_sum) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    let (mut profile, mut rings) = (Vec::new(), Vec::new());
    for i in 0..p.len() {
        let (x, u, v) = (
            p.position.at(i) - p.displacement(i),
            p.displacement(i),
            p.volume[i],
        );
        let r = x.x.hypot(x.y);
        let (c, d) = (x.x / r, x.y / r);
        let (u_r, u_t) = (c * u.x + d * u.y, c * u.y - d * u.x);
        let [xx, yy, zz, xy, ..] = p.stress.at(i);
        let radial = c * c * xx + d * d * yy + 2.0 * c * d * xy;
        let hoop = xx + yy - radial;
        let shear = c * d * (yy - xx) + (c * c - d * d) * xy;
        let (u_e, [r_e, t_e, z_e]) = exact(poisson, r);
        u_sum[0] += v * ((u_r - u_e).powi(2) + u_t * u_t);
        u_sum[1] += v * u_e * u_e;
        let off = [radial - r_e, hoop - t_e, zz - z_e];
        let square = |a: [f64; 3]| a.map(|a| a * a).iter().sum::<f64>();
        s_sum[0] += v * (square(off) + 2.0 * shear * shear);
        s_sum[1] += v * square([r_e, t_e, z_e]);
        m_sum[0] += v * off.iter().sum::<f64>().powi(2);
        m_sum[1] += v;
        profile.push([r, radial / PRESSURE, hoop / PRESSURE]);
        let key = [r, x.z].map(|a| (a * 1e9).round() as i64);
        rings.push((key, u_r));
    }
    let relative = |a: [f64; 2]| (a[0] / a[1]).sqrt();
    Rest {
        displacement: relative(u_sum),
        stress: relative(s_sum),
        mean_stress: (m_sum[0] / m_sum[1]).sqrt() / 3.0 / PRESSURE,
        spread: spread(rings),
        motion: s.energies().kinetic_grid / s.energies().elastic,
        profile,
    }
}

/// Greatest difference of values with the same key, over the greatest value.
fn spread(mut values: Vec<([i64; 2], f64)>) -> f64 {
    values.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let rings = values.chunk_by(|a, b| a.0 == b.0);
    let widest = rings.map(|ring| ring[ring.len() - 1].1 - ring[0].1);
    let greatest = values.iter().map(|v| v.1.abs()).fold(0.0, f64::max);
    widest.fold(0.0, f64::max) / greatest
}

/// Means of the profile over `count` equal intervals of the radius.
fn means(profile: &[[f64; 3]], of: usize, count: usize) -> Vec<(f64, f64)> {
    let mut sums = vec![[0.0; 3]; count];
    for p in profile {
        let at = (p[0] - INNER) / (OUTER - INNER) * count as f64;
        let sum = &mut sums[(at as usize).min(count - 1)];
        *sum = [sum[0] + 1.0, sum[1] + p[0], sum[2] + p[of]];
    }
    let full = sums.iter().filter(|s| s[0] > 0.0);
    full.map(|s| (s[1] / s[0], s[2] / s[0])).collect()
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "split",
            "poisson",
            "smoothing",
            "cells",
            "displacement_error_%",
            "order",
            "stress_error_%",
            "order",
            "mean_stress_error_%_of_p",
            "spread_over_angle",
            "grid_kinetic_over_elastic",
            "residual",
        ]),
        ..Report::default()
    };
    let mut errors = Plot::new(
        "Thick-walled cylinder: error of displacements",
        "log10 of the cells along the radius",
        "log10 of the relative error",
    );
    let way = |split, poisson, smoothing| Way {
        split,
        poisson,
        smoothing,
    };
    let (mut finest, mut nearly_incompressible) = (Vec::new(), Vec::new());
    let (on, off) = (Smoothing::Strain, Smoothing::Off);
    let (few, many) = (vec![8, 16], vec![8, 16, 32]);
    let meshes = fidelity.pick(&few, &many);
    for (w, meshes) in [
        (
            way(Split::Symmetric, 0.3, on),
            &fidelity.pick(vec![4, 8], vec![4, 8, 16, 32]),
        ),
        (way(Split::Six, 0.3, on), meshes),
        (way(Split::Six, 0.49, on), meshes),
        (way(Split::Six, 0.49, off), meshes),
    ] {
        let mut curve = Vec::new();
        let mut last: Option<Rest> = None;
        for &n in meshes {
            let (rest, balance) = compute(w, n);
            note(&mut report, w, n, &rest, balance, last.as_ref());
            curve.push(((n as f64).log10(), rest.displacement.log10()));
            if w.split == Split::Symmetric {
                finest.clone_from(&rest.profile);
            }
            last = Some(rest);
        }
        let last = last.expect("every way has its meshes").displacement;
        if w.poisson == 0.49 {
            nearly_incompressible.push(last);
        }
        errors.line(w.name(), curve);
    }
    // Without smoothing the elements lock.
    let gain = nearly_incompressible[0] / nearly_incompressible[1];
    let what = "finest mesh; ν = 0.49: error of displacements with smoothing over that without";
    report.check(what, gain, 0.5);
    report
        .plots
        .push(("thick-cylinder".to_owned(), profile(&finest)));
    report
        .plots
        .push(("thick-cylinder-errors".to_owned(), errors));
    report
}

fn compute(way: Way, n: usize) -> (Rest, Balance) {
    let mut rest = Rest::default();
    let balance = setup::run(plan(way, n), |s| {
        if s.finished() {
            rest = judge(s, way.poisson);
        }
    });
    (rest, balance)
}

fn note(report: &mut Report, w: Way, n: usize, rest: &Rest, balance: Balance, last: Option<&Rest>) {
    let name = w.name();
    let order = |of: fn(&Rest) -> f64| {
        last.map_or("".to_owned(), |l| {
            format!("{:.2}", (of(l) / of(rest)).log2())
        })
    };
    report.table.row(&[
        &name.split(',').next().unwrap_or_default(),
        &w.poisson,
        &w.smoothing_name(),
        &n,
        &format!("{:.3}", 100.0 * rest.displacement),
        &order(|r| r.displacement),
        &format!("{:.3}", 100.0 * rest.stress),
        &order(|r| r.stress),
        &format!("{:.3}", 100.0 * rest.mean_stress),
        &format!("{:.1e}", rest.spread),
        &format!("{:.1e}", rest.motion),
        &format!("{:.1e}", balance.residual),
    ]);
    let mut check =
        |what, value, limit| report.check(format!("{name}, {n} cells: {what}"), value, limit);
    check(
        "kinetic energy of the grid over the elastic",
        rest.motion,
        1e-8,
    );
    check("residual of the ledger", balance.residual, 1e-9);
    if w.split == Split::Symmetric {
        check("difference of u_r over the angle", rest.spread, 1e-6);
    }
    if let (Some(last), Smoothing::Strain) = (last, w.smoothing) {
        let displacement = (last.displacement / rest.displacement).log2();
        check("2 less the order of displacements", 2.0 - displacement, 0.3);
        let stress = (last.stress / rest.stress).log2();
        check("1 less the order of stresses", 1.0 - stress, 0.5);
    }
}

/// The stresses along the radius beside Lamé's.
fn profile(finest: &[[f64; 3]]) -> Plot {
    let mut plot = Plot::new(
        "Thick-walled cylinder under internal pressure",
        "r, m",
        "stress over p",
    );
    plot.line("σ_r, moldwarp", means(finest, 1, 60));
    plot.line("σ_θ, moldwarp", means(finest, 2, 60));
    let radii = || (0..=60).map(|i| INNER + (OUTER - INNER) * f64::from(i) / 60.0);
    for (name, of) in [("σ_r, exact", 0), ("σ_θ, exact", 1)] {
        plot.dashed(
            name,
            radii()
                .map(|r| (r, exact(0.3, r).1[of] / PRESSURE))
                .collect(),
        );
    }
    plot
}
