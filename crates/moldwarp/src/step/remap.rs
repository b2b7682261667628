//! Stage 4: nodal velocities of the updated particles, v_i = Σ m_p v_p N_i / m_i, constraints
//! applied again, and Δu_i = Δt v_i (Jassim et al. Eq. 9; Sulsky et al. 1995 for the average).

use super::{BLOCK, Node};
use crate::Vec3;
use crate::measure::DriftWork;
use crate::parallel::fold;
use crate::simulation::Simulation;
use std::ops::Range;

pub(super) fn run(sim: &mut Simulation, dt: f64) {
    let Simulation {
        plan,
        active,
        nodes,
        cells,
        constraints,
        absorbing,
        ledger,
        probes,
        ..
    } = sim;
    let (active, sums, constraints, gravity) =
        (&*active, &cells.sums[..], &*constraints, plan.gravity);
    let items = (0..nodes.len(), &mut nodes[..]);
    let work = fold(items, BLOCK, &|(slots, nodes): (
        Range<usize>,
        &mut [Node],
    )| {
        let mut work = DriftWork::default();
        for (slot, node) in slots.zip(nodes) {
            let momentum: Vec3 = active
                .attached(slot)
                .iter()
                .map(|&(c, local)| sums[c as usize].momentum[local as usize])
                .sum();
            node.grid_velocity = if node.mass > 0.0 {
                momentum / node.mass
            } else {
                Vec3::ZERO
            };
            if let Some(constraint) = constraints.of(active.nodes[slot]) {
                node.grid_velocity =
                    constraint.free * node.grid_velocity + constraints.prescribed(constraint);
            }
            node.moved = node.grid_velocity * dt;
            work.add(node, gravity);
        }
        work
    });
    ledger.drift(work);
    let moved = |mesh_node: u32| {
        let slot = active.slot_of_node[mesh_node as usize] as usize;
        nodes.get(slot).map_or(Vec3::ZERO, |node| node.moved)
    };
    absorbing
        .nodes
        .iter_mut()
        .for_each(|n| n.displacement += moved(n.node));
    probes.add_drift(moved);
}
