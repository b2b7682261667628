//! Isotropic linear elasticity in rate form: Δσ = λ tr(Δε) I + 2G Δε.

use crate::tensor::{Voigt, trace};

/// Hooke's law. With the rotation of stresses before each increment it is a hypoelastic law:
/// an oedometer test gives σ = E_c ln(l/l₀).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearElastic {
    /// E, Pa.
    pub young_modulus: f64,
    /// ν.
    pub poisson_ratio: f64,
}

impl LinearElastic {
    /// G = E / (2 (1 + ν)), Pa (Jassim et al. Eq. 19).
    pub fn shear_modulus(&self) -> f64 {
        self.young_modulus / (2.0 * (1.0 + self.poisson_ratio))
    }

    /// λ = E ν / ((1 + ν) (1 − 2ν)), Pa.
    pub fn lame(&self) -> f64 {
        let nu = self.poisson_ratio;
        self.young_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// E_c = E (1 − ν) / ((1 + ν) (1 − 2ν)), Pa (Jassim et al. Eq. 19).
    pub fn constrained_modulus(&self) -> f64 {
        let nu = self.poisson_ratio;
        self.young_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    }

    /// σ + λ tr(Δε) I + 2G Δε, Pa.
    #[inline(always)]
    pub fn update(&self, stress: &Voigt, strain: &Voigt) -> Voigt {
        let (mean, shear) = (self.lame() * trace(strain), self.shear_modulus());
        let mut new = *stress;
        for k in 0..3 {
            new[k] += mean + 2.0 * shear * strain[k];
            new[k + 3] += shear * strain[k + 3];
        }
        new
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moduli_and_stresses_are_hookes() {
        let soil = LinearElastic {
            young_modulus: 5e6,
            poisson_ratio: 0.3,
        };
        assert!((soil.shear_modulus() - 5e6 / 2.6).abs() < 1e-6);
        assert!(
            (soil.constrained_modulus() - soil.lame() - 2.0 * soil.shear_modulus()).abs() < 1e-6
        );
        // Uniaxial stress: ε = (1, −ν, −ν) σ/E.
        let stress = soil.update(&[0.0; 6], &[1e-3, -0.3e-3, -0.3e-3, 0.0, 0.0, 2e-3]);
        let expected = [5e3, 0.0, 0.0, 0.0, 0.0, 2e-3 * soil.shear_modulus()];
        assert!(
            stress
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-9)
        );
    }
}
