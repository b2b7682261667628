//! Stage 2, continued: the acceleration that particles receive, corrected for the lumped mass.
//!
//! Particles take on Σ N_i a_i, and the velocity that comes back to a node from them changes by
//! the average (M a)_i / m_i of its neighbourhood, with M_ij = Σ m_p N_i N_j. With a = F/m that
//! average slows short waves: along a column with nodes h apart
//!
//!   ω / (c k) = 1 − (k h)²/24 [1 − (c Δt/h)² + s + 2 (1 − θ)],
//!
//! the 1 from the stiffness, s from the smoothing of strains (0 for shear, 1 for compression at
//! ν = 0) and 2 (1 − θ) from the average, θ = 0 being plain lumping. Giving the particles
//! instead
//!
//!   a'_i = a_i + θ/m_i Σ_j M_ij (a_i − a_j)
//!
//! takes the average back and leaves momentum as it is, since the sum is over pairs. At the
//! default Courant number on cubes of Kuhn tetrahedra no error is left for shear at θ = 1.44 and
//! for compression at θ = 1.94; we take 1.7. (Averaging lumped and consistent mass for phase
//! accuracy: Goudreau and Taylor 1973.) Only filled cells take part: at a free surface the plain
//! lumped mass is more robust.

use super::{BLOCK, CellForce, CellSums, Node};
use crate::Vec3;
use crate::parallel::fold;
use crate::plan::MassMatrix;
use crate::simulation::Simulation;
use std::ops::Range;

/// θ.
const CORRECTION: f64 = 1.7;

pub(super) fn run(sim: &mut Simulation, h: f64) {
    let theta = match sim.plan.numerics.mass {
        MassMatrix::Corrected => CORRECTION,
        MassMatrix::Lumped => 0.0,
    };
    if theta > 0.0 {
        exchange(sim);
    }
    let Simulation {
        active,
        nodes,
        cells,
        constraints,
        ledger,
        ..
    } = sim;
    let (active, sums, constraints) = (&*active, &cells.sums[..], &*constraints);
    let items = (0..nodes.len(), &mut nodes[..]);
    let power = fold(items, BLOCK, &|(slots, nodes): (
        Range<usize>,
        &mut [Node],
    )| {
        let mut power = 0.0;
        for (slot, node) in slots.zip(nodes) {
            node.received = node.acceleration;
            if theta > 0.0 && node.mass > 0.0 {
                let sum: Vec3 = active
                    .attached(slot)
                    .iter()
                    .map(|&(c, local)| sums[c as usize].exchange[local as usize])
                    .sum();
                let change = sum * (theta / node.mass);
                node.received += match constraints.of(active.nodes[slot]) {
                    Some(constraint) => constraint.free * change,
                    None => change,
                };
            }
            power += h * node.mass * node.velocity.dot(node.received);
        }
        power
    });
    ledger.received(power);
}

/// Σ_j M_ij (a_i − a_j) of each filled cell.
fn exchange(sim: &mut Simulation) {
    let Simulation {
        active,
        nodes,
        cells,
        ..
    } = sim;
    let (active, nodes) = (&*active, &nodes[..]);
    let items = (
        0..active.elements.len(),
        &mut cells.sums[..],
        &cells.forces[..],
    );
    fold(items, BLOCK, &|(range, sums, forces): (
        Range<usize>,
        &mut [CellSums],
        &[CellForce],
    )| {
        for ((c, sum), force) in range.zip(sums).zip(forces) {
            sum.exchange = [Vec3::ZERO; 4];
            if !force.filled {
                continue;
            }
            let a = active.cell_nodes[c].map(|n| nodes[n as usize].acceleration);
            for (pair, &(i, j)) in PAIRS.iter().enumerate() {
                let flux = (a[i] - a[j]) * sum.pairs[pair];
                sum.exchange[i] += flux;
                sum.exchange[j] -= flux;
            }
        }
    });
}

/// The pairs of a cell's nodes, in the order of [`CellSums::pairs`].
pub(super) const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
