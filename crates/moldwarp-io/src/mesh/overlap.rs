//! Elements that lie in each other.

use moldwarp::Mesh;
use moldwarp::mesh::Face;

/// Two elements that share a face and lie on the same side of it.
///
/// Only neighbours are looked at: parts of a mesh that touch in no face may lie in each other
/// unnoticed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "elements {first} and {second} overlap: they lie on the same side of the face that they share; if \
     volumes of the geometry overlap, cut them apart with `Coherence;` in the .geo"
)]
pub struct Overlap {
    /// The file's tags of both.
    pub first: u64,
    pub second: u64,
}

/// Refuses a mesh with such elements; `element_tags` are the numbers of its elements in their file.
///
/// # Errors
///
/// The first two in the order of the file.
pub fn check_overlap(mesh: &Mesh, element_tags: &[u64]) -> Result<(), Overlap> {
    for element in 0..mesh.tets.len() as u32 {
        for local in 0..4 {
            let face = Face { element, local };
            let Some(other) = mesh.across(face).filter(|o| o.element > element) else {
                continue;
            };
            // Seen from outside an element its faces run counter-clockwise. From both sides of a face one
            // of the two runs is the other way round.
            let [a, b, c] = mesh.face_nodes(face);
            let [d, e, f] = mesh.face_nodes(other);
            if [[a, b, c], [b, c, a], [c, a, b]].contains(&[d, e, f]) {
                let tag = |e: u32| element_tags[e as usize];
                return Err(Overlap {
                    first: tag(element),
                    second: tag(other.element),
                });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use moldwarp::Vec3;
    use moldwarp::mesh::{RawMesh, box_mesh};

    #[test]
    fn neighbours_lie_on_either_side_of_their_face() {
        let mesh = box_mesh(Vec3::ONE, [2; 3]).unwrap();
        let tags: Vec<u64> = (1..=mesh.tets.len() as u64).collect();
        assert_eq!(check_overlap(&mesh, &tags), Ok(()));
        let inside = Mesh::new(RawMesh {
            nodes: vec![
                Vec3::ZERO,
                Vec3::X,
                Vec3::Y,
                Vec3::Z,
                Vec3::new(0.2, 0.2, 0.5),
            ],
            tets: vec![[0, 1, 2, 3], [0, 1, 2, 4]],
            ..RawMesh::default()
        });
        let overlap = Overlap {
            first: 7,
            second: 9,
        };
        assert_eq!(check_overlap(&inside.unwrap(), &[7, 9]), Err(overlap));
    }
}
