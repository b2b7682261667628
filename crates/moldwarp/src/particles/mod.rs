//! Material points: a structure of arrays, in the order in which the step works on them.

mod column;
mod columns;
pub(crate) mod inherited;
pub mod initial_stress;
mod order;
mod seeding;

pub use column::Column;
pub use columns::{Columns, States, Tensors, Vectors};
pub use inherited::InheritedError;
pub use initial_stress::{InitialStress, InitialStressError};
pub use order::Order;
pub use seeding::{Seed, SeedingError, check_overlap, particles, seeds};

use crate::Vec3;
use crate::material::{STATE_SIZE, State};

/// How many working columns there are.
pub(crate) const WORKING: usize = 3 + 3 + 2 + 6 + STATE_SIZE;

/// All particles. The arrays have the same length and order.
#[derive(Clone, Debug, Default)]
pub struct Particles {
    /// Number of each particle; it never changes. Bodies that are not there have theirs reserved.
    pub id: Column<u32>,
    /// Index into the plan's bodies.
    pub body: Column<u16>,
    /// The element each particle is in.
    pub element: Column<u32>,
    /// m.
    pub position: Vectors,
    /// m/s. Between the steps of a stage it belongs to the middle of the coming step.
    pub velocity: Vectors,
    /// Where displacements count from: the position at the start, or when a stage has reset them, m.
    pub origin: Vectors,
    /// Cauchy stress, Pa.
    pub stress: Tensors,
    /// State variables of the material model.
    pub state: States,
    /// m³.
    pub volume: Column<f64>,
    /// m³.
    pub initial_volume: Column<f64>,
    /// kg; it never changes.
    pub mass: Column<f64>,
}

impl Particles {
    /// None, with room for so many.
    pub(crate) fn with_capacity(count: usize) -> Particles {
        let mut particles = Particles {
            id: Column::with_capacity(count),
            body: Column::with_capacity(count),
            element: Column::with_capacity(count),
            ..Particles::default()
        };
        let columns = particles.columns_mut();
        columns.for_each(|column| column.reserve_exact(count));
        particles
    }

    pub fn len(&self) -> usize {
        self.id.len()
    }

    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Since the start, or since a stage has reset it, m.
    pub fn displacement(&self, place: usize) -> Vec3 {
        self.position.at(place) - self.origin.at(place)
    }

    /// Of all particles, m.
    pub fn displacements(&self) -> impl ExactSizeIterator<Item = Vec3> + '_ {
        (0..self.len()).map(|place| self.displacement(place))
    }

    /// Displacements count from here.
    pub(crate) fn reset_displacements(&mut self) {
        self.origin.clone_from(&self.position);
    }

    /// Total mass, kg.
    pub fn total_mass(&self) -> f64 {
        self.mass.iter().sum()
    }

    /// Σ m v, kg m/s.
    pub fn momentum(&self) -> Vec3 {
        self.mass
            .iter()
            .zip(self.velocity.iter())
            .map(|(&m, v)| m * v)
            .sum()
    }

    /// Σ m x × v, kg m²/s.
    pub fn angular_momentum(&self) -> Vec3 {
        (0..self.len())
            .map(|p| self.mass[p] * self.position.at(p).cross(self.velocity.at(p)))
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
    pub(crate) fn append(&mut self, mut others: Particles) {
        self.id.extend_from_slice(&others.id);
        self.body.extend_from_slice(&others.body);
        self.element.extend_from_slice(&others.element);
        for (own, other) in self.columns_mut().zip(others.columns_mut()) {
            own.extend_from_slice(other);
        }
    }

    /// Keeps those whose place is marked, in their order.
    pub fn retain(&mut self, keep: &[bool]) {
        self.id.retain(keep);
        self.body.retain(keep);
        self.element.retain(keep);
        self.columns_mut().for_each(|column| column.retain(keep));
    }

    /// Works on the numbers that a step changes, one array a component; two threads share them.
    pub(crate) fn for_working_columns(&mut self, work: impl Fn(&mut Column<f64>) + Sync) {
        let (of_motion, of_material) = self.halves_mut();
        rayon::join(|| of_motion.for_each(&work), || of_material.for_each(&work));
    }

    /// The numbers that a step changes, in two parts.
    fn halves_mut(
        &mut self,
    ) -> (
        impl Iterator<Item = &mut Column<f64>> + Send,
        impl Iterator<Item = &mut Column<f64>> + Send,
    ) {
        let of_motion = (self.position.columns_mut().iter_mut())
            .chain(self.velocity.columns_mut())
            .chain([&mut self.volume, &mut self.mass]);
        let of_material = (self.stress.columns_mut().iter_mut()).chain(self.state.columns_mut());
        (of_motion, of_material)
    }

    /// The numbers that a step changes, one array a component.
    pub(crate) fn working_columns_mut(&mut self) -> impl Iterator<Item = &mut Column<f64>> {
        let (of_motion, of_material) = self.halves_mut();
        of_motion.chain(of_material)
    }

    /// The numbers that a step does not change.
    pub(crate) fn other_columns_mut(&mut self) -> impl Iterator<Item = &mut Column<f64>> {
        (self.origin.columns_mut().iter_mut()).chain([&mut self.initial_volume])
    }

    /// All numbers of particles, one array a component.
    pub(crate) fn columns_mut(&mut self) -> impl Iterator<Item = &mut Column<f64>> {
        (self.position.columns_mut().iter_mut())
            .chain(self.velocity.columns_mut())
            .chain(self.origin.columns_mut())
            .chain(self.stress.columns_mut())
            .chain(self.state.columns_mut())
            .chain([&mut self.volume, &mut self.initial_volume, &mut self.mass])
    }
}
