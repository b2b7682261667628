//! A mesh that moves.
//!
//! Two motions add: that of a body that takes the mesh along (`driven`), and those of absorbing
//! boundaries that follow the material (`follower`). What lies between moving and resting parts is
//! stretched, with weights that are harmonic in the mesh. When a step has moved it the mesh is an
//! ordinary one again: geometry is computed anew, and particles are located in it.

mod driven;
mod follower;
mod harmonic;
mod visits;

pub use driven::{Driven, MotionError, Zones};
pub use follower::Follower;
use harmonic::harmonic;
pub use visits::Visit;

use super::Mesh;
use rayon::prelude::*;

/// How far a direction may be turned by a node's constraint and still count as free (about 18°).
const FREE_COSINE: f64 = 0.95;

impl Mesh {
    /// The first element that has turned over, if any has.
    pub fn turned_over(&self) -> Option<u32> {
        let turned = self.volumes.par_iter().position_first(|&v| v <= 0.0);
        turned.map(|element| element as u32)
    }
}
