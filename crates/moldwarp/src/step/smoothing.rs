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

use super::shapes::{Corners, all_corners, load_nodes, set_corner};
use super::shapes::{NO_CORNERS, sum_nodes};
use super::{BLOCK, CellForce, Cells, TILES, strain, to_nodes};
use crate::lanes::{LANES, Lane, either, get, lane_of};
use crate::parallel::fold;
use crate::plan::Smoothing;
use crate::simulation::Simulation;
use crate::tensor;
use std::ops::Range;

/// w_e, m³, of a cell of this `whole` volume of which particles have `volume`, `closed` of it not separated.
#[inline(always)]
pub(super) fn weight(filled: f64, volume: f64, closed: f64, whole: f64) -> f64 {
    let weight = either(filled > 0.0, whole, volume.min(whole));
    either(closed < volume, weight * closed / volume, weight)
}

/// θ̄_e of the cells with these nodes.
#[inline(always)]
pub(super) fn means(means: &mut Lane, nodes: &[[u32; 4]; LANES], volumetric: &[f64]) {
    sum_nodes(means, nodes, volumetric);
    means.iter_mut().for_each(|mean| *mean *= 0.25);
}

/// θ_n of each node.
pub(super) fn strains(sim: &mut Simulation) {
    if sim.plan.numerics.smoothing == Smoothing::Off {
        return;
    }
    let mut means = std::mem::take(&mut sim.shared.volumetric);
    sum_at_nodes(sim, &mut means[..], 1.0);
    sim.shared.volumetric = means;
}

/// At each node the sum of a value of the attached cells over that of their weights, both in `weights`, and
/// over `factor`.
fn sum_at_nodes(sim: &Simulation, means: &mut [f64], factor: f64) {
    let (active, weights) = (&sim.active, &sim.cells.weights[..]);
    let items = (0..means.len(), means);
    fold(items, BLOCK, &|(slots, means): (
        Range<usize>,
        &mut [f64],
    )| {
        for (slot, mean) in slots.zip(means) {
            let (mut sum, mut all) = (0.0, 0.0);
            for at in active.attached(slot) {
                let (tile, l) = lane_of(at.owner());
                let [value, weight] = &weights[tile];
                sum += value[l];
                all += weight[l];
            }
            let whole = factor * all;
            *mean = if all > 0.0 { sum / whole } else { 0.0 };
        }
    });
}

/// Puts P̂_e in the place of P_e in the cells' forces, and books the work of the difference in
/// the last drift (`before` > 0).
pub(super) fn stresses(sim: &mut Simulation, before: f64) {
    if sim.plan.numerics.smoothing != Smoothing::Conjugate {
        return;
    }
    let Cells {
        shapes,
        sums,
        stresses,
        forces,
        weights,
        ..
    } = &mut sim.cells;
    for (tile, [value, own]) in weights.iter_mut().enumerate() {
        let (sum, force) = (&sums[tile], &forces[tile]);
        for l in 0..LANES {
            let closed = stresses[tile].closed[l];
            own[l] = weight(
                force.filled[l],
                sum.volume[l],
                closed,
                shapes[tile].volume[l],
            );
            value[l] = tensor::trace(&get(&force.stress, l));
        }
    }
    // q_n: a trace is three times the mean, and a quarter goes to each node.
    let mut means = std::mem::take(&mut sim.shared.mean_stress);
    sum_at_nodes(sim, &mut means, 12.0);
    sim.shared.mean_stress = means;
    let Simulation {
        active,
        shared,
        cells,
        ledger,
        ..
    } = sim;
    let (active, shared) = (&*active, &*shared);
    let (shapes, weights) = (&cells.shapes[..], &cells.weights[..]);
    let items = (
        0..weights.len(),
        &mut cells.forces[..],
        &mut cells.corners[..],
    );
    let work = fold(items, TILES, &|(tiles, forces, corners): (
        Range<usize>,
        &mut [CellForce],
        &mut [Corners],
    )| {
        let (mut work, mut moved) = (0.0, NO_CORNERS);
        let mut means = [0.0; LANES];
        for ((tile, force), corners) in tiles.zip(forces).zip(corners) {
            let nodes = active.tile_nodes(tile);
            sum_nodes(&mut means, nodes, &shared.mean_stress);
            load_nodes(&mut moved, nodes, &shared.moved);
            for l in (0..LANES).filter(|&l| active.is_cell[tile * LANES + l]) {
                let own = tensor::trace(&get(&force.stress, l)) / 3.0;
                let added = means[l] * weights[tile][1][l] - own;
                force.smoothed[l] = added;
                (0..3).for_each(|k| force.stress[k][l] += added);
                if before > 0.0 {
                    let gradients = shapes[tile].gradients(l);
                    let gradient = strain::gradient(&gradients, all_corners(&moved, l));
                    work += 0.5 * added * tensor::trace(&tensor::strain(&gradient));
                }
                let pushed = to_nodes::nodal(l, &shapes[tile], force);
                (0..4).for_each(|i| set_corner(corners, l, i, pushed[i]));
            }
        }
        work
    });
    ledger.stress_smoothing_work(work);
}
