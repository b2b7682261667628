//! Ctrl-C and SIGTERM.

use crate::Failure;
use crate::exit::{Exit, of_signal};
use moldwarp_io::run::Interrupt;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

/// Signals that come within this time of the first are the same one: `timeout` and batch systems send it
/// to the process and to its group.
const ONE: Duration = Duration::from_secs(1);
/// How often the first one is looked for.
const LOOK: Duration = Duration::from_millis(100);

/// From now on the first signal asks the run to stop with a checkpoint; a later one ends the program
/// at once, with the checkpoint before.
pub fn watch() -> Result<Interrupt, Failure> {
    let interrupt = Interrupt::default();
    let impatient = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        let code = of_signal(signal as usize) as i32;
        flag::register_conditional_shutdown(signal, code, Arc::clone(&impatient))
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
    let number = Arc::clone(interrupt.signal());
    std::thread::spawn(move || wait(&number, &impatient));
    Ok(interrupt)
}

/// Lets the next signal end the program some time after the first.
fn wait(number: &AtomicUsize, impatient: &AtomicBool) {
    while number.load(Ordering::Relaxed) == 0 {
        std::thread::sleep(LOOK);
    }
    std::thread::sleep(ONE);
    impatient.store(true, Ordering::Relaxed);
}
