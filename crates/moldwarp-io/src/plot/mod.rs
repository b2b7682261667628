//! Line plots for papers, as SVG and PNG.
//!
//! A [`Plot`] says what is to be shown, `layout` places it on the page in points (1/72 inch),
//! and one of two writers draws it. Both measure text with the same font, so that they show the same.

mod curve;
mod font;
mod histories;
mod layout;
mod png;
mod scale;
mod select;
mod shapes;
mod style;
mod svg;
mod units;

pub use curve::Curve;
pub use histories::{HistoriesError, Reference, Shown, ShownRun, histories};
pub use select::SelectError;

use crate::output::{FileError, write_whole};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Points in a centimetre.
const CENTIMETRE: f64 = 72.0 / 2.54;

/// How a plot is to look.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Width and height, cm.
    pub size: [f64; 2],
    /// Of the labels, points.
    pub font_size: f64,
    /// Dots per inch of a PNG.
    pub dpi: f64,
}

impl Default for Look {
    fn default() -> Look {
        Look {
            size: [12.0, 8.0],
            font_size: 9.0,
            dpi: 300.0,
        }
    }
}

/// Curves over common axes.
#[derive(Clone, Debug, Default)]
pub struct Plot {
    /// Above the plot; nothing if empty.
    pub title: String,
    /// Labels of the axes, with their units.
    pub x: String,
    pub y: String,
    pub curves: Vec<Curve>,
    /// Ends of the axes; of the curves if not given.
    pub x_range: Option<[f64; 2]>,
    pub y_range: Option<[f64; 2]>,
    /// A logarithmic vertical axis.
    pub log_y: bool,
    /// Small, below the plot: what it comes from.
    pub caption: String,
    pub look: Look,
}

/// Why a plot is not drawn.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum PlotError {
    #[error("there is nothing to be drawn: no curve has a finite value{0}")]
    Empty(&'static str),
    #[error("{0}")]
    #[diagnostic(help(
        "a larger `--size`, a smaller `--font-size` or fewer curves leave room for the plot itself"
    ))]
    NoRoom(String),
    #[error("{} is neither .png nor .svg", .0.display())]
    #[diagnostic(help(
        "the ending says what is written: `--output plot.png` or `--output plot.svg`"
    ))]
    Ending(PathBuf),
    #[error(transparent)]
    File(#[from] FileError),
}

/// What a file holds, by its ending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Png,
    Svg,
}

impl Format {
    /// # Errors
    ///
    /// If the ending is neither `.png` nor `.svg`.
    pub fn of(path: &Path) -> Result<Format, PlotError> {
        let ending = path.extension().map(|e| e.to_ascii_lowercase());
        match ending.as_deref().and_then(|e| e.to_str()) {
            Some("png") => Ok(Format::Png),
            Some("svg") => Ok(Format::Svg),
            _ => Err(PlotError::Ending(path.to_owned())),
        }
    }
}

impl Plot {
    pub fn new(title: &str, x: &str, y: &str) -> Plot {
        Plot {
            title: title.to_owned(),
            x: x.to_owned(),
            y: y.to_owned(),
            ..Plot::default()
        }
    }

    /// Adds a curve in the next style.
    pub fn line(&mut self, label: impl Into<String>, points: Vec<(f64, f64)>) {
        let style = self.curves.iter().filter(|c| !c.reference).count();
        self.curves.push(Curve::new(label, points, style));
    }

    /// Adds what the curves are to be compared with: thin, black and dashed.
    pub fn dashed(&mut self, label: impl Into<String>, points: Vec<(f64, f64)>) {
        let style = self.curves.iter().filter(|c| c.reference).count();
        self.curves.push(Curve::reference(label, points, style));
    }

    /// The plot as the text of an SVG file.
    ///
    /// # Errors
    ///
    /// If there is nothing to be drawn, or no room for it.
    pub fn svg(&self) -> Result<String, PlotError> {
        Ok(svg::text(&layout::page(self)?))
    }

    /// The plot as the bytes of a PNG file.
    ///
    /// # Errors
    ///
    /// If there is nothing to be drawn, or no room for it.
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        png::bytes(&layout::page(self)?, self.look.dpi)
    }

    /// Writes the plot, whole or not at all, as what the file's ending says.
    ///
    /// # Errors
    ///
    /// If it cannot be drawn or written, or the ending is another.
    pub fn write(&self, path: &Path) -> Result<(), PlotError> {
        let bytes = match Format::of(path)? {
            Format::Png => self.png()?,
            Format::Svg => self.svg()?.into_bytes(),
        };
        Ok(write_whole(path, |out| out.write_all(&bytes))?)
    }
}

#[cfg(test)]
mod tests;
