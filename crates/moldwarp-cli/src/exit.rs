//! Exit codes. A panic, 101, is a bug.

use moldwarp::Stop;
use std::process::ExitCode;

/// How a command ended. The book's page on the output says the same of each, from here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Done.
    Done = 0,
    // Also clap's code.
    /// Wrong input or arguments; no output was written.
    Input = 2,
    /// A guard stopped the run: a particle left the mesh, an element turned over, a body was to be
    /// added where another one is, a particle passed a face of a contact, a moving mesh was
    /// compressed to degeneracy, there is no stable step, or
    /// the forced one is above it. What was computed is kept, with a last row, a frame of the
    /// faulty state, and the last checkpoint.
    Guard = 3,
    /// Reading or writing failed during the run, as when a disk is full; `moldwarp resume` goes on from
    /// the last checkpoint.
    Files = 4,
    /// A stage reached its limit without equilibrium; the run ends there, and what was computed is
    /// kept.
    NotAtRest = 5,
    /// Interrupted by Ctrl-C (SIGINT) after a step; a checkpoint was written.
    Interrupted = 130,
    /// The same by SIGTERM.
    Terminated = 143,
}

/// The code of a run that was stopped.
pub fn of_stop(stop: &Stop) -> Exit {
    match stop {
        Stop::NotAtRest { .. } => Exit::NotAtRest,
        Stop::LeftTheMesh { .. }
        | Stop::PassedAFace { .. }
        | Stop::TurnedOver { .. }
        | Stop::Degenerate { .. }
        | Stop::NotFinite { .. }
        | Stop::Crushed { .. }
        | Stop::Law { .. }
        | Stop::Empty { .. }
        | Stop::Motion { .. }
        | Stop::NoRoom { .. }
        | Stop::TimeStep { .. } => Exit::Guard,
    }
}

/// The code of a run that was interrupted by this signal.
pub fn of_signal(signal: usize) -> Exit {
    match signal as i32 {
        signal_hook::consts::SIGTERM => Exit::Terminated,
        _ => Exit::Interrupted,
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}
