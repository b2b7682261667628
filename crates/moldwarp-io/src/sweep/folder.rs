//! The folder of a sweep, and when it may be written into: the rules are those of a run's.

use super::table::{EXIT_CODE, FIRST, Table};
use crate::output::folder::{entries, may_hold_results};
use crate::output::{FileError, Folder, FolderError, csv};
use std::ffi::OsStr;
use std::fs;
use std::path::{Component, Path, PathBuf};

const TABLE: &str = "sweep.csv";

/// A folder that is ready for a sweep: it exists, and nothing of an earlier sweep's runs is left.
#[derive(Clone, Debug)]
pub struct SweepFolder {
    path: PathBuf,
}

/// What stands in a folder before a sweep. Its table says which folders are those of its runs, and
/// whether these are over.
#[derive(Debug, Default)]
struct Earlier {
    table: bool,
    runs: Vec<String>,
    unfinished: bool,
    foreign: Option<PathBuf>,
}

impl SweepFolder {
    /// Makes the folder ready. With `force`, an unfinished sweep is replaced like a finished one
    /// and foreign files are put up with; they are never removed. `scene` is the folder of the
    /// scene. True beside the folder: an earlier sweep was replaced.
    pub fn prepare(
        path: &Path,
        scene: &Path,
        force: bool,
    ) -> Result<(SweepFolder, bool), FolderError> {
        let named = || path.to_owned();
        may_hold_results(path, scene)?;
        let earlier = look(path)?;
        if let (Some(file), false) = (earlier.foreign, force) {
            return Err(FolderError::Foreign {
                path: named(),
                file,
                whose: "of a sweep",
            });
        }
        if earlier.unfinished && !force {
            return Err(FolderError::Unfinished {
                path: named(),
                what: "sweep",
            });
        }
        for run in &earlier.runs {
            Folder::remove(&path.join(run))?;
        }
        fs::create_dir_all(path).map_err(FileError::at("create", path))?;
        Ok((SweepFolder { path: named() }, earlier.table))
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn table(&self) -> PathBuf {
        self.path.join(TABLE)
    }

    /// Writes the table, whole or not at all.
    pub fn write(&self, table: &Table) -> Result<(), FileError> {
        table.write(&self.table())
    }
}

fn look(path: &Path) -> Result<Earlier, FileError> {
    let names = entries(path)?;
    let Some((runs, unfinished)) = runs(&path.join(TABLE)) else {
        return Ok(Earlier {
            foreign: names.first().map(PathBuf::from),
            ..Earlier::default()
        });
    };
    let part = format!("{TABLE}.part");
    let ours = |name: &OsStr| name == TABLE || name == &*part || runs.iter().any(|r| name == &**r);
    let mut foreign = names.iter().find(|n| !ours(n)).map(PathBuf::from);
    for run in runs.iter().filter(|run| path.join(run).exists()) {
        let folder = path.join(run);
        foreign = foreign.or(match folder.is_dir() {
            true => Folder::foreign(&folder)?.map(|file| Path::new(run).join(file)),
            false => Some(run.into()),
        });
    }
    Ok(Earlier {
        table: true,
        runs,
        unfinished,
        foreign,
    })
}

/// A run of a sweep, as the table has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    pub folder: PathBuf,
    /// Paths of the scene and the values that they had.
    pub values: Vec<(String, String)>,
    /// None if it has not ended, or not begun.
    pub exit_code: Option<i32>,
    /// Why it did not come to its end; empty if it did.
    pub reason: String,
    /// s.
    pub wall_time: Option<f64>,
}

/// The runs of the sweep in a folder, in the order of its table; none if it holds no sweep.
pub fn members(path: &Path) -> Option<Vec<Member>> {
    let table = csv::read_text(&path.join(TABLE)).ok()?;
    let (folders, _) = runs(&path.join(TABLE))?;
    let ends = table.names.iter().position(|n| n == EXIT_CODE)?;
    let varied = table.names.get(FIRST.len()..ends)?;
    let cell = |row: &[String], at: usize| row.get(at).cloned().unwrap_or_default();
    let member = |row: &Vec<String>| Member {
        folder: path.join(cell(row, 1)),
        values: varied
            .iter()
            .cloned()
            .zip(row[FIRST.len()..ends].iter().cloned())
            .collect(),
        exit_code: cell(row, ends).parse().ok(),
        reason: cell(row, ends + 1),
        wall_time: cell(row, ends + 2).parse().ok(),
    };
    let within = |row: &&Vec<String>| folders.contains(&cell(row, 1));
    Some(table.rows.iter().filter(within).map(member).collect())
}

/// The folders of the runs that a table lists, and whether one of them has not ended. None if
/// there is no table of a sweep.
fn runs(table: &Path) -> Option<(Vec<String>, bool)> {
    let table = csv::read_text(table).ok()?;
    if table.names[..FIRST.len().min(table.names.len())] != FIRST {
        return None;
    }
    let unfinished = table.column(EXIT_CODE)?.contains(&"");
    let folders = table.column(FIRST[1])?.into_iter();
    // A table that was changed by hand must not lead out of the folder.
    let within = |name: &&str| {
        let mut parts = Path::new(name).components();
        matches!(
            (parts.next(), parts.next()),
            (Some(Component::Normal(_)), None)
        )
    };
    Some((
        folders.filter(within).map(str::to_owned).collect(),
        unfinished,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn prepare(path: &Path, force: bool) -> Result<bool, FolderError> {
        SweepFolder::prepare(path, Path::new("nowhere"), force).map(|(_, replaced)| replaced)
    }

    /// A folder that holds a sweep of two runs, of which the second ended with this code.
    fn sweep(code: &str) -> tempfile::TempDir {
        let dir = tempfile::tempdir().unwrap();
        let table = format!("run,folder,a,exit_code\n1,a-1,1,0\n2,a-2,2,{code}\n");
        fs::write(dir.path().join(TABLE), table).unwrap();
        for run in ["a-1", "a-2"] {
            let run = dir.path().join(run);
            fs::create_dir_all(run.join("frames")).unwrap();
            fs::write(run.join("run.log"), "").unwrap();
            fs::write(run.join("history.csv"), "").unwrap();
        }
        dir
    }

    #[test]
    fn a_finished_sweep_is_replaced_with_its_runs_and_an_unfinished_one_by_force() {
        let done = sweep("3");
        assert!(prepare(done.path(), false).unwrap());
        assert_eq!(entries(done.path()).unwrap(), [TABLE]);

        let cut = sweep("");
        let refused = prepare(cut.path(), false).unwrap_err();
        assert!(matches!(
            refused,
            FolderError::Unfinished { what: "sweep", .. }
        ));
        assert!(cut.path().join("a-1/history.csv").exists());
        assert!(prepare(cut.path(), true).unwrap());
        assert!(!prepare(&cut.path().join("new"), false).unwrap());
    }

    #[test]
    fn foreign_files_are_refused_and_never_removed() {
        for file in ["thesis.tex", "a-2/thesis.tex"] {
            let dir = sweep("0");
            fs::write(dir.path().join(file), "").unwrap();
            let refused = prepare(dir.path(), false).unwrap_err();
            assert!(
                matches!(&refused, FolderError::Foreign { file: f, .. } if f == Path::new(file))
            );
            assert!(dir.path().join("a-1/history.csv").exists());
            prepare(dir.path(), true).unwrap();
            assert!(dir.path().join(file).exists());
            assert!(!dir.path().join("a-2/history.csv").exists());
        }
        let other = tempfile::tempdir().unwrap();
        fs::write(other.path().join(TABLE), "a,b\n1,2\n").unwrap();
        assert!(prepare(other.path(), false).is_err());
    }

    #[test]
    fn a_table_leads_to_no_other_folder() {
        let dir = sweep("0");
        let inner = dir.path().join("a-1");
        let table = "run,folder,a,exit_code\n1,../a-2,1,0\n2,.,1,0\n";
        fs::write(inner.join(TABLE), table).unwrap();
        prepare(&inner, true).unwrap();
        assert!(dir.path().join("a-2/history.csv").exists());
        assert!(inner.join("history.csv").exists());
    }
}
