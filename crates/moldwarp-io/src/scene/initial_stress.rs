//! The stress before the first stage.

use super::amount::Spanned;
use super::error::Fault;
use super::quantity::Dimension;
use super::raw::{RawBody, RawInitialStress};
use super::values::{choose, not_negative, placed, positive};
use moldwarp::particles::{InitialStress, InitialStressError};
use std::ops::Range;

/// `bodies` in the order of the plan.
pub(super) fn initial_stress<'a>(
    raw: Option<&Spanned<RawInitialStress>>,
    bodies: impl Iterator<Item = &'a RawBody> + Clone,
) -> Result<Option<InitialStress>, Fault> {
    let Some(raw) = raw else {
        return match bodies.into_iter().find_map(|b| b.k0.as_ref()) {
            None => Ok(None),
            Some(k0) => Err(Fault::new("`k0` needs an initial stress to be a part of")
                .at(k0.span(), "K0 of what?")
                .help("add [initial_stress] with kind = \"k0\", or leave this out")),
        };
    };
    let (place, raw) = (raw.span(), raw.get_ref());
    choose(placed(&raw.kind), "kind of initial stress", &[("k0", ())])?;
    let k0 = |body: &RawBody| {
        let k0 = body.k0.as_ref();
        k0.map(|k0| positive("k0", k0, Dimension::Number))
            .transpose()
    };
    let k0: Vec<Option<f64>> = bodies.map(k0).collect::<Result<_, _>>()?;
    if k0.iter().all(Option::is_none) {
        return Err(
            Fault::new("no body has a `k0`, so there is no initial stress")
                .at(place, "of which body?")
                .help("give each body of the ground its K0, for example k0 = 0.5"),
        );
    }
    let surcharge = raw.surcharge.as_ref();
    let surcharge = surcharge.map(|q| not_negative("surcharge", q, Dimension::Stress));
    Ok(Some(InitialStress {
        k0,
        surcharge: surcharge.transpose()?.unwrap_or(0.0),
    }))
}

/// What the solver found, at the place where the initial stress is asked for.
pub(super) fn explain(error: &InitialStressError, place: Range<usize>) -> Fault {
    let help = match error {
        InitialStressError::NoGravity => "give the scene its gravity",
        InitialStressError::Sloping { .. } => {
            "use gravity loading for such ground: no initial stress, and a first stage with damping \
             until = \"equilibrium\""
        }
        InitialStressError::SideBySide { .. } => {
            "the procedure is for horizontal layers: give them the same weight, or use gravity \
             loading: no initial stress, and a first stage with damping until = \"equilibrium\""
        }
        InitialStressError::NotOnFaces { .. } => {
            "let the mesh follow the layers, with a volume for each; under a surface that slopes use \
             gravity loading: no initial stress, and a first stage with damping until = \
             \"equilibrium\""
        }
        InitialStressError::Yields { .. } => {
            "K0 must lie between the active and the passive coefficient of earth pressure, \
             (1 ∓ sin φ)/(1 ± sin φ) without cohesion; 1 − sin φ is usual"
        }
    };
    Fault::new(error.to_string())
        .at(place, "cannot be done")
        .help(help)
}
