//! Nodal mixed discretisation against locking (Detournay and Dzik 2006; Jassim et al. Eq. 15–16).
//!
//! Volumetric strains θ_e of cells are averaged at nodes and the nodes' means given back,
//!
//!   θ_n = Σ_e w_e θ_e / W_n,   θ̄_e = ¼ Σ_n θ_n,   W_n = Σ_e w_e,
//!
//! with w_e = V_e in the bulk, min(Σ V_p, V_e) at free surfaces. Separated particles keep θ_e and
//! do not count: with grains apart there is no bulk stiffness that would tie volumes together, and
//! a grain that lands among others in free flight has to feel its own cell. (Counting them, the
//! pressure of such a grain is not relieved by the motion that it drives. It does work for ever:
//! sparse fronts gain energy and throw grains about.)
//!
//! # Conjugate smoothing
//!
//! Particles take up the work Σ P_e θ̄_e, P_e being mean stress times volume, and forces from P_e
//! do Σ P_e θ_e. Forces from the transposed operator,
//!
//!   P̂_e = w_e Σ_n q_n,   q_n = ¼ Σ_e P_e / W_n,
//!
//! do Σ P̂_e θ_e = Σ P_e θ̄_e: nothing is lost. But then neither forces nor strains know of a
//! pressure that alternates from cell to cell. Elastic material never makes one; plastic flow does,
//! and frictional soil becomes too weak, the more the finer the mesh (validation case
//! `collapse-smoothing`). It is offered for comparison and is not the default.

use super::{BLOCK, CellForce, CellSums, Node, to_nodes};
use crate::Vec3;
use crate::parallel::fold;
use crate::plan::Smoothing;
use crate::simulation::Simulation;
use crate::tensor;
use std::ops::Range;

/// w_e, m³.
#[inline]
pub(super) fn weight(force: &CellForce, sum: &CellSums, closed: f64, volume: f64) -> f64 {
    let weight = if force.filled {
        volume
    } else {
        sum.volume.min(volume)
    };
    if closed < sum.volume {
        weight * closed / sum.volume
    } else {
        weight
    }
}

/// θ̄_e of the cell with these nodes.
#[inline]
pub(super) fn cell(corners: &[u32; 4], nodes: &[Node]) -> f64 {
    0.25 * corners
        .iter()
        .map(|&n| nodes[n as usize].volumetric)
        .sum::<f64>()
}

/// θ_n of each node.
pub(super) fn strains(sim: &mut Simulation) {
    if sim.plan.numerics.smoothing == Smoothing::Off {
        return;
    }
    sum_at_nodes(sim, |node, sum, weights| {
        node.volumetric = if weights > 0.0 { sum / weights } else { 0.0 }
    });
}

/// Sums a value of the attached cells and their weight w_e, both in `weights`, at each node, and has
/// `store` make something of them.
fn sum_at_nodes(sim: &mut Simulation, store: impl Fn(&mut Node, f64, f64) + Sync) {
    let Simulation {
        active,
        nodes,
        cells,
        ..
    } = sim;
    let (active, weights) = (&*active, &cells.weights[..]);
    let items = (0..nodes.len(), &mut nodes[..]);
    fold(items, BLOCK, &|(slots, nodes): (
        Range<usize>,
        &mut [Node],
    )| {
        for (slot, node) in slots.zip(nodes) {
            let (mut sum, mut all) = (0.0, 0.0);
            for &(c, _) in active.attached(slot) {
                let [value, weight] = weights[c as usize];
                sum += value;
                all += weight;
            }
            store(node, sum, all);
        }
    });
}

/// Puts P̂_e in the place of P_e in the cells' forces, and books the work of the difference in
/// the last drift (`before` > 0).
pub(super) fn stresses(sim: &mut Simulation, before: f64) {
    if sim.plan.numerics.smoothing != Smoothing::Conjugate {
        return;
    }
    for c in 0..sim.cells.forces.len() {
        let (force, closed) = (&sim.cells.forces[c], sim.cells.stresses[c].closed);
        let volume = sim.plan.mesh.volumes[sim.active.elements[c] as usize];
        let weight = weight(force, &sim.cells.sums[c], closed, volume);
        sim.cells.weights[c] = [tensor::trace(&force.stress), weight];
    }
    // q_n: a trace is three times the mean, and a quarter goes to each node.
    sum_at_nodes(sim, |node, sum, weights| {
        let whole = 12.0 * weights;
        node.mean_stress = if weights > 0.0 { sum / whole } else { 0.0 };
    });
    let Simulation {
        plan,
        active,
        nodes,
        cells,
        ledger,
        ..
    } = sim;
    let (mesh, active, nodes, weights) = (&plan.mesh, &*active, &nodes[..], &cells.weights[..]);
    let items = (
        0..weights.len(),
        &mut cells.forces[..],
        &mut cells.nodal[..],
    );
    let work = fold(items, BLOCK, &|(range, forces, nodal): (
        Range<usize>,
        &mut [CellForce],
        &mut [[Vec3; 4]],
    )| {
        let mut work = 0.0;
        for ((c, force), nodal) in range.zip(forces).zip(nodal) {
            let e = active.elements[c] as usize;
            let corners = active.cell_nodes[c].map(|n| &nodes[n as usize]);
            let mean: f64 = corners.iter().map(|n| n.mean_stress).sum();
            force.smoothed = mean * weights[c][1] - tensor::trace(&force.stress) / 3.0;
            (0..3).for_each(|k| force.stress[k] += force.smoothed);
            if before > 0.0 {
                let moved = corners.map(|n| n.moved);
                let gradient = super::strain::gradient(&mesh.gradients[e], moved);
                work += force.half_smoothing_work(&gradient);
            }
            *nodal = to_nodes::nodal(force, mesh, e);
        }
        work
    });
    ledger.stress_smoothing_work(work);
}
