use moldwarp::boundary::Function;
use moldwarp::material::{LinearElastic, Material};
use moldwarp::plan::*;
use moldwarp::{Plan, Simulation, Vec3};
use moldwarp_validation::exact::column::*;
fn main() {
    let arg = |i: usize, d: &str| std::env::args().nth(i).unwrap_or(d.into());
    let n: usize = arg(1, "10").parse().unwrap();
    let kind = arg(2, "spring");
    let end: f64 = arg(3, "1.6").parse().unwrap();
    let courant: f64 = arg(4, "0.5").parse().unwrap();
    let h = 1.0 / n as f64;
    let mesh = moldwarp::mesh::box_mesh(Vec3::new(2.0 * h, 2.0 * h, 1.0), [2, 2, n]).unwrap();
    let s = |n: &str| mesh.surface(n).unwrap();
    let (bottom, kindb) = match &kind[..] {
        "rigid" => (Bottom::Rigid, BoundaryKind::Fixed { directions: [true; 3] }),
        "dashpot" => (Bottom::Dashpot { alpha: 2.5 }, BoundaryKind::Absorbing { alpha: [2.5; 2], virtual_thickness: None }),
        _ => (Bottom::DashpotAndSpring { alpha: 2.5, virtual_thickness: 0.5 }, BoundaryKind::Absorbing { alpha: [2.5; 2], virtual_thickness: Some([0.5; 2]) }),
    };
    let plan = Plan {
        title: "column".into(), gravity: Vec3::ZERO,
        materials: vec![NamedMaterial { name: "soil".into(), density: 18e3 / 9.81, model: Material::LinearElastic(LinearElastic { young_modulus: 1e5, poisson_ratio: 0.0 }) }],
        bodies: vec![Body { name: "layer".into(), place: Place::VolumeGroup(0), material: 0, seeding: Seeding::Four }],
        boundaries: vec![
            Boundary { name: "sides".into(), surfaces: vec![s("x-min"), s("x-max"), s("y-min"), s("y-max")], kind: BoundaryKind::Roller },
            Boundary { name: "b".into(), surfaces: vec![s("z-min")], kind: kindb }],
        loads: vec![Load { name: "top".into(), surfaces: vec![s("z-max")], body: 0, kind: LoadKind::Traction(Vec3::new(0.0, 0.0, -1e3)), function: Function::Constant }],
        probes: vec![
            Probe { name: "bottom".into(), target: Target::Surface(s("z-min")), quantities: vec![Quantity::Displacement, Quantity::Stress, Quantity::Reaction] },
            Probe { name: "top".into(), target: Target::Surface(s("z-max")), quantities: vec![Quantity::Displacement] }],
        numerics: Numerics { courant, smoothing: std::env::var("NOSM").is_err(), ..Default::default() },
        stages: vec![Stage { name: "l".into(), until: Until::Duration(end), damping: None, initial_velocities: vec![] }],
        mesh,
    };
    let exact = Column::of_the_paper(bottom).solve(end + 1.0);
    let peak = exact.bottom_peak(end);
    let mut sim = Simulation::new(plan).unwrap();
    let (mut worst, mut at, mut wtop) = (0.0f64, 0.0, 0.0f64);
    let start = std::time::Instant::now();
    let mut v = vec![];
    let (mut numer, mut resid) = (0.0f64, 0.0f64);
    while !sim.finished() {
        if let Err(e) = sim.step() { println!("{e}"); break; }
        v.clear(); sim.probe_values(&mut v);
        let err = (-v[2] - exact.bottom_displacement(sim.time())).abs();
        if std::env::var("PR").is_ok() { println!("{:.4} {:.4} {:.4} {:.4} {:.1}", sim.time()/0.1354567, -v[2]*1e3, exact.bottom_displacement(sim.time())*1e3, (-v[2]-exact.bottom_displacement(sim.time()))/peak*100.0, (-v[5])); }
        if err > worst { worst = err; at = sim.time(); }
        wtop = wtop.max((-v[14] - exact.top_displacement(sim.time())).abs());
        let e = sim.energies();
        numer = numer.max(e.numerical()); resid = resid.max(e.residual.abs());
    }
    let e = sim.energies();
    let t = sim.energy_turned_over();
    println!("n {n} {kind} dt {:.3e} steps {} error {:.3} % at {at:.3} s ({:.2} T), top {:.3} % of 20 mm; turned {:.4e} residual {:.1e} max {:.1e} numerical {:.3} % max {:.3} % (transfer {:.3} smoothing {:.3} integ {:.3} adv {:.3} %) {:.1} s", sim.time_step(), sim.steps(),
        100.0 * worst / peak.max(1e-30), at / 0.135457, 100.0 * wtop / 0.02, t, e.residual / t, resid / t, 100.0 * e.numerical() / t, 100.0*numer / t,
        100.0 * e.transfer / t, 100.0 * e.smoothing / t, 100.0 * e.integration / t, 100.0 * e.advection / t, start.elapsed().as_secs_f64());
}
