//! `history.csv`: the columns of a simulation and its rows.

use super::{RunError, whole};
use crate::output::compare::{difference, reference_peak};
use crate::output::csv::{self, Writer};
use crate::output::summary::Compared;
use crate::output::{FileError, Folder};
use crate::scene::Compare;
use moldwarp::Simulation;
use moldwarp::measure::Energies;
use moldwarp::plan::{Contact, Quantity};

/// A column that every history has. The book's page on the output is made from these, too.
pub(crate) struct Column {
    pub name: &'static str,
    pub unit: &'static str,
    #[cfg_attr(not(test), expect(dead_code, reason = "it is for the book"))]
    pub meaning: &'static str,
    value: fn(&Simulation) -> f64,
}

/// Columns that every history begins with.
pub(crate) const FIRST: [Column; 5] = [
    Column {
        name: "time",
        unit: "s",
        meaning: "Since the start of the run; never reset.",
        value: Simulation::time,
    },
    Column {
        name: "stage",
        unit: "",
        meaning: "Number of the stage, from 0.",
        // All stages done: the last row still belongs to the last stage.
        value: |sim| sim.stage().min(sim.plan().stages.len() - 1) as f64,
    },
    Column {
        name: "stage_time",
        unit: "s",
        meaning: "Since the stage began.",
        value: Simulation::stage_time,
    },
    Column {
        name: "step",
        unit: "",
        meaning: "Steps done.",
        value: |sim| sim.steps() as f64,
    },
    Column {
        name: "dt",
        unit: "s",
        meaning: "Last step; 0 in the first row.",
        value: Simulation::time_step,
    },
];

/// The unit of a column by its name, as runs before their end have no summary that says it; none if no
/// history has such a column.
pub(crate) fn unit(column: &str) -> Option<&'static str> {
    if let Some(first) = FIRST.iter().find(|c| c.name == column) {
        return Some(first.unit);
    }
    if column.starts_with("energy.") {
        return Some("J");
    }
    if let Some(rest) = column.strip_prefix("contact.") {
        let of_contact = Contact::COLUMNS.iter();
        let mut found =
            of_contact.filter(|c| rest.strip_suffix(c.0).is_some_and(|r| r.ends_with('.')));
        if let Some(column) = found.next() {
            return Some(column.1);
        }
    }
    let quantity = |part: &str| {
        Quantity::ALL
            .iter()
            .find(|q| q.0 == part)
            .map(|q| q.1.unit())
    };
    let mut parts = column.rsplit('.');
    // `probe.penetration` or `probe.displacement.z`.
    let (last, before) = (parts.next()?, parts.next()?);
    quantity(last).or_else(|| quantity(before))
}

/// A history's columns with their units, in order.
pub(crate) fn columns(sim: &Simulation) -> Vec<(String, String)> {
    let first = FIRST.map(|c| (c.name.to_owned(), c.unit.to_owned()));
    let probes = sim.probe_columns().into_iter();
    let probes_and_contacts = probes.chain(sim.contact_columns());
    let energies = Energies::NAMES.map(|name| (format!("energy.{name}"), "J".to_owned()));
    first
        .into_iter()
        .chain(probes_and_contacts.map(|(name, unit)| (name, unit.to_owned())))
        .chain(energies)
        .collect()
}

/// The values of all columns now.
pub(super) fn row(sim: &Simulation, out: &mut Vec<f64>) {
    out.clear();
    out.extend(FIRST.iter().map(|c| (c.value)(sim)));
    whole::probe_values(sim, out);
    whole::contact_values(sim, out);
    out.extend(whole::energies(sim).values());
}

/// An expected history and the values to be compared with it.
#[derive(Debug)]
pub(crate) struct Expected {
    column: usize,
    name: String,
    file: String,
    reference: Vec<(f64, f64)>,
    /// Time in s, value.
    seen: Vec<(f64, f64)>,
}

impl Expected {
    /// Reads the reference of every comparison and finds its column.
    pub fn read_all(
        compare: &[Compare],
        columns: &[(String, String)],
    ) -> Result<Vec<Expected>, RunError> {
        compare.iter().map(|c| Expected::read(c, columns)).collect()
    }

    fn find(compare: &Compare, columns: &[(String, String)]) -> Result<usize, RunError> {
        let column = columns.iter().position(|c| c.0 == compare.column);
        column.ok_or_else(|| RunError::NoSuchColumn {
            column: compare.column.clone(),
        })
    }

    fn read(compare: &Compare, columns: &[(String, String)]) -> Result<Expected, RunError> {
        let column = Expected::find(compare, columns)?;
        let table = csv::read(&compare.file)?;
        let [times, values, ..] = &table.columns[..] else {
            return Err(RunError::OneColumn {
                file: compare.file.clone(),
            });
        };
        let reference: Vec<(f64, f64)> =
            times.iter().copied().zip(values.iter().copied()).collect();
        reference_peak(&reference).map_err(|problem| RunError::Reference {
            file: compare.file.clone(),
            problem,
        })?;
        Ok(Expected {
            column,
            name: compare.column.clone(),
            file: compare
                .file
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            reference,
            seen: Vec::new(),
        })
    }

    /// The names of the files and what they say, by which [`Expected::again`] finds them later.
    pub fn references(all: &[Expected]) -> Vec<(String, Vec<(f64, f64)>)> {
        let reference = |e: &Expected| (e.file.clone(), e.reference.clone());
        all.iter().map(reference).collect()
    }

    /// The comparisons with references that have been read before.
    pub fn again(
        compare: &[Compare],
        columns: &[(String, String)],
        references: Vec<(String, Vec<(f64, f64)>)>,
    ) -> Result<Vec<Expected>, RunError> {
        let pairs = compare.iter().zip(references);
        let pair = pairs.map(|(compare, (file, reference))| {
            Ok(Expected {
                column: Expected::find(compare, columns)?,
                name: compare.column.clone(),
                file,
                reference,
                seen: Vec::new(),
            })
        });
        pair.collect()
    }

    /// Takes a history's columns for all that there is to compare.
    pub fn see(&mut self, columns: &[Vec<f64>]) {
        let (times, values) = (&columns[0], &columns[self.column]);
        self.seen = times.iter().copied().zip(values.iter().copied()).collect();
    }

    /// How far the history was from what was expected; a problem as a sentence.
    pub fn compared(&self) -> Result<Compared, String> {
        let d = difference(self.seen.iter().copied(), &self.reference)
            .map_err(|e| format!("{} is not compared with {}: {e}", self.name, self.file))?;
        Ok(Compared {
            column: self.name.clone(),
            file: self.file.clone(),
            relative_difference: d.relative(),
            greatest_difference: d.greatest,
            at_time: d.time,
            reference_peak: d.peak,
        })
    }
}

/// The history that is being written.
#[derive(Debug)]
pub(crate) struct History {
    writer: Writer,
    row: Vec<f64>,
    pub expected: Vec<Expected>,
}

impl History {
    pub fn create(
        folder: &Folder,
        columns: &[(String, String)],
        expected: Vec<Expected>,
    ) -> Result<History, FileError> {
        let names: Vec<&str> = columns.iter().map(|c| c.0.as_str()).collect();
        Ok(History {
            writer: Writer::create(&folder.history(), &names)?,
            row: Vec::new(),
            expected,
        })
    }

    /// Goes on after the first `length` bytes of the file.
    pub fn resume(
        folder: &Folder,
        columns: &[(String, String)],
        mut expected: Vec<Expected>,
        length: u64,
    ) -> Result<History, RunError> {
        let path = folder.history();
        let writer = Writer::resume(&path, columns.len(), length)?;
        if !expected.is_empty() {
            let rows = csv::read(&path)?;
            for expected in &mut expected {
                expected.see(&rows.columns);
            }
        }
        Ok(History {
            writer,
            row: Vec::new(),
            expected,
        })
    }

    /// Brings all rows to the disk. Returns the length of the file in bytes.
    pub fn sync(&mut self) -> Result<u64, FileError> {
        self.writer.sync()
    }

    /// Adds the simulation as it is now.
    pub fn write(&mut self, sim: &Simulation) -> Result<(), FileError> {
        row(sim, &mut self.row);
        for expected in &mut self.expected {
            expected.seen.push((sim.time(), self.row[expected.column]));
        }
        self.writer.row(&self.row)
    }

    pub fn finish(&mut self) -> Result<(), FileError> {
        self.writer.finish()
    }
}
