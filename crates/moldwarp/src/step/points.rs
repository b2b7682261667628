//! The pass over particles: what they are still to receive of the last kick, what a drift does to them, and in a mesh that
//! stays the sums over those of each cell, with which the next kick begins.
//!
//! One pass in place of four, since a particle's numbers come from memory, which takes about as long as to compute with
//! them.

use super::collect::Shares;
use super::motion::{self, Crossing, Motion, Search, go_along};
use super::state::Summed;
use super::strain::own_work;
use super::stress::{Arrays as Stressed, Stresses};
use super::sums::{Arrays as SumArrays, Asked, Counted, Records, Sums};
use super::to_particles::{Before, Given, Kick};
use crate::lanes::{self, ByTile, Lane, load, prefetch, prefetch_bodies, prefetch_record, store};
use crate::parallel::Smallest;
use crate::particles::Particles;
use crate::simulation::Simulation;

/// New velocities, stresses, volumes and positions of all particles. Returns whether one has lost all its volume, and what has
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
        pending,
        kinetic,
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
    let (body, mass) = (&body[..], &mass[..]);
    let given = Given {
        pending: pending.take(),
        received: &shared.received,
        grid: &shared.grid,
    };
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
    type Vectors<'a> = [&'a mut [f64]; 3];
    type Arrays<'a> = (Stressed<'a>, (Vectors<'a>, Vectors<'a>), &'a mut [u32]);
    let vectors = (position.components_mut(), velocity.components_mut());
    let arrays: Arrays = (stressed, vectors, &mut element[..]);
    let records = (
        &mut cells.sums[..],
        &mut cells.pairs[..],
        &mut cells.stresses[..],
    );
    let (shapes, strains) = (&cells.shapes[..], &cells.strains[..]);
    let cut = cells.portions.cut();
    let all = ByTile::new(&active.tiles, arrays, (records, cells.portions.shares()));
    let work = |block: ByTile<Arrays, (SumArrays, Shares<2>)>| {
        let first = block.first();
        let tiles = block.each();
        let (mut stressed, (mut position, mut velocity), elements) = block.particles;
        let ((cell_sums, pairs, stresses), shares) = block.cells;
        let (mut stress, mut motion) = (Stresses::new(plan, answers, simd), Motion::default());
        let (mut sums, mut share) = (Sums::default(), shares.begin());
        let (mut kick, mut speeds) = (Kick::default(), [Lane::of(0.0); 3]);
        let mut crossing = Crossing::default();
        // Work of the particles' stresses in the halves of the drift.
        let (mut begun, mut ended) = (Lane::of(0.0), [Lane::of(0.0); 2]);
        let records = cell_sums.iter_mut().zip(pairs).zip(stresses);
        for ((number, tile), ((sum, pairs), cell_stress)) in tiles.zip(records) {
            let nodes = active.tile_nodes(number);
            prefetch_record(strains, number + 1);
            prefetch_record(shapes, number + 1);
            let (strains, shapes) = (&strains[number], &shapes[number]);
            own_work(simd, strains, cell_stress, &mut begun);
            stress.enter(strains, nodes, shared);
            kick.enter(simd, &given, nodes, shapes);
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
                prefetch(&velocity.each_ref().map(|v| &**v), next);
                prefetch(&[mass], slot.end);
                prefetch_bodies(body, slot.end);
                let columns = position.each_ref().map(|x| &**x);
                motion::fetch(
                    simd,
                    &mut motion,
                    &columns,
                    start,
                    &mass[slot.start..],
                    lanes,
                );
                load(&mut speeds, &velocity.each_ref().map(|v| &**v), start);
                let before = Before {
                    position: &motion.position,
                    mass: &motion.mass,
                };
                kick.give(simd, &given, &before, &mut speeds, shapes, lanes);
                store(&speeds, &mut velocity, start, lanes);
                stress.update(strains, slot.clone(), bodies, &mut stressed, first);
                go_along(
                    simd,
                    &mut motion,
                    shapes,
                    strains,
                    gravity,
                    &mut position,
                    start,
                    lanes,
                );
                if !stays {
                    continue;
                }
                // What has come to another element counts there, as a guest.
                let elements = &mut elements[start..];
                let volume = &mut stress.points.volume;
                motion.search(&search, slot, elements, &mut crossing, |l| volume[l] = 0.0);
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
                let guests = usize::from(number >= active.own_tiles());
                own_work(simd, strains, records.stress, &mut ended[guests]);
            }
        }
        let [begun, own, guests] = [&begun, &ended[0], &ended[1]].map(lanes::sum);
        let sums = [motion.work(), kick.kinetic(), begun, own, guests];
        ((stress.end(), sums), crossing)
    };
    type Found = ((([f64; 3], Smallest), [f64; 5]), Crossing);
    let (((works, least), sums), crossing): Found = cut.fold(all, &work);
    ledger.particle_stress_work(works);
    ledger.gravity_work(sums[0]);
    *kinetic = Some(sums[1]);
    ledger.grid_stress_work(sums[2]);
    cells.worked = [sums[3], sums[4]];
    cells.summed = if stays { Summed::All } else { Summed::Nothing };
    (least.0 <= 0.0, crossing)
}
