//! Principal values of a symmetric tensor, and tensors with the same directions and other values.
//!
//! The deviator, scaled to B with B : B = 6, has the characteristic equation β³ − 3β − 2h = 0 with
//! h = det B / 2 in [−1, 1]. Its root of largest magnitude lies in √3 ≤ |β| ≤ 2, at least √3 away
//! from the other two whatever their distance from each other, so this lonely root is well conditioned, and so is the
//! projector onto its direction, P = adj(B − β I) / tr adj(B − β I). What remains is a plane tensor,
//! D = B + β/2 I − 3/2 β P, with the values ± r, r² = D : D / 2: exact to round-off for equal and for nearly equal values
//! (the formula with three cosines loses half of the digits there). With other values a for the lonely one and b, c for the
//! others the tensor is
//!
//!   (b + c)/2 I + (a − (b + c)/2) P + (b − c)/(2 r) D,
//!
//! which takes no directions. The way to the lonely root resembles the non-iterative scheme of D. Eberly, "A robust
//! eigensolver for 3×3 symmetric matrices" (2014), with Newton's iteration instead of trigonometric functions.

use super::Voigt;
use crate::lanes::either;

/// A symmetric tensor by its principal values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principal {
    /// Largest first.
    pub values: [f64; 3],
    /// Whether the lonely value is the smallest one; else it is the largest one.
    last: bool,
    /// Projector onto its direction.
    lonely: Voigt,
    /// D, or nothing where r is far below round-off.
    plane: Voigt,
    /// 1 / r, or 0.
    over_radius: f64,
}

/// Principal values of a stress (tensor components, Voigt order).
///
/// They are exact to a few units in the last place of the largest component. Where values coincide, directions
/// are some orthonormal choice.
pub fn principal(s: &Voigt) -> Principal {
    let b = deviator(s);
    let norm_squared = square(&b);
    if is_ordinary(norm_squared) {
        return decompose(s, &b, norm_squared);
    }
    // Zero, isotropic, tiny or huge: the components are brought to a size of which the powers
    // are numbers.
    let largest = s.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let scaled = s.map(|v| v / largest);
    let b = deviator(&scaled);
    let norm_squared = square(&b);
    if norm_squared > 1e-34 {
        let found = decompose(&scaled, &b, norm_squared);
        Principal {
            values: found.values.map(|v| v * largest),
            ..found
        }
    } else {
        Principal {
            values: [s[0], s[1], s[2]],
            last: false,
            lonely: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            plane: [0.0; 6],
            over_radius: 0.0,
        }
    }
}

impl Principal {
    /// The tensor that has these values, largest first, in the same directions: exactly isotropic if they are equal.
    #[inline(always)]
    pub fn with(&self, [first, second, third]: &[f64; 3]) -> Voigt {
        let (alone, top, bottom) = (
            either(self.last, *third, *first),
            either(self.last, *first, *second),
            either(self.last, *second, *third),
        );
        let centre = 0.5 * (top + bottom);
        let (along, across) = (alone - centre, 0.5 * (top - bottom) * self.over_radius);
        std::array::from_fn(|k| {
            let own = self.lonely[k] * along + self.plane[k] * across;
            if k < 3 { centre + own } else { own }
        })
    }
}

/// Whether [`decompose`] can take a deviator of this square.
#[inline(always)]
fn is_ordinary(norm_squared: f64) -> bool {
    // Both are asked, so that there is no jump.
    let (large, small) = (norm_squared >= 1e-100, norm_squared < 1e100);
    large & small
}

/// [`principal`] of an ordinary stress, without branches, and whether this one is.
#[inline(always)]
pub fn principal_if_ordinary(s: &Voigt) -> (Principal, bool) {
    let b = deviator(s);
    let norm_squared = square(&b);
    (decompose(s, &b, norm_squared), is_ordinary(norm_squared))
}

/// s − tr s/3 I. Its trace is zero but for its own round-off, not only for that of s.
#[inline(always)]
fn deviator(s: &Voigt) -> Voigt {
    let mean = super::trace(s) * (1.0 / 3.0);
    let (x, y) = (s[0] - mean, s[1] - mean);
    [x, y, -(x + y), s[3], s[4], s[5]]
}

/// b : b
#[inline(always)]
fn square(b: &Voigt) -> f64 {
    (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]) + 2.0 * (b[3] * b[3] + b[4] * b[4] + b[5] * b[5])
}

/// `b` is the deviator of `s`. Choices that depend on its values are selections between what has been
/// computed for all cases, so that several stresses can be decomposed side by side.
#[inline(always)]
fn decompose(s: &Voigt, b: &Voigt, norm_squared: f64) -> Principal {
    let unit_squared = norm_squared * (1.0 / 6.0);
    let unit = unit_squared.sqrt();
    let determinant = b[0] * (b[1] * b[2] - b[4] * b[4]) - b[3] * (b[3] * b[2] - b[4] * b[5])
        + b[5] * (b[3] * b[4] - b[1] * b[5]);
    let half = 0.5 * determinant / (unit * unit_squared);
    let alone = unit * lonely_root(half.abs().min(1.0)).copysign(half);
    let lonely = projector(b, alone);

    let centre = -0.5 * alone;
    let apart = alone - centre;
    let plane: Voigt = std::array::from_fn(|k| {
        let own = b[k] - lonely[k] * apart;
        if k < 3 { own - centre } else { own }
    });
    let radius = (0.5 * square(&plane)).sqrt();
    // Equal values, far below round-off.
    let differ = radius > 1e-20 * unit;
    // The lonely value is first or last.
    let mean = s[0] - b[0];
    let last = half < 0.0;
    let (top, bottom) = (mean + (centre + radius), mean + (centre - radius));
    let alone = mean + alone;
    Principal {
        values: [
            either(last, top, alone),
            either(last, bottom, top),
            either(last, alone, bottom),
        ],
        last,
        lonely,
        plane,
        over_radius: either(differ, 1.0 / radius, 0.0),
    }
}

/// The largest root of β³ − 3β = 2h for 0 ≤ h ≤ 1, 2 cos(arccos(h) / 3).
#[inline(always)]
fn lonely_root(h: f64) -> f64 {
    // Interpolates in Chebyshev points, off by at most 1e-5. A Newton step squares that error;
    // the second one can keep the slope of the first.
    let start = (1.732_060_86 + h * 0.332_823_44)
        + (h * h) * ((h * 0.035_024_38 - 0.091_843_87) - (h * h) * 0.008_070_8);
    let over_slope = 1.0 / (3.0 * start * start - 3.0);
    let excess = |root: f64| root * (root * root - 3.0) - 2.0 * h;
    let root = start - excess(start) * over_slope;
    root - excess(root) * over_slope
}

/// Onto the direction of a simple principal value.
#[inline(always)]
fn projector(b: &Voigt, value: f64) -> Voigt {
    let (x, y, z) = (b[0] - value, b[1] - value, b[2] - value);
    let adjugate = [
        y * z - b[4] * b[4],
        z * x - b[5] * b[5],
        x * y - b[3] * b[3],
        b[4] * b[5] - b[3] * z,
        b[5] * b[3] - b[4] * x,
        b[3] * b[4] - b[5] * y,
    ];
    // The product of the distances to the other values.
    let over = 1.0 / super::trace(&adjugate);
    adjugate.map(|a| a * over)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mat3;
    use crate::random::Random;
    use crate::tensor::rotate;

    /// Largest errors of the values, of the tensor of these values, and of that of other ones.
    fn errors(values: [f64; 3], turn: &Mat3) -> [f64; 3] {
        let turned = |v: [f64; 3]| rotate(&[v[0], v[1], v[2], 0.0, 0.0, 0.0], turn);
        let tensor = turned(values);
        let found = principal(&tensor);
        let largest = |a: &[f64], b: &[f64]| {
            a.iter()
                .zip(b)
                .fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
        };
        let mut sorted = values;
        sorted.sort_by(|a, b| b.total_cmp(a));
        // What is close to each other stays so.
        let size = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let other = |v: f64| v.min(0.3 * size) + 0.5 * v;
        [
            largest(&found.values, &sorted),
            largest(&found.with(&found.values), &tensor),
            largest(
                &found.with(&found.values.map(other)),
                &turned(values.map(other)),
            ),
        ]
    }

    #[test]
    fn random_equal_and_nearly_equal_values_are_found_to_round_off() {
        let mut random = Random::new(3);
        for n in 0..100_000 {
            let scale = libm::exp2(random.within(-60.0, 60.0));
            let close = libm::exp2(random.within(-60.0, 0.0));
            let mut v: [f64; 3] = std::array::from_fn(|_| random.within(-1.0, 1.0));
            match n % 5 {
                0 => v[1] = v[0] + close * v[1],
                1 => v = [v[0], v[0] + close * v[1], v[0] + close * v[2]],
                2 => v[1] = v[0],
                3 => v = [v[0] * close, v[1], v[2] * close * close],
                _ => {}
            }
            let [value, tensor, other] = errors(v.map(|x| x * scale), &random.rotation());
            assert!(value <= 4e-15 * scale, "{v:?} × {scale}: {value}");
            assert!(tensor <= 4e-15 * scale, "{v:?} × {scale}: {tensor}");
            assert!(other <= 8e-15 * scale, "{v:?} × {scale}: {other}");
        }
    }

    #[test]
    fn special_tensors() {
        assert_eq!(principal(&[0.0; 6]).values, [0.0; 3]);
        for p in [7.0, -1e5 / 3.0, 1e-200, 1e200] {
            let found = principal(&[p, p, p, 0.0, 0.0, 0.0]);
            assert!(found.values.iter().all(|v| (v / p - 1.0).abs() < 1e-15));
        }
        for tiny_or_huge in [1e-290, 1e-200, 1e200, 1e290] {
            let found = principal(&[0.0, 0.0, 0.0, tiny_or_huge, 0.0, 0.0]);
            for (a, b) in found.values.iter().zip([1.0, 0.0, -1.0]) {
                assert!((a / tiny_or_huge - b).abs() < 1e-15);
            }
        }
        // Axes in any order, without a rotation.
        for v in [
            [3.0, 2.0, 1.0],
            [1.0, 3.0, 2.0],
            [2.0, 2.0, -1.0],
            [2.0, -1.0, 2.0],
            [0.0, 0.0, -5.0],
        ] {
            assert!(errors(v, &Mat3::IDENTITY).iter().all(|&e| e < 3e-15));
        }
    }
}
