//! Constitutive models. One file a model: equations, source, update, wave speed, tests.

mod linear_elastic;
mod mohr_coulomb;

pub use linear_elastic::LinearElastic;
pub use mohr_coulomb::{
    MohrCoulomb, MohrCoulombParameters, MohrCoulombState, ParameterError, PlasticStep, YieldState,
};

use crate::tensor::Voigt;

/// A material model with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    LinearElastic(LinearElastic),
}

impl Material {
    /// Stress after a strain increment, Pa. `stress` has been rotated by the step's spin.
    #[inline]
    pub fn update(&self, stress: &Voigt, strain: &Voigt) -> Voigt {
        match self {
            Material::LinearElastic(elastic) => elastic.update(stress, strain),
        }
    }

    /// The elastic part of the model.
    pub fn elasticity(&self) -> &LinearElastic {
        match self {
            Material::LinearElastic(elastic) => elastic,
        }
    }
}
