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

use super::collect::{Portions, Shares};
use super::corners::{NO_CORNERS, Quad, all_corners, load_nodes, sum_nodes};
use super::shapes::Shapes;
use super::{BLOCK, CellForce, Cells, Shared, strain, to_nodes};
use crate::lanes::{LANES, Lane, either, get, smaller};
use crate::parallel::fold;
use crate::plan::Smoothing;
use crate::simulation::Simulation;
use crate::tensor;
use std::ops::Range;

/// w_e, m³, of a cell of this `whole` volume of which particles have `volume`, `closed` of it not separated.
#[inline(always)]
fn weight(filled: f64, volume: f64, closed: f64, whole: f64) -> f64 {
    let weight = whole_weight(filled, volume, whole);
    either(closed < volume, weight * closed / volume, weight)
}

/// The same as if none of it were separated.
#[inline(always)]
pub(super) fn whole_weight(filled: f64, volume: f64, whole: f64) -> f64 {
    either(filled > 0.0, whole, smaller(volume, whole))
}

/// θ_n of each node.
pub(super) fn strains(sim: &mut Simulation) {
    if sim.plan.numerics.smoothing == Smoothing::Off {
        return;
    }
    let means = &mut sim.shared.moved[..];
    means_at_nodes(&sim.cells.portions, means, 1.0, |quad| &mut quad.0[3]);
}

/// At each node the sum of what is smoothed times w_e over that of w_e, both collected, and over `factor`.
fn means_at_nodes<T: Send>(
    portions: &Portions,
    means: &mut [T],
    factor: f64,
    of: impl Fn(&mut T) -> &mut f64 + Sync,
) {
    let items = (0..means.len(), means);
    fold(items, BLOCK, &|(slots, means): (Range<usize>, &mut [T])| {
        let mut sums = [Quad::default(); BLOCK];
        portions.nodes.own_sums(slots, &mut [&mut sums]);
        for (mean, &Quad([sum, all, ..])) in means.iter_mut().zip(&sums) {
            let whole = factor * all;
            *of(mean) = if all > 0.0 { sum / whole } else { 0.0 };
        }
    });
}

/// Puts P̂_e in the place of P_e in the cells' forces, and books the work of the difference in
/// the last drift (`before` > 0).
pub(super) fn stresses(sim: &mut Simulation, before: f64) {
    if sim.plan.numerics.smoothing != Smoothing::Conjugate {
        return;
    }
    let Simulation {
        active,
        shared,
        cells,
        ledger,
        simd,
        ..
    } = sim;
    let (active, simd) = (&*active, *simd);
    let Shared {
        places,
        mean_stress,
        moved: drift,
        ..
    } = shared;
    let places = &places[..];
    let Cells {
        sums,
        fills,
        forces,
        portions,
        ..
    } = cells;
    let (sums, fills) = (&sums[..], &fills[..]);
    let weight = |tile: usize, l: usize, shapes: &Shapes| {
        let (volume, closed) = (sums[tile].volume[l], sums[tile].closed[l]);
        weight(fills[tile].filled[l], volume, closed, shapes.volume[l])
    };
    let (cut, known) = (portions.cut(), &forces[..]);
    let items = (0..known.len(), portions.shares());
    cut.fold_own(items, &|(tiles, shares): (
        Range<usize>,
        Shares<Quad, 1>,
    )| {
        let (mut traces, mut weights) = (Lane::of(0.0), Lane::of(0.0));
        let (mut shapes, mut share) = (Shapes::default(), shares.begin());
        for tile in tiles {
            let (force, nodes) = (&known[tile], active.tile_nodes(tile));
            shapes.enter(simd, nodes, places);
            for l in 0..LANES {
                traces[l] = tensor::trace(&get(&force.stress, l));
                weights[l] = weight(tile, l, &shapes);
            }
            share.give_alike(simd, nodes, [&traces, &weights]);
        }
    });
    // q_n: a trace is three times the mean, and a quarter goes to each node.
    mean_stress.resize(places.len(), 0.0);
    means_at_nodes(portions, mean_stress, 12.0, |mean| mean);
    let (mean_stress, drift) = (&mean_stress[..], &drift[..]);
    let items = (0..forces.len(), &mut forces[..], portions.shares());
    let work = cut.fold_own(items, &|(tiles, forces, shares): (
        Range<usize>,
        &mut [CellForce],
        Shares<Quad, 1>,
    )| {
        let (mut work, mut moved, mut pushed) = (0.0, NO_CORNERS, NO_CORNERS);
        let (mut means, mut shapes) = (Lane::of(0.0), Shapes::default());
        let mut share = shares.begin();
        for (tile, force) in tiles.zip(forces) {
            let nodes = active.tile_nodes(tile);
            shapes.enter(simd, nodes, places);
            sum_nodes(&mut means, nodes, mean_stress);
            load_nodes(simd, &mut moved, nodes, drift);
            for l in (0..LANES).filter(|&l| active.is_cell[tile * LANES + l]) {
                let own = tensor::trace(&get(&force.stress, l)) / 3.0;
                let added = means[l] * weight(tile, l, &shapes) - own;
                force.smoothed[l] = added;
                (0..3).for_each(|k| force.stress[k][l] += added);
                if before > 0.0 {
                    let gradients = shapes.gradients(l);
                    let gradient = strain::gradient(&gradients, all_corners(&moved, l));
                    work += 0.5 * added * tensor::trace(&tensor::strain(&gradient));
                }
            }
            to_nodes::push(simd, &shapes, force, nodes, &mut pushed, &mut share);
        }
        work
    });
    ledger.stress_smoothing_work(work);
}
