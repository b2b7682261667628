//! What is measured: the balance of energy, equilibrium, and probes.

mod equilibrium;
mod ledger;
mod probe;

pub(crate) use equilibrium::{Forces, Scale, Watch};
pub use ledger::{DriftWork, Energies, Ledger};
pub use probe::Probes;
