//! What a page holds once everything has its place. Lengths are in points, y goes down.

use super::style::{Colour, Stroke};

/// Where a text has its anchor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    /// The share of the text's width that is left of the anchor.
    pub fn share(self) -> f64 {
        match self {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5,
            Anchor::End => 1.0,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    /// Lines, drawn within the frame of the plot only if `clipped`.
    Lines {
        lines: Vec<Vec<[f64; 2]>>,
        stroke: Stroke,
        clipped: bool,
    },
    /// On its base line; `upright` turns it by a quarter against the clock.
    Text {
        text: String,
        at: [f64; 2],
        size: f64,
        anchor: Anchor,
        upright: bool,
        colour: Colour,
    },
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Page {
    pub width: f64,
    pub height: f64,
    /// Left, top, right and bottom of the plot's frame.
    pub frame: [f64; 4],
    pub shapes: Vec<Shape>,
    /// What it shows, for those who cannot see it and for the file's own record.
    pub description: String,
}
