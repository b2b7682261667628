//! What averaging takes from short waves, given back.
//!
//! Velocities go from particles to nodes as averages v̄_i = Σ m_p v_p N_i / m_i. With M_ij =
//! Σ m_p N_i N_j, what comes back to the nodes of an acceleration that was handed to the particles
//! is (M a)_i / m_i, smoother than a. A wave along a column with nodes h apart then runs at
//!
//!   ω / (c k) = 1 − (k h)²/24 [1 − (c Δt/h)² + s + 2 (1 − 2θ)],
//!
//! with 1 from the stiffness, s from the smoothing of strains (0 for shear, 1 for compression at
//! ν = 0) and 2 from the average (θ = 0). So nodes and particles exchange
//!
//!   B w = w_i + θ/m_i Σ_j M_ij (w_i − w_j)
//!
//! in place of w, both where accelerations go to particles and where averages move the nodes. The
//! sum is over pairs of nodes, so that momentum stays as it is. B is self-adjoint in the lumped
//! mass and stands on both sides: the power of a force on the nodes' velocities, F · B v̄, is what
//! the particles gain, m B (F/m) · v̄. Standing on one side alone, or in filled cells only, it lets
//! energy grow as particles cross elements. No error is left for shear at 2θ = 1.47 and for
//! compression at 2θ = 1.94 (Kuhn tetrahedra of cubes, ν = 0, Courant number 0.5); we take 1.6.
//! (Averaging lumped and consistent mass for phase accuracy: Goudreau and Taylor 1973.)

use super::shapes::{Corners, NO_CORNERS, all_corners, load_nodes, set_corner};
use super::{Active, BLOCK, Node};
use crate::Vec3;
use crate::lanes::{LANES, Lane, for_each_simd, set, side_by_side, whole};
use crate::parallel::fold;
use crate::plan::MassMatrix;
use crate::simulation::Simulation;
use std::ops::Range;

/// θ.
const CORRECTION: f64 = 0.8;

/// How much stiffer for its mass a partly filled cell can be than a full one, as a factor on ω².
/// Motions that a few particles hardly resolve have M small against the lumped mass; there B is
/// 1 + θ, and it acts twice. In full cells M B² is at most 1.08 of the lumped mass.
pub(super) fn stiffening(mass: MassMatrix) -> f64 {
    match mass {
        MassMatrix::Lumped => 1.0,
        MassMatrix::Corrected => (1.0 + CORRECTION) * (1.0 + CORRECTION),
    }
}

/// The pairs of a cell's nodes, in the order of [`CellPairs`](super::CellPairs).
pub(super) const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// Cells side by side.
struct Side {
    w: Corners,
    pairs: [Lane; 6],
    sum: Corners,
}

for_each_simd! {
    fn flow(side: &mut Side, lanes: usize) {
        for l in 0..whole(lanes) {
            let w = all_corners(&side.w, l);
            let mut sum = [Vec3::ZERO; 4];
            for k in 0..6 {
                let (i, j) = PAIRS[k];
                let flux = (w[i] - w[j]) * side.pairs[k][l];
                sum[i] += flux;
                sum[j] -= flux;
            }
            for i in 0..4 {
                set_corner(&mut side.sum, l, i, sum[i]);
            }
        }
    }
}

/// Σ_j M_ij (w_i − w_j) of each cell, for [`change`]. Returns θ.
pub(super) fn exchange(sim: &mut Simulation, w: impl Fn(&Node) -> Vec3 + Sync) -> f64 {
    if sim.plan.numerics.mass == MassMatrix::Lumped {
        return 0.0;
    }
    let Simulation {
        active,
        nodes,
        cells,
        simd,
        ..
    } = sim;
    let (active, nodes, pairs, simd) = (&*active, &nodes[..], &cells.pairs[..], *simd);
    let items = (0..active.elements.len(), &mut cells.exchange[..]);
    fold(items, BLOCK, &|(range, sums): (
        Range<usize>,
        &mut [[Vec3; 4]],
    )| {
        let first = range.start;
        let mut side = Side {
            w: NO_CORNERS,
            pairs: [[0.0; LANES]; 6],
            sum: NO_CORNERS,
        };
        for window in side_by_side(range) {
            for (l, c) in window.clone().enumerate() {
                load_nodes(&mut side.w, l, active, c, nodes, &w);
                set(&mut side.pairs, l, pairs[c]);
            }
            flow(simd, &mut side, window.len());
            for (l, c) in window.enumerate() {
                sums[c - first] = all_corners(&side.sum, l);
            }
        }
    });
    CORRECTION
}

/// B w − w at node `slot`, after [`exchange`].
#[inline]
pub(super) fn change(
    theta: f64,
    slot: usize,
    mass: f64,
    active: &Active,
    exchange: &[[Vec3; 4]],
) -> Vec3 {
    if theta == 0.0 || mass == 0.0 {
        return Vec3::ZERO;
    }
    let attached = active.attached(slot).iter();
    let sum: Vec3 = attached
        .map(|&(c, i)| exchange[c as usize][i as usize])
        .sum();
    sum * (theta / mass)
}

/// What particles receive of the nodes' accelerations in a kick of length `h`.
pub(super) fn receive(sim: &mut Simulation, h: f64) {
    let theta = exchange(sim, |node| node.acceleration);
    let Simulation {
        active,
        nodes,
        cells,
        constraints,
        ledger,
        ..
    } = sim;
    let (active, exchange, constraints) = (&*active, &cells.exchange[..], &*constraints);
    let items = (0..nodes.len(), &mut nodes[..]);
    let gain = fold(items, BLOCK, &|(slots, nodes): (
        Range<usize>,
        &mut [Node],
    )| {
        let mut gain = 0.0;
        for (slot, node) in slots.zip(nodes) {
            let change = change(theta, slot, node.mass, active, exchange);
            node.received = node.acceleration
                + match constraints.of(active.nodes[slot]) {
                    Some(constraint) => constraint.free * change,
                    None => change,
                };
            gain += h * node.mass * node.velocity.dot(node.received);
        }
        gain
    });
    ledger.receive(gain);
}
