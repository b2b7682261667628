//! How a run is shown while it goes on: two lines on a terminal, a line now and then elsewhere.

use crate::text;
use indicatif::{ProgressBar, ProgressStyle};
use moldwarp::Simulation;
use moldwarp_io::output::Folder;
use moldwarp_io::run::{Observer, Progress};
use std::collections::VecDeque;
use std::io::IsTerminal;
use std::time::Duration;

/// Parts of the bar.
const PARTS: u64 = 1000;
/// How far, and below it how: the second line is cut at the terminal's edge.
const TEMPLATE: &str = "{bar:20.cyan/dim} {prefix}\n{wide_msg:.dim}";
/// Without a terminal: a line at each tenth of the run, but no more often than once a second,
/// and at least once a minute.
const LEAST_PAUSE: Duration = Duration::from_secs(1);
const GREATEST_PAUSE: Duration = Duration::from_secs(60);
/// The time left is judged by what was done in this time: steps become shorter and longer on the way.
const LOOK_BACK: Duration = Duration::from_secs(60);

/// Shows a run on standard error.
pub struct Display {
    bar: Option<ProgressBar>,
    threads: usize,
    /// Tenths of the run and wall time at the last line.
    shown: (u32, Duration),
    pace: Pace,
}

impl Display {
    pub fn new(threads: usize) -> Display {
        Display {
            bar: None,
            threads,
            shown: (0, Duration::ZERO),
            pace: Pace::default(),
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
            let style = ProgressStyle::with_template(TEMPLATE);
            let bar = ProgressBar::new(PARTS);
            bar.set_style(style.map_or_else(
                |_| ProgressStyle::default_bar(),
                |style| style.progress_chars("━╸─"),
            ));
            self.bar = Some(bar);
        }
    }

    fn progress(&mut self, progress: &Progress) {
        let left = self.pace.left(progress.elapsed, progress.share());
        if let Some(bar) = &self.bar {
            bar.set_prefix(far(progress, left));
            bar.set_message(how(progress));
            bar.set_position((progress.share() * PARTS as f64) as u64);
            return;
        }
        let tenths = (10.0 * progress.share()) as u32;
        let pause = progress.elapsed.saturating_sub(self.shown.1);
        if (tenths > self.shown.0 && pause >= LEAST_PAUSE) || pause >= GREATEST_PAUSE {
            self.shown = (tenths, progress.elapsed);
            eprintln!("{}; {}", far(progress, left), how(progress));
        }
    }

    fn end(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
        }
    }
}

/// How fast the run has come on lately.
#[derive(Debug, Default)]
struct Pace {
    /// Wall times and shares that were done, of the last while.
    seen: VecDeque<(Duration, f64)>,
}

impl Pace {
    /// Wall time that is left at the pace of late; none before there is one.
    fn left(&mut self, elapsed: Duration, share: f64) -> Option<Duration> {
        self.seen.push_back((elapsed, share));
        // One that is older than that stays, to look back to.
        while self
            .seen
            .get(1)
            .is_some_and(|s| elapsed.saturating_sub(s.0) >= LOOK_BACK)
        {
            self.seen.pop_front();
        }
        let (then, before) = *self.seen.front()?;
        let (spent, done) = ((elapsed - then).as_secs_f64(), share - before);
        if spent < 0.5 || done <= 0.0 {
            return None;
        }
        Duration::try_from_secs_f64(spent * (1.0 - share) / done).ok()
    }
}

/// Share, simulated time and the time left.
fn far(p: &Progress, left: Option<Duration>) -> String {
    let most = if p.may_end_earlier { "at most " } else { "" };
    let left = left.map(|l| format!(", {most}{} left", text::duration(l)));
    format!(
        "{:.0} %, t = {} of {} s{}",
        (100.0 * p.share()).floor(),
        text::number(p.time),
        text::number(p.end),
        left.unwrap_or_default()
    )
}

/// Stage, step, pace, and whether the run is sound so far.
fn how(p: &Progress) -> String {
    let stage = match p.stages {
        1 => String::new(),
        n => format!("stage {} of {n} `{}`, ", p.stage_number + 1, p.stage),
    };
    // Nobody needs to see round-off.
    let residual = match p.residual {
        r if r < 1e-9 => "books close".to_owned(),
        r => format!("residual {} %", text::number(100.0 * r)),
    };
    format!(
        "{stage}step {}, Δt = {} s, {} particle steps/s, {residual}, numerical {:.2} %, kinetic energy {} J",
        p.step,
        text::number(p.time_step),
        text::rate(p.rate),
        100.0 * p.numerical,
        text::number(p.kinetic)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn progress() -> Progress {
        Progress {
            stage: "loading".to_owned(),
            stage_number: 0,
            stages: 1,
            may_end_earlier: false,
            time: 0.5,
            end: 2.0,
            step: 120,
            time_step: 1.25e-3,
            rate: 1.5e6,
            kinetic: 0.25,
            residual: 1e-15,
            numerical: 0.0049,
            elapsed: Duration::from_secs(10),
        }
    }

    #[test]
    fn the_lines_say_how_far_and_how() {
        let left = Some(Duration::from_secs(30));
        assert_eq!(far(&progress(), left), "25 %, t = 0.5 of 2 s, 30.0 s left");
        assert_eq!(
            how(&progress()),
            "step 120, Δt = 0.00125 s, 1.50 M particle steps/s, books close, numerical 0.49 %, \
             kinetic energy 0.25 J"
        );
        let staged = Progress {
            stages: 2,
            stage_number: 1,
            may_end_earlier: true,
            residual: 2e-4,
            ..progress()
        };
        assert_eq!(
            far(&staged, left),
            "25 %, t = 0.5 of 2 s, at most 30.0 s left"
        );
        assert!(how(&staged).starts_with("stage 2 of 2 `loading`, step 120"));
        assert!(how(&staged).contains("residual 0.02 %"));
    }

    #[test]
    fn the_time_left_follows_the_pace_of_late() {
        let mut pace = Pace::default();
        let mut left = None;
        // 1 % a second, and from 50 s on a tenth of that.
        for s in 0..200 {
            let t = f64::from(s);
            let share = if t < 50.0 {
                0.01 * t
            } else {
                0.5 + 0.001 * (t - 50.0)
            };
            left = pace.left(Duration::from_secs(s as u64), share);
            if s == 40 {
                assert_eq!(left.unwrap().as_secs_f64().round(), 60.0);
            }
        }
        let expected = (1.0 - (0.5 + 0.149)) / 0.001;
        assert!((left.unwrap().as_secs_f64() - expected).abs() < 2.0);
        assert_eq!(Pace::default().left(Duration::from_secs(1), 0.5), None);
    }
}
