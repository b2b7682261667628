//! Frames that a session keeps while it is stepped, in a folder that it was told of.

use super::super::frames::write_frame;
use super::super::schedule::Schedule;
use crate::output::{FileError, Folder};
use moldwarp::Simulation;
use std::path::{Path, PathBuf};

/// A frame: its time, s, and the files of particles and mesh.
pub(crate) type Framed = (f64, [PathBuf; 2]);

/// The frames so far, and when the next one is due.
#[derive(Debug)]
pub(super) struct Reel {
    folder: PathBuf,
    /// None: the scene wants no frames.
    schedule: Option<Schedule>,
    frames: Vec<Framed>,
    /// Steps made at the last one.
    last: Option<u64>,
    /// Why the last one that was due is not there.
    fault: Option<FileError>,
}

impl Reel {
    /// Without a frame yet. `folder` is there and empty.
    pub fn new(folder: &Path, schedule: Option<Schedule>) -> Result<Reel, FileError> {
        let path = folder.join(Folder::frame("particles", 0));
        let path = path.parent().unwrap_or(folder);
        std::fs::create_dir_all(path).map_err(FileError::at("create", path))?;
        Ok(Reel {
            folder: folder.to_owned(),
            schedule,
            frames: Vec::new(),
            last: None,
            fault: None,
        })
    }

    /// Writes the frame that is due after a step.
    pub fn record(&mut self, sim: &Simulation) {
        let Some(schedule) = &mut self.schedule else {
            return;
        };
        if schedule.due(sim.time()) || sim.finished() {
            self.write(sim, sim.time());
        }
    }

    /// Writes the state in which the simulation has stopped, at `time`, s, unless it is written already.
    pub fn record_last(&mut self, sim: &Simulation, time: f64) {
        if self.schedule.is_some() && self.frames.last().is_none_or(|last| last.0 != time) {
            self.write(sim, time);
        }
    }

    /// The only frame again, after something was changed at the beginning.
    pub fn record_again(&mut self, sim: &Simulation) {
        self.frames.clear();
        self.record_last(sim, sim.time());
    }

    fn write(&mut self, sim: &Simulation, time: f64) {
        let number = self.frames.len();
        let paths = ["particles", "mesh"].map(|kind| self.folder.join(Folder::frame(kind, number)));
        match write_frame(sim, time, &paths) {
            Ok(()) => {
                self.last = Some(sim.steps());
                self.frames.push((time, paths));
            }
            Err(fault) => self.fault = Some(fault),
        }
    }

    pub fn frames(&self) -> &[Framed] {
        &self.frames
    }

    /// Whether the last frame is of the state after so many steps.
    pub fn is_of(&self, steps: u64) -> bool {
        self.last == Some(steps)
    }

    /// The last frame is not of the state any more, which was changed.
    pub fn was_changed(&mut self) {
        self.last = None;
    }

    pub fn has_fault(&self) -> bool {
        self.fault.is_some()
    }

    pub fn take_fault(&mut self) -> Option<FileError> {
        self.fault.take()
    }
}
