//! Plots of the histories of runs.

use super::select::{SelectError, select};
use super::units::{self, Unit};
use super::{Curve, Plot};
use crate::output::csv::{self, CsvError};
use crate::results::{History, ResultsError};
use crate::run::unit_of_column;
use std::path::PathBuf;

/// A run that is to be shown.
#[derive(Clone, Debug)]
pub struct ShownRun {
    /// What it is called in the legend.
    pub label: String,
    pub history: History,
}

/// A table that is drawn beside the runs: its first column over the horizontal axis, the second over the
/// vertical one, both in SI units.
#[derive(Clone, Debug)]
pub struct Reference {
    pub label: String,
    pub file: PathBuf,
}

/// What is to be shown.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    pub runs: Vec<ShownRun>,
    /// Columns, see [`SelectError`] and the book.
    pub what: Vec<String>,
    /// Column of the horizontal axis.
    pub against: String,
    pub references: Vec<Reference>,
    /// Units of the axes; those that suit the values if not given.
    pub x_unit: Option<String>,
    pub y_unit: Option<String>,
    /// Ends of the axes, each a number in SI units or with a unit; those of the values if not given.
    pub x_range: Option<[String; 2]>,
    pub y_range: Option<[String; 2]>,
}

/// Why there is no plot.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum HistoriesError {
    #[error("{run}: {error}")]
    #[diagnostic(help("{}", help_of(.error)))]
    Select { run: String, error: SelectError },
    #[error("`{several}` are several columns; a plot has one horizontal axis")]
    #[diagnostic(help("name one of them: {list}"))]
    Against { several: String, list: String },
    #[error("columns of different units cannot share an axis: {list}")]
    #[diagnostic(help("make a plot of each"))]
    Units { list: String },
    #[error("`{name}` is no unit for {si}")]
    #[diagnostic(help("{help}"))]
    Unit {
        name: String,
        si: String,
        help: String,
    },
    #[error("{text} is no range of an axis{problem}")]
    #[diagnostic(help(
        "give both ends, in SI units or with units that the axis can have: {example}"
    ))]
    Range {
        text: String,
        problem: &'static str,
        example: String,
    },
    #[error("{} has one column; a reference has two, such as time and value", .0.display())]
    OneColumn(PathBuf),
    #[error(transparent)]
    #[diagnostic(help(
        "a reference is a table of numbers in SI units under a header row such as `time,value`"
    ))]
    Reference(#[from] CsvError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Results(#[from] ResultsError),
}

fn help_of(error: &SelectError) -> String {
    use miette::Diagnostic;
    error
        .help()
        .map(|help| help.to_string())
        .unwrap_or_default()
}

/// A curve in SI units before it is scaled.
struct Raw {
    column: String,
    run: usize,
    points: Vec<(f64, f64)>,
}

/// The plot of histories; title, ranges and look are left to the caller.
///
/// # Errors
///
/// If a column is not there, or what is to be shown does not go together.
pub fn histories(shown: &Shown) -> Result<Plot, HistoriesError> {
    let mut raw = Vec::new();
    let mut sets: Vec<(String, String)> = Vec::new();
    for (number, run) in shown.runs.iter().enumerate() {
        let names = &run.history.table.names;
        let failed = |error| HistoriesError::Select {
            run: run.label.clone(),
            error,
        };
        let across = select(std::slice::from_ref(&shown.against), names).map_err(failed)?;
        let &[across] = &across[..] else {
            let list = across.iter().map(|&at| names[at].as_str());
            return Err(HistoriesError::Against {
                several: shown.against.clone(),
                list: crate::scene::suggest::list(list),
            });
        };
        let of = |at: usize| run.history.table.columns[at].iter().copied();
        for column in select(&shown.what, names).map_err(failed)? {
            sets.push((names[column].clone(), run.history.units[column].clone()));
            raw.push(Raw {
                column: names[column].clone(),
                run: number,
                points: of(across).zip(of(column)).collect(),
            });
        }
    }
    leave_zeros_out(&mut raw, &mut sets, &shown.what);
    let x_si = si_unit(&shown.against, shown);
    let y_si = common_unit(&sets)?;
    let references = references(&shown.references)?;
    let all = || {
        raw.iter()
            .map(|r| &r.points)
            .chain(references.iter().map(|r| &r.1))
    };
    let greatest = |value: fn(&(f64, f64)) -> f64| {
        let finite = all().flatten().map(value).filter(|v| v.is_finite());
        finite.fold(0.0, |g: f64, v| g.max(v.abs()))
    };
    let x_unit = unit(&x_si, &shown.x_unit, greatest(|p| p.0))?;
    let y_unit = unit(&y_si, &shown.y_unit, greatest(|p| p.1))?;
    let scaled = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
        let scale = |p: &(f64, f64)| (p.0 * x_unit.factor, p.1 * y_unit.factor);
        points.iter().map(scale).collect()
    };
    let mut plot = Plot {
        x: labelled(&spoken(&shown.against), &x_unit),
        y: labelled(&common_name(&raw), &y_unit),
        x_range: range(&shown.x_range, &x_si, &x_unit)?,
        y_range: range(&shown.y_range, &y_si, &y_unit)?,
        ..Plot::default()
    };
    let columns = distinct(raw.iter().map(|r| r.column.as_str()));
    for r in &raw {
        let column = columns
            .iter()
            .position(|c| *c == r.column)
            .unwrap_or_default();
        let (several_runs, several_columns) = (shown.runs.len() > 1, columns.len() > 1);
        let run = &shown.runs[r.run].label;
        let label = match (several_runs, several_columns) {
            (false, false) if references.is_empty() => String::new(),
            (true, true) => format!("{run}: {}", in_legend(&r.column, &columns)),
            (false, true) => in_legend(&r.column, &columns),
            _ => run.clone(),
        };
        let style = r.run * columns.len() + column;
        plot.curves
            .push(Curve::new(label, scaled(&r.points), style));
    }
    for (style, (label, points)) in references.iter().enumerate() {
        plot.curves
            .push(Curve::reference(label, scaled(points), style));
    }
    Ok(plot)
}

/// Columns that are zero throughout in all runs are not wanted by whoever has named only the beginning of
/// their names: of all energies, say, those that a scene does not have.
fn leave_zeros_out(raw: &mut Vec<Raw>, sets: &mut Vec<(String, String)>, what: &[String]) {
    let named: Vec<&str> = what
        .iter()
        .flat_map(|entry| entry.split(','))
        .map(str::trim)
        .collect();
    let has_values = |column: &str| {
        let own = raw.iter().filter(|r| r.column == column);
        own.flat_map(|r| &r.points).any(|p| p.1 != 0.0)
    };
    let kept = |column: &str| named.contains(&column) || has_values(column);
    let kept: Vec<String> = sets
        .iter()
        .map(|s| s.0.clone())
        .filter(|c| kept(c))
        .collect();
    if !kept.is_empty() {
        raw.retain(|r| kept.contains(&r.column));
        sets.retain(|s| kept.contains(&s.0));
    }
}

/// A reference's label and its points.
type Labelled = (String, Vec<(f64, f64)>);

fn references(wanted: &[Reference]) -> Result<Vec<Labelled>, HistoriesError> {
    let read = |reference: &Reference| {
        let table = csv::read(&reference.file)?;
        let [x, y, ..] = &table.columns[..] else {
            return Err(HistoriesError::OneColumn(reference.file.clone()));
        };
        let points = x.iter().copied().zip(y.iter().copied()).collect();
        Ok((reference.label.clone(), points))
    };
    wanted.iter().map(read).collect()
}

fn si_unit(column: &str, shown: &Shown) -> String {
    let of_run = shown.runs.iter().find_map(|run| {
        let at = run.history.table.names.iter().position(|n| n == column)?;
        Some(run.history.units[at].clone())
    });
    of_run.unwrap_or_else(|| unit_of_column(column).unwrap_or_default().to_owned())
}

/// The unit of all columns, each given with its own.
fn common_unit(columns: &[(String, String)]) -> Result<String, HistoriesError> {
    let units = distinct(columns.iter().map(|c| c.1.as_str()));
    if let [unit] = units[..] {
        return Ok(unit.to_owned());
    }
    let list = units.iter().map(|unit| {
        let names = distinct(
            columns
                .iter()
                .filter(|c| c.1 == *unit)
                .map(|c| c.0.as_str()),
        );
        let unit = if unit.is_empty() { "no unit" } else { unit };
        format!("{} ({unit})", crate::scene::suggest::list(names))
    });
    Err(HistoriesError::Units {
        list: list.collect::<Vec<_>>().join("; "),
    })
}

fn unit(si: &str, wanted: &Option<String>, greatest: f64) -> Result<Unit, HistoriesError> {
    let Some(name) = wanted else {
        return Ok(units::fitting(si, greatest));
    };
    units::named(si, name).map_err(|names| HistoriesError::Unit {
        name: name.clone(),
        si: if si.is_empty() {
            "a plain number".into()
        } else {
            format!("what is in {si}")
        },
        help: match names.iter().all(|n| n.is_empty()) {
            true => "leave it out".to_owned(),
            false => format!("units: {}", crate::scene::suggest::list(names)),
        },
    })
}

/// The ends of an axis in the unit that it is shown in.
fn range(
    wanted: &Option<[String; 2]>,
    si: &str,
    shown: &Unit,
) -> Result<Option<[f64; 2]>, HistoriesError> {
    let Some(ends) = wanted else {
        return Ok(None);
    };
    let wrong = |problem| HistoriesError::Range {
        text: format!("`{}` to `{}`", ends[0], ends[1]),
        problem,
        example: match &shown.name[..] {
            "" => "0 2.5".to_owned(),
            unit => format!("0 '2.5 {unit}'"),
        },
    };
    let mut values = [0.0; 2];
    for (value, text) in values.iter_mut().zip(ends) {
        let text = text.trim();
        let unit_at = text.find(|c: char| c.is_alphabetic() && !matches!(c, 'e' | 'E'));
        let (number, unit) = text.split_at(unit_at.unwrap_or(text.len()));
        let number: f64 = number.trim().parse().map_err(|_| wrong(""))?;
        let factor = match unit.trim() {
            "" => 1.0,
            name => {
                units::named(si, name)
                    .map_err(|_| wrong(": the unit does not fit"))?
                    .factor
            }
        };
        *value = number / factor * shown.factor;
    }
    match values[0] < values[1] && values.iter().all(|v| v.is_finite()) {
        true => Ok(Some(values)),
        false => Err(wrong(": the first end has to be less than the second")),
    }
}

fn labelled(name: &str, unit: &Unit) -> String {
    match &unit.name[..] {
        "" => name.to_owned(),
        unit => format!("{name} ({unit})"),
    }
}

fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut all: Vec<&str> = Vec::new();
    for name in names {
        if !all.contains(&name) {
            all.push(name);
        }
    }
    all
}

/// A column's name in words: `bottom.displacement.z` is "displacement z of bottom".
fn spoken(column: &str) -> String {
    let parts: Vec<&str> = column.split('.').collect();
    let text = match parts[..] {
        ["energy", kind] => format!("{kind} energy"),
        ["contact", name, kind, component] => format!("{kind} force {component} of contact {name}"),
        ["contact", name, kind] => format!("{kind} nodes of contact {name}"),
        [probe, quantity, component] => format!("{quantity} {component} of {probe}"),
        [probe, quantity] => format!("{quantity} of {probe}"),
        _ => column.to_owned(),
    };
    text.replace('_', " ")
}

/// What the vertical axis shows: the column, or what is the same in all of them.
fn common_name(raw: &[Raw]) -> String {
    let columns = distinct(raw.iter().map(|r| r.column.as_str()));
    let split: Vec<Vec<&str>> = columns.iter().map(|c| c.split('.').collect()).collect();
    let same = |at: usize| {
        let parts = distinct(split.iter().filter_map(|parts| parts.get(at).copied()));
        match parts[..] {
            [one] if split.iter().all(|parts| parts.len() > at) => Some(one.replace('_', " ")),
            _ => None,
        }
    };
    match &columns[..] {
        [one] => spoken(one),
        _ => match (same(0), same(1), same(2)) {
            (Some(first), None, None) => first,
            (Some(first), Some(quantity), _) => format!("{quantity} of {first}"),
            (_, Some(quantity), Some(component)) => format!("{quantity} {component}"),
            (_, Some(quantity), None) => quantity,
            _ => "value".to_owned(),
        },
    }
}

/// A column in the legend, without what all of them have at the beginning.
fn in_legend(column: &str, columns: &[&str]) -> String {
    let parts: Vec<&str> = column.split('.').collect();
    let shared = (0..parts.len().saturating_sub(1))
        .take_while(|&at| {
            columns
                .iter()
                .all(|c| c.split('.').nth(at) == Some(parts[at]))
        })
        .count();
    parts[shared..].join(".").replace('_', " ")
}
