//! The balance of energy: every term from its own formula, only `residual` a difference.
//!
//! Works of forces are trapezoids: over a drift from t_n to t_{n+1} a force's work on the mesh is
//! ½ (F_n + F_{n+1}) · Δu. One half is booked when the drift is known (after the remap), the other
//! when the new force is (in the kick). What a kick gives the particles follows from the nodal
//! equation of motion,
//!
//!   ΔK = h Σ m_i v_i · a'_i + ½ h² Σ m_p |Σ N_i a'_i|²
//!
//! with a' the accelerations that particles receive. `transfer` is the difference between the
//! trapezoidal work of all forces and this: what the lumped mass matrix and the average of the
//! remap take (or give back). The work of stresses on the mesh differs from that in the
//! particles by `integration` (σ̄ V_e against Σ σ_p V_p, and evened weights against those of
//! particles), `smoothing` (σ_m (Δε_v − Δε̄_v) V) and
//! `advection` (particles have moved through the mesh by the time the second half is booked, and
//! its gradients are those of the step's start). All are positive where energy is lost.

use crate::Vec3;
use crate::parallel::Sum;
use crate::step::Node;

/// Works of nodal forces in half a drift, J.
#[derive(Clone, Copy, Debug, Default)]
pub struct DriftWork {
    total: f64,
    /// Of the forces that stresses make.
    internal: f64,
    gravity: f64,
    /// Of the difference between the weights of nodes and those of particles.
    evened: f64,
    load: f64,
    damping: f64,
    absorbing: f64,
    reaction: f64,
    /// ½ Σ m v².
    kinetic: f64,
}

impl DriftWork {
    /// Half the work of a node's forces on its displacement.
    #[inline(always)]
    pub fn add(&mut self, node: &Node, gravity: Vec3) {
        let moved = 0.5 * node.moved;
        let fall = gravity.dot(moved);
        self.total += node.mass * node.acceleration.dot(moved);
        self.internal += node.internal.dot(moved);
        self.gravity += node.mass * fall;
        self.kinetic += 0.5 * node.mass * node.grid_velocity.length_squared();
        if node.weighed != node.mass {
            self.evened += (node.weighed - node.mass) * fall;
        }
        if node.is_acted_on {
            self.load += node.load.dot(moved);
            self.damping += node.damping.dot(moved);
            self.absorbing += node.absorbing.dot(moved);
            self.reaction += node.reaction.dot(moved);
        }
    }
}

impl Sum for DriftWork {
    fn plus(self, other: DriftWork) -> DriftWork {
        DriftWork {
            total: self.total + other.total,
            internal: self.internal + other.internal,
            gravity: self.gravity + other.gravity,
            evened: self.evened + other.evened,
            load: self.load + other.load,
            damping: self.damping + other.damping,
            absorbing: self.absorbing + other.absorbing,
            reaction: self.reaction + other.reaction,
            kinetic: self.kinetic + other.kinetic,
        }
    }
}

/// Energies of the whole model since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// ½ Σ m_p v_p² of particles, at the same instant as their positions.
    pub kinetic: f64,
    /// ½ Σ m_i v_i² of nodes after the last remap, half a step earlier; no part of the balance.
    pub kinetic_grid: f64,
    /// Σ σ : (Δε − Δε^p) V, stored in the material.
    pub elastic: f64,
    /// −Σ m_p g · Δx_p, stored in the gravity field.
    pub gravity: f64,
    /// Work of loads.
    pub load: f64,
    /// Work of prescribed velocities.
    pub prescribed: f64,
    /// Σ σ : Δε^p V, dissipated by plastic flow.
    pub plastic: f64,
    /// Dissipated by friction between bodies.
    pub friction: f64,
    /// Taken by impulses along the normals of contacts.
    pub contact: f64,
    /// Dissipated by local damping, viscosity and the relaxation to the mesh's velocities.
    pub damping: f64,
    /// Taken by absorbing boundaries: dissipated in dashpots, stored in springs.
    pub absorbed: f64,
    /// Σ ½ m_p v_p² of particles that stages have taken away; those added come at rest. All other kinds
    /// are works, so what a removed body has stored stays in `elastic` and `gravity`.
    pub removed: f64,
    /// Lost between nodes and particles by the lumped mass matrix and the remap.
    pub transfer: f64,
    /// Lost because forces do not know of the smoothing of strains.
    pub smoothing: f64,
    /// Lost between mean stresses of elements and those of particles.
    pub integration: f64,
    /// Lost as particles move through the mesh.
    pub advection: f64,
    /// What is left over: given less stored, dissipated and lost; round-off.
    pub residual: f64,
}

impl Energies {
    /// Names in the order of [`Energies::values`].
    pub const NAMES: [&'static str; 17] = [
        "kinetic",
        "kinetic_grid",
        "elastic",
        "gravity",
        "load",
        "prescribed",
        "plastic",
        "friction",
        "contact",
        "damping",
        "absorbed",
        "removed",
        "transfer",
        "smoothing",
        "integration",
        "advection",
        "residual",
    ];

    pub fn values(&self) -> [f64; 17] {
        [
            self.kinetic,
            self.kinetic_grid,
            self.elastic,
            self.gravity,
            self.load,
            self.prescribed,
            self.plastic,
            self.friction,
            self.contact,
            self.damping,
            self.absorbed,
            self.removed,
            self.transfer,
            self.smoothing,
            self.integration,
            self.advection,
            self.residual,
        ]
    }

    /// All energies times a factor.
    pub fn times(self, factor: f64) -> Energies {
        Energies {
            kinetic: self.kinetic * factor,
            kinetic_grid: self.kinetic_grid * factor,
            elastic: self.elastic * factor,
            gravity: self.gravity * factor,
            load: self.load * factor,
            prescribed: self.prescribed * factor,
            plastic: self.plastic * factor,
            friction: self.friction * factor,
            contact: self.contact * factor,
            damping: self.damping * factor,
            absorbed: self.absorbed * factor,
            removed: self.removed * factor,
            transfer: self.transfer * factor,
            smoothing: self.smoothing * factor,
            integration: self.integration * factor,
            advection: self.advection * factor,
            residual: self.residual * factor,
        }
    }

    /// Sum of the absolute numerical terms, J: how good the run is.
    pub fn numerical(&self) -> f64 {
        self.transfer.abs() + self.smoothing.abs() + self.integration.abs() + self.advection.abs()
    }
}

/// Keeps the books.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    now: Energies,
    /// Kinetic energy given to bodies, J.
    given: f64,
    /// Kinetic energy of the particles with their mid-step velocities, J.
    particles: f64,
    /// h Σ m_i v_i · a'_i of the last kick, J.
    gain: f64,
    /// What the second part of the last kick will be booked with in the coming drift.
    pending_gain: f64,
    pending_damping: f64,
    turned_over: f64,
}

crate::saved!(Ledger {
    now,
    given,
    particles,
    gain,
    pending_gain,
    pending_damping,
    turned_over,
});

impl Ledger {
    /// The energies now.
    pub fn energies(&self) -> Energies {
        let mut now = self.now;
        now.kinetic = self.particles - self.pending_gain + self.pending_damping;
        let taken = now.kinetic
            + now.elastic
            + now.gravity
            + now.plastic
            + now.damping
            + now.absorbed
            + now.removed
            + now.friction
            + now.contact
            + now.transfer
            + now.smoothing
            + now.integration
            + now.advection;
        now.residual = self.given + now.load + now.prescribed - taken;
        now
    }

    /// The energy turned over, J: the greatest value so far of half the sum of the absolute
    /// values of all physical terms, counted from the start.
    pub fn turned_over(&self) -> f64 {
        self.turned_over
    }

    /// Particles have been given velocities: their kinetic energy changes to `kinetic`.
    pub(crate) fn give(&mut self, kinetic: f64) {
        self.given += kinetic - self.particles;
        self.particles = kinetic;
    }

    /// Particles with this kinetic energy are taken away.
    pub(crate) fn remove(&mut self, kinetic: f64) {
        self.now.removed += kinetic;
        self.particles -= kinetic;
    }

    /// Kinetic energy of the particles with their mid-step velocities, J.
    #[cfg(test)]
    pub(crate) fn particles(&self) -> f64 {
        self.particles
    }

    /// Half a drift's work of the particles' stresses in cells: a part of the forces' work.
    pub(crate) fn grid_stress_work(&mut self, work: f64) {
        self.now.advection += work;
        self.now.integration -= work;
    }

    /// The same of viscous stresses.
    pub(crate) fn viscous_work(&mut self, work: f64) {
        self.now.damping += work;
        self.now.integration -= work;
    }

    /// The same of what smoothing adds to the cells' mean stresses.
    pub(crate) fn stress_smoothing_work(&mut self, work: f64) {
        self.now.smoothing += work;
        self.now.integration -= work;
    }

    /// A drift's work in particles: [σ : (Δε̄ − Δε^p) V, what smoothing left out, σ : Δε^p V].
    pub(crate) fn particle_stress_work(&mut self, [elastic, smoothed_out, plastic]: [f64; 3]) {
        self.now.elastic += elastic;
        self.now.plastic += plastic;
        self.now.smoothing += smoothed_out;
        self.now.advection -= elastic + smoothed_out + plastic;
    }

    /// Half a drift's work of contact forces: [along normals, along surfaces].
    pub(crate) fn contact_work(&mut self, [normal, tangential]: [f64; 2]) {
        self.now.contact -= normal;
        self.now.friction -= tangential;
    }

    /// Σ m_p g · Δx_p of a drift.
    pub(crate) fn gravity_work(&mut self, work: f64) {
        self.now.gravity -= work;
        self.now.advection += work;
    }

    /// First half of a drift's work of nodal forces.
    pub(crate) fn drift(&mut self, work: DriftWork) {
        self.half(work);
        self.now.transfer -= self.pending_gain;
        self.now.damping += self.pending_damping;
        (self.pending_gain, self.pending_damping) = (0.0, 0.0);
        self.now.kinetic_grid = work.kinetic;
    }

    /// h Σ m_i v_i · a'_i of a kick.
    pub(crate) fn receive(&mut self, gain: f64) {
        self.gain = gain;
    }

    /// Second half of the last drift's work of nodal forces.
    pub(crate) fn kick(&mut self, work: DriftWork) {
        self.half(work);
    }

    fn half(&mut self, work: DriftWork) {
        self.now.transfer += work.total;
        self.now.advection -= work.gravity;
        // Forces do what stresses of cells take up.
        self.now.integration -= work.internal + work.evened;
        self.now.load += work.load;
        self.now.damping -= work.damping;
        self.now.absorbed -= work.absorbing;
        self.now.prescribed += work.reaction;
    }

    /// Ends a kick: `sums` are Σ m_p |Σ N_i a_i|², what relaxation took, and the kinetic energy.
    pub(crate) fn end_kick(&mut self, sums: [f64; 3], before: f64, after: f64) {
        let h = before + after;
        let gain = self.gain + 0.5 * h * h * sums[0];
        let now = if h > 0.0 { before / h } else { 1.0 };
        self.now.transfer -= gain * now;
        self.now.damping += sums[1] * now;
        self.pending_gain += gain * (1.0 - now);
        self.pending_damping += sums[1] * (1.0 - now);
        self.particles = sums[2];
        let e = self.energies();
        let physical = [
            self.given,
            e.kinetic,
            e.elastic,
            e.gravity,
            e.load,
            e.prescribed,
            e.plastic,
            e.damping,
            e.absorbed,
            e.removed,
            e.friction,
            e.contact,
        ];
        let turned = 0.5 * physical.iter().map(|e| e.abs()).sum::<f64>();
        self.turned_over = self.turned_over.max(turned);
    }
}
