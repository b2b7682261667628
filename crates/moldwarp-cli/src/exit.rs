//! Exit codes. A panic, 101, is a bug.

use std::process::ExitCode;

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    Done = 0,
    /// Wrong input or arguments; nothing was written. Also clap's code.
    Input = 2,
    /// A guard stopped the run; what was computed until then is kept.
    Guard = 3,
    /// Reading or writing failed during the run.
    Files = 4,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}
