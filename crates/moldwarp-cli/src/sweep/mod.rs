//! `moldwarp sweep`: a scene with several values, one run after the other or some at a time.
//!
//! Each run is a process of its own, so that whatever ends one leaves the others alone.

mod part;
mod process;

pub use part::part;

use crate::args::{SceneArgs, SweepArgs};
use crate::exit::Exit;
use crate::{Failure, say, text};
use miette::Diagnostic;
use moldwarp_io::output::FileError;
use moldwarp_io::output::hash::scene_hash;
use moldwarp_io::run::{RunError, verify};
use moldwarp_io::scene;
use moldwarp_io::sweep::{self, End, Run, SweepFolder, Table, Variation};
use process::Job;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

pub fn sweep(args: &SweepArgs) -> Result<Exit, Failure> {
    let variations = Variation::parse_all(&args.vary, &args.scene.sets).map_err(Failure::input)?;
    let threads = crate::run::start_threads(args.scene.threads)?;
    let runs = sweep::runs(&variations);
    let checked = check_all(&args.scene, &runs)?;
    let path = match &args.out {
        Some(path) => path.clone(),
        None => sweep::default_path(&checked.case),
    };
    if let Some(earlier) = &checked.earlier {
        earlier.keep_from(&path).map_err(Failure::input)?;
    }
    let (folder, replaced) = SweepFolder::prepare(&path, &checked.folder, args.force)
        .map_err(|e| Failure::from(RunError::from(e)))?;
    let table = Table::new(&variations, &runs, &checked.columns);
    folder.write(&table).map_err(files)?;
    if replaced {
        eprintln!("note: the earlier sweep in {} is replaced", path.display());
    }
    for note in &checked.notes {
        eprintln!("note: {note}");
    }
    let jobs = usize::from(args.jobs).min(runs.len());
    eprintln!(
        "{}, into {}",
        plan(runs.len(), jobs, threads),
        path.display()
    );
    let sweeping = Sweeping {
        args,
        runs: &runs,
        hashes: &checked.hashes,
        folder: &folder,
    };
    let codes = sweeping.compute(table, &shares(threads, jobs))?;
    say(&format!("table: {}\n", folder.table().display()));
    conclusion(&codes)
}

/// What is known of the scenes before the first run.
#[derive(Default)]
struct Checked {
    case: String,
    /// The scene's.
    folder: PathBuf,
    /// Of all scenes, each once.
    notes: Vec<String>,
    earlier: Option<scene::Earlier>,
    /// Of each scene.
    hashes: Vec<String>,
    columns: Vec<Vec<String>>,
}

/// Reads every scene and sets it up, as its run will; nothing is kept of it.
fn check_all(args: &SceneArgs, runs: &[Run]) -> Result<Checked, Failure> {
    let mut checked = Checked::default();
    for run in runs {
        let wrong = |error: RunError| Failure::input(named(error, run));
        let mut scene = scene::load_varied(&args.scene, &args.sets, &run.varied)
            .map_err(|e| wrong(e.into()))?;
        if let Some(from) = &args.from {
            scene::inherit(&mut scene, from).map_err(|e| wrong(e.into()))?;
            checked.earlier.clone_from(&scene.earlier);
        }
        checked.case.clone_from(&scene.case);
        checked.folder.clone_from(&scene.folder);
        for note in &scene.notes {
            if !checked.notes.contains(note) {
                checked.notes.push(note.clone());
            }
        }
        checked.hashes.push(scene_hash(&scene.plan));
        checked.columns.push(verify(scene).map_err(wrong)?);
    }
    Ok(checked)
}

/// The error with the values of its run, unless it names the guilty one, or there was no scene.
fn named(error: RunError, run: &Run) -> miette::Report {
    let known = error.to_string().starts_with("`--") || error.source_code().is_none();
    let report = miette::Report::new(error);
    match known {
        true => report,
        false => report.wrap_err(format!("with {}", run.varied.join(", "))),
    }
}

/// So many runs and how they share the machine.
fn plan(runs: usize, jobs: usize, threads: usize) -> String {
    let runs = match runs {
        1 => "1 run".to_owned(),
        n => format!("{n} runs"),
    };
    match jobs {
        1 => format!("{runs}, {}", text::threads(threads)),
        n => format!(
            "{runs}, {n} at a time sharing {}",
            text::threads(threads.max(n))
        ),
    }
}

/// Threads of each job: as even as can be, and at least one.
fn shares(threads: usize, jobs: usize) -> Vec<usize> {
    let share = |job| threads / jobs + usize::from(job < threads % jobs);
    (0..jobs).map(|job| share(job).max(1)).collect()
}

fn files(error: FileError) -> Failure {
    RunError::from(error).into()
}

/// A sweep whose runs go on.
struct Sweeping<'a> {
    args: &'a SweepArgs,
    runs: &'a [Run],
    hashes: &'a [String],
    folder: &'a SweepFolder,
}

impl Sweeping<'_> {
    /// Makes all runs, as many at a time as there are shares of the threads. Returns their codes.
    fn compute(&self, table: Table, shares: &[usize]) -> Result<Vec<i32>, Failure> {
        let program = std::env::current_exe()
            .map_err(FileError::at("find", Path::new("moldwarp")))
            .map_err(files)?;
        let next = AtomicUsize::new(0);
        let (sender, ended) = channel();
        std::thread::scope(|scope| {
            for &threads in shares {
                let (sender, next, program) = (sender.clone(), &next, &program);
                scope.spawn(move || {
                    while let Some(number) = self.take(next) {
                        let end = self.job(program, number, threads).run();
                        if sender.send((number, end)).is_err() {
                            return;
                        }
                    }
                });
            }
            drop(sender);
            // Where the table cannot be written, the runs that go on are the last.
            self.gather(table, &ended)
                .inspect_err(|_| next.store(self.runs.len(), Ordering::Relaxed))
        })
    }

    /// The number of the next run, if there is one.
    fn take(&self, next: &AtomicUsize) -> Option<usize> {
        let number = next.fetch_add(1, Ordering::Relaxed);
        (number < self.runs.len()).then_some(number)
    }

    fn job<'a>(&'a self, program: &'a Path, number: usize, threads: usize) -> Job<'a> {
        Job {
            program,
            args: self.args,
            varied: &self.runs[number].varied,
            scene_hash: &self.hashes[number],
            out: self.folder.path().join(&self.runs[number].folder),
            threads,
        }
    }

    /// Writes and shows what comes in.
    fn gather(
        &self,
        mut table: Table,
        ended: &Receiver<(usize, End)>,
    ) -> Result<Vec<i32>, Failure> {
        let mut codes = Vec::new();
        for (number, end) in ended {
            codes.push(end.code);
            let line = self.line(codes.len(), number, &end);
            table.end(number, end);
            self.folder.write(&table).map_err(files)?;
            say(&line);
        }
        Ok(codes)
    }

    fn line(&self, done: usize, number: usize, end: &End) -> String {
        let wall = text::duration(Duration::try_from_secs_f64(end.wall_time).unwrap_or_default());
        let outcome = match &end.reason {
            None => format!("done in {wall}"),
            Some(reason) => format!("stopped after {wall}, code {}: {reason}", end.code),
        };
        let values = self.runs[number].varied.join(", ");
        format!("{done}/{}  {values}: {outcome}\n", self.runs.len())
    }
}

/// Done if all runs are, else the greatest of their codes.
fn conclusion(codes: &[i32]) -> Result<Exit, Failure> {
    let stopped = codes.iter().filter(|&&code| code != 0).count();
    let Some(&greatest) = codes.iter().max_by_key(|c| c.unsigned_abs()) else {
        return Ok(Exit::Done);
    };
    if stopped == 0 {
        return Ok(Exit::Done);
    }
    // Some systems have codes that no command can end with.
    let code = ExitCode::from(u8::try_from(greatest).unwrap_or(u8::MAX));
    Err(Failure::new(
        code,
        miette::miette!(
            help = "the table says why; what they computed is kept",
            "{stopped} of {} runs did not come to their end",
            codes.len()
        ),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_shared_out_and_no_job_is_without() {
        assert_eq!(shares(8, 3), [3, 3, 2]);
        assert_eq!(shares(2, 3), [1, 1, 1]);
        assert_eq!(shares(5, 1), [5]);
    }
}
