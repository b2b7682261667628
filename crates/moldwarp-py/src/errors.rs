//! Errors of moldwarp as Python's exceptions, with the text that the command shows.

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme};
use moldwarp::Stop;
use moldwarp_io::output::FileError as Failed;
use moldwarp_io::report::ReportError;
use moldwarp_io::run::SessionError;
use moldwarp_io::scene::SceneError;
use pyo3::import_exception;
use pyo3::prelude::*;

import_exception!(moldwarp._errors, BusyError);
import_exception!(moldwarp._errors, FileError);
import_exception!(moldwarp._errors, FrozenError);
import_exception!(moldwarp._errors, NotAtRestError);
import_exception!(moldwarp._errors, StoppedError);

mod python {
    pyo3::import_exception!(moldwarp._errors, SceneError);
}

/// The report of an error, as the command prints it where there are no colours.
pub fn report(error: &dyn Diagnostic) -> String {
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
    let drawn = handler
        .with_width(90)
        .with_break_words(false)
        .render_report(&mut text, error);
    match drawn {
        Ok(()) => text
            .lines()
            .map(str::trim_end)
            .collect::<Vec<_>>()
            .join("\n"),
        Err(_) => error.to_string(),
    }
}

fn help(error: &dyn Diagnostic) -> Option<String> {
    error.help().map(|help| help.to_string())
}

pub fn scene(error: &SceneError) -> PyErr {
    python::SceneError::new_err((report(error), error.to_string(), help(error)))
}

pub fn session(error: &SessionError) -> PyErr {
    match error {
        SessionError::Scene(error) => scene(error),
        SessionError::Stopped(_) => StoppedError::new_err(error.to_string()),
        _ => FileError::new_err((report(error), error.to_string(), help(error))),
    }
}

pub fn report_of(error: &ReportError) -> PyErr {
    match error {
        ReportError::Scene(error) => scene(error),
        _ => FileError::new_err((report(error), error.to_string(), help(error))),
    }
}

/// A frame that could not be written.
pub fn frame(error: Failed) -> PyErr {
    session(&error.into())
}

pub fn stop(stop: &Stop) -> PyErr {
    match stop {
        Stop::NotAtRest { .. } => NotAtRestError::new_err(stop.to_string()),
        _ => StoppedError::new_err(stop.to_string()),
    }
}
