//! `moldwarp completions` and `moldwarp man`: what the definition of the command makes of itself.

use crate::args::{Args, CompletionsArgs, ManArgs};
use crate::exit::Exit;
use crate::{Failure, say};
use clap::CommandFactory;
use moldwarp_io::output::FileError;
use std::fs;
use std::path::Path;

/// The command as users know it: what only moldwarp itself calls is left out.
fn command() -> clap::Command {
    let whole = Args::command();
    let shown: Vec<clap::Command> = whole
        .get_subcommands()
        .filter(|c| !c.is_hide_set())
        .cloned()
        .collect();
    let bare = clap::Command::new("moldwarp")
        .version(env!("CARGO_PKG_VERSION"))
        .about(whole.get_about().cloned().unwrap_or_default())
        .subcommand_required(true)
        .arg_required_else_help(true);
    bare.subcommands(shown)
}

pub fn completions(args: &CompletionsArgs) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command(), "moldwarp", &mut script);
    say(&String::from_utf8_lossy(&script));
    Ok(Exit::Done)
}

pub fn man(args: &ManArgs) -> Result<Exit, Failure> {
    let Some(dir) = &args.dir else {
        let page = page(&command(), Path::new("moldwarp.1"))?;
        say(&String::from_utf8_lossy(&page));
        return Ok(Exit::Done);
    };
    fs::create_dir_all(dir).map_err(|e| unwritten("create", dir, e))?;
    let whole = command();
    write(dir, &whole)?;
    for part in whole.get_subcommands() {
        let name = format!("moldwarp-{}", part.get_name());
        write(
            dir,
            &part
                .clone()
                .display_name(&name)
                .bin_name(name.replacen('-', " ", 1)),
        )?;
    }
    say(&format!("pages: {}\n", dir.display()));
    Ok(Exit::Done)
}

fn write(dir: &Path, command: &clap::Command) -> Result<(), Failure> {
    let name = command.get_display_name().unwrap_or(command.get_name());
    let path = dir.join(format!("{name}.1"));
    fs::write(&path, page(command, &path)?).map_err(|e| unwritten("write", &path, e))
}

fn page(command: &clap::Command, path: &Path) -> Result<Vec<u8>, Failure> {
    let mut page = Vec::new();
    let man = clap_mangen::Man::new(command.clone());
    man.render(&mut page)
        .map_err(|e| unwritten("write", path, e))?;
    Ok(page)
}

fn unwritten(action: &'static str, path: &Path, reason: std::io::Error) -> Failure {
    let error = FileError::at(action, path)(reason);
    Failure::new(Exit::Files, miette::miette!("{error}"))
}
