//! Constitutive models. One file a model: equations, source, update, wave speed, tests.

mod linear_elastic;

pub use linear_elastic::LinearElastic;

/// A material model with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    LinearElastic(LinearElastic),
}

impl Material {
    /// The elastic part of the model.
    pub fn elasticity(&self) -> &LinearElastic {
        match self {
            Material::LinearElastic(elastic) => elastic,
        }
    }
}
