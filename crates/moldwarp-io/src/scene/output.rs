//! What is written during the run, and what it is compared with.

use super::amount::Spanned;
use super::error::Fault;
use super::quantity::Dimension;
use super::raw::{RawAmount, RawCompare, RawOutput, Text};
use super::suggest;
use super::values::{at_most_one, count, positive, span};
use moldwarp::measure::Energies;
use moldwarp::plan::{Contact, Probe};
use std::path::{Path, PathBuf};

/// How often something is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Every {
    /// So many times, evenly over the run.
    Count(u32),
    /// Whenever so much time has passed, s.
    Interval(f64),
}

/// When results are written. It does not influence them.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputSettings {
    /// ParaView frames; a count of 0 is none.
    pub frames: Every,
    /// Rows of the history.
    pub history: Every,
    /// Wall time between checkpoints, s.
    pub checkpoints: f64,
}

impl Default for OutputSettings {
    fn default() -> OutputSettings {
        OutputSettings {
            frames: Every::Count(50),
            history: Every::Count(1000),
            checkpoints: 300.0,
        }
    }
}

/// A column of the history that is expected to run like the one in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Compare {
    /// Name of the history's column.
    pub column: String,
    /// CSV file of time (s) and value, under the scene's folder.
    pub file: PathBuf,
}

pub(super) fn output(raw: &RawOutput) -> Result<OutputSettings, Fault> {
    let default = OutputSettings::default();
    let frames = ("frames", &raw.frames, 0);
    let history = ("history", &raw.history, 1);
    Ok(OutputSettings {
        frames: every(
            frames,
            ("frame_interval", &raw.frame_interval),
            default.frames,
        )?,
        history: every(
            history,
            ("history_interval", &raw.history_interval),
            default.history,
        )?,
        checkpoints: match &raw.checkpoint_interval {
            Some(interval) => positive("checkpoint_interval", interval, Dimension::Time)?,
            None => default.checkpoints,
        },
    })
}

fn every(
    (key, number, least): (&str, &Option<Spanned<i64>>, u32),
    (interval_key, interval): (&str, &Option<RawAmount>),
    default: Every,
) -> Result<Every, Fault> {
    at_most_one(&[(key, span(number)), (interval_key, span(interval))])?;
    match (number, interval) {
        (Some(n), _) => u32::try_from(count(key, n, least)?)
            .map(Every::Count)
            .map_err(|_| Fault::new(format!("`{key}` is too large")).at(n.span(), "too many")),
        (None, Some(dt)) => Ok(Every::Interval(positive(
            interval_key,
            dt,
            Dimension::Time,
        )?)),
        (None, None) => Ok(default),
    }
}

/// `folder` is that of the scene; without one its files have been read before and are not looked for.
pub(super) fn compare(
    raw: &[RawCompare],
    (probes, contacts): (&[Probe], &[Contact]),
    folder: Option<&Path>,
) -> Result<Vec<Compare>, Fault> {
    let columns = columns(probes, contacts);
    raw.iter()
        .map(|raw| {
            check_column(&raw.column, &columns)?;
            let file = folder.unwrap_or(Path::new("")).join(raw.file.get_ref());
            if folder.is_some() && !file.is_file() {
                return Err(
                    Fault::new(format!("there is no file `{}`", raw.file.get_ref()))
                        .at(raw.file.span(), "no such file")
                        .help("paths are relative to the scene's folder"),
                );
            }
            Ok(Compare {
                column: raw.column.get_ref().clone(),
                file,
            })
        })
        .collect()
}

fn columns(probes: &[Probe], contacts: &[Contact]) -> Vec<String> {
    let mut columns = Vec::new();
    for probe in probes {
        for quantity in &probe.quantities {
            columns.extend(quantity.columns(&probe.name));
        }
    }
    columns.extend(contacts.iter().flat_map(Contact::columns).map(|c| c.0));
    columns.extend(Energies::NAMES.iter().map(|kind| format!("energy.{kind}")));
    columns
}

fn check_column(column: &Text, columns: &[String]) -> Result<(), Fault> {
    let name = column.get_ref();
    if columns.contains(name) {
        return Ok(());
    }
    let near = suggest::nearest(name, columns.iter().map(String::as_str));
    let help = match near {
        Some(near) => format!("did you mean `{near}`?"),
        None => "columns are `<probe>.<quantity>.<component>`, `contact.<name>.<what>` and `energy.<kind>`"
            .to_owned(),
    };
    Err(Fault::new(format!("the history has no column `{name}`"))
        .at(column.span(), "no such column")
        .help(help))
}
