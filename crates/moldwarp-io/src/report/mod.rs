//! The report of a run: one page that opens in any browser, with all that it shows inside.
//!
//! It is made from a run's folder alone, or from a [`Session`]. Rust reads, judges and packs; what moves in the page is the
//! script `viewer.js`, built from `viewer/` and committed, so that nothing but Rust is needed here.

mod answers;
mod budget;
mod fields;
mod figures;
mod mesh;
mod packing;
mod page;
mod pictures;
mod source;
mod spacing;
mod surface;
mod survey;
mod tables;
#[cfg(test)]
mod tests;

pub use budget::Wishes;

use crate::output::csv::CsvError;
use crate::output::vtu_read::VtuError;
use crate::output::{FileError, Folder, write_whole};
use crate::run::Session;
use crate::scene::SceneError;
use source::Source;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Reports begin so: a file that does is one, and may be replaced.
const MARK: &str = "<!doctype html>\n<!-- A report of moldwarp";

/// A report that was written.
#[derive(Debug)]
pub struct Written {
    pub path: PathBuf,
    pub bytes: usize,
    /// What was left out to keep the page small, a sentence each.
    pub left_out: Vec<String>,
}

/// Why there is no report.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum ReportError {
    #[error("there is no folder {}", .0.display())]
    #[diagnostic(help("name the folder that `moldwarp run` has written, such as out/column"))]
    Missing(PathBuf),
    #[error("{} is not the folder of a run: it has no run.log and scene.toml", .0.display())]
    #[diagnostic(help("name the folder that `moldwarp run` has written, such as out/column"))]
    NoRun(PathBuf),
    #[error("{} is the folder of a sweep", .0.display())]
    #[diagnostic(help("name the folder of one of its runs, which are in it"))]
    Sweep(PathBuf),
    #[error("{} cannot be used: {problem}", .path.display())]
    #[diagnostic(help("it has been changed or damaged since the run; make the run again"))]
    Broken { path: PathBuf, problem: String },
    #[error("{} is there already, and is no report", .0.display())]
    #[diagnostic(help("name another file (`--to`), or remove it"))]
    Foreign(PathBuf),
    #[error("{} is a folder", .0.display())]
    #[diagnostic(help("name a file (`--to`), such as report.html"))]
    Folder(PathBuf),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    #[diagnostic(help("it has been changed or damaged since the run; make the run again"))]
    Frame(#[from] VtuError),
    #[error(transparent)]
    #[diagnostic(help("it has been changed or damaged since the run; make the run again"))]
    History(#[from] CsvError),
    #[error(transparent)]
    File(#[from] FileError),
}

/// Writes the report of the run in a folder to `to`, or as `report.html` into the folder.
///
/// # Errors
///
/// If the folder is not that of a run, something in it is damaged, or the page cannot be written.
/// Nothing is changed then.
pub fn report(folder: &Path, to: Option<&Path>, wishes: Wishes) -> Result<Written, ReportError> {
    let path = to.map_or_else(|| Folder::resume(folder).report(), Path::to_owned);
    write(&Source::read(folder)?, path, wishes)
}

/// Writes the report of a simulation in memory, computed with so many threads, as it stands, to `to`. Files
/// that are needed on the way go into `work`, a folder that is there and empty.
///
/// # Errors
///
/// If these files or the page cannot be written.
pub fn report_of(
    session: &Session,
    threads: usize,
    work: &Path,
    to: &Path,
    wishes: Wishes,
) -> Result<Written, ReportError> {
    // What is seen soon is told soon.
    may_be_written(to)?;
    write(&Source::of(session, threads, work)?, to.to_owned(), wishes)
}

fn write(source: &Source, path: PathBuf, wishes: Wishes) -> Result<Written, ReportError> {
    may_be_written(&path)?;
    let (page, left_out) = page::page(source, wishes)?;
    write_whole(&path, |out| out.write_all(page.as_bytes()))?;
    Ok(Written {
        path,
        bytes: page.len(),
        left_out,
    })
}

fn may_be_written(path: &Path) -> Result<(), ReportError> {
    if path.is_dir() {
        return Err(ReportError::Folder(path.to_owned()));
    }
    let is_report = || -> std::io::Result<bool> {
        let mut start = [0; MARK.len()];
        let mut file = std::fs::File::open(path)?;
        Ok(std::io::Read::read_exact(&mut file, &mut start).is_ok() && start == MARK.as_bytes())
    };
    match path.exists() && !is_report().map_err(FileError::at("read", path))? {
        true => Err(ReportError::Foreign(path.to_owned())),
        false => Ok(()),
    }
}
