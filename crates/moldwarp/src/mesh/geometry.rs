//! Volumes, gradients and altitudes of linear tetrahedra.

use super::Mesh;
use crate::Vec3;
use crate::lanes::larger;
use rayon::prelude::*;

/// Gradients of N₁, N₂, N₃ (1/m) and signed volume (m³) of a tetrahedron.
#[inline(always)]
pub fn tetrahedron_gradients(x: [Vec3; 4]) -> ([Vec3; 3], f64) {
    let [a, b, c] = [x[1] - x[0], x[2] - x[0], x[3] - x[0]];
    let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
    let det = a.dot(bc);
    let over = 1.0 / det;
    ([bc * over, ca * over, ab * over], det / 6.0)
}

/// Barycentric coordinates of `x` in the element whose node 0 lies at `origin`.
#[inline]
pub fn barycentric(origin: Vec3, gradients: &[Vec3; 3], x: Vec3) -> [f64; 4] {
    let d = x - origin;
    let (b, c, e) = (
        gradients[0].dot(d),
        gradients[1].dot(d),
        gradients[2].dot(d),
    );
    [1.0 - b - c - e, b, c, e]
}

/// 1 over the square of the shortest altitude, 1/m², of a tetrahedron with these gradients of N₁, N₂, N₃, 1/m: a gradient
/// is 1 over an altitude.
#[inline(always)]
pub fn steepest_squared(gradients: &[Vec3; 3]) -> f64 {
    let first = -(gradients[0] + gradients[1] + gradients[2]);
    gradients
        .iter()
        .fold(first.length_squared(), |m, g| larger(m, g.length_squared()))
}

/// Shortest altitude, m, of a tetrahedron with these gradients.
pub fn shortest_altitude(gradients: &[Vec3; 3]) -> f64 {
    1.0 / steepest_squared(gradients).sqrt()
}

impl Mesh {
    /// Barycentric coordinates of `x` in element `e`; they are the shape functions there.
    #[inline]
    pub fn barycentric(&self, e: usize, x: Vec3) -> [f64; 4] {
        let corners = self.corners(e);
        barycentric(corners[0], &tetrahedron_gradients(corners).0, x)
    }

    /// Gradients of N₁, N₂, N₃ in element `e`, 1/m.
    #[inline]
    pub fn gradients(&self, e: usize) -> [Vec3; 3] {
        tetrahedron_gradients(self.corners(e)).0
    }

    /// Gradients of all four shape functions of element `e`, 1/m.
    #[inline]
    pub fn all_gradients(&self, e: usize) -> [Vec3; 4] {
        let [b, c, d] = self.gradients(e);
        [-(b + c + d), b, c, d]
    }

    /// Corner coordinates of element `e`, m.
    pub fn corners(&self, e: usize) -> [Vec3; 4] {
        self.tets[e].map(|n| self.nodes[n as usize])
    }

    /// Centroid of element `e`, m.
    pub fn centroid(&self, e: usize) -> Vec3 {
        self.corners(e).iter().sum::<Vec3>() / 4.0
    }

    /// Shortest altitude of element `e`, m.
    pub fn altitude(&self, e: usize) -> f64 {
        shortest_altitude(&self.gradients(e))
    }

    /// Computes volumes from the node coordinates, and the volumes
    /// attached to nodes. To be called whenever nodes have moved.
    pub fn update_geometry(&mut self) {
        let (nodes, tets) = (&self.nodes, &self.tets);
        (&mut self.volumes)
            .into_par_iter()
            .zip(tets)
            .with_min_len(1024)
            .for_each(|(volume, tet)| {
                *volume = tetrahedron_gradients(tet.map(|n| nodes[n as usize])).1;
            });
        let (volumes, offsets, attached) = (&self.volumes, &self.node_offsets, &self.node_elements);
        self.node_volumes
            .par_iter_mut()
            .enumerate()
            .with_min_len(1024)
            .for_each(|(n, sum)| {
                let range = offsets[n] as usize..offsets[n + 1] as usize;
                *sum = attached[range].iter().map(|at| volumes[at.owner()]).sum();
            });
    }
}
