//! The stages of a run and when they went on.

use super::Results;
use serde::Serialize;
use std::collections::HashMap;

/// A stage of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StageInfo {
    pub name: String,
    /// s since the run's start; none if it has not begun.
    pub begins: Option<f64>,
    /// s since the run's start; none if it has not ended.
    pub ends: Option<f64>,
}

impl Results {
    /// The scene's stages, in order. `end` is when the run ended, s, if it came to its end.
    pub fn stages(&self, end: Option<f64>) -> Vec<StageInfo> {
        // The log of a run that was resumed may tell of a stage twice; the later beginning holds.
        let mut begun: HashMap<&str, f64> = HashMap::new();
        for line in &self.log {
            if let Some((name, time)) = beginning(line) {
                begun.insert(name, time);
            }
        }
        let stages = self.scene.get("stages").and_then(toml::Value::as_array);
        let names: Vec<String> = stages
            .into_iter()
            .flatten()
            .enumerate()
            .map(|(number, stage)| {
                let name = stage.get("name").and_then(toml::Value::as_str);
                name.map_or_else(|| number.to_string(), str::to_owned)
            })
            .collect();
        let begins: Vec<Option<f64>> = names
            .iter()
            .map(|name| begun.get(&name[..]).copied())
            .collect();
        let ends = begins.iter().skip(1).copied().chain([end]);
        let all = names.into_iter().zip(&begins).zip(ends);
        all.map(|((name, &begins), ends)| StageInfo {
            name,
            begins,
            ends: ends.filter(|_| begins.is_some()),
        })
        .collect()
    }
}

/// The name and the time of a line that says that a stage begins.
fn beginning(line: &str) -> Option<(&str, f64)> {
    let (_, rest) = line.split_once(" s  stage `")?;
    let (name, time) = rest.rsplit_once("` begins at ")?;
    Some((name, time.strip_suffix(" s")?.parse().ok()?))
}
