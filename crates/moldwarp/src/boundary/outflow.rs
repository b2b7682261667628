//! Outflow: surfaces of the mesh through which material leaves.
//!
//! Nothing holds their nodes. A particle that would leave the mesh across one of their faces is taken out, and
//! counted; what energy of motion it had is booked as removed. Anywhere else a particle that leaves the
//! mesh stops the run.

use crate::mesh::{Face, Mesh};
use crate::plan::{Boundary, BoundaryKind};

/// The faces through which material may leave.
#[derive(Clone, Debug, Default)]
pub struct Outflow {
    /// For each element a bit for each local face; empty if there are none at all.
    faces: Vec<u8>,
}

crate::saved!(Outflow { faces });

impl Outflow {
    /// Of the boundaries that are on.
    pub fn new(mesh: &Mesh, boundaries: &[&Boundary]) -> Outflow {
        let open = boundaries
            .iter()
            .filter(|b| matches!(b.kind, BoundaryKind::Outflow));
        let mut outflow = Outflow::default();
        for &surface in open.flat_map(|b| &b.surfaces) {
            outflow.faces.resize(mesh.tets.len(), 0);
            for face in &mesh.surfaces[surface].faces {
                outflow.faces[face.element as usize] |= 1 << face.local;
            }
        }
        outflow
    }

    /// Whether material may leave through this face.
    #[inline]
    pub fn lets_out(&self, face: Face) -> bool {
        let own = self.faces.get(face.element as usize);
        own.is_some_and(|faces| faces >> face.local & 1 == 1)
    }
}

/// What has left through outflow surfaces so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outflown {
    /// Number of particles.
    pub particles: u64,
    /// Their mass, kg.
    pub mass: f64,
}
