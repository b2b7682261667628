//! The command `moldwarp`.

mod args;
mod check;
mod exit;
mod failure;
mod inspect;
mod manual;
mod new;
mod plot;
mod progress;
mod report;
mod resume;
mod run;
mod signals;
mod sweep;
mod text;

use args::{Args, Command};
use clap::Parser;
use exit::Exit;
use std::io::Write;
use std::process::ExitCode;

fn main() -> ExitCode {
    failure::install();
    let done = match Args::parse().command {
        Command::Run(args) => run::run(&args),
        Command::Resume(args) => resume::resume(&args),
        Command::Check(args) => check::check(&args),
        Command::Sweep(args) => sweep::sweep(&args),
        Command::SweepPart(args) => return sweep::part(&args),
        Command::Report(args) => report::report(&args),
        Command::New(args) => new::new(&args),
        Command::Inspect(args) => inspect::inspect(&args),
        Command::Plot(args) => plot::plot(&args),
        Command::Completions(args) => manual::completions(&args),
        Command::Man(args) => manual::man(&args),
    };
    match done {
        Ok(exit) => exit.into(),
        Err(failure) => {
            eprintln!("{:?}", failure.report);
            failure.exit
        }
    }
}

/// Writes to standard output. Someone who has stopped reading, as `head` does, is no failure:
/// what was computed stands in files.
fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

/// Why a command ended early: what is shown, and the exit code.
struct Failure {
    report: miette::Report,
    exit: ExitCode,
}

impl Failure {
    fn new(exit: impl Into<ExitCode>, report: impl Into<miette::Report>) -> Failure {
        Failure {
            report: report.into(),
            exit: exit.into(),
        }
    }

    /// Wrong input or arguments.
    fn input(report: impl Into<miette::Report>) -> Failure {
        Failure::new(Exit::Input, report)
    }
}

impl From<moldwarp_io::report::ReportError> for Failure {
    fn from(error: moldwarp_io::report::ReportError) -> Failure {
        Failure::input(error)
    }
}

impl From<moldwarp_io::run::RunError> for Failure {
    fn from(error: moldwarp_io::run::RunError) -> Failure {
        let exit = if error.is_input() {
            Exit::Input
        } else {
            Exit::Files
        };
        Failure::new(exit, error)
    }
}
