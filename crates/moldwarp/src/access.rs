//! What can be changed in a simulation from outside, between its steps.

use crate::Vec3;
use crate::boundary::Absorbing;
use crate::measure::Ledger;
use crate::particles::{Particles, Tensors, Vectors};
use crate::simulation::Simulation;
use crate::stop::Stop;

impl Simulation {
    /// The velocities that the first stage gives its bodies, m/s, in the order of the arrays: those at
    /// t = 0. Before the first step the particles' own are already those of its middle.
    pub fn velocities_at_the_start(&self) -> Vectors {
        let given = &self.plan.stages[0].initial_velocities;
        let of = |body: u16| given.iter().rfind(|g| g.0 == usize::from(body));
        let bodies = self.particles.body.iter();
        bodies.map(|&b| of(b).map_or(Vec3::ZERO, |g| g.1)).collect()
    }

    /// Begins with these velocities (m/s, at t = 0) and stresses (Pa), in the order of the arrays; before
    /// the first step. If `stressed`, absorbing boundaries take it that they are in equilibrium with
    /// these, as they do with an initial stress of the plan.
    ///
    /// # Errors
    ///
    /// As the first step: there may be no stable one, or a number is not finite.
    pub fn begin_with(
        &mut self,
        velocity: &Vectors,
        stress: &Tensors,
        stressed: bool,
    ) -> Result<(), Stop> {
        assert_eq!(self.clock.steps, 0, "nothing has moved yet");
        self.particles.stress.clone_from(stress);
        self.particles.velocity.clone_from(velocity);
        if stressed {
            self.absorbing = Absorbing::default();
            self.set_boundaries(true, true)
                .map_err(|error| Stop::Motion {
                    error,
                    stage: self.plan.stages[0].name.clone(),
                    time: 0.0,
                })?;
        }
        self.ledger = Ledger::default();
        self.gave_velocities();
        self.clock.longest = 0.0;
        self.clock.next = self.kick(0.0, self.remaining())?;
        self.settle();
        Ok(())
    }

    /// Gives all particles these velocities, m/s, in the order of the arrays: those of the middle of the
    /// coming step. The ledger books the change of their kinetic energy as given.
    pub fn assign_velocity(&mut self, velocity: Vectors) {
        assert_eq!(velocity.len(), self.particles().len());
        self.particles.velocity = velocity;
        let constraints = self.clock.new_constraints;
        self.gave_velocities();
        self.clock.new_constraints = constraints;
    }

    /// Gives all particles these stresses, Pa, in the order of the arrays. Forces come from them from the
    /// end of the coming step on. The ledger knows works alone: what the change has stored is in no term.
    pub fn assign_stress(&mut self, stress: Tensors) {
        assert_eq!(stress.len(), self.particles().len());
        self.particles.stress = stress;
    }

    /// Takes the particles' arrays out and goes on with copies of them: what was looked at stays as it
    /// was, where it was.
    pub fn take_particles(&mut self) -> Particles {
        let copy = self.particles().clone();
        std::mem::replace(&mut self.particles, copy)
    }

    /// Takes them out of a simulation that is given up.
    pub fn give_up_particles(&mut self) -> Particles {
        std::mem::take(&mut self.particles)
    }
}
