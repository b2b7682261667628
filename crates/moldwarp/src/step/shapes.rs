//! Shape functions and nodal values of cells side by side.

use crate::Vec3;
use crate::lanes::{LANES, Lane, get, set};
use crate::mesh::{Mesh, NONE, barycentric};

/// Vectors at the four nodes of cells side by side.
pub type Corners = [Lane; 12];

pub(super) const NO_CORNERS: Corners = [Lane::of(0.0); 12];

/// What the shape functions of elements are made of. All zero where there is no element.
#[derive(Clone, Debug)]
pub struct Shapes {
    /// Node 0.
    origin: [Lane; 3],
    /// ∇N₁, ∇N₂, ∇N₃.
    gradients: [Lane; 9],
    /// Volume, m³.
    pub volume: Lane,
    /// Shortest altitude, m.
    pub altitude: Lane,
}

impl Default for Shapes {
    fn default() -> Shapes {
        Shapes {
            origin: [Lane::of(0.0); 3],
            gradients: [Lane::of(0.0); 9],
            volume: Lane::of(0.0),
            altitude: Lane::of(0.0),
        }
    }
}

impl Shapes {
    /// Of these elements.
    pub(super) fn load(&mut self, mesh: &Mesh, elements: &[u32]) {
        for (l, &e) in elements.iter().enumerate() {
            if e == NONE {
                set(&mut self.origin, l, [0.0; 3]);
                set(&mut self.gradients, l, [0.0; 9]);
                (self.volume[l], self.altitude[l]) = (0.0, 0.0);
                continue;
            }
            let e = e as usize;
            let origin = mesh.nodes[mesh.tets[e][0] as usize];
            set(&mut self.origin, l, origin.to_array());
            for (i, g) in mesh.gradients(e).iter().enumerate() {
                for (k, g) in g.to_array().into_iter().enumerate() {
                    self.gradients[3 * i + k][l] = g;
                }
            }
            (self.volume[l], self.altitude[l]) = (mesh.volumes[e], mesh.altitudes[e]);
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

/// Copies vectors of the nodes of cells side by side.
#[inline(always)]
pub(super) fn load_nodes(corners: &mut Corners, cells: &[[u32; 4]; LANES], vectors: &[Vec3]) {
    for (l, cell) in cells.iter().enumerate() {
        for (i, &n) in cell.iter().enumerate() {
            set_corner(corners, l, i, vectors[n as usize]);
        }
    }
}

/// Sums of a number of the nodes of cells side by side.
#[inline(always)]
pub(super) fn sum_nodes(sums: &mut Lane, cells: &[[u32; 4]; LANES], numbers: &[f64]) {
    for (sum, cell) in sums.iter_mut().zip(cells) {
        *sum = cell.iter().map(|&n| numbers[n as usize]).sum();
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
