//! Scenes of the examples at their start.

use moldwarp::Simulation;

/// The tunnel under its initial stress, its face held by the pressure of the ground: on a mesh that
/// knows nothing of layers the stress is exact at every particle, and in 100 steps none is faster than
/// 1e-6 √(gH), H = 26 m being the depth of the base.
#[test]
fn the_ground_around_the_tunnel_is_at_rest() {
    let path = "../../examples/tunnel-face/scene.toml".as_ref();
    let mut scene = moldwarp_io::scene::load(path, &[]).unwrap();
    scene.plan.stages.truncate(1);
    let mut sim = Simulation::new(scene.plan).unwrap();
    let unit_weight = 16e3 / 9.81 * 9.81;
    let p = sim.particles();
    for (x, stress) in p.position.iter().zip(p.stress.iter()) {
        let vertical = unit_weight * x.z;
        let expected = [0.5 * vertical, 0.5 * vertical, vertical, 0.0, 0.0, 0.0];
        let close = |(a, b): (&f64, f64)| (a - b).abs() < 1e-12 * unit_weight * 26.0;
        assert!(stress.iter().zip(expected).all(close), "{x}: {stress:?}");
    }
    let mut greatest = 0.0f64;
    while !sim.finished() {
        sim.step().unwrap();
        let speeds = sim.particles().velocity.iter().map(|v| v.length());
        greatest = speeds.fold(greatest, f64::max);
    }
    let greatest = greatest / (9.81f64 * 26.0).sqrt();
    println!(
        "{} steps: greatest velocity {greatest:e} √(gH)",
        sim.steps()
    );
    assert!(greatest < 1e-6, "{greatest}");
}

/// The book's first own problem: its sketch's volume, ground at rest in its first stage, and a cut whose
/// face moves out once it is dug.
#[test]
fn the_books_cut_is_dug_out_of_ground_at_rest() {
    let path = "../../book/src/first-problem/scene.toml".as_ref();
    let mut scene = moldwarp_io::scene::load(path, &[]).unwrap();
    scene.plan.stages[1].until = moldwarp::plan::Until::Steps(200);
    let mut sim = Simulation::new(scene.plan).unwrap();
    let volume: f64 = sim.particles().volume.iter().sum();
    assert!((volume - 30.0).abs() < 1e-9, "{volume}");
    let crest = |sim: &Simulation| {
        let p = sim.particles();
        let places = p.position.iter().zip(p.displacements());
        let near = places.filter(|(x, _)| x.x > -0.5 && x.x < 0.1 && x.z > -0.5);
        near.map(|(_, u)| u.x).fold(0.0f64, f64::max)
    };
    while sim.stage() == 0 {
        sim.step().unwrap();
    }
    let before = crest(&sim);
    assert!(before < 1e-9, "{before}");
    while !sim.finished() {
        sim.step().unwrap();
    }
    assert!(crest(&sim) > 1e-3, "{}", crest(&sim));
}
