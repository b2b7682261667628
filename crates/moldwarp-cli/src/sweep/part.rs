//! One run of a sweep as a process, seen from itself: silent but for why it stopped.

use crate::Failure;
use crate::args::PartArgs;
use crate::exit::{Exit, of_stop};
use crate::run::{load, options};
use moldwarp_io::output::hash::scene_hash;
use moldwarp_io::run::run as compute;
use std::process::ExitCode;

pub fn part(args: &PartArgs) -> ExitCode {
    end_with_the_sweep();
    match run(args) {
        Ok(exit) => exit.into(),
        Err(failure) => {
            eprintln!("{}", failure.report);
            failure.exit
        }
    }
}

fn run(args: &PartArgs) -> Result<Exit, Failure> {
    let (scene, threads) = load(&args.run.scene)?;
    if scene_hash(&scene.plan) != args.scene_hash {
        return Err(Failure::input(miette::miette!(
            "the scene or its mesh was changed while the sweep went on"
        )));
    }
    let outcome = compute(scene, &options(&args.run, threads)?, &mut ())?;
    match outcome.stopped {
        None => Ok(Exit::Done),
        Some(stop) => Err(Failure::new(of_stop(&stop), miette::miette!("{stop}"))),
    }
}

/// The sweep holds the other end of standard input, and nothing is ever written to it: it ends when
/// the sweep does. The code is seen by no one.
fn end_with_the_sweep() {
    std::thread::spawn(|| {
        let _ = std::io::copy(&mut std::io::stdin(), &mut std::io::sink());
        std::process::exit(Exit::Files as i32);
    });
}
