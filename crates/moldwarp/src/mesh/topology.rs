//! From bare elements to a connected mesh.

use super::{
    Corner, FACE_NODES, Face, Mesh, MeshError, NONE, RawMesh, Surface, VolumeGroup,
    tetrahedron_gradients,
};
use crate::Vec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

impl Mesh {
    /// Connects elements to a mesh.
    ///
    /// If *all* elements are numbered the other way round they are turned; single inverted
    /// elements are an error, since they are what a damaged mesh looks like.
    pub fn new(raw: RawMesh) -> Result<Mesh, MeshError> {
        let RawMesh {
            nodes,
            mut tets,
            volume_groups,
            surface_groups,
        } = raw;
        check_numbers(&nodes, &tets)?;
        orient(&nodes, &mut tets)?;
        let (node_offsets, node_elements) = node_to_elements(nodes.len(), &tets);
        let faces = Faces {
            tets: &tets,
            offsets: &node_offsets,
            attached: &node_elements,
        };
        let neighbours = faces.neighbours()?;
        let surfaces = surfaces(surface_groups, &faces)?;
        let volume_groups = volumes(volume_groups, tets.len())?;
        let count = tets.len();
        let mut mesh = Mesh {
            volumes: vec![0.0; count],
            node_volumes: vec![0.0; nodes.len()],
            nodes,
            tets,
            neighbours,
            node_offsets,
            node_elements,
            volume_groups,
            surfaces,
        };
        mesh.update_geometry();
        Ok(mesh)
    }
}

fn check_numbers(nodes: &[Vec3], tets: &[[u32; 4]]) -> Result<(), MeshError> {
    if tets.is_empty() {
        return Err(MeshError::Empty);
    }
    if let Some(node) = nodes.iter().position(|x| !x.is_finite()) {
        return Err(MeshError::NotFinite { node });
    }
    for (element, tet) in tets.iter().enumerate() {
        if let Some(&node) = tet.iter().find(|&&n| n as usize >= nodes.len()) {
            return Err(MeshError::NoSuchNode {
                element,
                node,
                count: nodes.len(),
            });
        }
    }
    Ok(())
}

fn orient(nodes: &[Vec3], tets: &mut [[u32; 4]]) -> Result<(), MeshError> {
    let signed: Vec<(f64, f64)> = tets
        .par_iter()
        .map(|tet| {
            let x = tet.map(|n| nodes[n as usize]);
            let longest = (1..4).map(|i| (x[i] - x[0]).length()).fold(0.0, f64::max);
            (tetrahedron_gradients(x).1, longest)
        })
        .collect();
    // Flat: thinner than round-off of the coordinates can tell.
    let is_flat =
        |&(volume, longest): &(f64, f64)| volume.abs() <= 1e-13 * longest * longest * longest;
    let flat: Vec<usize> = (0..tets.len()).filter(|&e| is_flat(&signed[e])).collect();
    if let Some(&element) = flat.first() {
        return Err(MeshError::Flat {
            element,
            volume: signed[element].0,
            others: flat.len() - 1,
        });
    }
    let inverted: Vec<usize> = (0..tets.len()).filter(|&e| signed[e].0 < 0.0).collect();
    if inverted.len() == tets.len() {
        tets.iter_mut().for_each(|tet| tet.swap(2, 3));
    } else if let Some(&element) = inverted.first() {
        return Err(MeshError::Inverted {
            element,
            volume: signed[element].0,
            others: inverted.len() - 1,
        });
    }
    Ok(())
}

fn node_to_elements(nodes: usize, tets: &[[u32; 4]]) -> (Vec<u32>, Vec<Corner>) {
    assert!(tets.len() < 1 << 30, "corners have 30 bits for elements");
    let mut offsets = vec![0u32; nodes + 1];
    for &n in tets.iter().flatten() {
        offsets[n as usize + 1] += 1;
    }
    for n in 0..nodes {
        offsets[n + 1] += offsets[n];
    }
    let mut next = offsets.clone();
    let mut attached = vec![Corner::default(); tets.len() * 4];
    for (e, tet) in tets.iter().enumerate() {
        for (local, &n) in tet.iter().enumerate() {
            attached[next[n as usize] as usize] = Corner::new(e, local);
            next[n as usize] += 1;
        }
    }
    (offsets, attached)
}

/// Faces are found among the elements at one of their nodes, about two dozen: no list of all faces is
/// needed, which would be larger than the mesh.
struct Faces<'a> {
    tets: &'a [[u32; 4]],
    offsets: &'a [u32],
    attached: &'a [Corner],
}

impl Faces<'_> {
    /// The sides of elements with these three nodes, by element.
    fn sides(&self, nodes: [u32; 3]) -> impl Iterator<Item = Face> + '_ {
        let at = |n: u32| {
            let ends = (
                self.offsets.get(n as usize),
                self.offsets.get(n as usize + 1),
            );
            let (Some(&from), Some(&to)) = ends else {
                return &[][..];
            };
            &self.attached[from as usize..to as usize]
        };
        let fewest = nodes
            .map(at)
            .into_iter()
            .min_by_key(|corners| corners.len());
        let corners = fewest.unwrap_or_default().iter();
        corners.filter_map(move |corner| {
            let tet = &self.tets[corner.owner()];
            // Three of four nodes: the one that is not among them lies opposite.
            let mut opposite = (0..4).filter(|&i| !nodes.contains(&tet[i]));
            let (local, more) = (opposite.next()?, opposite.next());
            more.is_none().then_some(Face {
                element: corner.owner() as u32,
                local: local as u8,
            })
        })
    }

    /// The element across each side of each element.
    ///
    /// # Errors
    ///
    /// Of the faces with more than two sides, the one whose sorted nodes come first.
    fn neighbours(&self) -> Result<Vec<[u32; 4]>, MeshError> {
        // Each side is one of its least node, and so written by one thread.
        let none = |_| [NONE; 4].map(AtomicU32::new);
        let neighbours: Vec<[AtomicU32; 4]> = self.tets.par_iter().map(none).collect();
        let connect = |side: &Side, to: &Side| {
            let Face { element, local } = side.face();
            let place = &neighbours[element as usize][usize::from(local)];
            place.store(to.face().element, Ordering::Relaxed);
        };
        let nodes = (0..self.offsets.len() - 1).into_par_iter();
        let shared = nodes
            .with_min_len(1024)
            .map_init(Vec::new, |sides, n| {
                self.sides_of_least_node(n, sides);
                for same in sides.chunk_by(|a, b| a.others == b.others) {
                    match same {
                        [] | [_] => {}
                        [a, b] => {
                            connect(a, b);
                            connect(b, a);
                        }
                        [first, ..] => {
                            let [b, c] = first.others;
                            let elements = same.iter().map(|s| s.face().element).collect();
                            let nodes = [n as u32, b, c];
                            return Some(MeshError::FaceShared { nodes, elements });
                        }
                    }
                }
                None
            })
            .find_map_first(|error| error);
        match shared {
            Some(error) => Err(error),
            None => {
                let neighbours = neighbours.into_iter();
                Ok(neighbours.map(|of| of.map(AtomicU32::into_inner)).collect())
            }
        }
    }

    /// All sides of elements whose least node is `n`, in order.
    fn sides_of_least_node(&self, n: usize, sides: &mut Vec<Side>) {
        sides.clear();
        for corner in &self.attached[self.offsets[n] as usize..self.offsets[n + 1] as usize] {
            let tet = &self.tets[corner.owner()];
            for opposite in (0..4).filter(|&i| i != corner.local()) {
                let mut others = FACE_NODES[opposite]
                    .into_iter()
                    .filter(|&i| i != corner.local());
                let [Some(i), Some(j)] = [others.next(), others.next()] else {
                    unreachable!("a face has three nodes");
                };
                let (low, high) = (tet[i].min(tet[j]), tet[i].max(tet[j]));
                if low > n as u32 {
                    sides.push(Side {
                        others: [low, high],
                        corner: Corner::new(corner.owner(), opposite),
                    });
                }
            }
        }
        sides.sort_unstable_by_key(|side| (side.others, side.corner.owner()));
    }
}

/// A face of an element by the two greater ones of its nodes.
struct Side {
    others: [u32; 2],
    /// The corner opposite it.
    corner: Corner,
}

impl Side {
    fn face(&self) -> Face {
        Face {
            element: self.corner.owner() as u32,
            local: self.corner.local() as u8,
        }
    }
}

fn surfaces(
    groups: Vec<(String, Vec<[u32; 3]>)>,
    faces: &Faces,
) -> Result<Vec<Surface>, MeshError> {
    let find = |surface: &str, nodes: [u32; 3]| {
        let face = faces.sides(nodes).next();
        face.ok_or_else(|| MeshError::NoSuchFace {
            surface: surface.to_owned(),
            nodes,
        })
    };
    groups
        .into_iter()
        .map(|(name, triangles)| {
            let faces = triangles
                .into_iter()
                .map(|t| find(&name, t))
                .collect::<Result<_, _>>()?;
            Ok(Surface { name, faces })
        })
        .collect()
}

fn volumes(
    groups: Vec<(String, Vec<u32>)>,
    elements: usize,
) -> Result<Vec<VolumeGroup>, MeshError> {
    let mut owner = vec![NONE; elements];
    for (g, (name, members)) in groups.iter().enumerate() {
        for &element in members {
            let owner = &mut owner[element as usize];
            if *owner != NONE && *owner != g as u32 {
                let first = groups[*owner as usize].0.clone();
                return Err(MeshError::TwoVolumes {
                    element,
                    first,
                    second: name.clone(),
                });
            }
            *owner = g as u32;
        }
    }
    Ok(groups
        .into_iter()
        .map(|(name, elements)| VolumeGroup { name, elements })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_tet() -> RawMesh {
        RawMesh {
            nodes: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
            tets: vec![[0, 1, 2, 3]],
            volume_groups: vec![("soil".into(), vec![0])],
            surface_groups: vec![("base".into(), vec![[2, 0, 1]])],
        }
    }

    #[test]
    fn a_face_has_its_area_and_outward_normal() {
        let mesh = Mesh::new(unit_tet()).unwrap();
        assert_eq!(
            mesh.face_area(mesh.surfaces[0].faces[0]),
            Vec3::new(0.0, 0.0, -0.5)
        );
        assert_eq!(mesh.boundary_faces().count(), 4);
        let closed: Vec3 = mesh.boundary_faces().map(|f| mesh.face_area(f)).sum();
        assert!(closed.length() < 1e-16);
    }

    #[test]
    fn a_wholly_turned_mesh_is_turned_back_and_a_partly_turned_one_refused() {
        let mut raw = unit_tet();
        raw.tets = vec![[0, 2, 1, 3]];
        assert!(Mesh::new(raw.clone()).unwrap().volumes[0] > 0.0);
        raw.nodes.push(Vec3::ONE);
        raw.tets.push([1, 2, 3, 4]);
        assert!(matches!(
            Mesh::new(raw),
            Err(MeshError::Inverted {
                element: 0,
                others: 0,
                ..
            })
        ));
    }

    #[test]
    fn damaged_meshes_are_named() {
        let mut flat = unit_tet();
        flat.nodes[3] = Vec3::new(0.3, 0.3, 0.0);
        assert!(matches!(
            Mesh::new(flat),
            Err(MeshError::Flat { element: 0, .. })
        ));
        let mut far = unit_tet();
        far.tets[0][2] = 9;
        assert!(matches!(
            Mesh::new(far),
            Err(MeshError::NoSuchNode { node: 9, .. })
        ));
        let mut nan = unit_tet();
        nan.nodes[1].y = f64::NAN;
        assert_eq!(
            Mesh::new(nan).unwrap_err(),
            MeshError::NotFinite { node: 1 }
        );
        let mut fan = unit_tet();
        fan.nodes
            .extend([Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.0, 0.0, 3.0)]);
        fan.tets = vec![[0, 1, 2, 3], [0, 1, 2, 4], [0, 1, 2, 5]];
        assert!(matches!(
            Mesh::new(fan),
            Err(MeshError::FaceShared {
                nodes: [0, 1, 2],
                ..
            })
        ));
        let mut stray = unit_tet();
        stray.nodes.push(Vec3::ONE);
        stray.surface_groups[0].1[0] = [0, 1, 4];
        assert!(matches!(
            Mesh::new(stray),
            Err(MeshError::NoSuchFace { .. })
        ));
        let mut twice = unit_tet();
        twice.volume_groups.push(("clay".into(), vec![0]));
        assert!(matches!(
            Mesh::new(twice),
            Err(MeshError::TwoVolumes { element: 0, .. })
        ));
    }
}
