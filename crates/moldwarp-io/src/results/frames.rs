//! The frames of a run.

use super::{Results, ResultsError};
use crate::output::FileError;
use std::path::PathBuf;

/// A frame on disk.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameEntry {
    /// s.
    pub time: f64,
    pub path: PathBuf,
}

/// The frames of a kind, `particles` or `mesh`, in order; none if the run wrote none.
///
/// # Errors
///
/// If the collection cannot be read.
pub fn frames(results: &Results, kind: &str) -> Result<Vec<FrameEntry>, ResultsError> {
    let path = results.folder.collection(kind);
    if !path.exists() {
        return Ok(Vec::new());
    }
    let text = std::fs::read_to_string(&path).map_err(FileError::at("read", &path))?;
    let attribute = |line: &str, name: &str| -> Option<String> {
        let (_, rest) = line.split_once(&format!(" {name}=\""))?;
        Some(rest.split('"').next()?.to_owned())
    };
    let entries = text.lines().filter(|line| line.starts_with("<DataSet "));
    let entry = |line: &str| {
        Some(FrameEntry {
            time: attribute(line, "timestep")?.parse().ok()?,
            path: results.folder.path().join(attribute(line, "file")?),
        })
    };
    let all: Option<Vec<FrameEntry>> = entries.map(entry).collect();
    all.ok_or_else(|| ResultsError::Damaged {
        path: path.clone(),
        reason: "a line of it names no time and file".to_owned(),
    })
}
