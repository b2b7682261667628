//! The mesh's outer surface.

use std::collections::HashMap;

/// Triangles that belong to one tetrahedron only, of nodes that are numbered anew.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// The mesh's nodes, by their new numbers.
    pub nodes: Vec<u32>,
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Of tetrahedra as four nodes each, one after the other.
    pub fn of(cell_nodes: &[i64]) -> Surface {
        let mut faces: HashMap<[i64; 3], ([i64; 3], usize)> = HashMap::new();
        for (t, tet) in cell_nodes.as_chunks().0.iter().enumerate() {
            let [a, b, c, d]: [i64; 4] = *tet;
            for face in [[a, c, b], [a, b, d], [b, c, d], [a, d, c]] {
                let mut key = face;
                key.sort_unstable();
                // The second tetrahedron takes it out again.
                if faces.remove(&key).is_none() {
                    faces.insert(key, (face, 4 * t));
                }
            }
        }
        let mut outer: Vec<([i64; 3], usize)> = faces.into_values().collect();
        outer.sort_unstable_by_key(|&(face, place)| (place, face));
        let mut surface = Surface::default();
        let mut numbers: HashMap<i64, u32> = HashMap::new();
        for (face, _) in outer {
            let triangle = face.map(|node| {
                *numbers.entry(node).or_insert_with(|| {
                    surface.nodes.push(node as u32);
                    surface.nodes.len() as u32 - 1
                })
            });
            surface.triangles.push(triangle);
        }
        surface
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_face_between_two_tetrahedra_is_none() {
        let surface = Surface::of(&[0, 1, 2, 3, 1, 2, 3, 9]);
        assert_eq!(surface.triangles.len(), 6);
        let mut nodes = surface.nodes.clone();
        nodes.sort_unstable();
        assert_eq!(nodes, [0, 1, 2, 3, 9]);
        let between = |t: &[u32; 3]| {
            let mut t = t.map(|n| surface.nodes[n as usize]);
            t.sort_unstable();
            t == [1, 2, 3]
        };
        assert!(!surface.triangles.iter().any(between));
    }
}
