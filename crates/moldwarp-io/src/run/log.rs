//! `run.log`: what happened, with the wall time since the start.

use crate::output::FileError;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// A log that stands on the disk line by line.
#[derive(Debug)]
pub(crate) struct Log {
    path: PathBuf,
    file: File,
    start: Instant,
}

impl Log {
    /// Empties or creates the file; times count from `start`.
    pub fn create(path: &Path, start: Instant) -> Result<Log, FileError> {
        Ok(Log {
            path: path.to_owned(),
            file: File::create(path).map_err(FileError::at("create", path))?,
            start,
        })
    }

    /// Adds a line.
    pub fn line(&mut self, text: &str) -> Result<(), FileError> {
        let line = format!("{:10.3} s  {text}\n", self.start.elapsed().as_secs_f64());
        self.file
            .write_all(line.as_bytes())
            .map_err(FileError::at("write", &self.path))
    }
}
