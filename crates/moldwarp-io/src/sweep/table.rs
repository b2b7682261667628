//! `sweep.csv`: a row a run, in the order of the values. A run that has not ended has no exit code,
//! so that the table also tells whether its sweep is over.

use super::Run;
use super::values::Variation;
use crate::output::csv::{self, push_number, quoted};
use crate::output::{FileError, write_whole};
use std::io::Write;
use std::path::Path;

/// Columns before the values, and between these and the history.
pub(super) const FIRST: [&str; 2] = ["run", "folder"];
pub(super) const EXIT_CODE: &str = "exit_code";
const OUTCOME: [&str; 3] = [EXIT_CODE, "reason", "wall_time"];

/// How a run ended.
#[derive(Clone, Debug, Default)]
pub struct End {
    pub code: i32,
    /// Why, if it did not come to its end.
    pub reason: Option<String>,
    /// s.
    pub wall_time: f64,
    /// Of each column of its history the name, the last and the greatest value.
    pub history: Vec<(String, [f64; 2])>,
}

/// Last and greatest value of every column of a history. The greatest is that with the greatest
/// absolute value, with its sign: in a column that sinks it is the depth, not the start. It is no
/// number if one of the values is none.
pub fn extremes(history: &csv::Table) -> Vec<(String, [f64; 2])> {
    let columns = history.names.iter().zip(&history.columns);
    columns
        .filter_map(|(name, values)| {
            let greatest = values.iter().copied().reduce(farther)?;
            Some((name.clone(), [*values.last()?, greatest]))
        })
        .collect()
}

/// The value farther from zero; the first of equals.
fn farther(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.abs() <= a.abs() {
        a
    } else {
        b
    }
}

/// The table as far as it is known.
#[derive(Debug)]
pub struct Table {
    variations: Vec<String>,
    runs: Vec<(Run, Option<End>)>,
    /// Columns of any run's history.
    columns: Vec<String>,
}

impl Table {
    /// For these runs, none of which has ended; `columns` are those of each run's history.
    pub fn new(variations: &[Variation], runs: &[Run], columns: &[Vec<String>]) -> Table {
        let mut all: Vec<String> = Vec::new();
        for name in columns.iter().flatten() {
            if !all.contains(name) {
                all.push(name.clone());
            }
        }
        Table {
            variations: variations.iter().map(|v| v.path.clone()).collect(),
            runs: runs.iter().map(|run| (run.clone(), None)).collect(),
            columns: all,
        }
    }

    /// Run `number`, from 0, has ended.
    pub fn end(&mut self, number: usize, end: End) {
        self.runs[number].1 = Some(end);
    }

    /// Writes the file, whole or not at all.
    pub(super) fn write(&self, path: &Path) -> Result<(), FileError> {
        write_whole(path, |out| {
            writeln!(out, "{}", row(&self.header()))?;
            for (number, (run, end)) in self.runs.iter().enumerate() {
                writeln!(out, "{}", row(&self.cells(number + 1, run, end.as_ref())))?;
            }
            Ok(())
        })
    }

    fn header(&self) -> Vec<String> {
        let ends = |name: &String| ["last", "max"].map(|end| format!("{name}.{end}"));
        let first = FIRST.iter().map(|&n| n.to_owned());
        first
            .chain(self.variations.iter().cloned())
            .chain(OUTCOME.iter().map(|&n| n.to_owned()))
            .chain(self.columns.iter().flat_map(ends))
            .collect()
    }

    /// What is not known is an empty cell.
    fn cells(&self, number: usize, run: &Run, end: Option<&End>) -> Vec<String> {
        let mut cells = vec![number.to_string(), run.folder.clone()];
        cells.extend(run.values.iter().cloned());
        let reason = end.and_then(|end| end.reason.clone());
        cells.push(end.map_or(String::new(), |end| end.code.to_string()));
        cells.push(reason.unwrap_or_default());
        cells.push(number_cell(end.map(|end| end.wall_time)));
        for name in &self.columns {
            let known = end.and_then(|end| end.history.iter().find(|c| c.0 == *name));
            let values = known.map_or([None; 2], |c| c.1.map(Some));
            cells.extend(values.map(number_cell));
        }
        cells
    }
}

fn number_cell(value: Option<f64>) -> String {
    let mut text = String::new();
    if let Some(value) = value {
        push_number(&mut text, value);
    }
    text
}

/// A line. Readers of tables differ in what they make of lines within cells, so there are none.
fn row(cells: &[String]) -> String {
    let cell = |text: &String| quoted(&text.replace(['\n', '\r'], " "));
    cells.iter().map(cell).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_greatest_value_is_farthest_from_zero_and_keeps_its_sign() {
        let history = csv::Table {
            names: ["a", "b", "c"].map(str::to_owned).to_vec(),
            columns: vec![
                vec![0.0, -3.0, 2.0],
                vec![1.0, -1.0, 0.5],
                vec![0.0, f64::NAN, 2.0],
            ],
        };
        let found = extremes(&history);
        assert_eq!(found[0], ("a".to_owned(), [2.0, -3.0]));
        assert_eq!(found[1], ("b".to_owned(), [0.5, 1.0]));
        assert_eq!(found[2].1[0], 2.0);
        assert!(found[2].1[1].is_nan());
    }

    #[test]
    fn text_and_what_is_not_known_are_read_back() {
        let entries = ["a=\"1 m, about\",2".to_owned()];
        let variations = Variation::parse_all(&entries, &[]).unwrap();
        let runs = super::super::runs(&variations);
        let columns = [vec!["time".to_owned()], vec!["x".to_owned()]];
        let mut table = Table::new(&variations, &runs, &columns);
        table.end(
            0,
            End {
                code: 3,
                reason: Some("it \"left\",\nand more".to_owned()),
                wall_time: 0.5,
                history: vec![("time".to_owned(), [0.25, 1.0])],
            },
        );
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("sweep.csv");
        table.write(&path).unwrap();
        let read = csv::read_text(&path).unwrap();
        assert_eq!(
            read.names.join(" "),
            "run folder a exit_code reason wall_time time.last time.max x.last x.max"
        );
        assert_eq!(
            read.rows[0],
            [
                "1",
                "a-1-m-about",
                "\"1 m, about\"",
                "3",
                "it \"left\", and more",
                "0.5",
                "0.25",
                "1",
                "",
                ""
            ]
        );
        assert_eq!(read.rows[1], ["2", "a-2", "2", "", "", "", "", "", "", ""]);
    }
}
