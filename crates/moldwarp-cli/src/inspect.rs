//! `moldwarp inspect`.

use crate::args::InspectArgs;
use crate::exit::Exit;
use crate::text::{self, number, table};
use crate::{Failure, say};
use moldwarp_io::results::{
    CheckpointInfo, ColumnRange, FieldRange, Inspection, StageInfo, State, checkpoint,
    field_ranges, inspect as look,
};
use moldwarp_io::sweep::{Member, members};
use serde::Serialize;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Duration;

pub fn inspect(args: &InspectArgs) -> Result<Exit, Failure> {
    let out = &args.out;
    let ending = out.extension().and_then(|e| e.to_str());
    let said = match ending.filter(|_| out.is_file()) {
        Some("checkpoint") => {
            let info = checkpoint(out).map_err(Failure::input)?;
            shown(args, &info, || checkpoint_text(&info))
        }
        Some("vtu") => {
            let fields = field_ranges([&**out]).map_err(Failure::input)?;
            shown(args, &fields, || field_lines(&fields, false).concat())
        }
        _ => match members(out) {
            Some(members) => match args.json {
                true => pretty(&sweep_json(&members)),
                false => sweep_text(out, &members),
            },
            None => {
                let run = look(out, args.frames).map_err(Failure::input)?;
                shown(args, &run, || run_text(&run, args.frames))
            }
        },
    };
    say(&said);
    Ok(Exit::Done)
}

fn shown(args: &InspectArgs, what: &impl Serialize, text: impl Fn() -> String) -> String {
    match args.json {
        true => pretty(&json!(what)),
        false => text(),
    }
}

fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}

/// A part of the text under its name.
fn part(name: &str, lines: Vec<String>) -> String {
    let mut text = String::new();
    for (at, line) in lines.iter().enumerate() {
        let name = if at == 0 { name } else { "" };
        text += format!("{name:<12}{}", line.trim_end_matches('\n')).trim_end();
        text.push('\n');
    }
    text
}

fn run_text(run: &Inspection, all_frames: bool) -> String {
    let mut parts = vec![format!("{}\n{}\n", run.title, standing(run))];
    parts.push(part("run", about(run)));
    parts.push(part("stages", run.stages.iter().map(stage).collect()));
    parts.push(part("frames", vec![frames(run)]));
    parts.push(part("history", history(run)));
    let which = match (run.frames_seen, all_frames, run.frame_times.last()) {
        (0, ..) | (_, _, None) => None,
        (n, true, _) => Some(format!("extremes in all {n} frames")),
        (_, _, Some(t)) => Some(format!("extremes in the last frame, t = {} s", number(*t))),
    };
    if let Some(which) = which {
        let lines = field_lines(&run.fields, all_frames);
        parts.push(part("particles", [vec![which], lines].concat()));
    }
    parts.push(part("energy", energy(run)));
    parts.push(part("compare", compared(run)));
    parts.push(part("checkpoints", checkpoints(run)));
    parts.push(part("warnings", warnings(run)));
    parts.concat()
}

/// How the run stands, in one line.
fn standing(run: &Inspection) -> String {
    let folder = run.folder.display();
    let far = match (run.time, run.steps) {
        (Some(time), Some(steps)) => format!("t = {} s after {steps} steps", number(time)),
        _ => "before its first step".to_owned(),
    };
    let wall = run.figure("wall_time").map(|s| {
        let wall = Duration::try_from_secs_f64(s).unwrap_or_default();
        format!(" and {}", text::duration(wall))
    });
    let far = format!("{far}{}", wall.unwrap_or_default());
    let resume = format!("`moldwarp resume {folder}` goes on from its last checkpoint");
    match run.state {
        State::Done => format!("{folder}: done, {far}"),
        State::Stopped => {
            let reason = run.reason.as_deref().unwrap_or_default();
            format!("{folder}: stopped, {far}: {reason}")
        }
        State::AtWork => format!("{folder}: going on, {far}"),
        State::Interrupted => format!("{folder}: interrupted, {far}; {resume}"),
        State::CutOff => {
            format!("{folder}: cut off, {far}: its log ends without a word why; {resume}")
        }
    }
}

fn about(run: &Inspection) -> Vec<String> {
    let mut lines = Vec::new();
    let count = |key: &str| run.figure(key).map_or("?".to_owned(), |n| format!("{n}"));
    if run.summary.is_some() {
        lines.push(format!(
            "{} particles in {} elements, {} kg; {} particle steps/s with {}, moldwarp {}",
            count("particles"),
            count("elements"),
            number(run.figure("mass").unwrap_or(f64::NAN)),
            text::rate(run.figure("particle_steps_per_second").unwrap_or(f64::NAN)),
            text::threads(run.figure("threads").unwrap_or(1.0) as usize),
            run.text("version").unwrap_or("?")
        ));
        if let (Some(low), Some(high)) = (run.figure("min_dt"), run.figure("max_dt")) {
            lines.push(format!("Δt from {} to {} s", number(low), number(high)));
        }
        let moved = [
            ("lost_particles", "lost"),
            ("foreign_particles", "in another body's elements"),
            ("outflow_particles", "flowed out"),
        ];
        let moved: Vec<String> = moved
            .iter()
            .filter_map(|(key, what)| {
                let n = run.figure(key).filter(|n| *n > 0.0)?;
                Some(format!("{n} particles {what}"))
            })
            .collect();
        if !moved.is_empty() {
            lines.push(moved.join(", "));
        }
    }
    let short = |hash: &str| hash.chars().take(12).collect::<String>();
    if let Some(scene) = &run.scene_hash {
        let state = run
            .text("state_hash")
            .map(|h| format!(", final state {}…", short(h)));
        lines.push(format!(
            "scene {}…{}",
            short(scene),
            state.unwrap_or_default()
        ));
    }
    if let Some(from) = run.text("from") {
        lines.push(format!("began with {from}"));
    }
    lines
}

fn stage(stage: &StageInfo) -> String {
    let when = match (stage.begins, stage.ends) {
        (Some(begins), Some(ends)) => format!("{} to {} s", number(begins), number(ends)),
        (Some(begins), None) => format!("from {} s, not completed", number(begins)),
        (None, _) => "not begun".to_owned(),
    };
    format!("`{}` {when}", stage.name)
}

fn frames(run: &Inspection) -> String {
    match &run.frame_times[..] {
        [] => "none".to_owned(),
        [first, .., last] => format!(
            "{}, t = {} to {} s: {}",
            run.frame_times.len(),
            number(*first),
            number(*last),
            run.folder.join("particles.pvd").display()
        ),
        [only] => format!("1, t = {} s", number(*only)),
    }
}

fn history(run: &Inspection) -> Vec<String> {
    if run.rows == 0 {
        return vec!["no rows yet".to_owned()];
    }
    let mut rows =
        vec![["", "", "last", "least", "at t (s)", "greatest", "at t (s)"].map(str::to_owned)];
    let zero = |c: &&ColumnRange| c.least == 0.0 && c.greatest == 0.0 && c.not_finite == 0;
    for c in run.columns.iter().filter(|c| !zero(c)) {
        let unit = match c.not_finite {
            0 => c.unit.clone(),
            n => format!("{} ({n} not finite)", c.unit),
        };
        let figures = [c.last, c.least, c.least_at, c.greatest, c.greatest_at].map(number);
        let [last, least, least_at, greatest, greatest_at] = figures;
        rows.push([
            c.name.clone(),
            unit,
            last,
            least,
            least_at,
            greatest,
            greatest_at,
        ]);
    }
    let zeros: Vec<&str> = run
        .columns
        .iter()
        .filter(zero)
        .map(|c| c.name.as_str())
        .collect();
    let zeros = match zeros.is_empty() {
        true => Vec::new(),
        false => vec![format!("zero throughout: {}", zeros.join(", "))],
    };
    [vec![format!("{} rows", run.rows)], table(&rows, 2), zeros].concat()
}

/// The fields' ranges, with the place of the end that is farther from zero: of a compressive stress that is
/// the least. With when it was reached where that may differ.
fn field_lines(fields: &[FieldRange], with_time: bool) -> Vec<String> {
    let mut rows = vec![["", "", "least", "greatest", "farthest from 0 at (m)"].map(str::to_owned)];
    for f in fields {
        let farthest = match f.least.value.abs() > f.greatest.value.abs() {
            true => &f.least,
            false => &f.greatest,
        };
        let at = farthest.position.map(number).join(", ");
        let time = match with_time {
            true => format!(", t = {} s", number(farthest.time)),
            false => String::new(),
        };
        let id = farthest.id.map(|id| format!(", particle {id}"));
        let bad = match f.not_finite {
            0 => String::new(),
            n => format!(", {n} values are not finite"),
        };
        // Uniform fields are greatest everywhere.
        let place = match f.least.value == f.greatest.value {
            true => format!("everywhere{bad}"),
            false => format!("[{at}]{}{time}{bad}", id.unwrap_or_default()),
        };
        rows.push([
            f.name.clone(),
            f.unit.unwrap_or_default().to_owned(),
            number(f.least.value),
            number(f.greatest.value),
            place,
        ]);
    }
    let widest = |at: usize| {
        rows.iter()
            .map(|r| r[at].chars().count())
            .max()
            .unwrap_or(0)
    };
    let [name, unit, least, greatest] = [0, 1, 2, 3].map(widest);
    let line = |r: &[String; 5]| {
        format!(
            "{:<name$}  {:<unit$}  {:>least$}  {:>greatest$}  {}\n",
            r[0], r[1], r[2], r[3], r[4]
        )
    };
    rows.iter().map(line).collect()
}

fn energy(run: &Inspection) -> Vec<String> {
    let turned_over = run.figure("energy_turned_over").filter(|e| *e > 0.0);
    let mut rows = Vec::new();
    // What there is nothing of is left out, but for the two that say how good the run is.
    for (kind, joules) in run
        .energy
        .iter()
        .filter(|e| e.1 != 0.0 || e.0 == "residual")
    {
        let share = turned_over.map(|t| format!("{} %", number(100.0 * joules / t)));
        rows.push([
            kind.clone(),
            format!("{} J", number(*joules)),
            share.unwrap_or_default(),
        ]);
    }
    if rows.is_empty() {
        return Vec::new();
    }
    let whole =
        turned_over.map(|t| format!("at the end; shares of the {} J turned over", number(t)));
    let heading = whole.unwrap_or_else(|| "as far as the history goes".to_owned());
    [vec![heading], table(&rows, 1)].concat()
}

fn compared(run: &Inspection) -> Vec<String> {
    let summary = run.summary.as_ref();
    let all = summary
        .and_then(|s| s["compare"].as_array())
        .into_iter()
        .flatten();
    all.map(|c| {
        let text = |key: &str| c[key].as_str().unwrap_or("?").to_owned();
        let figure = |key: &str| c[key].as_f64().unwrap_or(f64::NAN);
        format!(
            "{}: at most {} % of the peak away from {} (at t = {} s)",
            text("column"),
            number(100.0 * figure("relative_difference")),
            text("file"),
            number(figure("at_time"))
        )
    })
    .collect()
}

fn checkpoints(run: &Inspection) -> Vec<String> {
    let line = |c: &CheckpointInfo| {
        let name = c.path.strip_prefix(&run.folder).unwrap_or(&c.path);
        format!("{}: {}", name.display(), of_checkpoint(c))
    };
    let problems = run.checkpoint_problems.iter().cloned();
    run.checkpoints.iter().map(line).chain(problems).collect()
}

fn of_checkpoint(c: &CheckpointInfo) -> String {
    let wall = Duration::try_from_secs_f64(c.wall_time).unwrap_or_default();
    format!(
        "t = {} s, step {}, after {}, {}",
        number(c.time),
        c.step,
        text::duration(wall),
        text::bytes(c.bytes as f64)
    )
}

fn warnings(run: &Inspection) -> Vec<String> {
    let all = run.summary.as_ref().and_then(|s| s["warnings"].as_array());
    let texts = all.into_iter().flatten().filter_map(Value::as_str);
    texts.map(str::to_owned).collect()
}

fn checkpoint_text(c: &CheckpointInfo) -> String {
    format!(
        "{}: {}\nof `{}` by moldwarp {}, {} stages over, scene {}…\n",
        c.path.display(),
        of_checkpoint(c),
        c.case,
        c.version,
        c.stages_over,
        c.scene_hash.chars().take(12).collect::<String>()
    )
}

fn sweep_text(out: &Path, members: &[Member]) -> String {
    let (ended, done) = (
        members.iter().filter(|m| m.exit_code.is_some()).count(),
        members.iter().filter(|m| m.exit_code == Some(0)).count(),
    );
    let mut text = format!(
        "{}: a sweep of {} runs, {ended} ended, {done} of them done\n",
        out.display(),
        members.len()
    );
    for member in members {
        let values: Vec<String> = member
            .values
            .iter()
            .map(|(p, v)| format!("{p}={v}"))
            .collect();
        let how = match (member.exit_code, &member.reason[..]) {
            (None, _) => "not ended".to_owned(),
            (Some(0), _) => "done".to_owned(),
            (Some(code), reason) => format!("code {code}: {reason}"),
        };
        text += &format!(
            "{}: {how}\n            {}\n",
            values.join(", "),
            member.folder.display()
        );
    }
    text
}

fn sweep_json(members: &[Member]) -> Value {
    let run = |m: &Member| {
        let values: Vec<Value> = m
            .values
            .iter()
            .map(|(path, value)| json!({ "path": path, "value": value }))
            .collect();
        json!({
            "folder": m.folder,
            "values": values,
            "exit_code": m.exit_code,
            "reason": m.reason,
            "wall_time": m.wall_time,
        })
    };
    json!({ "runs": members.iter().map(run).collect::<Vec<_>>() })
}
