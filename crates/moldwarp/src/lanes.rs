//! Particles side by side: how the step uses the processor's vector instructions.
//!
//! A tile is up to [`LANES`] neighbouring cells, one a lane; slot k of it are their k-th particles. A
//! cell with many particles has several lanes. Those
//! with most particles come first, so that the lanes of a slot are the first ones of the tile. What is kept
//! per cell, and the particles of a slot, lie side by side in memory. The loop over the lanes is plain scalar
//! code, which the compiler turns into vector instructions. Each lane's arithmetic is that of the scalar code,
//! operation for operation, and sums over lanes are made in the lanes' order, so that results have the same
//! bits with any instruction set.

mod tiles;

pub use tiles::{ByTile, Contents, Pile, Tiles};

use std::ops::{Deref, DerefMut};

/// Lanes of a window.
pub const LANES: usize = 32;

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

/// Instructions to compute with. Results are the same with all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Simd(Level);

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd)]
enum Level {
    Scalar,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Default for Simd {
    fn default() -> Simd {
        Simd::best()
    }
}

impl Simd {
    /// Names, as `--simd` takes them.
    pub const NAMES: [&'static str; 3] = ["scalar", "avx2", "avx512"];

    /// The widest that this processor has.
    pub fn best() -> Simd {
        let named = Simd::NAMES.iter().rev().find_map(|name| Simd::named(name));
        named.unwrap_or(Simd(Level::Scalar))
    }

    /// By its name, if this processor has it.
    pub fn named(name: &str) -> Option<Simd> {
        match name {
            "scalar" => Some(Simd(Level::Scalar)),
            #[cfg(target_arch = "x86_64")]
            "avx2" => std::is_x86_feature_detected!("avx2").then_some(Simd(Level::Avx2)),
            #[cfg(target_arch = "x86_64")]
            "avx512" => (std::is_x86_feature_detected!("avx512f")
                && std::is_x86_feature_detected!("avx512dq")
                && std::is_x86_feature_detected!("avx512vl"))
            .then_some(Simd(Level::Avx512)),
            _ => None,
        }
    }

    #[cfg(target_arch = "x86_64")]
    pub(crate) fn has_avx512(self) -> bool {
        self.0 == Level::Avx512
    }

    #[cfg(target_arch = "x86_64")]
    pub(crate) fn has_avx2(self) -> bool {
        self.0 >= Level::Avx2
    }
}

/// Compiles a function once for each instruction set, and calls the one that its first argument asks for.
/// What it calls must be inlined, else it is compiled for the least processor.
macro_rules! for_each_simd {
    ($(#[$doc:meta])* $vis:vis fn $name:ident($($arg:ident: $type:ty),* $(,)?) $body:block) => {
        $(#[$doc])*
        #[allow(clippy::too_many_arguments)]
        $vis fn $name(simd: $crate::lanes::Simd, $($arg: $type),*) {
            #[inline(always)]
            #[allow(clippy::too_many_arguments)]
            fn plain($($arg: $type),*) $body
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                #[allow(clippy::too_many_arguments)]
                fn avx2($($arg: $type),*) {
                    plain($($arg),*);
                }
                #[target_feature(enable = "avx512f,avx512dq,avx512vl")]
                #[allow(clippy::too_many_arguments)]
                fn avx512($($arg: $type),*) {
                    plain($($arg),*);
                }
                if simd.has_avx512() {
                    // SAFETY: `Simd` is made only where the processor has it.
                    return unsafe { avx512($($arg),*) };
                }
                if simd.has_avx2() {
                    // SAFETY: as above.
                    return unsafe { avx2($($arg),*) };
                }
            }
            let _ = simd;
            plain($($arg),*);
        }
    };
}
pub(crate) use for_each_simd;

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
#[expect(clippy::manual_memcpy)] // as said inside
pub fn load_one(lane: &mut Lane, column: &[f64], start: usize) {
    let from = &column[start..];
    match from.first_chunk::<LANES>() {
        // Vector by vector: the library's copy takes longer to be called than to copy.
        Some(all) => {
            let (from, to) = (all.as_chunks::<8>().0, lane.as_chunks_mut::<8>().0);
            for k in 0..LANES / 8 {
                to[k] = from[k];
            }
        }
        None => lane[..from.len()].copy_from_slice(from),
    }
}

/// Particles from the end of a slot to those that should be on their way from memory: the first cache has no room for more
/// than the slot's own, so they come to the second.
pub const AHEAD: usize = 2 * LANES;

/// Has the numbers of the particles of a slot fetched from memory, to be near when it is their turn.
#[inline(always)]
pub fn prefetch<const N: usize>(columns: &[&[f64]; N], start: usize) {
    for column in columns {
        for line in 0..LANES / 8 {
            prefetch_line(column.as_ptr().wrapping_add(start + 8 * line));
        }
    }
}

#[inline(always)]
fn prefetch_line<T>(place: *const T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        // SAFETY: a hint may have any address.
        unsafe { _mm_prefetch::<_MM_HINT_T1>(place.cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = place;
}

/// The same for their bodies.
#[inline(always)]
pub fn prefetch_bodies(bodies: &[u16], start: usize) {
    prefetch_line(bodies.as_ptr().wrapping_add(start));
}

/// Copies the first numbers of lanes to the particles from `start` on.
#[inline(always)]
pub fn store<const N: usize>(
    lanes: &[Lane; N],
    columns: &mut [&mut [f64]; N],
    start: usize,
    count: usize,
) {
    for k in 0..N {
        store_one(&lanes[k], columns[k], start, count);
    }
}

#[inline(always)]
pub fn store_one(lane: &Lane, column: &mut [f64], start: usize, count: usize) {
    let (groups, rest) = column[start..start + count].as_chunks_mut::<8>();
    let (from, _) = lane.as_chunks::<8>();
    let whole = groups.len();
    for (to, from) in groups.iter_mut().zip(from) {
        *to = *from;
    }
    if !rest.is_empty() {
        rest.copy_from_slice(&from[whole][..rest.len()]);
    }
}

/// Lanes that a loop works on to have so many: vector instructions do eight at a time, and what is left over
/// would be done one by one. What the additional ones hold is a number from before, and goes nowhere.
#[inline(always)]
pub fn whole(lanes: usize) -> usize {
    // Written so that the compiler sees that it is a multiple of eight and no more than there are.
    lanes.div_ceil(8).min(LANES / 8) * 8
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
    #[cfg(target_arch = "x86_64")]
    fn the_widest_have_what_the_narrower_have() {
        assert!(Simd(Level::Avx512).has_avx2() && !Simd(Level::Scalar).has_avx2());
    }

    #[test]
    fn numbers_go_to_lanes_and_back() {
        let numbers: Vec<f64> = (0..50).map(f64::from).collect();
        let mut lane = Lane::of(0.0);
        load_one(&mut lane, &numbers, 30);
        assert_eq!(lane[..20], numbers[30..]);
        let mut to = vec![0.0; 50];
        store_one(&lane, &mut to, 3, 19);
        assert_eq!((to[2], &to[3..22], to[22]), (0.0, &numbers[30..49], 0.0));
    }
}
