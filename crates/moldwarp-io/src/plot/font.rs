//! The font that is measured with, and drawn with where there is no other.
//!
//! Arimo has the widths of Arial and Helvetica, so that an SVG, which names those, is laid out as it is
//! shown wherever it is opened.

use std::sync::LazyLock;
use ttf_parser::{Face, OutlineBuilder};

static FACE: LazyLock<Face<'static>> = LazyLock::new(|| {
    Face::parse(include_bytes!("font/Arimo-Regular.ttf"), 0)
        .expect("the font is inside the program")
});

/// Of these an SVG's viewer takes the first that it has.
pub(super) const FAMILIES: &str = "Arial, Arimo, 'Liberation Sans', Helvetica, sans-serif";

fn scale(size: f64) -> f64 {
    size / f64::from(FACE.units_per_em())
}

/// Width of a text, in the unit of `size`.
pub(super) fn width(text: &str, size: f64) -> f64 {
    text.chars().map(|c| advance(c, size)).sum()
}

fn advance(c: char, size: f64) -> f64 {
    let glyph = FACE.glyph_index(c).unwrap_or_default();
    f64::from(FACE.glyph_hor_advance(glyph).unwrap_or_default()) * scale(size)
}

/// Draws the outlines of a text from the origin to the right, upwards positive.
pub(super) fn outline(text: &str, size: f64, path: &mut tiny_skia::PathBuilder) {
    let mut x = 0.0;
    for c in text.chars() {
        let mut pen = Pen {
            path,
            x,
            scale: scale(size),
        };
        FACE.outline_glyph(FACE.glyph_index(c).unwrap_or_default(), &mut pen);
        x += advance(c, size);
    }
}

struct Pen<'a> {
    path: &'a mut tiny_skia::PathBuilder,
    x: f64,
    scale: f64,
}

impl Pen<'_> {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        let (x, y) = (
            f64::from(x) * self.scale + self.x,
            f64::from(y) * self.scale,
        );
        (x as f32, y as f32)
    }
}

impl OutlineBuilder for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_what_labels_need() {
        let signs = "azAZ09 äöüßéñçø±²³µ·×÷−–σετφψπμΔΣ≤≥≈√∞′″₀₁⁻¹()[]%";
        for c in signs.chars() {
            assert!(FACE.glyph_index(c).is_some(), "{c}");
        }
        assert!(FACE.glyph_index('漢').is_none());
        // Arial's widths: n is 0.556, i 0.222 of the size.
        assert!((width("nin", 1000.0) - (556.0 + 222.0 + 556.0)).abs() < 2.0);
    }
}
