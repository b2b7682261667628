//! A mesh moves through ground at rest and must not disturb it.
//!
//! Ground of depth H is in K₀ stress, σ_zz = −γ (H − z) and σ_xx = K₀ σ_zz, under empty elements. There a
//! small body goes down by 5 D and takes the mesh along: a moving zone, 2 D wide on each side of it, reaches
//! from above it to D below the surface, where rows of elements are finest. The body never touches the
//! ground, so that the exact solution is the initial stress at every particle and no velocity at any node;
//! whatever else comes is the mesh's doing.

use crate::setup::{self, Balance};
use crate::{Fidelity, Plot, Report, Table};
use moldwarp::boundary::Function;
use moldwarp::particles::InitialStress;
use moldwarp::plan::*;
use moldwarp::{Mesh, Plan, Simulation, Vec3};

/// Diameter that lengths are told in, m.
const D: f64 = 0.3;
/// Depth and width of the ground, m.
const H: f64 = 12.0 * D;
const WIDTH: f64 = 5.0 * D;
/// Way of the mesh, m.
const WAY: f64 = 5.0 * D;
const UNIT_WEIGHT: f64 = 18e3;
const G: f64 = 9.81;
const K0: f64 = 0.43;
/// Height of each row below the zone over that of the one above it.
const GROWTH: f64 = 1.06;

/// One run.
#[derive(Clone, Copy)]
struct Run {
    /// Height of the finest rows, m. Cells are at most twice as wide.
    h: f64,
    /// Particles at least in an element of the finest rows; none seeds four in each element.
    density: Option<f64>,
    plastic: bool,
    /// Stiffness-proportional, s.
    viscosity: f64,
    /// Of the driver, m/s.
    speed: f64,
    integration: Integration,
}

impl Run {
    fn name(&self) -> String {
        format!(
            "{}, {} integration, {}, h = {} m, {} m/s, viscosity {} s",
            self.soil(),
            self.integration(),
            self.seeding(),
            self.h,
            self.speed,
            self.viscosity
        )
    }

    fn soil(&self) -> &'static str {
        match self.plastic {
            true => "Mohr-Coulomb",
            false => "elastic",
        }
    }

    fn integration(&self) -> &'static str {
        match self.integration {
            Integration::Mixed => "mixed",
            Integration::Particle => "particle",
        }
    }

    fn seeding(&self) -> &'static str {
        match self.density {
            Some(_) => "dense",
            None => "four",
        }
    }

    /// Of a cell along x, m: D is a whole number of them.
    fn width(&self) -> f64 {
        D / (0.5 * D / self.h - 1e-9).ceil()
    }
}

/// Lower end of the moving zone at the start, m.
const ZONE: f64 = H - D;
/// Bottom and height of the driver, m.
const DRIVER: [f64; 2] = [H + WAY + D, D];

fn mesh(run: &Run) -> Mesh {
    let below = setup::growing(ZONE, run.h, 0, GROWTH, 0.0);
    let stretch = ZONE / (ZONE - below[below.len() - 1]);
    let mut rows: Vec<f64> = below[1..]
        .iter()
        .map(|z| ZONE + (z - ZONE) * stretch)
        .collect();
    rows.reverse();
    rows[0] = 0.0;
    let fine = (D / run.h).round() as usize;
    rows.extend((0..=fine).map(|k| ZONE + D * k as f64 / fine as f64));
    let air = setup::growing(H, run.h, 0, 1.1, DRIVER[0]);
    let stretch = (DRIVER[0] - H) / (air[air.len() - 1] - H);
    rows.extend(air[1..].iter().map(|z| H + (z - H) * stretch));
    let last = rows[rows.len() - 1];
    rows.extend([last + DRIVER[1], last + DRIVER[1] + D]);
    // The driver and its zone end on faces.
    let cells = (WIDTH / run.width()).round() as usize;
    let across = (0..=cells)
        .map(|i| WIDTH * i as f64 / cells as f64)
        .collect();
    let mesh = setup::graded_box([across, vec![0.0, 2.0 * run.h], rows]);
    let mesh = setup::with_surface_at(&mesh, "driver-bottom", DRIVER[0], |x| x.x < D + 1e-9);
    let top = DRIVER[0] + DRIVER[1];
    let mesh = setup::with_surface_at(&mesh, "driver-top", top, |x| x.x < D + 1e-9);
    setup::with_volumes(&mesh, |x| match x {
        _ if x.x < D && x.z > DRIVER[0] && x.z < top => "driver",
        _ if x.z < H && x.x < 2.0 * D && x.z > ZONE => "ground-moving",
        _ if x.z < H => "ground",
        _ if x.x < 2.0 * D => "air-moving",
        _ => "air",
    })
}

fn plan(run: &Run) -> Plan {
    let mesh = mesh(run);
    let density = UNIT_WEIGHT / G;
    let soil = match run.plastic {
        true => setup::mohr_coulomb((5e6, 0.3), 5e3, 30.0, None, density),
        false => setup::elastic(5e6, 0.3, density),
    };
    let mut plan = setup::free_body(mesh, soil, WAY / run.speed);
    plan.materials.push(NamedMaterial {
        name: "plastic".to_owned(),
        ..setup::elastic(5e6, 0.0, 100.0)
    });
    let group = |name: &str| plan.mesh.volume_group(name).expect("the mesh has it");
    let body = |name: &str, volumes, material, seeding| Body {
        name: name.to_owned(),
        place: Place::Volumes(volumes),
        material,
        seeding,
    };
    let seeding = match run.density {
        Some(least) => {
            let finest = run.h * run.width() * 2.0 * run.h / 6.0;
            let spacing = (finest / least).cbrt();
            Seeding::Spacing(Spacing {
                start: Vec3::ZERO,
                end: Vec3::ZERO,
                points: vec![[0.0, spacing]],
            })
        }
        None => Seeding::Four,
    };
    let motion = MeshMotion {
        driver: 1,
        direction: -Vec3::Z,
        moving: vec![group("ground-moving"), group("air-moving")],
        blend: vec![group("ground"), group("air")],
    };
    let ground = vec![group("ground"), group("ground-moving")];
    plan.bodies = vec![
        body("ground", ground, 0, seeding),
        body("driver", vec![group("driver")], 1, Seeding::Four),
    ];
    plan.mesh_motion = Some(motion);
    plan.gravity = Vec3::new(0.0, 0.0, -G);
    plan.initial_stress = Some(InitialStress {
        k0: vec![Some(K0), None],
        surcharge: 0.0,
    });
    plan.title = run.name();
    plan.numerics.integration = run.integration;
    plan.numerics.viscosity = run.viscosity;
    setup::bound(&mut plan, &setup::SIDES, BoundaryKind::Roller);
    setup::bound(&mut plan, &["z-min"], setup::FIXED);
    let pushed = BoundaryKind::Prescribed {
        velocity: [Some(0.0), Some(0.0), Some(-run.speed)],
        function: Function::Constant,
    };
    setup::bound(&mut plan, &["driver-bottom", "driver-top"], pushed);
    plan.stages[0].initial_velocities = vec![(1, Vec3::new(0.0, 0.0, -run.speed))];
    plan
}

/// What a run came to.
#[derive(Default)]
struct Outcome {
    /// (Way over D, rms of the error over rms of the stress, of σ_zz).
    vertical: Vec<(f64, f64)>,
    /// The same of σ_xx.
    horizontal: Vec<(f64, f64)>,
    /// (Way over D, rms velocity of the ground's nodes over √(gH)).
    velocity: Vec<(f64, f64)>,
    /// Fewest particles that an element below the surface has held.
    fewest: usize,
    particles: usize,
}

fn greatest(curve: &[(f64, f64)]) -> f64 {
    curve.iter().map(|p| p.1).fold(0.0, f64::max)
}

/// Root mean squares of the errors of σ_zz and σ_xx over those of the stresses.
fn stress_errors(s: &Simulation) -> [f64; 2] {
    let p = s.particles();
    let mut sums = [[0.0; 2]; 2];
    for i in (0..p.len()).filter(|&i| p.body[i] == 0) {
        let vertical = -UNIT_WEIGHT * (H - p.position.at(i).z);
        for (sum, (own, exact)) in sums.iter_mut().zip([
            (p.stress.at(i)[2], vertical),
            (p.stress.at(i)[0], K0 * vertical),
        ]) {
            sum[0] += (own - exact).powi(2);
            sum[1] += exact.powi(2);
        }
    }
    sums.map(|s| (s[0] / s[1]).sqrt())
}

/// √(2 E/M) of the nodes that the driver does not touch, over √(gH).
fn grid_velocity(s: &Simulation) -> f64 {
    let fields = s.node_fields();
    let (mut energy, mut mass) = (0.0, 0.0);
    let nodes = fields.velocity.iter().zip(&fields.mass);
    // The driver never comes nearer to the surface than D.
    for ((v, m), _) in nodes.zip(&s.mesh().nodes).filter(|n| n.1.z < H + 0.9 * D) {
        energy += 0.5 * m * v.length_squared();
        mass += m;
    }
    (2.0 * energy / mass / (G * H)).sqrt()
}

fn fewest(s: &Simulation) -> usize {
    let mesh = s.mesh();
    let mut count = vec![0; mesh.tets.len()];
    s.particles()
        .element
        .iter()
        .for_each(|&e| count[e as usize] += 1);
    let inside = (0..count.len()).filter(|&e| mesh.corners(e).iter().all(|x| x.z < H - 1e-3));
    inside.map(|e| count[e]).min().unwrap_or(0)
}

fn compute(run: &Run) -> (Outcome, Balance) {
    let mut o = Outcome {
        fewest: usize::MAX,
        ..Outcome::default()
    };
    let mut next = 0.0;
    let balance = setup::run(plan(run), |s: &Simulation| {
        let way = s.time() * run.speed;
        if way < next && !s.finished() {
            return;
        }
        next += WAY / 100.0;
        let [vertical, horizontal] = stress_errors(s);
        o.vertical.push((way / D, vertical));
        o.horizontal.push((way / D, horizontal));
        o.velocity.push((way / D, grid_velocity(s)));
        o.fewest = o.fewest.min(fewest(s));
        o.particles = s.particles().len();
    });
    (o, balance)
}

/// Particles in an element of the finest rows that keep two in those that are compressed.
const DENSE: f64 = 8.0;

/// Runs with limits, and those that show why.
fn runs(fidelity: Fidelity) -> Vec<(Run, bool)> {
    let run = |h, speed| Run {
        h,
        speed,
        density: Some(DENSE),
        plastic: false,
        viscosity: 0.0,
        integration: Integration::Mixed,
    };
    let h = fidelity.pick(0.1, 0.05);
    let first = run(h, 5.0);
    let soil = Run {
        plastic: true,
        ..run(0.1, 5.0)
    };
    let sparse = Run {
        density: None,
        ..first
    };
    let particle = Run {
        integration: Integration::Particle,
        ..first
    };
    let mut runs = vec![
        (first, true),
        (soil, true),
        (sparse, false),
        (particle, false),
    ];
    if fidelity == Fidelity::Fine {
        // Errors add up over time.
        let viscous = Run {
            viscosity: 5e-4,
            ..run(2.0 * h, 2.0)
        };
        let slow = [
            (run(2.0 * h, 2.0), false),
            (viscous, true),
            (run(h, 2.0), true),
        ];
        runs.extend(slow);
    }
    runs
}

pub fn run(fidelity: Fidelity) -> Report {
    let mut report = Report {
        table: Table::new(&[
            "soil",
            "integration",
            "seeding",
            "h_m",
            "speed_m/s",
            "viscosity_s",
            "particles",
            "fewest",
            "stress_zz_%",
            "stress_xx_%",
            "velocity",
            "residual",
            "numerical_%",
        ]),
        ..Report::default()
    };
    let mut plot = Plot::new(
        "A mesh moves through ground at rest",
        "way over D",
        "rms error of the vertical stress, %",
    );
    for (run, limited) in runs(fidelity) {
        let (o, balance) = compute(&run);
        let [zz, xx, velocity] = [&o.vertical, &o.horizontal, &o.velocity].map(|c| greatest(c));
        report.table.row(&[
            &run.soil(),
            &run.integration(),
            &run.seeding(),
            &run.h,
            &run.speed,
            &run.viscosity,
            &o.particles,
            &o.fewest,
            &format!("{:.3}", 100.0 * zz),
            &format!("{:.3}", 100.0 * xx),
            &format!("{velocity:.2e}"),
            &format!("{:.1e}", balance.residual),
            &format!("{:.3}", 100.0 * balance.numerical),
        ]);
        let damped = if run.viscosity > 0.0 { "; viscous" } else { "" };
        let name = format!(
            "{}; {}; {}; h = {} m; {} m/s{damped}",
            run.soil(),
            run.integration(),
            run.seeding(),
            run.h,
            run.speed
        );
        report.check(
            format!("{name}: residual of the ledger"),
            balance.residual,
            1e-9,
        );
        if limited {
            report.check(format!("{name}: error of vertical stress"), zz, 0.005);
            report.check(format!("{name}: error of horizontal stress"), xx, 0.005);
            report.check(format!("{name}: velocity of the grid"), velocity, 5e-4);
        }
        // The other one would hide them.
        if run.integration == Integration::Mixed {
            let percent = o.vertical.iter().map(|p| (p.0, 100.0 * p.1)).collect();
            plot.line(name, percent);
        }
    }
    report.plots.push(("moving-ground".to_owned(), plot));
    report
}
