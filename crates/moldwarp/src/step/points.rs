//! The pass over particles: what they are still to receive of the last kick, what a drift does to them, and in a mesh that
//! stays the sums over those of each cell, with which the next kick begins.
//!
//! One pass in place of four, since a particle's numbers come from memory, which takes about as long as to compute with
//! them.

use super::corners::NO_CORNERS;
use super::motion::{self, Crossing, Motion, Search, go_along};
use super::shapes::Shapes;
use super::state::Summed;
use super::strain::{Deformation, own_work};
use super::stress::{Arrays as Stressed, Stresses};
use super::sums::{self, Arrays as SumArrays, Asked, Counted, Given as Sharing, Sums};
use super::to_particles::{Before, Given, Kick};
use crate::lanes::{self, AHEAD, ByTile, Lane, load, prefetch, prefetch_bodies, store};
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
    let smoothing = plan.numerics.smoothing;
    let differs = sums::differs(elasticity, asked.reference);
    let (records, sharing, pairs, cut) = sums::arrays(cells, differs);
    let all = ByTile::new(&active.tiles, arrays, (records, sharing));
    let work = |block: ByTile<Arrays, (SumArrays, Sharing)>| {
        let first = block.first();
        let tiles = block.each();
        let (mut stressed, (mut position, mut velocity), elements) = block.particles;
        let (records, (to_nodes, to_pairs)) = block.cells;
        let (mut stress, mut motion) = (Stresses::new(plan, answers, simd), Motion::default());
        let (mut shapes, mut sums) = (Shapes::default(), Sums::default());
        let mut corners = NO_CORNERS;
        let mut giving = (to_nodes.begin(), to_pairs.begin());
        let (mut kick, mut speeds) = (Kick::default(), [Lane::of(0.0); 3]);
        let (mut deformation, mut crossing) = (Deformation::default(), Crossing::default());
        // Work of the particles' stresses in the halves of the drift.
        let (mut begun, mut ended) = (Lane::of(0.0), [Lane::of(0.0); 2]);
        for ((number, tile), mut records) in tiles.zip(sums::each(records)) {
            let nodes = active.tile_nodes(number);
            shapes.enter(simd, &mut corners, nodes, &shared.places);
            deformation.enter(simd, &mut corners, &shapes, nodes, shared, smoothing);
            stress.points.enter();
            own_work(simd, &deformation, records.sum, &mut begun);
            kick.enter(simd, &mut corners, &given, nodes, &shapes);
            if stays {
                sums.enter(&mut records);
            }
            for slot in tile.slots() {
                let (start, lanes) = (slot.start - first, slot.len());
                let bodies = &body[slot.clone()];
                let next = slot.end - first + AHEAD;
                // Not all at once: only so many lines can be on their way.
                prefetch(&position.each_ref().map(|x| &**x), next);
                prefetch(&velocity.each_ref().map(|v| &**v), next);
                prefetch(&[mass], slot.end + AHEAD);
                prefetch_bodies(body, slot.end + AHEAD);
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
                kick.give(simd, &given, &before, &mut speeds, &shapes, lanes);
                store(&speeds, &mut velocity, start, lanes);
                stress.update(&deformation, slot.clone(), bodies, &mut stressed, first);
                prefetch(&stressed.0.each_ref().map(|s| &**s), next);
                prefetch(&stressed.1.each_ref().map(|s| &**s), next);
                prefetch(&[&*stressed.2], next);
                go_along(
                    simd,
                    &mut motion,
                    &shapes,
                    &deformation,
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
                let pairs = pairs.tile_pairs(number);
                sums.leave(simd, tile, &mut records, nodes, pairs, &mut giving);
                let guests = usize::from(number >= active.own_tiles());
                own_work(simd, &deformation, records.sum, &mut ended[guests]);
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
