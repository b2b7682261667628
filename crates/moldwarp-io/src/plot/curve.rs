//! A curve of a plot.

/// A line through points.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// For the legend; none if empty.
    pub label: String,
    /// A value that is no number interrupts the line.
    pub points: Vec<(f64, f64)>,
    /// Number of its style; each has a colour and a kind of line that tell it from the others.
    pub style: usize,
    /// Something to compare with: it is thin, black and dashed; styles differ in their dashes.
    pub reference: bool,
}

impl Curve {
    pub fn new(label: impl Into<String>, points: Vec<(f64, f64)>, style: usize) -> Curve {
        Curve {
            label: label.into(),
            points,
            style,
            reference: false,
        }
    }

    pub fn reference(label: impl Into<String>, points: Vec<(f64, f64)>, style: usize) -> Curve {
        Curve {
            reference: true,
            ..Curve::new(label, points, style)
        }
    }
}

/// The parts of a line between values that are no numbers, without the points that do not show: those
/// that lie nearer than `tolerance` to the line through their neighbours that are kept
/// (Ramer–Douglas–Peucker).
pub(super) fn thinned(points: &[[f64; 2]], tolerance: f64) -> Vec<Vec<[f64; 2]>> {
    let finite = |p: &[f64; 2]| p[0].is_finite() && p[1].is_finite();
    let parts = points.split(|p| !finite(p)).filter(|part| !part.is_empty());
    parts.map(|part| thin(part, tolerance)).collect()
}

fn thin(points: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let mut kept = vec![false; points.len()];
    kept[0] = true;
    kept[points.len() - 1] = true;
    // A list of its own: histories may be long, and recursion as deep as they are.
    let mut spans = vec![(0, points.len() - 1)];
    while let Some((first, last)) = spans.pop() {
        let farthest = (first + 1..last)
            .map(|i| (i, distance(points[i], points[first], points[last])))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, apart)) = farthest
            && apart > tolerance
        {
            kept[i] = true;
            spans.extend([(first, i), (i, last)]);
        }
    }
    let kept = points.iter().zip(kept).filter(|p| p.1);
    kept.map(|p| *p.0).collect()
}

/// Distance of a point from the piece of line from `a` to `b`.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length = along[0].powi(2) + along[1].powi(2);
    let share = if length > 0.0 {
        ((to[0] * along[0] + to[1] * along[1]) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (to[0] - share * along[0]).hypot(to[1] - share * along[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_shows_is_kept() {
        let straight: Vec<[f64; 2]> = (0..1000).map(|i| [f64::from(i), 2.0]).collect();
        assert_eq!(thinned(&straight, 0.01), [[[0.0, 2.0], [999.0, 2.0]]]);
        let mut peak = straight.clone();
        peak[500][1] = 3.0;
        let thin = &thinned(&peak, 0.01)[0];
        assert!(thin.contains(&[500.0, 3.0]) && thin.contains(&[499.0, 2.0]) && thin.len() == 5);
        // Back and forth on a line: the turning points are far from the piece between the ends.
        assert_eq!(
            thinned(&[[0.0, 0.0], [9.0, 0.0], [1.0, 0.0]], 0.01)[0].len(),
            3
        );
        let gap = [[0.0, 0.0], [1.0, f64::NAN], [2.0, 0.0], [3.0, 1.0]];
        assert_eq!(thinned(&gap, 0.01).len(), 2);
    }
}
