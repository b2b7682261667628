//! An elastic block on an elastic incline of 30°.
//!
//! Plane strain; z is normal to the incline, x points down it. Coulomb's friction and adhesion c_a on
//! the sole A give the block the acceleration g (sin θ − μ cos θ) − c_a A/m, and none if that is
//! negative. Gravity grows while all nodes are held along x, comes to rest, and then the block is
//! free; where it is to stick, friction alone holds it from the beginning.

use super::{body, contact};
use crate::setup::{self, Balance};
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::mesh::box_mesh;
use moldwarp::plan::*;
use moldwarp::{Plan, Vec3};

const G: f64 = 9.81;
const SLOPE: f64 = std::f64::consts::FRAC_PI_6;
const DENSITY: f64 = 2000.0;
/// Pa; with ν = 0.3.
const E: f64 = 1e6;
/// Of the block, of the base, and where the block starts, m.
const LENGTH: f64 = 0.4;
const HEIGHT: f64 = 0.2;
const BASE: f64 = 0.1;
const START: f64 = 0.2;
/// How far the block slides, m.
const WAY: f64 = 1.05;
/// 2 ξ/ω for ξ = 5 % and the block's first mode, ω = 2π c_p/(4 HEIGHT), s.
const VISCOSITY: f64 = 4.9e-4;
/// Of the stages in which gravity grows, and then comes to rest, s.
const RAMP: f64 = 0.3;
const REST: f64 = 0.3;

/// Friction and adhesion, Pa.
const SCENES: [(f64, f64); 6] = [
    (0.0, 0.0),
    (0.2, 0.0),
    (0.5, 0.0),
    (0.7, 0.0),
    (0.0, 800.0),
    (0.2, 800.0),
];

/// What is between block and base, and how it is computed.
#[derive(Clone, Copy, Debug)]
struct Scene {
    friction: f64,
    /// Pa.
    adhesion: f64,
    surface: ContactSurface,
    viscosity: f64,
    h: f64,
}

impl Scene {
    fn exact(&self) -> f64 {
        let held = self.adhesion / (DENSITY * HEIGHT);
        G * (SLOPE.sin() - self.friction * SLOPE.cos()) - held
    }

    fn sticks(&self) -> bool {
        self.exact() < 0.0
    }

    /// Time of the free motion, s: that of the way, or of a smooth incline if the block sticks.
    fn time(&self) -> f64 {
        let a = if self.sticks() {
            G * SLOPE.sin()
        } else {
            self.exact()
        };
        (2.0 * WAY / a).sqrt()
    }

    fn surface_name(&self) -> &'static str {
        match self.surface {
            ContactSurface::Aligned => "aligned",
            ContactSurface::Free => "free",
        }
    }

    fn plan(&self) -> Plan {
        let h = self.h;
        // Room for what slides faster than it should, and over the block.
        let size = Vec3::new(START + LENGTH + 1.4 * WAY, h, BASE + HEIGHT + 0.1);
        let cells = [size.x, size.y, size.z].map(|l| (l / h).ceil() as usize);
        let size = Vec3::from_array(cells.map(|n| n as f64 * h));
        let mesh = box_mesh(size, cells).expect("a box is a good mesh");
        let stone = setup::elastic(E, 0.3, DENSITY);
        let mut plan = setup::free_body(mesh, stone, self.time());
        plan.title = format!(
            "{}, μ = {}, {} Pa, viscosity {} s, h = {h} m",
            self.surface_name(),
            self.friction,
            self.adhesion,
            self.viscosity
        );
        plan.gravity = G * Vec3::new(SLOPE.sin(), 0.0, -SLOPE.cos());
        let min = Vec3::new(START, 0.0, BASE);
        let max = min + Vec3::new(LENGTH, h, HEIGHT);
        let ground = Region::Box {
            min: Vec3::ZERO,
            max: Vec3::new(size.x, h, BASE),
        };
        plan.bodies = vec![
            body("base", ground),
            body("block", Region::Box { min, max }),
        ];
        plan.contacts = vec![Contact {
            adhesion: self.adhesion,
            ..contact([0, 1], self.friction, self.surface)
        }];
        setup::bound(&mut plan, &["z-min"], setup::FIXED);
        setup::bound(&mut plan, &setup::SIDES, BoundaryKind::Roller);
        plan.probes = vec![Probe {
            name: "block".to_owned(),
            target: Target::Body(1),
            quantities: vec![Quantity::Displacement, Quantity::Velocity],
        }];
        plan.numerics.viscosity = self.viscosity;
        let grow = |over| {
            let (from, to) = (Some(0.0), 1.0);
            vec![(Level::Gravity, Ramp { from, to, over })]
        };
        let mut slide = Stage {
            reset_displacement: true,
            ..Stage::new("slide", Until::Duration(self.time()))
        };
        let ramp = if self.sticks() {
            // Ten periods of the block's and the base's shearing.
            Stage {
                levels: grow(2.0 * RAMP),
                ..Stage::new("ramp", Until::Duration(2.0 * RAMP + REST))
            }
        } else {
            // One cell is between y-min and y-max: all nodes are held.
            let directions = [true, false, false];
            let hold = BoundaryKind::Fixed { directions };
            setup::bound(&mut plan, &["y-min", "y-max"], hold);
            slide.off = vec![Item::Boundary(2)];
            Stage {
                levels: grow(RAMP),
                // Without viscosity nothing else would bring it to rest.
                damping: Some(if self.viscosity > 0.0 { 0.0 } else { 0.3 }),
                ..Stage::new("ramp", Until::Duration(RAMP + REST))
            }
        };
        slide.damping = Some(0.0);
        plan.stages = vec![ramp, slide];
        plan
    }
}

/// Of the block since it is free.
#[derive(Clone, Copy, Debug)]
struct Instant {
    time: f64,
    along: f64,
    normal: f64,
    velocity: f64,
}

struct Outcome {
    path: Vec<Instant>,
    balance: Balance,
    /// Mean over the second half of the way: acceleration, m/s², and change of the gap, m.
    acceleration: f64,
    gap: f64,
}

fn compute(scene: &Scene) -> Outcome {
    let mut path = Vec::new();
    let mut values = Vec::new();
    let balance = setup::run(scene.plan(), |s| {
        if s.stage() == 1 {
            values.clear();
            s.probe_values(&mut values);
            path.push(Instant {
                time: s.stage_time(),
                along: values[0],
                normal: values[2],
                velocity: values[3],
            });
        }
    });
    // What slides too fast must not be judged by what the end of the mesh does to it.
    path.truncate(path.partition_point(|i| i.along < 1.25 * WAY).max(2));
    let last = path[path.len() - 1];
    let middle = path.partition_point(|i| i.along < 0.5 * last.along);
    let second = &path[middle.min(path.len() - 2)..];
    Outcome {
        acceleration: slope(second),
        gap: second.iter().map(|i| i.normal).sum::<f64>() / second.len() as f64,
        balance,
        path,
    }
}

/// Acceleration as the slope of the velocity over time by least squares: the block quivers, so that
/// two instants would not do.
fn slope(path: &[Instant]) -> f64 {
    let count = path.len() as f64;
    let mean = |of: &dyn Fn(&Instant) -> f64| path.iter().map(of).sum::<f64>() / count;
    let (t, v) = (mean(&|i| i.time), mean(&|i| i.velocity));
    mean(&|i| (i.time - t) * (i.velocity - v)) / mean(&|i| (i.time - t).powi(2))
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "surface",
            "friction",
            "adhesion_Pa",
            "viscosity_s",
            "h_m",
            "exact_m/s2",
            "computed_m/s2",
            "error_%_of_g_sin",
            "way_m",
            "gap_mm",
            "gap_over_h",
            "contact_%",
            "numerical_%",
            "residual",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "A block on an incline of 30°",
        "time since it is free, s",
        "way, m",
    );
    for surface in [ContactSurface::Aligned, ContactSurface::Free] {
        for (friction, adhesion) in SCENES {
            for h in fidelity.pick(vec![0.1], vec![0.1, 0.05, 0.025]) {
                for viscosity in [VISCOSITY, 0.0] {
                    // On the finest mesh only what has a limit and slides soon: the others take many steps.
                    let limited = viscosity > 0.0;
                    let finest = h < 0.05;
                    let coarse = fidelity == Fidelity::Coarse;
                    if finest && !(limited && friction < 0.3) || coarse && viscosity == 0.0 {
                        continue;
                    }
                    let scene = Scene {
                        friction,
                        adhesion,
                        surface,
                        viscosity,
                        h,
                    };
                    let outcome = compute(&scene);
                    tabulate(&mut report, &scene, &outcome);
                    if viscosity > 0.0 {
                        check(&mut report, &scene, &outcome);
                    }
                    let drawn = fidelity.pick(0.1, 0.05);
                    let friction_only = limited && adhesion == 0.0;
                    if friction_only && h == drawn && surface == ContactSurface::Free {
                        draw(&mut plot, &scene, &outcome);
                    }
                }
            }
        }
    }
    report.plots.push(("sliding-block".to_owned(), plot));
    report
}

fn tabulate(report: &mut Report, scene: &Scene, o: &Outcome) {
    let exact = scene.exact().max(0.0);
    let error = (o.acceleration - exact) / (G * SLOPE.sin());
    let way = o.path[o.path.len() - 1].along;
    report.table.row(&[
        &scene.surface_name(),
        &scene.friction,
        &scene.adhesion,
        &format!("{:.1e}", scene.viscosity),
        &scene.h,
        &format!("{exact:.4}"),
        &format!("{:.4}", o.acceleration),
        &format!("{:.3}", 100.0 * error),
        &format!("{way:.5}"),
        &format!("{:.3}", 1e3 * o.gap),
        &format!("{:.4}", o.gap / scene.h),
        &format!("{:.3}", 100.0 * o.balance.contact),
        &format!("{:.3}", 100.0 * o.balance.numerical),
        &format!("{:.1e}", o.balance.residual),
    ]);
}

fn check(report: &mut Report, scene: &Scene, o: &Outcome) {
    let adhesion = match scene.adhesion {
        0.0 => String::new(),
        c => format!("; {c} Pa"),
    };
    let name = format!(
        "{}; μ = {}{adhesion}; h = {} m",
        scene.surface_name(),
        scene.friction,
        scene.h
    );
    let mut check = |what: &str, value: f64, limit: f64| {
        report.check(format!("{name}: {what}"), value, limit);
    };
    if scene.sticks() {
        let slip = o.path.iter().map(|i| i.along.abs()).fold(0.0, f64::max);
        let free = 0.5 * G * SLOPE.sin() * scene.time().powi(2);
        check("slip over the way of a smooth incline", slip / free, 1e-3);
    } else {
        let error = (o.acceleration - scene.exact()).abs() / (G * SLOPE.sin());
        let limit = match scene.surface {
            ContactSurface::Aligned => 0.01,
            ContactSurface::Free => 0.03,
        };
        check("error of a over g sin θ", error, limit);
    }
    // On the way blocks sink by about a millimetre, whatever h is. What slides slowly sinks most, and on
    // the finest mesh that is over the limit; the table has it.
    if scene.adhesion == 0.0 || scene.h >= 0.05 {
        check("change of the gap over h", o.gap.abs() / scene.h, 0.05);
    }
    check("residual of the ledger", o.balance.residual, 1e-6);
    check("absolute numerical terms", o.balance.numerical, 0.05);
}

fn draw(plot: &mut Plot, scene: &Scene, o: &Outcome) {
    let every = o.path.len().div_ceil(200);
    let points = |of: &dyn Fn(&Instant) -> f64| {
        let some = o.path.iter().step_by(every);
        some.map(|i| (i.time, of(i))).collect()
    };
    plot.line(
        format!("moldwarp, μ = {}", scene.friction),
        points(&|i| i.along),
    );
    let a = scene.exact().max(0.0);
    plot.dashed("exact", points(&|i| 0.5 * a * i.time * i.time));
}
