//! What is written during a run, and when.

use super::RunError;
use super::frames::Frames;
use super::history::{Expected, History};
use super::schedule::Schedule;
use crate::output::summary::Compared;
use crate::output::{FileError, Folder};
use crate::scene::{Every, OutputSettings};
use moldwarp::Simulation;

/// Frames and history with their times.
#[derive(Debug)]
pub(super) struct Recorder {
    /// None: no frames at all.
    frame_schedule: Option<Schedule>,
    history_schedule: Option<Schedule>,
    frames: Frames,
    history: History,
    /// Steps made at the last frame and at the last row.
    last: [Option<u64>; 2],
}

/// What a recorder has to remember to go on.
#[derive(Debug)]
pub(super) struct Recorded {
    frame_schedule: Option<Schedule>,
    history_schedule: Option<Schedule>,
    /// Times of the frames, s.
    frames: Vec<f64>,
    /// Length of the history in bytes.
    history: u64,
    last: [Option<u64>; 2],
}

moldwarp::saved!(Recorded {
    frame_schedule,
    history_schedule,
    frames,
    history,
    last,
});

impl Recorder {
    /// Gets the files going for a run that ends at `end`, s.
    pub fn new(
        output: &OutputSettings,
        end: f64,
        folder: &Folder,
        columns: &[(String, String)],
        expected: Vec<Expected>,
    ) -> Result<Recorder, FileError> {
        Ok(Recorder {
            frame_schedule: schedule(output.frames, end),
            history_schedule: schedule(output.history, end),
            frames: Frames::new(folder),
            history: History::create(folder, columns, expected)?,
            last: [None; 2],
        })
    }

    /// Goes on from what was recorded; all that was written later is cut off. `changed` are other
    /// settings than before of frames and history, from now on, for a run that now ends at `end`, s.
    pub fn resume(
        recorded: Recorded,
        changed: [Option<Every>; 2],
        (now, end): (f64, f64),
        folder: &Folder,
        columns: &[(String, String)],
        expected: Vec<Expected>,
    ) -> Result<Recorder, RunError> {
        let go_on = |before: Option<Schedule>, changed: Option<Every>| match changed {
            None => before,
            Some(every) => {
                let mut new = schedule(every, end);
                if let Some(new) = &mut new {
                    new.due(now);
                }
                new
            }
        };
        Ok(Recorder {
            frame_schedule: go_on(recorded.frame_schedule, changed[0]),
            history_schedule: go_on(recorded.history_schedule, changed[1]),
            frames: Frames::resume(folder, &recorded.frames)?,
            history: History::resume(folder, columns, expected, recorded.history)?,
            last: recorded.last,
        })
    }

    /// Brings frames and history to the disk, and says how to go on from here.
    pub fn recorded(&mut self) -> Result<Recorded, FileError> {
        self.frames.sync()?;
        Ok(Recorded {
            frame_schedule: self.frame_schedule,
            history_schedule: self.history_schedule,
            frames: self.frames.times(),
            history: self.history.sync()?,
            last: self.last,
        })
    }

    /// Writes what is due now.
    pub fn record(&mut self, sim: &mut Simulation) -> Result<(), FileError> {
        let due =
            |schedule: &mut Option<Schedule>| schedule.as_mut().is_some_and(|s| s.due(sim.time()));
        let (frame, row) = (
            due(&mut self.frame_schedule),
            due(&mut self.history_schedule),
        );
        if frame || row {
            sim.settle();
        }
        if frame {
            self.frame(sim)?;
        }
        if row {
            self.row(sim)?;
        }
        Ok(())
    }

    /// Writes the state in which a step has stopped that began at `begun`, s, and was to take `step`, s.
    /// Where the clock has not gone on, positions and stresses have.
    pub fn record_fault(
        &mut self,
        sim: &Simulation,
        begun: f64,
        step: f64,
    ) -> Result<(), FileError> {
        if self.frame_schedule.is_some() {
            let time = if sim.time() > begun {
                sim.time()
            } else {
                begun + step
            };
            self.frames.write(sim, time)?;
        }
        if self.last[1] != Some(sim.steps()) {
            self.row(sim)?;
        }
        self.history.finish()
    }

    /// Writes the end, unless it is written already.
    pub fn record_last(&mut self, sim: &Simulation) -> Result<(), FileError> {
        if self.frame_schedule.is_some() && self.last[0] != Some(sim.steps()) {
            self.frame(sim)?;
        }
        if self.last[1] != Some(sim.steps()) {
            self.row(sim)?;
        }
        self.history.finish()
    }

    pub fn folder(&self) -> &Folder {
        self.frames.folder()
    }

    fn frame(&mut self, sim: &Simulation) -> Result<(), FileError> {
        self.last[0] = Some(sim.steps());
        self.frames.write(sim, sim.time())
    }

    fn row(&mut self, sim: &Simulation) -> Result<(), FileError> {
        self.last[1] = Some(sim.steps());
        self.history.write(sim)
    }

    /// The comparisons, and those that could not be made.
    pub fn compared(&self) -> (Vec<Compared>, Vec<String>) {
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

/// Output times of a run that ends at `end`, s; none if no output is wanted.
pub(super) fn schedule(every: Every, end: f64) -> Option<Schedule> {
    match every {
        Every::Count(0) => None,
        Every::Count(count) => Some(Schedule::every(end / f64::from(count))),
        Every::Interval(interval) => Some(Schedule::every(interval)),
    }
}
