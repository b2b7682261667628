//! Whether a model has come to rest.
//!
//! Two ratios are looked at in every step:
//!
//! - out of balance: Σ_i |F_i| / Σ_i (|m_i g| + |loads| + |reactions|), F_i being what is left at node
//!   i of internal forces, gravity, loads and reactions, without damping;
//! - the grid's kinetic energy ½ Σ m_i v_i² over a reference, the larger of its peak in the stage and
//!   ½ M v², v = 1e-3 √(g H), with the mass M and the height H of the model. Particles keep kinetic
//!   energy that no node knows of, and do not count.
//!
//! The model is at rest when both have been small enough for the time that a wave takes through it.

use crate::Vec3;
use crate::parallel::Sum;
use crate::plan::Equilibrium;
use crate::simulation::Simulation;
use crate::step::Node;

/// Out-of-balance and applied forces, N.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Forces {
    pub unbalanced: f64,
    pub applied: f64,
}

impl Sum for Forces {
    fn plus(self, other: Forces) -> Forces {
        Forces {
            unbalanced: self.unbalanced + other.unbalanced,
            applied: self.applied + other.applied,
        }
    }
}

impl Forces {
    /// Adds a node after stage 2.
    pub fn add(&mut self, node: &Node, gravity: Vec3) {
        let left = node.mass * node.acceleration - node.damping;
        self.unbalanced += left.length();
        let (reaction, load) = (node.reaction + node.absorbing, node.load);
        self.applied += (gravity * node.weighed).length() + load.length() + reaction.length();
    }

    fn ratio(&self) -> f64 {
        if self.applied > 0.0 {
            self.unbalanced / self.applied
        } else {
            0.0
        }
    }
}

/// What has been seen since a stage began.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Watch {
    /// Of the last step.
    pub forces: Forces,
    peak: f64,
    /// Stage time since when both ratios have been small enough.
    calm_since: Option<f64>,
}

crate::saved!(Watch {
    forces,
    peak,
    calm_since
});

impl Watch {
    /// Looks at the step just made. Says whether the model is at rest.
    pub fn look(
        &mut self,
        scale: &Scale,
        kinetic: f64,
        stage_time: f64,
        judged: &Equilibrium,
    ) -> bool {
        self.peak = self.peak.max(kinetic);
        let calm = self.forces.ratio() <= judged.unbalanced
            && kinetic <= judged.kinetic * self.peak.max(scale.kinetic);
        if !calm {
            self.calm_since = None;
            return false;
        }
        let since = *self.calm_since.get_or_insert(stage_time);
        stage_time - since >= judged.hold.unwrap_or(scale.travel_time)
    }

    /// [out-of-balance ratio, grid's kinetic energy over its reference].
    pub fn ratios(&self, scale: &Scale, kinetic: f64) -> [f64; 2] {
        let reference = self.peak.max(scale.kinetic);
        let share = if reference > 0.0 {
            kinetic / reference
        } else {
            0.0
        };
        [self.forces.ratio(), share]
    }
}

/// What the model's motion is compared with.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Scale {
    /// ½ M g H 1e-6, J.
    pub kinetic: f64,
    /// The time that the slowest P-wave takes along the longest side of the mesh, s.
    pub travel_time: f64,
}

impl Scale {
    pub fn new(sim: &Simulation) -> Scale {
        let plan = sim.plan();
        let [low, high] = plan.mesh.bounds();
        let (size, g) = (high - low, plan.gravity.length());
        let height = size.dot(plan.gravity.abs()) / g.max(f64::MIN_POSITIVE);
        let slowest = plan.bodies.iter().map(|b| {
            let material = &plan.materials[b.material];
            (material.model.elasticity().constrained_modulus() / material.density).sqrt()
        });
        Scale {
            kinetic: 0.5e-6 * sim.particles().total_mass() * g * height,
            travel_time: size.max_element()
                / slowest.filter(|c| *c > 0.0).fold(f64::INFINITY, f64::min),
        }
    }
}
