//! Stages 7 and 8: particles move with the nodes, the mesh moves with its driver and its boundaries,
//! and each particle's element is found anew.

use super::shapes::{Corners, NO_CORNERS, Shapes, all_corners, interpolate, load_nodes};
use super::state::moved;
use super::{BLOCK, guard};
use crate::Vec3;
use crate::contact::{Contacts, Fields};
use crate::lanes::{self, LANES, Lane, Window, either, for_each_simd, get, set, whole};
use crate::measure::Part;
use crate::mesh::Mesh;
use crate::parallel::{ByCell, First, Sum, fold};
use crate::simulation::{Simulation, Stop};

pub(super) fn run(sim: &mut Simulation) -> Result<(), Stop> {
    let stays = !(sim.driven.moves() || sim.follower.moves());
    let mut crossing = move_particles(sim, stays);
    sim.profile.lap(Part::Move);
    if !stays {
        move_mesh(sim)?;
        sim.profile.lap(Part::Mesh);
        crossing = locate(sim);
        sim.profile.lap(Part::Locate);
    }
    if check(sim, crossing)? {
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
    shapes: Shapes,
    moved: Corners,
    position: [Lane; 3],
    displacement: [Lane; 3],
    mass: Lane,
    work: Lane,
    /// 1 where a particle has left its element as it was.
    left: Lane,
}

impl Default for Side {
    fn default() -> Side {
        let vector = [[0.0; LANES]; 3];
        Side {
            shapes: Shapes::default(),
            moved: NO_CORNERS,
            position: vector,
            displacement: vector,
            mass: [0.0; LANES],
            work: [0.0; LANES],
            left: [0.0; LANES],
        }
    }
}

#[inline(always)]
fn is_inside(n: [f64; 4]) -> bool {
    (n[0] >= 0.0) & (n[1] >= 0.0) & (n[2] >= 0.0) & (n[3] >= 0.0)
}

for_each_simd! {
    fn go_along(side: &mut Side, gravity: Vec3, lanes: usize) {
        for l in 0..whole(lanes) {
            let mut x = Vec3::from_array(get(&side.position, l));
            let step = interpolate(side.shapes.at(l, x), all_corners(&side.moved, l));
            x += step;
            set(&mut side.position, l, x.to_array());
            let displacement = Vec3::from_array(get(&side.displacement, l)) + step;
            set(&mut side.displacement, l, displacement.to_array());
            side.work[l] += side.mass[l] * gravity.dot(step);
            side.left[l] = either(is_inside(side.shapes.at(l, x)), 0.0, 1.0);
        }
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
}

impl Sum for Crossing {
    fn plus(self, other: Crossing) -> Crossing {
        Crossing {
            outside: self.outside.plus(other.outside),
            crossed: self.crossed.plus(other.crossed),
            passed: self.passed.plus(other.passed),
        }
    }
}

/// What it takes to find a particle's element.
struct Search<'a> {
    mesh: &'a Mesh,
    fields: &'a Fields,
    contacts: &'a Contacts,
    body: &'a [u16],
}

impl Search<'_> {
    /// Walks particle `p` to its element.
    #[inline]
    fn walk(&self, p: usize, x: Vec3, element: &mut u32, crossing: &mut Crossing) {
        match self.mesh.walk(*element, x) {
            Some(found) if found == *element => {}
            Some(found) => {
                let field = self.fields.of(self.body[p]);
                if self.contacts.blocks(field, *element, found) {
                    crossing.passed.note(p);
                } else {
                    *element = found;
                    crossing.crossed.note(p);
                }
            }
            None => crossing.outside.note(p),
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
        nodes,
        ledger,
        gravity,
        fields,
        contacts,
        simd,
        ..
    } = sim;
    let (mesh, active, nodes, gravity) = (&plan.mesh, &*active, &nodes[..], *gravity);
    let (mass, simd) = (&particles.mass, *simd);
    let search = Search {
        mesh,
        fields,
        contacts,
        body: &particles.body,
    };
    let arrays = (
        &mut particles.position[..],
        &mut particles.displacement[..],
        &mut particles.element[..],
    );
    let block = ByCell::new(&active.offsets, arrays);
    type Arrays<'a> = (&'a mut [Vec3], &'a mut [Vec3], &'a mut [u32]);
    let (lifted, crossing) = fold(block, BLOCK, &|block: ByCell<Arrays>| {
        let first = block.first();
        let (positions, displacements, elements) = block.particles;
        let mut side = Side::default();
        let mut crossing = Crossing::default();
        for window in Window::of(block.cells, &active.offsets) {
            for (l, &c) in window.cells().iter().enumerate() {
                let c = c as usize;
                side.shapes.load(l, mesh, active.elements[c] as usize);
                load_nodes(&mut side.moved, l, active, c, nodes, |n| n.moved);
            }
            window.slots(|slot| {
                for (l, &p) in slot.iter().enumerate() {
                    let own = p as usize - first;
                    set(&mut side.position, l, positions[own].to_array());
                    set(&mut side.displacement, l, displacements[own].to_array());
                    side.mass[l] = mass[p as usize];
                }
                side.mass[slot.len()..whole(slot.len())].fill(0.0);
                go_along(simd, &mut side, gravity, slot.len());
                for (l, &p) in slot.iter().enumerate() {
                    let own = p as usize - first;
                    positions[own] = Vec3::from_array(get(&side.position, l));
                    displacements[own] = Vec3::from_array(get(&side.displacement, l));
                    if stays && side.left[l] != 0.0 {
                        let x = positions[own];
                        search.walk(p as usize, x, &mut elements[own], &mut crossing);
                    }
                }
            });
        }
        (lanes::sum(&side.work), crossing)
    });
    ledger.gravity_work(lifted);
    crossing
}

for_each_simd! {
    fn look(side: &mut Side, lanes: usize) {
        for l in 0..whole(lanes) {
            let x = Vec3::from_array(get(&side.position, l));
            side.left[l] = either(is_inside(side.shapes.at(l, x)), 0.0, 1.0);
        }
    }
}

/// Finds each particle's element in a mesh that has moved.
fn locate(sim: &mut Simulation) -> Crossing {
    let Simulation {
        plan,
        particles,
        active,
        fields,
        contacts,
        simd,
        ..
    } = sim;
    let search = Search {
        mesh: &plan.mesh,
        fields,
        contacts,
        body: &particles.body,
    };
    let (active, position, simd) = (&*active, &particles.position, *simd);
    let block = ByCell::new(&active.offsets, &mut particles.element[..]);
    fold(block, BLOCK, &|block: ByCell<&mut [u32]>| {
        let first = block.first();
        let elements = block.particles;
        let mut side = Side::default();
        let mut crossing = Crossing::default();
        for window in Window::of(block.cells, &active.offsets) {
            for (l, &c) in window.cells().iter().enumerate() {
                let e = active.elements[c as usize] as usize;
                side.shapes.load(l, search.mesh, e);
            }
            window.slots(|slot| {
                for (l, &p) in slot.iter().enumerate() {
                    set(&mut side.position, l, position[p as usize].to_array());
                }
                look(simd, &mut side, slot.len());
                for (l, &p) in slot.iter().enumerate() {
                    if side.left[l] != 0.0 {
                        let (p, element) = (p as usize, &mut elements[p as usize - first]);
                        search.walk(p, position[p], element, &mut crossing);
                    }
                }
            });
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
    if crossing.passed.get().is_some() {
        crossed |= guard::put_back(sim)?;
    }
    Ok(crossed)
}
