//! Symmetric second-order tensors as six numbers, and rotations.
//!
//! Order xx, yy, zz, xy, yz, zx. Stresses hold the tensor's components, strains hold engineering
//! shear strains (twice the tensor's), so that [`dot`] of a stress and a strain is σ : ε.

mod principal;

pub use principal::{Principal, principal, principal_if_ordinary};

use crate::{Mat3, Vec3};

/// Six components, xx, yy, zz, xy, yz, zx.
pub type Voigt = [f64; 6];

/// Σ aᵢ bᵢ; the double contraction if `a` is a stress and `b` a strain.
#[inline(always)]
pub fn dot(a: &Voigt, b: &Voigt) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5]
}

/// Sum of the normal components.
#[inline(always)]
pub fn trace(a: &Voigt) -> f64 {
    a[0] + a[1] + a[2]
}

/// a + f b.
#[inline(always)]
pub fn add_scaled(a: &mut Voigt, b: &Voigt, f: f64) {
    for k in 0..6 {
        a[k] += b[k] * f;
    }
}

/// The symmetric matrix of a stress.
#[inline(always)]
pub fn to_matrix(s: &Voigt) -> Mat3 {
    Mat3::from_cols(
        Vec3::new(s[0], s[3], s[5]),
        Vec3::new(s[3], s[1], s[4]),
        Vec3::new(s[5], s[4], s[2]),
    )
}

/// The stress of a symmetric matrix.
#[inline(always)]
pub fn from_matrix(m: &Mat3) -> Voigt {
    [
        m.x_axis.x, m.y_axis.y, m.z_axis.z, m.x_axis.y, m.y_axis.z, m.z_axis.x,
    ]
}

/// Engineering strain, the symmetric part of a displacement gradient.
#[inline(always)]
pub fn strain(gradient: &Mat3) -> Voigt {
    let (x, y, z) = (gradient.x_axis, gradient.y_axis, gradient.z_axis);
    [x.x, y.y, z.z, x.y + y.x, y.z + z.y, z.x + x.z]
}

/// Full contraction σ : ∇u of a stress with a displacement gradient.
#[inline(always)]
pub fn contract(stress: &Voigt, gradient: &Mat3) -> f64 {
    dot(stress, &strain(gradient))
}

/// σ · n.
#[inline(always)]
pub fn times(s: &Voigt, n: Vec3) -> Vec3 {
    Vec3::new(
        s[0] * n.x + s[3] * n.y + s[5] * n.z,
        s[3] * n.x + s[1] * n.y + s[4] * n.z,
        s[5] * n.x + s[4] * n.y + s[2] * n.z,
    )
}

/// Q σ Qᵀ of a rotation Q.
#[inline(always)]
pub fn rotate(s: &Voigt, q: &Mat3) -> Voigt {
    let (a, b, c) = (q.row(0), q.row(1), q.row(2));
    let (x, y) = (times(s, a), times(s, b));
    let (xx, yy) = (x.dot(a), y.dot(b));
    // The trace stays; changes, not the trace, so that zz stays to the last bit if nothing turns.
    let zz = s[2] + ((s[0] - xx) + (s[1] - yy));
    [xx, yy, zz, x.dot(b), y.dot(c), x.dot(c)]
}

/// Half the axial vector of the skew part W of a gradient.
#[inline(always)]
pub fn half_spin(gradient: &Mat3) -> Vec3 {
    let (x, y, z) = (gradient.x_axis, gradient.y_axis, gradient.z_axis);
    0.25 * Vec3::new(y.z - z.y, z.x - x.z, x.y - y.x)
}

/// The rotation of a step from the spin increment, Q = (I − W/2)⁻¹ (I + W/2), orthogonal for any W (Hughes and Winget 1980).
/// With half the axial vector of W, r, it is I + 2/(1+r²) (R + R²), R = r×; given are d r, d, and 2/(d² + d²r²) of any d.
#[inline(always)]
pub fn spin_rotation(r: Vec3, d: f64, factor: f64) -> Mat3 {
    let rate = Mat3::from_cols(
        Vec3::new(0.0, r.z, -r.y),
        Vec3::new(-r.z, 0.0, r.x),
        Vec3::new(r.y, -r.x, 0.0),
    );
    Mat3::IDENTITY + (rate * d + rate * rate) * factor
}

/// √(3/2 s : s) with s the deviator: von Mises' equivalent stress, Pa.
pub fn equivalent(s: &Voigt) -> f64 {
    let mean = trace(s) / 3.0;
    let normal: f64 = (0..3).map(|i| (s[i] - mean) * (s[i] - mean)).sum();
    let shear: f64 = (3..6).map(|i| s[i] * s[i]).sum();
    (1.5 * (normal + 2.0 * shear)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spin_rotation_is_orthogonal_and_matches_its_definition() {
        let g = Mat3::from_cols_array(&[0.1, 0.4, -0.3, 0.7, -0.2, 0.5, 0.2, -0.6, 0.3]);
        let (r, d) = (half_spin(&g), 3.0);
        let q = spin_rotation(d * r, d, 2.0 / (d * d * (1.0 + r.length_squared())));
        assert!((q * q.transpose()).abs_diff_eq(Mat3::IDENTITY, 1e-15));
        let w = (g - g.transpose()) * 0.5;
        let definition = (Mat3::IDENTITY - w * 0.5).inverse() * (Mat3::IDENTITY + w * 0.5);
        assert!(q.abs_diff_eq(definition, 1e-15), "{q} {definition}");
    }

    #[test]
    fn rotation_by_a_quarter_turn_swaps_components() {
        let q = Mat3::from_rotation_z(std::f64::consts::FRAC_PI_2);
        let turned = rotate(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], &q);
        for (a, b) in turned.iter().zip([2.0, 1.0, 3.0, -4.0, 6.0, -5.0]) {
            assert!((a - b).abs() < 1e-14);
        }
    }

    #[test]
    fn contraction_and_traction_agree_with_matrices() {
        let s = [1.0, -2.0, 3.0, 0.5, 0.25, -0.75];
        let g = Mat3::from_cols_array(&[0.1, 0.4, -0.3, 0.7, -0.2, 0.5, 0.2, -0.6, 0.3]);
        let product = to_matrix(&s) * g;
        let trace = product.x_axis.x + product.y_axis.y + product.z_axis.z;
        assert!((contract(&s, &g) - trace).abs() < 1e-15);
        let n = Vec3::new(0.3, -0.4, 0.5);
        assert!((times(&s, n) - to_matrix(&s) * n).length() < 1e-15);
        assert!((equivalent(&[2.0, 0.0, 0.0, 0.0, 0.0, 0.0]) - 2.0).abs() < 1e-15);
    }
}
