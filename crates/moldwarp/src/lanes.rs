//! Particles side by side: how the step uses the processor's vector instructions.
//!
//! A tile is up to [`LANES`] neighbouring cells, one a lane; slot k of it are their k-th particles. A
//! cell with many particles has several lanes. Those
//! with most particles come first, so that the lanes of a slot are the first ones of the tile. What is kept
//! per cell, and the particles of a slot, lie side by side in memory. The loop over the lanes is plain scalar
//! code, which the compiler turns into vector instructions. Each lane's arithmetic is that of the scalar code,
//! operation for operation, and sums over lanes are made in the lanes' order, so that results have the same
//! bits with any instruction set.

mod exp;
mod simd;
mod tiles;

pub use exp::exp;
pub use simd::Simd;
pub(crate) use simd::for_each_simd;
pub use tiles::{ByTile, Contents, Pile, Tiles};

use crate::parallel::Split;
use std::ops::{Deref, DerefMut};

/// Lanes of a tile: as many as the widest instructions take at a time.
pub const LANES: usize = 8;

/// A number for each lane. (Aligned: vectors that lie across two lines of the cache take several times as long.)
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lane([f64; LANES]);

impl Lane {
    /// The same number for all.
    pub const fn of(number: f64) -> Lane {
        Lane([number; LANES])
    }
}

impl Deref for Lane {
    type Target = [f64; LANES];

    #[inline(always)]
    fn deref(&self) -> &[f64; LANES] {
        &self.0
    }
}

impl DerefMut for Lane {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64; LANES] {
        &mut self.0
    }
}

impl From<[f64; LANES]> for Lane {
    fn from(numbers: [f64; LANES]) -> Lane {
        Lane(numbers)
    }
}

impl Default for Lane {
    fn default() -> Lane {
        Lane::of(0.0)
    }
}

/// A symmetric tensor for each lane, component by component.
pub type VoigtLanes = [Lane; 6];

/// Tile and lane of a cell.
#[inline(always)]
pub fn lane_of(cell: usize) -> (usize, usize) {
    (cell / LANES, cell % LANES)
}

/// Copies the numbers of particles from `start` on to lanes: as many as there are lanes or particles.
#[inline(always)]
pub fn load<const N: usize>(lanes: &mut [Lane; N], columns: &[&[f64]; N], start: usize) {
    for k in 0..N {
        load_one(&mut lanes[k], columns[k], start);
    }
}

#[inline(always)]
pub fn load_one(lane: &mut Lane, column: &[f64], start: usize) {
    let from = &column[start..];
    match from.first_chunk::<LANES>() {
        Some(all) => **lane = *all,
        None => load_last(lane, from),
    }
}

/// Apart, or both copies would become one by a call of the library's, which takes longer than to copy.
#[cold]
#[inline(never)]
fn load_last(lane: &mut Lane, from: &[f64]) {
    lane[..from.len()].copy_from_slice(from);
}

/// Particles from the start of a slot to those that should be on their way from memory: the first cache has no room for
/// more, so they come to the second.
pub const AHEAD: usize = 72;

/// Tiles from one to that whose record should be on its way to the first cache.
pub const RECORDS_AHEAD: usize = 3;

/// The same where there are few bytes a tile: a line of the cache has those of several.
pub const NUMBERS_AHEAD: usize = 16;

/// Has the numbers of the particles of a slot fetched from memory, to be near when it is their turn.
#[inline(always)]
pub fn prefetch<const N: usize>(columns: &[&[f64]; N], start: usize) {
    for column in columns {
        prefetch_line(column.as_ptr().wrapping_add(start), false);
    }
}

/// To the first cache if `near`, else to the second.
#[inline(always)]
fn prefetch_line<T>(place: *const T, near: bool) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _MM_HINT_T1, _mm_prefetch};
        // SAFETY: a hint may have any address.
        unsafe {
            match near {
                true => _mm_prefetch::<_MM_HINT_T0>(place.cast()),
                false => _mm_prefetch::<_MM_HINT_T1>(place.cast()),
            }
        };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (place, near);
}

/// The same for the record of a tile, if there is one.
#[inline(always)]
pub fn prefetch_record<T>(records: &[T], place: usize) {
    if let Some(record) = records.get(place) {
        prefetch_lines(record, 0, 0..size_of::<T>() / 64);
    }
}

/// The same for lines of a record that comes so many after this one, if there is one.
#[inline(always)]
pub fn prefetch_lines<T>(record: &T, ahead: usize, lines: std::ops::Range<usize>) {
    let first = std::ptr::from_ref(record).wrapping_add(ahead);
    for line in lines {
        prefetch_line(first.cast::<[f64; 8]>().wrapping_add(line), true);
    }
}

/// The same for a number or few of them, that lie one after another.
#[inline(always)]
pub fn prefetch_number<T>(numbers: &[T], place: usize) {
    prefetch_line(numbers.as_ptr().wrapping_add(place), true);
}

/// The same for their bodies.
#[inline(always)]
pub fn prefetch_bodies(bodies: &[u16], start: usize) {
    prefetch_line(bodies.as_ptr().wrapping_add(start), false);
}

/// Numbers of particles, one array a component, all of the same length.
pub struct Columns<'a, const N: usize>([&'a mut [f64]; N]);

impl<'a, const N: usize> Columns<'a, N> {
    pub fn new(columns: [&'a mut [f64]; N]) -> Columns<'a, N> {
        assert!(
            columns
                .iter()
                .all(|column| column.len() == columns[0].len())
        );
        Columns(columns)
    }

    fn len(&self) -> usize {
        self.0[0].len()
    }

    /// The numbers of a particle.
    #[inline]
    pub fn at(&self, place: usize) -> [f64; N] {
        std::array::from_fn(|k| self.0[k][place])
    }

    /// Whether there are as many particles from `start` on as lanes.
    #[inline(always)]
    pub fn has_all(&self, start: usize) -> bool {
        self.len() >= LANES && start <= self.len() - LANES
    }

    /// The numbers of as many particles from `start` on as there are lanes.
    #[inline(always)]
    pub fn all(&self, start: usize) -> [Lane; N] {
        assert!(self.has_all(start));
        let mut lanes = [Lane::of(0.0); N];
        for k in 0..N {
            lanes[k] = self.one(k, start);
        }
        lanes
    }

    /// One number of each of them.
    #[inline(always)]
    pub fn one(&self, k: usize, start: usize) -> Lane {
        assert!(self.has_all(start));
        // SAFETY: all columns have the length that has been looked at.
        Lane::from(unsafe { *self.0[k].as_ptr().add(start).cast::<[f64; LANES]>() })
    }

    /// Copies the numbers of particles from `start` on to lanes: as many as there are lanes or particles.
    #[inline(always)]
    pub fn load(&self, lanes: &mut [Lane; N], start: usize) {
        if self.len() < LANES || start > self.len() - LANES {
            return self.load_last(lanes, start);
        }
        for (lane, column) in lanes.iter_mut().zip(&self.0) {
            // SAFETY: all columns have the length that has been looked at.
            **lane = unsafe { *column.as_ptr().add(start).cast() };
        }
    }

    #[cold]
    #[inline(never)]
    fn load_last(&self, lanes: &mut [Lane; N], start: usize) {
        for (lane, column) in lanes.iter_mut().zip(&self.0) {
            load_last(lane, &column[start..]);
        }
    }

    /// Has the numbers of particles fetched from memory, to be near when it is their turn.
    #[inline(always)]
    pub fn prefetch(&self, start: usize) {
        self.prefetch_some(0..N, start);
    }

    /// The same for some of their numbers.
    #[inline(always)]
    pub fn prefetch_some(&self, numbers: std::ops::Range<usize>, start: usize) {
        for column in &self.0[numbers] {
            prefetch_line(column.as_ptr().wrapping_add(start), false);
        }
    }

    /// Copies the first numbers of lanes to particles that are there, in a kernel.
    #[inline(always)]
    pub fn put<S: crate::step::Instructions>(
        &mut self,
        lanes: &[Lane; N],
        start: usize,
        count: usize,
    ) {
        assert!(count <= LANES && start <= self.len() && count <= self.len() - start);
        for k in 0..N {
            // SAFETY: as has been looked at.
            unsafe { S::store(self.0[k].as_mut_ptr().add(start), lanes[k], count) };
        }
    }

    /// Copies the first numbers of lanes to the particles from `start` on.
    #[inline(never)]
    pub fn store(&mut self, simd: Simd, lanes: &[Lane; N], start: usize, count: usize) {
        assert!(count <= LANES && start <= self.len() && count <= self.len() - start);
        #[cfg(target_arch = "x86_64")]
        if simd.has_avx512() {
            // The library's copy of so few numbers takes longer to be called than to copy.
            return self.put::<crate::step::Avx512>(lanes, start, count);
        }
        let _ = simd;
        for (lane, column) in lanes.iter().zip(&mut self.0) {
            let to = &mut column[start..start + count];
            match to.first_chunk_mut::<LANES>() {
                Some(all) => *all = **lane,
                None => to.copy_from_slice(&lane[..count]),
            }
        }
    }
}

impl<const N: usize> Split for Columns<'_, N> {
    fn count(&self) -> usize {
        self.len()
    }
    fn split(self, at: usize) -> (Self, Self) {
        let (low, high) = self.0.split(at);
        (Columns(low), Columns(high))
    }
}

/// Greater than zero in lanes that hold a particle, 0 in the rest of them.
pub type Held = Lane;

/// The first lanes hold one. (Numbers to compare with, since compilers make little of numbers of lanes.)
#[inline]
pub fn held(count: usize) -> &'static Held {
    &HELD[count]
}

static HELD: [Held; LANES + 1] = {
    let mut held = [Lane::of(0.0); LANES + 1];
    let mut count = 0;
    while count <= LANES {
        let mut l = 0;
        while l < count {
            held[count].0[l] = 1.0;
            l += 1;
        }
        count += 1;
    }
    held
};

/// Has zero in lanes that hold nothing. (As what is new: part of a lane that is written has to get to the cache before all
/// of it can be read, which takes twice as long.)
#[inline(always)]
pub fn only(held: &Held, lane: &Lane) -> Lane {
    let mut only = Lane::of(0.0);
    for l in 0..LANES {
        only[l] = either(held[l] > 0.0, lane[l], 0.0);
    }
    only
}

/// The number of each component in a lane.
#[inline(always)]
pub fn get<const N: usize>(lanes: &[Lane; N], l: usize) -> [f64; N] {
    std::array::from_fn(|k| lanes[k][l])
}

/// The reverse of [`get`].
#[inline(always)]
pub fn set<const N: usize>(lanes: &mut [Lane; N], l: usize, values: [f64; N]) {
    for k in 0..N {
        lanes[k][l] = values[k];
    }
}

/// `a` if the condition holds, else `b`. Unlike an `if`, it never becomes a jump, which would keep a loop
/// over lanes scalar.
#[inline(always)]
pub fn either<T>(condition: bool, a: T, b: T) -> T {
    std::hint::select_unpredictable(condition, a, b)
}

/// The larger number. Unlike the library's, which minds what is not a number, one instruction.
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    either(b > a, b, a)
}

/// The smaller number, the same way.
#[inline(always)]
pub fn smaller(a: f64, b: f64) -> f64 {
    either(b < a, b, a)
}

/// Whether all are the same. (Without leaving early, as in [`any`]: that keeps a loop scalar.)
#[inline(always)]
pub fn alike(bodies: &[u16]) -> bool {
    let first = bodies[0];
    bodies.iter().fold(true, |all, &body| all & (body == first))
}

/// Whether any is greater than zero.
#[inline(always)]
pub fn any(numbers: &[f64]) -> bool {
    numbers.iter().fold(false, |any, &x| any | (x > 0.0))
}

/// Σ over the lanes, in their order.
pub fn sum(lanes: &Lane) -> f64 {
    lanes.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_go_to_lanes_and_back() {
        let numbers: Vec<f64> = (0..50).map(f64::from).collect();
        let mut lane = Lane::of(0.0);
        load_one(&mut lane, &numbers, 45);
        assert_eq!(lane[..5], numbers[45..]);
        load_one(&mut lane, &numbers, 30);
        assert_eq!(lane[..], numbers[30..38]);
        for length in [9, 50] {
            for simd in Simd::NAMES.iter().filter_map(|name| Simd::named(name)) {
                let (mut to, mut other) = (vec![0.0; length], numbers[..length].to_vec());
                let mut columns = Columns::new([&mut to[..], &mut other]);
                columns.store(simd, &[lane, lane], 3, 5);
                let mut back = [Lane::of(0.0); 2];
                columns.load(&mut back, 1);
                columns.load(&mut back, 2);
                for k in 0..2 {
                    assert_eq!(back[k][..6], [&[numbers[2 * k]], &lane[..5]].concat());
                }
                assert_eq!((to[8], other[8]), (0.0, 8.0));
            }
        }
    }
}
