//! Material points: a structure of arrays, ordered by the element they are in.

pub(crate) mod inherited;
pub mod initial_stress;
mod order;
mod seeding;

pub use inherited::InheritedError;
pub use initial_stress::{InitialStress, InitialStressError};
pub use order::Order;
pub use seeding::{Seed, SeedingError, check_overlap, particles, seeds};

use crate::Vec3;
use crate::material::State;
use crate::tensor::Voigt;

/// All particles. The arrays have the same length and order.
#[derive(Clone, Debug, Default)]
pub struct Particles {
    /// Number of each particle; it never changes. Bodies that are not there have theirs reserved.
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

    /// For each id, the place of its particle in the arrays; none if its body is not there.
    pub fn places_by_id(&self) -> Vec<Option<u32>> {
        let count = self.id.iter().max().map_or(0, |&id| id as usize + 1);
        let mut places = vec![None; count];
        for (place, &id) in self.id.iter().enumerate() {
            places[id as usize] = Some(place as u32);
        }
        places
    }

    /// Puts others after these.
    pub(crate) fn append(&mut self, others: Particles) {
        self.id.extend(others.id);
        self.body.extend(others.body);
        self.element.extend(others.element);
        self.position.extend(others.position);
        self.velocity.extend(others.velocity);
        self.displacement.extend(others.displacement);
        self.stress.extend(others.stress);
        self.state.extend(others.state);
        self.volume.extend(others.volume);
        self.initial_volume.extend(others.initial_volume);
        self.mass.extend(others.mass);
    }

    /// Keeps those whose place is marked, in their order.
    pub fn retain(&mut self, keep: &[bool]) {
        retain(&mut self.id, keep);
        retain(&mut self.body, keep);
        retain(&mut self.element, keep);
        retain(&mut self.position, keep);
        retain(&mut self.velocity, keep);
        retain(&mut self.displacement, keep);
        retain(&mut self.stress, keep);
        retain(&mut self.state, keep);
        retain(&mut self.volume, keep);
        retain(&mut self.initial_volume, keep);
        retain(&mut self.mass, keep);
    }
}

fn retain<T>(values: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    values.retain(|_| *keep.next().expect("a mark for each particle"));
}
