//! A run that goes on from its last checkpoint.

use super::checkpoint::{Checkpoint, Checkpoints};
use super::history::{Expected, columns};
use super::log::Log;
use super::recorder::Recorder;
use super::steps::{Books, end_time};
use super::{CheckpointError, Observer, Outcome, RunError, RunOptions, conclude};
use crate::output::{FileError, Folder, write_whole};
use crate::scene::{Given, Kept, OutputSettings, Scene, SceneError, check_end, kept};
use moldwarp::{Mesh, Plan, Simulation};
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};

/// Reads a checkpoint's bytes as [`resume`] does, up to the simulation that would go on, and returns its
/// number of steps.
///
/// # Errors
///
/// If it cannot be used.
pub fn read_checkpoint(bytes: Vec<u8>) -> Result<u64, RunError> {
    let checkpoint = Checkpoint::of(bytes)?;
    let (scene, _) = scene(&checkpoint, checkpoint.mesh()?, Path::new("."), &[])?;
    Ok(state(&checkpoint, scene.plan)?.steps())
}

/// The scene as run, with changes, and its output before them.
fn scene(
    checkpoint: &Checkpoint,
    mesh: Mesh,
    path: &Path,
    sets: &[String],
) -> Result<(Scene, OutputSettings), SceneError> {
    let of_run = Kept {
        text: &checkpoint.beginning.text,
        case: &checkpoint.beginning.case,
        mesh,
        given: Given::default(),
    };
    kept(of_run, path, sets, checkpoint.stage)
}

fn state(checkpoint: &Checkpoint, plan: Plan) -> Result<Simulation, CheckpointError> {
    Ok(Simulation::restore(plan, |name| checkpoint.section(name))?)
}

/// Goes on with the run in a folder from its last checkpoint, as if it had never stopped; what was
/// written after that is written anew. `sets` may change the ends of stages and the output. Nothing is
/// returned if the run is over already, and nothing is changed then.
///
/// # Errors
///
/// If there is no run or no checkpoint that can be used, or `sets` would change something else;
/// nothing is changed then either.
pub fn resume(
    path: &Path,
    sets: &[String],
    options: &RunOptions,
    observer: &mut dyn Observer,
) -> Result<Option<Outcome>, RunError> {
    let start = Instant::now();
    if !Folder::is_a_run(path) {
        return Err(RunError::NoRun(path.to_owned()));
    }
    let folder = Folder::resume(path);
    if is_over(&folder)? {
        return match sets.is_empty() {
            true => Ok(None),
            false => Err(RunError::Over(path.to_owned())),
        };
    }
    let mut log = Log::resume(&folder.log(), start)?;
    if !log.is_alone() {
        return Err(RunError::AtWork(path.to_owned()));
    }
    let (checkpoint, problems) = Checkpoint::newest(&folder)?;
    let mesh = checkpoint.mesh()?;
    let nodes = mesh.nodes.clone();
    let (scene, output) = scene(&checkpoint, mesh, path, sets)?;
    let title = scene.plan.title.clone();
    let mut sim = state(&checkpoint, scene.plan)?;
    check_end(&sim)?;
    if let Some(simd) = options.simd {
        sim.use_simd(simd);
    }
    let columns = columns(&sim);
    let references = checkpoint.beginning.references.clone();
    let expected = Expected::again(&scene.compare, &columns, references)?;

    // From here on something is changed.
    let (mut beginning, mut course, recorded, generation) = checkpoint.go_on();
    course.resumed_at.push(sim.steps());
    log.after(Duration::try_from_secs_f64(course.earlier).unwrap_or_default());
    problems.iter().try_for_each(|problem| log.line(problem))?;
    log.line(&format!(
        "resumed at step {}, {} s, {} threads",
        sim.steps(),
        sim.time(),
        options.threads
    ))?;
    remove(&folder.summary())?;
    remove(&folder.report())?;
    beginning.text = scene.text;
    write_whole(&folder.scene(), |out| {
        out.write_all(beginning.text.as_bytes())
    })?;
    let other = |now, before| (now != before).then_some(now);
    let recorder = Recorder::resume(
        recorded,
        [
            other(scene.output.frames, output.frames),
            other(scene.output.history, output.history),
        ],
        (sim.time(), end_time(&sim)),
        &folder,
        &columns,
        expected,
    )?;
    folder.remove_stages_from(sim.stage())?;
    let checkpoints = Checkpoints::new(
        &folder,
        (&beginning, nodes),
        generation,
        scene.output.checkpoints,
        start,
    );
    let mut notes = problems;
    notes.push(format!("resumed at step {}", sim.steps()));
    observer.begin(&sim, &folder, &notes);
    let books = Books {
        recorder,
        log,
        course,
        checkpoints,
    };
    let about = (beginning, title, columns);
    conclude(sim, books, about, &folder, options, observer).map(Some)
}

/// Whether the run has done all that it was to do. One that a guard has stopped may go on.
fn is_over(folder: &Folder) -> Result<bool, FileError> {
    let path = folder.summary();
    if !path.exists() {
        return Ok(false);
    }
    let text = std::fs::read_to_string(&path).map_err(FileError::at("read", &path))?;
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    Ok(summary["exit"] == "done")
}

fn remove(path: &Path) -> Result<(), FileError> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(FileError::at("remove", path)(e)),
        _ => Ok(()),
    }
}
