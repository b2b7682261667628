//! What a run has left in its folder, also one that goes on or did not come to its end. Nothing is
//! changed there.

mod checkpoints;
mod extremes;
mod frames;
mod inspection;
mod stages;

pub use checkpoints::{CheckpointInfo, checkpoint};
pub use extremes::{FieldRange, field_ranges};
pub use frames::{FrameEntry, frames};
pub use inspection::{ColumnRange, Inspection, inspect};
pub use stages::StageInfo;

use crate::output::csv::{self, CsvError};
use crate::output::vtu_read::VtuError;
use crate::output::{FileError, Folder};
use crate::run::{CheckpointError, unit_of_column};
use serde::Serialize;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// How a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum State {
    /// It came to its end.
    Done,
    /// A guard has stopped it, or a stage did not come to rest.
    Stopped,
    /// By Ctrl-C or SIGTERM; it can be resumed.
    Interrupted,
    /// It is going on in another process.
    AtWork,
    /// It ended without a word, as by a crash or a full disk.
    CutOff,
}

/// Why there are no results.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum ResultsError {
    #[error("there is no folder {}", .path.display())]
    #[diagnostic(help("{help}"))]
    Missing { path: PathBuf, help: String },
    #[error("{} holds no run of moldwarp", .path.display())]
    #[diagnostic(help("{help}"))]
    NoRun { path: PathBuf, help: String },
    #[error("{} is a file", .path.display())]
    #[diagnostic(help("{help}"))]
    NotAFolder { path: PathBuf, help: String },
    #[error("{} is not readable: {reason}", .path.display())]
    #[diagnostic(help("it was changed by hand or is damaged; run the scene again"))]
    Damaged { path: PathBuf, reason: String },
    #[error(transparent)]
    #[diagnostic(help(
        "a history that was changed since the run cannot be read; run the scene again"
    ))]
    Csv(#[from] CsvError),
    #[error(transparent)]
    Vtu(#[from] VtuError),
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    #[error(transparent)]
    File(#[from] FileError),
}

/// A history in memory.
#[derive(Clone, Debug)]
pub struct History {
    pub table: csv::Table,
    /// Of each column; empty for one without a unit.
    pub units: Vec<String>,
}

/// The folder of a run.
#[derive(Clone, Debug)]
pub struct Results {
    pub folder: Folder,
    pub state: State,
    /// Why it is not done, in the words of the run.
    pub reason: Option<String>,
    /// `summary.json`, of a run that is over.
    pub summary: Option<Value>,
    /// Lines of the log: wall time as written, and what happened.
    pub log: Vec<String>,
    scene: toml::Table,
}

impl Results {
    /// Looks at a folder.
    ///
    /// # Errors
    ///
    /// If it holds no run, or one whose files cannot be read.
    pub fn open(path: &Path) -> Result<Results, ResultsError> {
        if !path.exists() {
            return Err(missing(path));
        }
        if !path.is_dir() {
            return Err(not_a_folder(path));
        }
        if !Folder::is_a_run(path) {
            return Err(no_run(path));
        }
        let folder = Folder::resume(path);
        let log = read(&folder.log())?;
        let log: Vec<String> = log.lines().map(str::to_owned).collect();
        let summary = match folder.summary().exists() {
            true => Some(parsed(&folder.summary(), |text| {
                serde_json::from_str::<Value>(text).map_err(|e| e.to_string())
            })?),
            false => None,
        };
        let scene = parsed(&folder.scene(), |text| {
            text.parse::<toml::Table>()
                .map_err(|e| e.message().to_owned())
        })?;
        let (state, reason) = state(&folder, summary.as_ref(), &log)?;
        Ok(Results {
            folder,
            state,
            reason,
            summary,
            log,
            scene,
        })
    }

    /// The title of the scene.
    pub fn title(&self) -> &str {
        let title = self.scene.get("title").and_then(toml::Value::as_str);
        title.unwrap_or_default()
    }

    /// A figure of the summary; none before the run's end.
    pub fn figure(&self, key: &str) -> Option<f64> {
        self.summary.as_ref()?.get(key)?.as_f64()
    }

    /// A text of the summary; none before the run's end.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.summary.as_ref()?.get(key)?.as_str()
    }

    /// The fingerprint of the scene, from the summary or the log.
    pub fn scene_hash(&self) -> Option<&str> {
        let in_log = || {
            let lines = self
                .log
                .iter()
                .filter_map(|line| line.split_once(" s  scene "));
            lines.map(|(_, rest)| rest).next()?.split(',').next()
        };
        self.text("scene_hash").or_else(in_log)
    }

    /// The history as far as it is written.
    ///
    /// # Errors
    ///
    /// If it cannot be read.
    pub fn history(&self) -> Result<History, ResultsError> {
        let table = csv::read_growing(&self.folder.history())?;
        let written = self.summary.as_ref().map(|summary| &summary["units"]);
        let unit = |name: &String| {
            let written = written
                .and_then(|units| units.get(name))
                .and_then(Value::as_str);
            written
                .or_else(|| unit_of_column(name))
                .unwrap_or_default()
                .to_owned()
        };
        Ok(History {
            units: table.names.iter().map(unit).collect(),
            table,
        })
    }
}

/// How a run stands, and why it is not done.
fn state(
    folder: &Folder,
    summary: Option<&Value>,
    log: &[String],
) -> Result<(State, Option<String>), ResultsError> {
    if let Some(summary) = summary {
        let exit = summary["exit"]
            .as_str()
            .ok_or_else(|| ResultsError::Damaged {
                path: folder.summary(),
                reason: "it does not say how the run ended".to_owned(),
            })?;
        return Ok(match exit {
            "done" => (State::Done, None),
            why => (State::Stopped, Some(why.to_owned())),
        });
    }
    let file = std::fs::File::open(folder.log()).map_err(FileError::at("read", &folder.log()))?;
    // The run holds its log as long as it goes on.
    if let Err(std::fs::TryLockError::WouldBlock) = file.try_lock_shared() {
        return Ok((State::AtWork, None));
    }
    // Warnings follow what has ended a run.
    let said = log.iter().rev().filter_map(|line| line.split_once(" s  "));
    let last = said
        .map(|line| line.1)
        .find(|line| !line.starts_with("warning: "));
    Ok(match last {
        Some(line) if line.starts_with("interrupted by ") => {
            (State::Interrupted, Some(line.to_owned()))
        }
        _ => (State::CutOff, None),
    })
}

fn read(path: &Path) -> Result<String, FileError> {
    std::fs::read_to_string(path).map_err(FileError::at("read", path))
}

fn parsed<T>(path: &Path, parse: impl Fn(&str) -> Result<T, String>) -> Result<T, ResultsError> {
    parse(&read(path)?).map_err(|reason| ResultsError::Damaged {
        path: path.to_owned(),
        reason,
    })
}

const NAME_THE_FOLDER: &str = "name the folder that a run has written, the one with its run.log";

/// The folder that was probably meant is one of those beside it.
fn missing(path: &Path) -> ResultsError {
    let parent = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let wrong = path.file_name().unwrap_or_default().to_string_lossy();
    let names = crate::output::folder::entries(parent).unwrap_or_default();
    let names: Vec<String> = names
        .into_iter()
        .filter(|name| Folder::is_a_run(&parent.join(name)))
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    let near = crate::scene::suggest::nearest(&wrong, names.iter().map(String::as_str));
    ResultsError::Missing {
        path: path.to_owned(),
        help: match near {
            Some(near) => format!("did you mean `{}`?", path.with_file_name(near).display()),
            None => NAME_THE_FOLDER.to_owned(),
        },
    }
}

fn not_a_folder(path: &Path) -> ResultsError {
    let folder = path.ancestors().skip(1).find(|p| Folder::is_a_run(p));
    ResultsError::NotAFolder {
        path: path.to_owned(),
        help: match folder {
            Some(run) => format!("it is of a run: name its folder, `{}`", run.display()),
            None => NAME_THE_FOLDER.to_owned(),
        },
    }
}

fn no_run(path: &Path) -> ResultsError {
    let below = crate::output::folder::entries(path).unwrap_or_default();
    let runs: Vec<String> = below
        .into_iter()
        .map(|name| path.join(name))
        .filter(|p| Folder::is_a_run(p) || crate::sweep::members(p).is_some())
        .map(|p| p.display().to_string())
        .collect();
    let within = path.ancestors().skip(1).find(|p| Folder::is_a_run(p));
    let help = match (&runs[..], within) {
        (_, Some(run)) => format!("it is of a run: name its folder, `{}`", run.display()),
        ([], _) if path.join("scene.toml").is_file() => format!(
            "it is the folder of a scene: `moldwarp run {0}` writes results, `moldwarp check {0}` tells \
             beforehand what a run would be",
            path.display()
        ),
        ([], _) => NAME_THE_FOLDER.to_owned(),
        (runs, _) => format!(
            "there are runs in it: {}",
            crate::scene::suggest::list(runs.iter().map(String::as_str))
        ),
    };
    ResultsError::NoRun {
        path: path.to_owned(),
        help,
    }
}
