//! Memory with a limit: a header that claims 10¹² nodes must be refused before memory is taken for
//! them.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering};

/// Most bytes of one allocation. All files of the corpus together are far smaller.
const MOST: usize = 64 << 20;

/// Number of the case that is being run, for the message.
pub static CASE: AtomicU64 = AtomicU64::new(0);

/// The system's allocator, which has nothing for whoever asks for more than 64 MiB at once: the
/// process is then aborted.
pub struct Bounded;

fn too_much(size: usize) -> bool {
    let refuse = size > MOST;
    if refuse {
        let case = CASE.load(Ordering::Relaxed);
        eprintln!("case {case} asks for {size} bytes of memory at once");
    }
    refuse
}

// SAFETY: all calls are passed on as they are; to have no memory for a layout is allowed.
unsafe impl GlobalAlloc for Bounded {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        match too_much(layout.size()) {
            true => std::ptr::null_mut(),
            // SAFETY: the caller keeps the contract of `alloc`.
            false => unsafe { System.alloc(layout) },
        }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`; all memory is the system's.
        unsafe { System.dealloc(place, layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        match too_much(size) {
            true => std::ptr::null_mut(),
            // SAFETY: the caller keeps the contract of `realloc`; all memory is the system's.
            false => unsafe { System.realloc(place, layout, size) },
        }
    }
}
