//! A material whose law is not one of ours: whoever uses the solver as a library gives it.
//!
//! The other models are functions of one particle. A law is asked for *all* particles of its material
//! at once, before stage 6 goes through the cells (`step/stress/external.rs`): so it may be written in
//! a language in which a call is dear and an operation on whole arrays is not.

use super::{LinearElastic, STATE_SIZE, StateField};
use std::fmt::Debug;
use std::sync::Arc;

/// What a step does to the particles of a material, an array a component, all of the same length and
/// in the same order. The order changes from step to step; `id` says which particle is which.
#[derive(Debug)]
pub struct Increments<'a> {
    /// Number of each particle; it never changes.
    pub id: &'a [u32],
    /// Stress before, rotated by the step's spin, Pa.
    pub before: [&'a [f64]; 6],
    /// Strain increment, with the volumetric part smoothed if the plan wants it.
    pub strain: [&'a [f64]; 6],
    /// To be set: the new stress, Pa. Not a number to begin with.
    pub stress: [&'a mut [f64]; 6],
    /// To be set if there are plastic strains; else they are not looked at.
    pub plastic: &'a mut bool,
    /// The plastic part of the strain increment, whose work the ledger books as `plastic`; all other work
    /// as `elastic`. All of it has to be set if any is.
    pub plastic_strain: [&'a mut [f64]; 6],
    /// State variables, to be changed in place; all zero at the start.
    pub state: [&'a mut [f64]; STATE_SIZE],
}

/// A law for the stress. Its `Debug` text is part of the fingerprint of a scene.
pub trait Law: Debug + Send + Sync {
    /// New stresses of all particles of the material, called once a step from the thread that makes it.
    ///
    /// # Errors
    ///
    /// What is wrong, in words that go on from the material's name: the simulation stops.
    fn update(&self, step: Increments) -> Result<(), String>;

    /// Name and unit of each state variable that it keeps, at most [`STATE_SIZE`].
    fn state_fields(&self) -> &'static [StateField];
}

/// A law with the elastic constants by which the step goes.
#[derive(Clone, Debug)]
pub struct External {
    /// Its wave speed sets the stable step, so the law must never be stiffer. Viscosity and absorbing
    /// boundaries go by it, too.
    pub elastic: LinearElastic,
    pub law: Arc<dyn Law>,
}

impl PartialEq for External {
    fn eq(&self, other: &External) -> bool {
        self.elastic == other.elastic && Arc::ptr_eq(&self.law, &other.law)
    }
}
