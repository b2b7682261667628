//! The folder that a run writes into, and when it may.

use super::FileError;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// Present in the folder of a run that is over.
const SUMMARY: &str = "summary.json";
/// Present in the folder of every run that has begun.
const LOG: &str = "run.log";
/// Of a run that is over, or of its part that is there.
const REPORT: &str = "report.html";
/// Frames are in a folder of their own; the `.pvd` files beside it name them.
const FRAMES: &str = "frames";
/// Particles at the ends of stages, in a folder of their own.
const STAGES: &str = "stages";
/// What a run goes on from when it was interrupted, in a folder of its own.
const CHECKPOINTS: &str = "checkpoints";
/// Folders in the folder of a run.
const FOLDERS: [&str; 3] = [FRAMES, STAGES, CHECKPOINTS];
/// Everything a run writes, by its name in the folder.
const OURS: [&str; 10] = [
    SUMMARY,
    LOG,
    FRAMES,
    STAGES,
    CHECKPOINTS,
    "scene.toml",
    "history.csv",
    "particles.pvd",
    "mesh.pvd",
    REPORT,
];

/// A folder that is ready for a run: it exists, and nothing of an earlier run is left in it but
/// an emptied log.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

/// Why a folder is not written into.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// `what` is a run or a sweep.
    #[error("{} holds a {what} that is not finished", .path.display())]
    Unfinished { path: PathBuf, what: &'static str },
    #[error("{} holds files that are not {whose}, such as {}", .path.display(), .file.display())]
    Foreign {
        path: PathBuf,
        file: PathBuf,
        whose: &'static str,
    },
    #[error("{} is the scene's own folder", .path.display())]
    Scene { path: PathBuf },
    #[error("{} is a file, not a folder", .path.display())]
    NotAFolder { path: PathBuf },
    #[error(transparent)]
    File(#[from] FileError),
}

impl FolderError {
    /// What the user can do about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            FolderError::Unfinished { what: "run", .. } => {
                "`moldwarp resume DIR` goes on with it; `--force` replaces it; `--out DIR` writes \
                 somewhere else"
            }
            FolderError::Unfinished { .. } => {
                "`--force` replaces it; `--out DIR` writes somewhere else"
            }
            FolderError::Foreign { .. } => {
                "`--out DIR` writes somewhere else; `--force` writes beside them and leaves them as they are"
            }
            FolderError::Scene { .. } | FolderError::NotAFolder { .. } | FolderError::File(_) => {
                "name another folder with `--out DIR`"
            }
        }
    }
}

/// What stands in a folder before a run.
#[derive(Debug, PartialEq)]
enum Found {
    Nothing,
    Finished,
    Unfinished,
    Foreign(PathBuf),
}

impl Folder {
    /// Where results go unless another folder is named: `out/<case>` under the current one.
    pub fn default_path(case: &str) -> PathBuf {
        Path::new("out").join(case)
    }

    /// Makes the folder ready. With `force`, an unfinished run is replaced like a finished one
    /// and foreign files are put up with; they are never removed. `scene` is the folder of the
    /// scene, which is never written into. True beside the folder: a finished run was replaced.
    pub fn prepare(path: &Path, scene: &Path, force: bool) -> Result<(Folder, bool), FolderError> {
        let named = || path.to_owned();
        may_hold_results(path, scene)?;
        let found = look(path)?;
        match found {
            Found::Unfinished if !force => {
                return Err(FolderError::Unfinished {
                    path: named(),
                    what: "run",
                });
            }
            Found::Foreign(file) if !force => {
                return Err(FolderError::Foreign {
                    path: named(),
                    file,
                    whose: "moldwarp's",
                });
            }
            _ => {}
        }
        let log = path.join(LOG);
        let replaced = log.exists();
        clear(path)?;
        fs::create_dir_all(path).map_err(FileError::at("create", path))?;
        // The log first: from here on the folder is known for an unfinished run.
        fs::File::create(&log).map_err(FileError::at("create", &log))?;
        for folder in FOLDERS.map(|name| path.join(name)) {
            fs::create_dir_all(&folder).map_err(FileError::at("create", &folder))?;
        }
        Ok((Folder { path: named() }, replaced))
    }

    /// A file in the folder that no run put there, if there is one.
    pub(crate) fn foreign(path: &Path) -> Result<Option<PathBuf>, FileError> {
        Ok(match look(path)? {
            Found::Foreign(file) => Some(file),
            _ => None,
        })
    }

    /// Removes what an earlier run wrote, and the folder if nothing else is in it.
    pub(crate) fn remove(path: &Path) -> Result<(), FileError> {
        let log = path.join(LOG);
        if log.exists() {
            clear(path)?;
            fs::remove_file(&log).map_err(FileError::at("remove", &log))?;
        }
        // It fails where something is left, which stays, and where there is no folder.
        for folder in FOLDERS {
            let _ = fs::remove_dir(path.join(folder));
        }
        let _ = fs::remove_dir(path);
        Ok(())
    }

    /// The folder of a run that goes on.
    pub(crate) fn resume(path: &Path) -> Folder {
        Folder {
            path: path.to_owned(),
        }
    }

    /// Removes all frames but the first `count`.
    pub(crate) fn remove_frames_from(&self, count: usize) -> Result<(), FileError> {
        remove_files(&self.path.join(FRAMES), |name| {
            let number = name.split(['_', '.']).nth(1).and_then(|n| n.parse().ok());
            number.is_some_and(|n: usize| n >= count)
        })
    }

    /// Removes the particles at the ends of stages but the first `count`.
    pub(crate) fn remove_stages_from(&self, count: usize) -> Result<(), FileError> {
        remove_files(&self.path.join(STAGES), |name| {
            let number = name.split('_').next().and_then(|n| n.parse().ok());
            number.is_some_and(|n: usize| n >= count)
        })
    }

    /// Removes what a run that is over does not need any more.
    pub(crate) fn remove_checkpoints(&self) -> Result<(), FileError> {
        remove_files(&self.path.join(CHECKPOINTS), |_| true)
    }

    /// One of the two files that hold checkpoints in turn.
    pub fn checkpoint(&self, generation: u64) -> PathBuf {
        let name = format!("{}.checkpoint", generation % 2);
        self.path.join(CHECKPOINTS).join(name)
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn scene(&self) -> PathBuf {
        self.path.join("scene.toml")
    }

    pub fn log(&self) -> PathBuf {
        self.path.join(LOG)
    }

    pub fn history(&self) -> PathBuf {
        self.path.join("history.csv")
    }

    pub fn summary(&self) -> PathBuf {
        self.path.join(SUMMARY)
    }

    /// What `moldwarp report` makes of the run.
    pub fn report(&self) -> PathBuf {
        self.path.join(REPORT)
    }

    /// The collection of a kind of frames, `particles` or `mesh`.
    pub fn collection(&self, kind: &str) -> PathBuf {
        self.path.join(format!("{kind}.pvd"))
    }

    /// A frame's path from this folder, with `/` between the parts.
    pub fn frame(kind: &str, number: usize) -> String {
        format!("{FRAMES}/{kind}_{number:05}.vtu")
    }

    /// Whether the folder at a path is that of a run.
    pub(crate) fn is_a_run(path: &Path) -> bool {
        path.join(LOG).is_file() && path.join("scene.toml").is_file()
    }

    /// The particles at the end of a stage: its path from the folder of the run. The number tells
    /// stages apart whose names look the same in a name of a file.
    pub fn stage(number: usize, name: &str) -> String {
        let mut safe = crate::sweep::safe(name);
        safe.truncate(80);
        format!("{STAGES}/{number:02}_{safe}.vtu")
    }
}

/// Refuses what no results go into, whatever is forced: a file, and the folder of the scene.
pub(crate) fn may_hold_results(path: &Path, scene: &Path) -> Result<(), FolderError> {
    let named = || path.to_owned();
    if path.exists() && !path.is_dir() {
        return Err(FolderError::NotAFolder { path: named() });
    }
    match (path.canonicalize(), scene.canonicalize()) {
        (Ok(out), Ok(scene)) if out == scene => Err(FolderError::Scene { path: named() }),
        _ => Ok(()),
    }
}

/// Names of what is in the folder, in order; none if it does not exist.
pub(crate) fn entries(path: &Path) -> Result<Vec<OsString>, FileError> {
    let mut names = Vec::new();
    if path.exists() {
        for entry in fs::read_dir(path).map_err(FileError::at("read", path))? {
            names.push(entry.map_err(FileError::at("read", path))?.file_name());
        }
    }
    names.sort();
    Ok(names)
}

fn look(path: &Path) -> Result<Found, FileError> {
    let names = entries(path)?;
    let has = |name: &str| names.iter().any(|n| n == name);
    let ours = |name: &OsString| {
        // Without a log, even a file of a name of ours was not put there by a run.
        let name = name.to_str().unwrap_or_default();
        has(LOG) && OURS.contains(&name.strip_suffix(".part").unwrap_or(name))
    };
    Ok(if let Some(foreign) = names.iter().find(|n| !ours(n)) {
        Found::Foreign(foreign.into())
    } else if has(SUMMARY) {
        Found::Finished
    } else if has(LOG) {
        Found::Unfinished
    } else {
        Found::Nothing
    })
}

/// Removes what an earlier run wrote, and nothing else.
fn clear(path: &Path) -> Result<(), FileError> {
    if !path.join(LOG).exists() {
        return Ok(());
    }
    for folder in FOLDERS.map(|name| path.join(name)) {
        remove_files(&folder, |_| true)?;
    }
    let files = OURS.iter().filter(|n| !FOLDERS.contains(n) && **n != LOG);
    for name in files {
        for file in [path.join(name), path.join(format!("{name}.part"))] {
            if file.exists() {
                fs::remove_file(&file).map_err(FileError::at("remove", &file))?;
            }
        }
    }
    Ok(())
}

/// Removes files of ours in one of the folders of a run, if there is such a folder: those whose name
/// is `wanted`.
fn remove_files(folder: &Path, wanted: impl Fn(&str) -> bool) -> Result<(), FileError> {
    for name in entries(folder)? {
        let file = folder.join(&name);
        let of_a_run = |e: &std::ffi::OsStr| e == "vtu" || e == "part" || e == "checkpoint";
        let ours = file.extension().is_some_and(of_a_run);
        if ours && wanted(&name.to_string_lossy()) {
            fs::remove_file(&file).map_err(FileError::at("remove", &file))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn prepare(path: &Path, force: bool) -> Result<bool, FolderError> {
        Folder::prepare(path, Path::new("nowhere"), force).map(|(_, replaced)| replaced)
    }

    #[test]
    fn a_finished_run_is_replaced_and_an_unfinished_one_refused() {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path().join("out/case");
        assert!(!prepare(&out, false).unwrap());
        for name in [
            "scene.toml",
            "history.csv",
            "frames/mesh_00000.vtu",
            "stages/00_x.vtu",
        ] {
            fs::write(out.join(name), "").unwrap();
        }
        let refused = prepare(&out, false).unwrap_err();
        assert!(matches!(refused, FolderError::Unfinished { .. }));
        assert!(out.join("history.csv").exists());

        fs::write(out.join("summary.json"), "{}").unwrap();
        assert!(prepare(&out, false).unwrap());
        assert_eq!(
            fs::read_dir(&out).unwrap().count(),
            4,
            "log, frames, stages and checkpoints"
        );
        assert_eq!(fs::read_dir(out.join("frames")).unwrap().count(), 0);
        assert_eq!(fs::read_dir(out.join("stages")).unwrap().count(), 0);

        assert!(prepare(&out, true).unwrap());
    }

    #[test]
    fn foreign_files_are_refused_and_never_removed() {
        let dir = tempfile::tempdir().unwrap();
        let thesis = dir.path().join("thesis.tex");
        fs::write(&thesis, "").unwrap();
        let refused = prepare(dir.path(), false).unwrap_err();
        assert!(matches!(&refused, FolderError::Foreign { file, .. } if file == "thesis.tex"));
        assert!(!prepare(dir.path(), true).unwrap());
        assert!(thesis.exists());
    }

    #[test]
    fn the_scenes_folder_and_a_file_are_refused_even_by_force() {
        let dir = tempfile::tempdir().unwrap();
        let scene = dir.path().join("scene.toml");
        fs::write(&scene, "").unwrap();
        let own = Folder::prepare(dir.path(), dir.path(), true).unwrap_err();
        assert!(matches!(own, FolderError::Scene { .. }));
        let file = Folder::prepare(&scene, dir.path(), true).unwrap_err();
        assert!(matches!(file, FolderError::NotAFolder { .. }));
        let under = Folder::prepare(&scene.join("x"), dir.path(), true).unwrap_err();
        assert!(matches!(under, FolderError::File(_)));
    }
}
