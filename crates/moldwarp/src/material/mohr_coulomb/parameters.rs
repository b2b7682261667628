//! Parameters of Mohr-Coulomb and what is wrong with them.

/// What a user gives. Angles in radians, stresses in Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MohrCoulombParameters {
    /// c ≥ 0, Pa; undrained shear strength c_u for φ = 0.
    pub cohesion: f64,
    /// 0 ≤ φ < π/2.
    pub friction_angle: f64,
    /// 0 ≤ ψ ≤ φ.
    pub dilation_angle: f64,
    /// 0 ≤ T ≤ c cot φ, Pa; `None` for c cot φ. Required for φ = 0.
    pub tension_cutoff: Option<f64>,
}

/// Parameters with which the model makes no sense.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParameterError {
    #[error("the friction angle is {} degrees; it must be at least 0 and less than 90", .0)]
    FrictionAngle(f64),
    #[error(
        "the dilation angle is {dilation} degrees; it must be at least 0 and at most the friction angle, {friction} degrees"
    )]
    DilationAngle { dilation: f64, friction: f64 },
    #[error("the cohesion is {0} Pa; it must be a finite number, zero or more")]
    Cohesion(f64),
    #[error(
        "cohesion and friction angle are both zero: the material has no strength; give one of them"
    )]
    NoStrength,
    #[error(
        "a material without friction needs a tension cut-off, as its shear strength does not limit tension in all directions; give a very large one to have none"
    )]
    CutoffMissing,
    #[error("the tension cut-off is {0} Pa; it must be a finite number, zero or more")]
    Cutoff(f64),
    #[error(
        "the tension cut-off is {cutoff} Pa, above {apex} Pa, the tension c cot φ at which cohesion and friction end; lower it, or leave it out to have c cot φ"
    )]
    CutoffAboveApex { cutoff: f64, apex: f64 },
}

/// Relative difference below which a cut-off is c cot φ.
const EQUAL: f64 = 1e-12;

impl MohrCoulombParameters {
    /// c cot φ, Pa; `None` for φ = 0.
    pub fn apex(&self) -> Option<f64> {
        let sin = libm::sin(self.friction_angle);
        (sin > 0.0).then(|| self.cohesion * libm::cos(self.friction_angle) / sin)
    }

    /// The cut-off if it cuts the apex off, Pa.
    pub(super) fn effective_cutoff(&self) -> Option<f64> {
        self.tension_cutoff
            .filter(|&cutoff| self.apex().is_none_or(|apex| cutoff < apex * (1.0 - EQUAL)))
    }

    pub fn check(&self) -> Result<(), ParameterError> {
        let degrees = |radians: f64| (radians.to_degrees() * 1e9).round() / 1e9;
        let (friction, dilation) = (self.friction_angle, self.dilation_angle);
        if !(0.0..std::f64::consts::FRAC_PI_2).contains(&friction) {
            return Err(ParameterError::FrictionAngle(degrees(friction)));
        }
        if !(0.0..=friction).contains(&dilation) {
            return Err(ParameterError::DilationAngle {
                dilation: degrees(dilation),
                friction: degrees(friction),
            });
        }
        if !(self.cohesion.is_finite() && self.cohesion >= 0.0) {
            return Err(ParameterError::Cohesion(self.cohesion));
        }
        if friction == 0.0 && self.cohesion == 0.0 {
            return Err(ParameterError::NoStrength);
        }
        match (self.tension_cutoff, self.apex()) {
            (Some(cutoff), _) if !(cutoff.is_finite() && cutoff >= 0.0) => {
                Err(ParameterError::Cutoff(cutoff))
            }
            (Some(cutoff), Some(apex)) if cutoff > apex * (1.0 + EQUAL) => {
                Err(ParameterError::CutoffAboveApex { cutoff, apex })
            }
            (None, None) => Err(ParameterError::CutoffMissing),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn soil(c: f64, phi: f64, psi: f64, tension_cutoff: Option<f64>) -> MohrCoulombParameters {
        MohrCoulombParameters {
            cohesion: c,
            friction_angle: phi.to_radians(),
            dilation_angle: psi.to_radians(),
            tension_cutoff,
        }
    }

    #[test]
    fn wrong_parameters_are_refused_with_a_reason() {
        for (parameters, words) in [
            (soil(1e3, 90.0, 0.0, None), "friction angle is 90 degrees"),
            (soil(1e3, -1.0, 0.0, None), "friction angle is -1 degrees"),
            (soil(1e3, f64::NAN, 0.0, None), "friction angle is NaN"),
            (soil(1e3, 30.0, 31.0, None), "dilation angle is 31 degrees"),
            (soil(1e3, 30.0, -1.0, None), "dilation angle is -1 degrees"),
            (soil(-1.0, 30.0, 0.0, None), "cohesion is -1 Pa"),
            (soil(f64::INFINITY, 30.0, 0.0, None), "cohesion is inf Pa"),
            (soil(0.0, 0.0, 0.0, Some(0.0)), "no strength"),
            (soil(1e3, 0.0, 0.0, None), "needs a tension cut-off"),
            (
                soil(1e3, 0.0, 0.0, Some(f64::INFINITY)),
                "cut-off is inf Pa",
            ),
            (soil(1e3, 30.0, 0.0, Some(-1.0)), "cut-off is -1 Pa"),
            (
                soil(1e3, 45.0, 0.0, Some(1001.0)),
                "cut-off is 1001 Pa, above 1000",
            ),
            (
                soil(0.0, 30.0, 0.0, Some(1.0)),
                "cut-off is 1 Pa, above 0 Pa",
            ),
        ] {
            let message = parameters.check().unwrap_err().to_string();
            assert!(message.contains(words), "{message}");
        }
        for parameters in [
            soil(0.0, 30.0, 30.0, None),
            soil(0.0, 30.0, 0.0, Some(0.0)),
            soil(1e3, 0.0, 0.0, Some(1e9)),
            soil(1e3, 89.9, 0.0, None),
            soil(1e3, 25.0, 5.0, Some(1e3 / libm::tan(25f64.to_radians()))),
        ] {
            assert_eq!(parameters.check(), Ok(()));
        }
    }
}
