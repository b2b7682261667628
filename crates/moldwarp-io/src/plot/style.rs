//! How curves are told from each other: by colour, and without colours by the kind of line.

use super::Curve;

/// Red, green and blue.
pub(super) type Colour = [u8; 3];

pub(super) const BLACK: Colour = [0, 0, 0];
/// Of frames and ticks.
pub(super) const INK: Colour = [60, 60, 60];
/// Of lines behind the curves.
pub(super) const FAINT: Colour = [222, 222, 222];

/// Okabe and Ito's colours, which people with any kind of colour vision can tell apart, without the
/// yellow, which is too light for a line on white, and ordered so that neighbours differ in lightness.
pub(super) const COLOURS: [Colour; 6] = [
    [0, 114, 178],
    [230, 159, 0],
    [0, 158, 115],
    [213, 94, 0],
    [86, 180, 233],
    [180, 80, 140],
];

/// Lengths of dashes and gaps over the line's width; none is a whole line.
pub(super) const DASHES: [&[f64]; 5] = [
    &[],
    &[5.0, 2.0],
    &[1.2, 1.6],
    &[7.0, 2.0, 1.2, 2.0],
    &[9.0, 2.0, 3.0, 2.0],
];
const REFERENCES: [&[f64]; 4] = [
    &[4.0, 2.5],
    &[1.2, 1.8],
    &[8.0, 2.5, 1.2, 2.5],
    &[12.0, 3.0],
];

/// A line as it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stroke {
    pub colour: Colour,
    /// Points.
    pub width: f64,
    /// Lengths of dashes and gaps, points.
    pub dash: Vec<f64>,
}

impl Stroke {
    pub fn whole(colour: Colour, width: f64) -> Stroke {
        Stroke {
            colour,
            width,
            dash: Vec::new(),
        }
    }

    /// The line of a curve.
    pub fn of(curve: &Curve) -> Stroke {
        let (colour, width, dash) = match curve.reference {
            true => (BLACK, 0.9, REFERENCES[curve.style % REFERENCES.len()]),
            false => {
                let (round, number) = (curve.style / COLOURS.len(), curve.style % COLOURS.len());
                // Curves of one colour come once a round, and each round has other dashes.
                let dash = DASHES[(number + round) % DASHES.len()];
                (COLOURS[number], 1.3, dash)
            }
        };
        Stroke {
            colour,
            width,
            dash: dash.iter().map(|length| length * width).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_curves_differ_and_neighbours_do_so_without_colours() {
        let strokes: Vec<Stroke> = (0..30)
            .map(|style| Stroke::of(&Curve::new("", Vec::new(), style)))
            .collect();
        for (i, a) in strokes.iter().enumerate() {
            assert!(strokes[..i].iter().all(|b| a != b), "{i}");
        }
        assert!(
            strokes
                .windows(2)
                .all(|w| w[0].dash != w[1].dash || w[0].colour == w[1].colour)
        );
    }
}
