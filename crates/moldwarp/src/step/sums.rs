//! Sums over the particles of each cell, the first part of stage 1.
//!
//! In a mesh that stays they are made at the end of the drift, while particles are at hand (`points.rs`); what that could
//! not know, or all of it, is made up for here.

use super::collect::{Share, Shares};
use super::corners::{Corners, NO_CORNERS, all_corners, corner, load_nodes, set_corner};
use super::correction::PAIRS;
use super::shapes::Shapes;
use super::state::Summed;
use super::{CellPairs, CellStress, CellSums, Reference, strain};
use crate::Vec3;
use crate::lanes::{
    self, ByTile, Contents, LANES, Lane, Simd, VoigtLanes, alike, any, for_each_simd, get, load,
    load_one, set, whole,
};
use crate::material::STATE_SIZE;
use crate::particles::Particles;
use crate::plan::Plan;
use crate::simulation::Simulation;
use crate::tensor;

/// What the sums of cells side by side are made of, beside what their records have.
pub(super) struct Sums {
    /// Shares of the volume that have not opened, and that are not separated.
    shares: [Lane; 2],
    /// Whether these are all one.
    closed: bool,
    /// λ, G and E_c, Pa.
    elasticity: [Lane; 3],
    /// The body whose they are in all lanes.
    of: Option<u16>,
    /// Σ m_p v_p N_i of each cell.
    momentum: Corners,
}

impl Default for Sums {
    fn default() -> Sums {
        Sums {
            shares: [Lane::of(1.0); 2],
            closed: true,
            elasticity: [Lane::of(0.0); 3],
            of: None,
            momentum: NO_CORNERS,
        }
    }
}

/// The records of tiles.
pub(super) type Arrays<'a> = (
    &'a mut [CellSums],
    &'a mut [CellPairs],
    &'a mut [CellStress],
);

/// The records of a tile.
pub(super) struct Records<'a> {
    pub sum: &'a mut CellSums,
    pub pairs: &'a mut CellPairs,
    pub stress: &'a mut CellStress,
}

/// Particles side by side. What counts for nothing has no mass and no volume.
#[derive(Clone, Copy)]
pub(super) struct Counted<'a> {
    /// N_i.
    pub shapes: &'a [Lane; 4],
    pub position: &'a [Lane; 3],
    pub velocity: &'a [Lane; 3],
    pub mass: &'a Lane,
    pub volume: &'a Lane,
    pub stress: &'a VoigtLanes,
    pub state: &'a [Lane; STATE_SIZE],
}

for_each_simd! {
    /// Adds a particle to each cell.
    fn add(sums: &mut Sums, points: &Counted, records: &mut Records, lanes: usize) {
        let Records { sum, pairs, stress } = records;
        for l in 0..whole(lanes) {
            let n = get(points.shapes, l);
            let (m, v) = (points.mass[l], Vec3::from_array(get(points.velocity, l)));
            for i in 0..4 {
                let share = n[i] * m;
                sum.mass[i][l] += share;
                let momentum = corner(&sums.momentum, l, i) + v * share;
                set_corner(&mut sums.momentum, l, i, momentum);
            }
            for k in 0..10 {
                let (i, j) = PAIRS[k];
                pairs[k][l] += n[i] * n[j] * m;
            }
            let volume = points.volume[l];
            for k in 0..6 {
                stress.stress[k][l] += points.stress[k][l] * volume;
            }
            sum.volume[l] += volume;
            sum.solid[l] += volume * sums.shares[0][l];
            stress.closed[l] += volume * sums.shares[1][l];
            for k in 0..2 {
                stress.moduli[k][l] += volume * sums.elasticity[k][l];
            }
        }
        for l in 0..lanes {
            stress.wave_modulus[l] = stress.wave_modulus[l].max(sums.elasticity[2][l]);
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
        *records.pairs = CellPairs::default();
        *records.stress = CellStress::default();
        self.momentum = NO_CORNERS;
    }

    /// Adds the particles of a slot.
    #[inline]
    pub fn add(&mut self, asked: &Asked, points: &Counted, bodies: &[u16], records: &mut Records) {
        self.look_up(asked, points, bodies);
        add(asked.simd, self, points, records, bodies.len());
        let Some(reference) = asked.reference else {
            return;
        };
        for (l, &body) in bodies.iter().enumerate() {
            let x = Vec3::from_array(get(points.position, l));
            reference.add(records.stress, l, usize::from(body), x, points.volume[l]);
        }
    }

    /// Puts together what lanes of the same cell have, and gives nodes Σ m_p v_p N_i, Σ m_p N_i, and of the whole cell
    /// Σ V_p without what has opened and Σ m_p.
    #[inline]
    pub fn leave(
        &mut self,
        simd: Simd,
        tile: Contents,
        records: &mut Records,
        nodes: &[[u32; 4]; LANES],
        share: &mut Share<2>,
    ) {
        let Records { sum, pairs, stress } = records;
        if !tile.helpers.is_empty() {
            let lanes = (sum.lanes())
                .chain(&mut self.momentum)
                .chain(pairs.iter_mut())
                .chain(stress.lanes());
            tile.gather(lanes);
            for helper in tile.helpers {
                let [from, to] = [helper.lane, helper.of].map(usize::from);
                let moduli = &mut stress.wave_modulus;
                moduli[to] = moduli[to].max(moduli[from]);
            }
        }
        share.give(simd, nodes, &self.momentum, &sum.mass);
        let mut all = sum.mass[0];
        for mass in &sum.mass[1..] {
            all.iter_mut()
                .zip(mass.iter())
                .for_each(|(all, m)| *all += m);
        }
        share.give_alike(simd, nodes, [&sum.solid, &all]);
    }

    /// What materials say of the particles of a slot.
    #[inline]
    fn look_up(&mut self, asked: &Asked, points: &Counted, bodies: &[u16]) {
        let (plan, elasticity) = (asked.plan, asked.elasticity);
        let model = |body: u16| &plan.materials[plan.bodies[usize::from(body)].material].model;
        let (first, lanes) = (bodies[0], bodies.len());
        let alike = alike(bodies);
        if alike {
            if self.of != Some(first) {
                self.of = Some(first);
                let moduli = elasticity[usize::from(first)];
                self.elasticity = moduli.map(Lane::of);
            }
        } else {
            self.of = None;
            for (l, &body) in bodies.iter().enumerate() {
                set(&mut self.elasticity, l, elasticity[usize::from(body)]);
            }
        }
        let closed =
            alike && (model(first).opening()).is_none_or(|k| !any(&points.state[k][..lanes]));
        if closed {
            if !self.closed {
                self.closed = true;
                self.shares = [Lane::of(1.0); 2];
            }
            return;
        }
        self.closed = false;
        for (l, &body) in bodies.iter().enumerate() {
            let (stress, state) = (get(points.stress, l), get(points.state, l));
            let model = model(body);
            let closed = !model.is_separated(&stress, &state);
            let shares = [model.solid_share(&state), f64::from(u8::from(closed))];
            set(&mut self.shares, l, shares);
        }
    }
}

/// Particles side by side, as they lie in memory.
struct Side {
    shapes: [Lane; 4],
    position: [Lane; 3],
    velocity: [Lane; 3],
    mass: Lane,
    volume: Lane,
    stress: VoigtLanes,
    state: [Lane; STATE_SIZE],
}

impl Default for Side {
    fn default() -> Side {
        let vector = [Lane::of(0.0); 3];
        Side {
            shapes: [Lane::of(0.0); 4],
            position: vector,
            velocity: vector,
            mass: Lane::of(0.0),
            volume: Lane::of(0.0),
            stress: [Lane::of(0.0); 6],
            state: [Lane::of(0.0); STATE_SIZE],
        }
    }
}

for_each_simd! {
    fn fetch(side: &mut Side, particles: &Particles, start: usize, shapes: &Shapes, lanes: usize) {
        load(&mut side.position, &particles.position.components(), start);
        load(&mut side.velocity, &particles.velocity.components(), start);
        load(&mut side.stress, &particles.stress.components(), start);
        load(&mut side.state, &particles.state.components(), start);
        load_one(&mut side.mass, &particles.mass, start);
        load_one(&mut side.volume, &particles.volume, start);
        for l in lanes..whole(lanes) {
            (side.mass[l], side.volume[l]) = (0.0, 0.0);
        }
        for l in 0..whole(lanes) {
            let n = shapes.at(l, Vec3::from_array(get(&side.position, l)));
            set(&mut side.shapes, l, n);
        }
    }
}

/// The sums that the last drift has not made: of all cells, or of those of guests; and the second half of the work of the
/// particles' stresses in it.
pub(super) fn run(sim: &mut Simulation, before: f64) {
    let made = std::mem::take(&mut sim.cells.summed);
    let [own, guests] = std::mem::take(&mut sim.cells.worked);
    if made != Summed::All {
        sim.guests_arrive();
        let work = make(sim, made, before > 0.0);
        sim.guests_dismiss();
        let known = if made == Summed::Own { own } else { 0.0 };
        sim.ledger.grid_stress_work(known + work);
    } else {
        sim.ledger.grid_stress_work(own + guests);
    }
}

/// Returns half the work in the last drift, J, if it has `drifted`, of the particles in the cells that it has been to.
fn make(sim: &mut Simulation, made: Summed, drifted: bool) -> f64 {
    let Simulation {
        plan,
        particles,
        active,
        shared,
        cells,
        elasticity,
        reference,
        simd,
        ..
    } = sim;
    let (active, shared, particles) = (&*active, &*shared, &*particles);
    let asked = Asked {
        plan,
        elasticity,
        reference: reference.as_ref(),
        simd: *simd,
    };
    let arrays = (
        &mut cells.sums[..],
        &mut cells.pairs[..],
        &mut cells.stresses[..],
    );
    let cut = cells.portions.cut();
    let shares = cells.portions.shares();
    type All<'a> = (Arrays<'a>, Shares<'a, 2>, &'a [Shapes]);
    let all = ByTile::new(&active.tiles, (), (arrays, shares, &cells.shapes[..]));
    let work = |block: ByTile<(), All>| {
        let tiles = block.each();
        let ((cell_sums, pairs, stresses), shares, shapes) = block.cells;
        let (mut side, mut sums, mut share) = (Side::default(), Sums::default(), shares.begin());
        let (mut moved, mut work) = (NO_CORNERS, Lane::of(0.0));
        let arrays = cell_sums.iter_mut().zip(pairs).zip(stresses).zip(shapes);
        for ((number, tile), (((sum, pairs), stress), shapes)) in tiles.zip(arrays) {
            let mut records = Records { sum, pairs, stress };
            sums.enter(&mut records);
            for slot in tile.slots() {
                fetch(
                    asked.simd,
                    &mut side,
                    particles,
                    slot.start,
                    shapes,
                    slot.len(),
                );
                let points = Counted {
                    shapes: &side.shapes,
                    position: &side.position,
                    velocity: &side.velocity,
                    mass: &side.mass,
                    volume: &side.volume,
                    stress: &side.stress,
                    state: &side.state,
                };
                sums.add(&asked, &points, &particles.body[slot], &mut records);
            }
            let nodes = active.tile_nodes(number);
            sums.leave(asked.simd, tile, &mut records, nodes, &mut share);
            if drifted {
                load_nodes(asked.simd, &mut moved, nodes, &shared.moved);
                half_work(asked.simd, shapes, &moved, records.stress, &mut work);
            }
        }
        lanes::sum(&work)
    };
    match made {
        Summed::Own => cut.fold_guests(all, &work),
        _ => cut.fold(all, &work),
    }
}

for_each_simd! {
    /// Half the work of the particles' stresses on what the last drift has done to their cells, J.
    fn half_work(shapes: &Shapes, moved: &Corners, stress: &CellStress, work: &mut Lane) {
        for l in 0..LANES {
            let gradient = strain::gradient(&shapes.gradients(l), all_corners(moved, l));
            let strain = tensor::strain(&gradient);
            work[l] += 0.5 * tensor::dot(&get(&stress.stress, l), &strain);
        }
    }
}
