//! `moldwarp new`: the examples, which are in the binary.

use crate::args::NewArgs;
use crate::exit::Exit;
use crate::{Failure, say};
use moldwarp_io::output::FileError;
use std::fs;
use std::path::Path;

struct Case {
    name: &'static str,
    files: &'static [(&'static str, &'static [u8])],
}

macro_rules! case {
    ($name:literal: $($file:literal),+ $(,)?) => {
        Case {
            name: $name,
            files: &[$((
                $file,
                include_bytes!(concat!("../../../examples/", $name, "/", $file)),
            )),+],
        }
    };
}

const CASES: &[Case] = &[
    case!("absorbing-column":
        "scene.toml", "dashpot.toml", "rigid.toml", "column.geo", "column.msh",
        "exact.csv", "exact-dashpot.csv", "exact-rigid.csv", "README.md",
    ),
    case!("slope": "scene.toml", "slope.geo", "slope.msh", "README.md"),
    case!("tunnel-face":
        "scene.toml", "fine.toml", "stand.toml", "limit.toml", "tunnel.geo", "fine.geo",
        "tunnel.msh", "figures.py", "README.md",
    ),
    case!("drop-anchor":
        "scene.toml", "fine.toml", "finest.toml", "anchor.geo", "fine.geo", "finest.geo", "blunt.geo",
        "anchor.msh", "figures.py", "README.md",
    ),
    case!("dynamic-probing":
        "scene.toml", "medium.toml", "fine.toml", "probe.geo", "medium.geo", "fine.geo", "probe.msh",
        "figures.py", "README.md",
    ),
];

/// Names of the examples.
pub fn names() -> Vec<&'static str> {
    CASES.iter().map(|c| c.name).collect()
}

pub fn new(args: &NewArgs) -> Result<Exit, Failure> {
    let dir = &args.dir;
    let Some(case) = CASES.iter().find(|c| c.name == args.case) else {
        return Err(Failure::input(miette::miette!(
            "there is no example `{}`",
            args.case
        )));
    };
    if dir.exists() && !is_empty(dir).map_err(report)? {
        return Err(Failure::input(miette::miette!(
            help = "name a folder that does not exist yet",
            "{} is not empty",
            dir.display()
        )));
    }
    fs::create_dir_all(dir)
        .map_err(FileError::at("create", dir))
        .map_err(report)?;
    for (name, content) in case.files {
        let path = dir.join(name);
        fs::write(&path, content)
            .map_err(FileError::at("write", &path))
            .map_err(|e| Failure::new(Exit::Files, miette::miette!("{e}")))?;
    }
    say(&format!("next: moldwarp run {}\n", dir.display()));
    Ok(Exit::Done)
}

fn is_empty(dir: &Path) -> Result<bool, FileError> {
    let mut entries = fs::read_dir(dir).map_err(FileError::at("read", dir))?;
    Ok(entries.next().is_none())
}

/// Nothing has been written yet: the argument is wrong.
fn report(error: FileError) -> Failure {
    Failure::input(miette::miette!("{error}"))
}
