//! A mesh as bytes; its geometry is that of its nodes, computed anew with the same bits.

use super::Mesh;
use crate::saved::{Broken, Bytes, Saved};

impl Saved for Mesh {
    fn save(&self, out: &mut Vec<u8>) {
        let Mesh {
            nodes,
            tets,
            volumes: _,
            altitudes: _,
            neighbours,
            node_volumes: _,
            node_offsets,
            node_elements,
            volume_groups,
            surfaces,
        } = self;
        nodes.save(out);
        tets.save(out);
        neighbours.save(out);
        node_offsets.save(out);
        node_elements.save(out);
        volume_groups.save(out);
        surfaces.save(out);
    }

    fn load(from: &mut Bytes) -> Result<Mesh, Broken> {
        let nodes = Vec::load(from)?;
        let tets: Vec<[u32; 4]> = Vec::load(from)?;
        let mut mesh = Mesh {
            volumes: vec![0.0; tets.len()],
            altitudes: vec![0.0; tets.len()],
            neighbours: Vec::load(from)?,
            node_volumes: vec![0.0; nodes.len()],
            node_offsets: Vec::load(from)?,
            node_elements: Vec::load(from)?,
            volume_groups: Vec::load(from)?,
            surfaces: Vec::load(from)?,
            nodes,
            tets,
        };
        let known = |n: &u32| (*n as usize) < mesh.nodes.len();
        let right = mesh.tets.as_flattened().iter().all(known)
            && mesh.node_offsets.len() == mesh.nodes.len() + 1
            && mesh.node_elements.len() == 4 * mesh.tets.len();
        if !right {
            return Err(Broken::new("a mesh"));
        }
        mesh.update_geometry();
        Ok(mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;
    use crate::mesh::box_mesh;
    use crate::saved::load;

    #[test]
    fn a_mesh_comes_back_with_its_geometry() {
        let mesh = box_mesh(Vec3::new(0.3, 0.7, 1.1), [2, 3, 4]).unwrap();
        let mut bytes = Vec::new();
        mesh.save(&mut bytes);
        let back: Mesh = load(&bytes).unwrap();
        // Debug prints each number so that it reads back the same.
        assert_eq!(format!("{mesh:?}"), format!("{back:?}"));
        assert!(load::<Mesh>(&bytes[1..]).is_err());
    }
}
