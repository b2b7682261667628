//! Particles that leave their elements in a drift and are to be guests where they come to (`guests.rs`).
//!
//! The pass over particles puts down all that they have while it is at hand: to fetch it again, number by number from
//! memory, takes longer than to move a particle. What elements they have come to is found after the pass, of many of them
//! side by side: each waits for the mesh's memory.

use super::Active;
use super::motion::{Crossing, Search};
use crate::Vec3;
use crate::lanes::prefetch_number;
use crate::mesh::NONE;
use crate::parallel::fold;
use crate::particles::WORKING;
use std::sync::Mutex;

/// Leavers that one thread walks to their elements at a time.
const TOGETHER: usize = 32;
/// Leavers that a thread keeps to itself: to share each would take as long as to put it down.
const HANDFUL: usize = 16;

/// A particle that leaves its element.
#[derive(Clone, Copy, Debug, Default)]
pub struct Leaver {
    pub place: u32,
    /// The cell whose element it leaves.
    pub cell: u32,
    /// The element that it has come to, when that has been found.
    pub element: u32,
    /// Its N_i in the element that it leaves.
    pub shapes: [f64; 4],
    /// The numbers that a step changes, in the order of the working columns: it begins with the position.
    pub numbers: [f64; WORKING],
}

impl Leaver {
    fn position(&self) -> Vec3 {
        let [x, y, z] = *self
            .numbers
            .first_chunk()
            .expect("begins with the position");
        Vec3::new(x, y, z)
    }

    /// The element behind the face behind which it lies farthest, or [`NONE`].
    fn behind(&self, neighbours: &[[u32; 4]]) -> u32 {
        let farthest = (0..4).min_by(|&a, &b| self.shapes[a].total_cmp(&self.shapes[b]));
        neighbours[self.element as usize][farthest.expect("one of four")]
    }
}

/// Leavers that one thread has put down, before they come to those of all threads.
pub struct Handful<'a> {
    all: &'a Mutex<&'a mut Vec<Leaver>>,
    some: [Leaver; HANDFUL],
    count: usize,
}

impl<'a> Handful<'a> {
    pub fn new(all: &'a Mutex<&'a mut Vec<Leaver>>) -> Handful<'a> {
        Handful {
            all,
            some: [Leaver::default(); HANDFUL],
            count: 0,
        }
    }

    pub fn put(&mut self, leaver: Leaver) {
        self.some[self.count] = leaver;
        self.count += 1;
        if self.count == HANDFUL {
            self.hand_over();
        }
    }

    fn hand_over(&mut self) {
        let mut all = self.all.lock().expect("no other thread panicked");
        all.extend_from_slice(&self.some[..self.count]);
        self.count = 0;
    }
}

impl Drop for Handful<'_> {
    fn drop(&mut self) {
        if self.count > 0 {
            self.hand_over();
        }
    }
}

/// Finds the elements that leavers have come to.
pub(super) fn locate(leavers: &mut [Leaver], active: &Active, search: &Search) -> Crossing {
    let mesh = search.mesh;
    fold(leavers, TOGETHER, &|leavers: &mut [Leaver]| {
        for leaver in &*leavers {
            prefetch_number(&active.elements, leaver.cell as usize);
        }
        for leaver in &mut *leavers {
            leaver.element = active.elements[leaver.cell as usize];
            prefetch_number(&mesh.neighbours, leaver.element as usize);
            prefetch_number(search.body, leaver.place as usize);
        }
        let behind = |leaver: &Leaver| leaver.behind(&mesh.neighbours);
        for next in leavers.iter().map(behind).filter(|&next| next != NONE) {
            prefetch_number(&mesh.tets, next as usize);
            prefetch_number(&mesh.neighbours, next as usize);
        }
        for next in leavers.iter().map(behind).filter(|&next| next != NONE) {
            for n in mesh.tets[next as usize] {
                prefetch_number(&mesh.nodes, n as usize);
            }
        }
        let mut crossing = Crossing::default();
        for leaver in leavers {
            let (place, x) = (leaver.place as usize, leaver.position());
            if !search.walk(place, leaver.shapes, x, &mut leaver.element, &mut crossing) {
                // Back again by round-off: the cell has its sums from it as a guest, too.
                crossing.crossed.note(place);
            }
        }
        crossing
    })
}
