//! The part of the mesh that does work: cells and nodes that particles touch.
//!
//! A *cell* is an element that holds particles, or an empty one whose four nodes all belong to
//! such elements (it may count as filled); an element with particles of several velocity fields is
//! a cell for each. Cells and their nodes are numbered compactly, in the
//! mesh's order, so that the step never looks at the rest. Nodes are grid nodes: a mesh node that is
//! split by a wall has one on each side (`mesh/walls.rs`), and each of these one for every field that
//! it moves with (`contact`).

use crate::contact::Fields;
use crate::mesh::{Mesh, NONE, Walls};
use std::ops::Range;

/// What cells and nodes are made of.
pub struct Grid<'a> {
    pub mesh: &'a Mesh,
    pub walls: &'a Walls,
    pub fields: &'a Fields,
}

impl Grid<'_> {
    /// Field and first of each run of particles of one field among those of an element.
    fn runs(
        &self,
        mut inside: Range<usize>,
        bodies: &[u16],
    ) -> impl Iterator<Item = (usize, usize)> {
        std::iter::from_fn(move || {
            let start = inside.next()?;
            let field = self.fields.of(bodies[start]);
            if self.fields.count() == 1 {
                inside.start = inside.end;
            }
            while !inside.is_empty() && self.fields.of(bodies[inside.start]) == field {
                inside.start += 1;
            }
            Some((field, start))
        })
    }
}

/// Compact numbering of cells and nodes.
#[derive(Clone, Debug, Default)]
pub struct Active {
    /// Element of each cell, ascending.
    pub elements: Vec<u32>,
    /// First particle of each cell, and one past the last.
    pub offsets: Vec<u32>,
    /// The four nodes of each cell, as compact numbers.
    pub cell_nodes: Vec<[u32; 4]>,
    /// Mesh node of each node.
    pub nodes: Vec<u32>,
    /// Field times number of grid nodes plus grid node of each node, ascending.
    pub keys: Vec<u32>,
    /// Compact number of each key, or [`NONE`].
    pub slot_of_key: Vec<u32>,
    /// Field of each cell.
    pub fields: Vec<u8>,
    /// First cell of each element, or [`NONE`]; those of its other fields follow.
    pub cell_of_element: Vec<u32>,
    /// Number of grid nodes of the mesh.
    pub grid_nodes: usize,
    node_offsets: Vec<u32>,
    node_cells: Vec<(u32, u8)>,
}

impl Active {
    /// Cells attached to node `slot`, each with the node's local number in it.
    #[inline]
    pub fn attached(&self, slot: usize) -> &[(u32, u8)] {
        &self.node_cells[self.node_offsets[slot] as usize..self.node_offsets[slot + 1] as usize]
    }

    /// The cell of an element and a field, if there is one.
    #[inline]
    pub fn cell(&self, e: usize, field: usize) -> Option<usize> {
        let first = self.cell_of_element[e] as usize;
        let own = |&c: &usize| self.elements[c] as usize == e;
        (first..self.elements.len())
            .take_while(own)
            .find(|&c| usize::from(self.fields[c]) == field)
    }

    /// Whether an element holds particles, but none of this field.
    pub fn is_foreign(&self, e: usize, field: usize) -> bool {
        let first = self.cell_of_element[e] as usize;
        let occupied = first < self.elements.len() && self.offsets[first] < self.offsets[first + 1];
        occupied && self.cell(e, field).is_none()
    }

    /// Field of a node.
    pub fn field(&self, slot: usize) -> usize {
        self.keys[slot] as usize / self.grid_nodes
    }

    /// Whether there is no wall between two neighbours.
    pub fn share_a_face(&self, c: usize, other: usize) -> bool {
        let other = self.cell_nodes[other];
        let shared = self.cell_nodes[c].iter().filter(|n| other.contains(n));
        shared.count() == 3
    }

    /// Numbers cells and nodes anew from the first particle of each element.
    pub fn rebuild(&mut self, grid: &Grid, particle_offsets: &[u32], bodies: &[u16]) {
        let tets = grid.walls.tets(grid.mesh);
        let nodes = grid.walls.count(grid.mesh);
        let fields = grid.fields.count();
        let key = |field: usize, n: u32| field * nodes + n as usize;
        self.grid_nodes = nodes;
        self.slot_of_key.clear();
        self.slot_of_key.resize(fields * nodes, NONE);
        let touched = 0;
        let inside = |e: usize| particle_offsets[e] as usize..particle_offsets[e + 1] as usize;
        for (e, tet) in tets.iter().enumerate() {
            for (field, _) in grid.runs(inside(e), bodies) {
                for &n in tet {
                    self.slot_of_key[key(field, n)] = touched;
                }
            }
        }
        self.elements.clear();
        self.offsets.clear();
        self.fields.clear();
        self.cell_of_element.clear();
        for (e, tet) in tets.iter().enumerate() {
            let first = self.elements.len();
            let occupied = inside(e);
            for (field, start) in grid.runs(occupied.clone(), bodies) {
                self.push(e, field, start);
            }
            for field in (0..fields).filter(|_| occupied.is_empty()) {
                let all = |n: &u32| self.slot_of_key[key(field, *n)] != NONE;
                if tet.iter().all(all) {
                    self.push(e, field, occupied.start);
                }
            }
            let any = self.elements.len() > first;
            self.cell_of_element
                .push(if any { first as u32 } else { NONE });
        }
        self.offsets.push(particle_offsets[tets.len()]);
        self.number(grid, nodes);
        self.cell_nodes.clear();
        for (&e, &field) in self.elements.iter().zip(&self.fields) {
            let slot = |n: u32| self.slot_of_key[key(usize::from(field), n)];
            self.cell_nodes.push(tets[e as usize].map(slot));
        }
        self.attach();
    }

    fn push(&mut self, e: usize, field: usize, start: usize) {
        self.elements.push(e as u32);
        self.offsets.push(start as u32);
        self.fields.push(field as u8);
    }

    fn number(&mut self, grid: &Grid, nodes: usize) {
        self.nodes.clear();
        self.keys.clear();
        for (key, slot) in self.slot_of_key.iter_mut().enumerate() {
            if *slot != NONE {
                *slot = self.nodes.len() as u32;
                let node = grid.walls.mesh_node(grid.mesh, (key % nodes) as u32);
                self.nodes.push(node);
                self.keys.push(key as u32);
            }
        }
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
        let (walls, fields) = (Walls::default(), Fields::default());
        let grid = Grid {
            mesh: &mesh,
            walls: &walls,
            fields: &fields,
        };
        let bodies = vec![0; mesh.tets.len()];
        active.rebuild(&grid, &offsets, &bodies);
        assert_eq!(active.elements.len(), mesh.tets.len());
        assert_eq!(active.offsets[hole], active.offsets[hole + 1]);
        for slot in 0..active.nodes.len() {
            for &(c, local) in active.attached(slot) {
                assert_eq!(active.cell_nodes[c as usize][local as usize] as usize, slot);
            }
        }
        // With particles in one corner only, the rest sleeps.
        let offsets: Vec<u32> = (0..=mesh.tets.len()).map(|e| u32::from(e > 0)).collect();
        active.rebuild(&grid, &offsets, &bodies);
        assert_eq!((active.elements.len(), active.nodes.len()), (1, 4));
    }
}
