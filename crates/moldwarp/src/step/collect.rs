//! What nodes collect from the cells around them.
//!
//! Cells are cut into portions of neighbouring tiles: as many for any number of threads. Of each portion one
//! thread adds up, cell after cell, what its nodes are given, in numbers of the portion's own; a node then
//! adds up its portions, in their order. So memory is read and written in sequence, no two threads write to
//! the same place, and sums have the same bits with any number of threads. (A node that looks its cells up
//! waits for memory: four to eight times as long.)
//!
//! Guests (`guests.rs`) are a portion of all nodes, which is there if they are. More of them only add to what their nodes
//! have been given.

use super::corners::{
    Corners, Quad, TileNodes, TilePairs, add_alike, add_both, add_corners, add_pairs,
};
use super::mass::ConsistentMass;

use crate::lanes::{LANES, Lane, Simd};
use crate::parallel::{self, Split, Sum};
use crate::particles::Column;
use std::ops::{AddAssign, Range};

/// Portions that cells are cut into, unless they would have fewer tiles than [`LEAST`].
const PORTIONS: usize = 24;
const LEAST: usize = 32;
/// Most quads that a node collects at a time.
const MOST: usize = 2;

/// The portions, and what their nodes and pairs of nodes have been given.
#[derive(Clone, Debug, Default)]
pub struct Portions {
    cut: Cut,
    /// All tiles.
    count: usize,
    /// Quads of nodes.
    pub nodes: Collected<Quad>,
    /// A number of each pair of nodes.
    pub pairs: Collected<f64>,
}

/// What items that have numbers have been given by portions.
#[derive(Clone, Debug, Default)]
pub struct Collected<T: Copy + Default> {
    windows: Vec<Window>,
    /// Windows without that of guests.
    own: usize,
    /// (A node's two quads lie on one line of the cache.)
    given: Column<T>,
}

/// How tiles are cut into portions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cut {
    /// Tiles of a portion, but for guests; the last one may have fewer.
    tiles: usize,
    /// Tiles without those of guests.
    own: usize,
}

impl Cut {
    /// Calls `work` on one portion after another, and adds up what it returns.
    pub fn fold<S: Split, T: Sum>(self, items: S, work: &(impl Fn(S) -> T + Sync)) -> T {
        if items.count() <= self.own {
            return parallel::fold(items, self.tiles, work);
        }
        let (own, guests) = items.split(self.own);
        // Theirs may be the largest one.
        let (guests, own) = rayon::join(|| work(guests), || parallel::fold(own, self.tiles, work));
        own.plus(guests)
    }

    /// The same without guests.
    pub fn fold_own<S: Split, T: Sum>(self, items: S, work: &(impl Fn(S) -> T + Sync)) -> T {
        parallel::fold(items.split(self.own).0, self.tiles, work)
    }
}

/// The items of a portion's cells.
#[derive(Clone, Copy, Debug)]
struct Window {
    first: usize,
    count: usize,
    /// Items of all the portions before.
    before: usize,
}

impl Window {
    fn items(&self) -> Range<usize> {
        self.first..self.first + self.count
    }
}

impl Portions {
    /// Of cells with these nodes, tile after tile; guests are not there, but have room if there may be any.
    pub fn renew(&mut self, cell_nodes: &[[u32; 4]], mass: &ConsistentMass, guests: bool) {
        let own = cell_nodes.len() / LANES;
        let tiles = own.div_ceil(PORTIONS).max(LEAST);
        self.cut = Cut { tiles, own };
        self.count = own;
        self.nodes.clear();
        self.pairs.clear();
        for cells in cell_nodes.chunks(tiles * LANES) {
            let (mut first, mut last) = (u32::MAX, 0);
            for &n in cells.as_flattened() {
                first = first.min(n);
                last = last.max(n);
            }
            let nodes = first as usize..last as usize + 1;
            self.pairs.add(mass.pairs_of(nodes.clone()));
            self.nodes.add(nodes);
        }
        let all = usize::from(guests);
        self.nodes.begin(MOST, all * mass.diagonal.len());
        self.pairs.begin(1, all * mass.values.len());
    }

    /// There are guests, or more of them, and so many tiles. What has been given stays.
    pub fn add_guests(&mut self, tiles: usize, mass: &ConsistentMass) {
        if self.count == self.cut.own {
            self.nodes.add(0..mass.diagonal.len());
            self.pairs.add(0..mass.values.len());
            self.nodes.resize(MOST);
            self.pairs.resize(1);
        }
        self.count = tiles;
    }

    /// How tiles are cut.
    pub fn cut(&self) -> Cut {
        self.cut
    }

    /// To be split at portions, with other things kept by tile: what nodes are given N quads of.
    pub fn shares<const N: usize>(&mut self) -> Shares<'_, Quad, N> {
        const { assert!(N <= MOST) }
        self.nodes.shares(self.cut, self.count)
    }

    /// The same with a number for each pair of nodes.
    pub fn all_shares<const N: usize>(&mut self) -> (Shares<'_, Quad, N>, Shares<'_, f64, 1>) {
        const { assert!(N <= MOST) }
        let Portions {
            cut,
            count,
            nodes,
            pairs,
        } = self;
        (nodes.shares(*cut, *count), pairs.shares(*cut, *count))
    }
}

impl<T: Copy + Default> Collected<T> {
    fn clear(&mut self) {
        self.windows.clear();
    }

    fn add(&mut self, items: Range<usize>) {
        self.windows.push(Window {
            first: items.start,
            count: items.len(),
            before: self.count(),
        });
    }

    /// Items of all windows.
    fn count(&self) -> usize {
        self.windows.last().map_or(0, |w| w.before + w.count)
    }

    /// All windows are there but that of guests, which may have so many items. An item collects at most `most`.
    fn begin(&mut self, most: usize, guests: usize) {
        self.own = self.windows.len();
        self.windows.reserve(1);
        let room = (self.count() + guests) * most;
        if self.given.capacity() < room {
            self.given = Column::with_capacity(room + room / 8);
        }
        self.resize(most);
    }

    fn resize(&mut self, most: usize) {
        self.given.resize(self.count() * most, T::default());
    }

    fn shares<const N: usize>(&mut self, cut: Cut, count: usize) -> Shares<'_, T, N> {
        Shares {
            cut,
            count,
            windows: &self.windows,
            given: &mut self.given,
        }
    }

    /// Adds up what these items have been given, each of N one after another.
    #[inline]
    pub fn sums<const N: usize>(&self, items: Range<usize>, sums: &mut [&mut [T]; N])
    where
        T: AddAssign,
    {
        sum_windows(&self.windows, &self.given, items, sums);
    }

    /// The same of what all but guests have given.
    #[inline]
    pub fn own_sums<const N: usize>(&self, items: Range<usize>, sums: &mut [&mut [T]; N])
    where
        T: AddAssign,
    {
        sum_windows(&self.windows[..self.own], &self.given, items, sums);
    }
}

#[inline]
fn sum_windows<T: Copy + Default + AddAssign, const N: usize>(
    windows: &[Window],
    given: &[T],
    items: Range<usize>,
    sums: &mut [&mut [T]; N],
) {
    for window in windows {
        let own = window.items();
        let both = own.start.max(items.start)..own.end.min(items.end);
        if both.is_empty() {
            continue;
        }
        let at = window.before + both.start - own.start;
        let given = &given.as_chunks::<N>().0[at..at + both.len()];
        let to = both.start - items.start;
        for (k, sums) in sums.iter_mut().enumerate() {
            for (sum, given) in sums[to..to + both.len()].iter_mut().zip(given) {
                *sum += given[k];
            }
        }
    }
}

/// What the items of some portions are given.
pub struct Shares<'a, T, const N: usize> {
    cut: Cut,
    count: usize,
    windows: &'a [Window],
    given: &'a mut [T],
}

impl<T: Send, const N: usize> Split for Shares<'_, T, N> {
    fn count(&self) -> usize {
        self.count
    }

    fn split(self, at: usize) -> (Self, Self) {
        // What is split within guests has their window behind.
        let Cut { tiles, own } = self.cut;
        let (low, high) = self.windows.split_at(at.min(own).div_ceil(tiles));
        let before = |window: &Window| window.before - self.windows[0].before;
        let of_low = (high.first()).map_or(self.given.len(), |window| N * before(window));
        let given = self.given.split_at_mut(of_low);
        let part = |own, count, windows, given| Shares {
            cut: Cut { tiles, own },
            count,
            windows,
            given,
        };
        let rest = own - at.min(own);
        (
            part(at.min(own), at, low, given.0),
            part(rest, self.count - at, high, given.1),
        )
    }
}

/// What the items of one portion are given, item after item.
pub struct Share<'a, T, const N: usize> {
    first: usize,
    given: &'a mut [T],
}

impl<'a, T: Copy + Default, const N: usize> Shares<'a, T, N> {
    /// Nothing so far, of the only portion.
    pub fn begin(self) -> Share<'a, T, N> {
        let share = self.go_on();
        share.given.fill(T::default());
        share
    }

    /// What it has been given before, of the only portion.
    pub fn go_on(self) -> Share<'a, T, N> {
        let (first, count) = (self.windows.first()).map_or((0, 0), |w| (w.first, w.count));
        Share {
            first,
            given: &mut self.given[..N * count],
        }
    }
}

impl Share<'_, Quad, 1> {
    /// Gives each node of cells its vector and a number.
    #[inline]
    pub fn give(&mut self, simd: Simd, nodes: TileNodes, vectors: &Corners, fourth: &[Lane; 4]) {
        add_corners(simd, self.given, self.first, nodes, vectors, fourth);
    }

    /// Gives all nodes of cells the same two numbers.
    #[inline]
    pub fn give_alike(&mut self, simd: Simd, nodes: TileNodes, numbers: [&Lane; 2]) {
        add_alike(simd, self.given, self.first, nodes, numbers);
    }
}

impl Share<'_, Quad, 2> {
    /// Gives each node of cells its vector and a number, and two that are the same for all of a cell's with one of its own.
    #[inline]
    pub fn give(
        &mut self,
        simd: Simd,
        nodes: TileNodes,
        vectors: &Corners,
        fourth: &[Lane; 4],
        alike: [&Lane; 2],
        own: &[Lane; 4],
    ) {
        let (given, _) = self.given.as_chunks_mut();
        add_both(
            simd,
            given,
            self.first,
            nodes,
            ((vectors, fourth), (alike, own)),
        );
    }
}

impl Share<'_, f64, 1> {
    /// Gives each pair of nodes of cells its number.
    #[inline]
    pub fn give_pairs(&mut self, pairs: TilePairs, numbers: &[Lane; 6]) {
        add_pairs(self.given, self.first, pairs, numbers);
    }
}

#[cfg(test)]
mod tests {
    use super::super::corners::{NO_CORNERS, Numbers};
    use super::*;

    /// Cells along a line, each with the next four nodes: every inner node is given each number four times; and those
    /// of guests that come late.
    #[test]
    fn nodes_are_given_what_all_portions_have_for_them() {
        let tiles = 3 * LEAST * PORTIONS + 5;
        let cells: Vec<[u32; 4]> = (0..(tiles * LANES) as u32)
            .map(|c| std::array::from_fn(|i| c + i as u32))
            .collect();
        let mut numbers = Numbers::default();
        cells.iter().for_each(|&cell| numbers.push(cell));
        let mut portions = Portions::default();
        let (own, late) = (tiles - 11, tiles - 4);
        let mut mass = ConsistentMass::default();
        mass.renew(&cells, cells.len() + 3);
        portions.renew(&cells[..own * LANES], &mass, true);
        portions.add_guests(late, &mass);
        let cut = portions.cut();
        assert!(own.div_ceil(cut.tiles) <= PORTIONS && cut.tiles >= LEAST);
        let give = |tiles: Range<usize>, mut share: Share<Quad, 2>| {
            for nodes in tiles.map(|tile| numbers.tile(tile)) {
                let one = Lane::of(1.0);
                let own: [Lane; 4] = std::array::from_fn(|i| {
                    Lane::from(std::array::from_fn(|l| f64::from(nodes[l][i])))
                });
                let mut vectors = NO_CORNERS;
                (0..4).for_each(|i| vectors[3 * i] = one);
                let alike = [&one, &one];
                share.give(Simd::best(), nodes, &vectors, &own, alike, &own);
            }
        };
        let items = (0..late, portions.shares::<2>());
        cut.fold(items, &|(tiles, shares): (
            Range<usize>,
            Shares<Quad, 2>,
        )| give(tiles, shares.begin()));
        portions.add_guests(tiles, &mass);
        let (tiles, shares) = (0..tiles, portions.shares::<2>()).split(late).1;
        give(tiles, shares.go_on());
        let check = |nodes: usize, all: bool| {
            for first in (0..nodes).step_by(100) {
                let range = first..(first + 100).min(nodes);
                let (mut sums, mut alike) = ([Quad::default(); 100], [Quad::default(); 100]);
                let both = &mut [&mut sums[..], &mut alike[..]];
                match all {
                    true => portions.nodes.sums(range.clone(), both),
                    false => portions.nodes.own_sums(range.clone(), both),
                }
                for ((n, sum), alike) in range.zip(sums).zip(alike) {
                    let times = (n + 1).min(nodes - n).min(4) as f64;
                    assert_eq!(sum, Quad([times, 0.0, 0.0, times * n as f64]));
                    assert_eq!(alike, Quad([times, times, times * n as f64, 0.0]));
                }
            }
        };
        check(cells.len() + 3, true);
        check(own * LANES + 3, false);
    }
}
