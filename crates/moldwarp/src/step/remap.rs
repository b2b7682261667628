//! Stage 4: nodal velocities of the updated particles, and Δu_i = Δt v_i (Jassim et al. Eq. 9).
//!
//! The average v̄_i = Σ m_p v_p N_i / m_i (Sulsky et al. 1995) keeps nodes with little support
//! harmless; what it takes from short waves is given back (see `correction`). Held nodes exchange the
//! velocity that they have, as they do in stage 3 with accelerations, so that a roller on a plane of
//! symmetry is a mirror.

use super::corners::Quad;
use super::correction::{self, Change};
use super::state::moved;
use super::{BLOCK, Node, Shared, contact};
use crate::Vec3;
use crate::measure::DriftWork;
use crate::parallel::fold;
use crate::simulation::Simulation;
use std::ops::Range;

pub(super) fn run(sim: &mut Simulation, dt: f64) {
    hold(sim);
    if sim.fields.count() > 1 {
        contact::remap(sim, |node| &mut node.average);
        correction::give(&sim.nodes, &mut sim.shared.given, |node| node.average);
    }
    let alone = sim.contacts.meetings.is_empty();
    correct(sim, alone.then_some(dt));
    if !alone {
        contact::remap(sim, |node| &mut node.grid_velocity);
        move_nodes(sim, dt);
        contact::work(sim);
    }
    let Simulation {
        active,
        nodes,
        absorbing,
        probes,
        ..
    } = sim;
    let moved = moved(active, nodes);
    absorbing
        .nodes
        .iter_mut()
        .for_each(|n| n.displacement += moved(n.node));
    probes.add_drift(moved);
}

/// Applies constraints to v̄_i, and gives it to the nodes around.
fn hold(sim: &mut Simulation) {
    let Simulation {
        active,
        nodes,
        shared,
        constraints,
        ..
    } = sim;
    let (active, constraints) = (&*active, &*constraints);
    let items = (0..nodes.len(), &mut nodes[..], &mut shared.given[..]);
    fold(items, BLOCK, &|(slots, nodes, given): (
        Range<usize>,
        &mut [Node],
        &mut [Quad],
    )| {
        for ((slot, node), given) in slots.zip(nodes).zip(given) {
            node.prefetch(1..2);
            if let Some(constraint) = constraints.of(active.nodes[slot]) {
                node.average = constraint.free * node.average + constraints.prescribed(constraint);
            }
            *given = node.average.into();
        }
    });
}

/// v_i with constraints applied again; in a step of `dt` where no contact changes them, nodes move.
fn correct(sim: &mut Simulation, dt: Option<f64>) {
    let Simulation {
        plan,
        active,
        nodes,
        shared,
        cells,
        constraints,
        ledger,
        gravity,
        simd,
        ..
    } = sim;
    let (active, constraints, gravity) = (&*active, &*constraints, *gravity);
    let Shared { given, moved, .. } = shared;
    let change = Change::new(plan.numerics.mass, &cells.mass, *simd, given);
    let items = (0..nodes.len(), &mut nodes[..], &mut moved[..]);
    let work = fold(items, BLOCK, &|(slots, nodes, moved): (
        Range<usize>,
        &mut [Node],
        &mut [Quad],
    )| {
        let (mut work, mut flows) = (DriftWork::default(), [Quad::default(); BLOCK]);
        change.flows(slots.clone(), &mut flows);
        for (((slot, node), moved), &flow) in slots.zip(nodes).zip(moved).zip(&flows) {
            node.prefetch(0..3);
            node.grid_velocity = node.average + change.at(node.mass, flow);
            if let Some(constraint) = constraints.of(active.nodes[slot]) {
                node.grid_velocity =
                    constraint.free * node.grid_velocity + constraints.prescribed(constraint);
            }
            if let Some(dt) = dt {
                go(node, moved, dt, gravity, &mut work);
            }
        }
        work
    });
    if dt.is_some() {
        ledger.drift(work);
    }
}

/// Δu_i, and the first half of its work.
fn move_nodes(sim: &mut Simulation, dt: f64) {
    let Simulation {
        nodes,
        shared,
        ledger,
        gravity,
        ..
    } = sim;
    let gravity = *gravity;
    let items = (&mut nodes[..], &mut shared.moved[..]);
    let work = fold(items, BLOCK, &|(nodes, moved): (
        &mut [Node],
        &mut [Quad],
    )| {
        let mut work = DriftWork::default();
        for (node, moved) in nodes.iter_mut().zip(moved) {
            go(node, moved, dt, gravity, &mut work);
        }
        work
    });
    ledger.drift(work);
}

#[inline]
fn go(node: &mut Node, moved: &mut Quad, dt: f64, gravity: Vec3, work: &mut DriftWork) {
    node.moved = node.grid_velocity * dt;
    *moved = node.moved.into();
    work.add(node, gravity);
}
