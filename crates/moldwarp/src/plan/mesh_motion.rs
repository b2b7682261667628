//! A mesh that moves with a body.

use crate::Vec3;

/// A mesh that a body takes along.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshMotion {
    /// Index into [`super::Plan::bodies`].
    pub driver: usize,
    /// Unit vector along which the mesh moves.
    pub direction: Vec3,
    /// Volume groups (indices into [`crate::Mesh::volume_groups`]) that go rigidly with the driver. Its
    /// own elements need not be among them.
    pub moving: Vec<usize>,
    /// Those that are compressed and stretched.
    pub blend: Vec<usize>,
}
