//! What the solver finds when it sets up a scene, told where it stands in the scene's text.

use super::error::Fault;
use super::{SceneError, contacts, earlier, initial_stress, mesh_motion, overrides};
use moldwarp::SetupError;
use moldwarp::particles::SeedingError;
use moldwarp::step::TimeStepError;
use std::ops::Range;

/// Where a scene came from.
#[derive(Clone, Debug, Default)]
pub(crate) struct Origin {
    /// Its name in messages.
    pub(super) name: String,
    pub(super) overrides: Vec<overrides::Override>,
    pub(super) time_step: Option<Range<usize>>,
    pub(super) initial_stress: Option<Range<usize>>,
    pub(super) mesh_motion: Option<Range<usize>>,
    /// Names of bodies and where they stand.
    pub(super) bodies: Vec<(String, Range<usize>)>,
    /// The same of probes.
    pub(super) probes: Vec<(String, Range<usize>)>,
    /// Names of contacts and where their `surface` stands.
    pub(super) surfaces: Vec<(String, Range<usize>)>,
}

impl Origin {
    /// What the solver found when it set up the scene, shown in the scene's `text` where it has a
    /// place there.
    pub(crate) fn explain(&self, error: SetupError, text: &str) -> SceneError {
        let fault = self.fault(&error).caused_by(error);
        overrides::blame(fault, text, &self.overrides).in_file(&self.name, text)
    }

    fn fault(&self, error: &SetupError) -> Fault {
        match (error, &self.time_step) {
            (SetupError::TimeStep(TimeStepError::AboveStable { .. }), Some(place)) => {
                above_stable(error, place)
            }
            (SetupError::InitialStress(error), _) => {
                initial_stress::explain(error, self.initial_stress.clone().unwrap_or_default())
            }
            (SetupError::Seeding(error), _) => self.seeding(error),
            (SetupError::Motion(error), _) => mesh_motion::explain(error, self.mesh_motion.clone()),
            (SetupError::Inherited(error), _) => earlier::explain(error),
            (SetupError::Contact(error), _) => contacts::explain(error, &self.surfaces)
                .unwrap_or_else(|| Fault::new(error.to_string())),
            (SetupError::Load(_), _) => Fault::new(error.to_string()).help(
                "its body has no particles there: let the body's region reach the surface, or load \
                 another surface",
            ),
            (SetupError::NoInitialStress { body, .. }, _) => {
                Fault::new(error.to_string()).help(format!(
                    "give `{body}` its `k0` and the scene [initial_stress], or the load a pressure"
                ))
            }
            (SetupError::ProbeOfChange { probe, .. } | SetupError::ProbeOfNothing { probe }, _) => {
                self.lost(error, probe)
            }
            (SetupError::NoContact { probe }, _) => {
                let fault = Fault::new(error.to_string()).help(
                    "name a surface of the first body of an aligned contact; the whole force is in the \
                     columns contact.<name>",
                );
                let places = self.probes.iter().filter(|p| p.0 == *probe);
                places.fold(fault, |fault, (_, place)| {
                    fault.at(place.clone(), "this probe")
                })
            }
            _ => Fault::new(error.to_string()),
        }
    }

    /// A probe without its particles.
    fn lost(&self, error: &SetupError, probe: &str) -> Fault {
        let text = error.to_string();
        let problem = text.split_once(": ").map_or(&*text, |parts| parts.0);
        let fault = Fault::new(problem).help(
            "put the probe where a body is in all stages, or on a surface with a boundary, whose nodes \
             stay",
        );
        let places = self.probes.iter().filter(|p| p.0 == probe);
        places.fold(fault, |fault, (_, place)| {
            fault.at(place.clone(), "has nothing to look at in some stage")
        })
    }

    fn seeding(&self, error: &SeedingError) -> Fault {
        let (body, help) = match error {
            SeedingError::Overlap { first, second, .. } => return self.overlap(first, second),
            SeedingError::Empty { body } => (
                body,
                "make its region larger, or the elements smaller there",
            ),
            SeedingError::TooMany { body, .. } => (
                body,
                "take a larger `particle_spacing`, or smaller elements",
            ),
        };
        let fault = Fault::new(error.to_string()).help(help);
        let places = self.bodies.iter().filter(|b| b.0 == *body);
        places.fold(fault, |fault, (_, place)| {
            fault.at(place.clone(), "this body")
        })
    }

    fn overlap(&self, first: &str, second: &str) -> Fault {
        let fault = Fault::new(format!("bodies `{first}` and `{second}` overlap"))
            .help("a place can hold one body only: shrink or move the region of one of them");
        let places = self.bodies.iter().filter(|b| b.0 == first || b.0 == second);
        places.fold(fault, |fault, (_, place)| {
            fault.at(place.clone(), "shares elements with the other")
        })
    }
}

fn above_stable(error: &SetupError, place: &Range<usize>) -> Fault {
    let text = error.to_string();
    let problem = text.split_once(": ").map_or(&*text, |parts| parts.0);
    Fault::new(problem)
        .at(place.clone(), "above the stable step")
        .help(
            "leave `time_step` out, and the step follows the stable one; `max_time_step` only \
             bounds it; a forced step has to stay below the stable one, which shrinks as elements \
             are compressed",
        )
}
