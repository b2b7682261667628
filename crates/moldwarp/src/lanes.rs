//! Particles side by side: how the step uses the processor's vector instructions.
//!
//! A tile is up to [`LANES`] neighbouring cells, one a lane; slot k of it are their k-th particles. A
//! cell with many particles has several lanes. Those
//! with most particles come first, so that the lanes of a slot are the first ones of the tile. What is kept
//! per cell, and the particles of a slot, lie side by side in memory. The loop over the lanes is plain scalar
//! code, which the compiler turns into vector instructions. Each lane's arithmetic is that of the scalar code,
//! operation for operation, and sums over lanes are made in the lanes' order, so that results have the same
//! bits with any instruction set.

use crate::parallel::Split;
use std::cmp::Reverse;
use std::ops::{Deref, DerefMut, Range};

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
        self.0 == Level::Avx2
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

/// How cells and particles lie in memory: tile after tile, of its cells one a lane, of its particles slot
/// after slot, in each lane after lane.
///
/// What is kept per cell is kept as one record a tile of one number a lane; cell c is lane c mod [`LANES`]
/// of tile c / [`LANES`].
#[derive(Clone, Debug, Default)]
pub struct Tiles {
    tiles: Vec<Tile>,
    /// Place of the first particle of each slot, and one past the last.
    slots: Vec<u32>,
    /// Lanes that help another one of their tile, as its cell has many particles.
    helpers: Vec<Helper>,
}

#[derive(Clone, Copy, Debug)]
struct Tile {
    first_slot: u32,
    first_helper: u32,
}

/// A lane that adds to another one of the same cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Helper {
    pub lane: u8,
    pub of: u8,
}

/// Neighbouring cells that tiles are made of.
const WINDOW: usize = 128;

/// Most particles of a lane, unless their cell would take more than a tile.
const DEEP: u32 = 8;

/// Particles of a cell, by rank.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pile {
    /// Number of the cell in the order in which cells are given.
    pub cell: u32,
    pub first: u32,
    /// From one to the next: a cell's particles go round its lanes, so that ranks and places have the same
    /// order, and an order that is found anew is the same.
    pub stride: u32,
    pub count: u32,
    /// Whether it is a helper's.
    pub more: bool,
}

/// Cells with their numbers, in windows those with most particles first: tiles of cells with as many particles have
/// hardly an empty lane.
fn alike_together(
    cells: impl Iterator<Item = (u32, u32)>,
) -> impl Iterator<Item = (usize, u32, u32)> {
    let mut cells = cells
        .enumerate()
        .map(|(cell, (first, count))| (cell, first, count));
    let (mut window, mut next, mut filled) = ([(0, 0, 0); WINDOW], 0, 0);
    std::iter::from_fn(move || {
        if next == filled {
            (next, filled) = (0, 0);
            for (place, cell) in window.iter_mut().zip(&mut cells) {
                *place = cell;
                filled += 1;
            }
            window[..filled].sort_unstable_by_key(|&(cell, _, count)| (Reverse(count), cell));
        }
        (next < filled).then(|| {
            next += 1;
            window[next - 1]
        })
    })
}

impl Tiles {
    /// Lays out cells, given by their particles. `lane` is told the lanes one after another, none for those
    /// that stay empty, `put` the place of each rank.
    pub(crate) fn rebuild(
        &mut self,
        cells: impl Iterator<Item = (u32, u32)>,
        lane: impl FnMut(Option<Pile>),
        put: impl FnMut(u32, u32),
    ) {
        self.tiles.clear();
        self.slots.clear();
        self.helpers.clear();
        self.append(0, cells, lane, put);
    }

    /// Puts others in the place of all tiles but the first ones.
    pub(crate) fn replace(
        &mut self,
        keep: usize,
        cells: impl Iterator<Item = (u32, u32)>,
        lane: impl FnMut(Option<Pile>),
        put: impl FnMut(u32, u32),
    ) {
        let end = self.tiles[keep];
        let place = self.slots[end.first_slot as usize];
        self.tiles.truncate(keep);
        self.slots.truncate(end.first_slot as usize);
        self.helpers.truncate(end.first_helper as usize);
        self.append(place, cells, lane, put);
    }

    fn append(
        &mut self,
        mut place: u32,
        cells: impl Iterator<Item = (u32, u32)>,
        mut lane: impl FnMut(Option<Pile>),
        mut put: impl FnMut(u32, u32),
    ) {
        let (mut piles, mut lanes) = ([Pile::default(); LANES], 0);
        for (cell, first, count) in alike_together(cells) {
            let deep = DEEP.max(count.div_ceil(LANES as u32));
            let wanted = count.div_ceil(deep).max(1) as usize;
            if lanes + wanted > LANES {
                self.push(&mut piles[..lanes], &mut place, &mut lane, &mut put);
                lanes = 0;
            }
            let stride = wanted as u32;
            for k in 0..stride {
                piles[lanes] = Pile {
                    cell: cell as u32,
                    first: first + k,
                    stride,
                    count: (count + stride - 1 - k) / stride,
                    more: k > 0,
                };
                lanes += 1;
            }
        }
        if lanes > 0 {
            self.push(&mut piles[..lanes], &mut place, &mut lane, &mut put);
        }
        self.end_tiles();
        self.slots.push(place);
    }

    fn end_tiles(&mut self) {
        self.tiles.push(Tile {
            first_slot: self.slots.len() as u32,
            first_helper: self.helpers.len() as u32,
        });
    }

    fn push(
        &mut self,
        piles: &mut [Pile],
        place: &mut u32,
        lane: &mut impl FnMut(Option<Pile>),
        put: &mut impl FnMut(u32, u32),
    ) {
        // Those with most particles first, else as they come. (The library's sort allocates.)
        for i in 1..piles.len() {
            let mut k = i;
            while k > 0 && piles[k - 1].count < piles[k].count {
                piles.swap(k - 1, k);
                k -= 1;
            }
        }
        self.end_tiles();
        (0..LANES).for_each(|l| lane(piles.get(l).copied()));
        for (l, pile) in piles.iter().enumerate().filter(|p| p.1.more) {
            let own = |other: &Pile| other.cell == pile.cell && !other.more;
            let of = piles.iter().position(own);
            self.helpers.push(Helper {
                lane: l as u8,
                of: of.expect("a cell has a lane of its own") as u8,
            });
        }
        let deepest = piles.first().map_or(0, |pile| pile.count);
        for k in 0..deepest {
            self.slots.push(*place);
            for pile in piles.iter().take_while(|pile| pile.count > k) {
                put(pile.first + k * pile.stride, *place);
                *place += 1;
            }
        }
    }

    /// Room for more tiles.
    pub(crate) fn reserve(&mut self, tiles: usize) {
        self.tiles.reserve(tiles);
        self.slots.reserve(tiles * (DEEP as usize + 1));
        self.helpers.reserve(tiles);
    }

    /// Number of tiles.
    pub fn len(&self) -> usize {
        self.tiles.len() - 1
    }

    fn first_particle(&self, tile: usize) -> usize {
        self.slots[self.tiles[tile].first_slot as usize] as usize
    }
}

/// Tiles with their records, and with the parts of particle arrays that lie in them.
pub struct ByTile<'a, P, C> {
    tiles: &'a Tiles,
    range: Range<usize>,
    /// Arrays over the particles of the tiles.
    pub particles: P,
    /// Arrays over the tiles.
    pub cells: C,
}

impl<'a, P: Split, C: Split> ByTile<'a, P, C> {
    /// All tiles with arrays over all particles and records of all tiles.
    pub fn new(tiles: &'a Tiles, particles: P, cells: C) -> ByTile<'a, P, C> {
        ByTile {
            tiles,
            range: 0..tiles.len(),
            particles,
            cells,
        }
    }
}

impl<'a, P, C> ByTile<'a, P, C> {
    /// The first particle.
    pub fn first(&self) -> usize {
        self.tiles.first_particle(self.range.start)
    }

    /// Numbers of the tiles, each with what is in it.
    pub fn each(&self) -> impl Iterator<Item = (usize, Contents<'a>)> + use<'a, P, C> {
        let tiles = self.tiles;
        self.range.clone().map(move |number| {
            let [tile, next] = [&tiles.tiles[number], &tiles.tiles[number + 1]];
            let slots = tile.first_slot as usize..next.first_slot as usize + 1;
            let helpers = tile.first_helper as usize..next.first_helper as usize;
            let contents = Contents {
                slots: &tiles.slots[slots],
                helpers: &tiles.helpers[helpers],
            };
            (number, contents)
        })
    }
}

/// What is in a tile.
#[derive(Clone, Copy)]
pub struct Contents<'a> {
    slots: &'a [u32],
    /// Lanes whose sums belong to another lane.
    pub helpers: &'a [Helper],
}

impl<'a> Contents<'a> {
    /// Places of the particles in each slot, one a lane.
    pub fn slots(self) -> impl Iterator<Item = Range<usize>> + 'a {
        (self.slots.windows(2)).map(|w| w[0] as usize..w[1] as usize)
    }

    /// Adds the sums of helpers to those that they help.
    pub fn gather<'b>(self, sums: impl IntoIterator<Item = &'b mut Lane>) {
        if self.helpers.is_empty() {
            return;
        }
        for sum in sums {
            for helper in self.helpers {
                sum[usize::from(helper.of)] += sum[usize::from(helper.lane)];
                sum[usize::from(helper.lane)] = 0.0;
            }
        }
    }
}

impl<P: Split, C: Split> Split for ByTile<'_, P, C> {
    fn count(&self) -> usize {
        self.range.len()
    }
    fn split(self, at: usize) -> (Self, Self) {
        let first = self.first();
        let (low, high) = self.range.split(at);
        let tiles = self.tiles;
        let particles = self
            .particles
            .split(tiles.first_particle(high.start) - first);
        let cells = self.cells.split(at);
        let part = |range, particles, cells| ByTile {
            tiles,
            range,
            particles,
            cells,
        };
        (
            part(low, particles.0, cells.0),
            part(high, particles.1, cells.1),
        )
    }
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
        None => lane[..from.len()].copy_from_slice(from),
    }
}

/// Has the numbers of the particles of a slot fetched from memory, to be there when it is their turn.
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
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: a hint may have any address.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(place.cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = place;
}

/// The same for their bodies.
#[inline(always)]
pub fn prefetch_bodies(bodies: &[u16], start: usize) {
    prefetch_line(bodies.as_ptr().wrapping_add(start));
}

/// The same for a record.
#[inline(always)]
pub fn prefetch_record<T>(records: &[T], number: usize) {
    let record = records.as_ptr().wrapping_add(number).cast::<u8>();
    for line in 0..size_of::<T>() / 64 {
        prefetch_line(record.wrapping_add(64 * line));
    }
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
    fn every_particle_comes_once_in_its_cells_lane() {
        let counts = [0, 3, 1, 400, 0, 33, 4, 4, 0, 8, 9, 2, 0];
        let all: u32 = counts.iter().sum();
        let first = |c: usize| counts[..c].iter().sum::<u32>();
        let (mut tiles, mut lanes) = (Tiles::default(), Vec::new());
        let mut rank_at = vec![u32::MAX; all as usize];
        tiles.rebuild(
            (0..counts.len()).map(|c| (first(c), counts[c])),
            |pile| lanes.push(pile),
            |rank, place| rank_at[place as usize] = rank,
        );
        assert_eq!(lanes.len(), LANES * tiles.len());
        let own = lanes.iter().flatten().filter(|pile| !pile.more);
        let mut own: Vec<u32> = own.map(|pile| pile.cell).collect();
        own.sort_unstable();
        assert_eq!(own, (0..counts.len() as u32).collect::<Vec<_>>());
        let mut seen = vec![0; rank_at.len()];
        let whole = ByTile::new(&tiles, 0..rank_at.len(), 0..tiles.len());
        let (low, high) = whole.split(1);
        let mut particles = vec![0.0; counts.len()];
        for part in [low, high] {
            for (number, contents) in part.each() {
                assert!(part.cells.contains(&number));
                let mut sum = Lane::of(0.0);
                for slot in contents.slots() {
                    assert!(slot.start >= part.particles.start && slot.end <= part.particles.end);
                    for (lane, place) in slot.enumerate() {
                        let c = lanes[number * LANES + lane].unwrap().cell as usize;
                        assert!((first(c)..first(c) + counts[c]).contains(&rank_at[place]));
                        seen[rank_at[place] as usize] += 1;
                        sum[lane] += 1.0;
                    }
                }
                contents.gather([&mut sum]);
                for (lane, sum) in sum.into_iter().enumerate() {
                    if let Some(pile) = lanes[number * LANES + lane] {
                        particles[pile.cell as usize] += sum;
                    }
                }
            }
        }
        assert!(seen.iter().all(|&n| n == 1));
        assert!(
            particles
                .iter()
                .zip(counts)
                .all(|(&n, c)| n == f64::from(c))
        );
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
