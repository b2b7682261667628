//! How a run is shown while it goes on: a bar on a terminal, a line now and then elsewhere.

use crate::text;
use indicatif::{ProgressBar, ProgressStyle};
use moldwarp::Simulation;
use moldwarp_io::output::Folder;
use moldwarp_io::run::{Observer, Progress};
use std::io::IsTerminal;
use std::time::Duration;

/// Parts of the bar.
const PARTS: u64 = 1000;
/// Without a terminal: a line at each tenth of the run, but no more often than once a second,
/// and at least once a minute.
const LEAST_PAUSE: Duration = Duration::from_secs(1);
const GREATEST_PAUSE: Duration = Duration::from_secs(60);

/// Shows a run on standard error.
pub struct Display {
    bar: Option<ProgressBar>,
    threads: usize,
    /// Tenths of the run and wall time at the last line.
    shown: (u32, Duration),
}

impl Display {
    pub fn new(threads: usize) -> Display {
        Display {
            bar: None,
            threads,
            shown: (0, Duration::ZERO),
        }
    }
}

impl Observer for Display {
    fn begin(&mut self, sim: &Simulation, folder: &Folder, notes: &[String]) {
        for note in notes {
            eprintln!("note: {note}");
        }
        eprintln!(
            "{} particles in {} elements, {}, into {}",
            sim.particles().len(),
            sim.mesh().tets.len(),
            text::threads(self.threads),
            folder.path().display()
        );
        if std::io::stderr().is_terminal() {
            let style = ProgressStyle::with_template("{bar:30} {msg}");
            let bar = ProgressBar::new(PARTS);
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            self.bar = Some(bar);
        }
    }

    fn progress(&mut self, progress: &Progress) {
        if let Some(bar) = &self.bar {
            bar.set_position((progress.share() * PARTS as f64) as u64);
            bar.set_message(line(progress));
            return;
        }
        let tenths = (10.0 * progress.share()) as u32;
        let pause = progress.elapsed.saturating_sub(self.shown.1);
        if (tenths > self.shown.0 && pause >= LEAST_PAUSE) || pause >= GREATEST_PAUSE {
            self.shown = (tenths, progress.elapsed);
            eprintln!("{}", line(progress));
        }
    }

    fn end(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

/// Simulated time, step, Δt, pace and the time left.
fn line(p: &Progress) -> String {
    let left = p.left().map(|l| format!(", {} left", text::duration(l)));
    format!(
        "t = {} of {} s, step {}, Δt = {} s, {} particle steps/s{}",
        text::number(p.time),
        text::number(p.end),
        p.step,
        text::number(p.time_step),
        text::rate(p.rate),
        left.unwrap_or_default()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_says_how_far_and_how_long() {
        let progress = Progress {
            time: 0.5,
            end: 2.0,
            step: 120,
            time_step: 1.25e-3,
            rate: 1.5e6,
            elapsed: Duration::from_secs(10),
        };
        assert_eq!(
            line(&progress),
            "t = 0.5 of 2 s, step 120, Δt = 0.00125 s, 1.50 M particle steps/s, 30.0 s left"
        );
    }
}
