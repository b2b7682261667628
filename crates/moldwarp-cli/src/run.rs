//! `moldwarp run`.

use crate::args::{HowArgs, RunArgs, SceneArgs};
use crate::exit::{Exit, of_signal, of_stop};
use crate::progress::Display;
use crate::{Failure, report, say, signals, text};
use moldwarp::Simd;
use moldwarp::measure::Energies;
use moldwarp_io::output::summary::Compared;
use moldwarp_io::run::{Outcome, RunOptions, run as compute};
use moldwarp_io::scene::{self, Scene};
use std::time::Duration;

pub fn run(args: &RunArgs) -> Result<Exit, Failure> {
    let (scene, threads) = load(&args.scene)?;
    let options = RunOptions {
        interrupt: signals::watch()?,
        ..options(args, threads)?
    };
    // On a thread of the pool, so that the step need not wait for one to wake up.
    let outcome = rayon::scope(|_| compute(scene, &options, &mut Display::new(threads)))?;
    conclude(outcome, args.how.profile, args.report)
}

/// Says how a run has ended, and writes a report of it if it is wanted.
pub fn conclude(outcome: Outcome, with_profile: bool, with_report: bool) -> Result<Exit, Failure> {
    if let Some(signal) = outcome.interrupted {
        eprintln!(
            "interrupted at step {}, t = {} s; `moldwarp resume {}` goes on from there",
            outcome.summary.steps,
            text::number(outcome.summary.time),
            outcome.folder.path().display()
        );
        return Ok(of_signal(signal));
    }
    say(&conclusion(&outcome));
    if with_profile {
        say(&profile(&outcome));
    }
    if with_report {
        report::of(&outcome)?;
    }
    let Some(stop) = &outcome.stopped else {
        return Ok(Exit::Done);
    };
    let exit = of_stop(stop);
    let help = match exit {
        Exit::NotAtRest => format!(
            "frames and history up to then are kept; `moldwarp resume {} --set \
             stages.NAME.duration=…` gives the stage more time",
            outcome.folder.path().display()
        ),
        _ => "frames and history up to then are kept".to_owned(),
    };
    let steps = outcome.summary.steps;
    Err(Failure::new(
        exit,
        miette::miette!(help = help, "stopped after {steps} steps: {stop}"),
    ))
}

/// How the arguments want the run to be made.
pub fn options(args: &RunArgs, threads: usize) -> Result<RunOptions, Failure> {
    Ok(RunOptions {
        out: args.out.clone(),
        force: args.force,
        threads,
        simd: simd(&args.how)?,
        ..RunOptions::default()
    })
}

/// The instructions that are asked for.
pub fn simd(args: &HowArgs) -> Result<Option<Simd>, Failure> {
    let simd = args.simd.as_ref().map(|name| {
        Simd::named(name)
            .ok_or_else(|| Failure::input(miette::miette!("this processor does not have {name}")))
    });
    simd.transpose()
}

/// Sets the threads up and reads the scene. Returns the number of threads beside it.
pub fn load(args: &SceneArgs) -> Result<(Scene, usize), Failure> {
    let threads = start_threads(args.threads)?;
    let mut scene = scene::load(&args.scene, &args.sets).map_err(Failure::input)?;
    if let Some(from) = &args.from {
        scene::inherit(&mut scene, from).map_err(Failure::input)?;
    }
    Ok((scene, threads))
}

/// Sets the threads up and returns their number.
pub fn start_threads(wanted: Option<u16>) -> Result<usize, Failure> {
    let wanted = wanted.map_or(0, usize::from);
    rayon::ThreadPoolBuilder::new()
        .num_threads(wanted)
        .build_global()
        .map_err(|e| Failure::input(miette::miette!("cannot start {wanted} threads: {e}")))?;
    Ok(rayon::current_num_threads())
}

/// Where the time of the steps went, in the order of a step.
fn profile(outcome: &Outcome) -> String {
    let whole: Duration = outcome.profile.spent().map(|(_, time)| time).sum();
    let share = |time: Duration| 100.0 * time.as_secs_f64() / whole.as_secs_f64();
    let parts = outcome.profile.spent().map(|(name, time)| {
        let (seconds, share) = (time.as_secs_f64(), share(time));
        format!("  {name:<30} {seconds:9.2} s {share:5.1} %\n")
    });
    format!("time:\n{}", parts.collect::<String>())
}

/// How the run went and where to look.
fn conclusion(outcome: &Outcome) -> String {
    let s = &outcome.summary;
    let wall = Duration::try_from_secs_f64(s.wall_time).unwrap_or_default();
    let mut lines = vec![format!(
        "t = {} s in {} steps and {}, {} particle steps/s",
        text::number(s.time),
        s.steps,
        text::duration(wall),
        text::rate(s.particle_steps_per_second)
    )];
    lines.extend(s.compare.iter().map(compared));
    lines.extend(outcome.problems.iter().cloned());
    lines.extend(ledger(&outcome.energies, s.energy_turned_over));
    if s.outflow_particles > 0 {
        lines.push(format!(
            "outflow: {} particles of {} kg",
            s.outflow_particles,
            text::number(s.outflow_mass)
        ));
    }
    lines.extend(s.warnings.iter().map(|w| format!("warning: {w}")));
    let frames = outcome.folder.collection("particles");
    if frames.exists() {
        lines.push(format!("frames:  {} (ParaView)", frames.display()));
    }
    lines.push(format!("history: {}", outcome.folder.history().display()));
    lines.iter().map(|l| format!("{l}\n")).collect()
}

fn compared(c: &Compared) -> String {
    format!(
        "{}: at most {} % of the peak away from {} (at t = {} s)",
        c.column,
        text::number(100.0 * c.relative_difference),
        c.file,
        text::number(c.at_time)
    )
}

/// The balance of energy in two lines: whether it holds, and how good the run is.
fn ledger(energies: &Energies, turned_over: f64) -> [String; 2] {
    let share = |joules: f64| {
        if turned_over > 0.0 {
            text::number(100.0 * joules / turned_over)
        } else {
            text::number(0.0)
        }
    };
    [
        format!(
            "energy:  residual {} % of the {} J turned over",
            share(energies.residual.abs()),
            text::number(turned_over)
        ),
        format!(
            "         numerical terms {} % of it",
            share(energies.numerical())
        ),
    ]
}
