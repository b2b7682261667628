//! The step loop, and what is done beside the steps.

use super::checkpoint::{Checkpoints, Course};
use super::interrupt::Interrupt;
use super::log::Log;
use super::recorder::Recorder;
use super::{Observer, Progress, stage_files};
use crate::output::FileError;
use moldwarp::plan::Until;
use moldwarp::{Simulation, Stop};
use std::time::{Duration, Instant};

/// Observers are called this often.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);

/// How the step loop ended.
#[derive(Debug, PartialEq)]
pub(super) enum Ended {
    Done,
    /// A guard has stopped it.
    Stopped(Stop),
    /// By this signal; there is a checkpoint.
    Interrupted(usize),
}

/// What the step loop has done.
#[derive(Clone, Debug, Default)]
pub(super) struct Pace {
    particle_steps: f64,
    /// Wall time of the steps.
    pub seconds: f64,
    /// Least and greatest step, s.
    pub bounds: Option<[f64; 2]>,
}

moldwarp::saved!(Pace {
    particle_steps,
    seconds,
    bounds
});

impl Pace {
    pub fn add(&mut self, spent: Duration, particles: usize, time_step: f64) {
        self.particle_steps += particles as f64;
        self.seconds += spent.as_secs_f64();
        let [low, high] = self.bounds.unwrap_or([time_step; 2]);
        self.bounds = Some([low.min(time_step), high.max(time_step)]);
    }

    /// Particles times steps per second of wall time in the steps; what is written between them, and at the
    /// ends of stages, does not count.
    pub fn rate(&self) -> f64 {
        if self.seconds > 0.0 {
            self.particle_steps / self.seconds
        } else {
            0.0
        }
    }
}

/// Everything that a run writes while it goes on.
#[derive(Debug)]
pub(super) struct Books {
    pub recorder: Recorder,
    pub log: Log,
    pub course: Course,
    pub checkpoints: Checkpoints,
}

impl Books {
    fn checkpoint(&mut self, sim: &mut Simulation) -> Result<(), FileError> {
        sim.settle();
        self.checkpoints
            .write(sim, &self.course, &mut self.recorder)
    }

    fn stage_begins(&mut self, sim: &Simulation) -> Result<(), FileError> {
        match sim.plan().stages.get(sim.stage()) {
            Some(stage) => {
                let line = format!("stage `{}` begins at {} s", stage.name, sim.time());
                self.log.line(&line)
            }
            None => Ok(()),
        }
    }
}

/// The step loop. A guard that stops it is no error: what was computed until then is kept.
pub(super) fn steps(
    sim: &mut Simulation,
    books: &mut Books,
    interrupt: &Interrupt,
    observer: &mut dyn Observer,
) -> Result<Ended, FileError> {
    let start = Instant::now();
    let earlier = Duration::try_from_secs_f64(books.course.earlier).unwrap_or_default();
    let mut shown = start;
    // What is due at the beginning of a run that is resumed was recorded before its checkpoint.
    if books.course.resumed_at.is_empty() {
        books.stage_begins(sim)?;
        books.recorder.record(sim)?;
    }
    books.checkpoint(sim)?;
    sim.wrote_output();
    while !sim.finished() {
        if let Some(signal) = interrupt.asked() {
            books.checkpoint(sim)?;
            return Ok(Ended::Interrupted(signal));
        }
        let (begun, particles, stage) = (Instant::now(), sim.particle_count(), sim.stage());
        let (time, dt) = (sim.time(), sim.next_time_step());
        let (mut stage_file, mut writing) = (Ok(()), Duration::ZERO);
        let folder = books.recorder.folder();
        let step = sim.step_and(|sim| {
            let start = Instant::now();
            stage_file = stage_files::write(sim, folder);
            writing = start.elapsed();
        });
        let now = Instant::now();
        stage_file?;
        if let Err(stop) = step {
            sim.settle();
            match stop {
                Stop::NotAtRest { .. } => books.recorder.record_last(sim)?,
                _ => books.recorder.record_fault(sim, time, dt)?,
            }
            return Ok(Ended::Stopped(stop));
        }
        (books.course.pace).add(now - begun - writing, particles, sim.time_step());
        books.recorder.record(sim)?;
        if sim.stage() != stage {
            books.stage_begins(sim)?;
        }
        let due = sim.stage() != stage || books.checkpoints.due(now);
        if due && !sim.finished() {
            books.checkpoint(sim)?;
        }
        sim.wrote_output();
        if now - shown >= PROGRESS_INTERVAL {
            shown = now;
            observer.progress(&progress(sim, &books.course.pace, earlier + (now - start)));
        }
    }
    sim.settle();
    books.recorder.record_last(sim)?;
    Ok(Ended::Done)
}

fn progress(sim: &Simulation, pace: &Pace, elapsed: Duration) -> Progress {
    let stages = &sim.plan().stages;
    let number = sim.stage().min(stages.len() - 1);
    let energies = sim.energies();
    let turned_over = sim.energy_turned_over();
    let share = |energy: f64| {
        if turned_over > 0.0 {
            energy / turned_over
        } else {
            0.0
        }
    };
    let until_rest =
        |stage: &moldwarp::plan::Stage| matches!(stage.until, Until::Equilibrium { .. });
    Progress {
        stage: stages[number].name.clone(),
        stage_number: number,
        stages: stages.len(),
        may_end_earlier: stages[number..].iter().any(until_rest),
        time: sim.time(),
        end: end_time(sim),
        step: sim.steps(),
        time_step: sim.time_step(),
        rate: pace.rate(),
        kinetic: super::whole::energies(sim).kinetic,
        residual: share(energies.residual.abs()),
        numerical: share(energies.numerical()),
        elapsed,
    }
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
