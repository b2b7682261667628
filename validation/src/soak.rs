//! A soak: an example over and over, interrupted at random and resumed, in one process.
//!
//! All runs must end with the same `state_hash`, and the process must not grow.

use moldwarp_io::run::{Outcome, RunOptions, resume, run};
use moldwarp_io::scene;
use std::error::Error;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Longest time to an interruption, s; the shortest is a tenth.
const PATIENCE: f64 = 15.0;
/// Interruptions of a run at most: the rest of it is done in one go.
const MOST: u32 = 6;
/// Growth of the process's memory that is none, as a share.
const GROWTH: f64 = 0.05;
/// The signal that interruptions pretend to be.
const TERMINATED: usize = 15;

/// `soak [RUNS [EXAMPLE]]`.
pub fn soak(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let runs: u32 = arguments.first().map_or(Ok(10), |a| a.parse())?;
    let example = arguments.get(1).map_or("tunnel-face", String::as_str);
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the repository");
    let file = root.join("examples").join(example).join("scene.toml");
    let out = root.join("target/soak");
    let mut random = Random(0x5eed);
    println!("| run | interrupted | wall time (s) | memory after (MB) | state |");
    println!("|---|---|---|---|---|");
    let (mut hashes, mut memories) = (Vec::new(), Vec::new());
    for number in 1..=runs {
        let start = Instant::now();
        let folder = out.join(number.to_string());
        let (outcome, interrupted) = interrupted_run(&file, &folder, &mut random)?;
        let memory = resident();
        let hash = outcome.summary.state_hash;
        println!(
            "| {number} | {interrupted} | {:.0} | {} | {} |",
            start.elapsed().as_secs_f64(),
            memory.map_or("?".into(), |m| format!("{m:.0}")),
            &hash[..16.min(hash.len())],
        );
        hashes.push(hash);
        memories.extend(memory);
    }
    if hashes.iter().any(|hash| *hash != hashes[0]) {
        return Err("the runs have ended differently".into());
    }
    // The first run fills pools that stay.
    if let (Some(second), Some(last)) = (memories.get(1), memories.last())
        && *last > second * (1.0 + GROWTH)
    {
        return Err(format!("the process has grown from {second:.0} to {last:.0} MB").into());
    }
    println!("\n{runs} runs of {example}, all with state {}", hashes[0]);
    Ok(())
}

/// A whole run, and how often it was interrupted.
fn interrupted_run(
    file: &Path,
    folder: &Path,
    random: &mut Random,
) -> Result<(Outcome, u32), Box<dyn Error>> {
    let mut options = options(folder);
    let mut timer = Timer::start(&options, Some(random.within(PATIENCE)));
    let mut outcome = run(scene::load(file, &[])?, &options, &mut ())?;
    let mut interrupted = 0;
    while outcome.interrupted.is_some() {
        drop(timer);
        interrupted += 1;
        options = self::options(folder);
        let next = (interrupted < MOST).then(|| random.within(PATIENCE));
        timer = Timer::start(&options, next);
        let Some(next) = resume(folder, &[], &options, &mut ())? else {
            return Err("an interrupted run is called finished".into());
        };
        outcome = next;
    }
    drop(timer);
    match &outcome.stopped {
        Some(stop) => Err(stop.to_string().into()),
        None => Ok((outcome, interrupted)),
    }
}

fn options(folder: &Path) -> RunOptions {
    RunOptions {
        out: Some(folder.to_owned()),
        force: true,
        ..RunOptions::default()
    }
}

/// Asks a run to stop after some seconds, unless it is over before.
struct Timer {
    over: Option<std::sync::mpsc::Sender<()>>,
    thread: Option<std::thread::JoinHandle<()>>,
}

impl Timer {
    fn start(options: &RunOptions, seconds: Option<f64>) -> Timer {
        let Some(seconds) = seconds else {
            return Timer {
                over: None,
                thread: None,
            };
        };
        let signal = options.interrupt.signal().clone();
        let (over, waiting): (_, Receiver<()>) = channel();
        let thread = std::thread::spawn(move || {
            let ended = waiting.recv_timeout(Duration::from_secs_f64(seconds));
            if ended == Err(RecvTimeoutError::Timeout) {
                signal.store(TERMINATED, Ordering::Relaxed);
            }
        });
        Timer {
            over: Some(over),
            thread: Some(thread),
        }
    }
}

impl Drop for Timer {
    fn drop(&mut self) {
        self.over = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Memory of this process that is in use, MB; where the system tells.
fn resident() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1e3)
}

/// Xorshift.
struct Random(u64);

impl Random {
    /// Between a tenth of this and it.
    fn within(&mut self, most: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        let unit = (self.0 >> 11) as f64 / (1u64 << 53) as f64;
        most * (0.1 + 0.9 * unit)
    }
}
