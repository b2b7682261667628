//! How fast the step is: particles times steps per second of the scenes in `benches`, beside what the
//! machine's memory delivers.

use moldwarp::Simulation;
use moldwarp_io::scene;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

/// A scene, changes to it, steps to begin with and steps that count.
struct Bench {
    name: &'static str,
    scene: &'static str,
    sets: &'static [&'static str],
    warm_up: u64,
    steps: u64,
}

const BENCHES: [Bench; 13] = [
    Bench {
        name: "column",
        scene: "benches/column.toml",
        sets: &[],
        warm_up: 0,
        steps: 100,
    },
    Bench {
        name: "flow",
        scene: "benches/flow.toml",
        sets: &[],
        warm_up: 1500,
        steps: 200,
    },
    Bench {
        name: "elastic",
        scene: "benches/elastic.toml",
        sets: &[],
        warm_up: 0,
        steps: 100,
    },
    Bench {
        name: "contact",
        scene: "benches/contact.toml",
        sets: &[],
        warm_up: 0,
        steps: 100,
    },
    Bench {
        name: "column-20",
        scene: "benches/column.toml",
        sets: &[
            "mesh.box.cells=[40, 10, 20]",
            "numerics.time_step=1.1564e-4",
        ],
        warm_up: 0,
        steps: 100,
    },
    Bench {
        name: "column-60",
        scene: "benches/column.toml",
        sets: &[
            "mesh.box.cells=[120, 30, 60]",
            "numerics.time_step=3.855e-5",
        ],
        warm_up: 0,
        steps: 30,
    },
    Bench {
        name: "column-80",
        scene: "benches/column.toml",
        sets: &[
            "mesh.box.cells=[160, 40, 80]",
            "numerics.time_step=2.891e-5",
        ],
        warm_up: 0,
        steps: 12,
    },
    Bench {
        name: "column-94",
        scene: "benches/column.toml",
        sets: &[
            "mesh.box.cells=[188, 47, 94]",
            "numerics.time_step=2.460e-5",
        ],
        warm_up: 0,
        steps: 8,
    },
    Bench {
        name: "column-120",
        scene: "benches/column.toml",
        sets: &[
            "mesh.box.cells=[240, 60, 120]",
            "numerics.time_step=1.927e-5",
        ],
        warm_up: 0,
        steps: 4,
    },
    Bench {
        name: "filled-100",
        scene: "benches/column.toml",
        sets: &["mesh.box.size=[0.5, 0.5, 1]", "mesh.box.cells=[20, 20, 40]"],
        warm_up: 0,
        steps: 100,
    },
    Bench {
        name: "filled-5",
        scene: "benches/column.toml",
        sets: &["mesh.box.size=[10, 0.5, 1]", "mesh.box.cells=[400, 20, 40]"],
        warm_up: 0,
        steps: 100,
    },
    Bench {
        name: "anchor",
        scene: "examples/drop-anchor/scene.toml",
        sets: &[],
        warm_up: 500,
        steps: 500,
    },
    Bench {
        name: "tunnel",
        scene: "examples/tunnel-face/scene.toml",
        sets: &[],
        warm_up: 100,
        steps: 500,
    },
];

/// Measures the benches of these names, all if there is none, and the memory.
pub fn measure(names: &[String]) -> Result<(), Failure> {
    let known = |name: &String| name == "memory" || BENCHES.iter().any(|b| b.name == name);
    if let Some(unknown) = names.iter().find(|name| !known(name)) {
        let all: Vec<_> = BENCHES.iter().map(|b| b.name).collect();
        return Err(format!("no bench `{unknown}`; there are memory, {}", all.join(", ")).into());
    }
    let wanted = |name: &str| names.is_empty() || names.iter().any(|n| n == name);
    let threads = rayon::current_num_threads();
    println!("{threads} threads");
    if wanted("memory") {
        println!("memory: {:.1} GB/s read and written", 1e-9 * triad());
    }
    println!(
        "bench         particles  filled elements        steps   million particle-steps/s   \
         peak of memory, bytes a particle"
    );
    for bench in BENCHES.iter().filter(|b| wanted(b.name)) {
        run(bench)?;
    }
    Ok(())
}

fn run(bench: &Bench) -> Result<(), Failure> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let sets: Vec<String> = bench.sets.iter().map(|s| s.to_string()).collect();
    forget_peak();
    let scene = scene::load(&root.join(bench.scene), &sets)?;
    let mut sim = Simulation::new(scene.plan)?;
    for _ in 0..bench.warm_up {
        sim.step()?;
    }
    let (mut done, start) = (0, Instant::now());
    for _ in 0..bench.steps {
        if sim.finished() {
            return Err(format!("{} is over after {} steps", bench.name, sim.steps()).into());
        }
        done += sim.particle_count();
        sim.step_and(|_| ())?;
    }
    sim.settle();
    let rate = done as f64 / start.elapsed().as_secs_f64();
    let peak = moldwarp_io::check::peak_memory().map(|bytes| bytes as f64);
    let mut filled = sim.particles().element.to_vec();
    filled.sort_unstable();
    filled.dedup();
    println!(
        "{:12} {:10}  {:8} of {:8} {:7}   {:>24.2}   {:>32}",
        bench.name,
        sim.particles().len(),
        filled.len(),
        sim.mesh().tets.len(),
        bench.steps,
        1e-6 * rate,
        peak.map_or("-".to_owned(), |p| format!(
            "{:.0}",
            p / sim.particles().len() as f64
        ))
    );
    Ok(())
}

/// From here on the process's peak of memory counts anew, where the system can do that (Linux).
fn forget_peak() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Bytes a second of a = b + s c over arrays that no cache holds (STREAM's triad), the best of ten.
fn triad() -> f64 {
    use rayon::prelude::*;
    const COUNT: usize = 1 << 24;
    let (mut a, b, c) = (vec![0.0; COUNT], vec![1.0; COUNT], vec![2.0; COUNT]);
    let once = |_| {
        let start = Instant::now();
        let arrays = (&mut a, &b, &c).into_par_iter().with_min_len(1 << 16);
        arrays.for_each(|(a, b, c)| *a = b + 3.0 * c);
        black_box(&a);
        start.elapsed().as_secs_f64()
    };
    let best = (0..10).map(once).fold(f64::INFINITY, f64::min);
    (3 * 8 * COUNT) as f64 / best
}
