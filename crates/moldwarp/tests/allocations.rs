//! The step allocates nothing.

mod collapse;

use collapse::collapse;
use moldwarp::Simulation;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Counts what is allocated.
struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: the system's allocator does all the work.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Relaxed);
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        unsafe { System.dealloc(at, layout) }
    }
    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Relaxed);
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Arrays grow when the block spreads to more elements than ever before, and then only.
#[test]
fn the_step_allocates_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    pool.build().unwrap().install(|| {
        let mut stands = Simulation::new(collapse(6, 1e6)).unwrap();
        let mut flows = Simulation::new(collapse(6, 0.0)).unwrap();
        for (sim, most) in [(&mut stands, 0), (&mut flows, 20)] {
            (0..100).for_each(|_| sim.step().unwrap());
            let before = ALLOCATIONS.load(Relaxed);
            (0..300).for_each(|_| sim.step().unwrap());
            let count = ALLOCATIONS.load(Relaxed) - before;
            println!("{count} allocations in 300 steps");
            assert!(count <= most, "{count} allocations in 300 steps");
        }
    });
}
