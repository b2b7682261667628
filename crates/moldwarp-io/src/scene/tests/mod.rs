//! Scenes that are right give the expected plan; scenes that are wrong say where and why.

mod contacts;
mod messages;
mod plans;
mod presence;
mod sectors;
mod stages;

use super::{Scene, SceneError, load};
use miette::{GraphicalReportHandler, GraphicalTheme};
use tempfile::TempDir;

/// A loaded layer on an absorbing bottom, everything written out.
const SAMPLE: &str = r#"version = 1
title = "Suddenly loaded layer on an absorbing bottom"
gravity = ["0 m/s2", "0 m/s2", "0 m/s2"]

[mesh]
box = { size = ["0.1 m", "0.1 m", "1 m"], cells = [1, 1, 10] }

[materials.soil]
model = "linear-elastic"
young_modulus = "100 kPa"
poisson_ratio = 0.0
unit_weight = "18 kN/m3"

[bodies.layer]
volume = "box"
material = "soil"
particles_per_element = 4

[[boundaries]]
name = "sides"
surface = ["x-min", "x-max", "y-min", "y-max"]
kind = "roller"

[[boundaries]]
surface = "z-min"
kind = "absorbing"
alpha = 2.5 # found by trial
virtual_thickness = "0.5 m"

[[loads]]
surface = "z-max"
body = "layer"
traction = ["0 kPa", "0 kPa", "-1 kPa"]
function = { kind = "constant" }

[probes.bottom]
surface = "z-min"
quantities = ["displacement", "stress"]

[numerics]
integration = "mixed"
smoothing = true
courant = 0.5
pic_rate = "0 1/s"
viscosity = 0.0
damping = 0.0

[[stages]]
name = "loading"
duration = "2 s"

[output]
frames = 50
history = 1000
"#;

/// The sample with one part of its text replaced.
fn with(old: &str, new: &str) -> String {
    assert_eq!(SAMPLE.matches(old).count(), 1, "{old:?} must be there once");
    SAMPLE.replace(old, new)
}

/// Writes the text to column/scene.toml and loads it.
fn read(text: &str, sets: &[&str]) -> Result<Scene, Failure> {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("column");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(folder.join("scene.toml"), text).unwrap();
    read_in(dir, sets)
}

/// Loads column/scene.toml of the folder.
fn read_in(dir: TempDir, sets: &[&str]) -> Result<Scene, Failure> {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    load(&dir.path().join("column"), &sets).map_err(|error| Failure { error, dir })
}

/// An error with the folder it happened in.
#[derive(Debug)]
struct Failure {
    error: SceneError,
    dir: TempDir,
}

impl Failure {
    /// As a user sees it, without colour and without the temporary folder.
    fn rendered(&self) -> String {
        let mut text = String::new();
        GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor())
            .with_width(90)
            .render_report(&mut text, &self.error)
            .unwrap();
        let folder = format!("{}{}", self.dir.path().display(), std::path::MAIN_SEPARATOR);
        let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
        lines.join("\n").replace(&folder, "").replace('\\', "/")
    }
}
