//! One time step: the eight stages of the method, one file each.
//!
//! Velocities live at mid-steps and positions and stresses at full steps (leapfrog). A step is a
//! *drift*, which carries positions and stresses over Δt with the velocities of the mid-step, and
//! a *kick*, which carries velocities from the middle of this step to the middle of the next with
//! the forces in between, over h = (Δt + Δt_next)/2:
//!
//! | | stage | file |
//! |---|---|---|
//! | drift | 4 remap: v_i = Σ m_p v_p N_i / m_i, Δu_i = Δt v_i | `remap` |
//! | | 5 strain: ∇Δu per element, volumetric part smoothed | `strain` |
//! | | 6 stress: rotation and material model | `stress` |
//! | | 7 move: x_p += Σ N_i Δu_i; 8 mesh: follows, particles located | `advance` |
//! | kick | 1 particles to nodes: masses, momenta, forces | `to_nodes` |
//! | | 2 nodes: a_i = F_i / m_i, damping, boundaries, lumping | `nodes`, `mass` |
//! | | 3 nodes to particles: v_p += h Σ N_i a_i | `to_particles` |
//!
//! Jassim et al. Eq. 5–9 are the same cycle cut before stage 1; with equal steps the numbers are
//! theirs but for the first kick, which is half as long: a load that acts from t = 0 then acts
//! neither half a step too long nor too short. A stage of the run begins and ends with a half
//! kick, so that at its ends positions and velocities belong to the same instant.

mod active;
mod advance;
mod mass;
mod nodes;
mod remap;
mod state;
mod strain;
mod stress;
mod time_step;
mod to_nodes;
mod to_particles;

pub use active::Active;
pub use state::{CellForce, CellStrain, CellSums, Node};
pub use time_step::TimeStepError;
pub(crate) use time_step::critical;

use crate::simulation::{Simulation, Stop};

/// Cells or nodes that one thread works on at a time.
const BLOCK: usize = 256;

impl Simulation {
    /// Advances positions, stresses and the mesh by `dt` seconds.
    pub(crate) fn drift(&mut self, dt: f64) -> Result<(), Stop> {
        remap::run(self, dt);
        strain::run(self);
        stress::run(self);
        advance::run(self)
    }

    /// Advances velocities from `before` seconds before now to half the coming step after now.
    /// Returns that coming step: the stable one, at most `limit` (0 at the end of a stage).
    pub(crate) fn kick(&mut self, before: f64, limit: f64) -> Result<f64, Stop> {
        to_nodes::run(self, before);
        let stable = time_step::choose(self).map_err(|error| self.no_time_step(error))?;
        // A step that would leave a sliver of the stage is stretched to its end.
        let dt = if limit <= stable * (1.0 + 1e-6) {
            limit
        } else {
            stable
        };
        let after = 0.5 * dt;
        self.constraints.set_time(
            self.clock.time + after,
            before == 0.0 && self.clock.given_velocities,
        );
        nodes::run(self, before, after);
        mass::run(self, before + after);
        to_particles::run(self, before, after);
        Ok(dt)
    }
}
