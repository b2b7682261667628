//! A run: from a checked scene to its folder of results.

mod checkpoint;
mod frames;
mod history;
mod interrupt;
mod log;
mod recorder;
mod resume;
mod schedule;
mod session;
mod stage_files;
mod state;
mod steps;
mod warnings;
mod whole;

pub use checkpoint::CheckpointError;
pub use interrupt::Interrupt;
pub use resume::{read_checkpoint, resume};
pub use session::{Session, SessionError};
pub use state::state_hash;

pub(crate) use checkpoint::{checkpoint_bytes, facts as checkpoint_facts};
#[cfg(test)]
pub(crate) use frames::{Field, NODE_FIELDS, OfParticles, PARTICLE_FIELDS};
pub(crate) use frames::{frame_bytes, unit as unit_of_field};
#[cfg(test)]
pub(crate) use history::FIRST;
pub(crate) use history::{Expected, columns, unit as unit_of_column};
pub(crate) use session::{Framed, GOING_ON};
pub(crate) use stage_files::StageFile;
pub(crate) use steps::end_time;
pub(crate) use warnings::{NUMERICAL, RESIDUAL};
pub(crate) use whole::factor as whole_factor;

use crate::mesh::describe_quality;
use crate::output::csv::CsvError;
use crate::output::hash::scene_hash;
use crate::output::{FileError, Folder, FolderError, Projected, Summary, write_whole};
use crate::scene::{Origin, Scene, SceneError};
use checkpoint::{Beginning, Checkpoints, Course};
use log::Log;
use moldwarp::measure::{Energies, Profile};
use moldwarp::{Plan, Simd, Simulation, Stop};
use recorder::Recorder;
use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use steps::{Books, Ended, Pace, steps};

/// How a scene is run; nothing here changes what is computed.
#[derive(Clone, Debug, Default)]
pub struct RunOptions {
    /// Where results go; `out/<case>` under the current folder if not given.
    pub out: Option<PathBuf>,
    /// Replace an unfinished run, put up with foreign files.
    pub force: bool,
    /// The threads at work, for the record.
    pub threads: usize,
    /// Instructions to compute with; the best of this processor if not given.
    pub simd: Option<Simd>,
    /// Asks the run to stop.
    pub interrupt: Interrupt,
}

/// How far a run is.
#[derive(Clone, Debug)]
pub struct Progress {
    /// Name of the stage that goes on, its number from 0, and how many there are.
    pub stage: String,
    pub stage_number: usize,
    pub stages: usize,
    /// Whether a stage that goes on or is to come may end earlier, in equilibrium.
    pub may_end_earlier: bool,
    /// Simulated time, s.
    pub time: f64,
    /// When it will end, s; an estimate where a stage is given in steps.
    pub end: f64,
    pub step: u64,
    /// The last step, s.
    pub time_step: f64,
    /// Particles times steps per second of the step loop.
    pub rate: f64,
    /// Kinetic energy of the particles, J, of the whole body.
    pub kinetic: f64,
    /// |Residual| and the numerical terms over the energy turned over; 0 before there is any.
    pub residual: f64,
    pub numerical: f64,
    /// Wall time since the loop's start, with that of earlier parts of a run that was resumed.
    pub elapsed: Duration,
}

impl Progress {
    /// Share of the simulated time that is done, 0 to 1.
    pub fn share(&self) -> f64 {
        if self.end > 0.0 {
            (self.time / self.end).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }

    /// Wall time that is left at this pace; none before there is a pace.
    pub fn left(&self) -> Option<Duration> {
        let seconds = self.elapsed.as_secs_f64() * (1.0 - self.share()) / self.share();
        Duration::try_from_secs_f64(seconds).ok()
    }
}

/// Someone who watches a run.
pub trait Observer {
    /// The folder is ready and the first step about to be made. `notes` are what a user should
    /// know: of the scene, and that an earlier run was replaced.
    fn begin(&mut self, sim: &Simulation, folder: &Folder, notes: &[String]);
    /// Called a few times a second.
    fn progress(&mut self, progress: &Progress);
    /// After the last step.
    fn end(&mut self);
}

/// Watches nothing.
impl Observer for () {
    fn begin(&mut self, _: &Simulation, _: &Folder, _: &[String]) {}
    fn progress(&mut self, _: &Progress) {}
    fn end(&mut self) {}
}

/// A run that has come to an end.
#[derive(Debug)]
pub struct Outcome {
    pub folder: Folder,
    pub summary: Summary,
    /// At the end.
    pub energies: Energies,
    /// The guard that stopped it, if one did.
    pub stopped: Option<Stop>,
    /// The signal that interrupted it, if one did: there is a checkpoint, but no summary yet.
    pub interrupted: Option<usize>,
    pub profile: Profile,
    /// Comparisons that could not be made, a sentence each.
    pub problems: Vec<String>,
}

/// Why there is no outcome.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum RunError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    #[error("the history has no column `{column}` that could be compared")]
    #[diagnostic(help("without [[compare]], `moldwarp check` lists the columns"))]
    NoSuchColumn { column: String },
    #[error("{} has one column; a reference has two, time and value", .file.display())]
    OneColumn { file: PathBuf },
    #[error("{} cannot serve as a reference: {problem}", .file.display())]
    Reference {
        file: PathBuf,
        problem: crate::output::compare::CompareError,
    },
    #[error(transparent)]
    #[diagnostic(help(
        "a reference is a table of numbers, time and value, under a header row such as `time,value`"
    ))]
    Csv(#[from] CsvError),
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Folder(#[from] FolderError),
    #[error("{} holds no run of moldwarp", .0.display())]
    #[diagnostic(help("name the folder that a run has written, the one with its run.log"))]
    NoRun(PathBuf),
    #[error("the run in {} is over", .0.display())]
    #[diagnostic(help(
        "run the scene again with what you want to change; `--from OUT@STAGE` begins with the end of one \
         of its stages"
    ))]
    Over(PathBuf),
    #[error("the run in {} is going on", .0.display())]
    #[diagnostic(help("wait for it, or interrupt it with Ctrl-C where it runs"))]
    AtWork(PathBuf),
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Checkpoint(#[from] CheckpointError),
    /// During the run.
    #[error(transparent)]
    File(#[from] FileError),
    /// The same where there is a checkpoint.
    #[error("{error}")]
    #[diagnostic(help(
        "make room for its files; then `moldwarp resume {}` goes on from step {step}",
        .folder.display()
    ))]
    Cut {
        error: FileError,
        folder: PathBuf,
        step: u64,
    },
}

impl RunError {
    /// Whether the input or the arguments are wrong, so that the run never began.
    pub fn is_input(&self) -> bool {
        !matches!(self, RunError::File(_) | RunError::Cut { .. })
    }
}

/// Computes a scene and writes its results. Nothing is created if the scene, a reference or the
/// folder is refused.
pub fn run(
    scene: Scene,
    options: &RunOptions,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let start = Instant::now();
    let path = match &options.out {
        Some(path) => path.clone(),
        None => Folder::default_path(&scene.case),
    };
    if let Some(earlier) = &scene.earlier {
        earlier.keep_from(&path)?;
    }
    let title = scene.plan.title.clone();
    let scene_hash = scene_hash(&scene.plan);
    let nodes = scene.plan.mesh.nodes.clone();
    let mut sim = simulation(scene.plan, &scene.origin, &scene.text)?;
    if let Some(simd) = options.simd {
        sim.use_simd(simd);
    }
    let columns = columns(&sim);
    let expected = Expected::read_all(&scene.compare, &columns)?;
    let (folder, replaced) = Folder::prepare(&path, &scene.folder, options.force)?;

    let mut notes = scene.notes;
    if replaced {
        notes.push(format!("the earlier run in {} is replaced", path.display()));
    }
    let mut log = Log::create(&folder.log(), start)?;
    log.is_alone();
    log.line(&format!("moldwarp {}", env!("CARGO_PKG_VERSION")))?;
    log.line(&format!("scene {scene_hash}, {} threads", options.threads))?;
    notes.iter().try_for_each(|note| log.line(note))?;
    for line in describe_quality(sim.mesh(), &scene.element_tags) {
        log.line(&format!("mesh: {line}"))?;
    }
    write_whole(&folder.scene(), |out| out.write_all(scene.text.as_bytes()))?;
    let beginning = Beginning {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        case: scene.case,
        text: scene.text,
        from: scene.earlier.map(|earlier| earlier.given),
        scene_hash,
        references: Expected::references(&expected),
    };
    let interval = scene.output.checkpoints;
    let checkpoints = Checkpoints::new(&folder, (&beginning, nodes), 0, interval, start);
    let end = end_time(&sim);
    let books = Books {
        recorder: Recorder::new(&scene.output, end, &folder, &columns, expected)?,
        log,
        course: Course::default(),
        checkpoints,
    };
    observer.begin(&sim, &folder, &notes);
    let about = (beginning, title, columns);
    conclude(sim, books, about, &folder, options, observer)
}

/// Makes the steps that are left and what comes after them.
fn conclude(
    mut sim: Simulation,
    mut books: Books,
    (beginning, title, columns): (Beginning, String, Vec<(String, String)>),
    folder: &Folder,
    options: &RunOptions,
    observer: &mut dyn Observer,
) -> Result<Outcome, RunError> {
    let ended = steps(&mut sim, &mut books, &options.interrupt, observer);
    observer.end();
    let ended = ended.map_err(|error| match books.checkpoints.last_step() {
        Some(step) => RunError::Cut {
            error,
            folder: folder.path().to_owned(),
            step,
        },
        None => RunError::File(error),
    })?;
    let (stopped, interrupted) = match ended {
        Ended::Done => (None, None),
        Ended::Stopped(stop) => (Some(stop), None),
        Ended::Interrupted(signal) => (None, Some(signal)),
    };
    let (compare, problems) = books.recorder.compared();
    let exit = match (&stopped, interrupted) {
        (None, None) => "done".to_owned(),
        (Some(stop), _) => stop.to_string(),
        (None, Some(signal)) => format!("interrupted by signal {signal}"),
    };
    let (course, log) = (&books.course, &mut books.log);
    let summary = Summary {
        case: beginning.case,
        title,
        from: beginning.from,
        exit,
        resumed_at: course.resumed_at.clone(),
        wall_time: course.earlier + books.checkpoints.elapsed(),
        compare,
        threads: options.threads,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        scene_hash: beginning.scene_hash,
        units: columns,
        ..computed(&sim, &course.pace)
    };
    log.line(&format!("{} at step {}", summary.exit, summary.steps))?;
    for warning in &summary.warnings {
        log.line(&format!("warning: {warning}"))?;
    }
    if interrupted.is_none() {
        problems.iter().try_for_each(|problem| log.line(problem))?;
        summary.write(&folder.summary())?;
    }
    if summary.exit == "done" {
        folder.remove_checkpoints()?;
    }
    Ok(Outcome {
        folder: folder.clone(),
        summary,
        energies: whole::energies(&sim),
        stopped,
        interrupted,
        profile: sim.profile().clone(),
        problems,
    })
}

/// Everything that [`run`] asks of a scene before it makes its folder. Returns the columns of the
/// history.
pub fn verify(scene: Scene) -> Result<Vec<String>, RunError> {
    let sim = simulation(scene.plan, &scene.origin, &scene.text)?;
    let columns = columns(&sim);
    Expected::read_all(&scene.compare, &columns)?;
    Ok(columns.into_iter().map(|(name, _)| name).collect())
}

/// The simulation, or what keeps it from being set up in the words of the scene.
pub(crate) fn simulation(
    plan: Plan,
    origin: &Origin,
    text: &str,
) -> Result<Simulation, SceneError> {
    Simulation::new(plan).map_err(|error| origin.explain(error, text))
}

/// The part of the summary that the simulation and its pace tell.
fn computed(sim: &Simulation, pace: &Pace) -> Summary {
    let names = Energies::NAMES.map(str::to_owned).into_iter();
    let projections = sim.projections();
    Summary {
        particles: sim.particles().len(),
        elements: sim.mesh().tets.len(),
        mass: whole::mass(sim),
        steps: sim.steps(),
        time: sim.time(),
        particle_steps_per_second: pace.rate(),
        min_dt: pace.bounds.map(|b| b[0]),
        max_dt: pace.bounds.map(|b| b[1]),
        energy: names.zip(whole::energies(sim).values()).collect(),
        energy_turned_over: whole::energy_turned_over(sim),
        projections: Projected {
            count: projections.count,
            sum: projections.sum,
            greatest: projections.greatest,
            work: projections.work * whole::factor(sim),
        },
        foreign_particles: sim.foreign_particles(),
        lost_particles: sim.lost_particles(),
        outflow_particles: sim.outflown().particles,
        outflow_mass: sim.outflown().mass * whole::factor(sim),
        warnings: warnings::warnings(sim),
        state_hash: state_hash(sim),
        ..Summary::default()
    }
}
