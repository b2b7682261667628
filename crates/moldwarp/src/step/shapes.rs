//! Shape functions of cells side by side.
//!
//! They are found anew wherever they are needed: their numbers would take longer to come from memory than the places of
//! the nodes, which the cache holds, take to make them.

use super::corners::{Instructions, Quad, TileNodes, all_corners};
use crate::Vec3;
use crate::lanes::{LANES, Lane, Simd, for_each_simd, get, set};
use crate::mesh::{barycentric, tetrahedron_gradients};

/// What the shape functions of cells are made of.
pub struct Shapes {
    /// Node 0.
    origin: [Lane; 3],
    /// ∇N₁, ∇N₂, ∇N₃.
    gradients: [Lane; 9],
    /// Volume, m³.
    pub volume: Lane,
}

impl Default for Shapes {
    fn default() -> Shapes {
        Shapes {
            origin: [Lane::of(0.0); 3],
            gradients: [Lane::of(0.0); 9],
            volume: Lane::of(0.0),
        }
    }
}

for_each_simd! {
    fn find(shapes: &mut Shapes, nodes: TileNodes, places: &[Quad], sums: &mut Lane) {
        *sums = shapes.find::<S>(nodes, places);
    }
}

impl Shapes {
    /// The same as [`Shapes::enter_and_sum`] in a kernel.
    #[inline(always)]
    pub(super) fn find<S: Instructions>(&mut self, nodes: TileNodes, places: &[Quad]) -> Lane {
        let (places, sums) = S::corners(nodes, places);
        for l in 0..LANES {
            let corners = all_corners(&places, l);
            let (gradients, volume) = tetrahedron_gradients(corners);
            set(&mut self.origin, l, corners[0].to_array());
            for (i, g) in gradients.iter().enumerate() {
                for (k, g) in g.to_array().into_iter().enumerate() {
                    self.gradients[3 * i + k][l] = g;
                }
            }
            self.volume[l] = volume;
        }
        sums
    }

    /// Goes to cells with these nodes; `places` are those of all nodes.
    #[inline]
    pub(super) fn enter(&mut self, simd: Simd, nodes: TileNodes, places: &[Quad]) {
        let mut sums = Lane::of(0.0);
        find(simd, self, nodes, places, &mut sums);
    }

    /// The same, and the sums of the fourth numbers of `places`.
    #[inline]
    pub(super) fn enter_and_sum(
        &mut self,
        simd: Simd,
        sums: &mut Lane,
        nodes: TileNodes,
        places: &[Quad],
    ) {
        find(simd, self, nodes, places, sums);
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

    /// A point from node 0 on, m.
    #[inline(always)]
    pub fn arm(&self, l: usize, x: Vec3) -> Vec3 {
        x - Vec3::from_array(get(&self.origin, l))
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
