//! A run: from a checked scene to its folder of results.

mod frames;
mod history;
mod log;
mod schedule;
mod state;

pub use state::state_hash;

pub(crate) use frames::frame_bytes;
pub(crate) use history::{Expected, columns};

use crate::output::csv::CsvError;
use crate::output::hash::scene_hash;
use crate::output::summary::Compared;
use crate::output::{FileError, Folder, FolderError, Summary, write_whole};
use crate::scene::{Every, Scene};
use frames::Frames;
use history::History;
use log::Log;
use moldwarp::measure::Energies;
use moldwarp::plan::Until;
use moldwarp::{SetupError, Simulation, Stop};
use schedule::Schedule;
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
    /// Comparisons that could not be made, a sentence each.
    pub problems: Vec<String>,
}

/// Why there is no outcome.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum RunError {
    #[error(transparent)]
    Setup(#[from] SetupError),
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
    let title = scene.plan.title.clone();
    let scene_hash = scene_hash(&scene.plan);
    let mut sim = Simulation::new(scene.plan)?;
    let columns = columns(&sim);
    let expected = Expected::read_all(&scene.compare, &columns)?;
    let path = match &options.out {
        Some(path) => path.clone(),
        None => Folder::default_path(&scene.case),
    };
    let (folder, replaced) = Folder::prepare(&path, &scene.folder, options.force)?;

    let mut notes = scene.notes;
    if replaced {
        notes.push(format!("the earlier run in {} is replaced", path.display()));
    }
    let mut log = Log::create(&folder.log(), start)?;
    log.line(&format!("moldwarp {}", env!("CARGO_PKG_VERSION")))?;
    log.line(&format!("scene {scene_hash}, {} threads", options.threads))?;
    for note in &notes {
        log.line(note)?;
    }
    write_whole(&folder.scene(), |out| out.write_all(scene.text.as_bytes()))?;
    let end = end_time(&sim);
    let mut recorder = Recorder {
        frame_schedule: schedule(scene.output.frames, end),
        history_schedule: schedule(scene.output.history, end),
        frames: Frames::new(&folder),
        history: History::create(&folder, &columns, expected)?,
        last: [None; 2],
    };
    observer.begin(&sim, &folder, &notes);
    let mut pace = Pace::default();
    let stopped = steps(&mut sim, &mut recorder, &mut log, &mut pace, observer)?;
    observer.end();

    let (compare, problems) = recorder.compared();
    for problem in &problems {
        log.line(problem)?;
    }
    let energies = sim.energies();
    let energy_names = Energies::NAMES.map(str::to_owned);
    let summary = Summary {
        case: scene.case,
        title,
        exit: stopped.as_ref().map_or("done".into(), Stop::to_string),
        particles: sim.particles().len(),
        elements: sim.mesh().tets.len(),
        steps: sim.steps(),
        time: sim.time(),
        wall_time: start.elapsed().as_secs_f64(),
        particle_steps_per_second: pace.rate(),
        min_dt: pace.bounds.map(|b| b[0]),
        max_dt: pace.bounds.map(|b| b[1]),
        energy: energy_names.into_iter().zip(energies.values()).collect(),
        energy_turned_over: sim.energy_turned_over(),
        compare,
        threads: options.threads,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        scene_hash,
        state_hash: state_hash(&sim),
        units: columns,
    };
    log.line(&format!("{} at step {}", summary.exit, summary.steps))?;
    summary.write(&folder.summary())?;
    Ok(Outcome {
        folder,
        summary,
        energies,
        stopped,
        problems,
    })
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
        let step = sim.step();
        let now = Instant::now();
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
            Until::Duration(duration) => duration,
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

/// Output times of a run that ends at `end`, s; none if no output is wanted.
fn schedule(every: Every, end: f64) -> Option<Schedule> {
    match every {
        Every::Count(0) => None,
        Every::Count(count) => Some(Schedule::every(end / f64::from(count))),
        Every::Interval(interval) => Some(Schedule::every(interval)),
    }
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

/// Frames and history with their times.
struct Recorder {
    /// None: no frames at all.
    frame_schedule: Option<Schedule>,
    history_schedule: Option<Schedule>,
    frames: Frames,
    history: History,
    /// Steps made at the last frame and at the last row.
    last: [Option<u64>; 2],
}

impl Recorder {
    /// Writes what is due now.
    fn record(&mut self, sim: &Simulation) -> Result<(), FileError> {
        let due =
            |schedule: &mut Option<Schedule>| schedule.as_mut().is_some_and(|s| s.due(sim.time()));
        if due(&mut self.frame_schedule) {
            self.frame(sim)?;
        }
        if due(&mut self.history_schedule) {
            self.row(sim)?;
        }
        Ok(())
    }

    /// Writes the end, unless it is written already.
    fn record_last(&mut self, sim: &Simulation) -> Result<(), FileError> {
        if self.frame_schedule.is_some() && self.last[0] != Some(sim.steps()) {
            self.frame(sim)?;
        }
        if self.last[1] != Some(sim.steps()) {
            self.row(sim)?;
        }
        self.history.finish()
    }

    fn frame(&mut self, sim: &Simulation) -> Result<(), FileError> {
        self.last[0] = Some(sim.steps());
        self.frames.write(sim)
    }

    fn row(&mut self, sim: &Simulation) -> Result<(), FileError> {
        self.last[1] = Some(sim.steps());
        self.history.write(sim)
    }

    /// The comparisons, and those that could not be made.
    fn compared(&self) -> (Vec<Compared>, Vec<String>) {
        let mut done = Vec::new();
        let mut problems = Vec::new();
        for expected in &self.history.expected {
            match expected.compared() {
                Ok(compared) => done.push(compared),
                Err(problem) => problems.push(problem),
            }
        }
        (done, problems)
    }
}
