//! What the step keeps per node and per cell.

use super::Active;
use super::collect::Portions;
use super::corners::Quad;
use super::mass::ConsistentMass;
use crate::Vec3;
use crate::lanes::{LANES, Lane, VoigtLanes, any, lane_of, prefetch_lines, prefetch_record};
use crate::mesh::Mesh;
use crate::parallel::fold;
use std::iter::repeat;
use std::ops::Range;

/// A node that particles touch. Forces in N, work in J. (Passes over nodes wait for memory: what is asked of all nodes comes
/// first, what acts on few of them lies on lines of its own.)
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub struct Node {
    /// m_i = Σ m_p N_i, kg.
    pub mass: f64,
    /// v_i = Σ m_p v_p N_i / m_i before the kick, m/s.
    pub velocity: Vec3,
    /// (change of velocity in the kick) / h: F_i / m_i with all that holds the node, m/s².
    pub acceleration: Vec3,
    /// The mass whose weight pulls at the node, kg: `mass`, but for a reference stress (see
    /// `step/reference.rs`).
    pub weighed: f64,
    /// Σ m_p v_p N_i / m_i of the updated particles, m/s.
    pub average: Vec3,
    /// −Σ S ∇N_i of the attached cells.
    pub internal: Vec3,
    /// Velocity after the remap, with which the mesh moves the material, m/s.
    pub grid_velocity: Vec3,
    /// Δu_i of the last drift, m.
    pub moved: Vec3,
    /// Whether any of the following may not be zero.
    pub is_acted_on: bool,
    /// Loads.
    pub load: Vec3,
    /// Local damping.
    pub damping: Vec3,
    /// Force of an absorbing boundary.
    pub absorbing: Vec3,
    /// Force of fixities, rollers and prescribed velocities.
    pub reaction: Vec3,
}

/// Nodes from one to that of which lines should be on their way to the first cache.
const NODES_AHEAD: usize = 8;

impl Node {
    /// Has lines of a node that comes later fetched from memory.
    #[inline(always)]
    pub(super) fn prefetch(&self, lines: Range<usize>) {
        prefetch_lines(self, NODES_AHEAD, lines);
    }
}

/// What cells read of nodes, in arrays of their own: they stay in the cache.
#[derive(Clone, Debug, Default)]
pub struct Shared {
    /// φ: volume of particles over volume of elements, of all elements attached.
    pub filling: Vec<f64>,
    /// A quarter of the averaged mean stress of the attached cells, Pa, where stresses are smoothed.
    pub mean_stress: Vec<f64>,
    /// Where nodes are, m, and mass over volume of all elements attached where these are full, kg/m³.
    pub places: Vec<Quad>,
    /// Δu_i of the last drift, m, and the averaged volumetric strain of the attached cells.
    pub moved: Vec<Quad>,
    /// What nodes exchange: accelerations or velocities.
    pub given: Vec<Quad>,
    /// What particles receive of the acceleration of the last kick, corrected for averaging, m/s².
    pub received: Vec<Quad>,
    /// Velocities that particles are drawn to by relaxation, m/s; none without it.
    pub grid: Vec<Quad>,
}

/// What is still needed of a node's last kick and drift when nodes are numbered anew.
#[derive(Clone, Copy, Debug, Default)]
pub struct Remembered {
    grid_velocity: Vec3,
    moved: Quad,
    received: Quad,
    grid: Quad,
}

impl Shared {
    /// What is still needed of these nodes, one after another.
    pub(crate) fn remember(&self, nodes: &[Node]) -> impl Iterator<Item = Remembered> {
        let relaxation = self.grid.iter().copied().chain(repeat(Quad::default()));
        let quads = self.moved.iter().zip(&self.received).zip(relaxation);
        nodes
            .iter()
            .zip(quads)
            .map(|(node, ((&moved, &received), grid))| Remembered {
                grid_velocity: node.grid_velocity,
                moved,
                received,
                grid,
            })
    }

    /// Gives it to the node that has this number now.
    pub(crate) fn recall(&mut self, nodes: &mut [Node], slot: usize, own: &Remembered) {
        (nodes[slot].grid_velocity, nodes[slot].moved) = (own.grid_velocity, own.moved.vector());
        (self.moved[slot], self.received[slot]) = (own.moved, own.received);
        if let Some(grid) = self.grid.get_mut(slot) {
            *grid = own.grid;
        }
    }

    /// Of these nodes; what cells still need of the last drift is kept.
    pub(crate) fn renew(&mut self, nodes: &[Node]) {
        self.filling.resize(nodes.len(), 0.0);
        for vectors in [&mut self.given, &mut self.received] {
            vectors.resize(nodes.len(), Quad::default());
        }
        if !self.grid.is_empty() {
            self.grid.resize(nodes.len(), Quad::default());
        }
        self.moved.clear();
        self.moved
            .extend(nodes.iter().map(|node| Quad::from(node.moved)));
    }

    /// Nodes are where the mesh is now.
    pub(crate) fn place(&mut self, active: &Active, mesh: &Mesh) {
        self.places.clear();
        let nodes = active.nodes.iter().map(|&n| mesh.nodes[n as usize]);
        self.places.extend(nodes.map(Quad::from));
    }
}

/// Sums over the particles of each cell.
#[derive(Clone, Debug)]
pub struct CellSums {
    /// Σ m_p, kg.
    pub mass: Lane,
    /// Σ V_p, m³.
    pub volume: Lane,
    /// Σ V_p without what has opened in tension, m³: it judges filling.
    pub solid: Lane,
    /// Σ V_p of particles that are not separated, m³.
    pub closed: Lane,
    /// Σ σ_p V_p, J.
    pub stress: VoigtLanes,
}

/// More sums, kept where bodies differ in elasticity or there is a reference stress.
#[derive(Clone, Debug)]
pub struct CellMedium {
    /// Σ λ V_p and Σ G V_p, J.
    pub moduli: [Lane; 2],
    /// Greatest constrained modulus of its particles, Pa.
    pub wave_modulus: Lane,
    /// Of particles with a reference stress: Σ σ_v V_p and Σ K₀ σ_v V_p, J, and Σ V_p, m³.
    pub reference: [Lane; 3],
    /// Σ m_p N_i for each node, kg.
    pub shares: [Lane; 4],
}

/// How full cells are.
#[derive(Clone, Debug)]
pub struct CellFill {
    /// 1 where the cell counts as filled.
    pub filled: Lane,
    /// Density by which a filled cell's waves run, kg/m³.
    pub density: Lane,
}

/// Stress times volume that acts on each cell's nodes: f_i = −S ∇N_i. Kept where a later stage looks at it.
#[derive(Clone, Debug)]
pub struct CellForce {
    /// σ̄ V_e if filled, else Σ σ_p V_p, J.
    pub stress: VoigtLanes,
    /// What smoothing has added to its mean, J.
    pub smoothed: Lane,
    /// The viscous part, J.
    pub viscous: VoigtLanes,
    /// The mass whose weight pulls at each node where there is a reference stress, kg.
    pub weighed: [Lane; 4],
}

/// What the step keeps per cell, one record a tile.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    pub sums: Vec<CellSums>,
    /// None, if all bodies are alike.
    pub medium: Vec<CellMedium>,
    pub fills: Vec<CellFill>,
    /// None, if no later stage looks at them.
    pub forces: Vec<CellForce>,
    pub mass: ConsistentMass,
    /// What nodes collect.
    pub portions: Portions,
    /// The shortest stable time step of a cell, s.
    pub shortest: f64,
    /// Whose sums the last drift has made.
    pub summed: Summed,
    /// Half the work of the particles' stresses in the last drift as far as sums are made, J.
    pub worked: f64,
    /// Of each tile whether any of its particles may have state variables other than zero that are not only added to: those
    /// of the others need not be read.
    pub stirred: Vec<bool>,
}

/// Cells that have their sums.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Summed {
    #[default]
    Nothing,
    /// Those before this tile, the first one of guests that have just come.
    Before(usize),
    All,
}

const ZERO: Lane = Lane::of(0.0);

/// Whether no cell of a tile has particles or counts as filled: nothing acts on their nodes.
#[inline]
pub(super) fn are_void(sum: &CellSums, fill: &CellFill) -> bool {
    !any(&*sum.volume) && !any(&*fill.filled)
}

impl CellSums {
    /// All sums.
    pub(super) fn lanes(&mut self) -> impl Iterator<Item = &mut Lane> {
        [
            &mut self.mass,
            &mut self.volume,
            &mut self.solid,
            &mut self.closed,
        ]
        .into_iter()
        .chain(&mut self.stress)
    }

    /// Adds what a lane of others has.
    #[inline]
    fn add_lane(&mut self, to: usize, others: &CellSums, from: usize) {
        let CellSums {
            mass,
            volume,
            solid,
            closed,
            stress,
        } = self;
        mass[to] += others.mass[from];
        volume[to] += others.volume[from];
        solid[to] += others.solid[from];
        closed[to] += others.closed[from];
        for (sum, more) in stress.iter_mut().zip(&others.stress) {
            sum[to] += more[from];
        }
    }
}

impl CellMedium {
    /// All sums; the greatest modulus is none.
    pub(super) fn lanes(&mut self) -> impl Iterator<Item = &mut Lane> {
        (self.moduli.iter_mut())
            .chain(&mut self.reference)
            .chain(&mut self.shares)
    }

    /// The same to look at.
    fn all(&self) -> impl Iterator<Item = &Lane> {
        (self.moduli.iter())
            .chain(&self.reference)
            .chain(&self.shares)
    }
}

impl Default for CellSums {
    fn default() -> CellSums {
        CellSums {
            mass: ZERO,
            volume: ZERO,
            solid: ZERO,
            closed: ZERO,
            stress: [ZERO; 6],
        }
    }
}

impl Default for CellMedium {
    fn default() -> CellMedium {
        CellMedium {
            moduli: [ZERO; 2],
            wave_modulus: ZERO,
            reference: [ZERO; 3],
            shares: [ZERO; 4],
        }
    }
}

impl Default for CellFill {
    fn default() -> CellFill {
        CellFill {
            filled: ZERO,
            density: ZERO,
        }
    }
}

impl Default for CellForce {
    fn default() -> CellForce {
        CellForce {
            stress: [ZERO; 6],
            smoothed: ZERO,
            viscous: [ZERO; 6],
            weighed: [ZERO; 4],
        }
    }
}

impl Cells {
    /// Of these cells, with room for so many tiles of guests.
    pub(crate) fn renew(&mut self, active: &Active, guests: usize) {
        let room = active.tiles.len() + guests;
        room_for(&mut self.sums, room);
        room_for(&mut self.fills, room);
        room_for(&mut self.stirred, room);
        self.stirred.clear();
        self.sums.clear();
        self.resize(active);
        self.mass.renew(&active.cell_nodes, active.nodes.len());
        (self.portions).renew(&active.cell_nodes, &self.mass, guests > 0);
        self.summed = Summed::Nothing;
    }

    fn resize(&mut self, active: &Active) {
        let tiles = active.tiles.len();
        self.sums.resize_with(tiles, CellSums::default);
        self.fills.resize_with(tiles, CellFill::default);
        self.stirred.resize(tiles, true);
        self.keep_medium(!self.medium.is_empty());
        self.keep_forces(!self.forces.is_empty());
    }

    /// Whether the medium of cells is kept.
    pub(super) fn keep_medium(&mut self, kept: bool) {
        keep(&mut self.medium, kept, &self.sums);
    }

    /// Whether stresses of cells are kept.
    pub(super) fn keep_forces(&mut self, kept: bool) {
        keep(&mut self.forces, kept, &self.sums);
    }

    /// Room for guests where [`Cells::renew`] has not made it.
    pub(crate) fn make_room(&mut self, tiles: usize) {
        self.keep_medium(!self.medium.is_empty());
        self.keep_forces(!self.forces.is_empty());
        self.mass.make_room(tiles * LANES);
    }

    /// The same after guests have come, in the tiles from this one on.
    pub(crate) fn add_guests(&mut self, active: &Active, tile: usize) {
        self.resize(active);
        self.mass.add_guests(active.guest_pairs(tile));
        self.portions.add_guests(active.tiles.len(), &self.mass);
        if self.summed == Summed::All {
            self.summed = Summed::Before(tile);
        }
    }

    /// Moves the sums of guests that make a cell's stress to the cells that they are in.
    pub(super) fn count_guests(&mut self, active: &Active) {
        let own = active.own_tiles();
        if active.guest_cells().is_empty() {
            return;
        }
        let (sums, guests) = self.sums.split_at_mut(own);
        let medium = (!self.medium.is_empty()).then(|| self.medium.split_at_mut(own));
        let (medium, guests_medium) = medium.unzip();
        let (given, given_medium) = (&*guests, guests_medium.as_deref());
        // Each thread looks through all guests for those in its cells: so these are added in their order, with any number of
        // threads.
        let block = own.div_ceil(rayon::current_num_threads());
        fold((0..own, sums, medium), block, &|(
            tiles,
            sums,
            mut medium,
        ): (
            Range<usize>,
            &mut [CellSums],
            Option<&mut [CellMedium]>,
        )| {
            let cells = active.guest_cells();
            for (guest, &cell) in cells.iter().enumerate() {
                let ((tile, to), (from_tile, from)) = (lane_of(cell as usize), lane_of(guest));
                if let Some(&later) = cells.get(guest + LANES) {
                    let later = lane_of(later as usize).0;
                    if tiles.contains(&later) {
                        prefetch_record(sums, later - tiles.start);
                    }
                }
                if !tiles.contains(&tile) {
                    continue;
                }
                let tile = tile - tiles.start;
                sums[tile].add_lane(to, &given[from_tile], from);
                let (Some(medium), Some(given)) = (&mut medium, given_medium) else {
                    continue;
                };
                add_lane(medium[tile].lanes(), to, given[from_tile].all(), from);
                let (own, guest) = (
                    &mut medium[tile].wave_modulus,
                    &given[from_tile].wave_modulus,
                );
                own[to] = own[to].max(guest[from]);
            }
        });
        for guests in guests {
            guests.lanes().for_each(|lane| *lane = ZERO);
        }
        for guests in guests_medium.into_iter().flatten() {
            guests.lanes().for_each(|lane| *lane = ZERO);
        }
    }

    /// Σ V_p of a cell, m³.
    pub(crate) fn volume(&self, c: usize) -> f64 {
        let (tile, lane) = lane_of(c);
        self.sums[tile].volume[lane]
    }
}

fn add_lane<'a>(
    sums: impl Iterator<Item = &'a mut Lane>,
    to: usize,
    given: impl Iterator<Item = &'a Lane>,
    from: usize,
) {
    for (sum, given) in sums.zip(given) {
        sum[to] += given[from];
    }
}

/// Room for so many, and some more for next time. What there was is not moved there: it takes as much memory again, and
/// is found anew.
pub(super) fn room_for<T>(records: &mut Vec<T>, room: usize) {
    if records.capacity() < room {
        *records = Vec::new();
        *records = Vec::with_capacity(room + room / 8);
    }
}

/// Has as many records as there are of another kind, and as much room, or none.
fn keep<T: Default, U>(records: &mut Vec<T>, kept: bool, like: &Vec<U>) {
    if kept {
        records.reserve_exact(like.capacity() - records.len());
        records.resize_with(like.len(), T::default);
    } else {
        records.clear();
    }
}

/// Displacements in the last drift by mesh node, m: the mean of all fields by mass; zero where no
/// particle is near.
pub(super) fn moved<'a>(active: &'a Active, nodes: &'a [Node]) -> impl Fn(u32) -> Vec3 + 'a {
    |mesh_node| {
        let keys = (mesh_node as usize..active.slot_of_key.len()).step_by(active.grid_nodes);
        let slots = keys.filter_map(|key| nodes.get(active.slot_of_key[key] as usize));
        let mut present = slots.filter(|node| node.mass > 0.0);
        let Some(first) = present.next() else {
            return Vec3::ZERO;
        };
        let Some(second) = present.next() else {
            return first.moved;
        };
        let (mut mass, mut sum) = (0.0, Vec3::ZERO);
        for node in [first, second].into_iter().chain(present) {
            mass += node.mass;
            sum += node.moved * node.mass;
        }
        sum / mass
    }
}
