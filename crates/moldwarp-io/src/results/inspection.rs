//! A run at a glance: what its files say, put together.

use super::{
    CheckpointInfo, FieldRange, History, Results, ResultsError, StageInfo, State, field_ranges,
    frames,
};
use serde::Serialize;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A run at a glance. SI units; what is not known yet, or not any more, is none.
#[derive(Clone, Debug, Serialize)]
pub struct Inspection {
    pub folder: PathBuf,
    pub title: String,
    pub state: State,
    /// Why it is not done, in the words of the run.
    pub reason: Option<String>,
    /// Simulated, s.
    pub time: Option<f64>,
    pub steps: Option<u64>,
    pub scene_hash: Option<String>,
    pub stages: Vec<StageInfo>,
    /// Of the particles' frames, s.
    pub frame_times: Vec<f64>,
    pub rows: usize,
    pub columns: Vec<ColumnRange>,
    /// Number of frames that fields were looked at in, of the last ones.
    pub frames_seen: usize,
    pub fields: Vec<FieldRange>,
    /// At the end, or as far as the history goes, J, by kind.
    pub energy: Vec<(String, f64)>,
    pub checkpoints: Vec<CheckpointInfo>,
    /// What is wrong with checkpoints that cannot be used.
    pub checkpoint_problems: Vec<String>,
    /// `summary.json`, of a run that is over.
    pub summary: Option<Value>,
}

/// The range of a column of the history.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ColumnRange {
    pub name: String,
    pub unit: String,
    pub last: f64,
    pub least: f64,
    /// s.
    pub least_at: f64,
    pub greatest: f64,
    /// s.
    pub greatest_at: f64,
    /// Rows whose value is no finite number.
    pub not_finite: usize,
}

/// Puts together what a folder's files say; fields are looked for in the last frame, or in all.
///
/// # Errors
///
/// If there is no run, or a file of it cannot be read.
pub fn inspect(path: &Path, all_frames: bool) -> Result<Inspection, ResultsError> {
    let results = Results::open(path)?;
    // A run that is about to begin has no rows yet.
    let history = match results.folder.history().exists() {
        true => Some(results.history()?),
        false => None,
    };
    let last = |column: &str| history.as_ref()?.table.column(column)?.last().copied();
    let time = results.figure("time").or(last("time"));
    let steps = results.figure("steps").or(last("step")).map(|s| s as u64);
    let frames = frames(&results, "particles")?;
    let seen = match all_frames {
        true => &frames[..],
        false => &frames[frames.len().saturating_sub(1)..],
    };
    let (checkpoints, checkpoint_problems) = results.checkpoints();
    let energy = energies(&results, history.as_ref());
    let over = (results.state == State::Done).then_some(time).flatten();
    Ok(Inspection {
        folder: path.to_owned(),
        title: results.title().to_owned(),
        state: results.state,
        reason: results.reason.clone(),
        time,
        steps,
        scene_hash: results.scene_hash().map(str::to_owned),
        stages: results.stages(over),
        frame_times: frames.iter().map(|f| f.time).collect(),
        rows: history.as_ref().map_or(0, |h| h.table.columns[0].len()),
        columns: history.as_ref().map(columns).unwrap_or_default(),
        frames_seen: seen.len(),
        fields: field_ranges(seen.iter().map(|f| &*f.path))?,
        energy,
        checkpoints,
        checkpoint_problems,
        summary: results.summary,
    })
}

impl Inspection {
    /// A figure of the summary.
    pub fn figure(&self, key: &str) -> Option<f64> {
        self.summary.as_ref()?.get(key)?.as_f64()
    }

    /// A text of the summary.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.summary.as_ref()?.get(key)?.as_str()
    }
}

fn energies(results: &Results, history: Option<&History>) -> Vec<(String, f64)> {
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let in_summary = results
        .summary
        .as_ref()
        .and_then(|s| s["energy"].as_object());
    if let (Some(energies), Some(history)) = (in_summary, history) {
        // In the order of the history; an object has none.
        let kinds = history
            .table
            .names
            .iter()
            .filter_map(|n| n.strip_prefix("energy."));
        let known = kinds.filter_map(|kind| Some((kind.to_owned(), number(energies.get(kind)?))));
        return known.collect();
    }
    let columns = history.map(|h| h.table.names.iter().zip(&h.table.columns));
    let energy = |(name, values): (&String, &Vec<f64>)| {
        Some((name.strip_prefix("energy.")?.to_owned(), *values.last()?))
    };
    columns.into_iter().flatten().filter_map(energy).collect()
}

/// What tells when a row was written, rather than what was found.
const CLOCK: [&str; 4] = ["time", "stage", "stage_time", "step"];

fn columns(history: &History) -> Vec<ColumnRange> {
    let table = &history.table;
    let times = table.column("time").unwrap_or_default();
    let named = table.names.iter().zip(&table.columns).zip(&history.units);
    let measured = named.filter(|((name, _), _)| !CLOCK.contains(&&name[..]));
    let range = |((name, values), unit): ((&String, &Vec<f64>), &String)| {
        let finite = || values.iter().zip(times).filter(|v| v.0.is_finite());
        // Where no value is finite, the last one says what they are.
        let only = (values.last()?, times.last()?);
        let least = finite().min_by(|a, b| a.0.total_cmp(b.0)).unwrap_or(only);
        // The first of equals.
        let greatest = finite()
            .rev()
            .max_by(|a, b| a.0.total_cmp(b.0))
            .unwrap_or(only);
        Some(ColumnRange {
            name: name.clone(),
            unit: unit.clone(),
            last: *values.last()?,
            least: *least.0,
            least_at: *least.1,
            greatest: *greatest.0,
            greatest_at: *greatest.1,
            not_finite: values.len() - finite().count(),
        })
    };
    measured.filter_map(range).collect()
}
