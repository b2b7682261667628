//! Materials: density and model.

use super::amount::Named;
use super::error::Fault;
use super::quantity::Dimension;
use super::raw::{RawMaterial, Text};
use super::unsupported;
use super::values::{amount, choose, exactly_one, placed, positive, required, span};
use moldwarp::material::{LinearElastic, Material};
use moldwarp::plan::NamedMaterial;

/// What a unit weight is divided by, whatever the scene's gravity is, m/s².
const STANDARD_GRAVITY: f64 = 9.81;

pub(super) fn materials(raw: &Named<RawMaterial>) -> Result<Vec<NamedMaterial>, Fault> {
    raw.0
        .iter()
        .map(|(name, raw)| {
            Ok(NamedMaterial {
                name: name.get_ref().clone(),
                model: model(name, raw)?,
                density: density(name, raw)?,
            })
        })
        .collect()
}

fn model(name: &Text, raw: &RawMaterial) -> Result<Material, Fault> {
    choose(
        placed(&raw.model),
        "model",
        &[("linear-elastic", ())],
        &unsupported::MODELS,
    )?;
    let owner = || (name.span(), "a linear-elastic material");
    let young = required(owner(), "young_modulus", &raw.young_modulus, "\"100 kPa\"")?;
    let poisson = required(owner(), "poisson_ratio", &raw.poisson_ratio, "0.3")?;
    let poisson_ratio = amount("poisson_ratio", poisson, Dimension::Number)?;
    if poisson_ratio <= -1.0 || poisson_ratio >= 0.5 {
        return Err(
            Fault::new("`poisson_ratio` must be greater than −1 and less than 0.5")
                .at(poisson.span(), "no stable elastic material has this")
                .help("0.5 is incompressible, which takes infinitely small steps; 0.49 is close"),
        );
    }
    Ok(Material::LinearElastic(LinearElastic {
        young_modulus: positive("young_modulus", young, Dimension::Stress)?,
        poisson_ratio,
    }))
}

fn density(name: &Text, raw: &RawMaterial) -> Result<f64, Fault> {
    exactly_one(
        (name.span(), "a material"),
        &[
            ("unit_weight", span(&raw.unit_weight)),
            ("density", span(&raw.density)),
        ],
    )?;
    match (&raw.unit_weight, &raw.density) {
        (Some(weight), _) => {
            Ok(positive("unit_weight", weight, Dimension::UnitWeight)? / STANDARD_GRAVITY)
        }
        (None, Some(density)) => positive("density", density, Dimension::Density),
        (None, None) => Err(Fault::new("a material needs a density")),
    }
}
