//! Memory with a limit: a header that claims 10¹² nodes must be refused before memory is taken for
//! them.

use std::alloc::{GlobalAlloc, Layout, System};

/// Most bytes of one allocation. The whole corpus is far smaller.
const MOST: usize = 64 << 20;

/// The system's allocator, which has nothing for whoever asks for more than [`MOST`] at once: the
/// test is then aborted.
pub struct Bounded;

// SAFETY: all calls are passed on as they are; to have no memory for a layout is allowed.
unsafe impl GlobalAlloc for Bounded {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        match layout.size() > MOST {
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
        match size > MOST {
            true => std::ptr::null_mut(),
            // SAFETY: the caller keeps the contract of `realloc`; all memory is the system's.
            false => unsafe { System.realloc(place, layout, size) },
        }
    }
}
