//! Runs the real command in a folder of its own.

#![allow(dead_code)] // each test file uses its share

use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// A column of soil on an absorbing bottom, suddenly loaded, that computes in no time.
pub const COLUMN: &str = r#"version = 1
title = "A small column"
gravity = ["0 m/s2", "0 m/s2", "0 m/s2"]

[mesh]
box = { size = ["0.1 m", "0.1 m", "0.5 m"], cells = [1, 1, 5] }

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
name = "bottom"
surface = "z-min"
kind = "absorbing"
alpha = 2.5
virtual_thickness = "0.5 m"

[[loads]]
surface = "z-max"
body = "layer"
traction = ["0 kPa", "0 kPa", "-1 kPa"]
function = { kind = "constant" }

[probes.bottom]
surface = "z-min"
quantities = ["displacement"]

[[stages]]
name = "loading"
duration = "0.2 s"

[output]
frames = 4
history = 20
"#;

/// A folder with the scene `column/scene.toml`, under which commands are run.
pub struct Bench {
    dir: tempfile::TempDir,
}

impl Bench {
    pub fn new() -> Bench {
        Bench::with(COLUMN)
    }

    pub fn with(scene: &str) -> Bench {
        let bench = Bench {
            dir: tempfile::tempdir().unwrap(),
        };
        bench.write("column/scene.toml", scene);
        bench
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    pub fn write(&self, name: &str, content: &str) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, content).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// Everything below this folder, by its path, in order.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut found = Vec::new();
        let mut folders = vec![self.path("")];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path.clone());
                }
                found.push(path);
            }
        }
        found.sort();
        found
    }

    /// The command in this folder, without colours and independent of who runs the tests.
    pub fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_moldwarp"));
        command
            .args(args)
            .current_dir(self.dir.path())
            .env("NO_COLOR", "1")
            .env("LC_ALL", "C.UTF-8")
            .env_remove("COLUMNS")
            .stdin(Stdio::null());
        command
    }

    pub fn moldwarp(&self, args: &[&str]) -> Output {
        self.command(args).output().unwrap()
    }

    /// Runs the command, which has to end with this code. Returns what it said on standard error.
    pub fn fails(&self, code: i32, args: &[&str]) -> String {
        let output = self.moldwarp(args);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{said}");
        said
    }

    /// Runs the command, which has to be done. Returns what it said on standard output.
    pub fn done(&self, args: &[&str]) -> String {
        let output = self.moldwarp(args);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
        String::from_utf8(output.stdout).unwrap()
    }

    pub fn summary(&self, out: &str) -> Value {
        serde_json::from_str(&self.read(&format!("{out}/summary.json"))).unwrap()
    }
}
