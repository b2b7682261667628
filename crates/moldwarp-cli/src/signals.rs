//! Ctrl-C and SIGTERM.

use crate::Failure;
use crate::exit::{Exit, of_signal};
use moldwarp_io::run::Interrupt;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// From now on the first signal asks the run to stop with a checkpoint; a second one ends the program
/// at once, with the checkpoint before.
pub fn watch() -> Result<Interrupt, Failure> {
    let interrupt = Interrupt::default();
    let asked = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        let code = of_signal(signal as usize) as i32;
        // In this order: the first signal finds `asked` unset and sets it.
        flag::register_conditional_shutdown(signal, code, Arc::clone(&asked))
            .and_then(|_| flag::register(signal, Arc::clone(&asked)))
            .and_then(|_| {
                let number = Arc::clone(interrupt.signal());
                flag::register_usize(signal, number, signal as usize)
            })
            .map_err(|e| {
                Failure::new(
                    Exit::Files,
                    miette::miette!("cannot watch for signals: {e}"),
                )
            })?;
    }
    Ok(interrupt)
}
