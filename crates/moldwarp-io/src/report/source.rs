//! A run's folder as it is read for a report, of which nothing but the folder is needed; or a session.

use super::ReportError;
use crate::output::csv::{self, Table};
use crate::output::{FileError, Folder};
use crate::run::{Framed, GOING_ON, Session};
use crate::scene::Outline;
use crate::text::number;
use moldwarp::plan::Quantity;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// What stands in the folder, but for the frames, which are read when they are needed.
#[derive(Debug)]
pub struct Source {
    /// As run.
    pub scene: String,
    pub outline: Outline,
    /// None of a run that is not over.
    pub summary: Option<Value>,
    /// `summary.json` as it stands; empty if there is none.
    pub summary_text: String,
    /// `history.csv` as it stands, but for a last row that is not complete; empty if there is none.
    pub history_text: String,
    pub history: Table,
    /// Times, s, and paths of the frames of the particles.
    pub particles: Vec<(f64, PathBuf)>,
    /// The same of the mesh.
    pub mesh: Vec<(f64, PathBuf)>,
    /// What the frames do not show, a sentence each.
    pub left_out: Vec<String>,
}

impl Source {
    /// Reads what a run has written.
    pub fn read(path: &Path) -> Result<Source, ReportError> {
        if !path.exists() {
            return Err(ReportError::Missing(path.to_owned()));
        }
        if path.join("sweep.csv").is_file() {
            return Err(ReportError::Sweep(path.to_owned()));
        }
        if !Folder::is_a_run(path) {
            return Err(ReportError::NoRun(path.to_owned()));
        }
        let folder = Folder::resume(path);
        let scene = read(&folder.scene())?;
        let outline = Outline::read(&scene, &folder.scene())?;
        let summary_text = read_if_there(&folder.summary())?;
        let summary = match summary_text.is_empty() {
            true => None,
            false => Some(parse(&summary_text, &folder.summary())?),
        };
        let (history_text, history) = history(&folder.history())?;
        Ok(Source {
            scene,
            outline,
            summary,
            summary_text,
            history_text,
            history,
            particles: collection(&folder, "particles")?,
            mesh: collection(&folder, "mesh")?,
            left_out: Vec::new(),
        })
    }

    /// A session as it stands, computed with so many threads. What is read again from files is written into
    /// `work`.
    pub fn of(session: &Session, threads: usize, work: &Path) -> Result<Source, ReportError> {
        let paths = ["scene.toml", "summary.json", "history.csv"].map(|name| work.join(name));
        let [scene_path, summary_path, history_path] = &paths;
        session.summary(threads).write(summary_path)?;
        session.write_history(history_path)?;
        let summary_text = read(summary_path)?;
        let (history_text, history) = history(history_path)?;
        let frames = session.frames(work)?;
        let of_kind = |kind: usize| {
            let frames = frames.iter();
            frames
                .map(|(time, paths)| (*time, paths[kind].clone()))
                .collect()
        };
        Ok(Source {
            scene: session.text().to_owned(),
            outline: Outline::read(session.text(), scene_path)?,
            summary: Some(parse(&summary_text, summary_path)?),
            summary_text,
            history_text,
            history,
            particles: of_kind(0),
            mesh: of_kind(1),
            left_out: not_kept(&frames),
        })
    }

    /// Whether it has ended, in whatever way.
    pub fn is_over(&self) -> bool {
        let summary = self.summary.as_ref();
        summary.is_some_and(|summary| summary["exit"] != GOING_ON)
    }

    /// The unit of a column of the history; empty if it has none or is not known.
    pub fn unit(&self, column: &str) -> String {
        let known = self
            .summary
            .as_ref()
            .and_then(|s| s["units"][column].as_str());
        match known {
            Some(unit) => unit.to_owned(),
            None => unit_by_name(column).to_owned(),
        }
    }
}

/// What frames of a session do not show, a sentence or none.
fn not_kept(frames: &[Framed]) -> Vec<String> {
    let time = frames.first().map_or(0.0, |frame| frame.0);
    let sentence = match frames.len() {
        _ if time == 0.0 => return Vec::new(),
        1 => {
            "The 3D view shows the last state alone, since no frames were kept; answers from frames are of it, too."
        }
        _ => {
            "The 3D view begins at t = {}, since no frames were kept before; answers from frames do, too."
        }
    };
    vec![sentence.replace("{}", &format!("{} s", number(time)))]
}

/// For runs that are not over, whose units nothing tells yet.
fn unit_by_name(column: &str) -> &'static str {
    let words: Vec<&str> = column.split('.').collect();
    match words[..] {
        ["time" | "stage_time" | "dt"] => "s",
        ["energy", _] => "J",
        ["contact", _, "normal" | "tangential", _] => "N",
        [_, quantity, ..] => {
            let quantity = Quantity::ALL.iter().find(|q| q.0 == quantity);
            quantity.map_or("", |q| q.1.unit())
        }
        _ => "",
    }
}

fn read(path: &Path) -> Result<String, FileError> {
    std::fs::read_to_string(path).map_err(FileError::at("read", path))
}

fn read_if_there(path: &Path) -> Result<String, FileError> {
    match path.exists() {
        true => read(path),
        false => Ok(String::new()),
    }
}

fn parse(text: &str, path: &Path) -> Result<Value, ReportError> {
    let broken = |problem: String| ReportError::Broken {
        path: path.to_owned(),
        problem,
    };
    let value: Value = serde_json::from_str(text).map_err(|e| broken(format!("no JSON: {e}")))?;
    for key in ["exit", "time", "steps", "particles", "energy", "warnings"] {
        if value.get(key).is_none() {
            return Err(broken(format!("it has no `{key}`")));
        }
    }
    Ok(value)
}

/// The rows that are complete: a run that is at work, or was killed, may have written a part of one.
fn history(path: &Path) -> Result<(String, Table), ReportError> {
    let mut text = read_if_there(path)?;
    text.truncate(text.rfind('\n').map_or(0, |end| end + 1));
    let empty = Table {
        names: Vec::new(),
        columns: Vec::new(),
    };
    let table = match text.is_empty() {
        true => empty,
        false => csv::parse(&text, path)?,
    };
    Ok((text, table))
}

/// The frames that a collection names, in order.
fn collection(folder: &Folder, kind: &str) -> Result<Vec<(f64, PathBuf)>, ReportError> {
    let path = folder.collection(kind);
    let text = read_if_there(&path)?;
    let lines = text.lines().filter_map(|l| l.strip_prefix("<DataSet "));
    let frame = |line: &str| {
        let after = |key: &str| line.split(key).nth(1)?.split('"').nth(1);
        let time = after("timestep=")?.parse().ok()?;
        Some((time, folder.path().join(after("file=")?)))
    };
    let frames: Option<Vec<_>> = lines.map(frame).collect();
    match frames {
        Some(frames) if frames.len() == text.matches("<DataSet").count() => Ok(frames),
        _ => Err(ReportError::Broken {
            path,
            problem: "a line of it does not name a frame as moldwarp does".to_owned(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_follow_from_names_where_no_summary_tells_them() {
        let all = [
            ("time", "s"),
            ("step", ""),
            ("bottom.displacement.z", "m"),
            ("bottom.stress.xx", "Pa"),
            ("tip.penetration", "m"),
            ("tip.contact.x", "N"),
            ("bore.volume", "m3"),
            ("contact.anchor.normal.z", "N"),
            ("contact.anchor.open", ""),
            ("energy.kinetic", "J"),
        ];
        for (column, unit) in all {
            assert_eq!(unit_by_name(column), unit, "{column}");
        }
    }
}
