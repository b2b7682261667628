//! The scene of a run that is resumed: as it was, whatever has become of its files.

use super::error::{Fault, SceneError};
use super::output::{OutputSettings, output};
use super::{Given, Scene, check, overrides, syntax};
use moldwarp::plan::Until;
use moldwarp::{Mesh, Simulation};
use std::path::Path;

/// What a run has kept of its scene.
#[derive(Debug)]
pub(crate) struct Kept<'a> {
    /// As it was run.
    pub text: &'a str,
    pub case: &'a str,
    /// As the run began.
    pub mesh: Mesh,
    /// What a program has given to it, and gives again.
    pub given: Given,
}

const WHAT_MAY_CHANGE: &str = "of a run that is resumed `--set` may change the `duration` and `steps` of \
     stages that are not over, and everything in `output`; `--threads` is an option of its own";

/// The scene again, with changes `sets` of what may still change, and its output settings before
/// these. `out` is the folder of the run, `done` the number of stages that are over.
///
/// # Errors
///
/// If something else is to change, or a value is wrong.
pub(crate) fn kept(
    kept: Kept,
    out: &Path,
    sets: &[String],
    done: usize,
) -> Result<(Scene, OutputSettings), SceneError> {
    let mut name = out.join("scene.toml").display().to_string();
    let before = syntax::parse(kept.text).and_then(|raw| output(&raw.output));
    let before = before.map_err(|fault| fault.in_file(&name, kept.text))?;
    let (text, overrides) = allowed(sets)
        .and_then(|()| overrides::apply(kept.text, sets, &[]))
        .and_then(|changed| same_stages(kept.text, &changed.0, done).map(|()| changed))
        .map_err(Fault::without_file)?;
    if !sets.is_empty() {
        name += " with --set";
    }
    let (case, folder) = (kept.case.to_owned(), out.to_owned());
    let read = syntax::parse(&text)
        .and_then(|raw| check(&raw, case, folder, &text, (&kept.given, Some(kept.mesh))));
    match read {
        Ok(mut scene) => {
            scene.origin.name = name;
            scene.origin.overrides = overrides;
            Ok((scene, before))
        }
        Err(fault) => Err(overrides::blame(fault, &text, &overrides).in_file(&name, &text)),
    }
}

fn allowed(sets: &[String]) -> Result<(), Fault> {
    for entry in sets {
        let (path, _) = overrides::split(entry)?;
        let path: Vec<&str> = path.iter().map(String::as_str).collect();
        match path[..] {
            ["output", _] | ["stages", _, "duration" | "steps"] => {}
            _ => {
                let problem = format!("`--set {entry}`: the run goes on with what it began with");
                return Err(Fault::new(problem).help(WHAT_MAY_CHANGE));
            }
        }
    }
    Ok(())
}

/// Stages that are over are what they were.
fn same_stages(before: &str, after: &str, done: usize) -> Result<(), Fault> {
    let stages = |text: &str| -> Vec<toml::Value> {
        let scene: toml::Table = toml::from_str(text).unwrap_or_default();
        let stages = scene.get("stages").and_then(toml::Value::as_array);
        stages.cloned().unwrap_or_default()
    };
    let pairs = stages(before).into_iter().zip(stages(after)).take(done);
    for (number, (before, after)) in pairs.enumerate() {
        if before != after {
            let name = before.get("name").and_then(toml::Value::as_str);
            let name = name.map_or(number.to_string(), str::to_owned);
            let problem = format!("stage `{name}` is over, and cannot be given another end");
            return Err(Fault::new(problem).help(WHAT_MAY_CHANGE));
        }
    }
    Ok(())
}

/// Whether the stage that goes on ends after its coming step, as it has to.
///
/// # Errors
///
/// If a changed end is over already.
pub(crate) fn check_end(sim: &Simulation) -> Result<(), SceneError> {
    let Some(stage) = sim.plan().stages.get(sim.stage()) else {
        return Ok(());
    };
    let (time, steps) = (
        sim.stage_time() + sim.next_time_step(),
        sim.stage_steps() + 1,
    );
    let problem = match stage.until {
        Until::Duration(end) | Until::Equilibrium { limit: end, .. }
            if end < time * (1.0 - 1e-9) =>
        {
            format!("its `duration` has to be at least {time} s")
        }
        Until::Steps(end) if end < steps => format!("its `steps` have to be at least {steps}"),
        _ => return Ok(()),
    };
    let name = &stage.name;
    Err(
        Fault::new(format!("stage `{name}` has gone on for longer than that"))
            .help(problem)
            .without_file(),
    )
}
