//! Particles that leave their elements in a drift and are to be guests where they come to (`guests.rs`).
//!
//! The pass over particles puts down all that they have while it is at hand: to fetch it again, number by number from
//! memory, takes longer than to move a particle. What elements they have come to is found after the pass, of many of them
//! side by side: each waits for the mesh's memory.

use super::motion::{Crossing, Search};
use crate::Vec3;
use crate::lanes::prefetch_number;
use crate::mesh::NONE;
use crate::parallel::fold;
use crate::particles::WORKING;
use std::sync::Mutex;

/// Leavers that one thread walks to their elements at a time.
const TOGETHER: usize = 32;

/// A particle that leaves its element.
#[derive(Clone, Copy, Debug)]
pub struct Leaver {
    /// Its place, and the element that it leaves or, when that has been found, is in.
    pub place: u32,
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

/// Where threads put down leavers, up to so many.
pub struct Gathering<'a> {
    leavers: Mutex<&'a mut Vec<Leaver>>,
    most: usize,
}

impl<'a> Gathering<'a> {
    pub fn new(leavers: &'a mut Vec<Leaver>, most: usize) -> Gathering<'a> {
        leavers.clear();
        let leavers = Mutex::new(leavers);
        Gathering { leavers, most }
    }

    /// False if there are so many already.
    pub fn put(&self, leaver: impl FnOnce() -> Leaver) -> bool {
        let mut leavers = self.leavers.lock().expect("no other thread panicked");
        let few = leavers.len() < self.most;
        if few {
            leavers.push(leaver());
        }
        few
    }
}

/// Finds the elements that leavers have come to.
pub(super) fn locate(leavers: &mut [Leaver], search: &Search) -> Crossing {
    let mesh = search.mesh;
    fold(leavers, TOGETHER, &|leavers: &mut [Leaver]| {
        for leaver in &*leavers {
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
