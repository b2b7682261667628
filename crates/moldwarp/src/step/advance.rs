//! Stages 7 and 8: particles move with the nodes, the mesh moves with its driver and its boundaries,
//! and each particle's element is found anew.

use super::shapes::{Corners, NO_CORNERS, Shapes, all_corners, interpolate, load_nodes};
use super::state::moved;
use super::{TILES, guard};
use crate::Vec3;
use crate::boundary::Outflow;
use crate::contact::{Contacts, Fields};
use crate::lanes::{
    self, ByTile, Lane, either, for_each_simd, get, load, load_one, set, store, whole,
};
use crate::measure::Part;
use crate::mesh::{Mesh, NONE};
use crate::parallel::{First, Sum, fold};
use crate::simulation::Simulation;
use crate::stop::Stop;
use std::ops::Range;

pub(super) fn run(sim: &mut Simulation) -> Result<(), Stop> {
    let stays = !(sim.driven.moves() || sim.follower.moves());
    let mut crossing = move_particles(sim, stays);
    crossing.outside = crossing.outside.map(|p| sim.guests.home(p, &sim.particles));
    sim.guests_leave();
    sim.profile.lap(Part::Move);
    if !stays {
        move_mesh(sim)?;
        sim.cells.find_shapes(&sim.active, &sim.plan.mesh);
        sim.profile.lap(Part::Mesh);
        crossing = locate(sim);
        sim.profile.lap(Part::Locate);
    }
    let gone = crossing.gone.get().is_some();
    let crossed = check(sim, crossing)?;
    if gone || crossed && !(sim.may_have_guests() && sim.regroup()) {
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

/// Cells and particles side by side.
struct Side {
    moved: Corners,
    position: [Lane; 3],
    mass: Lane,
    work: Lane,
    /// 1 where a particle has left its element as it was.
    left: Lane,
}

impl Default for Side {
    fn default() -> Side {
        let vector = [Lane::of(0.0); 3];
        Side {
            moved: NO_CORNERS,
            position: vector,
            mass: Lane::of(0.0),
            work: Lane::of(0.0),
            left: Lane::of(0.0),
        }
    }
}

#[inline(always)]
fn is_inside(n: [f64; 4]) -> bool {
    (n[0] >= 0.0) & (n[1] >= 0.0) & (n[2] >= 0.0) & (n[3] >= 0.0)
}

for_each_simd! {
    fn go_along(
        side: &mut Side,
        shapes: &Shapes,
        gravity: Vec3,
        mass: &[f64],
        position: &mut [&mut [f64]; 3],
        start: usize,
        lanes: usize,
    ) {
        load(&mut side.position, &position.each_ref().map(|x| &**x), start);
        load_one(&mut side.mass, mass, start);
        side.mass[lanes..whole(lanes)].fill(0.0);
        for l in 0..whole(lanes) {
            let mut x = Vec3::from_array(get(&side.position, l));
            let step = interpolate(shapes.at(l, x), all_corners(&side.moved, l));
            x += step;
            set(&mut side.position, l, x.to_array());
            side.work[l] += side.mass[l] * gravity.dot(step);
            // Where a guest comes from lies a particle without mass.
            let stays = is_inside(shapes.at(l, x)) | (side.mass[l] == 0.0);
            side.left[l] = either(stays, 0.0, 1.0);
        }
        store(&side.position, position, start, lanes);
    }
}

/// Particles that have come to another element, by their places; the first of each kind.
#[derive(Clone, Copy, Debug, Default)]
struct Crossing {
    /// Out of the mesh.
    outside: First,
    /// Into another element.
    crossed: First,
    /// Across a face that they must not pass: they are still in the old element.
    passed: First,
    /// Out of the mesh, through an outflow surface: they are in no element.
    gone: First,
}

impl Sum for Crossing {
    fn plus(self, other: Crossing) -> Crossing {
        Crossing {
            outside: self.outside.plus(other.outside),
            crossed: self.crossed.plus(other.crossed),
            passed: self.passed.plus(other.passed),
            gone: self.gone.plus(other.gone),
        }
    }
}

/// What it takes to find a particle's element.
struct Search<'a> {
    mesh: &'a Mesh,
    fields: &'a Fields,
    contacts: &'a Contacts,
    outflow: &'a Outflow,
    body: &'a [u16],
}

impl Search<'_> {
    /// Whether a particle is of a rigid body, which goes as a whole or stays.
    fn is_rigid(&self, p: usize) -> bool {
        let field = self.fields.of(self.body[p]);
        let rigid = self.contacts.rigid_of_field.get(field);
        rigid.is_some_and(Option::is_some)
    }

    /// Walks particle `p` to its element.
    #[inline]
    fn walk(&self, p: usize, x: Vec3, element: &mut u32, crossing: &mut Crossing) {
        match self.mesh.walk_or_leave(*element, x) {
            Ok(found) if found == *element => {}
            Ok(found) => {
                let field = self.fields.of(self.body[p]);
                if self.contacts.blocks(field, *element, found) {
                    crossing.passed.note(p);
                } else {
                    *element = found;
                    crossing.crossed.note(p);
                }
            }
            Err(Some(face)) if self.outflow.lets_out(face) && !self.is_rigid(p) => {
                *element = NONE;
                crossing.gone.note(p);
            }
            Err(_) => crossing.outside.note(p),
        }
    }
}

/// x_p += Σ N_i Δu_i (Jassim et al. Eq. 9). In a mesh that stays, each particle's element is found on the
/// way.
fn move_particles(sim: &mut Simulation, stays: bool) -> Crossing {
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
        simd,
        ..
    } = sim;
    let (mesh, active, shared, gravity) = (&plan.mesh, &*active, &*shared, *gravity);
    let simd = *simd;
    let search = Search {
        mesh,
        fields,
        contacts,
        outflow,
        body: &particles.body,
    };
    type Arrays<'a> = ([&'a mut [f64]; 3], &'a mut [u32], &'a [f64]);
    let arrays = (
        particles.position.components_mut(),
        &mut particles.element[..],
        &particles.mass[..],
    );
    let all = ByTile::new(&active.tiles, arrays, &cells.shapes[..]);
    let (lifted, crossing) = fold(all, TILES, &|block: ByTile<Arrays, &[Shapes]>| {
        let first = block.first();
        let tiles = block.each().zip(block.cells);
        let (mut position, elements, mass) = block.particles;
        let mut side = Side::default();
        let mut crossing = Crossing::default();
        for ((number, tile), shapes) in tiles {
            load_nodes(&mut side.moved, active.tile_nodes(number), &shared.moved);
            for slot in tile.slots() {
                let start = slot.start - first;
                go_along(
                    simd,
                    &mut side,
                    shapes,
                    gravity,
                    mass,
                    &mut position,
                    start,
                    slot.len(),
                );
                if stays {
                    side.search(&search, slot, &mut elements[start..], &mut crossing);
                }
            }
        }
        (lanes::sum(&side.work), crossing)
    });
    ledger.gravity_work(lifted);
    crossing
}

impl Side {
    /// Finds the elements of the particles of a slot that have left theirs.
    fn search(
        &self,
        search: &Search,
        slot: Range<usize>,
        elements: &mut [u32],
        crossing: &mut Crossing,
    ) {
        let left = &self.left[..slot.len()];
        if left.iter().sum::<f64>() == 0.0 {
            return;
        }
        for (l, p) in slot.enumerate().filter(|&(l, _)| left[l] != 0.0) {
            let x = Vec3::from_array(get(&self.position, l));
            search.walk(p, x, &mut elements[l], crossing);
        }
    }
}

for_each_simd! {
    fn look(side: &mut Side, shapes: &Shapes, position: &[&[f64]; 3], start: usize, lanes: usize) {
        load(&mut side.position, position, start);
        for l in 0..whole(lanes) {
            let x = Vec3::from_array(get(&side.position, l));
            side.left[l] = either(is_inside(shapes.at(l, x)), 0.0, 1.0);
        }
    }
}

/// Finds each particle's element in a mesh that has moved.
fn locate(sim: &mut Simulation) -> Crossing {
    let Simulation {
        plan,
        particles,
        active,
        cells,
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
    let all = ByTile::new(&active.tiles, elements, &cells.shapes[..]);
    fold(all, TILES, &|block: ByTile<&mut [u32], &[Shapes]>| {
        let first = block.first();
        let tiles = block.each().zip(block.cells);
        let elements = block.particles;
        let mut side = Side::default();
        let mut crossing = Crossing::default();
        for ((_, tile), shapes) in tiles {
            for slot in tile.slots() {
                look(simd, &mut side, shapes, &position, slot.start, slot.len());
                let own = &mut elements[slot.start - first..];
                side.search(&search, slot, own, &mut crossing);
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
