//! A mesh as bytes: what it was made of, from which it is made again with the same bits.

use super::{Face, Mesh, RawMesh, Surface, VolumeGroup};
use crate::Vec3;
use crate::saved::{Broken, Bytes, Out, Part, Saved, list_size, save_list};

/// A mesh with its nodes somewhere else, to be saved.
#[derive(Clone, Copy)]
pub struct MeshAt<'a> {
    mesh: &'a Mesh,
    nodes: &'a [Vec3],
}

impl<'a> MeshAt<'a> {
    /// `nodes` are coordinates in m, as many as the mesh has nodes.
    pub fn new(mesh: &'a Mesh, nodes: &'a [Vec3]) -> MeshAt<'a> {
        MeshAt { mesh, nodes }
    }
}

impl Part for MeshAt<'_> {
    fn count(&self) -> usize {
        let Mesh {
            tets,
            volume_groups,
            surfaces,
            ..
        } = self.mesh;
        list_size(self.nodes) + tets.size() + volume_groups.size() + surfaces.size()
    }

    fn write(&self, out: &mut Out) {
        // Taken apart, so that nothing that is no matter of nodes and elements is forgotten.
        let Mesh {
            nodes: _,
            tets,
            volumes: _,
            neighbours: _,
            node_volumes: _,
            node_offsets: _,
            node_elements: _,
            volume_groups,
            surfaces,
        } = self.mesh;
        save_list(self.nodes, out);
        tets.save(out);
        volume_groups.save(out);
        surfaces.save(out);
    }
}

impl Saved for Mesh {
    fn size(&self) -> usize {
        MeshAt::new(self, &self.nodes).count()
    }

    fn save(&self, out: &mut Out) {
        MeshAt::new(self, &self.nodes).write(out);
    }

    fn load(from: &mut Bytes) -> Result<Mesh, Broken> {
        let nodes = Vec::load(from)?;
        let tets: Vec<[u32; 4]> = Vec::load(from)?;
        let groups: Vec<VolumeGroup> = Vec::load(from)?;
        let surfaces: Vec<Surface> = Vec::load(from)?;
        let there = |face: &Face| (face.element as usize) < tets.len() && face.local < 4;
        let mut elements = groups.iter().flat_map(|g| &g.elements);
        let right = elements.all(|&e| (e as usize) < tets.len())
            && surfaces.iter().flat_map(|s| &s.faces).all(there);
        if !right {
            return Err(Broken::new("a mesh"));
        }
        let corners = |face: &Face| {
            let tet = tets[face.element as usize];
            super::FACE_NODES[usize::from(face.local)].map(|i| tet[i])
        };
        let triangles = |s: &Surface| s.faces.iter().map(corners).collect();
        let surface_groups = surfaces.iter().map(|s| (s.name.clone(), triangles(s)));
        let raw = RawMesh {
            volume_groups: groups.into_iter().map(|g| (g.name, g.elements)).collect(),
            surface_groups: surface_groups.collect(),
            nodes,
            tets,
        };
        Mesh::new(raw).map_err(|error| Broken::new(format!("a mesh: {error}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::box_mesh;
    use crate::saved::{Section, load, to_bytes};

    #[test]
    fn a_mesh_comes_back_with_its_geometry() {
        let mesh = box_mesh(Vec3::new(0.3, 0.7, 1.1), [2, 3, 4]).unwrap();
        let bytes = to_bytes(&mesh);
        let back: Mesh = load(&bytes).unwrap();
        // Debug prints each number so that it reads back the same.
        assert_eq!(format!("{mesh:?}"), format!("{back:?}"));
        assert!(load::<Mesh>(&bytes[1..]).is_err());
        let mut moved = mesh.clone();
        moved.nodes.iter_mut().for_each(|x| x.z *= 2.0);
        let before = MeshAt::new(&moved, &mesh.nodes);
        assert_eq!(Section::new(&before).to_bytes(), bytes);
    }
}
