//! Walls: surfaces inside the mesh that hold material on both sides, such as the lining of a tunnel.
//!
//! What lies on one side must not feel what lies on the other: neither masses nor volumetric strains
//! may be averaged across, and a node is as full as the soil on its own side. So a node in a wall is
//! split into *grid nodes*, one for each group of elements around it that hang together without
//! crossing the wall. At the wall's free edge they all do, and the node stays whole.

use super::{Face, Mesh};

/// How walls split the nodes of a mesh.
#[derive(Clone, Debug, Default)]
pub struct Walls {
    /// Grid nodes of each element; empty if there are no walls, when they are the mesh's nodes.
    tets: Vec<[u32; 4]>,
    /// Mesh nodes of the grid nodes beyond the mesh's own, ascending.
    extra: Vec<u32>,
    /// Grid nodes of split nodes and the elements around them, ascending.
    around: Vec<(u32, u32)>,
}

crate::saved!(Walls {
    tets,
    extra,
    around
});

impl Walls {
    /// Whether they are walls of this mesh.
    pub(crate) fn fit(&self, mesh: &Mesh) -> bool {
        let (nodes, elements) = (mesh.nodes.len(), mesh.tets.len());
        let grid_node = |n: &u32| (*n as usize) < nodes + self.extra.len();
        let around = |a: &(u32, u32)| grid_node(&a.0) && (a.1 as usize) < elements;
        (self.tets.is_empty() || self.tets.len() == elements)
            && self.tets.iter().flatten().all(grid_node)
            && self.extra.iter().all(|&n| (n as usize) < nodes)
            && self.around.iter().all(around)
    }

    /// Splits the nodes of these faces. Faces on the outside of the mesh have one side only and
    /// split nothing.
    pub fn new(mesh: &Mesh, faces: impl Iterator<Item = Face>) -> Walls {
        let mut blocked = vec![[false; 4]; mesh.tets.len()];
        let mut nodes = Vec::new();
        for face in faces {
            if let Some(other) = mesh.across(face) {
                blocked[face.element as usize][face.local as usize] = true;
                blocked[other.element as usize][other.local as usize] = true;
                nodes.extend(mesh.face_nodes(face));
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        let mut walls = Walls::default();
        for node in nodes {
            walls.split(mesh, node, &blocked);
        }
        walls.around.sort_unstable();
        walls
    }

    fn split(&mut self, mesh: &Mesh, node: u32, blocked: &[[bool; 4]]) {
        let groups = groups(mesh, node, blocked);
        if groups.iter().all(|&g| g == 0) {
            return;
        }
        if self.tets.is_empty() {
            self.tets = mesh.tets.clone();
        }
        let beyond = (mesh.nodes.len() + self.extra.len()) as u32;
        for (at, &group) in mesh.attached(node).iter().zip(&groups) {
            // The first group keeps the node's number.
            let grid = if group == 0 { node } else { beyond + group - 1 };
            self.tets[at.owner()][at.local()] = grid;
            self.around.push((grid, at.owner() as u32));
        }
        let more = groups.iter().copied().max().unwrap_or(0);
        self.extra.extend((0..more).map(|_| node));
    }

    /// Grid nodes of each element.
    pub fn tets<'a>(&'a self, mesh: &'a Mesh) -> &'a [[u32; 4]] {
        if self.tets.is_empty() {
            &mesh.tets
        } else {
            &self.tets
        }
    }

    /// Number of grid nodes.
    pub fn count(&self, mesh: &Mesh) -> usize {
        mesh.nodes.len() + self.extra.len()
    }

    /// The mesh node that a grid node is part of.
    pub fn mesh_node(&self, mesh: &Mesh, grid: u32) -> u32 {
        let beyond = (grid as usize).checked_sub(mesh.nodes.len());
        beyond.map_or(grid, |k| self.extra[k])
    }

    /// The grid nodes of a mesh node.
    pub fn grid_nodes(&self, mesh: &Mesh, node: u32) -> impl Iterator<Item = u32> + use<> {
        let first = self.extra.partition_point(|&n| n < node);
        let last = self.extra.partition_point(|&n| n <= node);
        let beyond = mesh.nodes.len();
        std::iter::once(node).chain((first..last).map(move |k| (beyond + k) as u32))
    }

    /// Volume of the elements around a grid node, m³.
    pub fn volume(&self, mesh: &Mesh, grid: u32) -> f64 {
        match self.split_around(grid) {
            [] => mesh.node_volumes[grid as usize],
            own => own.iter().map(|a| mesh.volumes[a.1 as usize]).sum(),
        }
    }

    /// The elements around a grid node.
    pub fn elements(&self, mesh: &Mesh, grid: u32) -> impl Iterator<Item = u32> {
        let split = self.split_around(grid);
        let whole = match split {
            [] => mesh.attached(grid),
            _ => &[],
        };
        split
            .iter()
            .map(|a| a.1)
            .chain(whole.iter().map(|at| at.owner() as u32))
    }

    /// The grid node with each element around it if it is part of a split node, else nothing.
    fn split_around(&self, grid: u32) -> &[(u32, u32)] {
        let first = self.around.partition_point(|a| a.0 < grid);
        let count = self.around[first..].partition_point(|a| a.0 == grid);
        &self.around[first..first + count]
    }
}

/// For each element around a node the number of its group: elements that hang together across faces
/// at the node that are not blocked. Numbered in the elements' order.
fn groups(mesh: &Mesh, node: u32, blocked: &[[bool; 4]]) -> Vec<u32> {
    const NEW: u32 = u32::MAX;
    let around = mesh.attached(node);
    let mut groups = vec![NEW; around.len()];
    let mut next = 0;
    while let Some(start) = groups.iter().position(|&g| g == NEW) {
        groups[start] = next;
        let mut waiting = vec![start];
        while let Some(k) = waiting.pop() {
            let (e, own) = (around[k].owner(), around[k].local());
            // Faces at the node are those opposite the others.
            for local in (0..4).filter(|&l| l != own) {
                let across = mesh.neighbours[e][local];
                let other = around.iter().position(|a| a.owner() as u32 == across);
                let other = other.filter(|&o| groups[o] == NEW && !blocked[e][local]);
                if let Some(other) = other {
                    groups[other] = next;
                    waiting.push(other);
                }
            }
        }
        next += 1;
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;
    use crate::mesh::{NONE, box_mesh};

    /// A plane across a box splits each of its nodes in two; one that ends inside does not split
    /// the nodes of its free edge.
    #[test]
    fn a_wall_splits_what_it_separates() {
        let mesh = box_mesh(Vec3::new(4.0, 2.0, 2.0), [4, 2, 2]).unwrap();
        let in_plane = |face: &Face, most: f64| {
            let corners = mesh.face_nodes(*face).map(|n| mesh.nodes[n as usize]);
            corners.iter().all(|x| x.x == 2.0 && x.z <= most)
        };
        let faces = || {
            let faces = (0..mesh.tets.len() as u32)
                .flat_map(|element| (0..4).map(move |local| Face { element, local }));
            faces.filter(|f| mesh.neighbours[f.element as usize][f.local as usize] != NONE)
        };
        let whole = Walls::new(&mesh, faces().filter(|f| in_plane(f, 2.0)));
        assert_eq!(whole.count(&mesh), mesh.nodes.len() + 9);
        let half = Walls::new(&mesh, faces().filter(|f| in_plane(f, 1.0)));
        assert_eq!(half.count(&mesh), mesh.nodes.len() + 3);
        for walls in [whole, half] {
            for (e, (grid, own)) in walls.tets(&mesh).iter().zip(&mesh.tets).enumerate() {
                assert_eq!(grid.map(|g| walls.mesh_node(&mesh, g)), *own, "element {e}");
            }
            for node in 0..mesh.nodes.len() as u32 {
                let grid: Vec<u32> = walls.grid_nodes(&mesh, node).collect();
                let volume: f64 = grid.iter().map(|&g| walls.volume(&mesh, g)).sum();
                assert!((volume / mesh.node_volumes[node as usize] - 1.0).abs() < 1e-14);
            }
        }
        let outside = Walls::new(&mesh, mesh.boundary_faces());
        assert_eq!(outside.count(&mesh), mesh.nodes.len());
    }
}
