//! The page's tables: figures of the summary, energies, stages, histories, comparisons.

use super::answers::of_summary;
use super::figures::{count, escape, figure, percent, raised};
use super::source::Source;
use serde_json::Value;

/// Keys of the summary that are no single figures, or stand in tables of their own.
const ELSEWHERE: [&str; 5] = ["energy", "compare", "units", "warnings", "projections"];

/// What is known of the keys' units. All others are numbers of things or texts.
const UNITS: [(&str, &str); 9] = [
    ("mass", "kg"),
    ("time", "s"),
    ("wall_time", "s"),
    ("min_dt", "s"),
    ("max_dt", "s"),
    ("energy_turned_over", "J"),
    ("outflow_mass", "kg"),
    ("projections.sum", "m"),
    ("projections.greatest", "m"),
];

/// All figures of `summary.json`.
pub fn summary(source: &Source) -> String {
    let Some(summary) = source.summary.as_ref().and_then(Value::as_object) else {
        return "<p>There is no <code>summary.json</code>: it is written when a run is over.</p>"
            .to_owned();
    };
    let projections = summary.get("projections").and_then(Value::as_object);
    let projections = projections.into_iter().flatten();
    let projections = projections.map(|(key, value)| (format!("projections.{key}"), value));
    let all = summary
        .iter()
        .filter(|(key, _)| !ELSEWHERE.contains(&&key[..]));
    let all = all
        .map(|(key, value)| (key.clone(), value))
        .chain(projections);
    let rows = all.map(|(key, value)| {
        let unit = UNITS.iter().find(|u| u.0 == key).map_or("", |u| u.1);
        let unit = if key == "projections.work" { "J" } else { unit };
        format!(
            "<tr data-key=\"{0}\"><th scope=\"row\"><code>{0}</code></th><td>{1}</td></tr>\n",
            escape(&key),
            cell(value, unit)
        )
    });
    table("summary", "<th>figure</th><th>value</th>", rows)
}

/// A value of any kind.
fn cell(value: &Value, unit: &str) -> String {
    match value {
        Value::Null => "–".to_owned(),
        Value::String(text) => format!("<span class=\"text\">{}</span>", escape(text)),
        Value::Number(n) => match (n.as_u64(), n.as_f64()) {
            (Some(n), _) if unit.is_empty() => count(n),
            (_, Some(x)) => figure(x, unit),
            _ => escape(&n.to_string()),
        },
        Value::Array(all) if all.is_empty() => "none".to_owned(),
        other => escape(&other.to_string()),
    }
}

fn table(id: &str, head: &str, rows: impl Iterator<Item = String>) -> String {
    format!(
        "<div class=\"wide\"><table id=\"table-{id}\"><thead><tr>{head}</tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
        rows.collect::<String>()
    )
}

/// What an energy is: its group in the table, and its meaning.
const KINDS: [(&str, &str, &str); 17] = [
    ("load", "given", "work of loads"),
    ("prescribed", "given", "work of prescribed velocities"),
    ("kinetic", "stored", "in the particles' motion"),
    ("elastic", "stored", "in the material"),
    ("gravity", "stored", "in the gravity field"),
    ("plastic", "dissipated", "by plastic flow"),
    ("friction", "dissipated", "by friction between bodies"),
    (
        "contact",
        "dissipated",
        "by impulses along the normals of contacts",
    ),
    ("damping", "dissipated", "by damping and viscosity"),
    ("absorbed", "taken away", "by absorbing boundaries"),
    (
        "removed",
        "taken away",
        "with particles that were taken out",
    ),
    ("transfer", "numerical", "lost between nodes and particles"),
    ("smoothing", "numerical", "lost by the smoothing of strains"),
    (
        "integration",
        "numerical",
        "lost between means of elements and particles",
    ),
    (
        "advection",
        "numerical",
        "lost as particles move through the mesh",
    ),
    (
        "residual",
        "check",
        "given less all others: round-off, or something is wrong",
    ),
    (
        "kinetic_grid",
        "beside",
        "motion of the mesh's nodes; no part of the balance",
    ),
];

/// The energies at the end, of the summary; of a run that is not over those of the last row.
pub fn energies(source: &Source) -> String {
    let value = |kind: &str| match &source.summary {
        Some(summary) => summary["energy"][kind].as_f64(),
        None => source
            .history
            .column(&format!("energy.{kind}"))?
            .last()
            .copied(),
    };
    let turned_over = of_summary(source, "energy_turned_over");
    let rows = KINDS.iter().map(|(kind, group, meaning)| {
        let (joules, share) = match value(kind) {
            Some(joules) => {
                let share = turned_over.filter(|t| *t > 0.0).map(|t| percent(joules / t));
                (figure(joules, "J"), share.unwrap_or("–".to_owned()))
            }
            None => ("–".to_owned(), "–".to_owned()),
        };
        format!(
            "<tr data-key=\"{kind}\" class=\"{0}\"><td>{group}</td><th scope=\"row\"><code>{kind}</code></th>\
             <td>{joules}</td><td>{share}</td><td>{meaning}</td></tr>\n",
            group.replace(' ', "-")
        )
    });
    let head = "<th></th><th>energy</th><th>at the end</th><th>of the energy turned over</th><th>meaning</th>";
    table("energies", head, rows)
}

/// When each stage began and ended, by the rows of the history.
pub fn stages(source: &Source) -> String {
    let column = |name: &str| source.history.column(name).unwrap_or_default();
    let (stage, times, since, steps) = (
        column("stage"),
        column("time"),
        column("stage_time"),
        column("step"),
    );
    let reached = stage.last().map(|s| *s as usize);
    let done = source.summary.as_ref().is_some_and(|s| s["exit"] == "done");
    let rows = source.outline.stages.iter().enumerate().map(|(number, name)| {
        let first = stage.iter().position(|&s| s as usize == number);
        let last = stage.iter().rposition(|&s| s as usize == number);
        let (began, ended, length, step) = match (first, last) {
            (Some(first), Some(last)) => (
                figure(times[first] - since[first], "s"),
                figure(times[last], "s"),
                figure(since[last], "s"),
                count(steps[last] as u64),
            ),
            _ => ["–"; 4].map(str::to_owned).into(),
        };
        let state = match reached {
            Some(reached) if number < reached => "completed",
            Some(reached) if number == reached && done => "completed",
            Some(reached) if number == reached && source.is_over() => "stopped",
            Some(reached) if number == reached => "not over",
            Some(_) => "not reached",
            None => "–",
        };
        format!(
            "<tr><td>{number}</td><th scope=\"row\">{}</th><td>{state}</td><td>{began}</td><td>{ended}</td>\
             <td>{length}</td><td>{step}</td></tr>\n",
            escape(name)
        )
    });
    let head = "<th></th><th>stage</th><th></th><th>began at</th><th>last row at</th><th>length until then</th>\
                <th>step then</th>";
    table("stages", head, rows)
}

/// Each column of the history with its last value and its extremes.
pub fn history(source: &Source) -> String {
    let history = &source.history;
    let Some(times) = history.column("time").filter(|t| !t.is_empty()) else {
        return "<p>There is no history.</p>".to_owned();
    };
    let of_run = ["time", "stage", "stage_time", "step"];
    let columns = history.names.iter().zip(&history.columns);
    let rows = columns.filter(|c| !of_run.contains(&&c.0[..])).map(|(name, values)| {
        let unit = source.unit(name);
        let found = values.iter().zip(times).filter(|v| v.0.is_finite());
        let least = found.clone().reduce(|a, b| if b.0 < a.0 { b } else { a });
        let greatest = found.reduce(|a, b| if b.0 > a.0 { b } else { a });
        let extreme = |found: Option<(&f64, &f64)>| match found {
            Some((&value, &time)) => format!("<td>{}</td><td>{}</td>", figure(value, &unit), figure(time, "s")),
            None => "<td>–</td><td>–</td>".to_owned(),
        };
        let last = values.last().map_or("–".to_owned(), |&v| figure(v, &unit));
        format!(
            "<tr data-key=\"{0}\"><th scope=\"row\"><code>{0}</code></th><td>{last}</td>{1}{2}</tr>\n",
            escape(name),
            extreme(least),
            extreme(greatest)
        )
    });
    let head = "<th>column</th><th>at the end</th><th>least</th><th>at t</th><th>greatest</th><th>at t</th>";
    table("history", head, rows)
}

/// Comparisons with what was expected; nothing if the scene has none.
pub fn comparisons(source: &Source) -> String {
    let compared = source
        .summary
        .as_ref()
        .and_then(|s| s["compare"].as_array());
    let Some(compared) = compared.filter(|c| !c.is_empty()) else {
        return String::new();
    };
    let rows = compared.iter().map(|c| {
        let column = c["column"].as_str().unwrap_or_default();
        let unit = source.unit(column);
        let number = |key: &str| c[key].as_f64();
        let value = |key: &str, unit: &str| number(key).map_or("–".to_owned(), |x| figure(x, unit));
        format!(
            "<tr><th scope=\"row\"><code>{}</code></th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            escape(column),
            escape(c["file"].as_str().unwrap_or_default()),
            number("relative_difference").map_or("–".to_owned(), percent),
            value("greatest_difference", &unit),
            value("at_time", "s"),
            value("reference_peak", &unit)
        )
    });
    let head = "<th>column</th><th>compared with</th><th>greatest difference, of the peak</th>\
                <th>greatest difference</th><th>at t</th><th>peak of the reference</th>";
    format!(
        "<h2 id=\"comparisons\">Comparisons</h2>\n{}",
        table("compare", head, rows)
    )
}

/// Warnings of the summary, and how the run was stopped.
pub fn warnings(source: &Source) -> String {
    let all = source
        .summary
        .as_ref()
        .and_then(|s| s["warnings"].as_array());
    let all: Vec<&str> = all
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .collect();
    if all.is_empty() {
        return "<p>None.</p>".to_owned();
    }
    let items = all.iter().map(|w| format!("<li>{}</li>\n", escape(w)));
    format!(
        "<ul class=\"warnings\">\n{}</ul>\n",
        items.collect::<String>()
    )
}

/// Of all columns.
pub fn units(source: &Source) -> Value {
    let all = source.history.names.iter();
    all.map(|name| (name.clone(), Value::String(raised(&source.unit(name)))))
        .collect::<serde_json::Map<_, _>>()
        .into()
}
