//! Comparisons of moldwarp with exact solutions.
//!
//! Every case computes a table, a plot and figures with their limits. `coarse` runs in seconds to
//! a minute and is tested; `fine` shows convergence and takes what it needs.

pub mod cases;
pub mod exact;
pub mod example;
pub mod ledgers;
pub mod made;
pub mod pictures;
mod report;
pub mod setup;
pub mod soak;
pub mod speed;

pub use moldwarp_io::plot::{Curve, Plot};
pub use report::{Check, Report, Table};

/// How finely a case is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fidelity {
    Coarse,
    Fine,
}

impl Fidelity {
    pub fn name(self) -> &'static str {
        match self {
            Fidelity::Coarse => "coarse",
            Fidelity::Fine => "fine",
        }
    }

    /// `coarse` or `fine`, whichever this is.
    pub fn pick<T>(self, coarse: T, fine: T) -> T {
        match self {
            Fidelity::Coarse => coarse,
            Fidelity::Fine => fine,
        }
    }
}

/// A case: its name, what it shows, and how it is computed.
pub struct Case {
    pub name: &'static str,
    pub title: &'static str,
    pub run: fn(Fidelity) -> Report,
}
