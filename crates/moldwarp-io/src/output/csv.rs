//! Tables with one header row, comma separated: histories, which hold numbers only, and the table
//! of a sweep, which also holds text.

use super::FileError;
use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Rows reach the disk at least this often, so that a running history can be watched.
const FLUSH_INTERVAL: Duration = Duration::from_secs(1);

/// A table that is being written row by row.
#[derive(Debug)]
pub struct Writer {
    path: PathBuf,
    out: BufWriter<File>,
    line: String,
    columns: usize,
    flushed: Instant,
}

impl Writer {
    /// Creates the file with its header row.
    pub fn create<S: AsRef<str>>(path: &Path, columns: &[S]) -> Result<Writer, FileError> {
        let file = File::create(path).map_err(FileError::at("create", path))?;
        let mut writer = Writer {
            path: path.to_owned(),
            out: BufWriter::new(file),
            line: String::new(),
            columns: columns.len(),
            flushed: Instant::now(),
        };
        let header: Vec<String> = columns.iter().map(|c| quoted(c.as_ref())).collect();
        writer.line = header.join(",");
        writer.put_line()?;
        writer.finish()?;
        Ok(writer)
    }

    /// Goes on with a file of so many columns after its first `length` bytes; what follows them is cut
    /// off.
    pub fn resume(path: &Path, columns: usize, length: u64) -> Result<Writer, FileError> {
        let open = || {
            let mut file = File::options().write(true).open(path)?;
            if file.metadata()?.len() < length {
                return Err(std::io::Error::other("rows that it had are missing"));
            }
            file.set_len(length)?;
            file.seek(SeekFrom::End(0))?;
            Ok(file)
        };
        let file = open().map_err(FileError::at("go on with", path))?;
        Ok(Writer {
            path: path.to_owned(),
            out: BufWriter::new(file),
            line: String::new(),
            columns,
            flushed: Instant::now(),
        })
    }

    /// Brings everything written so far to the disk, beyond the system's own memory. Returns the
    /// length of the file in bytes.
    pub fn sync(&mut self) -> Result<u64, FileError> {
        self.finish()?;
        let file = self.out.get_ref();
        file.sync_data()
            .and_then(|()| file.metadata())
            .map(|about| about.len())
            .map_err(FileError::at("write", &self.path))
    }

    /// Writes a row, one value a column.
    pub fn row(&mut self, values: &[f64]) -> Result<(), FileError> {
        debug_assert_eq!(values.len(), self.columns);
        self.line.clear();
        for (i, &value) in values.iter().enumerate() {
            if i > 0 {
                self.line.push(',');
            }
            push_number(&mut self.line, value);
        }
        self.put_line()?;
        if self.flushed.elapsed() >= FLUSH_INTERVAL {
            self.finish()?;
        }
        Ok(())
    }

    /// Brings everything written so far to the disk.
    pub fn finish(&mut self) -> Result<(), FileError> {
        self.flushed = Instant::now();
        self.out.flush().map_err(FileError::at("write", &self.path))
    }

    fn put_line(&mut self) -> Result<(), FileError> {
        self.line.push('\n');
        self.out
            .write_all(self.line.as_bytes())
            .map_err(FileError::at("write", &self.path))
    }
}

/// The shortest text that reads back as the same number: whole numbers without a point, small
/// and large ones with an exponent.
pub(crate) fn push_number(text: &mut String, value: f64) {
    use std::fmt::Write;
    let whole = value.fract() == 0.0 && value.abs() < 1e15;
    let written = if whole {
        write!(text, "{value}")
    } else {
        write!(text, "{value:?}")
    };
    debug_assert!(written.is_ok(), "a string takes any text");
}

/// A text as one cell.
pub(crate) fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// A table in memory, by columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    pub names: Vec<String>,
    /// One list a name, all equally long.
    pub columns: Vec<Vec<f64>>,
}

impl Table {
    /// The values of the column with this name.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let i = self.names.iter().position(|n| n == name)?;
        Some(&self.columns[i])
    }
}

/// A table of texts in memory, by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Records {
    pub names: Vec<String>,
    /// As many cells as names.
    pub rows: Vec<Vec<String>>,
    /// Where each row stands in the file, from 1.
    lines: Vec<usize>,
}

impl Records {
    /// The cells of the column with this name.
    pub fn column(&self, name: &str) -> Option<Vec<&str>> {
        let i = self.names.iter().position(|n| n == name)?;
        Some(self.rows.iter().map(|row| row[i].as_str()).collect())
    }
}

/// Why a table could not be read.
#[derive(Debug, thiserror::Error)]
pub enum CsvError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{} is empty; a header row such as `time,value` is needed", .path.display())]
    Empty { path: PathBuf },
    #[error("{} begins with numbers; a header row such as `time,value` is needed", .path.display())]
    NoHeader { path: PathBuf },
    #[error("{}:{line}: {found} values, but the header names {expected}", .path.display())]
    Width {
        path: PathBuf,
        line: usize,
        found: usize,
        expected: usize,
    },
    #[error("{}:{line}: `{text}` is no number", .path.display())]
    Number {
        path: PathBuf,
        line: usize,
        text: String,
    },
}

/// Reads a table: a header row, then numbers. Empty lines and lines that begin with `#` are
/// passed over.
pub fn read(path: &Path) -> Result<Table, CsvError> {
    numbers(read_text(path)?, path)
}

/// The same of a table that may still be written, or was when its program ended: a last line without
/// its end is not there yet.
pub fn read_growing(path: &Path) -> Result<Table, CsvError> {
    let text = std::fs::read_to_string(path).map_err(FileError::at("read", path))?;
    let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
    numbers(records(whole, path)?, path)
}

/// The same of the text of a file; `path` is for messages.
pub fn parse(text: &str, path: &Path) -> Result<Table, CsvError> {
    numbers(records(text, path)?, path)
}

fn numbers(records: Records, path: &Path) -> Result<Table, CsvError> {
    let mut columns = vec![Vec::new(); records.names.len()];
    for (row, &line) in records.rows.iter().zip(&records.lines) {
        for (column, cell) in columns.iter_mut().zip(row) {
            column.push(cell.parse().map_err(|_| CsvError::Number {
                path: path.to_owned(),
                line,
                text: cell.clone(),
            })?);
        }
    }
    Ok(Table {
        names: records.names,
        columns,
    })
}

/// The same of a table that may hold text. No cell goes over several lines.
pub fn read_text(path: &Path) -> Result<Records, CsvError> {
    let text = std::fs::read_to_string(path).map_err(FileError::at("read", path))?;
    records(&text, path)
}

fn records(text: &str, path: &Path) -> Result<Records, CsvError> {
    let path = || path.to_owned();
    let mut lines = text
        .trim_start_matches('\u{feff}')
        .lines()
        .enumerate()
        .filter(|(_, l)| !l.trim().is_empty() && !l.starts_with('#'));
    let (_, header) = lines
        .next()
        .ok_or_else(|| CsvError::Empty { path: path() })?;
    let names = cells(header);
    if names.iter().all(|n| n.parse::<f64>().is_ok()) {
        return Err(CsvError::NoHeader { path: path() });
    }
    let mut records = Records {
        names,
        rows: Vec::new(),
        lines: Vec::new(),
    };
    for (i, line) in lines {
        let row = cells(line);
        if row.len() != records.names.len() {
            return Err(CsvError::Width {
                path: path(),
                line: i + 1,
                found: row.len(),
                expected: records.names.len(),
            });
        }
        records.rows.push(row);
        records.lines.push(i + 1);
    }
    Ok(records)
}

/// Splits a row; a cell in quotes may hold commas, and quotes doubled.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut in_quotes = false;
    let mut chars = line.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '"' if in_quotes && chars.peek() == Some(&'"') => {
                cells.last_mut().into_iter().for_each(|l| l.push('"'));
                chars.next();
            }
            '"' => in_quotes = !in_quotes,
            ',' if !in_quotes => cells.push(String::new()),
            c => cells.last_mut().into_iter().for_each(|l| l.push(c)),
        }
    }
    cells.iter().map(|c| c.trim().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_bit_for_bit() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("history.csv");
        let names = ["time", "tip, \"left\".x"];
        let values = [0.1 + 0.2, -1e-300, 1e22, 12.0, f64::MIN_POSITIVE, -0.0];
        let mut out = Writer::create(&path, &names).unwrap();
        for (i, &v) in values.iter().enumerate() {
            out.row(&[i as f64, v]).unwrap();
        }
        out.row(&[6.0, f64::NAN]).unwrap();
        out.finish().unwrap();

        let table = read(&path).unwrap();
        assert_eq!(table.names, names);
        let read = table.column(names[1]).unwrap();
        for (a, b) in read.iter().zip(values) {
            assert_eq!(a.to_bits(), b.to_bits());
        }
        assert!(read[6].is_nan());
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains("0,0.30000000000000004\n1,-1e-300\n2,1e22\n3,12\n"));
    }

    #[test]
    fn a_row_that_is_being_written_is_not_there_yet() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("x.csv");
        for cut in ["2", "2,", "2,0.", "2,0.5"] {
            std::fs::write(&path, format!("time,value\n0,1\n{cut}")).unwrap();
            assert_eq!(read_growing(&path).unwrap().columns, [[0.0], [1.0]]);
        }
    }

    #[test]
    fn wrong_tables_are_told_with_their_line() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("x.csv");
        let message = |text: &str| {
            std::fs::write(&path, text).unwrap();
            let message = read(&path).unwrap_err().to_string();
            message.replace(&format!("{}", path.display()), "x.csv")
        };
        insta::assert_snapshot!(message(""), @"x.csv is empty; a header row such as `time,value` is needed");
        insta::assert_snapshot!(message("0,1\n"), @"x.csv begins with numbers; a header row such as `time,value` is needed");
        insta::assert_snapshot!(message("# made by hand\ntime,value\n0,1\n1,2,3\n"), @"x.csv:4: 3 values, but the header names 2");
        insta::assert_snapshot!(message("time,value\n0,one\n"), @"x.csv:2: `one` is no number");
    }
}
