//! What a scene's text tells by itself, without its files: for readers of a run's folder, where the
//! mesh is not.

use super::error::SceneError;
use super::quantity::Dimension;
use super::syntax;
use super::values::{amount, vector};
use std::path::Path;

/// Names in their order, and the part that was computed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Outline {
    pub title: String,
    /// By their numbers in the frames.
    pub bodies: Vec<String>,
    /// By their numbers in the history.
    pub stages: Vec<String>,
    /// m/s².
    pub gravity: [f64; 3],
    pub part: Option<Part>,
}

/// What was computed of a body; `axis` is 0, 1 or 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Part {
    /// From θ = 0 to `angle`, rad, about the axis.
    Sector { axis: usize, angle: f64 },
    /// One side of the plane with this normal.
    Half { axis: usize },
}

impl Outline {
    /// Reads a scene as it was run; `path` is where it stands.
    pub fn read(text: &str, path: &Path) -> Result<Outline, SceneError> {
        let outline = || {
            let raw = syntax::parse(text)?;
            let gravity = vector("gravity", &raw.gravity, Dimension::Acceleration)?;
            let part = match &raw.symmetry {
                None => None,
                Some(raw) => {
                    let raw = raw.get_ref();
                    let axis = "xyz".find(raw.axis.get_ref().as_str()).unwrap_or(2);
                    Some(match &raw.angle {
                        Some(angle) => Part::Sector {
                            axis,
                            angle: amount("angle", angle, Dimension::Angle)?,
                        },
                        None => Part::Half { axis },
                    })
                }
            };
            let stages = raw.stages.iter().map(|s| s.get_ref().name.get_ref());
            Ok(Outline {
                title: raw.title.clone().unwrap_or_default(),
                bodies: (raw.bodies.0.iter().map(|(name, _)| name.get_ref().clone())).collect(),
                stages: stages.cloned().collect(),
                gravity: gravity.to_array(),
                part,
            })
        };
        outline().map_err(|fault: super::Fault| fault.in_file(&path.display().to_string(), text))
    }
}
