//! moldwarp: a dynamic material point method for geomechanics.
//!
//! Particles carry the material through a mesh of four-node tetrahedra; the equation of motion
//! is solved on the mesh's nodes with explicit steps (Jassim, Hamad and Vermeer 2011). A
//! [`Plan`] says what is to be computed, a [`Simulation`] computes it; [`step`] is the method.
//!
//! Conventions: SI units; tension positive; Voigt order xx, yy, zz, xy, yz, zx with engineering
//! shear strains.

mod access;
mod bodies;
pub mod boundary;
pub mod contact;
mod lanes;
pub mod material;
pub mod measure;
pub mod mesh;
mod parallel;
pub mod particles;
pub mod plan;
mod query;
#[cfg(test)]
mod random;
pub mod saved;
mod simulation;
mod stages;
pub mod step;
mod stop;
mod switches;
pub mod symmetry;
pub mod tensor;

pub use lanes::Simd;
pub use material::Material;
pub use mesh::Mesh;
pub use particles::Particles;
pub use plan::Plan;
pub use query::NodeFields;
pub use simulation::Simulation;
pub use stop::{SetupError, Stop};
pub use symmetry::Symmetry;

/// A point, a vector: x, y, z.
pub type Vec3 = glam::DVec3;
/// A second-order tensor.
pub type Mat3 = glam::DMat3;
