//! Many cases of a target, without a fuzzer.

use super::memory::CASE;
use super::mutate::{Seeds, case};
use super::targets::Target;
use std::fs::{create_dir_all, write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// What came of a run.
#[derive(Debug, Default)]
pub struct Tally {
    pub cases: u64,
    /// Those that were right.
    pub right: u64,
    /// The longest case, and its number.
    pub slowest: (Duration, u64),
}

/// Runs the seeds as they are.
///
/// # Panics
///
/// If the target does.
pub fn replay(target: &Target) -> Tally {
    let mut tally = Tally::default();
    for seed in (target.seeds)() {
        tally.cases += 1;
        tally.right += u64::from((target.run)(&seed));
    }
    tally
}

fn seeds(target: &Target) -> Seeds {
    let all = (target.seeds)();
    let right = all.iter().filter(|seed| (target.run)(seed)).cloned();
    let right = right.collect();
    Seeds { all, right }
}

/// Runs the cases from `first` on, until `count` are done or the time is up.
///
/// # Errors
///
/// The number of a case that panicked; its message has been printed.
pub fn run(target: &Target, first: u64, count: u64, limit: Duration) -> Result<Tally, u64> {
    let (seeds, start) = (seeds(target), Instant::now());
    let mut tally = Tally::default();
    for number in first..first.saturating_add(count) {
        if start.elapsed() > limit {
            break;
        }
        let bytes = case(number, &seeds, target.most);
        CASE.store(number, Ordering::Relaxed);
        let begun = Instant::now();
        let right = catch_unwind(AssertUnwindSafe(|| (target.run)(&bytes)));
        tally.right += u64::from(right.map_err(|_| number)?);
        tally.slowest = tally.slowest.max((begun.elapsed(), number));
        tally.cases += 1;
    }
    Ok(tally)
}

/// `TARGET [COUNT [FIRST]]`: so many cases, or ten minutes.
pub fn main(target: &Target) -> ExitCode {
    let mut numbers = std::env::args().skip(1).map(|a| a.parse::<u64>());
    let (count, first) = match (numbers.next(), numbers.next()) {
        (None, _) => (1_000_000, 0),
        (Some(Ok(count)), None) => (count, 0),
        (Some(Ok(count)), Some(Ok(first))) => (count, first),
        _ => {
            eprintln!("usage: {} [COUNT [FIRST]]", target.name);
            return ExitCode::from(2);
        }
    };
    let replayed = replay(target);
    println!(
        "{}: {} seeds, {} of them right",
        target.name, replayed.cases, replayed.right
    );
    let start = Instant::now();
    match run(target, first, count, Duration::from_secs(600)) {
        Ok(tally) => {
            let (longest, number) = tally.slowest;
            println!(
                "{}: {} cases from {first} on in {:.0} s, {} of them right; the longest, {number}, \
                 took {:.3} s",
                target.name,
                tally.cases,
                start.elapsed().as_secs_f64(),
                tally.right,
                longest.as_secs_f64()
            );
            ExitCode::SUCCESS
        }
        Err(number) => {
            let file = format!("artifacts/{}-{number}", target.name);
            let bytes = case(number, &seeds(target), target.most);
            let kept = create_dir_all("artifacts").and_then(|()| write(&file, bytes));
            let kept = kept.map_or_else(|e| e.to_string(), |()| format!("it is kept as {file}"));
            eprintln!(
                "case {number} panicked; {kept}; again: {} 1 {number}",
                target.name
            );
            ExitCode::FAILURE
        }
    }
}
