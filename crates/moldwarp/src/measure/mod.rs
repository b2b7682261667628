//! What is measured: the balance of energy, and probes.

mod ledger;
mod probe;

pub use ledger::{DriftWork, Energies, Ledger};
pub use probe::Probes;
