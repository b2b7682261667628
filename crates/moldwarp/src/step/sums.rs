//! Sums over the particles of each cell, the first part of stage 1.

use super::collect::{Share, Shares};
use super::correction::PAIRS;
use super::shapes::{Corners, NO_CORNERS, Shapes, corner, set_corner};
use super::{CellPairs, CellStress, CellSums};
use crate::Vec3;
use crate::lanes::{
    ByTile, LANES, Lane, VoigtLanes, for_each_simd, get, load, load_one, set, whole,
};
use crate::parallel::fold;
use crate::particles::Particles;
use crate::plan::Plan;
use crate::simulation::Simulation;
use std::ops::Range;

/// What nodes are given: Σ m_p v_p N_i, Σ m_p N_i, and of the whole cell Σ V_p without what has opened and
/// Σ m_p.
pub(super) type Given = [f64; 6];

/// Particles side by side.
struct Side {
    x: [Lane; 3],
    v: [Lane; 3],
    mass: Lane,
    volume: Lane,
    stress: VoigtLanes,
    /// Shares of the volume that have not opened, and that are not separated.
    shares: [Lane; 2],
    /// λ, G and E_c, Pa.
    elasticity: [Lane; 3],
    /// Σ m_p v_p N_i of each cell.
    momentum: Corners,
}

impl Default for Side {
    fn default() -> Side {
        let vector = [Lane::of(0.0); 3];
        Side {
            x: vector,
            v: vector,
            mass: Lane::of(0.0),
            volume: Lane::of(0.0),
            stress: [Lane::of(0.0); 6],
            shares: [Lane::of(1.0); 2],
            elasticity: vector,
            momentum: NO_CORNERS,
        }
    }
}

for_each_simd! {
    /// Adds a particle to each cell.
    fn add(
        side: &mut Side,
        particles: &Particles,
        slot: &Range<usize>,
        shapes: &Shapes,
        sum: &mut CellSums,
        pairs: &mut CellPairs,
        stress: &mut CellStress,
    ) {
        let (start, lanes) = (slot.start, slot.len());
        load(&mut side.x, &particles.position.components(), start);
        load(&mut side.v, &particles.velocity.components(), start);
        load(&mut side.stress, &particles.stress.components(), start);
        load_one(&mut side.mass, &particles.mass, start);
        load_one(&mut side.volume, &particles.volume, start);
        for l in lanes..whole(lanes) {
            (side.mass[l], side.volume[l]) = (0.0, 0.0);
        }
        for l in 0..whole(lanes) {
            let n = shapes.at(l, Vec3::from_array(get(&side.x, l)));
            let (m, v) = (side.mass[l], Vec3::from_array(get(&side.v, l)));
            for i in 0..4 {
                let share = n[i] * m;
                sum.mass[i][l] += share;
                let momentum = corner(&side.momentum, l, i) + v * share;
                set_corner(&mut side.momentum, l, i, momentum);
            }
            for k in 0..6 {
                let (i, j) = PAIRS[k];
                pairs[k][l] += n[i] * n[j] * m;
            }
            let volume = side.volume[l];
            for k in 0..6 {
                stress.stress[k][l] += side.stress[k][l] * volume;
            }
            sum.volume[l] += volume;
            sum.solid[l] += volume * side.shares[0][l];
            stress.closed[l] += volume * side.shares[1][l];
            for k in 0..2 {
                stress.moduli[k][l] += volume * side.elasticity[k][l];
            }
        }
        for l in 0..lanes {
            stress.wave_modulus[l] = stress.wave_modulus[l].max(side.elasticity[2][l]);
        }
    }
}

for_each_simd! {
    /// Gives nodes what they collect.
    fn give(side: &Side, sum: &CellSums, nodes: &[[u32; 4]; LANES], share: &mut Share<6>) {
        for l in 0..LANES {
            let (mass, solid) = (get(&sum.mass, l), sum.solid[l]);
            let all = mass[0] + mass[1] + mass[2] + mass[3];
            share.give(&nodes[l], |i| {
                let [x, y, z] = corner(&side.momentum, l, i).to_array();
                [x, y, z, mass[i], solid, all]
            });
        }
    }
}

/// Sums of all cells.
pub(super) fn run(sim: &mut Simulation) {
    let Simulation {
        plan,
        particles,
        active,
        cells,
        elasticity,
        reference,
        simd,
        ..
    } = sim;
    let (active, particles, elasticity) = (&*active, &*particles, &*elasticity);
    let (reference, simd) = (reference.as_ref(), *simd);
    type Sums<'a> = (
        &'a mut [CellSums],
        &'a mut [CellPairs],
        &'a mut [CellStress],
    );
    let sums = (
        &mut cells.sums[..],
        &mut cells.pairs[..],
        &mut cells.stresses[..],
    );
    let shapes = &cells.shapes[..];
    type Records<'a> = (Sums<'a>, Shares<'a, 6>, &'a [Shapes]);
    let portion = cells.portions.tiles;
    let shares = cells.portions.shares();
    let all = ByTile::new(&active.tiles, (), (sums, shares, shapes));
    fold(all, portion, &|block: ByTile<(), Records>| {
        let tiles = block.each();
        let ((sums, pairs, stresses), shares, shapes) = block.cells;
        let (mut side, mut share) = (Side::default(), shares.begin());
        let records = sums.iter_mut().zip(pairs).zip(stresses).zip(shapes);
        for ((number, tile), (((sum, pairs), stress), shapes)) in tiles.zip(records) {
            *sum = CellSums::default();
            *pairs = CellPairs::default();
            *stress = CellStress::default();
            side.momentum = NO_CORNERS;
            for slot in tile.slots() {
                side.look_up(plan, elasticity, particles, slot.clone());
                add(
                    simd, &mut side, particles, &slot, shapes, sum, pairs, stress,
                );
                let Some(reference) = reference else { continue };
                for (l, p) in slot.enumerate() {
                    let body = usize::from(particles.body[p]);
                    let (x, volume) = (particles.position.at(p), particles.volume[p]);
                    reference.add(stress, l, body, x, volume);
                }
            }
            if !tile.helpers.is_empty() {
                let lanes = (sum.lanes())
                    .chain(&mut side.momentum)
                    .chain(pairs)
                    .chain(stress.lanes());
                tile.gather(lanes);
                for helper in tile.helpers {
                    let [from, to] = [helper.lane, helper.of].map(usize::from);
                    let moduli = &mut stress.wave_modulus;
                    moduli[to] = moduli[to].max(moduli[from]);
                }
            }
            give(simd, &side, sum, active.tile_nodes(number), &mut share);
        }
    });
}

impl Side {
    /// What materials say of the particles of a slot.
    fn look_up(
        &mut self,
        plan: &Plan,
        elasticity: &[[f64; 3]],
        particles: &Particles,
        slot: Range<usize>,
    ) {
        let model = |body: u16| &plan.materials[plan.bodies[usize::from(body)].material].model;
        let bodies = &particles.body[slot.clone()];
        let first = bodies[0];
        let lanes = slot.len();
        let alike = bodies.iter().all(|&b| b == first);
        if alike {
            for (lane, modulus) in (self.elasticity.iter_mut()).zip(elasticity[usize::from(first)])
            {
                lane[..lanes].fill(modulus);
            }
        } else {
            for (l, &body) in bodies.iter().enumerate() {
                set(&mut self.elasticity, l, elasticity[usize::from(body)]);
            }
        }
        let closed = alike
            && model(first).opening().is_none_or(|k| {
                let opening = &particles.state.components()[k][slot.clone()];
                opening.iter().all(|&w| w == 0.0)
            });
        if closed {
            self.shares.iter_mut().for_each(|s| s[..lanes].fill(1.0));
            return;
        }
        for (l, p) in slot.enumerate() {
            let (stress, state) = (particles.stress.at(p), particles.state.at(p));
            let model = model(bodies[l]);
            let closed = !model.is_separated(&stress, &state);
            let shares = [model.solid_share(&state), f64::from(u8::from(closed))];
            set(&mut self.shares, l, shares);
        }
    }
}
