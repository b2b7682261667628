//! A scene whose ground is as an earlier run left it: `--from OUT@STAGE`.

use super::{Fault, Scene, SceneError, suggest};
use crate::output::Folder;
use crate::run::StageFile;
use moldwarp::particles::{InheritedError, Particles};
use std::path::{Path, PathBuf};

/// The end of a stage of an earlier run.
#[derive(Clone, Debug, PartialEq)]
pub struct Earlier {
    /// As the user wrote it, `OUT@STAGE`.
    pub given: String,
    /// The run's.
    pub folder: PathBuf,
    pub stage: String,
}

impl Earlier {
    /// Refuses to write where the earlier run is: it would be removed.
    ///
    /// # Errors
    ///
    /// If the run is in `out` or below it.
    pub fn keep_from(&self, out: &Path) -> Result<(), SceneError> {
        match (out.canonicalize(), self.folder.canonicalize()) {
            (Ok(out), Ok(folder)) if folder.starts_with(&out) => Err(Fault::new(format!(
                "the earlier run in {} would be replaced",
                self.folder.display()
            ))
            .help("`--out DIR` writes somewhere else")
            .without_file()),
            _ => Ok(()),
        }
    }
}

/// Gives the bodies that an earlier run has too, by name, the particles that it had at the end of a
/// stage. `given` is `OUT@STAGE`, the run's folder and the stage's name.
///
/// # Errors
///
/// If there is no such run or stage, if none of its bodies is in the scene, or if the scene has
/// an initial stress of its own.
pub fn inherit(scene: &mut Scene, given: &str) -> Result<(), SceneError> {
    let earlier = find(given).map_err(Fault::without_file)?;
    if scene.plan.initial_stress.is_some() {
        let place = scene.origin.initial_stress.clone().unwrap_or_default();
        return Err(Fault::new("the stress comes from the earlier run")
            .at(place, "cannot be together with `--from`")
            .help("leave out [initial_stress] and the `k0` of bodies, or `--from`")
            .in_file(&scene.origin.name, &scene.text));
    }
    let (number, _) = stages(&earlier.folder)
        .into_iter()
        .enumerate()
        .find(|s| s.1 == earlier.stage)
        .unwrap_or_default();
    let path = (earlier.folder).join(Folder::stage(number, &earlier.stage));
    let file = StageFile::read(&path, &earlier.stage).map_err(|e| {
        let fault = Fault::new(e.to_string());
        fault.help("make the earlier run again").without_file()
    })?;
    take_over(file, scene, &earlier).map_err(Fault::without_file)?;
    scene.earlier = Some(earlier);
    Ok(())
}

/// The run and its stage, if there is a file of it.
fn find(given: &str) -> Result<Earlier, Fault> {
    let (folder, stage) = match given.rsplit_once('@') {
        Some((folder, stage)) => (folder, Some(stage).filter(|s| !s.is_empty())),
        None => (given, None),
    };
    let path = PathBuf::from(folder);
    if !Folder::is_a_run(&path) {
        let fault = match path.is_dir() {
            true => Fault::new(format!("{folder} holds no run of moldwarp")),
            false => Fault::new(format!("there is no folder `{folder}`")),
        };
        return Err(fault.help(
            "`--from OUT@STAGE` names the folder that an earlier run has written and one of its \
             stages",
        ));
    }
    let stages = stages(&path);
    let completed: Vec<&str> = (stages.iter().enumerate())
        .filter(|(number, name)| path.join(Folder::stage(*number, name)).is_file())
        .map(|(_, name)| &name[..])
        .collect();
    let there = |wrong: &str| match completed.is_empty() {
        true => "the run has completed no stage".to_owned(),
        false => suggest::help(wrong, "completed stages", completed.iter().copied()),
    };
    let Some(stage) = stage else {
        return Err(Fault::new(format!("`--from {given}` names no stage"))
            .help(format!("write `{folder}@STAGE`; {}", there(""))));
    };
    if completed.contains(&stage) {
        return Ok(Earlier {
            given: given.to_owned(),
            folder: path,
            stage: stage.to_owned(),
        });
    }
    Err(match stages.iter().any(|s| s == stage) {
        true => Fault::new(format!(
            "the run in {folder} did not complete stage `{stage}`"
        ))
        .help(match completed.is_empty() {
            true => there(stage),
            false => format!("completed stages: {}", suggest::list(completed)),
        }),
        false => {
            Fault::new(format!("the run in {folder} has no stage `{stage}`")).help(there(stage))
        }
    })
}

/// Names of a run's stages, in order; none if its scene cannot be read.
fn stages(folder: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(folder.join("scene.toml")).unwrap_or_default();
    let scene: toml::Table = toml::from_str(&text).unwrap_or_default();
    let stages = scene.get("stages").and_then(toml::Value::as_array);
    let name = |stage: &toml::Value| stage.get("name")?.as_str().map(str::to_owned);
    stages.into_iter().flatten().filter_map(name).collect()
}

fn take_over(file: StageFile, scene: &mut Scene, earlier: &Earlier) -> Result<(), Fault> {
    let plan = &scene.plan;
    let (bodies, materials) = (&plan.bodies, &plan.materials);
    // A body that a stage adds is seeded when it comes.
    let own = |name: &str| {
        let number = bodies.iter().position(|b| b.name == name);
        number.filter(|&b| plan.there_at_the_start(b))
    };
    let numbers: Vec<Option<usize>> = file.bodies.iter().map(|b| own(&b.name)).collect();
    if numbers.iter().all(Option::is_none) {
        return Err(
            Fault::new(format!("the scene has no body of {}", earlier.given)).help(format!(
                "bodies are found by name; of the scene: {}; of the earlier run: {}",
                suggest::list(bodies.iter().map(|b| &b.name[..])),
                suggest::list(file.bodies.iter().map(|b| &b.name[..]))
            )),
        );
    }
    let mut particles = file.particles;
    let (mut from, mut notes) = (Vec::new(), Vec::new());
    for (theirs, (body, &number)) in file.bodies.iter().zip(&numbers).enumerate() {
        let name = &body.name;
        let Some(number) = number else {
            notes.push(format!(
                "body `{name}` of the earlier run is left out: the scene has none of this name at the start"
            ));
            continue;
        };
        from.push(&name[..]);
        let fields = materials[bodies[number].material].model.state_fields();
        for (at, field) in fields.iter().enumerate() {
            let Some((_, values)) = body.state.iter().find(|s| s.0 == field.name) else {
                notes.push(format!(
                    "body `{name}` begins with {} 0: its material had none in the earlier run",
                    field.name
                ));
                continue;
            };
            let of_body = |p: &usize| usize::from(particles.body[*p]) == theirs;
            for p in (0..particles.body.len()).filter(of_body) {
                particles.state.components_mut()[at][p] = values[p];
            }
        }
    }
    keep_known(&mut particles, &numbers);
    scene.notes.push(format!(
        "at the start {} as at the end of {}",
        suggest::list(from),
        earlier.given
    ));
    scene.notes.append(&mut notes);
    scene.plan.inherited = particles;
    Ok(())
}

/// Removes the particles of bodies without a number in the scene, and gives the others theirs.
fn keep_known(particles: &mut Particles, numbers: &[Option<usize>]) {
    let number = |body: &u16| numbers[usize::from(*body)];
    let kept: Vec<bool> = particles.body.iter().map(|b| number(b).is_some()).collect();
    particles.retain(&kept);
    for body in particles.body.iter_mut() {
        *body = number(body).unwrap_or_default() as u16;
    }
}

/// What the solver found of the particles, and what to do.
pub(super) fn explain(error: &InheritedError) -> Fault {
    let help = match error {
        InheritedError::Outside { .. } => {
            "the mesh has to hold the ground as the earlier run left it: make the mesh larger, or \
             call the body otherwise here, so that it is seeded"
        }
        InheritedError::Overlap { .. } => {
            "a place can hold one body only: shrink or move the seeded one"
        }
        InheritedError::Density { .. } => {
            "mass is inherited: give the material the density that it had; other properties may \
             change"
        }
        InheritedError::InitialStress => "leave out one of them",
    };
    Fault::new(error.to_string()).help(help)
}
