//! One run of a sweep as a process, seen from the sweep.

use crate::args::SweepArgs;
use moldwarp_io::output::csv;
use moldwarp_io::sweep::{End, extremes};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Output, Stdio};
use std::time::Instant;

/// What a process needs to know.
pub struct Job<'a> {
    /// This one.
    pub program: &'a Path,
    pub args: &'a SweepArgs,
    pub varied: &'a [String],
    pub scene_hash: &'a str,
    pub out: PathBuf,
    pub threads: usize,
}

impl Job<'_> {
    /// Makes the run and waits for it.
    pub fn run(&self) -> End {
        let begun = Instant::now();
        let ended = self.process();
        let wall_time = begun.elapsed().as_secs_f64();
        let (code, reason) = match ended {
            Ok(output) => (code(output.status), reason(&output)),
            Err(e) => (4, Some(format!("the run cannot be started: {e}"))),
        };
        // A run that did not even begin has none, and one that crashed may have half a row.
        let (history, missing) = match csv::read(&self.out.join("history.csv")) {
            Ok(history) => (extremes(&history), None),
            Err(e) => (Vec::new(), Some(e.to_string())),
        };
        End {
            code,
            reason: reason.or(missing),
            wall_time,
            history,
        }
    }

    fn process(&self) -> io::Result<Output> {
        let mut command = Command::new(self.program);
        command.args(["sweep-part", "--scene-hash", self.scene_hash]);
        command.arg("--out").arg(&self.out);
        command.arg(format!("--threads={}", self.threads));
        for set in self.args.scene.sets.iter().chain(self.varied) {
            command.arg(format!("--set={set}"));
        }
        if let Some(from) = &self.args.scene.from {
            command.arg(format!("--from={from}"));
        }
        if self.args.force {
            command.arg("--force");
        }
        let mut child = command
            .arg("--")
            .arg(&self.args.scene.scene)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()?;
        // Open until the run has ended, or this process has, however it does: then the run ends.
        let lifeline = child.stdin.take();
        let output = child.wait_with_output();
        drop(lifeline);
        output
    }
}

/// The exit code; for what was ended by a signal 128 and its number, as shells say.
fn code(status: ExitStatus) -> i32 {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return 128 + signal;
    }
    status.code().unwrap_or(i32::MAX)
}

/// Why it stopped, in its own words if it had any.
fn reason(output: &Output) -> Option<String> {
    if output.status.success() {
        return None;
    }
    let said = String::from_utf8_lossy(&output.stderr);
    let lines: Vec<&str> = said.lines().map(str::trim).collect();
    Some(match (lines.join(" ").trim(), output.status.code()) {
        ("", _) => output.status.to_string(),
        (said, Some(_)) => said.to_owned(),
        (said, None) => format!("{}: {said}", output.status),
    })
}
