//! `run.log`: what happened, with the wall time since the start.

use crate::output::FileError;
use std::fs::{File, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A log that stands on the disk line by line.
#[derive(Debug)]
pub(crate) struct Log {
    path: PathBuf,
    file: File,
    start: Instant,
    /// Wall time that earlier processes have spent on the run.
    before: Duration,
}

impl Log {
    /// Empties or creates the file; times count from `start`.
    pub fn create(path: &Path, start: Instant) -> Result<Log, FileError> {
        Ok(Log {
            path: path.to_owned(),
            file: File::create(path).map_err(FileError::at("create", path))?,
            start,
            before: Duration::ZERO,
        })
    }

    /// Goes on with the file of an earlier process.
    pub fn resume(path: &Path, start: Instant) -> Result<Log, FileError> {
        let file = File::options().append(true).open(path);
        Ok(Log {
            path: path.to_owned(),
            file: file.map_err(FileError::at("go on with", path))?,
            start,
            before: Duration::ZERO,
        })
    }

    /// Times count from `before` earlier on.
    pub fn after(&mut self, before: Duration) {
        self.before = before;
    }

    /// Whether this process is the only one that writes the file; it is then until it ends. Where files
    /// cannot be locked it is taken for the only one.
    pub fn is_alone(&self) -> bool {
        !matches!(self.file.try_lock(), Err(TryLockError::WouldBlock))
    }

    /// Adds a line.
    pub fn line(&mut self, text: &str) -> Result<(), FileError> {
        let time = (self.before + self.start.elapsed()).as_secs_f64();
        let line = format!("{time:10.3} s  {text}\n");
        self.file
            .write_all(line.as_bytes())
            .map_err(FileError::at("write", &self.path))
    }
}
