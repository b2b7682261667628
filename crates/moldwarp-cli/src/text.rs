//! Figures as people read them.

pub use moldwarp_io::text::number;
use std::time::Duration;

/// Bytes with a decimal prefix.
pub fn bytes(count: f64) -> String {
    match count {
        c if c < 1e3 => format!("{c:.0} B"),
        c if c < 1e6 => format!("{:.0} kB", c / 1e3),
        c if c < 1e9 => format!("{:.0} MB", c / 1e6),
        c => format!("{:.1} GB", c / 1e9),
    }
}

/// A wall time.
pub fn duration(time: Duration) -> String {
    let s = time.as_secs_f64();
    match s {
        s if s < 1.0 => format!("{:.0} ms", 1e3 * s),
        s if s < 100.0 => format!("{s:.1} s"),
        s if s < 5940.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86400.0),
    }
}

/// So many threads.
pub fn threads(count: usize) -> String {
    match count {
        1 => "1 thread".to_owned(),
        n => format!("{n} threads"),
    }
}

/// Thousands, millions … of things a second.
pub fn rate(x: f64) -> String {
    match x {
        x if x < 1e3 => format!("{x:.0}"),
        x if x < 1e6 => format!("{:.0} k", x / 1e3),
        x => format!("{:.2} M", x / 1e6),
    }
}

/// Rows as lines with their cells under each other: the first `left` columns begin at the left, the others
/// are figures.
pub fn table<const N: usize>(rows: &[[String; N]], left: usize) -> Vec<String> {
    let width = |at: usize| rows.iter().map(|row| row[at].chars().count()).max();
    let widths: Vec<usize> = (0..N).map(|at| width(at).unwrap_or(0)).collect();
    let cell = |at: usize, text: &String| match at < left {
        true => format!("{text:<0$}", widths[at]),
        false => format!("{text:>0$}", widths[at]),
    };
    let line = |row: &[String; N]| {
        let cells: Vec<String> = (0..N).map(|at| cell(at, &row[at])).collect();
        cells.join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_sizes_have_fitting_units() {
        let t = [0.25, 12.0, 600.0, 7200.0, 259_200.0];
        let t = t.map(|s| duration(Duration::from_secs_f64(s)));
        assert_eq!(t, ["250 ms", "12.0 s", "10 min", "2.0 h", "3.0 days"]);
        assert_eq!([512.0, 2.5e6, 3e9].map(bytes), ["512 B", "2 MB", "3.0 GB"]);
        assert_eq!([512.0, 2.5e6].map(rate), ["512", "2.50 M"]);
    }

    #[test]
    fn cells_stand_under_each_other() {
        let rows = [["a", "m", "1.5"], ["Δbc", "", "-20"]].map(|row| row.map(str::to_owned));
        assert_eq!(table(&rows, 2), ["a    m  1.5", "Δbc     -20"]);
    }
}
