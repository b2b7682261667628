//! Materials: density and model.

use super::amount::Named;
use super::error::Fault;
use super::given::Given;
use super::quantity::Dimension;
use super::raw::{RawMaterial, Text};
use super::values::{amount, choose, exactly_one, foreign, placed, positive, required, span};
use moldwarp::material::{
    External, LinearElastic, Material, MohrCoulomb, MohrCoulombParameters, ParameterError,
};
use moldwarp::plan::NamedMaterial;
use std::ops::Range;

/// What a unit weight is divided by, whatever the scene's gravity is, m/s².
const STANDARD_GRAVITY: f64 = 9.81;

pub(super) fn materials(
    raw: &Named<RawMaterial>,
    given: &Given,
) -> Result<Vec<NamedMaterial>, Fault> {
    raw.0
        .iter()
        .map(|(name, raw)| {
            Ok(NamedMaterial {
                name: name.get_ref().clone(),
                model: model(name, raw, given)?,
                density: density(name, raw)?,
            })
        })
        .collect()
}

/// What the reference says of each stands here.
#[derive(Clone, Copy)]
enum Model {
    /// Hooke's law in rate form, at large deformations; see
    /// [the elastic law](../limits.md#the-elastic-law-is-a-rate-law).
    LinearElastic,
    /// The same until it yields, with a tension cut-off; see
    /// [what is not there yet](../limits.md#what-is-not-there-yet).
    MohrCoulomb,
    /// Bodies move as one, without turning; see [rigid bodies](../theory/method.md#rigid-bodies).
    Rigid,
    /// A law that the program gives which runs the scene, as from
    /// [Python](../python.md#a-material-of-your-own); the command has none to give. The elastic constants
    /// set the stable step: the law must never be stiffer.
    External,
}

fn model(name: &Text, raw: &RawMaterial, given: &Given) -> Result<Material, Fault> {
    let models = [
        ("linear-elastic", Model::LinearElastic),
        ("mohr-coulomb", Model::MohrCoulomb),
        ("rigid", Model::Rigid),
        ("external", Model::External),
    ];
    let plastic = [
        ("cohesion", span(&raw.cohesion)),
        ("friction_angle", span(&raw.friction_angle)),
        ("dilation_angle", span(&raw.dilation_angle)),
        ("tension_cutoff", span(&raw.tension_cutoff)),
    ];
    match choose(placed(&raw.model), "model", &models)? {
        Model::LinearElastic => {
            foreign(&raw.model, &plastic)?;
            elastic((name.span(), "a linear-elastic material"), raw).map(Material::LinearElastic)
        }
        Model::MohrCoulomb => mohr_coulomb(name, raw),
        Model::Rigid => {
            let elastic = [
                ("young_modulus", span(&raw.young_modulus)),
                ("poisson_ratio", span(&raw.poisson_ratio)),
            ];
            foreign(&raw.model, &elastic)?;
            foreign(&raw.model, &plastic)?;
            Ok(Material::Rigid)
        }
        Model::External => {
            foreign(&raw.model, &plastic)?;
            let elastic = elastic((name.span(), "an external material"), raw)?;
            match given.laws.get(name.get_ref()) {
                Some(law) => Ok(Material::External(External {
                    elastic,
                    law: law.clone(),
                })),
                None => Err(no_law(name, raw)),
            }
        }
    }
}

fn no_law(name: &Text, raw: &RawMaterial) -> Fault {
    Fault::new(format!(
        "material `{}` is external, and nobody has given its law",
        name.get_ref()
    ))
    .at(raw.model.span(), "no law")
    .help(
        "the law is a program's: run the scene from it, as from Python; the command computes the \
         other models",
    )
}

fn elastic(owner: (Range<usize>, &str), raw: &RawMaterial) -> Result<LinearElastic, Fault> {
    let need = |key: &str, value, example| required(owner.clone(), key, value, example);
    let young = need("young_modulus", &raw.young_modulus, "\"100 kPa\"")?;
    let poisson = need("poisson_ratio", &raw.poisson_ratio, "0.3")?;
    let poisson_ratio = amount("poisson_ratio", poisson, Dimension::Number)?;
    if poisson_ratio <= -1.0 || poisson_ratio >= 0.5 {
        return Err(
            Fault::new("`poisson_ratio` must be greater than −1 and less than 0.5")
                .at(poisson.span(), "no stable elastic material has this")
                .help("0.5 is incompressible, which takes infinitely small steps; 0.49 is close"),
        );
    }
    Ok(LinearElastic {
        young_modulus: positive("young_modulus", young, Dimension::Stress)?,
        poisson_ratio,
    })
}

fn mohr_coulomb(name: &Text, raw: &RawMaterial) -> Result<Material, Fault> {
    let owner = (name.span(), "a Mohr-Coulomb material");
    let elastic = elastic(owner.clone(), raw)?;
    let need = |key: &str, value, example| required(owner.clone(), key, value, example);
    let cohesion = need("cohesion", &raw.cohesion, "\"5 kPa\"")?;
    let friction = need("friction_angle", &raw.friction_angle, "\"30 deg\"")?;
    let optional = |key: &str, value: &Option<_>, dimension| {
        value
            .as_ref()
            .map(|v| amount(key, v, dimension))
            .transpose()
    };
    let dilation = optional("dilation_angle", &raw.dilation_angle, Dimension::Angle)?;
    let parameters = MohrCoulombParameters {
        cohesion: amount("cohesion", cohesion, Dimension::Stress)?,
        friction_angle: amount("friction_angle", friction, Dimension::Angle)?,
        dilation_angle: dilation.unwrap_or(0.0),
        tension_cutoff: optional("tension_cutoff", &raw.tension_cutoff, Dimension::Stress)?,
    };
    let model = MohrCoulomb::new(elastic, parameters);
    model.map(Material::MohrCoulomb).map_err(|error| {
        // What is wrong stands at the value that is, or at the material that lacks one.
        let place = match &error {
            ParameterError::FrictionAngle(_) => Some(friction.span()),
            ParameterError::DilationAngle { .. } => span(&raw.dilation_angle),
            ParameterError::Cohesion(_) | ParameterError::NoStrength => Some(cohesion.span()),
            ParameterError::CutoffMissing => None,
            ParameterError::Cutoff(_) | ParameterError::CutoffAboveApex { .. } => {
                span(&raw.tension_cutoff)
            }
        };
        let label = if place.is_some() {
            "here"
        } else {
            "`tension_cutoff` is missing"
        };
        Fault::new(error.to_string())
            .at(place.unwrap_or(name.span()), label)
            .caused_by(error)
    })
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
