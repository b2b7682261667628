//! Stages 7 and 8: particles move with the nodes, the mesh moves with its driver and its boundaries,
//! and each particle's element is found anew.

use super::motion::{Crossing, Motion, Search, look};
use super::shapes::Shapes;
use super::state::moved;
use super::{TILES, guard, points};
use crate::Vec3;
use crate::lanes::ByTile;
use crate::measure::Part;
use crate::parallel::fold;
use crate::simulation::Simulation;
use crate::stop::Stop;

pub(super) fn run(sim: &mut Simulation) -> Result<(), Stop> {
    let stays = !(sim.driven.moves() || sim.follower.moves());
    let (crushed, mut crossing) = points::run(sim, stays);
    crossing.outside = crossing.outside.map(|p| sim.guests.home(p, &sim.particles));
    let plain = crossing.is_plain();
    if crushed || !stays || !plain {
        sim.guests_leave();
    }
    sim.profile.lap(Part::Points);
    if crushed {
        return Err(sim.crushed());
    }
    if !stays {
        move_mesh(sim)?;
        sim.shared.place(&sim.active, &sim.plan.mesh);
        sim.profile.lap(Part::Mesh);
        crossing = locate(sim);
        sim.profile.lap(Part::Locate);
    }
    let gone = crossing.gone.get().is_some();
    let crossed = check(sim, crossing)?;
    if gone || crossed && !(plain && sim.may_have_guests() && sim.regroup()) {
        sim.reorder();
    }
    sim.profile.lap(Part::Order);
    match sim.driven.degenerate(&sim.plan.mesh) {
        Some(element) => Err(sim.degenerate(element)),
        None => Ok(()),
    }
}

/// The mesh goes with its driver and follows absorbing boundaries.
fn move_mesh(sim: &mut Simulation) -> Result<(), Stop> {
    let Simulation {
        plan,
        active,
        nodes,
        follower,
        driven,
        fields,
        ..
    } = sim;
    let mesh = &mut plan.mesh;
    if let Some(motion) = &plan.mesh_motion {
        let field = fields.of(motion.driver as u16);
        let own = |n: u32| {
            let slot = active.slot_of_key[field * active.grid_nodes + n as usize];
            let node = nodes.get(slot as usize);
            node.map_or((0.0, Vec3::ZERO), |node| (node.mass, node.moved))
        };
        driven.shift(&mut mesh.nodes, own);
    }
    follower.shift(&mut mesh.nodes, moved(active, nodes));
    mesh.update_geometry();
    match mesh.turned_over() {
        // In a single step, from flat but not degenerate.
        Some(element) if sim.driven.moves() => Err(sim.degenerate(element)),
        Some(element) => Err(sim.turned_over(element)),
        None => Ok(()),
    }
}

/// Finds each particle's element in a mesh that has moved.
fn locate(sim: &mut Simulation) -> Crossing {
    let Simulation {
        plan,
        particles,
        active,
        shared,
        fields,
        contacts,
        outflow,
        simd,
        ..
    } = sim;
    let search = Search {
        mesh: &plan.mesh,
        fields,
        contacts,
        outflow,
        body: &particles.body,
    };
    let (active, position, simd) = (&*active, particles.position.components(), *simd);
    let elements = &mut particles.element[..];
    let places = &shared.places[..];
    let all = ByTile::new(&active.tiles, elements, ());
    fold(all, TILES, &|block: ByTile<&mut [u32], ()>| {
        let first = block.first();
        let tiles = block.each();
        let elements = block.particles;
        let (mut motion, mut shapes) = (Motion::default(), Shapes::default());
        let mut crossing = Crossing::default();
        for (number, tile) in tiles {
            let nodes = active.tile_nodes(number);
            shapes.enter(simd, nodes, places);
            for slot in tile.slots() {
                look(simd, &mut motion, &shapes, &position, slot.start);
                for l in motion.who_left(slot.len()) {
                    let (p, x) = (slot.start + l, motion.at(l));
                    search.walk(
                        p,
                        shapes.at(l, x),
                        x,
                        &mut elements[p - first],
                        &mut crossing,
                    );
                }
            }
        }
        crossing
    })
}

/// Deals with what must not be; says whether any particle has a new element.
fn check(sim: &mut Simulation, crossing: Crossing) -> Result<bool, Stop> {
    if let Some(p) = crossing.outside.get() {
        return Err(sim.left_the_mesh(p));
    }
    let mut crossed = crossing.crossed.get().is_some();
    if crossing.gone.get().is_some() {
        sim.let_out()?;
        crossed = true;
    }
    if crossing.passed.get().is_some() {
        crossed |= guard::put_back(sim)?;
    }
    Ok(crossed)
}
