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

use super::corners::Quad;
use super::{BLOCK, ConsistentMass, Node, Shared};
use crate::Vec3;
use crate::lanes::Simd;
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

/// θ, if masses are corrected.
fn theta(mass: MassMatrix) -> f64 {
    match mass {
        MassMatrix::Lumped => 0.0,
        MassMatrix::Corrected => CORRECTION,
    }
}

/// Has nodes give something to those around them, which see it in an array of its own.
pub(super) fn give(nodes: &[Node], given: &mut [Quad], w: impl Fn(&Node) -> Vec3 + Sync) {
    fold((nodes, given), BLOCK, &|(nodes, given): (
        &[Node],
        &mut [Quad],
    )| {
        for (given, node) in given.iter_mut().zip(nodes) {
            *given = w(node).into();
        }
    });
}

/// What B w − w takes at nodes.
pub(super) struct Change<'a> {
    theta: f64,
    matrix: &'a ConsistentMass,
    simd: Simd,
    given: &'a [Quad],
}

impl<'a> Change<'a> {
    /// Of what nodes have given.
    pub fn new(
        mass: MassMatrix,
        matrix: &'a ConsistentMass,
        simd: Simd,
        given: &'a [Quad],
    ) -> Change<'a> {
        Change {
            theta: theta(mass),
            matrix,
            simd,
            given,
        }
    }

    /// Σ_j M_ij (w_i − w_j) of each of these nodes, if it counts.
    #[inline]
    pub fn flows(&self, nodes: Range<usize>, flows: &mut [Quad]) {
        if self.theta > 0.0 {
            self.matrix.flows(self.simd, nodes, self.given, flows);
        }
    }

    /// B w − w at a node of this lumped mass.
    #[inline]
    pub fn at(&self, mass: f64, flow: Quad) -> Vec3 {
        if self.theta == 0.0 || mass == 0.0 {
            return Vec3::ZERO;
        }
        flow.vector() * (self.theta / mass)
    }
}

/// What particles receive of the accelerations that nodes have given, in a kick of length `h`.
pub(super) fn receive(sim: &mut Simulation, h: f64) {
    let Simulation {
        plan,
        active,
        nodes,
        shared,
        cells,
        constraints,
        ledger,
        simd,
        ..
    } = sim;
    let (active, constraints) = (&*active, &*constraints);
    let Shared {
        given, received, ..
    } = shared;
    let change = Change::new(plan.numerics.mass, &cells.mass, *simd, given);
    let items = (0..nodes.len(), &nodes[..], &mut received[..]);
    let gain = fold(items, BLOCK, &|(slots, nodes, received): (
        Range<usize>,
        &[Node],
        &mut [Quad],
    )| {
        let (mut gain, mut flows) = (0.0, [Quad::default(); BLOCK]);
        change.flows(slots.clone(), &mut flows);
        for (((slot, node), received), &flow) in slots.zip(nodes).zip(received).zip(&flows) {
            node.prefetch(0..1);
            let change = change.at(node.mass, flow);
            let change = match constraints.of(active.nodes[slot]) {
                Some(constraint) => constraint.free * change,
                None => change,
            };
            let own = node.acceleration + change;
            *received = own.into();
            gain += h * node.mass * node.velocity.dot(own);
        }
        gain
    });
    ledger.receive(gain);
}
