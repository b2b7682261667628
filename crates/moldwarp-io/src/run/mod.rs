//! A run: from a checked scene to its folder of results.

mod frames;
mod history;
mod log;
mod recorder;
mod schedule;
mod stage_files;
mod state;
mod whole;

pub use state::state_hash;

pub(crate) use frames::frame_bytes;
#[cfg(test)]
pub(crate) use frames::{Field, NODE_FIELDS, PARTICLE_FIELDS};
#[cfg(test)]
pub(crate) use history::FIRST;
pub(crate) use history::{Expected, columns};
pub(crate) use stage_files::StageFile;
pub(crate) use whole::factor as whole_factor;

use crate::mesh::describe_quality;
use crate::output::csv::CsvError;
use crate::output::hash::scene_hash;
use crate::output::{FileError, Folder, FolderError, Projected, Summary, write_whole};
use crate::scene::{Origin, Scene, SceneError};
use log::Log;
use moldwarp::measure::{Energies, Profile};
use moldwarp::plan::Until;
use moldwarp::{Plan, Simd, Simulation, Stop};
use recorder::Recorder;
use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

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
}

/// How far a run is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Simulated time, s.
    pub time: f64,
    /// When it will end, s; an estimate where a stage is given in steps.
    pub end: f64,
    pub step: u64,
    /// The last step, s.
    pub time_step: f64,
    /// Particles times steps per second of the step loop.
    pub rate: f64,
    /// Wall time since the loop's start.
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
    /// During the run.
    #[error(transparent)]
    File(#[from] FileError),
}

impl RunError {
    /// Whether the input or the arguments are wrong, so that the run never began.
    pub fn is_input(&self) -> bool {
        !matches!(self, RunError::File(_))
    }
}

/// Observers are called this often.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);

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
    log.line(&format!("moldwarp {}", env!("CARGO_PKG_VERSION")))?;
    log.line(&format!("scene {scene_hash}, {} threads", options.threads))?;
    notes.iter().try_for_each(|note| log.line(note))?;
    for line in describe_quality(sim.mesh(), &scene.element_tags) {
        log.line(&format!("mesh: {line}"))?;
    }
    write_whole(&folder.scene(), |out| out.write_all(scene.text.as_bytes()))?;
    let end = end_time(&sim);
    let mut recorder = Recorder::new(&scene.output, end, &folder, &columns, expected)?;
    let mut pace = Pace::default();
    observer.begin(&sim, &folder, &notes);
    let stopped = steps(&mut sim, &mut recorder, &mut log, &mut pace, observer);
    observer.end();
    let stopped = stopped?;

    let (compare, problems) = recorder.compared();
    problems.iter().try_for_each(|problem| log.line(problem))?;
    let summary = Summary {
        case: scene.case,
        title,
        from: scene.earlier.map(|earlier| earlier.given),
        exit: stopped.as_ref().map_or("done".into(), Stop::to_string),
        wall_time: start.elapsed().as_secs_f64(),
        compare,
        threads: options.threads,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        scene_hash,
        units: columns,
        ..computed(&sim, &pace)
    };
    log.line(&format!("{} at step {}", summary.exit, summary.steps))?;
    summary.write(&folder.summary())?;
    Ok(Outcome {
        folder,
        summary,
        energies: whole::energies(&sim),
        stopped,
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
        state_hash: state_hash(sim),
        ..Summary::default()
    }
}

/// The step loop. A guard that stops it is no error: what was computed until then is kept.
fn steps(
    sim: &mut Simulation,
    recorder: &mut Recorder,
    log: &mut Log,
    pace: &mut Pace,
    observer: &mut dyn Observer,
) -> Result<Option<Stop>, FileError> {
    let start = Instant::now();
    let mut shown = start;
    let mut stage = None;
    recorder.record(sim)?;
    while !sim.finished() {
        if stage != Some(sim.stage()) {
            stage = Some(sim.stage());
            let name = &sim.plan().stages[sim.stage()].name;
            log.line(&format!("stage `{name}` begins at {} s", sim.time()))?;
        }
        let begun = Instant::now();
        let particles = sim.particles().len();
        let mut stage_file = Ok(());
        let step = sim.step_and(|sim| stage_file = stage_files::write(sim, recorder.folder()));
        let now = Instant::now();
        stage_file?;
        if let Err(stop) = step {
            recorder.record_last(sim)?;
            return Ok(Some(stop));
        }
        pace.add(now - begun, particles, sim.time_step());
        recorder.record(sim)?;
        if now - shown >= PROGRESS_INTERVAL {
            shown = now;
            observer.progress(&Progress {
                time: sim.time(),
                end: end_time(sim),
                step: sim.steps(),
                time_step: sim.time_step(),
                rate: pace.rate(),
                elapsed: now - start,
            });
        }
    }
    recorder.record_last(sim)?;
    Ok(None)
}

/// When the run will end, s; stages given in steps are taken to go on with the coming step.
pub(crate) fn end_time(sim: &Simulation) -> f64 {
    let left = sim.plan().stages.iter().enumerate().skip(sim.stage());
    left.fold(sim.time(), |end, (number, stage)| {
        let whole = match stage.until {
            Until::Duration(duration)
            | Until::Equilibrium {
                limit: duration, ..
            } => duration,
            Until::Steps(steps) => steps as f64 * sim.next_time_step(),
        };
        let done = if number == sim.stage() {
            sim.stage_time()
        } else {
            0.0
        };
        end + (whole - done).max(0.0)
    })
}

/// What the step loop has done.
#[derive(Debug, Default)]
struct Pace {
    particle_steps: f64,
    seconds: f64,
    /// Least and greatest step, s.
    bounds: Option<[f64; 2]>,
}

impl Pace {
    fn add(&mut self, spent: Duration, particles: usize, time_step: f64) {
        self.particle_steps += particles as f64;
        self.seconds += spent.as_secs_f64();
        let [low, high] = self.bounds.unwrap_or([time_step; 2]);
        self.bounds = Some([low.min(time_step), high.max(time_step)]);
    }

    fn rate(&self) -> f64 {
        if self.seconds > 0.0 {
            self.particle_steps / self.seconds
        } else {
            0.0
        }
    }
}
