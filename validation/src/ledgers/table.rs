//! The table of ledgers: a row a run as CSV, and of these the worst of each case as Markdown.

use super::{Entry, RESIDUAL_LIMIT};
use std::fmt::Write;
use std::path::Path;

const COLUMNS: [&str; 13] = [
    "case",
    "run",
    "kind",
    "turned_over_J",
    "residual",
    "numerical_%",
    "transfer_%",
    "smoothing_%",
    "integration_%",
    "advection_%",
    "limit_%",
    "holds",
    "commit",
];

/// Values of a run, in the order of the columns.
type Row = [String; COLUMNS.len()];

const CASE: usize = 0;
const RUN: usize = 1;
const RESIDUAL: usize = 4;
const NUMERICAL: usize = 5;
const LIMIT: usize = 10;
const HOLDS: usize = 11;
const COMMIT: usize = 12;

/// A row a run.
#[derive(Default)]
pub struct Ledgers {
    rows: Vec<Row>,
}

impl Ledgers {
    /// What an earlier call has written; nothing if there is no file, or one with other columns.
    pub fn read(path: &Path) -> std::io::Result<Ledgers> {
        match std::fs::read_to_string(path) {
            Ok(text) => Ok(Ledgers::parsed(&text)),
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(Ledgers::default()),
            Err(e) => Err(e),
        }
    }

    fn parsed(text: &str) -> Ledgers {
        let mut lines = text.lines();
        if lines.next() != Some(&COLUMNS.join(",")) {
            return Ledgers::default();
        }
        let row = |line: &str| -> Option<Row> {
            let values: Vec<String> = line.split(',').map(str::to_owned).collect();
            values.try_into().ok()
        };
        Ledgers {
            rows: lines.filter_map(row).collect(),
        }
    }

    /// Puts the runs of a case in the place of its earlier ones. `order` is that of the cases; what is
    /// not in it is no case any more.
    pub fn replace(&mut self, case: &str, entries: &[Entry], commit: &str, order: &[&str]) {
        let place = |row: &Row| order.iter().position(|&name| name == row[CASE]);
        self.rows.retain(|r| r[CASE] != case && place(r).is_some());
        self.rows
            .extend(entries.iter().map(|e| row(case, e, commit)));
        self.rows.sort_by_key(place);
    }

    /// In their order.
    #[cfg(test)]
    pub fn cases(&self) -> impl Iterator<Item = &str> {
        let cases = self.rows.chunk_by(|a, b| a[CASE] == b[CASE]);
        cases.map(|runs| runs[0][CASE].as_str())
    }

    pub fn csv(&self) -> String {
        let header = COLUMNS.join(",") + "\n";
        let rows = self.rows.iter().map(|r| r.join(",") + "\n");
        std::iter::once(header).chain(rows).collect()
    }

    /// For each case the run whose numerical terms are greatest against their limit, with the greatest
    /// residual of all its runs.
    pub fn markdown(&self) -> String {
        let mut text = String::from(
            "| case | runs | the worst run | kind | turned over (J) | greatest residual | \
             numerical terms (%) | transfer | smoothing | integration | advection | limit (%) | \
             all runs hold |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        );
        for runs in self.rows.chunk_by(|a, b| a[CASE] == b[CASE]) {
            line(&mut text, runs);
        }
        let over = self.rows.iter().filter(|r| r[HOLDS] != "yes").count();
        let mut commits: Vec<&str> = self.rows.iter().map(|r| r[COMMIT].as_str()).collect();
        commits.sort_unstable();
        commits.dedup();
        writeln!(
            text,
            "\n{} runs, {over} of them over a limit. Computed from commit {}.",
            self.rows.len(),
            commits.join(", ")
        )
        .expect("a string takes what is written to it");
        text
    }
}

fn row(case: &str, e: &Entry, commit: &str) -> Row {
    let percent = |share: f64| format!("{:.4}", 100.0 * share);
    let [transfer, smoothing, integration, advection] = e.terms.map(percent);
    [
        case.to_owned(),
        e.run.replace(',', ";"),
        e.kind.name().to_owned(),
        format!("{:.4e}", e.turned_over),
        format!("{:.1e}", e.residual),
        percent(e.numerical()),
        transfer,
        smoothing,
        integration,
        advection,
        format!("{}", 100.0 * e.kind.limit()),
        if e.holds() { "yes" } else { "no" }.to_owned(),
        commit.to_owned(),
    ]
}

/// A case's line of the Markdown table.
fn line(text: &mut String, runs: &[Row]) {
    let number = |row: &Row, column: usize| row[column].parse().unwrap_or(f64::NAN);
    let share = |row: &Row| number(row, NUMERICAL) / number(row, LIMIT);
    let worst = runs.iter().max_by(|a, b| share(a).total_cmp(&share(b)));
    let worst = worst.expect("a case in the table has a run");
    let residuals = runs.iter().map(|r| number(r, RESIDUAL));
    let residual = residuals.max_by(f64::total_cmp).unwrap_or(f64::NAN);
    let missed = runs.iter().filter(|r| r[HOLDS] != "yes").count();
    let holds = match missed {
        0 => "yes".to_owned(),
        _ if residual <= RESIDUAL_LIMIT => format!("**no**: {missed} of {} do not", runs.len()),
        _ => format!("**no**: {missed} of {} do not; residual", runs.len()),
    };
    let mut values: Vec<String> = worst[RUN..HOLDS].to_vec();
    values[RESIDUAL - RUN] = format!("{residual:.1e}");
    writeln!(
        text,
        "| {} | {} | {} | {holds} |",
        worst[CASE],
        runs.len(),
        values.join(" | ")
    )
    .expect("a string takes what is written to it");
}

#[cfg(test)]
mod tests {
    use super::super::Kind;
    use super::*;

    fn entry(run: &str, residual: f64, transfer: f64) -> Entry {
        Entry {
            run: run.to_owned(),
            kind: Kind::Elastic,
            turned_over: 2.0,
            residual,
            terms: [transfer, 0.0, -0.001, 0.0],
        }
    }

    #[test]
    fn a_case_computed_anew_replaces_its_own_rows_only() {
        let (order, mut ledgers) = (["a", "b"], Ledgers::default());
        ledgers.replace("b", &[entry("x", 0.0, 0.0)], "1", &order);
        ledgers.replace("a", &[entry("y, z", 0.0, 0.0)], "1", &order);
        let mut again = Ledgers::parsed(&ledgers.csv());
        assert_eq!(again.csv(), ledgers.csv());
        again.replace(
            "b",
            &[entry("x", 0.0, 0.0), entry("w", 0.0, 0.0)],
            "2",
            &order,
        );
        let found: Vec<_> = again.rows.iter().map(|r| [&r[0], &r[1], &r[12]]).collect();
        assert_eq!(
            found,
            [["a", "y; z", "1"], ["b", "x", "2"], ["b", "w", "2"]]
        );
    }

    #[test]
    fn the_worst_run_stands_for_its_case_with_the_greatest_residual() {
        let mut ledgers = Ledgers::default();
        let runs = [entry("quiet", 1e-12, 0.002), entry("loud", 1e-15, -0.02)];
        ledgers.replace("a", &runs, "1", &["a"]);
        let page = ledgers.markdown();
        let line = page.lines().nth(2).expect("a line for the case");
        assert_eq!(
            line,
            "| a | 2 | loud | elastic | 2.0000e0 | 1.0e-12 | 2.1000 | -2.0000 | 0.0000 | -0.1000 | \
             0.0000 | 1 | **no**: 1 of 2 do not |"
        );
    }

    #[test]
    fn what_is_no_number_does_not_hold() {
        assert!(entry("", 1e-7, 0.001).holds());
        assert!(!entry("", f64::NAN, 0.001).holds());
        assert!(!entry("", 1e-7, f64::NAN).holds());
        assert!(!entry("", 1.1e-6, 0.001).holds());
    }
}
