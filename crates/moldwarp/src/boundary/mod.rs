//! What acts on a body from outside: fixities, absorbing boundaries, loads.

mod absorbing;
mod constraints;
mod function;
mod load;
mod outflow;

pub use absorbing::{Absorbing, AbsorbingNode};
pub use constraints::{Constraint, Constraints, surface_nodes};
pub use function::Function;
pub use load::{LoadError, LoadPoint, Surroundings, load_points};
pub use outflow::{Outflow, Outflown};
