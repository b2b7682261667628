//! Reports, of simulations and of runs' folders.

use crate::errors;
use crate::simulation::{Simulation, check_process, within};
use moldwarp_io::report::{self, Wishes, Written};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// Path, bytes, and what was left out, a sentence each.
type About = (PathBuf, usize, Vec<String>);

/// How many particles and frames are shown at most.
type Most = (Option<usize>, Option<usize>);

fn wishes((particles, frames): Most) -> Wishes {
    Wishes { particles, frames }
}

fn about(written: Written) -> About {
    (written.path, written.bytes, written.left_out)
}

/// Of a simulation as it stands. `work` is an empty folder for files on the way.
#[pyfunction]
pub fn report_of(
    py: Python,
    simulation: &Bound<Simulation>,
    work: PathBuf,
    to: PathBuf,
    most: Most,
) -> PyResult<About> {
    let cell = simulation.get().look()?;
    let session = &cell.session;
    let wishes = wishes(most);
    let write = || {
        let threads = rayon::current_num_threads();
        report::report_of(session, threads, &work, &to, wishes)
    };
    let written = py.detach(|| within(&cell.threads, write));
    written
        .map(about)
        .map_err(|error| errors::report_of(&error))
}

/// Of the run in a folder.
#[pyfunction]
pub fn report_in(py: Python, folder: PathBuf, to: Option<PathBuf>, most: Most) -> PyResult<About> {
    check_process()?;
    let to: Option<&Path> = to.as_deref();
    let written = py.detach(|| report::report(&folder, to, wishes(most)));
    written
        .map(about)
        .map_err(|error| errors::report_of(&error))
}
