//! Finding the element that holds a point by walking over neighbours.

use super::{Face, Mesh, NONE};
use crate::Vec3;

/// How far outside an element, in barycentric coordinates, a point still counts as in it:
/// round-off of a particle that slides along a wall.
const TOLERANCE: f64 = 1e-10;

/// Whether a point with these N_i in an element lies outside of it.
#[inline]
pub(crate) fn is_outside(n: [f64; 4]) -> bool {
    n.iter().any(|&n| n < -TOLERANCE)
}

impl Mesh {
    /// Walks from element `start` to the one that holds `x`, always across the face behind which
    /// `x` lies farthest; `None` if the way leads out of the mesh.
    pub fn walk(&self, start: u32, x: Vec3) -> Option<u32> {
        self.walk_or_leave(start, x).ok()
    }

    /// As [`Mesh::walk`]; the error is the face by which the way leads out of the mesh, if it does not just
    /// go astray.
    pub fn walk_or_leave(&self, start: u32, x: Vec3) -> Result<u32, Option<Face>> {
        self.walk_on(start, self.barycentric(start as usize, x), x)
    }

    /// The same where N_i of `start` at `x` are known.
    #[inline]
    pub(crate) fn walk_on(
        &self,
        start: u32,
        mut n: [f64; 4],
        x: Vec3,
    ) -> Result<u32, Option<Face>> {
        let mut at = start;
        // A walk that visits every element once has gone astray (only possible round holes).
        for _ in 0..=self.tets.len() {
            let mut next = NONE;
            let mut farthest = -TOLERANCE;
            let mut inside = true;
            for local in 0..4 {
                if n[local] < -TOLERANCE {
                    inside = false;
                }
                let neighbour = self.neighbours[at as usize][local];
                if n[local] < farthest && neighbour != NONE {
                    farthest = n[local];
                    next = neighbour;
                }
            }
            if inside {
                return Ok(at);
            }
            if next == NONE {
                let outermost = (0..4).min_by(|&a, &b| n[a].total_cmp(&n[b]));
                return Err(outermost.map(|local| Face {
                    element: at,
                    local: local as u8,
                }));
            }
            at = next;
            n = self.barycentric(at as usize, x);
        }
        Err(None)
    }

    /// Whether `x` lies in element `e` (on its surface counts).
    pub fn contains(&self, e: u32, x: Vec3) -> bool {
        !is_outside(self.barycentric(e as usize, x))
    }

    /// The first element that holds `x`, by looking at all of them.
    pub fn find(&self, x: Vec3) -> Option<u32> {
        (0..self.tets.len() as u32).find(|&e| self.contains(e, x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::box_mesh;

    #[test]
    fn a_walk_through_a_box_arrives_and_one_out_of_it_says_so() {
        let mesh = box_mesh(Vec3::ONE, [5, 4, 3]).unwrap();
        let target = Vec3::new(0.91, 0.87, 0.93);
        let found = mesh.walk(0, target).unwrap();
        assert!(
            mesh.barycentric(found as usize, target)
                .iter()
                .all(|&n| n >= 0.0)
        );
        assert_eq!(mesh.walk(0, Vec3::new(0.5, 0.5, 1.01)), None);
        // On the wall, up to round-off, is inside.
        assert!(mesh.walk(0, Vec3::new(1.0 + 1e-13, 0.5, 0.5)).is_some());
    }
}
