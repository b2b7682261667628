//! Shape functions and nodal values of cells side by side.

use super::{Active, Node};
use crate::Vec3;
use crate::lanes::{LANES, Lane, get, set};
use crate::mesh::{Mesh, barycentric};

/// Vectors at the four nodes of cells side by side.
pub(super) type Corners = [Lane; 12];

pub(super) const NO_CORNERS: Corners = [[0.0; LANES]; 12];

/// What the shape functions of elements are made of.
pub(super) struct Shapes {
    /// Node 0.
    origin: [Lane; 3],
    /// ∇N₁, ∇N₂, ∇N₃.
    gradients: [Lane; 9],
}

impl Default for Shapes {
    fn default() -> Shapes {
        Shapes {
            origin: [[0.0; LANES]; 3],
            gradients: [[0.0; LANES]; 9],
        }
    }
}

impl Shapes {
    #[inline(always)]
    pub fn load(&mut self, l: usize, mesh: &Mesh, e: usize) {
        let origin = mesh.nodes[mesh.tets[e][0] as usize];
        set(&mut self.origin, l, origin.to_array());
        self.load_gradients(l, mesh, e);
    }

    /// For those who do not ask for shape functions.
    #[inline(always)]
    pub fn load_gradients(&mut self, l: usize, mesh: &Mesh, e: usize) {
        for (i, g) in mesh.gradients[e].iter().enumerate() {
            for (k, g) in g.to_array().into_iter().enumerate() {
                self.gradients[3 * i + k][l] = g;
            }
        }
    }

    /// ∇N₁, ∇N₂, ∇N₃ of an element.
    #[inline(always)]
    pub fn gradients(&self, l: usize) -> [Vec3; 3] {
        let g = get(&self.gradients, l);
        [
            Vec3::new(g[0], g[1], g[2]),
            Vec3::new(g[3], g[4], g[5]),
            Vec3::new(g[6], g[7], g[8]),
        ]
    }

    /// N_i at a point.
    #[inline(always)]
    pub fn at(&self, l: usize, x: Vec3) -> [f64; 4] {
        barycentric(
            Vec3::from_array(get(&self.origin, l)),
            &self.gradients(l),
            x,
        )
    }
}

/// Copies a vector of each node of a cell.
#[inline(always)]
pub(super) fn load_nodes(
    corners: &mut Corners,
    l: usize,
    active: &Active,
    c: usize,
    nodes: &[Node],
    value: impl Fn(&Node) -> Vec3,
) {
    for (i, &n) in active.cell_nodes[c].iter().enumerate() {
        set_corner(corners, l, i, value(&nodes[n as usize]));
    }
}

#[inline(always)]
pub(super) fn corner(corners: &Corners, l: usize, i: usize) -> Vec3 {
    Vec3::new(
        corners[3 * i][l],
        corners[3 * i + 1][l],
        corners[3 * i + 2][l],
    )
}

#[inline(always)]
pub(super) fn all_corners(corners: &Corners, l: usize) -> [Vec3; 4] {
    [
        corner(corners, l, 0),
        corner(corners, l, 1),
        corner(corners, l, 2),
        corner(corners, l, 3),
    ]
}

#[inline(always)]
pub(super) fn set_corner(corners: &mut Corners, l: usize, i: usize, value: Vec3) {
    corners[3 * i][l] = value.x;
    corners[3 * i + 1][l] = value.y;
    corners[3 * i + 2][l] = value.z;
}

/// Σ N_i w_i.
#[inline(always)]
pub(super) fn interpolate(n: [f64; 4], w: [Vec3; 4]) -> Vec3 {
    w[0] * n[0] + w[1] * n[1] + w[2] * n[2] + w[3] * n[3]
}
