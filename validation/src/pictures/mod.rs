//! The pictures of README, examples and book: how each is made, and from which scene it was.
//!
//! `pictures.toml` says how, `pictures.csv` which scene it was: a picture whose scene has changed since is
//! found by a test, without drawing anything.

#[cfg(test)]
mod check;
mod list;
mod record;
mod runs;

pub use list::{Entry, entries, file_and_sets};
pub use record::{Record, fingerprint};

use crate::example;
use std::path::{Path, PathBuf};
use std::process::Command;

type Failure = Box<dyn std::error::Error>;

/// The repository's folder.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// `[--out DIR] [NAME]…`: makes the pictures whose file or scene has one of these names in it, all if there
/// is none. Results are looked for in DIR, `out` if it is not given, and computed where there are none of
/// the scene as it is. Returns whether all were made.
///
/// # Errors
///
/// If the arguments or the list are wrong.
pub fn make(arguments: &[String]) -> Result<bool, Failure> {
    let (out, names) = match arguments {
        [option, out, names @ ..] if option == "--out" => (PathBuf::from(out), names),
        [option, ..] if option.starts_with('-') => {
            return Err(format!("`{option}` is no option; there is --out DIR").into());
        }
        names => (PathBuf::from("out"), names),
    };
    let out = std::path::absolute(out)?;
    let entries = entries()?;
    if let Some(unknown) = names
        .iter()
        .find(|name| !entries.iter().any(|e| e.is_called(name)))
    {
        let all: Vec<&str> = entries
            .iter()
            .flat_map(|e| &e.files)
            .map(String::as_str)
            .collect();
        return Err(format!(
            "no picture is called `{unknown}`; there are\n  {}",
            all.join("\n  ")
        )
        .into());
    }
    let mut record = Record::read()?;
    let mut all_made = true;
    for entry in &entries {
        if !names.is_empty() && !names.iter().any(|name| entry.is_called(name)) {
            continue;
        }
        match draw(entry, &out) {
            Ok(()) => {
                record.replace(entry)?;
                record.write()?;
                entry.files.iter().for_each(|file| println!("{file}"));
            }
            Err(error) => {
                all_made = false;
                eprintln!("{} not made: {error}", entry.files.join(", "));
            }
        }
    }
    Ok(all_made)
}

fn draw(entry: &Entry, out: &Path) -> Result<(), Failure> {
    let (tool, arguments) = entry.make.split_first().ok_or("an entry makes nothing")?;
    let file = root().join(&entry.files[0]);
    if tool == "stress" {
        let scene = arguments.first().ok_or("`stress` needs its scene")?;
        return example::draw_stress(scene, &file);
    }
    let folders = entry
        .scenes
        .iter()
        .map(|scene| runs::results(scene, entry.sweep.as_deref(), out));
    let folders: Vec<PathBuf> = folders.collect::<Result<_, Failure>>()?;
    let mut command = match &tool[..] {
        "moldwarp" => Command::new(runs::program()?),
        "render" => python(&root().join("scripts/render.py")),
        "figures" => python(&entry.folder().join("figures.py")),
        other => return Err(format!("`{other}` is no tool").into()),
    };
    let to = file.parent().unwrap_or(Path::new("."));
    for argument in arguments {
        let mut text = argument.replace("{file}", &file.display().to_string());
        text = text.replace("{to}", &to.display().to_string());
        for (number, folder) in folders.iter().enumerate() {
            text = text.replace(
                &format!("{{{}}}", number + 1),
                &folder.display().to_string(),
            );
        }
        command.arg(text);
    }
    runs::done(command.current_dir(root()))
}

fn python(script: &Path) -> Command {
    let mut command = Command::new("python3");
    command.arg(script);
    command
}
