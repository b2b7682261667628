//! Why a plan cannot be computed, or a simulation cannot go on.

use crate::Vec3;
use crate::boundary::LoadError;
use crate::contact::ContactError;
use crate::mesh::MotionError;
use crate::particles::{InheritedError, InitialStressError, SeedingError};
use crate::simulation::Simulation;
use crate::step::TimeStepError;

/// Why a plan cannot be computed.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum SetupError {
    #[error(transparent)]
    Seeding(#[from] SeedingError),
    #[error(transparent)]
    Inherited(#[from] InheritedError),
    #[error(transparent)]
    Contact(#[from] ContactError),
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error(transparent)]
    TimeStep(#[from] TimeStepError),
    #[error(transparent)]
    Motion(#[from] MotionError),
    #[error("probe `{probe}` asks for a reaction, but is no surface that carries a boundary")]
    NoReaction { probe: String },
    #[error("probe `{probe}` asks for the force of a contact, but is no surface of an aligned one")]
    NoContact { probe: String },
    #[error(transparent)]
    InitialStress(#[from] InitialStressError),
    #[error("load `{load}` asks for the initial stress of body `{body}`, which has none")]
    NoInitialStress { load: String, body: String },
    #[error(
        "probe `{probe}` looks at particles of body `{body}`, which is {change} by stage `{stage}`: \
         probes look at what is there in all stages"
    )]
    ProbeOfChange {
        probe: String,
        body: String,
        stage: String,
        /// `added` or `removed`.
        change: &'static str,
    },
    #[error(
        "probe `{probe}` looks at the particles next to its surface at the start, and there are none"
    )]
    ProbeOfNothing { probe: String },
    #[error("there is no stage")]
    NoStage,
}

/// Why a simulation had to stop before its end.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum Stop {
    #[error(
        "particle {id} of body `{body}` left the mesh at {position} m, {time:e} s after the start \
         in stage `{stage}`: give it room, or check boundaries, loads and stiffness"
    )]
    LeftTheMesh {
        id: u32,
        body: String,
        position: Vec3,
        stage: String,
        time: f64,
    },
    #[error(
        "particle {id} of body `{body}` passed a face of an aligned contact by more than a tenth of an \
         element at {position} m, {time:e} s after the start in stage `{stage}`: the bodies move \
         through the mesh; make the contact free"
    )]
    PassedAFace {
        id: u32,
        body: String,
        position: Vec3,
        stage: String,
        time: f64,
    },
    #[error(
        "element {element} (counted from 0) turned over as the mesh followed an absorbing \
         boundary, {time:e} s after the start in stage `{stage}`: the boundary yields by more than \
         an element; give it a virtual thickness, or larger elements next to it"
    )]
    TurnedOver {
        element: u32,
        stage: String,
        time: f64,
    },
    #[error(
        "volume `{zone}` is compressed to degeneracy by the moving mesh, first in element {element} \
         (counted from 0), {time:e} s after the start in stage `{stage}`: give it more room in the \
         direction of the motion or larger elements, or end the stage earlier"
    )]
    Degenerate {
        zone: String,
        element: u32,
        stage: String,
        time: f64,
    },
    #[error(
        "{what} of particle {id} of body `{body}` (and of {others} more) is not a finite number, {time:e} s \
         after the start in stage `{stage}`: look for values out of proportion in materials, loads and velocities around \
         {position} m"
    )]
    NotFinite {
        what: &'static str,
        id: u32,
        others: usize,
        body: String,
        position: Vec3,
        stage: String,
        time: f64,
    },
    #[error(
        "particle {id} of body `{body}` at {position} m is crushed to no volume in one step, {time:e} s \
         after the start in stage `{stage}`: loads or velocities are out of proportion to the stiffness, or \
         the time step is too long for them; lower `numerics.courant`"
    )]
    Crushed {
        id: u32,
        body: String,
        position: Vec3,
        stage: String,
        time: f64,
    },
    #[error("material `{material}` {problem}, {time:e} s after the start in stage `{stage}`")]
    Law {
        material: String,
        problem: String,
        stage: String,
        time: f64,
    },
    #[error(
        "all material has left through outflow surfaces, {time:e} s after the start in stage `{stage}`: \
         end the stage earlier"
    )]
    Empty { stage: String, time: f64 },
    #[error("stage `{stage}`, {time:e} s after the start: {error}")]
    Motion {
        error: MotionError,
        stage: String,
        time: f64,
    },
    #[error(
        "stage `{stage}`, {time:e} s after the start, adds body `{body}` where particles of body \
         `{other}` are, first in element {element} (counted from 0): remove `{other}` before, or add \
         `{body}` to elements that it does not reach"
    )]
    NoRoom {
        body: String,
        other: String,
        element: u32,
        stage: String,
        time: f64,
    },
    #[error(
        "stage `{stage}` reached its limit without equilibrium, {time:.4} s after the start: the \
         out-of-balance ratio is {unbalanced:.2e} (at most {least_unbalanced:e}), the grid's kinetic \
         energy {kinetic:.2e} of its reference (at most {least_kinetic:e})"
    )]
    NotAtRest {
        unbalanced: f64,
        least_unbalanced: f64,
        kinetic: f64,
        least_kinetic: f64,
        stage: String,
        time: f64,
    },
    #[error("stage `{stage}`, {time:e} s after the start: {error}")]
    TimeStep {
        error: TimeStepError,
        stage: String,
        time: f64,
    },
}

impl Simulation {
    pub(crate) fn no_time_step(&self, error: TimeStepError) -> Stop {
        let stage = self.plan.stages[self.clock.stage].name.clone();
        Stop::TimeStep {
            error,
            stage,
            time: self.clock.time,
        }
    }

    pub(crate) fn turned_over(&self, element: u32) -> Stop {
        let stage = self.plan.stages[self.clock.stage].name.clone();
        Stop::TurnedOver {
            element,
            stage,
            time: self.clock.time,
        }
    }

    pub(crate) fn degenerate(&self, element: u32) -> Stop {
        let mut groups = self.plan.mesh.volume_groups.iter();
        let zone = groups.find(|g| g.elements.contains(&element));
        Stop::Degenerate {
            zone: zone.map_or(String::new(), |g| g.name.clone()),
            element,
            stage: self.plan.stages[self.clock.stage].name.clone(),
            time: self.clock.time,
        }
    }

    pub(crate) fn passed_a_face(&self, particle: usize) -> Stop {
        match self.left_the_mesh(particle) {
            Stop::LeftTheMesh {
                id,
                body,
                position,
                stage,
                time,
            } => Stop::PassedAFace {
                id,
                body,
                position,
                stage,
                time,
            },
            other => other,
        }
    }

    /// For a sum over particles that is not a finite number.
    pub(crate) fn not_finite(&self) -> Stop {
        let p = &self.particles;
        let stress = |i: usize| p.stress.at(i).iter().all(|s| s.is_finite());
        let checks: [(&str, &dyn Fn(usize) -> bool); 3] = [
            ("the velocity", &|i| p.velocity.at(i).is_finite()),
            ("the stress", &stress),
            ("the position", &|i| p.position.at(i).is_finite()),
        ];
        let found = checks.iter().find_map(|(what, finite)| {
            let wrong = || (0..p.len()).filter(|&i| !finite(i));
            let first = wrong().min_by_key(|&i| p.id[i])?;
            Some((*what, first, wrong().count() - 1))
        });
        // A finite velocity may have a square that is none.
        let (what, i, others) = found.unwrap_or(("the energy of motion", 0, 0));
        Stop::NotFinite {
            what,
            others,
            id: p.id[i],
            body: self.plan.bodies[usize::from(p.body[i])].name.clone(),
            position: p.position.at(i),
            stage: self.plan.stages[self.clock.stage].name.clone(),
            time: self.clock.time,
        }
    }

    /// For particles of which some have no volume left.
    pub(crate) fn crushed(&self) -> Stop {
        let p = &self.particles;
        let crushed = (0..p.len()).filter(|&i| p.volume[i] <= 0.0);
        let i = crushed.min_by_key(|&i| p.id[i]).unwrap_or(0);
        Stop::Crushed {
            id: p.id[i],
            body: self.plan.bodies[usize::from(p.body[i])].name.clone(),
            position: p.position.at(i),
            stage: self.plan.stages[self.clock.stage].name.clone(),
            time: self.clock.time,
        }
    }

    pub(crate) fn left_the_mesh(&self, particle: usize) -> Stop {
        Stop::LeftTheMesh {
            id: self.particles.id[particle],
            body: self.plan.bodies[usize::from(self.particles.body[particle])]
                .name
                .clone(),
            position: self.particles.position.at(particle),
            stage: self.plan.stages[self.clock.stage].name.clone(),
            time: self.clock.time,
        }
    }
}
