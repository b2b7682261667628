//! Shape functions of cells side by side.

use crate::Vec3;
use crate::lanes::{Lane, get, set};
use crate::mesh::{Mesh, NONE, barycentric, shortest_altitude};

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
            let gradients = mesh.gradients(e);
            for (i, g) in gradients.iter().enumerate() {
                for (k, g) in g.to_array().into_iter().enumerate() {
                    self.gradients[3 * i + k][l] = g;
                }
            }
            (self.volume[l], self.altitude[l]) = (mesh.volumes[e], shortest_altitude(&gradients));
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
