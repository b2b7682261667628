//! Being asked to stop.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Whether a run is to stop after the step that it is at, with a checkpoint. Copies are one thing.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicUsize>);

impl Interrupt {
    /// The number of the signal that asks to stop, 0 for none: a handler may set it at any time.
    pub fn signal(&self) -> &Arc<AtomicUsize> {
        &self.0
    }

    /// The signal, if there has been one.
    pub(super) fn asked(&self) -> Option<usize> {
        match self.0.load(Ordering::Relaxed) {
            0 => None,
            signal => Some(signal),
        }
    }
}
