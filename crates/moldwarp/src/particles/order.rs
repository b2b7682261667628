//! Which particles are in which element, and keeping them in memory as the step wants them.
//!
//! The *rank* of a particle counts by element, and within it by velocity field; those of one element and
//! field keep the order that they had. Its *place* is where it lies in the arrays: in [`Tiles`](crate::lanes::Tiles).

use super::{Column, Particles};
use crate::contact::Fields;
use crate::lanes::{LANES, prefetch_number};
use crate::parallel::fold;
use std::ops::Range;

/// Particles by element, and working arrays of the sort, kept so that no step allocates.
#[derive(Clone, Debug, Default)]
pub struct Order {
    /// Rank of the first particle of each element and field, and one past the last.
    first: Vec<u32>,
    fields: usize,
    /// The element under which each particle lies: the one in which it was when they were put in order.
    pub filed: Column<u32>,
    /// Place of each particle by rank.
    places: Vec<u32>,
    /// Where each particle went in the last sort: new place by old place.
    pub destination: Vec<u32>,
    /// The reverse.
    source: Vec<u32>,
    /// Where the working columns of each particle were.
    working_source: Vec<u32>,
    numbers: Column<f64>,
    indices: Column<u32>,
    bodies: Column<u16>,
}

impl Order {
    /// Particles of one field, wherever they are.
    pub fn of(elements: &[u32], count: usize) -> Order {
        let mut order = Order::default();
        order.rank(elements, count, 1, |_| 0);
        order
    }

    /// Ranks particles anew; they stay where they are.
    pub fn find(&mut self, particles: &Particles, elements: usize, fields: &Fields) {
        let field = |p: usize| fields.of(particles.body[p]);
        self.rank(&particles.element, elements, fields.count(), field);
    }

    fn rank(
        &mut self,
        element: &[u32],
        count: usize,
        fields: usize,
        field: impl Fn(usize) -> usize,
    ) {
        let keys = count * fields;
        let key = |p: usize| element[p] as usize * fields + field(p);
        self.fields = fields;
        self.first.clear();
        self.first.resize(keys + 1, 0);
        for p in 0..element.len() {
            self.first[key(p) + 1] += 1;
        }
        for k in 0..keys {
            self.first[k + 1] += self.first[k];
        }
        for numbers in [&mut self.places, &mut self.source, &mut self.destination] {
            numbers.resize(element.len(), 0);
        }
        for p in 0..element.len() {
            let next = &mut self.first[key(p)];
            self.places[*next as usize] = p as u32;
            *next += 1;
        }
        // Each has moved on to the next key's; move them back.
        self.first.copy_within(0..keys, 1);
        self.first[0] = 0;
    }

    /// Ranks of the particles of an element.
    pub fn ranks(&self, e: usize) -> Range<usize> {
        self.first[e * self.fields] as usize..self.first[(e + 1) * self.fields] as usize
    }

    /// Fields that have particles in an element, and the ranks of each.
    pub fn runs(&self, e: usize) -> impl Iterator<Item = (usize, Range<usize>)> {
        let first = &self.first[e * self.fields..=(e + 1) * self.fields];
        let runs = first.windows(2).enumerate().filter(|(_, w)| w[0] < w[1]);
        runs.map(|(field, w)| (field, w[0] as usize..w[1] as usize))
    }

    /// Places of the particles in an element.
    pub fn inside(&self, e: usize) -> &[u32] {
        &self.places[self.ranks(e)]
    }

    /// Places of the particles of these ranks.
    pub fn places(&self, ranks: Range<usize>) -> &[u32] {
        &self.places[ranks]
    }

    /// Number of particles.
    pub fn count(&self) -> usize {
        self.places.len()
    }

    /// The particle of this rank is to have this place.
    pub(crate) fn put(&mut self, rank: u32, place: u32) {
        let p = std::mem::replace(&mut self.places[rank as usize], place);
        self.source[place as usize] = p;
        self.destination[p as usize] = place;
    }

    /// All particles have been given places. The working columns of those that are `away` are somewhere else: their
    /// places and these.
    pub(crate) fn begin_to_move(&mut self, away: impl Iterator<Item = (usize, usize)>) {
        self.working_source.clone_from(&self.source);
        for (home, place) in away {
            self.working_source[self.destination[home] as usize] = place as u32;
        }
    }

    /// Moves all particles to the places that they have been given.
    pub(crate) fn settle(&mut self, particles: &mut Particles) {
        for column in particles.working_columns_mut() {
            permute(&self.working_source, column, &mut self.numbers);
        }
        let from = &self.source;
        for column in particles.other_columns_mut() {
            permute(from, column, &mut self.numbers);
        }
        permute(from, &mut particles.id, &mut self.indices);
        permute(from, &mut particles.element, &mut self.indices);
        permute(from, &mut particles.body, &mut self.bodies);
        self.filed.clone_from(&particles.element);
    }
}

/// Particles from one that is moved to that which should be on its way from memory.
const MOVES_AHEAD: usize = 128;
/// Particles that one thread moves at a time.
const BLOCK: usize = 4096;

fn permute<T: Copy + Default + Send + Sync>(
    source: &[u32],
    values: &mut Column<T>,
    spare: &mut Column<T>,
) {
    spare.reserve_exact(values.capacity().saturating_sub(spare.len()));
    spare.resize(source.len(), T::default());
    fold((source, &mut spare[..]), BLOCK, &|(source, spare): (
        &[u32],
        &mut [T],
    )| {
        // Most come from places that follow each other, as do those of a line of the cache.
        let later = source.iter().skip(MOVES_AHEAD).step_by(LANES);
        let later = later.copied().chain(std::iter::repeat(0));
        for ((new, from), later) in spare.chunks_mut(LANES).zip(source.chunks(LANES)).zip(later) {
            prefetch_number(values, later as usize);
            for (new, &from) in new.iter_mut().zip(from) {
                *new = values[from as usize];
            }
        }
    });
    std::mem::swap(values, spare);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particles_are_found_by_element_and_field() {
        let (element, field) = ([2, 0, 2, 2, 0, 3], [1, 0, 0, 1, 0, 1]);
        let mut order = Order::default();
        order.rank(&element, 5, 2, |p| field[p]);
        assert_eq!(order.inside(0), [1, 4]);
        assert_eq!(order.inside(2), [2, 0, 3]);
        assert!(order.inside(1).is_empty() && order.inside(4).is_empty());
        assert_eq!(order.runs(2).collect::<Vec<_>>(), [(0, 2..3), (1, 3..5)]);
        assert_eq!(order.runs(3).collect::<Vec<_>>(), [(1, 5..6)]);
    }
}
