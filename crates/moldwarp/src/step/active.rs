//! The part of the mesh that does work: cells and nodes that particles touch.
//!
//! A *cell* is an element that holds particles, or an empty one whose four nodes all belong to
//! such elements (it may count as filled); an element with particles of several velocity fields is
//! a cell for each. Cells and their nodes are numbered compactly, nodes in the
//! mesh's order and cells nearly (`lanes.rs`), so that the step never looks at the rest. Nodes are grid nodes: a mesh node that is
//! split by a wall has one on each side (`mesh/walls.rs`), and each of these one for every field that
//! it moves with (`contact`).

use super::corners::{Numbers, TileNodes};
use crate::contact::Fields;
use crate::lanes::{LANES, Pile, Tiles};
use crate::mesh::{Corner, Mesh, NONE, Walls};
use crate::particles::Order;
use std::ops::Range;

/// What cells and nodes are made of.
pub struct Grid<'a> {
    pub mesh: &'a Mesh,
    pub walls: &'a Walls,
    pub fields: &'a Fields,
    /// Whether elements next to those with particles are cells, too: particles may come to them before
    /// cells are found anew.
    pub margin: bool,
}

/// Cells and nodes, numbered compactly.
#[derive(Clone, Debug, Default)]
pub struct Active {
    /// How cells and their particles lie side by side.
    pub tiles: Tiles,
    /// Element of each lane of the tiles, or [`NONE`]. A lane that helps another has that one's element.
    pub elements: Vec<u32>,
    /// The four nodes of each lane's cell, as compact numbers; where there is none, those of another one.
    pub cell_nodes: Numbers<4>,
    /// Whether a lane is a cell: it is neither empty nor a helper.
    pub is_cell: Vec<bool>,
    /// Field of each lane's cell.
    pub fields: Vec<u8>,
    /// Rank of the first particle of each cell (`particles/order.rs`), and their number.
    ranks: Vec<(u32, u32)>,
    /// Mesh node of each node.
    pub nodes: Vec<u32>,
    /// Field times number of grid nodes plus grid node of each node, ascending.
    pub keys: Vec<u32>,
    /// Compact number of each key, or [`NONE`].
    pub slot_of_key: Vec<u32>,
    /// Number of grid nodes of the mesh.
    pub grid_nodes: usize,
    /// Cell of each element and field, or [`NONE`].
    cell_of: Vec<u32>,
    field_count: usize,
    node_offsets: Vec<u32>,
    node_cells: Vec<Corner>,
    listed: Vec<Listed>,
    /// Tiles without those of guests.
    own_tiles: usize,
    guest_cells: Vec<u32>,
}

/// A cell as it is found, before it has a number.
#[derive(Clone, Copy, Debug)]
struct Listed {
    element: u32,
    first: u32,
    count: u32,
    field: u8,
}

impl Active {
    /// Corners of cells at node `slot`, where there is more than one field.
    #[inline]
    pub fn attached(&self, slot: usize) -> &[Corner] {
        &self.node_cells[self.node_offsets[slot] as usize..self.node_offsets[slot + 1] as usize]
    }

    /// The nodes of a tile's cells.
    #[inline(always)]
    pub fn tile_nodes(&self, tile: usize) -> TileNodes<'_> {
        self.cell_nodes.tile(tile)
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.listed.len()
    }

    /// Ranks of the particles of a cell.
    pub fn ranks(&self, c: usize) -> Range<usize> {
        let (first, count) = self.ranks[c];
        first as usize..(first + count) as usize
    }

    /// The cell of an element and a field, if there is one.
    #[inline]
    pub fn cell(&self, e: usize, field: usize) -> Option<usize> {
        let cell = self.cell_of[e * self.field_count + field];
        (cell != NONE).then_some(cell as usize)
    }

    /// Whether an element holds particles, but none of this field.
    pub fn is_foreign(&self, e: usize, field: usize) -> bool {
        let mut cells = (0..self.field_count).filter_map(|f| self.cell(e, f));
        self.cell(e, field).is_none() && cells.any(|c| self.ranks[c].1 > 0)
    }

    /// Field of a node.
    pub fn field(&self, slot: usize) -> usize {
        self.keys[slot] as usize / self.grid_nodes
    }

    /// Whether two cells have three nodes in common: a wall may lie between.
    pub fn share_a_face(&self, c: usize, other: usize) -> bool {
        let of_other = &self.cell_nodes[other];
        let common = |n: &&u32| of_other.contains(n);
        self.cell_nodes[c].iter().filter(common).count() == 3
    }

    /// Finds cells and nodes anew, and gives particles their places.
    pub fn rebuild(&mut self, grid: &Grid, order: &mut Order) {
        let tets = grid.walls.tets(grid.mesh);
        let nodes = grid.walls.count(grid.mesh);
        let fields = grid.fields.count();
        let key = |field: usize, n: u32| field * nodes + n as usize;
        (self.grid_nodes, self.field_count) = (nodes, fields);
        self.slot_of_key.clear();
        self.slot_of_key.resize(fields * nodes, NONE);
        let touched = 0;
        for (e, tet) in tets.iter().enumerate() {
            for (field, _) in order.runs(e) {
                for &n in tet {
                    self.slot_of_key[key(field, n)] = touched;
                }
            }
        }
        self.listed.clear();
        for (e, tet) in tets.iter().enumerate() {
            let mut empty = true;
            for (field, ranks) in order.runs(e) {
                empty = false;
                self.list(e, field, ranks);
            }
            if !empty {
                continue;
            }
            let least = if grid.margin { 3 } else { 4 };
            for field in 0..fields {
                let touched = |n: &&u32| self.slot_of_key[key(field, **n)] != NONE;
                if tet.iter().filter(touched).count() >= least {
                    self.list(e, field, 0..0);
                }
            }
        }
        if grid.margin {
            for cell in &self.listed {
                for &n in &tets[cell.element as usize] {
                    self.slot_of_key[key(usize::from(cell.field), n)] = touched;
                }
            }
        }
        self.number_nodes(grid, nodes);
        self.number_cells(tets, order);
        // Only contact asks for the cells around a node.
        if fields > 1 {
            self.attach();
        }
    }

    fn list(&mut self, e: usize, field: usize, ranks: Range<usize>) {
        self.listed.push(Listed {
            element: e as u32,
            first: ranks.start as u32,
            count: ranks.len() as u32,
            field: field as u8,
        });
    }

    fn number_cells(&mut self, tets: &[[u32; 4]], order: &mut Order) {
        let Active {
            tiles,
            elements,
            cell_nodes,
            is_cell,
            fields,
            ranks,
            slot_of_key,
            grid_nodes,
            cell_of,
            field_count,
            listed,
            ..
        } = self;
        elements.clear();
        cell_nodes.clear();
        is_cell.clear();
        fields.clear();
        ranks.clear();
        cell_of.clear();
        cell_of.resize(tets.len() * *field_count, NONE);
        let lane = |pile: Option<Pile>| {
            is_cell.push(pile.is_some_and(|pile| !pile.more));
            let Some(pile) = pile else {
                elements.push(NONE);
                cell_nodes.push(*cell_nodes.last().expect("a tile begins with a cell"));
                fields.push(0);
                ranks.push((0, 0));
                return;
            };
            let cell = listed[pile.cell as usize];
            let (e, field) = (cell.element as usize, usize::from(cell.field));
            if !pile.more {
                cell_of[e * *field_count + field] = elements.len() as u32;
            }
            elements.push(cell.element);
            cell_nodes.push(tets[e].map(|n| slot_of_key[field * *grid_nodes + n as usize]));
            fields.push(cell.field);
            ranks.push((cell.first, cell.count));
        };
        let cells = listed.iter().map(|cell| (cell.first, cell.count));
        tiles.rebuild(cells, lane, |rank, place| order.put(rank, place));
        self.own_tiles = self.tiles.len();
        self.guest_cells.clear();
    }

    /// Room for guests.
    pub fn make_room(&mut self, tiles: usize) {
        let lanes = tiles * LANES;
        self.tiles.reserve(tiles);
        self.elements.reserve(lanes);
        self.cell_nodes.reserve(lanes);
        self.is_cell.reserve(lanes);
        self.fields.reserve(lanes);
        self.ranks.reserve(lanes);
        self.guest_cells.reserve(lanes);
    }

    /// Lays out more guests behind all others: cells that they are in and how many each has. `put` is told the
    /// place of each.
    pub fn invite(&mut self, guests: &[(u32, u32)], put: impl FnMut(u32, u32)) {
        let Active {
            tiles,
            elements,
            cell_nodes,
            is_cell,
            fields,
            ranks,
            guest_cells,
            ..
        } = self;
        let lane = |pile: Option<Pile>| {
            let cell = pile.map(|pile| guests[pile.cell as usize].0 as usize);
            guest_cells.push(cell.map_or(NONE, |c| c as u32));
            elements.push(cell.map_or(NONE, |c| elements[c]));
            let nodes = cell.map_or_else(|| cell_nodes.last(), |c| cell_nodes.get(c));
            cell_nodes.push(*nodes.expect("there is a cell before"));
            is_cell.push(false);
            fields.push(0);
            ranks.push((0, 0));
        };
        let mut first = 0;
        let cells = guests.iter().map(|&(_, count)| {
            first += count;
            (first - count, count)
        });
        tiles.extend(cells, lane, put);
    }

    /// Number of tiles without those of guests.
    pub fn own_tiles(&self) -> usize {
        self.own_tiles
    }

    /// The cell of each lane of guests, or [`NONE`].
    pub fn guest_cells(&self) -> &[u32] {
        &self.guest_cells
    }

    /// For each lane of guests from a tile of theirs on one that has the same nodes and is not of guests.
    pub(super) fn guest_pairs(&self, tile: usize) -> impl Iterator<Item = usize> {
        let mut last = 0;
        let cells = &self.guest_cells[(tile - self.own_tiles) * LANES..];
        cells.iter().map(move |&cell| {
            if cell != NONE {
                last = cell as usize;
            }
            last
        })
    }

    fn number_nodes(&mut self, grid: &Grid, nodes: usize) {
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
        let Active {
            node_offsets: offsets,
            node_cells,
            cell_nodes,
            cell_of,
            field_count,
            listed,
            ..
        } = self;
        // In the mesh's order, so that sums do not depend on how cells share tiles.
        let cells = || {
            listed.iter().map(|cell| {
                let e = cell.element as usize;
                let c = cell_of[e * *field_count + usize::from(cell.field)] as usize;
                (c, &cell_nodes[c])
            })
        };
        offsets.clear();
        offsets.resize(nodes + 1, 0);
        for &n in cells().flat_map(|cell| cell.1) {
            offsets[n as usize + 1] += 1;
        }
        for n in 0..nodes {
            offsets[n + 1] += offsets[n];
        }
        node_cells.clear();
        node_cells.resize(offsets[nodes] as usize, Corner::default());
        for (c, cell) in cells() {
            for (local, &n) in cell.iter().enumerate() {
                let next = &mut offsets[n as usize];
                node_cells[*next as usize] = Corner::new(c, local);
                *next += 1;
            }
        }
        // Each offset has moved on to the next node's; move them back.
        offsets.copy_within(0..nodes, 1);
        offsets[0] = 0;
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
        let others = (0..mesh.tets.len() as u32).filter(|&e| e as usize != hole);
        let mut order = Order::of(&others.collect::<Vec<_>>(), mesh.tets.len());
        let mut active = Active::default();
        let (walls, fields) = (Walls::default(), Fields::default());
        let grid = Grid {
            mesh: &mesh,
            walls: &walls,
            fields: &fields,
            margin: false,
        };
        active.rebuild(&grid, &mut order);
        assert_eq!(active.cell_count(), mesh.tets.len());
        active.attach();
        let hole = active.cell(hole, 0).unwrap();
        assert!(active.ranks(hole).is_empty());
        for slot in 0..active.nodes.len() {
            for corner in active.attached(slot) {
                let own = active.cell_nodes[corner.owner()][corner.local()];
                assert_eq!(own as usize, slot);
            }
        }
        // With particles in one corner only, the rest sleeps, but for the elements next to it.
        let margin = Grid {
            margin: true,
            ..grid
        };
        active.rebuild(&margin, &mut Order::of(&[0], mesh.tets.len()));
        let next = mesh.neighbours[0].iter().filter(|&&n| n != NONE).count();
        assert_eq!(
            (active.cell_count(), active.nodes.len()),
            (1 + next, 4 + next)
        );
        active.rebuild(&grid, &mut Order::of(&[0], mesh.tets.len()));
        assert_eq!((active.cell_count(), active.nodes.len()), (1, 4));
    }
}
