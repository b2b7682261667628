//! Stages 7 and 8: particles move with the nodes, the mesh moves with its driver and its boundaries,
//! and each particle's element is found anew.

use super::state::moved;
use super::{BLOCK, guard};
use crate::Vec3;
use crate::measure::Part;
use crate::parallel::{ByCell, First, fold};
use crate::simulation::{Simulation, Stop};

pub(super) fn run(sim: &mut Simulation) -> Result<(), Stop> {
    move_particles(sim);
    sim.profile.lap(Part::Move);
    if sim.driven.moves() || sim.follower.moves() {
        move_mesh(sim)?;
    }
    sim.profile.lap(Part::Mesh);
    let crossed = locate(sim)?;
    sim.profile.lap(Part::Locate);
    if crossed {
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

/// x_p += Σ N_i Δu_i (Jassim et al. Eq. 9).
fn move_particles(sim: &mut Simulation) {
    let Simulation {
        plan,
        particles,
        active,
        nodes,
        ledger,
        gravity,
        ..
    } = sim;
    let (mesh, active, nodes, gravity) = (&plan.mesh, &*active, &nodes[..], *gravity);
    let mass = &particles.mass;
    let arrays = (&mut particles.position[..], &mut particles.displacement[..]);
    let block = ByCell::new(&active.offsets, arrays);
    let lifted = fold(block, BLOCK, &|block: ByCell<(
        &mut [Vec3],
        &mut [Vec3],
    )>| {
        let first = block.first();
        let (positions, displacements) = block.particles;
        let mut work = 0.0;
        for c in block.cells {
            let e = active.elements[c] as usize;
            let moved = active.cell_nodes[c].map(|n| nodes[n as usize].moved);
            for p in active.offsets[c] as usize..active.offsets[c + 1] as usize {
                let n = mesh.barycentric(e, positions[p - first]);
                let step: Vec3 = (0..4).map(|i| moved[i] * n[i]).sum();
                positions[p - first] += step;
                displacements[p - first] += step;
                work += mass[p] * gravity.dot(step);
            }
        }
        work
    });
    ledger.gravity_work(lifted);
}

/// Walks each particle to its element; says whether any has a new one.
fn locate(sim: &mut Simulation) -> Result<bool, Stop> {
    let Simulation {
        plan,
        particles,
        active,
        fields,
        contacts,
        ..
    } = sim;
    let (mesh, position, body) = (&plan.mesh, &particles.position, &particles.body);
    let (fields, contacts) = (&*fields, &*contacts);
    let block = ByCell::new(&active.offsets, &mut particles.element[..]);
    let (outside, (crossed, passed)) = fold(block, BLOCK, &|block: ByCell<&mut [u32]>| {
        let first = block.first();
        let (mut outside, mut crossed) = (First::default(), First::default());
        let mut passed = First::default();
        for (k, element) in block.particles.iter_mut().enumerate() {
            let p = first + k;
            match mesh.walk(*element, position[p]) {
                Some(found) if found == *element => {}
                Some(found) if contacts.blocks(fields.of(body[p]), *element, found) => {
                    passed.0 = passed.0.min(p as u32);
                }
                Some(found) => {
                    *element = found;
                    crossed.0 = crossed.0.min(p as u32);
                }
                None => outside.0 = outside.0.min(p as u32),
            }
        }
        (outside, (crossed, passed))
    });
    if outside.0 != u32::MAX {
        return Err(sim.left_the_mesh(outside.0 as usize));
    }
    let mut crossed = crossed.0 != u32::MAX;
    if passed.0 != u32::MAX {
        crossed |= guard::put_back(sim)?;
    }
    Ok(crossed)
}
