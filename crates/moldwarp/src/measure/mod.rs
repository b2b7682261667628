//! What is measured: the balance of energy, equilibrium, and probes.

mod equilibrium;
mod ledger;
mod probe;
mod profile;

pub(crate) use equilibrium::{Forces, Scale, Watch};
pub use ledger::{DriftWork, Energies, Ledger};
pub use probe::Probes;
pub use profile::{Part, Profile};
