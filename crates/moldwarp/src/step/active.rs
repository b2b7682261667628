//! The part of the mesh that does work: cells and nodes that particles touch.
//!
//! A *cell* is an element that holds particles, or an empty one whose four nodes all belong to
//! such elements (it may count as filled). Cells and their nodes are numbered compactly, in the
//! mesh's order, so that the step never looks at the rest. Nodes are grid nodes: a mesh node that is
//! split by a wall has one on each side (`mesh/walls.rs`).

use crate::mesh::{Mesh, NONE, Walls};

/// Compact numbering of cells and nodes.
#[derive(Clone, Debug, Default)]
pub struct Active {
    /// Element of each cell, ascending.
    pub elements: Vec<u32>,
    /// First particle of each cell, and one past the last.
    pub offsets: Vec<u32>,
    /// The four nodes of each cell, as compact numbers.
    pub cell_nodes: Vec<[u32; 4]>,
    /// Mesh node of each node; ascending but for those beyond a wall, which come last.
    pub nodes: Vec<u32>,
    /// Grid node of each node, ascending.
    pub grid: Vec<u32>,
    /// Compact number of each grid node, or [`NONE`].
    pub slot_of_grid: Vec<u32>,
    /// Cell of each element, or [`NONE`].
    pub cell_of_element: Vec<u32>,
    node_offsets: Vec<u32>,
    node_cells: Vec<(u32, u8)>,
}

impl Active {
    /// Cells attached to node `slot`, each with the node's local number in it.
    #[inline]
    pub fn attached(&self, slot: usize) -> &[(u32, u8)] {
        &self.node_cells[self.node_offsets[slot] as usize..self.node_offsets[slot + 1] as usize]
    }

    /// The nodes of an element that is a cell.
    #[inline]
    pub fn nodes_of_element(&self, e: usize) -> [u32; 4] {
        self.cell_nodes[self.cell_of_element[e] as usize]
    }

    /// Whether there is no wall between two neighbours.
    pub fn share_a_face(&self, c: usize, other: usize) -> bool {
        let other = self.cell_nodes[other];
        let shared = self.cell_nodes[c].iter().filter(|n| other.contains(n));
        shared.count() == 3
    }

    /// Numbers cells and nodes anew from the first particle of each element.
    pub fn rebuild(&mut self, mesh: &Mesh, walls: &Walls, particle_offsets: &[u32]) {
        let tets = walls.tets(mesh);
        let occupied = |e: usize| particle_offsets[e] < particle_offsets[e + 1];
        self.slot_of_grid.clear();
        self.slot_of_grid.resize(walls.count(mesh), NONE);
        self.cell_of_element.clear();
        self.cell_of_element.resize(mesh.tets.len(), NONE);
        let touched = 0;
        for e in (0..mesh.tets.len()).filter(|&e| occupied(e)) {
            self.cell_of_element[e] = touched;
            for &n in &tets[e] {
                self.slot_of_grid[n as usize] = touched;
            }
        }
        for (e, tet) in tets.iter().enumerate() {
            if tet.iter().all(|&n| self.slot_of_grid[n as usize] != NONE) {
                self.cell_of_element[e] = touched;
            }
        }
        self.number(mesh, walls, particle_offsets);
        self.attach();
    }

    fn number(&mut self, mesh: &Mesh, walls: &Walls, particle_offsets: &[u32]) {
        let tets = walls.tets(mesh);
        self.nodes.clear();
        self.grid.clear();
        for (n, slot) in self.slot_of_grid.iter_mut().enumerate() {
            if *slot != NONE {
                *slot = self.nodes.len() as u32;
                self.nodes.push(walls.mesh_node(mesh, n as u32));
                self.grid.push(n as u32);
            }
        }
        self.elements.clear();
        self.offsets.clear();
        self.cell_nodes.clear();
        for (e, (cell, tet)) in self.cell_of_element.iter_mut().zip(tets).enumerate() {
            if *cell != NONE {
                *cell = self.elements.len() as u32;
                self.elements.push(e as u32);
                self.offsets.push(particle_offsets[e]);
                self.cell_nodes
                    .push(tet.map(|n| self.slot_of_grid[n as usize]));
            }
        }
        self.offsets.push(particle_offsets[mesh.tets.len()]);
    }

    fn attach(&mut self) {
        let nodes = self.nodes.len();
        self.node_offsets.clear();
        self.node_offsets.resize(nodes + 1, 0);
        for &n in self.cell_nodes.iter().flatten() {
            self.node_offsets[n as usize + 1] += 1;
        }
        for n in 0..nodes {
            self.node_offsets[n + 1] += self.node_offsets[n];
        }
        self.node_cells.clear();
        self.node_cells.resize(4 * self.cell_nodes.len(), (0, 0));
        for (c, cell) in self.cell_nodes.iter().enumerate() {
            for (local, &n) in cell.iter().enumerate() {
                let next = &mut self.node_offsets[n as usize];
                self.node_cells[*next as usize] = (c as u32, local as u8);
                *next += 1;
            }
        }
        // Each offset has moved on to the next node's; move them back.
        self.node_offsets.copy_within(0..nodes, 1);
        self.node_offsets[0] = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;
    use crate::mesh::box_mesh;

    #[test]
    fn empty_elements_between_occupied_ones_are_cells_too() {
        let mesh = box_mesh(Vec3::ONE, [3, 3, 3]).unwrap();
        let hole = mesh.walk(0, Vec3::new(0.52, 0.51, 0.5)).unwrap() as usize;
        let mut offsets = vec![0u32; mesh.tets.len() + 1];
        for e in 0..mesh.tets.len() {
            offsets[e + 1] = offsets[e] + u32::from(e != hole);
        }
        let mut active = Active::default();
        active.rebuild(&mesh, &Walls::default(), &offsets);
        assert_eq!(active.elements.len(), mesh.tets.len());
        assert_eq!(active.offsets[hole], active.offsets[hole + 1]);
        for slot in 0..active.nodes.len() {
            for &(c, local) in active.attached(slot) {
                assert_eq!(active.cell_nodes[c as usize][local as usize] as usize, slot);
            }
        }
        // With particles in one corner only, the rest sleeps.
        let offsets: Vec<u32> = (0..=mesh.tets.len()).map(|e| u32::from(e > 0)).collect();
        active.rebuild(&mesh, &Walls::default(), &offsets);
        assert_eq!((active.elements.len(), active.nodes.len()), (1, 4));
    }
}
