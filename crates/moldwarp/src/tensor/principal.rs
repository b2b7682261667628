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
    let mean = (s[0] + s[1] + s[2]) / 3.0;
    let (x, y, z) = (s[0] - mean, s[1] - mean, s[2] - mean);
    let largest = [x, y, z, s[3], s[4], s[5]]
        .iter()
        .fold(0.0, |m: f64, v| m.max(v.abs()));
    // Also false for tensors that are not numbers, and where the reciprocal would overflow.
    if !(largest >= 1e-300) {
        return Principal {
            values: [mean; 3],
            directions: [Vec3::X, Vec3::Y, Vec3::Z],
        };
    }
    let f = 1.0 / largest;
    let b = [x * f, y * f, z * f, s[3] * f, s[4] * f, s[5] * f];
    let norm_squared =
        b[0] * b[0] + b[1] * b[1] + b[2] * b[2] + 2.0 * (b[3] * b[3] + b[4] * b[4] + b[5] * b[5]);
    let unit = (norm_squared / 6.0).sqrt();
    let determinant = b[0] * (b[1] * b[2] - b[4] * b[4]) - b[3] * (b[3] * b[2] - b[4] * b[5])
        + b[5] * (b[3] * b[4] - b[1] * b[5]);
    let half = 0.5 * determinant / (unit * unit * unit);
    let shift = unit * lonely_root(half.abs().min(1.0)).copysign(half);

    let lonely = lonely_direction(&b, shift);
    let (u, w) = complement(lonely);
    let (bl, bu, bw) = (
        super::times(&b, lonely),
        super::times(&b, u),
        super::times(&b, w),
    );
    // A Jacobi rotation makes the 2×2 block diagonal.
    let (uu, uw, ww) = (u.dot(bu), u.dot(bw), w.dot(bw));
    let tangent = if uw == 0.0 {
        0.0
    } else {
        let t = 0.5 * (ww - uu) / uw;
        1f64.copysign(t) / (t.abs() + (1.0 + t * t).sqrt())
    };
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    let sine = tangent * cosine;
    let mut pairs = [
        (lonely.dot(bl), lonely),
        (uu - tangent * uw, u * cosine - w * sine),
        (ww + tangent * uw, w * cosine + u * sine),
    ];
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if pairs[i].0 < pairs[j].0 {
            pairs.swap(i, j);
        }
    }
    Principal {
        values: pairs.map(|p| mean + largest * p.0),
        directions: pairs.map(|p| p.1),
    }
}

/// The largest root of β³ − 3β = 2h for 0 ≤ h ≤ 1, 2 cos(arccos(h) / 3).
#[inline]
fn lonely_root(h: f64) -> f64 {
    const SQRT_3: f64 = 1.732_050_807_568_877_2;
    // Value and slope at h = 0 and the value at h = 1 are exact: off by 1e-2 at most, and each
    // step squares that error.
    let mut root = SQRT_3 + h * (1.0 / 3.0 + h * (2.0 - SQRT_3 - 1.0 / 3.0));
    for _ in 0..3 {
        let square = root * root;
        root -= (root * (square - 3.0) - 2.0 * h) / (3.0 * square - 3.0);
    }
    root
}

/// Direction of a simple principal value: the longest column of the adjugate of B − value I.
#[inline]
fn lonely_direction(b: &Voigt, value: f64) -> Vec3 {
    let rows = [
        Vec3::new(b[0] - value, b[3], b[5]),
        Vec3::new(b[3], b[1] - value, b[4]),
        Vec3::new(b[5], b[4], b[2] - value),
    ];
    let mut longest = rows[0].cross(rows[1]);
    let mut square = longest.length_squared();
    for other in [rows[1].cross(rows[2]), rows[2].cross(rows[0])] {
        if other.length_squared() > square {
            longest = other;
            square = other.length_squared();
        }
    }
    longest / square.sqrt()
}

/// Two unit vectors at right angles to the unit vector `n` and to each other.
#[inline]
fn complement(n: Vec3) -> (Vec3, Vec3) {
    let u = if n.x.abs() > n.y.abs() {
        Vec3::new(-n.z, 0.0, n.x) / (n.x * n.x + n.z * n.z).sqrt()
    } else {
        Vec3::new(0.0, n.z, -n.y) / (n.y * n.y + n.z * n.z).sqrt()
    };
    (u, n.cross(u))
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
        assert_eq!(
            principal(&[7.0, 7.0, 7.0, 0.0, 0.0, 0.0]).values,
            [7.0, 7.0, 7.0]
        );
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
