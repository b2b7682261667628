//! `moldwarp report`.

use crate::args::ReportArgs;
use crate::exit::Exit;
use crate::{Failure, say, text};
use moldwarp_io::report::{Wishes, Written, report as write};
use moldwarp_io::run::Outcome;

pub fn report(args: &ReportArgs) -> Result<Exit, Failure> {
    let wishes = Wishes {
        particles: args.particles.map(|n| n as usize),
        frames: args.frames.map(|n| n as usize),
    };
    let written = write(&args.dir, args.to.as_deref(), wishes)?;
    say(&line(&written));
    Ok(Exit::Done)
}

/// Of a run that has just ended, whatever ended it but an interruption: then there is no time for it.
pub fn of(outcome: &Outcome) -> Result<(), Failure> {
    if outcome.interrupted.is_none() {
        let written = write(outcome.folder.path(), None, Wishes::default());
        let written = written.map_err(|e| Failure::new(Exit::Files, e))?;
        say(&line(&written));
    }
    Ok(())
}

fn line(written: &Written) -> String {
    let left_out = written
        .left_out
        .iter()
        .map(|sentence| format!("{sentence}\n"));
    format!(
        "{}report:  {} ({}, opens in a browser)\n",
        left_out.collect::<String>(),
        written.path.display(),
        text::bytes(written.bytes as f64)
    )
}
