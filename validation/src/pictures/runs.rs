//! The results that pictures are made from: those that there are, or new ones.

use super::{Failure, file_and_sets};
use moldwarp_io::output::hash::scene_hash;
use moldwarp_io::results::{Results, State};
use moldwarp_io::scene;
use moldwarp_io::sweep;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The command, which lies beside this program.
pub(super) fn program() -> Result<PathBuf, Failure> {
    let own = std::env::current_exe()?;
    let program = own.with_file_name(format!("moldwarp{}", std::env::consts::EXE_SUFFIX));
    match program.exists() {
        true => Ok(program),
        false => Err("the command `moldwarp` is not built: `cargo build --release` does it".into()),
    }
}

/// The folder with the results of a scene, or of its sweep, under `out`. They are computed if they are
/// not there, or are of the scene as it was before.
pub(super) fn results(scene: &str, sweep: Option<&str>, out: &Path) -> Result<PathBuf, Failure> {
    let (path, sets) = file_and_sets(scene);
    let loaded = scene::load(&path, &sets)?;
    // `mesh.file=medium.msh` goes to `CASE-medium`.
    let value = sets
        .first()
        .and_then(|set| set.rsplit('=').next())
        .map(Path::new);
    let suffix = match (sweep, value.and_then(Path::file_stem)) {
        (Some(_), _) => "-sweep".to_owned(),
        (None, Some(value)) => format!("-{}", value.to_string_lossy()),
        (None, None) => String::new(),
    };
    let folder = out.join(format!("{}{suffix}", loaded.case));
    let there = match sweep {
        // The hash of a sweep's run is that of its value; that all have come to their end has to do.
        Some(_) => sweep::members(&folder).is_some_and(|m| m.iter().all(|m| m.exit_code.is_some())),
        None => is_of(&folder, &scene_hash(&loaded.plan)),
    };
    if !there {
        println!("{scene} is computed into {}", folder.display());
        let mut command = Command::new(program()?);
        command
            .arg(if sweep.is_some() { "sweep" } else { "run" })
            .arg(&path);
        command.arg("--out").arg(&folder);
        sets.iter().for_each(|set| {
            command.args(["--set", set]);
        });
        if let Some(values) = sweep {
            command.args(["--vary", values]);
        }
        done(&mut command)?;
    }
    Ok(folder)
}

/// Whether a folder has results of this scene that are over.
fn is_of(folder: &Path, hash: &str) -> bool {
    let results = Results::open(folder).ok();
    results.is_some_and(|r| {
        matches!(r.state, State::Done | State::Stopped) && r.scene_hash() == Some(hash)
    })
}

/// Runs a command, which has to come to its end well.
pub(super) fn done(command: &mut Command) -> Result<(), Failure> {
    let name = command.get_program().to_string_lossy().into_owned();
    let status = command
        .status()
        .map_err(|e| format!("cannot run {name}: {e}"))?;
    match status.success() {
        true => Ok(()),
        false => Err(format!("{name} ended with {status}").into()),
    }
}
