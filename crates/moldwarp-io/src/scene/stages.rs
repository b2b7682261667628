//! Stages of the run.

use super::amount::Spanned;
use super::error::Fault;
use super::quantity::Dimension;
use super::raw::RawStage;
use super::values::{count, damping, exactly_one, find, placed, positive, span, vector};
use moldwarp::plan::{Body, Stage, Until};

pub(super) fn stages(raw: &[Spanned<RawStage>], bodies: &[Body]) -> Result<Vec<Stage>, Fault> {
    if raw.is_empty() {
        return Err(
            Fault::new("the scene has no stages, so nothing would be computed")
                .help("add one at the end:\n[[stages]]\nname = \"loading\"\nduration = \"2 s\""),
        );
    }
    let mut stages: Vec<Stage> = Vec::new();
    for raw in raw {
        let stage = stage(raw.get_ref(), bodies)?;
        if stages.iter().any(|s| s.name == stage.name) {
            return Err(
                Fault::new(format!("two stages are called `{}`", stage.name))
                    .at(raw.get_ref().name.span(), "the second of this name")
                    .help("give each its own name"),
            );
        }
        stages.push(stage);
    }
    Ok(stages)
}

fn stage(raw: &RawStage, bodies: &[Body]) -> Result<Stage, Fault> {
    exactly_one(
        (raw.name.span(), "a stage"),
        &[
            ("duration", span(&raw.duration)),
            ("steps", span(&raw.steps)),
        ],
    )?;
    let until = match (&raw.duration, &raw.steps) {
        (Some(duration), _) => Until::Duration(positive("duration", duration, Dimension::Time)?),
        (None, Some(steps)) => Until::Steps(count("steps", steps, 1)?),
        (None, None) => return Err(Fault::new("a stage needs an end")),
    };
    let mut initial_velocities = Vec::new();
    for (body, velocity) in &raw.initial_velocity.0 {
        let names = bodies.iter().map(|b| b.name.as_str());
        initial_velocities.push((
            find(placed(body), "body", "bodies", names)?,
            vector("initial_velocity", velocity, Dimension::Velocity)?,
        ));
    }
    Ok(Stage {
        name: raw.name.get_ref().clone(),
        until,
        damping: raw.damping.as_ref().map(damping).transpose()?,
        initial_velocities,
    })
}
