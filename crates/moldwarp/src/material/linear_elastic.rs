//! Isotropic linear elasticity in rate form: Δσ = λ tr(Δε) I + 2G Δε.

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
}
