//! Sums that the last drift has not made: of all cells where the mesh moves, else of guests that have just come.

use super::{Arrays, Asked, Carried, Counted, Given, Sums, arrays, differs, each};
use crate::Vec3;
use crate::lanes::{
    self, AHEAD, ByTile, Held, LANES, Lane, VoigtLanes, any, for_each_simd, get, held, load,
    load_one, only, prefetch, set,
};
use crate::material::STATE_SIZE;
use crate::parallel::Split;
use crate::particles::Particles;
use crate::simulation::Simulation;
use crate::step::corners::{NO_CORNERS, load_nodes};
use crate::step::shapes::Shapes;
use crate::step::state::Summed;
use crate::step::strain;
use crate::step::stress::Bodies;

/// Particles side by side, as they lie in memory.
struct Side {
    position: [Lane; 3],
    volume: Lane,
    stress: VoigtLanes,
    state: [Lane; STATE_SIZE],
}

impl Default for Side {
    fn default() -> Side {
        Side {
            position: [Lane::of(0.0); 3],
            volume: Lane::of(0.0),
            stress: [Lane::of(0.0); 6],
            state: [Lane::of(0.0); STATE_SIZE],
        }
    }
}

for_each_simd! {
    fn fetch(
        side: &mut Side,
        carried: &mut Carried,
        particles: &Particles,
        start: usize,
        shapes: &Shapes,
        held: &Held,
    ) {
        let Particles { position, velocity, stress, state, .. } = particles;
        let (position, velocity) = (position.components(), velocity.components());
        let (stress, state) = (stress.components(), state.components());
        let scalars = [&particles.mass[..], &particles.volume];
        load(&mut side.position, &position, start);
        load(&mut carried.velocity, &velocity, start);
        load(&mut side.stress, &stress, start);
        load(&mut side.state, &state, start);
        prefetch(&position, start + AHEAD);
        prefetch(&velocity, start + AHEAD);
        prefetch(&stress, start + AHEAD);
        prefetch(&state, start + AHEAD);
        prefetch(&scalars, start + AHEAD);
        let (mut mass, mut volume) = (Lane::of(0.0), Lane::of(0.0));
        load_one(&mut mass, scalars[0], start);
        load_one(&mut volume, scalars[1], start);
        (carried.mass, side.volume) = (only(held, &mass), only(held, &volume));
        for l in 0..LANES {
            let n = shapes.at(l, Vec3::from_array(get(&side.position, l)));
            set(&mut carried.shapes, l, n);
        }
    }
}

/// The sums that the last drift has not made: of all cells, or of guests that have just come; and the second half of the
/// work of the particles' stresses in it.
pub(in super::super) fn run(sim: &mut Simulation, before: f64) {
    let made = std::mem::take(&mut sim.cells.summed);
    let known = std::mem::take(&mut sim.cells.worked);
    let work = match made {
        Summed::All => known,
        Summed::Before(tile) => known + make(sim, tile, before > 0.0),
        Summed::Nothing => {
            // They stay for the next drift.
            sim.guests_arrive();
            make(sim, 0, before > 0.0)
        }
    };
    sim.ledger.grid_stress_work(work);
}

/// From this tile on: it is the first one, or the first one of guests. Returns half the work in the last drift, J, if it has
/// `drifted`, of the particles in the cells that it has been to.
fn make(sim: &mut Simulation, from: usize, drifted: bool) -> f64 {
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
    let differs = differs(elasticity, asked.reference);
    let (arrays, given, mass, cut) = arrays(cells, differs);
    type All<'a> = (Arrays<'a>, Given<'a>);
    let all = ByTile::new(&active.tiles, (), (arrays, given));
    // More guests add to what the others have given.
    let more = from > active.own_tiles();
    let work = |block: ByTile<(), All>| {
        let tiles = block.each();
        let (arrays, (to_nodes, to_pairs)) = block.cells;
        let (mut side, mut sums) = (Side::default(), Sums::default());
        let mut bodies = Bodies::new(asked.plan);
        let mut giving = match more {
            true => (to_nodes.go_on(), to_pairs.go_on()),
            false => (to_nodes.begin(), to_pairs.begin()),
        };
        let (mut moved, mut work) = (NO_CORNERS, Lane::of(0.0));
        let mut shapes = Shapes::default();
        for ((number, tile), mut records) in tiles.zip(each(arrays)) {
            sums.enter(&mut records);
            if tile.is_empty() {
                continue;
            }
            let nodes = active.tile_nodes(number);
            let pairs = mass.tile_pairs(number);
            shapes.enter(asked.simd, nodes, &shared.places);
            for slot in tile.slots() {
                fetch(
                    asked.simd,
                    &mut side,
                    sums.next(),
                    particles,
                    slot.start,
                    &shapes,
                    held(slot.len()),
                );
                let body = &particles.body[slot];
                let whose = bodies.of(body);
                let may_open = |k: usize| any(&side.state[k][..body.len()]);
                let points = Counted {
                    position: &side.position,
                    volume: &side.volume,
                    stress: &side.stress,
                    state: &side.state,
                    open: whose.opening.is_none_or(may_open),
                };
                sums.add(&asked, &points, body, whose, &mut records);
            }
            sums.leave(asked.simd, tile, &mut records, nodes, pairs, &mut giving);
            if drifted {
                load_nodes(asked.simd, &mut moved, nodes, &shared.moved);
                strain::half_work(asked.simd, &shapes, &moved, records.sum, &mut work);
            }
        }
        lanes::sum(&work)
    };
    match from {
        0 => cut.fold(all, &work),
        _ => work(all.split(from).1),
    }
}
