//! Keeping particles ordered by element, and within it by velocity field.

use super::Particles;
use crate::Vec3;
use crate::contact::Fields;
use crate::material::State;
use crate::tensor::Voigt;

/// Working arrays of the sort, kept so that no step allocates.
#[derive(Clone, Debug, Default)]
pub struct Order {
    /// Number of the first particle of each element, and one past the last.
    pub offsets: Vec<u32>,
    /// Where each particle went in the last sort: new place by old place.
    pub destination: Vec<u32>,
    vectors: Vec<Vec3>,
    stresses: Vec<Voigt>,
    states: Vec<State>,
    numbers: Vec<f64>,
    indices: Vec<u32>,
    bodies: Vec<u16>,
}

impl Order {
    /// Sorts by element and field, keeping the order within each (a counting sort).
    pub fn sort(&mut self, particles: &mut Particles, elements: usize, fields: &Fields) {
        let key = |e: u32, body: u16| e as usize * fields.count() + fields.of(body);
        let keys = elements * fields.count();
        let by_place = || particles.element.iter().zip(&particles.body);
        self.offsets.clear();
        self.offsets.resize(keys + 1, 0);
        for (&e, &body) in by_place() {
            self.offsets[key(e, body) + 1] += 1;
        }
        for k in 0..keys {
            self.offsets[k + 1] += self.offsets[k];
        }
        self.destination.resize(particles.len(), 0);
        for (p, (&e, &body)) in by_place().enumerate() {
            let next = &mut self.offsets[key(e, body)];
            self.destination[p] = *next;
            *next += 1;
        }
        // Each offset has moved on to the next key's; the last one of an element is now where the
        // next element begins.
        if fields.count() == 1 {
            self.offsets.copy_within(0..elements, 1);
        } else {
            for e in 0..elements {
                self.offsets[e + 1] = self.offsets[(e + 1) * fields.count() - 1];
            }
        }
        self.offsets.truncate(elements + 1);
        self.offsets[0] = 0;
        let to = &self.destination;
        permute(to, &mut particles.id, &mut self.indices);
        permute(to, &mut particles.element, &mut self.indices);
        permute(to, &mut particles.body, &mut self.bodies);
        permute(to, &mut particles.position, &mut self.vectors);
        permute(to, &mut particles.velocity, &mut self.vectors);
        permute(to, &mut particles.displacement, &mut self.vectors);
        permute(to, &mut particles.stress, &mut self.stresses);
        permute(to, &mut particles.state, &mut self.states);
        permute(to, &mut particles.volume, &mut self.numbers);
        permute(to, &mut particles.initial_volume, &mut self.numbers);
        permute(to, &mut particles.mass, &mut self.numbers);
    }
}

fn permute<T: Copy + Default>(destination: &[u32], values: &mut Vec<T>, spare: &mut Vec<T>) {
    spare.resize(values.len(), T::default());
    for (&to, &value) in destination.iter().zip(values.iter()) {
        spare[to as usize] = value;
    }
    std::mem::swap(values, spare);
}
