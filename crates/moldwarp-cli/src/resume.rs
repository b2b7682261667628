//! `moldwarp resume`.

use crate::args::ResumeArgs;
use crate::exit::Exit;
use crate::progress::Display;
use crate::run::{conclude, simd, start_threads};
use crate::{Failure, say, signals};
use moldwarp_io::run::{RunOptions, resume as go_on};

pub fn resume(args: &ResumeArgs) -> Result<Exit, Failure> {
    let threads = start_threads(args.threads)?;
    let options = RunOptions {
        threads,
        simd: simd(&args.how)?,
        interrupt: signals::watch()?,
        ..RunOptions::default()
    };
    let mut display = Display::new(threads);
    // On a thread of the pool, as in `run`.
    match rayon::scope(|_| go_on(&args.dir, &args.sets, &options, &mut display))? {
        Some(outcome) => conclude(outcome, args.how.profile, args.report),
        None => {
            say(&format!(
                "the run in {} is over; nothing to do\n",
                args.dir.display()
            ));
            Ok(Exit::Done)
        }
    }
}
