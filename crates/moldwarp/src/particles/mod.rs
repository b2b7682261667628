//! Material points: a structure of arrays, ordered by the element they are in.

mod inherited;
pub mod initial_stress;
mod order;
mod seeding;

pub use inherited::InheritedError;
pub(crate) use inherited::populate;
pub use initial_stress::{InitialStress, InitialStressError};
pub use order::Order;
pub use seeding::{SeedingError, seed};

use crate::Vec3;
use crate::material::State;
use crate::tensor::Voigt;

/// All particles. The arrays have the same length and order.
#[derive(Clone, Debug, Default)]
pub struct Particles {
    /// Number of each particle at the start; it never changes.
    pub id: Vec<u32>,
    /// Index into the plan's bodies.
    pub body: Vec<u16>,
    /// The element each particle is in.
    pub element: Vec<u32>,
    /// m.
    pub position: Vec<Vec3>,
    /// m/s. Between the steps of a stage it belongs to the middle of the coming step.
    pub velocity: Vec<Vec3>,
    /// Since the start, or since a stage has reset it, m.
    pub displacement: Vec<Vec3>,
    /// Cauchy stress, Pa.
    pub stress: Vec<Voigt>,
    /// State variables of the material model.
    pub state: Vec<State>,
    /// m³.
    pub volume: Vec<f64>,
    /// m³.
    pub initial_volume: Vec<f64>,
    /// kg; it never changes.
    pub mass: Vec<f64>,
}

impl Particles {
    pub fn len(&self) -> usize {
        self.id.len()
    }

    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Total mass, kg.
    pub fn total_mass(&self) -> f64 {
        self.mass.iter().sum()
    }

    /// Σ m v, kg m/s.
    pub fn momentum(&self) -> Vec3 {
        self.mass
            .iter()
            .zip(&self.velocity)
            .map(|(&m, &v)| m * v)
            .sum()
    }

    /// Σ m x × v, kg m²/s.
    pub fn angular_momentum(&self) -> Vec3 {
        (0..self.len())
            .map(|p| self.mass[p] * self.position[p].cross(self.velocity[p]))
            .sum()
    }

    /// For each id, the place of its particle in the arrays.
    pub fn places_by_id(&self) -> Vec<u32> {
        let mut places = vec![0; self.len()];
        for (place, &id) in self.id.iter().enumerate() {
            places[id as usize] = place as u32;
        }
        places
    }
}
