//! The compiled part of the Python package `moldwarp`.
//!
//! It holds what has to be near the solver: setting scenes up, stepping without Python's lock, arrays
//! of particles in and out, laws called back. What is convenience stands in `python/moldwarp`.

mod arrays;
mod copies;
mod errors;
mod law;
mod lease;
mod mesh;
mod report;
mod scene;
mod simulation;

use pyo3::prelude::*;

/// The compiled part of moldwarp; use the package `moldwarp`.
#[pymodule]
mod _moldwarp {
    #[pymodule_export]
    use super::lease::Lease;
    #[pymodule_export]
    use super::report::{report_in, report_of};
    #[pymodule_export]
    use super::scene::{Scene, quantity};
    #[pymodule_export]
    use super::simulation::Simulation;

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
