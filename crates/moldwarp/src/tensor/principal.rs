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
//! eigensolver for 3×3 symmetric matrices" (2014), with polynomials instead of trigonometric functions. The trace of the
//! adjugate is the product of the distances to the other values, 3β² − 3.
//!
//! Stresses side by side wait for each other's results, and for quotients and roots longest: there are few of them, and
//! polynomials are added up in pairs.

use super::Voigt;
use crate::lanes::{either, smaller};

/// A symmetric tensor by its principal values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principal {
    /// Largest first.
    pub values: [f64; 3],
    /// Whether the lonely value is the smallest one; else it is the largest one.
    last: bool,
    /// The projector onto its direction is `over` times this.
    adjugate: Voigt,
    over: f64,
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
            adjugate: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            over: 1.0,
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
        let along = (alone - centre) * self.over;
        let across = 0.5 * (top - bottom) * self.over_radius;
        std::array::from_fn(|k| {
            let own = self.adjugate[k] * along + self.plane[k] * across;
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
    // As 1/√x = √x/x, the quotient does not wait for the root.
    let over = 1.0 / (unit_squared * unit_squared);
    let determinant = b[0] * (b[1] * b[2] - b[4] * b[4]) - b[3] * (b[3] * b[2] - b[4] * b[5])
        + b[5] * (b[3] * b[4] - b[1] * b[5]);
    let half = (0.5 * determinant) * (unit * over);
    let (root, over_distances) = lonely_root(smaller(half.abs(), 1.0), unit_squared * over);
    let alone = unit * root.copysign(half);
    let adjugate = adjugate(b, alone);

    let centre = -0.5 * alone;
    let apart = (alone - centre) * over_distances;
    let plane: Voigt = std::array::from_fn(|k| {
        let own = b[k] - adjugate[k] * apart;
        if k < 3 { own - centre } else { own }
    });
    let radius_squared = 0.5 * square(&plane);
    let radius = radius_squared.sqrt();
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
        adjugate,
        over: over_distances,
        plane,
        over_radius: either(differ, radius * (1.0 / radius_squared), 0.0),
    }
}

/// The largest root β of β³ − 3β = 2h for 0 ≤ h ≤ 1, 2 cos(arccos(h) / 3), and `factor` / (3β² − 3).
#[inline(always)]
fn lonely_root(h: f64, factor: f64) -> (f64, f64) {
    let h2 = h * h;
    let h4 = h2 * h2;
    let h8 = h4 * h4;
    let linear = |c: &[f64], k: usize| c[k] + c[k + 1] * h;
    let cubic = |c: &[f64], k: usize| linear(c, k) + linear(c, k + 2) * h2;
    let seventh = |c: &[f64], k: usize| cubic(c, k) + cubic(c, k + 4) * h4;
    let fifteenth = seventh(&ROOT, 0) + seventh(&ROOT, 8) * h8;
    let root = fifteenth + linear(&ROOT, 16) * (h8 * h8);
    let start = seventh(&OVER, 0) + linear(&OVER, 8) * h8;
    // One step of Newton's iteration for a reciprocal.
    let over = (start * (factor * (1.0 / 3.0))) * (2.0 - (root * root - 1.0) * start);
    (root, over)
}

/// Coefficients of 2 cos(arccos(h) / 3) for 0 ≤ h ≤ 1, the constant first: it interpolates in Chebyshev points, off by at
/// most 2e-16.
const ROOT: [f64; 18] = [
    1.732_050_807_568_877_4,
    0.333_333_333_333_225_23,
    -0.096_225_044_853_218_92,
    0.049_382_715_543_020_87,
    -0.031_184_030_706_843_89,
    0.021_947_710_673_387_81,
    -0.016_514_462_848_362_21,
    0.012_996_017_525_005_404,
    -0.010_535_428_631_981_057,
    0.008_650_749_231_281_842,
    -0.007_002_755_080_584_41,
    0.005_358_373_387_141_181,
    -0.003_669_219_985_073_899_2,
    0.002_113_847_064_559_300_5,
    -0.000_957_453_682_072_820_2,
    0.000_313_744_963_885_133_2,
    -6.534_997_416_054_092e-5,
    6.446_471_913_600_215e-6,
];

/// The same of 1 / (β² − 1), off by at most 2e-8 of it.
const OVER: [f64; 10] = [
    0.499_999_994_471_837_9,
    -0.288_674_023_758_624_17,
    0.222_184_690_668_496_47,
    -0.186_601_899_260_060_27,
    0.161_100_335_713_740_27,
    -0.134_005_105_036_115_76,
    0.097_005_751_060_189_65,
    -0.053_448_995_384_657_64,
    0.018_876_255_380_243_93,
    -0.003_103_673_374_029_122,
];

/// adj(B − x I), for a principal value x the projector onto its direction times its distances to the other values.
#[inline(always)]
fn adjugate(b: &Voigt, value: f64) -> Voigt {
    let (x, y, z) = (b[0] - value, b[1] - value, b[2] - value);
    [
        y * z - b[4] * b[4],
        z * x - b[5] * b[5],
        x * y - b[3] * b[3],
        b[4] * b[5] - b[3] * z,
        b[5] * b[3] - b[4] * x,
        b[3] * b[4] - b[5] * y,
    ]
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
    fn polynomials_give_the_lonely_root() {
        for n in 0..=1000 {
            let h = f64::from(n) / 1000.0;
            let exact = 2.0 * libm::cos(libm::acos(h) / 3.0);
            let (root, over) = lonely_root(h, 6.0);
            assert!((root - exact).abs() < 9e-16, "{h}: {root} {exact}");
            let exact = 2.0 / (exact * exact - 1.0);
            assert!((over / exact - 1.0).abs() < 3e-15, "{h}: {over} {exact}");
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
