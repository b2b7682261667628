//! The pass over particles: what they are still to receive of the last kick, what a drift does to them, and in a mesh that
//! stays the sums over those of each cell, with which the next kick begins.
//!
//! One pass in place of four, since a particle's numbers come from memory, which takes about as long as to compute with
//! them.

#[cfg(test)]
mod tests;
mod usual;

use super::leavers::{self, Handful, Leaver};
use super::motion::{Crossing, Motion, Search};
use super::shapes::Shapes;
use super::state::Summed;
use super::strain::{Deformation, own_work};
use super::stress::{Arrays as Stressed, Booked, Points, Stresses};
use super::sums::{self, Arrays as SumArrays, Asked, Carried, Counted, Given as Sharing, Sums};
use super::to_particles::{Given, Kick, Pending};
use crate::Vec3;
use crate::lanes::{
    self, AHEAD, ByTile, Columns, Held, LANES, Lane, any, for_each_simd, get, held, only, prefetch,
    prefetch_bodies, set,
};
use crate::mesh::is_outside;
use crate::parallel::{Smallest, Sum};
use crate::particles::{Particles, WORKING};
use crate::simulation::Simulation;
use std::sync::Mutex;
use usual::Done;

/// New velocities, stresses, volumes and positions of all particles. Returns whether one has lost all its volume, and what has
/// crossed faces, unless the mesh is still to move.
pub(super) fn run(sim: &mut Simulation, stays: bool) -> (bool, Crossing) {
    let may_have_guests = sim.may_have_guests();
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
        guests,
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
    let leavers = Mutex::new(&mut guests.leavers);
    let stressed = (
        Columns::new(stress.components_mut()),
        Columns::new(state.components_mut()),
        Columns::new([volume]),
    );
    let vectors = (
        Columns::new(position.components_mut()),
        Columns::new(velocity.components_mut()),
    );
    let arrays: Arrays = (stressed, vectors, &mut element[..]);
    let smoothing = plan.numerics.smoothing;
    let differs = sums::differs(elasticity, asked.reference);
    let mut stirred = std::mem::take(&mut cells.stirred);
    let (records, sharing, pairs, cut) = sums::arrays(cells, differs);
    let all = ByTile::new(&active.tiles, arrays, (records, &mut stirred[..], sharing));
    let work = |block: ByTile<Arrays, (SumArrays, &mut [bool], Sharing)>| {
        let first = block.first();
        let tiles = block.each();
        let (stressed, (position, velocity), elements) = block.particles;
        let mut arrays = Own {
            stressed,
            position,
            velocity,
        };
        let (records, stirred, (to_nodes, to_pairs)) = block.cells;
        let (mut stress, mut motion) = (Stresses::new(plan, answers, simd), Motion::default());
        let (mut shapes, mut sums) = (Shapes::default(), Sums::default());
        let mut giving = (to_nodes.begin(), to_pairs.begin());
        let (mut kick, mut leaving) = (Kick::default(), Handful::new(&leavers));
        let (mut deformation, mut crossing) = (Deformation::default(), Crossing::default());
        // Work of the particles' stresses in the halves of the drift.
        let (mut begun, mut ended) = (Lane::of(0.0), Lane::of(0.0));
        let records = sums::each(records).zip(stirred);
        for ((number, tile), (mut records, stirred)) in tiles.zip(records) {
            if tile.is_empty() && !any(&*records.sum.volume) {
                // Nor has it had guests: its records stay as they are, of nothing.
                continue;
            }
            let nodes = active.tile_nodes(number);
            shapes.enter(simd, nodes, &shared.places);
            deformation.enter(simd, &shapes, nodes, shared, smoothing);
            stress.points.enter();
            own_work(simd, &deformation, records.sum, &mut begun);
            kick.enter(simd, &given, nodes, &shapes);
            if stays {
                sums.enter(&mut records);
            }
            let is_still = !std::mem::take(stirred);
            let cells = Cells {
                shapes: &shapes,
                deformation: &deformation,
            };
            for slot in tile.slots() {
                let (start, lanes) = (slot.start - first, slot.len());
                let bodies = &body[slot.clone()];
                let whose = stress.whose.of(bodies);
                let mut done = Done::Nothing;
                if let Some(model) = whose.model.filter(|_| !in_parts()) {
                    let plain = stays && records.medium.is_none();
                    let mut advance = |open| {
                        let advance = match open {
                            false => usual::advance::<false>,
                            true => usual::advance::<true>,
                        };
                        let (carried, has_opened) = sums.next_and_opened();
                        advance(
                            simd,
                            &mut arrays,
                            &mass[slot.start..],
                            (start, lanes),
                            held(lanes),
                            is_still,
                            model,
                            &shapes,
                            &deformation,
                            &mut kick,
                            given.pending,
                            gravity,
                            &mut stress.points,
                            &mut motion,
                            &mut stress.booked,
                            stirred,
                            carried,
                            has_opened,
                            plain.then_some(&mut *records.sum),
                        )
                    };
                    done = advance(false);
                    if done == Done::NothingAsOpen {
                        done = advance(true);
                    }
                }
                prefetch(&[mass], slot.start + AHEAD);
                prefetch_bodies(body, slot.start + AHEAD);
                if done == Done::All {
                    sums.count(simd);
                    continue;
                }
                if done == Done::Nothing {
                    *stirred = true;
                    begin(
                        simd,
                        &mut motion,
                        sums.next(),
                        &mut stress.points,
                        &arrays,
                        &mass[slot.start..],
                        &cells,
                        (&kick, given.pending),
                        start,
                        held(lanes),
                        whose.opening,
                    );
                    // All at once they would wait for each other.
                    arrays.position.prefetch(start + AHEAD);
                    arrays.velocity.prefetch(start + AHEAD);
                    let known = (&arrays.stressed, start);
                    stress.update(&deformation, slot.start, bodies, whose, known);
                    arrays.stressed.0.prefetch(start + AHEAD);
                    end(
                        simd,
                        &mut motion,
                        sums.next(),
                        &mut stress.points,
                        &mut stress.booked,
                        &mut kick,
                        &cells,
                        gravity,
                    );
                    keep(
                        simd,
                        &mut motion,
                        sums.next(),
                        &mut stress.points,
                        &mut arrays,
                        start,
                        lanes,
                        whose.opening,
                    );
                    arrays.stressed.1.prefetch(start + AHEAD);
                    arrays.stressed.2.prefetch(start + AHEAD);
                    stress.book_plastic();
                }
                if !stays {
                    continue;
                }
                // What has come to another element counts there, as a guest.
                let Carried {
                    mass, shapes: n, ..
                } = sums.next();
                for l in motion.who_left(lanes) {
                    let (p, x, n) = (slot.start + l, motion.at(l), get(n, l));
                    if !may_have_guests {
                        if !search.walk(p, n, x, &mut elements[start + l], &mut crossing) {
                            continue;
                        }
                    } else if is_outside(n) {
                        leaving.put(Leaver {
                            place: p as u32,
                            cell: (number * LANES + l) as u32,
                            shapes: n,
                            numbers: arrays.working(start + l, mass[l]),
                            ..Leaver::default()
                        });
                    } else {
                        continue;
                    }
                    (mass[l], stress.points.volume[l]) = (0.0, 0.0);
                }
                let points = Counted {
                    position: &motion.position,
                    volume: &stress.points.volume,
                    stress: &stress.points.increment.stress,
                    state: &stress.points.increment.state,
                    open: stress.points.open,
                };
                sums.add(&asked, &points, bodies, whose, &mut records);
            }
            if stays {
                let pairs = pairs.tile_pairs(number);
                sums.leave(simd, tile, &mut records, nodes, pairs, &mut giving);
                own_work(simd, &deformation, records.sum, &mut ended);
            }
        }
        let [begun, ended] = [&begun, &ended].map(lanes::sum);
        let sums = [motion.work(), kick.kinetic(), begun, ended];
        ((stress.end(), sums), crossing)
    };
    type Found = ((([f64; 3], Smallest), [f64; 4]), Crossing);
    let (((works, least), sums), crossing): Found = cut.fold(all, &work);
    ledger.particle_stress_work(works);
    ledger.gravity_work(sums[0]);
    *kinetic = Some(sums[1]);
    cells.stirred = stirred;
    let crossing = crossing.plus(leavers::locate(&mut guests.leavers, active, &search));
    ledger.grid_stress_work(sums[2]);
    cells.worked = sums[3];
    cells.summed = if stays { Summed::All } else { Summed::Nothing };
    (least.0 <= 0.0, crossing)
}

/// Whether no slot is taken for a usual one, to see that both ways are the same.
#[cfg(test)]
fn in_parts() -> bool {
    tests::IN_PARTS.load(std::sync::atomic::Ordering::Relaxed)
}

#[cfg(not(test))]
fn in_parts() -> bool {
    false
}

type Arrays<'a> = (
    Stressed<'a>,
    (Columns<'a, 3>, Columns<'a, 3>),
    &'a mut [u32],
);

/// What the pass changes of particles.
struct Own<'a> {
    stressed: Stressed<'a>,
    position: Columns<'a, 3>,
    velocity: Columns<'a, 3>,
}

impl Own<'_> {
    /// All numbers of a particle of this mass, in the order of the working columns.
    fn working(&self, place: usize, mass: f64) -> [f64; WORKING] {
        let (stress, state, volume) = &self.stressed;
        let [x, v] = [&self.position, &self.velocity].map(|vectors| vectors.at(place));
        let scalars = [volume.at(place)[0], mass];
        let (stress, state) = (stress.at(place), state.at(place));
        let mut all = (x.into_iter().chain(v).chain(scalars))
            .chain(stress)
            .chain(state);
        std::array::from_fn(|_| all.next().expect("as many as there are"))
    }
}

/// The cells of a tile.
struct Cells<'a> {
    shapes: &'a Shapes,
    deformation: &'a Deformation,
}

for_each_simd! {
    /// Fetches the particles of a slot, gives them what they have not received yet, and turns their stresses.
    fn begin(
        motion: &mut Motion,
        carried: &mut Carried,
        points: &mut Points,
        arrays: &Own,
        mass: &[f64],
        cells: &Cells,
        kick: (&Kick, Option<Pending>),
        start: usize,
        held: &Held,
        opening: Option<usize>,
    ) {
        motion.fetch(&arrays.position, carried, mass, start, held);
        let mut v = [Lane::of(0.0); 3];
        arrays.velocity.load(&mut v, start);
        for k in 0..3 {
            carried.velocity[k] = only(&carried.mass, &v[k]);
        }
        points.fetch(&arrays.stressed, start, held);
        if let (kick, Some(pending)) = kick {
            for l in 0..LANES {
                let arm = cells.shapes.arm(l, Vec3::from_array(get(&motion.position, l)));
                let v = kick.receive(l, arm, Vec3::from_array(get(&carried.velocity, l)), pending);
                set(&mut carried.velocity, l, v.to_array());
            }
        }
        for l in 0..LANES {
            points.turn(cells.deformation, l);
        }
        points.look_for_open(opening);
    }
}

for_each_simd! {
    /// Moves particles that have their new stresses.
    fn end(
        motion: &mut Motion,
        carried: &mut Carried,
        points: &mut Points,
        booked: &mut Booked,
        kick: &mut Kick,
        cells: &Cells,
        gravity: Vec3,
    ) {
        for l in 0..LANES {
            points.book(booked, l);
            kick.count(l, carried.mass[l], Vec3::from_array(get(&carried.velocity, l)));
            motion.go_along(cells.shapes, cells.deformation, gravity, carried, l);
        }
    }
}

for_each_simd! {
    /// Copies what is new to the particles of a slot.
    fn keep(
        motion: &mut Motion,
        carried: &Carried,
        points: &mut Points,
        arrays: &mut Own,
        start: usize,
        lanes: usize,
        opening: Option<usize>,
    ) {
        motion.look_who_left();
        points.look_for_open(opening);
        points.keep::<S>(&mut arrays.stressed, start, lanes);
        arrays.position.put::<S>(&motion.position, start, lanes);
        arrays.velocity.put::<S>(&carried.velocity, start, lanes);
    }
}
