//! Stage 4: nodal velocities of the updated particles, and Δu_i = Δt v_i (Jassim et al. Eq. 9).
//!
//! The average v̄_i = Σ m_p v_p N_i / m_i (Sulsky et al. 1995) keeps nodes with little support
//! harmless, but it smooths: with M_ij = Σ m_p N_i N_j, what comes back to the nodes of an
//! acceleration that was handed to the particles is (M a)_i / m_i. A wave along a column with
//! nodes h apart then runs at
//!
//!   ω / (c k) = 1 − (k h)²/24 [1 − (c Δt/h)² + s + 2 (1 − θ)],
//!
//! with 1 from the stiffness, s from the smoothing of strains (0 for shear, 1 for compression at
//! ν = 0) and 2 from the average (θ = 0). The remap takes the smoothing back with
//!
//!   v_i = v̄_i + θ/m_i Σ_j M_ij (v̄_i − v̄_j).
//!
//! The sum is over pairs of nodes, so that momentum stays as it is; as a polynomial in M the
//! operator is self-adjoint and commutes with the average, so that energy does too (restricted
//! to filled cells it gains energy whenever particles cross). θ = 1 is the first step towards the
//! consistent mass matrix, M v = Σ m_p v_p N. No error is left for shear at θ = 1.47 and for
//! compression at θ = 1.94 (Kuhn tetrahedra of cubes, ν = 0, Courant number 0.5); we take 1.7.
//! (Averaging lumped and consistent mass for phase accuracy: Goudreau and Taylor 1973.)

use super::{BLOCK, CellSums, Node};
use crate::Vec3;
use crate::measure::DriftWork;
use crate::parallel::fold;
use crate::plan::MassMatrix;
use crate::simulation::Simulation;
use std::ops::Range;

/// θ.
const CORRECTION: f64 = 1.7;

/// The pairs of a cell's nodes, in the order of [`CellSums::pairs`].
pub(super) const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

pub(super) fn run(sim: &mut Simulation, dt: f64) {
    average(sim);
    let theta = match sim.plan.numerics.mass {
        MassMatrix::Corrected => {
            exchange(sim);
            CORRECTION
        }
        MassMatrix::Lumped => 0.0,
    };
    move_nodes(sim, theta, dt);
    let Simulation {
        active,
        nodes,
        absorbing,
        probes,
        ..
    } = sim;
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

/// v̄_i.
fn average(sim: &mut Simulation) {
    let Simulation {
        active,
        nodes,
        cells,
        ..
    } = sim;
    let (active, sums) = (&*active, &cells.sums[..]);
    let items = (0..nodes.len(), &mut nodes[..]);
    fold(items, BLOCK, &|(slots, nodes): (
        Range<usize>,
        &mut [Node],
    )| {
        for (slot, node) in slots.zip(nodes) {
            let attached = active.attached(slot).iter();
            let momentum: Vec3 = attached
                .map(|&(c, i)| sums[c as usize].momentum[i as usize])
                .sum();
            node.average = if node.mass > 0.0 {
                momentum / node.mass
            } else {
                Vec3::ZERO
            };
        }
    });
}

/// Σ_j M_ij (v̄_i − v̄_j) of each cell.
fn exchange(sim: &mut Simulation) {
    let Simulation {
        active,
        nodes,
        cells,
        ..
    } = sim;
    let (active, nodes) = (&*active, &nodes[..]);
    let items = (0..active.elements.len(), &mut cells.sums[..]);
    fold(items, BLOCK, &|(range, sums): (
        Range<usize>,
        &mut [CellSums],
    )| {
        for (c, sum) in range.zip(sums) {
            let v = active.cell_nodes[c].map(|n| nodes[n as usize].average);
            sum.exchange = [Vec3::ZERO; 4];
            for (&(i, j), &mass) in PAIRS.iter().zip(&sum.pairs) {
                let flux = (v[i] - v[j]) * mass;
                sum.exchange[i] += flux;
                sum.exchange[j] -= flux;
            }
        }
    });
}

/// v_i with constraints applied again, Δu_i, and the first half of its work.
fn move_nodes(sim: &mut Simulation, theta: f64, dt: f64) {
    let Simulation {
        plan,
        active,
        nodes,
        cells,
        constraints,
        ledger,
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
            node.grid_velocity = node.average;
            if theta > 0.0 && node.mass > 0.0 {
                let attached = active.attached(slot).iter();
                let sum: Vec3 = attached
                    .map(|&(c, i)| sums[c as usize].exchange[i as usize])
                    .sum();
                node.grid_velocity += sum * (theta / node.mass);
            }
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
}
