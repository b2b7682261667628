//! From bare elements to a connected mesh.

use super::{
    Corner, FACE_NODES, Face, Mesh, MeshError, NONE, RawMesh, Surface, VolumeGroup,
    tetrahedron_gradients,
};
use crate::Vec3;
use rayon::prelude::*;

/// A face by its sorted nodes, with the element and local face it belongs to.
type FaceKey = ([u32; 3], u32, u8);

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
        let faces = sorted_faces(&tets);
        let neighbours = neighbours(tets.len(), &faces)?;
        let surfaces = surfaces(surface_groups, &faces)?;
        let volume_groups = volumes(volume_groups, tets.len())?;
        let count = tets.len();
        let mut mesh = Mesh {
            volumes: vec![0.0; count],
            altitudes: vec![0.0; count],
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

fn sorted_faces(tets: &[[u32; 4]]) -> Vec<FaceKey> {
    let mut faces: Vec<FaceKey> = tets
        .par_iter()
        .enumerate()
        .flat_map_iter(|(e, tet)| {
            FACE_NODES.iter().enumerate().map(move |(local, corners)| {
                let mut key = corners.map(|i| tet[i]);
                key.sort_unstable();
                (key, e as u32, local as u8)
            })
        })
        .collect();
    faces.par_sort_unstable();
    faces
}

fn neighbours(elements: usize, faces: &[FaceKey]) -> Result<Vec<[u32; 4]>, MeshError> {
    let mut neighbours = vec![[NONE; 4]; elements];
    for same in faces.chunk_by(|a, b| a.0 == b.0) {
        match same {
            [_] => {}
            [a, b] => {
                neighbours[a.1 as usize][a.2 as usize] = b.1;
                neighbours[b.1 as usize][b.2 as usize] = a.1;
            }
            more => {
                let elements = more.iter().map(|f| f.1).collect();
                return Err(MeshError::FaceShared {
                    nodes: more[0].0,
                    elements,
                });
            }
        }
    }
    Ok(neighbours)
}

fn surfaces(
    groups: Vec<(String, Vec<[u32; 3]>)>,
    faces: &[FaceKey],
) -> Result<Vec<Surface>, MeshError> {
    let find = |surface: &str, nodes: [u32; 3]| {
        let mut key = nodes;
        key.sort_unstable();
        let at = faces.partition_point(|f| f.0 < key);
        match faces.get(at) {
            Some(&(found, element, local)) if found == key => Ok(Face { element, local }),
            _ => Err(MeshError::NoSuchFace {
                surface: surface.to_owned(),
                nodes,
            }),
        }
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
