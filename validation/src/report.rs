//! What a case brings: a table, plots, and figures with limits.

use moldwarp_io::plot::{Look, Plot};
use std::fmt::Write;
use std::path::Path;

/// A figure and the limit it must keep.
#[derive(Clone, Debug)]
pub struct Check {
    pub what: String,
    pub value: f64,
    pub limit: f64,
}

impl Check {
    pub fn passed(&self) -> bool {
        self.value <= self.limit
    }
}

/// Plots are for screens, where they are shown as wide as a page's text.
pub fn look() -> Look {
    Look {
        size: [18.0, 10.0],
        font_size: 10.0,
        ..Look::default()
    }
}

/// Rows under named columns.
#[derive(Clone, Debug, Default)]
pub struct Table {
    pub columns: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub fn new(columns: &[&str]) -> Table {
        Table {
            columns: columns.iter().map(|c| c.to_string()).collect(),
            rows: Vec::new(),
        }
    }

    pub fn row(&mut self, values: &[&dyn std::fmt::Display]) {
        assert_eq!(
            values.len(),
            self.columns.len(),
            "a row has a value for each column"
        );
        self.rows
            .push(values.iter().map(|v| v.to_string()).collect());
    }

    fn csv(&self) -> String {
        let lines = std::iter::once(&self.columns).chain(&self.rows);
        lines.map(|l| l.join(",") + "\n").collect()
    }
}

/// The outcome of a case.
#[derive(Clone, Debug, Default)]
pub struct Report {
    pub table: Table,
    /// File name without ending, and plot.
    pub plots: Vec<(String, Plot)>,
    pub checks: Vec<Check>,
}

impl Report {
    /// Notes a figure that must not exceed `limit`.
    pub fn check(&mut self, what: impl Into<String>, value: f64, limit: f64) {
        self.checks.push(Check {
            what: what.into(),
            value,
            limit,
        });
    }

    pub fn passed(&self) -> bool {
        self.checks.iter().all(Check::passed)
    }

    /// The checks as lines of text.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        for check in &self.checks {
            let mark = if check.passed() { "ok  " } else { "FAIL" };
            writeln!(
                text,
                "  {mark} {}: {:.4e} (limit {:.1e})",
                check.what, check.value, check.limit
            )
            .expect("a string takes what is written to it");
        }
        text
    }

    /// Writes `case.csv`, `case-checks.csv` and the plots to `folder`.
    pub fn write(&self, folder: &Path, case: &str) -> std::io::Result<()> {
        std::fs::create_dir_all(folder)?;
        std::fs::write(folder.join(format!("{case}.csv")), self.table.csv())?;
        let mut checks = Table::new(&["figure", "value", "limit"]);
        for check in &self.checks {
            let what = check.what.replace(',', ";");
            checks.row(&[
                &what,
                &format!("{:.4e}", check.value),
                &format!("{:.1e}", check.limit),
            ]);
        }
        std::fs::write(folder.join(format!("{case}-checks.csv")), checks.csv())?;
        for (name, plot) in &self.plots {
            let look = look();
            let svg = Plot {
                look,
                ..plot.clone()
            }
            .svg()
            .map_err(std::io::Error::other)?;
            std::fs::write(folder.join(format!("{name}.svg")), svg)?;
        }
        Ok(())
    }
}
