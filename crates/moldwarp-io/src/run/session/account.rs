//! What a session tells as files of a run do: for its report.

use super::super::frames::write_frame;
use super::super::history::Expected;
use super::super::{computed, recorder};
use super::Session;
use super::reel::{Framed, Reel};
use crate::output::{FileError, Summary, csv};
use std::path::Path;

/// How a simulation that can go on has ended, in its summary.
pub(crate) const GOING_ON: &str = "not over";

impl Session {
    /// Keeps frames in an empty folder from now on, as often as the scene's `output` asks for them, and the
    /// state of now as the first one.
    ///
    /// # Errors
    ///
    /// If the first one cannot be written.
    pub fn keep_frames(&mut self, folder: &Path) -> Result<(), FileError> {
        let mut schedule = recorder::schedule(self.frames, self.end());
        if let Some(schedule) = &mut schedule {
            // The first one is written whatever the time is.
            schedule.due(self.sim.time());
        }
        let mut reel = Reel::new(folder, schedule)?;
        reel.record_last(&self.sim, self.sim.time());
        if let Some(fault) = reel.take_fault() {
            return Err(fault);
        }
        self.reel = Some(reel);
        Ok(())
    }

    /// Whether a frame could not be written.
    pub fn has_lost_a_frame(&self) -> bool {
        self.reel.as_ref().is_some_and(Reel::has_fault)
    }

    /// Why, once. The simulation is as sound as before, and the coming frames will be tried.
    pub fn lost_frame(&mut self) -> Option<FileError> {
        self.reel.as_mut()?.take_fault()
    }

    /// Particles times steps per second of wall time in the steps.
    pub fn rate(&self) -> f64 {
        self.pace.rate()
    }

    /// The summary as it stands, made with so many threads; the wall time is that of the steps.
    pub(crate) fn summary(&self, threads: usize) -> Summary {
        let exit = match &self.stopped {
            Some(reason) => reason.clone(),
            None if self.sim.finished() => "done".to_owned(),
            None => GOING_ON.to_owned(),
        };
        Summary {
            case: self.origin.case.clone(),
            title: self.sim.plan().title.clone(),
            from: self.origin.from.clone(),
            exit,
            wall_time: self.pace.seconds,
            compare: self.compared(),
            threads,
            version: self.origin.version.clone(),
            scene_hash: self.origin.scene_hash.clone(),
            units: self.columns.clone(),
            ..computed(&self.sim, &self.pace)
        }
    }

    /// Comparisons that can be made so far.
    fn compared(&self) -> Vec<crate::output::summary::Compared> {
        let references = self.origin.references.clone();
        let expected = Expected::again(&self.compare, &self.columns, references);
        let expected = expected.unwrap_or_default().into_iter();
        let compared = expected.map(|mut expected| {
            expected.see(&self.rows.columns);
            expected.compared()
        });
        compared.filter_map(Result::ok).collect()
    }

    /// Writes the history so far as a run does.
    pub(crate) fn write_history(&self, path: &Path) -> Result<(), FileError> {
        let names: Vec<&str> = self.columns.iter().map(|c| &c.0[..]).collect();
        let mut writer = csv::Writer::create(path, &names)?;
        let count = self.rows.columns.first().map_or(0, Vec::len);
        for number in 0..count {
            let row: Vec<f64> = self.rows.columns.iter().map(|c| c[number]).collect();
            writer.row(&row)?;
        }
        writer.finish()
    }

    /// The frames that were kept, and one of now, which is written into `folder` unless it is the last of
    /// them.
    pub(crate) fn frames(&self, folder: &Path) -> Result<Vec<Framed>, FileError> {
        let mut frames = Vec::new();
        if let Some(reel) = &self.reel {
            frames.extend_from_slice(reel.frames());
            if reel.is_of(self.sim.steps()) {
                return Ok(frames);
            }
        }
        let paths = ["particles.vtu", "mesh.vtu"].map(|name| folder.join(name));
        write_frame(&self.sim, self.sim.time(), &paths)?;
        frames.push((self.sim.time(), paths));
        Ok(frames)
    }
}
