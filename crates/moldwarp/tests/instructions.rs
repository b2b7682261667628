//! The same bits with any instructions and any number of threads.

mod collapse;

use collapse::collapse;
use moldwarp::particles::{Tensors, Vectors};
use moldwarp::{Simd, Simulation};

/// Positions, stresses and energies of a block after it has begun to flow.
fn collapsed(simd: Simd, threads: usize) -> (Vectors, Tensors, [f64; 17]) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().unwrap().install(|| {
        let mut sim = Simulation::new(collapse(6, 0.0)).unwrap();
        sim.use_simd(simd);
        (0..300).for_each(|_| sim.step().unwrap());
        let p = sim.particles();
        let places = p.places_by_id();
        let moved = |&p: &Option<u32>| sim.particles().displacement(p.unwrap() as usize).length();
        let farthest = places.iter().map(moved).fold(0.0, f64::max);
        assert!(farthest > 0.1, "it flows: {farthest}");
        (
            p.position.clone(),
            p.stress.clone(),
            sim.energies().values(),
        )
    })
}

#[test]
fn instructions_and_threads_do_not_matter() {
    let first = collapsed(Simd::named("scalar").unwrap(), 1);
    for simd in Simd::NAMES.iter().filter_map(|name| Simd::named(name)) {
        assert!(first == collapsed(simd, 2), "{simd:?}");
    }
    for threads in [3, 8] {
        assert!(
            first == collapsed(Simd::best(), threads),
            "{threads} threads"
        );
    }
}
