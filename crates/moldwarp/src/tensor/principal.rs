//! Principal values and directions of a symmetric tensor.
//!
//! The deviator, scaled to B with B : B = 6, has the characteristic equation β³ − 3β − 2h = 0 with
//! h = det B / 2 in [−1, 1]. Its root of largest magnitude lies in √3 ≤ |β| ≤ 2, at least √3 away
//! from the other two whatever their distance from each other, so this root and its direction are
//! well conditioned. The other two follow from a plane rotation in the orthogonal complement of
//! that direction, which is exact to round-off for equal and for nearly equal values (the formula
//! with three cosines loses half of the digits there). The scheme resembles the non-iterative
//! one of D. Eberly, "A robust eigensolver for 3×3 symmetric matrices" (2014), with Newton's
//! iteration instead of trigonometric functions.

use super::Voigt;
use crate::Vec3;
use crate::lanes::either;

/// σ = Σ valuesᵢ nᵢ ⊗ nᵢ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principal {
    /// Largest first.
    pub values: [f64; 3],
    /// Unit vectors at right angles, in the order of the values. Signs are arbitrary.
    pub directions: [Vec3; 3],
}

/// Principal values and directions of a stress (tensor components, Voigt order).
///
/// Values are exact to a few units in the last place of the largest component, directions
/// orthonormal to round-off. Where values coincide, the directions are some orthonormal choice.
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
            directions: [Vec3::X, Vec3::Y, Vec3::Z],
        }
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

/// s − tr s/3 I, but for round-off: any shift will do.
#[inline(always)]
fn deviator(s: &Voigt) -> Voigt {
    let mean = super::trace(s) * (1.0 / 3.0);
    [s[0] - mean, s[1] - mean, s[2] - mean, s[3], s[4], s[5]]
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
    let lonely = lonely_direction(b, unit * lonely_root(half.abs().min(1.0)).copysign(half));
    let (u, w) = complement(lonely);

    // A rotation by the half angle makes the 2×2 block of u and w diagonal, with values
    // `centre` ± `radius`.
    let (bu, bw) = (super::times(b, u), super::times(b, w));
    let (uu, uw, ww) = (u.dot(bu), u.dot(bw), w.dot(bw));
    let centre = 0.5 * (uu + ww);
    let difference = 0.5 * (ww - uu);
    let radius = (difference * difference + uw * uw).sqrt();
    // Equal values, far below round-off: no rotation.
    let differ = radius > 1e-20 * unit;
    let over = 1.0 / radius;
    let cosine = either(differ, difference.abs() * over, 1.0);
    let sine = either(differ, uw * over, 0.0);
    let large = (0.5 + 0.5 * cosine).sqrt();
    let small = 0.5 * sine / large;
    let ascending = difference >= 0.0;
    let f = either(ascending, small, large);
    let g = either(ascending, large, small);
    let (high, low) = (u * f + w * g, u * g - w * f);

    // The lonely value is first or last.
    let mean = s[0] - b[0];
    let alone = lonely.dot(super::times(b, lonely));
    let last = half < 0.0;
    let (top, bottom) = (mean + (centre + radius), mean + (centre - radius));
    let alone = mean + alone;
    Principal {
        values: [
            either(last, top, alone),
            either(last, bottom, top),
            either(last, alone, bottom),
        ],
        directions: [
            either_vector(last, high, lonely),
            either_vector(last, low, high),
            either_vector(last, lonely, low),
        ],
    }
}

#[inline(always)]
fn either_vector(first: bool, a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(
        either(first, a.x, b.x),
        either(first, a.y, b.y),
        either(first, a.z, b.z),
    )
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

/// Direction of a simple principal value: the longest column of the adjugate of B − value I.
#[inline(always)]
fn lonely_direction(b: &Voigt, value: f64) -> Vec3 {
    let rows = [
        Vec3::new(b[0] - value, b[3], b[5]),
        Vec3::new(b[3], b[1] - value, b[4]),
        Vec3::new(b[5], b[4], b[2] - value),
    ];
    // Column i is vᵢ v times the product of the distances to the other values, which is positive.
    let columns = [
        rows[1].cross(rows[2]),
        rows[2].cross(rows[0]),
        rows[0].cross(rows[1]),
    ];
    let (x, y, z) = (columns[0].x, columns[1].y, columns[2].z);
    let of_two = either_vector(y > x, columns[1], columns[0]);
    let longest = either_vector(z > either(y > x, y, x), columns[2], of_two);
    longest * (1.0 / longest.length())
}

/// Two unit vectors at right angles to the unit vector `n` and to each other (T. Duff et al.,
/// "Building an orthonormal basis, revisited", 2017).
#[inline(always)]
fn complement(n: Vec3) -> (Vec3, Vec3) {
    let sign = 1f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (
        Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
        Vec3::new(b, sign + n.y * n.y * a, -n.y),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mat3;
    use crate::random::Random;
    use crate::tensor::{from_matrix, rotate};

    /// Largest errors of the values, of the directions' products, and of Σ σᵢ nᵢ ⊗ nᵢ.
    fn errors(values: [f64; 3], turn: &Mat3) -> [f64; 3] {
        let [a, b, c] = values;
        let tensor = rotate(&[a, b, c, 0.0, 0.0, 0.0], turn);
        let found = principal(&tensor);
        let n = found.directions;
        let frame = Mat3::from_cols(n[0], n[1], n[2]);
        let [x, y, z] = found.values;
        let rebuilt = rotate(&[x, y, z, 0.0, 0.0, 0.0], &frame);
        let products = from_matrix(&(frame.transpose() * frame));
        let largest = |a: &[f64], b: &[f64]| {
            a.iter()
                .zip(b)
                .fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
        };
        let mut sorted = values;
        sorted.sort_by(|a, b| b.total_cmp(a));
        [
            largest(&found.values, &sorted),
            largest(&products, &[1.0, 1.0, 1.0, 0.0, 0.0, 0.0]),
            largest(&rebuilt, &tensor),
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
            let [value, product, tensor] = errors(v.map(|x| x * scale), &random.rotation());
            assert!(value <= 4e-15 * scale, "{v:?} × {scale}: {value}");
            assert!(product <= 2e-15, "{v:?} × {scale}: {product}");
            assert!(tensor <= 4e-15 * scale, "{v:?} × {scale}: {tensor}");
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
