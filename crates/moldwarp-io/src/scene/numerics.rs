//! Numerical parameters.

use super::amount::{AmountOr, Spanned};
use super::error::Fault;
use super::quantity::Dimension;
use super::raw::{RawNumerics, RawViscosity};
use super::values::{
    amount, amount_at, at_most_one, choose, damping, not_negative, placed, positive, span,
};
use moldwarp::plan::{Integration, MassMatrix, Numerics, Smoothing};
use std::f64::consts::PI;

/// What is not given is as in [`Numerics::default`].
pub(super) fn numerics(raw: &RawNumerics) -> Result<Numerics, Fault> {
    let mut n = Numerics::default();
    at_most_one(&[
        ("time_step", span(&raw.time_step)),
        ("max_time_step", span(&raw.max_time_step)),
    ])?;
    if let Some(word) = &raw.integration {
        let choices = [
            ("mixed", Integration::Mixed),
            ("particle", Integration::Particle),
        ];
        n.integration = choose(placed(word), "integration", &choices)?;
    }
    if let Some(word) = &raw.mass {
        let choices = [
            ("corrected", MassMatrix::Corrected),
            ("lumped", MassMatrix::Lumped),
        ];
        n.mass = choose(placed(word), "mass matrix", &choices)?;
    }
    if let Some(word) = &raw.smoothing {
        let choices = [
            ("true", Smoothing::Strain),
            ("false", Smoothing::Off),
            ("conjugate", Smoothing::Conjugate),
        ];
        n.smoothing = choose((word.span(), &word.get_ref().0), "smoothing", &choices)?;
    }
    if let Some(courant) = &raw.courant {
        n.courant = amount("courant", courant, Dimension::Number)?;
        if !(n.courant > 0.0 && n.courant <= 1.0) {
            return Err(Fault::new("`courant` must be greater than 0 and at most 1")
                .at(courant.span(), "outside (0, 1]")
                .help("it is the share of the critical time step that is taken; 0.5 is usual"));
        }
    }
    if let Some(rate) = &raw.pic_rate {
        n.pic_rate = not_negative("pic_rate", rate, Dimension::Rate)?;
    }
    if let Some(value) = &raw.viscosity {
        n.viscosity = viscosity(value)?;
    }
    if let Some(value) = &raw.damping {
        n.damping = damping(value)?;
    }
    if let Some(step) = &raw.time_step {
        n.time_step = Some(positive("time_step", step, Dimension::Time)?);
    }
    if let Some(step) = &raw.max_time_step {
        n.max_time_step = Some(positive("max_time_step", step, Dimension::Time)?);
    }
    Ok(n)
}

/// A stress C : ε̇ β damps a mode of angular frequency ω = 2π/T with the fraction ξ = β ω/2 of
/// critical, so β = ξ T/π.
fn viscosity(raw: &Spanned<AmountOr<RawViscosity>>) -> Result<f64, Fault> {
    match raw.get_ref() {
        AmountOr::Table(mode) => {
            let fraction = not_negative("fraction", &mode.fraction, Dimension::Number)?;
            Ok(fraction * positive("period", &mode.period, Dimension::Time)? / PI)
        }
        AmountOr::Amount(time) => {
            let time = amount_at("viscosity", raw.span(), time, Dimension::Time)?;
            if time >= 0.0 {
                return Ok(time);
            }
            Err(Fault::new("`viscosity` must not be negative")
                .at(raw.span(), "negative")
                .help("0 switches it off"))
        }
    }
}
