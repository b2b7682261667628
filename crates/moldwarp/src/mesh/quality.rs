//! How good a mesh is for an explicit computation.

use super::Mesh;

/// The figures that decide a mesh's cost and accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Shortest altitude of all elements, m: it sets the time step.
    pub smallest_altitude: f64,
    /// The element that has it.
    pub smallest_altitude_element: u32,
    /// Greatest ratio of an element's longest edge to its shortest altitude; 1.22 is a regular
    /// tetrahedron, over 10 is a sliver.
    pub worst_aspect: f64,
    /// The element that has it.
    pub worst_aspect_element: u32,
    /// Mean edge length, m.
    pub mean_edge: f64,
}

impl Mesh {
    /// Looks at all elements.
    pub fn quality(&self) -> Quality {
        let mut q = Quality {
            smallest_altitude: f64::INFINITY,
            smallest_altitude_element: 0,
            worst_aspect: 0.0,
            worst_aspect_element: 0,
            mean_edge: 0.0,
        };
        let mut edges = 0.0;
        for e in 0..self.tets.len() {
            let x = self.corners(e);
            let mut longest: f64 = 0.0;
            for i in 0..4 {
                for j in 0..i {
                    let edge = (x[i] - x[j]).length();
                    longest = longest.max(edge);
                    edges += edge;
                }
            }
            let altitude = self.altitude(e);
            if altitude < q.smallest_altitude {
                (q.smallest_altitude, q.smallest_altitude_element) = (altitude, e as u32);
            }
            let aspect = longest / altitude;
            if aspect > q.worst_aspect {
                (q.worst_aspect, q.worst_aspect_element) = (aspect, e as u32);
            }
        }
        q.mean_edge = edges / (6 * self.tets.len()) as f64;
        q
    }
}

#[cfg(test)]
mod tests {
    use crate::{Vec3, mesh::box_mesh};

    #[test]
    fn a_kuhn_cube_has_altitude_one_over_root_two() {
        let q = box_mesh(Vec3::ONE, [1, 1, 1]).unwrap().quality();
        assert!((q.smallest_altitude - 0.5f64.sqrt()).abs() < 1e-15);
        assert!((q.worst_aspect - 6f64.sqrt()).abs() < 1e-14);
    }
}
