//! The pass over particles: what a drift does to them, and in a mesh that stays the sums over those of each cell,
//! with which the kick begins.
//!
//! One pass in place of three, since a particle's numbers come from memory: that takes longer than to compute with
//! them.

use super::collect::Shares;
use super::motion::{Crossing, Motion, Search, go_along};
use super::state::Summed;
use super::stress::{Arrays as Stressed, Stresses};
use super::sums::{Asked, Counted, Records, Sums};
use super::{CellPairs, CellStress, CellSums};
use crate::lanes::{ByTile, Lane, for_each_simd, load, prefetch, prefetch_record, whole};
use crate::parallel::Smallest;
use crate::particles::Particles;
use crate::simulation::Simulation;

for_each_simd! {
    fn fetch(velocity: &mut [Lane; 3], columns: &[&[f64]; 3], start: usize, lanes: usize) {
        debug_assert!(whole(lanes) >= lanes);
        load(velocity, columns, start);
    }
}

/// New stresses, volumes and positions of all particles. Returns whether one has lost all its volume, and what has
/// crossed faces, unless the mesh is still to move.
pub(super) fn run(sim: &mut Simulation, stays: bool) -> (bool, Crossing) {
    let Simulation {
        plan,
        particles,
        active,
        shared,
        cells,
        ledger,
        gravity,
        fields,
        contacts,
        outflow,
        elasticity,
        reference,
        answers,
        simd,
        ..
    } = sim;
    let (plan, active, shared, answers) = (&*plan, &*active, &*shared, &*answers);
    let (gravity, simd) = (*gravity, *simd);
    let Particles {
        position,
        velocity,
        stress,
        state,
        volume,
        mass,
        body,
        element,
        ..
    } = particles;
    let (body, mass, velocity) = (&body[..], &mass[..], velocity.components());
    let search = Search {
        mesh: &plan.mesh,
        fields,
        contacts,
        outflow,
        body,
    };
    let asked = Asked {
        plan,
        elasticity,
        reference: reference.as_ref(),
        simd,
    };
    let stressed = (
        stress.components_mut(),
        state.components_mut(),
        &mut volume[..],
    );
    type Arrays<'a> = (Stressed<'a>, [&'a mut [f64]; 3], &'a mut [u32]);
    let arrays: Arrays = (stressed, position.components_mut(), &mut element[..]);
    type Cells<'a> = (
        &'a mut [CellSums],
        &'a mut [CellPairs],
        &'a mut [CellStress],
    );
    let records = (
        &mut cells.sums[..],
        &mut cells.pairs[..],
        &mut cells.stresses[..],
    );
    let (shapes, strains) = (&cells.shapes[..], &cells.strains[..]);
    let cut = cells.portions.cut();
    let all = ByTile::new(&active.tiles, arrays, (records, cells.portions.shares()));
    let work = |block: ByTile<Arrays, (Cells, Shares<2>)>| {
        let first = block.first();
        let tiles = block.each();
        let (mut stressed, mut position, elements) = block.particles;
        let ((cell_sums, pairs, stresses), shares) = block.cells;
        let (mut stress, mut motion) = (Stresses::new(plan, answers, simd), Motion::default());
        let (mut sums, mut share) = (Sums::default(), shares.begin());
        let mut speeds = [Lane::of(0.0); 3];
        let mut crossing = Crossing::default();
        let records = cell_sums.iter_mut().zip(pairs).zip(stresses);
        for ((number, tile), ((sum, pairs), cell_stress)) in tiles.zip(records) {
            let nodes = active.tile_nodes(number);
            prefetch_record(strains, number + 1);
            prefetch_record(shapes, number + 1);
            let (strains, shapes) = (&strains[number], &shapes[number]);
            stress.enter(strains, nodes, shared);
            let mut records = Records {
                sum,
                pairs,
                stress: cell_stress,
            };
            if stays {
                sums.enter(&mut records);
            }
            for slot in tile.slots() {
                let (start, lanes) = (slot.start - first, slot.len());
                let bodies = &body[slot.clone()];
                let next = slot.end - first;
                prefetch(&stressed.0.each_ref().map(|s| &**s), next);
                prefetch(&stressed.1.each_ref().map(|s| &**s), next);
                prefetch(&[&*stressed.2], next);
                prefetch(&position.each_ref().map(|x| &**x), next);
                prefetch(&velocity, slot.end);
                prefetch(&[mass], slot.end);
                stress.update(strains, slot.clone(), bodies, &mut stressed, first);
                go_along(
                    simd,
                    &mut motion,
                    shapes,
                    strains,
                    gravity,
                    &mass[slot.start..],
                    &mut position,
                    start,
                    lanes,
                );
                if !stays {
                    continue;
                }
                // What has come to another element counts there, as a guest.
                let (elements, start) = (&mut elements[start..], slot.start);
                let volume = &mut stress.points.volume;
                motion.search(&search, slot, elements, &mut crossing, |l| volume[l] = 0.0);
                fetch(simd, &mut speeds, &velocity, start, lanes);
                let points = Counted {
                    shapes: &motion.shapes,
                    position: &motion.position,
                    velocity: &speeds,
                    mass: &motion.mass,
                    volume: &stress.points.volume,
                    stress: &stress.points.increment.stress,
                    state: &stress.points.increment.state,
                };
                sums.add(&asked, &points, bodies, &mut records);
            }
            if stays {
                sums.leave(simd, tile, &mut records, nodes, &mut share);
            }
        }
        ((stress.end(), motion.work()), crossing)
    };
    let (((works, least), lifted), crossing): ((([f64; 3], Smallest), f64), Crossing) =
        cut.fold(all, &work);
    ledger.particle_stress_work(works);
    ledger.gravity_work(lifted);
    cells.summed = if stays { Summed::All } else { Summed::Nothing };
    (least.0 <= 0.0, crossing)
}
