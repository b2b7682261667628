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

use super::{BLOCK, CellForce, CellSums, Node};
use crate::parallel::fold;
use crate::plan::Smoothing;
use crate::simulation::{Cells, Simulation};
use crate::tensor;
use std::ops::Range;

/// w_e, m³.
#[inline]
fn weight(force: &CellForce, sum: &CellSums, volume: f64) -> f64 {
    let weight = if force.filled {
        volume
    } else {
        sum.volume.min(volume)
    };
    if sum.closed < sum.volume {
        weight * sum.closed / sum.volume
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
    sum_at_nodes(
        sim,
        |cells, c, weight| cells.strains[c].volumetric * weight,
        |node, sum, weights| node.volumetric = if weights > 0.0 { sum / weights } else { 0.0 },
    );
}

/// Sums a value of the attached cells, given their weight w_e, and the weights themselves at each
/// node, and has `store` make something of both.
fn sum_at_nodes(
    sim: &mut Simulation,
    value: impl Fn(&Cells, usize, f64) -> f64 + Sync,
    store: impl Fn(&mut Node, f64, f64) + Sync,
) {
    let Simulation {
        plan,
        active,
        nodes,
        cells,
        ..
    } = sim;
    let (mesh, active, cells) = (&plan.mesh, &*active, &*cells);
    let items = (0..nodes.len(), &mut nodes[..]);
    fold(items, BLOCK, &|(slots, nodes): (
        Range<usize>,
        &mut [Node],
    )| {
        for (slot, node) in slots.zip(nodes) {
            let (mut sum, mut weights) = (0.0, 0.0);
            for &(c, _) in active.attached(slot) {
                let c = c as usize;
                let volume = mesh.volumes[active.elements[c] as usize];
                let weight = weight(&cells.forces[c], &cells.sums[c], volume);
                sum += value(cells, c, weight);
                weights += weight;
            }
            store(node, sum, weights);
        }
    });
}

/// Puts P̂_e in the place of P_e in the cells' forces, and books the work of the difference in
/// the last drift (`before` > 0).
pub(super) fn stresses(sim: &mut Simulation, before: f64) {
    if sim.plan.numerics.smoothing != Smoothing::Conjugate {
        return;
    }
    // q_n: a trace is three times the mean, and a quarter goes to each node.
    sum_at_nodes(
        sim,
        |cells, c, _| tensor::trace(&cells.forces[c].stress),
        |node, sum, weights| {
            let whole = 12.0 * weights;
            node.mean_stress = if weights > 0.0 { sum / whole } else { 0.0 };
        },
    );
    let Simulation {
        plan,
        active,
        nodes,
        cells,
        ledger,
        ..
    } = sim;
    let (mesh, active, nodes, sums) = (&plan.mesh, &*active, &nodes[..], &cells.sums[..]);
    let items = (0..sums.len(), &mut cells.forces[..]);
    let work = fold(items, BLOCK, &|(range, forces): (
        Range<usize>,
        &mut [CellForce],
    )| {
        let mut work = [0.0; 3];
        for (c, force) in range.zip(forces) {
            let e = active.elements[c] as usize;
            let corners = active.cell_nodes[c].map(|n| &nodes[n as usize]);
            let mean: f64 = corners.iter().map(|n| n.mean_stress).sum();
            let weight = weight(force, &sums[c], mesh.volumes[e]);
            force.smoothed = mean * weight - tensor::trace(&force.stress) / 3.0;
            (0..3).for_each(|k| force.stress[k] += force.smoothed);
            if before > 0.0 {
                let gradient = super::strain::gradient(mesh, e, corners.map(|n| n.moved));
                work[0] += force.half_smoothing_work(&gradient);
            }
        }
        work
    });
    ledger.stress_smoothing_work(work[0]);
}
