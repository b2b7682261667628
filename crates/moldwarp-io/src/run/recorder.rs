//! What is written during a run, and when.

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

    /// Writes what is due now.
    pub fn record(&mut self, sim: &Simulation) -> Result<(), FileError> {
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
        self.frames.write(sim)
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
fn schedule(every: Every, end: f64) -> Option<Schedule> {
    match every {
        Every::Count(0) => None,
        Every::Count(count) => Some(Schedule::every(end / f64::from(count))),
        Every::Interval(interval) => Some(Schedule::every(interval)),
    }
}
