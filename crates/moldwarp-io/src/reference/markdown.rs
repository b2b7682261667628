//! Tables in Markdown: made, and read back.

/// A table; cells may hold any text of one line.
pub fn table<const N: usize>(header: [&str; N], rows: &[[String; N]]) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | ")).replace("|  |", "| |");
    let mut text = line(header.map(str::to_owned).to_vec());
    text += &format!("{}|\n", "|---".repeat(N));
    for row in rows {
        text += &line(row.iter().map(|cell| cell.replace('|', "\\|")).collect());
    }
    text
}

/// Names as code, one after the other.
pub fn code<S: AsRef<str>>(names: impl IntoIterator<Item = S>, between: &str) -> String {
    let names = names.into_iter().map(|n| format!("`{}`", n.as_ref()));
    names.collect::<Vec<_>>().join(between)
}

/// What stands as code in the first column of the tables under a heading, up to the next heading.
pub fn first_column(page: &str, heading: &str) -> Vec<String> {
    let mut lines = page.lines().skip_while(|line| *line != heading);
    assert!(lines.next().is_some(), "the page has no `{heading}`");
    let rows = lines
        .take_while(|line| !line.starts_with('#'))
        .filter_map(|line| line.strip_prefix("| `"));
    let cells = rows.map(|row| row.split(" | ").next().unwrap_or_default());
    cells
        .flat_map(|cell| cell.split('`').step_by(2).map(str::to_owned))
        .collect()
}
