//! Sums over the particles of each cell, the first part of stage 1.
//!
//! In a mesh that stays they are made at the end of the drift, while particles are at hand (`points.rs`); what that could
//! not know, or all of it, is made up for later (`sums/late.rs`).

mod late;

pub(super) use late::run;

use super::collect::{Cut, Share, Shares};
use super::corners::{Corners, NO_CORNERS, Quad, TileNodes, TilePairs, corner, set_corner};
use super::mass::PAIRS;
use super::stress::Whose;
use super::{CellMedium, CellSums, Cells, ConsistentMass, Reference};
use crate::Vec3;
use crate::lanes::{
    Contents, LANES, Lane, RECORDS_AHEAD, Simd, VoigtLanes, for_each_simd, get, prefetch_lines, set,
};
use crate::material::{Material, STATE_SIZE};
use crate::plan::Plan;

/// Slots that are added up at a time, their sums in registers.
const SLOTS: usize = 4;

/// What the sums of cells side by side are made of, beside what their records have.
pub(super) struct Sums {
    /// Slots that have not been added up yet, and how many.
    slots: [Carried; SLOTS],
    filled: usize,
    /// Whether none has been in these cells.
    empty: bool,
    /// Shares of the volume that have not opened, and that are not separated.
    shares: [Lane; 2],
    /// Whether these are all one.
    closed: bool,
    /// Whether they have not all been in these cells.
    opened: bool,
    /// λ, G and E_c, Pa.
    elasticity: [Lane; 3],
    /// The body whose they are in all lanes.
    of: Option<u16>,
    /// Σ m_p v_p N_i of each cell.
    momentum: Corners,
    /// Σ m_p N_i.
    mass: [Lane; 4],
    /// Σ m_p N_i N_j of each pair of nodes, and of each node with itself.
    pairs: [Lane; 6],
    squares: [Lane; 4],
}

impl Default for Sums {
    fn default() -> Sums {
        Sums {
            slots: std::array::from_fn(|_| Carried::default()),
            filled: 0,
            empty: true,
            shares: [Lane::of(1.0); 2],
            closed: true,
            opened: false,
            elasticity: [Lane::of(0.0); 3],
            of: None,
            momentum: NO_CORNERS,
            mass: [Lane::of(0.0); 4],
            pairs: [Lane::of(0.0); 6],
            squares: [Lane::of(0.0); 4],
        }
    }
}

/// The records of tiles.
pub(super) type Arrays<'a> = (&'a mut [CellSums], Option<&'a mut [CellMedium]>);

/// The records of a tile.
pub(super) struct Records<'a> {
    pub sum: &'a mut CellSums,
    pub medium: Option<&'a mut CellMedium>,
}

/// What nodes, and pairs of them, are given.
pub(super) type Given<'a> = (Shares<'a, Quad, 2>, Shares<'a, f64, 1>);

/// The same of one portion.
pub(super) type Giving<'a> = (Share<'a, Quad, 2>, Share<'a, f64, 1>);

/// What particles of a slot carry to their nodes. What counts for nothing has no mass.
pub(super) struct Carried {
    /// N_i.
    pub shapes: [Lane; 4],
    pub velocity: [Lane; 3],
    pub mass: Lane,
}

impl Default for Carried {
    fn default() -> Carried {
        Carried {
            shapes: [Lane::of(0.0); 4],
            velocity: [Lane::of(0.0); 3],
            mass: Lane::of(0.0),
        }
    }
}

/// The rest that counts of the same particles. What counts for nothing has no volume.
#[derive(Clone, Copy)]
pub(super) struct Counted<'a> {
    pub position: &'a [Lane; 3],
    pub volume: &'a Lane,
    pub stress: &'a VoigtLanes,
    pub state: &'a [Lane; STATE_SIZE],
    /// Whether any may have opened.
    pub open: bool,
}

for_each_simd! {
    /// Adds slots to Σ m_p v_p N_i and Σ m_p N_i, from nothing on if they are the first.
    fn add_momenta(momentum: &mut Corners, mass: &mut [Lane; 4], slots: &[Carried], first: bool) {
        let (mut sums, mut masses) = (NO_CORNERS, [Lane::of(0.0); 4]);
        if !first {
            (sums, masses) = (*momentum, *mass);
        }
        for slot in slots {
            for l in 0..LANES {
                let (m, v) = (slot.mass[l], Vec3::from_array(get(&slot.velocity, l)));
                let shares = get(&slot.shapes, l).map(|n| n * m);
                for i in 0..4 {
                    masses[i][l] += shares[i];
                    let momentum = corner(&sums, l, i) + v * shares[i];
                    set_corner(&mut sums, l, i, momentum);
                }
            }
        }
        (*momentum, *mass) = (sums, masses);
    }
}

for_each_simd! {
    /// The same for Σ m_p N_i N_j and Σ m_p N_i².
    fn add_products(pairs: &mut [Lane; 6], squares: &mut [Lane; 4], slots: &[Carried], first: bool) {
        let (mut products, mut own) = ([Lane::of(0.0); 6], [Lane::of(0.0); 4]);
        if !first {
            (products, own) = (*pairs, *squares);
        }
        for slot in slots {
            for l in 0..LANES {
                let (n, m) = (get(&slot.shapes, l), slot.mass[l]);
                let shares = n.map(|n| n * m);
                for i in 0..4 {
                    own[i][l] += n[i] * shares[i];
                }
                for k in 0..6 {
                    let (i, j) = PAIRS[k];
                    products[k][l] += n[i] * shares[j];
                }
            }
        }
        (*pairs, *squares) = (products, own);
    }
}

/// Adds particles to Σ σ_p V_p and Σ V_p, in a kernel.
#[inline(always)]
pub(super) fn add_to_stresses(stress: &VoigtLanes, volume: &Lane, sum: &mut CellSums) {
    for l in 0..LANES {
        let volume = volume[l];
        for k in 0..6 {
            sum.stress[k][l] += stress[k][l] * volume;
        }
        sum.volume[l] += volume;
    }
}

for_each_simd! {
    fn add_stresses(points: &Counted, sum: &mut CellSums) {
        add_to_stresses(points.stress, points.volume, sum);
    }
}

for_each_simd! {
    /// Adds what of it has not opened and what is not separated.
    fn add_closed(sums: &Sums, points: &Counted, sum: &mut CellSums) {
        add_to_closed(sums.shares.each_ref(), points.volume, sum);
    }
}

/// Adds what of particles has not opened and what is not separated, in a kernel.
#[inline(always)]
pub(super) fn add_to_closed(shares: [&Lane; 2], volume: &Lane, sum: &mut CellSums) {
    for l in 0..LANES {
        sum.solid[l] += volume[l] * shares[0][l];
        sum.closed[l] += volume[l] * shares[1][l];
    }
}

for_each_simd! {
    /// Shares of particles of this material that have not opened; and 1 if they are not separated, else 0.
    fn find_closed(
        solid: &mut Lane,
        closed: &mut Lane,
        model: &Material,
        stress: &VoigtLanes,
        state: &[Lane; STATE_SIZE],
    ) {
        let (mut shares, mut all) = (Lane::of(1.0), Lane::of(1.0));
        model.find_closed(stress, state, &mut shares, &mut all);
        (*solid, *closed) = (shares, all);
    }
}

for_each_simd! {
    /// Adds what it is made of.
    fn add_medium(
        sums: &Sums,
        carried: &Carried,
        volume: &Lane,
        medium: &mut CellMedium,
        lanes: usize,
    ) {
        for l in 0..LANES {
            let volume = volume[l];
            for k in 0..2 {
                medium.moduli[k][l] += volume * sums.elasticity[k][l];
            }
            for i in 0..4 {
                medium.shares[i][l] += carried.shapes[i][l] * carried.mass[l];
            }
        }
        for l in 0..lanes {
            medium.wave_modulus[l] = medium.wave_modulus[l].max(sums.elasticity[2][l]);
        }
    }
}

for_each_simd! {
    /// Masses of cells, as N_i add up to one.
    fn whole_masses(sums: &Sums, sum: &mut CellSums) {
        for l in 0..LANES {
            let [a, b, c, d] = get(&sums.mass, l);
            sum.mass[l] = a + b + c + d;
        }
    }
}

/// What is asked of all particles.
#[derive(Clone, Copy)]
pub(super) struct Asked<'a> {
    pub plan: &'a Plan,
    pub elasticity: &'a [[f64; 3]],
    pub reference: Option<&'a Reference>,
    pub simd: Simd,
}

impl Sums {
    /// Goes to the next cells.
    #[inline]
    pub fn enter(&mut self, records: &mut Records) {
        *records.sum = CellSums::default();
        if let Some(medium) = &mut records.medium {
            **medium = CellMedium::default();
        }
        (self.empty, self.opened) = (true, false);
    }

    /// Where what comes next is put.
    #[inline]
    pub fn next(&mut self) -> &mut Carried {
        &mut self.slots[self.filled]
    }

    /// The same, and whether the shares of what has not opened are summed.
    #[inline]
    pub fn next_and_opened(&mut self) -> (&mut Carried, &mut bool) {
        (&mut self.slots[self.filled], &mut self.opened)
    }

    /// Adds the particles of a slot, of which [`Sums::next`] has what they carry.
    #[inline]
    pub fn add(
        &mut self,
        asked: &Asked,
        points: &Counted,
        bodies: &[u16],
        whose: Whose,
        records: &mut Records,
    ) {
        self.look_up(asked, points, bodies, whose);
        let sum = &mut *records.sum;
        if !self.closed && !self.opened {
            self.opened = true;
            (sum.solid, sum.closed) = (sum.volume, sum.volume);
        }
        add_stresses(asked.simd, points, sum);
        if self.opened {
            add_closed(asked.simd, self, points, sum);
        }
        if let Some(medium) = &mut records.medium {
            let carried = &self.slots[self.filled];
            add_medium(
                asked.simd,
                self,
                carried,
                points.volume,
                medium,
                bodies.len(),
            );
            for (l, &body) in bodies.iter().enumerate() {
                let Some(reference) = asked.reference else {
                    break;
                };
                let x = Vec3::from_array(get(points.position, l));
                reference.add(medium, l, usize::from(body), x, points.volume[l]);
            }
        }
        self.count(asked.simd);
    }

    /// Counts a slot whose particles have been added to the rest.
    #[inline]
    pub fn count(&mut self, simd: Simd) {
        self.filled += 1;
        if self.filled == SLOTS {
            self.add_up(simd);
        }
    }

    fn add_up(&mut self, simd: Simd) {
        let slots = &self.slots[..self.filled];
        add_momenta(simd, &mut self.momentum, &mut self.mass, slots, self.empty);
        add_products(simd, &mut self.pairs, &mut self.squares, slots, self.empty);
        (self.filled, self.empty) = (0, false);
    }

    /// Gives nodes Σ m_p v_p N_i, Σ m_p N_i, Σ m_p N_i² and of the whole cell Σ V_p without what has opened and Σ m_p,
    /// pairs of nodes Σ m_p N_i N_j, and puts together what lanes of the same cell have.
    #[inline]
    pub fn leave(
        &mut self,
        simd: Simd,
        tile: Contents,
        records: &mut Records,
        nodes: TileNodes,
        pairs: TilePairs,
        (to_nodes, to_pairs): &mut Giving,
    ) {
        let sum = &mut *records.sum;
        if self.filled > 0 || self.empty {
            self.add_up(simd);
        }
        if !self.opened {
            (sum.solid, sum.closed) = (sum.volume, sum.volume);
        }
        whole_masses(simd, self, sum);
        let (alike, squares) = ([&sum.solid, &sum.mass], &self.squares);
        to_nodes.give(simd, nodes, &self.momentum, &self.mass, alike, squares);
        to_pairs.give_pairs(pairs, &self.pairs);
        tile.gather(sum.lanes());
        if let Some(medium) = &mut records.medium {
            tile.gather(medium.lanes());
            for helper in tile.helpers {
                let [from, to] = [helper.lane, helper.of].map(usize::from);
                let moduli = &mut medium.wave_modulus;
                moduli[to] = moduli[to].max(moduli[from]);
            }
        }
    }

    /// What materials say of the particles of a slot.
    #[inline]
    fn look_up(&mut self, asked: &Asked, points: &Counted, bodies: &[u16], whose: Whose) {
        let (plan, elasticity) = (asked.plan, asked.elasticity);
        let model = |body: u16| &plan.materials[plan.bodies[usize::from(body)].material].model;
        match whose.body {
            Some(_) if self.of == whose.body => {}
            Some(body) => self.elasticity = elasticity[usize::from(body)].map(Lane::of),
            None => {
                for (l, &body) in bodies.iter().enumerate() {
                    set(&mut self.elasticity, l, elasticity[usize::from(body)]);
                }
            }
        }
        self.of = whose.body;
        if !whose.can_open() || !points.open {
            if !self.closed {
                self.closed = true;
                self.shares = [Lane::of(1.0); 2];
            }
            return;
        }
        self.closed = false;
        if let Some(model) = whose.model {
            let [solid, closed] = &mut self.shares;
            find_closed(
                asked.simd,
                solid,
                closed,
                model,
                points.stress,
                points.state,
            );
            return;
        }
        for (l, &body) in bodies.iter().enumerate() {
            let (stress, state) = (get(points.stress, l), get(points.state, l));
            let model = model(body);
            let closed = !model.is_separated(&stress, &state);
            let shares = [model.solid_share(&state), f64::from(u8::from(closed))];
            set(&mut self.shares, l, shares);
        }
    }
}

/// Whether what cells are made of has to be summed.
pub(super) fn differs(elasticity: &[[f64; 3]], reference: Option<&Reference>) -> bool {
    reference.is_some() || elasticity.windows(2).any(|two| two[0] != two[1])
}

/// The records of all tiles, what nodes and pairs collect, and how that is cut.
pub(super) fn arrays(
    cells: &mut Cells,
    differs: bool,
) -> (Arrays<'_>, Given<'_>, &ConsistentMass, Cut) {
    cells.keep_medium(differs);
    let Cells {
        sums,
        medium,
        mass,
        portions,
        ..
    } = cells;
    let cut = portions.cut();
    let medium = differs.then_some(&mut medium[..]);
    let given = portions.all_shares();
    ((&mut sums[..], medium), given, mass, cut)
}

/// The records of tiles, one after another.
pub(super) fn each((sums, medium): Arrays) -> impl Iterator<Item = Records> {
    let mut medium = medium.map(|medium| medium.iter_mut());
    sums.iter_mut().map(move |sum| {
        prefetch_lines(sum, RECORDS_AHEAD, 0..size_of::<CellSums>() / 64);
        Records {
            sum,
            medium: medium.as_mut().and_then(|medium| medium.next()),
        }
    })
}
