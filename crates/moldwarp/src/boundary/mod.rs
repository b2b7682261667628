//! What acts on a body from outside: fixities, absorbing boundaries, loads.

mod function;

pub use function::Function;
