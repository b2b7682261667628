//! Rigid bodies in stage 2: the motion of the whole body.

use super::{Active, Node};
use crate::Vec3;
use crate::contact::{HeldDirections, Rigid};
use crate::simulation::Simulation;

/// Velocities at the end of a kick of length `h` without contact: V + h F/M, as far as nothing holds
/// the body. Nodes of rigid bodies have no internal forces; local damping leaves them alone.
pub(super) fn predict(sim: &mut Simulation, h: f64) {
    let Simulation {
        active,
        nodes,
        constraints,
        contacts,
        gravity,
        ..
    } = sim;
    for body in &mut contacts.rigid {
        let (mut mass, mut momentum, mut force) = (0.0, Vec3::ZERO, Vec3::ZERO);
        let mut held = HeldDirections::default();
        // Of the node with most mass: one that the body has just reached has not moved with it.
        let (mut most, mut moved) = (0.0, Vec3::ZERO);
        for slot in own(active, body.field) {
            let node = &nodes[slot];
            if node.mass > most {
                (most, moved) = (node.mass, node.moved);
            }
            mass += node.mass;
            momentum += node.velocity * node.mass;
            force += *gravity * node.weighed + node.load;
            if let Some(constraint) = constraints.of(active.nodes[slot]) {
                held.add(&constraint.free);
            }
        }
        if mass == 0.0 {
            continue;
        }
        (body.mass, body.free) = (mass, held.free());
        body.before = momentum / mass;
        body.velocity = body.free * (body.before + force * (h / mass));
        for slot in own(active, body.field) {
            let node = &mut nodes[slot];
            let force = *gravity * node.weighed + node.load;
            node.damping = Vec3::ZERO;
            node.is_acted_on = true;
            node.moved = moved;
            node.reaction = body.free * force - force;
        }
        spread(body, active, nodes, h);
    }
}

/// Gives all nodes of a body its acceleration.
pub(super) fn spread(body: &Rigid, active: &Active, nodes: &mut [Node], h: f64) {
    let acceleration = (body.velocity - body.before) / h;
    for slot in own(active, body.field) {
        nodes[slot].acceleration = acceleration;
    }
}

/// The nodes of a field: keys ascend by field.
fn own(active: &Active, field: usize) -> std::ops::Range<usize> {
    let first = |field: usize| {
        let key = (field * active.grid_nodes) as u32;
        active.keys.partition_point(|&k| k < key)
    };
    first(field)..first(field + 1)
}
