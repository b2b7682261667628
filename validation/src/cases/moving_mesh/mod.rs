//! A mesh that moves with a body.

pub mod ground;
pub mod push;
