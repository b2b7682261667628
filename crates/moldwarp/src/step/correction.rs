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

use super::collect::{Portions, Shares};
use super::corners::{Corners, NO_CORNERS, Quad, all_corners, load_nodes, set_corner};
use super::{BLOCK, CellPairs, Node};
use crate::Vec3;
use crate::lanes::{LANES, Lane, for_each_simd, prefetch_record};
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
pub(super) const PAIRS: [(usize, usize); 10] = [
    (0, 1),
    (0, 2),
    (0, 3),
    (1, 2),
    (1, 3),
    (2, 3),
    (0, 0),
    (1, 1),
    (2, 2),
    (3, 3),
];

for_each_simd! {
    /// Σ_j M_ij (w_i − w_j) of each node.
    fn flow(w: &Corners, pairs: &CellPairs, sums: &mut Corners) {
        for l in 0..LANES {
            let w = all_corners(w, l);
            let mut sum = [Vec3::ZERO; 4];
            for k in 0..6 {
                let (i, j) = PAIRS[k];
                let flux = (w[i] - w[j]) * pairs[k][l];
                sum[i] += flux;
                sum[j] -= flux;
            }
            for i in 0..4 {
                set_corner(sums, l, i, sum[i]);
            }
        }
    }
}

for_each_simd! {
    /// Σ_j M_ij w_j of each node.
    fn product(w: &Corners, pairs: &CellPairs, sums: &mut Corners) {
        for l in 0..LANES {
            let w = all_corners(w, l);
            let mut sum = [Vec3::ZERO; 4];
            for i in 0..4 {
                sum[i] = w[i] * pairs[6 + i][l];
            }
            for k in 0..6 {
                let (i, j) = PAIRS[k];
                sum[i] += w[j] * pairs[k][l];
                sum[j] += w[i] * pairs[k][l];
            }
            for i in 0..4 {
                set_corner(sums, l, i, sum[i]);
            }
        }
    }
}

/// What nodes exchange through the matrix M of their cells.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Through {
    /// Σ_j M_ij (w_i − w_j).
    Differences,
    /// Σ_j M_ij w_j.
    All,
}

/// Collects Σ_j M_ij w_j, w being accelerations (N) or velocities (kg m/s).
pub(super) fn multiply(sim: &mut Simulation, w: impl Fn(&Node) -> Vec3 + Sync) {
    exchange(sim, w, Through::All);
}

fn exchange(sim: &mut Simulation, w: impl Fn(&Node) -> Vec3 + Sync, through: Through) {
    let Simulation {
        active,
        nodes,
        shared,
        cells,
        simd,
        ..
    } = sim;
    let items = (&nodes[..], &mut shared.given[..]);
    fold(items, BLOCK, &|(nodes, given): (&[Node], &mut [Quad])| {
        for (given, node) in given.iter_mut().zip(nodes) {
            *given = w(node).into();
        }
    });
    let (active, given, pairs, simd) = (&*active, &shared.given[..], &cells.pairs[..], *simd);
    let cut = cells.portions.cut();
    let items = (0..pairs.len(), cells.portions.shares());
    cut.fold(items, &|(tiles, shares): (Range<usize>, Shares<1>)| {
        let (mut w, mut sums, mut share) = (NO_CORNERS, NO_CORNERS, shares.begin());
        let nothing = [Lane::of(0.0); 4];
        for tile in tiles {
            let nodes = active.tile_nodes(tile);
            prefetch_record(pairs, tile + 1);
            load_nodes(simd, &mut w, nodes, given);
            match through {
                Through::Differences => flow(simd, &w, &pairs[tile], &mut sums),
                Through::All => product(simd, &w, &pairs[tile], &mut sums),
            }
            share.give(simd, nodes, &sums, &nothing);
        }
    });
}

/// Collects Σ_j M_ij (w_i − w_j) for [`changes`], w being accelerations (N) or averages (kg m/s), if masses are corrected.
/// Returns θ.
pub(super) fn correct(sim: &mut Simulation, w: impl Fn(&Node) -> Vec3 + Sync) -> f64 {
    match sim.plan.numerics.mass {
        MassMatrix::Lumped => 0.0,
        MassMatrix::Corrected => {
            exchange(sim, w, Through::Differences);
            CORRECTION
        }
    }
}

/// Σ_j M_ij (w_i − w_j) at these nodes, after [`correct`].
pub(super) fn changes(
    theta: f64,
    nodes: Range<usize>,
    portions: &Portions,
    changes: &mut [[Quad; BLOCK]; 1],
) {
    if theta != 0.0 {
        portions.sums(nodes, changes);
    }
}

/// B w − w at a node, from its sum.
#[inline]
pub(super) fn change(theta: f64, mass: f64, sum: Quad) -> Vec3 {
    match mass {
        0.0 => Vec3::ZERO,
        _ => sum.vector() * (theta / mass),
    }
}

/// What particles receive of the nodes' accelerations in a kick of length `h`.
pub(super) fn receive(sim: &mut Simulation, h: f64) {
    let theta = correct(sim, |node| node.acceleration);
    let Simulation {
        active,
        nodes,
        shared,
        cells,
        constraints,
        ledger,
        ..
    } = sim;
    let (active, portions, constraints) = (&*active, &cells.portions, &*constraints);
    let items = (0..nodes.len(), &mut nodes[..], &mut shared.received[..]);
    let gain = fold(items, BLOCK, &|(slots, nodes, received): (
        Range<usize>,
        &mut [Node],
        &mut [Quad],
    )| {
        let mut gain = 0.0;
        let mut sums = [[Quad::default(); BLOCK]];
        changes(theta, slots.clone(), portions, &mut sums);
        for (((slot, node), received), &sum) in slots.zip(nodes).zip(received).zip(&sums[0]) {
            let change = change(theta, node.mass, sum);
            node.received = node.acceleration
                + match constraints.of(active.nodes[slot]) {
                    Some(constraint) => constraint.free * change,
                    None => change,
                };
            *received = node.received.into();
            gain += h * node.mass * node.velocity.dot(node.received);
        }
        gain
    });
    ledger.receive(gain);
}
