//! Rigid rough footings on weightless clay (Tresca).
//!
//! Prandtl's bearing capacity of a strip is (2 + π) c_u = 5.1416 c_u over the width B, that of a
//! circle 6.05 c_u (Eason and Shield 1960). Half the strip is computed in plane strain, of the circle
//! a sector of 20°: the mesh nodes under it move down slowly, with local damping 0.5, until a small
//! share of B. The soil is stiff for its strength, so that it fails before particles cross elements:
//! the nodes of the footing stay where they are while the soil goes down, and the row of elements
//! under it would lose particles. It is nearly incompressible (ν = 0.49) and takes any tension.
//! Elements are cubes of h = B/(2n) near the footing, n over its half width; away from it they grow.
//! The motion under the footing fades over the element beside it, so that it acts half an element
//! wider (a circle as a polygon of 18 sides).

use crate::setup::{self, growing};
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::boundary::Function;
use moldwarp::mesh::{CylinderSector, Split};
use moldwarp::plan::{BoundaryKind, Place, Quantity, Region, Smoothing};
use moldwarp::{Mesh, Vec3};

/// Undrained shear strength, Pa, and half width, m.
const STRENGTH: f64 = 1e3;
const HALF: f64 = 1.0;
const DENSITY: f64 = 2000.0;
const POISSON: f64 = 0.49;

/// How a footing is pushed: G over c_u, speed over that of the shear wave, settlement over B = 2 m
/// at the end. Particles under it cross elements at 0.138 h.
#[derive(Clone, Copy)]
struct Push {
    stiffness: f64,
    speed: f64,
    settlement: f64,
}

const ON_STRIP: Push = Push {
    stiffness: 4e3,
    speed: 2e-4,
    settlement: 0.0013,
};
const ON_CIRCLE: Push = Push {
    stiffness: 3e3,
    speed: 3e-4,
    settlement: 0.0016,
};

/// Bearing capacities over c_u.
const STRIP: f64 = 2.0 + std::f64::consts::PI;
const CIRCLE: f64 = 6.05;

/// A mesh with the surface `footing` at z = 0, the soil's highest and lowest corner, and the
/// footing's area, m².
struct Ground {
    mesh: Mesh,
    corners: [Vec3; 2],
    area: f64,
}

/// Heights of nodes for `n` elements over a metre: fine near z = 0, two rows of room above.
fn heights(n: usize) -> Vec<f64> {
    let h = HALF / n as f64;
    let mut z = growing(0.0, h, n, 1.15, -2.5 * HALF);
    z.reverse();
    z.extend([h, 2.0 * h]);
    z
}

/// Distances of nodes from the footing's middle.
fn distances(n: usize) -> Vec<f64> {
    growing(0.0, HALF / n as f64, n + n / 2, 1.15, 6.0 * HALF)
}

fn strip(n: usize) -> Ground {
    let h = HALF / n as f64;
    let (x, z) = (distances(n), heights(n));
    let corners = [Vec3::new(0.0, 0.0, z[0]), Vec3::new(x[x.len() - 1], h, 0.0)];
    let mesh = setup::graded_box([x, vec![0.0, h], z]);
    Ground {
        mesh: setup::with_surface_at(&mesh, "footing", 0.0, |x| x.x < HALF + 1e-9),
        corners,
        area: HALF * h,
    }
}

/// A sector of 20° with one cell around.
fn circle(n: usize) -> Ground {
    let (r, z) = (distances(n), heights(n));
    let (rings, layers) = (r.len() - 1, z.len() - 1);
    let angle = 20f64.to_radians();
    let sector = CylinderSector {
        outer: vec![[rings as f64, 0.0], [rings as f64, layers as f64]],
        inner: None,
        angle,
        radial: rings,
        around: 1,
        vertical: vec![layers],
        radial_grading: 1.0,
        vertical_grading: vec![1.0],
        split: Split::Six,
    };
    let unit = sector.mesh().expect("a cylinder is a good mesh");
    let mesh = setup::moved(&unit, |x| {
        let ring = x.truncate().length();
        let scale = if ring > 0.0 {
            r[ring.round() as usize] / ring
        } else {
            0.0
        };
        Vec3::new(x.x * scale, x.y * scale, z[x.z.round() as usize])
    });
    let most = r[rings];
    Ground {
        mesh: setup::with_surface_at(&mesh, "footing", 0.0, |x| {
            x.truncate().length() < HALF + 1e-9
        }),
        corners: [Vec3::new(0.0, 0.0, z[0]), Vec3::new(most, most, 0.0)],
        area: 0.5 * HALF * HALF * angle.sin(),
    }
}

/// (settlement over B, mean stress over c_u) of a footing that is pushed down.
fn press(ground: Ground, push: Push, sides: &[&str], smoothing: Smoothing) -> Vec<(f64, f64)> {
    let shear = push.stiffness * STRENGTH;
    let soil = setup::mohr_coulomb(
        (2.0 * shear * (1.0 + POISSON), POISSON),
        STRENGTH,
        0.0,
        Some(1e3 * STRENGTH),
        DENSITY,
    );
    let speed = push.speed * (shear / DENSITY).sqrt();
    let ramp = 0.1 * push.settlement * 2.0 * HALF / speed;
    let end = push.settlement * 2.0 * HALF / speed + 0.5 * ramp;
    let mut plan = setup::free_body(ground.mesh, soil, end);
    let [min, max] = ground.corners;
    plan.bodies[0].place = Place::Region(Region::Box { min, max });
    setup::bound(&mut plan, &["z-min"], setup::FIXED);
    setup::bound(&mut plan, sides, BoundaryKind::Roller);
    let kind = BoundaryKind::Prescribed {
        velocity: [Some(0.0), Some(0.0), Some(-speed)],
        function: Function::Ramp { duration: ramp },
    };
    setup::bound(&mut plan, &["footing"], kind);
    let quantities = [Quantity::Reaction, Quantity::Displacement];
    setup::probe(&mut plan, "footing", "footing", &quantities);
    let elements = plan.mesh.tets.len();
    plan.title = format!("{elements} elements, smoothing {smoothing:?}").to_lowercase();
    plan.numerics.damping = 0.5;
    plan.numerics.smoothing = smoothing;
    let mut curve = Vec::new();
    let mut sum = (0.0, 0);
    setup::run(plan, |s| {
        sum.0 -= setup::value(s, "footing.reaction.z") / (ground.area * STRENGTH);
        sum.1 += 1;
        if s.steps() % 20 == 0 {
            let settled = -setup::value(s, "footing.displacement.z") / (2.0 * HALF);
            curve.push((settled, sum.0 / f64::from(sum.1)));
            sum = (0.0, 0);
        }
    });
    curve
}

/// A strip footing, with and without smoothing.
pub fn run_strip(fidelity: Fidelity) -> Report {
    let smoothed = fidelity.pick(vec![4, 8], vec![6, 12, 24, 32]);
    let plain = fidelity.pick(vec![4, 8], vec![6, 12, 24]);
    let mut footing = Footing::new(
        "Rigid strip footing on Tresca soil",
        ON_STRIP,
        STRIP,
        "2 + π",
    );
    for &n in &smoothed {
        footing.smoothed(
            n,
            press(strip(n), ON_STRIP, &setup::SIDES, Smoothing::Strain),
        );
    }
    footing.limit(fidelity.pick(0.12, 0.05));
    for &n in &plain {
        footing.plain(n, press(strip(n), ON_STRIP, &setup::SIDES, Smoothing::Off));
    }
    footing.finish("strip-footing")
}

/// A circular footing, with smoothing.
pub fn run_circle(fidelity: Fidelity) -> Report {
    let mut footing = Footing::new(
        "Rigid circular footing on Tresca soil",
        ON_CIRCLE,
        CIRCLE,
        "6.05",
    );
    for n in fidelity.pick(vec![3, 6], vec![6, 12, 24]) {
        let sides = ["theta-min", "theta-max", "r-max"];
        footing.smoothed(n, press(circle(n), ON_CIRCLE, &sides, Smoothing::Strain));
    }
    footing.limit(fidelity.pick(0.25, 0.1));
    footing.finish("circular-footing")
}

/// What is made of the load curves.
struct Footing {
    settlement: f64,
    report: Report,
    plot: Plot,
    exact: f64,
    label: &'static str,
    /// Last error, and the number of elements it was found with.
    last: (f64, usize),
}

impl Footing {
    fn new(title: &str, push: Push, exact: f64, label: &'static str) -> Footing {
        let columns = [
            "elements",
            "smoothing",
            "load_over_c_u",
            "over_exact_%",
            "last_rise_%",
        ];
        Footing {
            settlement: push.settlement,
            report: Report {
                table: Table::new(&columns),
                ..Report::default()
            },
            plot: Plot::new(title, "settlement over B", "mean pressure over c_u"),
            exact,
            label,
            last: (f64::INFINITY, 0),
        }
    }

    /// Error at the end, and the rise of the load before.
    fn row(&mut self, n: usize, name: &str, curve: Vec<(f64, f64)>) -> (f64, f64) {
        let mean =
            |from: f64, to: f64| mean(&curve, [from, to].map(|share| share * self.settlement));
        let (end, before) = (mean(0.9, 1.1), mean(0.7, 0.9));
        let (error, rise) = (end / self.exact - 1.0, end / before - 1.0);
        self.report.table.row(&[
            &n,
            &name,
            &format!("{end:.4}"),
            &format!("{:.2}", 100.0 * error),
            &format!("{:.2}", 100.0 * rise),
        ]);
        self.plot
            .line(format!("{n} elements, smoothing {name}"), curve);
        (error, rise)
    }

    /// Approached from above under refinement.
    fn smoothed(&mut self, n: usize, curve: Vec<(f64, f64)>) {
        let (error, _) = self.row(n, "on", curve);
        let text = format!("{n} elements: error over the coarser mesh's");
        self.report.check(text, error / self.last.0, 0.9);
        self.report
            .check(format!("{n} elements: below the exact load"), -error, 0.01);
        self.last = (error, n);
    }

    /// The most that the finest mesh may be above the exact load.
    fn limit(&mut self, limit: f64) {
        let (error, n) = self.last;
        self.report
            .check(format!("{n} elements: above the exact load"), error, limit);
    }

    /// Without smoothing the load is far too high and climbs.
    fn plain(&mut self, n: usize, curve: Vec<(f64, f64)>) {
        let (error, rise) = self.row(n, "off", curve);
        let text = format!("{n} elements without smoothing: 20 % over the exact load; less this");
        self.report.check(text, 0.2 - error, 0.0);
        let text = format!("{n} elements without smoothing: the load climbs; minus its rise");
        self.report.check(text, -rise, 0.0);
    }

    fn finish(mut self, file: &str) -> Report {
        let ends = [(0.0, self.exact), (self.settlement, self.exact)];
        self.plot.dashed(self.label, ends.to_vec());
        self.report.plots.push((file.to_owned(), self.plot));
        self.report
    }
}

/// Mean load between two settlements.
fn mean(curve: &[(f64, f64)], [from, to]: [f64; 2]) -> f64 {
    let part = curve.iter().filter(|p| p.0 >= from && p.0 <= to);
    let values: Vec<f64> = part.map(|p| p.1).collect();
    values.iter().sum::<f64>() / values.len() as f64
}
