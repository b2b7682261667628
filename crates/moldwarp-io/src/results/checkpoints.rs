//! What a checkpoint is of.

use super::{Results, ResultsError};
use crate::output::FileError;
use crate::run::checkpoint_facts;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// A checkpoint on disk.
#[derive(Clone, Debug, Serialize)]
pub struct CheckpointInfo {
    pub path: PathBuf,
    /// Of the file.
    pub bytes: u64,
    /// Simulated time, s.
    pub time: f64,
    pub step: u64,
    /// Number of stages that are over.
    pub stages_over: usize,
    pub case: String,
    /// Of moldwarp.
    pub version: String,
    pub scene_hash: String,
    /// Wall time of the run up to it, s.
    pub wall_time: f64,
    /// Checkpoints of a run count from 0.
    pub generation: u64,
}

/// Reads a checkpoint, all of which is checked against its checksums.
///
/// # Errors
///
/// If it cannot be read or is damaged.
pub fn checkpoint(path: &Path) -> Result<CheckpointInfo, ResultsError> {
    let bytes = std::fs::read(path).map_err(FileError::at("read", path))?;
    let length = bytes.len() as u64;
    let facts = checkpoint_facts(bytes)?;
    Ok(CheckpointInfo {
        path: path.to_owned(),
        bytes: length,
        time: facts.time,
        step: facts.step,
        stages_over: facts.stages_over,
        case: facts.case,
        version: facts.version,
        scene_hash: facts.scene_hash,
        wall_time: facts.wall_time,
        generation: facts.generation,
    })
}

impl Results {
    /// The checkpoints there are, the newest first, and what is wrong with those that cannot be used.
    pub fn checkpoints(&self) -> (Vec<CheckpointInfo>, Vec<String>) {
        let (mut found, mut problems) = (Vec::new(), Vec::new());
        for path in [0, 1].map(|generation| self.folder.checkpoint(generation)) {
            if !path.exists() {
                continue;
            }
            match checkpoint(&path) {
                Ok(info) => found.push(info),
                Err(error) => problems.push(format!("{} cannot be used: {error}", path.display())),
            }
        }
        found.sort_by_key(|info| std::cmp::Reverse(info.generation));
        (found, problems)
    }
}
