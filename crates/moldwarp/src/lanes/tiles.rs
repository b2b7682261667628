//! How cells and particles lie in memory, and going through them tile by tile.

use super::{LANES, Lane, NUMBERS_AHEAD, prefetch_number};
use crate::parallel::Split;
use std::ops::Range;

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
const WINDOW: usize = 192;

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

/// Cells with their numbers, in windows by how many particles they have: tiles of cells with as many have hardly an empty
/// lane. Every other window begins with those that have fewest, as a tile may begin in one window and end in the next.
fn alike_together(
    cells: impl Iterator<Item = (u32, u32)>,
) -> impl Iterator<Item = (usize, u32, u32)> {
    let mut cells = cells.enumerate();
    let (mut window, mut next, mut filled) = ([(0, (0, 0)); WINDOW], 0, 0);
    // All bits, if those with most particles come first.
    let mut turned = 0;
    // Of each cell how many particles it has, and its place in the window: sorts faster than what has more to move.
    let mut sorted = [0; WINDOW];
    std::iter::from_fn(move || {
        if next == filled {
            (next, filled) = (0, 0);
            turned = !turned;
            for ((own, key), cell) in window.iter_mut().zip(&mut sorted).zip(&mut cells) {
                *own = cell;
                let (_, (_, count)) = cell;
                *key = u64::from(count ^ turned) << 32 | filled as u64;
                filled += 1;
            }
            sorted[..filled].sort_unstable();
        }
        (next < filled).then(|| {
            next += 1;
            let (cell, (first, count)) = window[sorted[next - 1] as u32 as usize];
            (cell, first, count)
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

    /// Lays out more cells behind the others.
    pub(crate) fn extend(
        &mut self,
        cells: impl Iterator<Item = (u32, u32)>,
        lane: impl FnMut(Option<Pile>),
        put: impl FnMut(u32, u32),
    ) {
        self.tiles.pop();
        let place = self.slots.pop().expect("where the last slot ends");
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
            prefetch_number(&tiles.tiles, number + NUMBERS_AHEAD);
            prefetch_number(&tiles.slots, slots.start + 4 * NUMBERS_AHEAD);
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
    /// Whether it has no particles.
    pub fn is_empty(self) -> bool {
        self.slots.len() == 1
    }

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
}
