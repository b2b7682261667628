//! What nodes collect from the cells around them.
//!
//! Cells are cut into portions of neighbouring tiles: as many for any number of threads. Of each portion one
//! thread adds up, cell after cell, what its nodes are given, in numbers of the portion's own; a node then
//! adds up its portions, in their order. So memory is read and written in sequence, no two threads write to
//! the same place, and sums have the same bits with any number of threads. (A node that looks its cells up
//! waits for memory: four to eight times as long.)
//!
//! Guests (`guests.rs`) have portions of their own, so that what nodes have been given by all others stays as it is
//! when guests change.

use super::corners::{Corners, Quad, add_alike, add_corners};
use super::mass::ConsistentMass;
use crate::lanes::{LANES, Lane, Simd};
use crate::parallel::{self, Split, Sum};
use std::ops::{AddAssign, Range};

/// Portions that cells are cut into, unless they would have fewer tiles than [`LEAST`].
const PORTIONS: usize = 32;
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
pub struct Collected<T> {
    windows: Vec<Window>,
    given: Vec<T>,
}

/// How tiles are cut into portions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cut {
    /// Tiles of a portion; the last one, and the last one of guests, may have fewer.
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
        let (own, guests) = rayon::join(
            || parallel::fold(own, self.tiles, work),
            || parallel::fold(guests, self.tiles, work),
        );
        own.plus(guests)
    }

    /// The same for the portions of guests only.
    pub fn fold_guests<S: Split, T: Sum>(self, items: S, work: &(impl Fn(S) -> T + Sync)) -> T {
        match items.count() > self.own {
            true => parallel::fold(items.split(self.own).1, self.tiles, work),
            false => T::default(),
        }
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
    /// Of cells with these nodes, tile after tile, of which the first tiles are `own`.
    pub fn renew(&mut self, cell_nodes: &[[u32; 4]], own: usize, mass: &ConsistentMass) {
        let tiles = own.div_ceil(PORTIONS).max(LEAST);
        self.cut = Cut { tiles, own };
        self.nodes.windows.clear();
        self.pairs.windows.clear();
        let (own, guests) = cell_nodes.split_at(own * LANES);
        self.add(own, mass);
        self.add(guests, mass);
        self.count = cell_nodes.len() / LANES;
    }

    /// The same after guests have changed. What others have given stays.
    pub fn renew_guests(&mut self, cell_nodes: &[[u32; 4]], mass: &ConsistentMass) {
        let own = self.cut.own;
        let portions = own.div_ceil(self.cut.tiles);
        self.nodes.windows.truncate(portions);
        self.pairs.windows.truncate(portions);
        self.add(&cell_nodes[own * LANES..], mass);
        self.count = cell_nodes.len() / LANES;
    }

    fn add(&mut self, cell_nodes: &[[u32; 4]], mass: &ConsistentMass) {
        for cells in cell_nodes.chunks(self.cut.tiles * LANES) {
            let (mut first, mut last) = (u32::MAX, 0);
            for &n in cells.as_flattened() {
                first = first.min(n);
                last = last.max(n);
            }
            let nodes = first as usize..last as usize + 1;
            self.pairs.add(mass.pairs_of(nodes.clone()), 1);
            self.nodes.add(nodes, MOST);
        }
    }

    /// How tiles are cut.
    pub fn cut(&self) -> Cut {
        self.cut
    }

    /// Room for two more portions of so many nodes and pairs.
    pub fn make_room(&mut self, nodes: usize, pairs: usize) {
        self.nodes.make_room(2 * nodes * MOST);
        self.pairs.make_room(2 * pairs);
    }

    /// To be split at portions, with other things kept by tile: what nodes are given N quads of.
    pub fn shares<const N: usize>(&mut self) -> Shares<'_, Quad, N> {
        const { assert!(N <= MOST) }
        self.nodes.shares(self.cut.tiles, self.count)
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
        (
            nodes.shares(cut.tiles, *count),
            pairs.shares(cut.tiles, *count),
        )
    }
}

impl<T: Copy + Default> Collected<T> {
    fn add(&mut self, items: Range<usize>, most: usize) {
        let before = self.windows.last().map_or(0, |w| w.before + w.count);
        let (first, count) = (items.start, items.len());
        self.windows.push(Window {
            first,
            count,
            before,
        });
        self.given.resize((before + count) * most, T::default());
    }

    fn make_room(&mut self, items: usize) {
        self.windows.reserve(2);
        self.given.reserve(items);
    }

    fn shares<const N: usize>(&mut self, tiles: usize, count: usize) -> Shares<'_, T, N> {
        Shares {
            tiles,
            count,
            windows: &self.windows,
            given: &mut self.given,
        }
    }

    /// Finds the sums of these items, each of N one after another.
    #[inline]
    pub fn sums<const N: usize>(&self, items: Range<usize>, sums: &mut [&mut [T]; N])
    where
        T: AddAssign,
    {
        let count = items.len();
        (sums.iter_mut()).for_each(|sums| sums[..count].fill(T::default()));
        for window in &self.windows {
            let own = window.items();
            let both = own.start.max(items.start)..own.end.min(items.end);
            if both.is_empty() {
                continue;
            }
            for (k, sums) in sums.iter_mut().enumerate() {
                let at = N * window.before + k * window.count + both.start - own.start;
                let given = &self.given[at..at + both.len()];
                for (sum, given) in sums[both.start - items.start..].iter_mut().zip(given) {
                    *sum += *given;
                }
            }
        }
    }
}

/// What the items of some portions are given.
pub struct Shares<'a, T, const N: usize> {
    tiles: usize,
    count: usize,
    windows: &'a [Window],
    given: &'a mut [T],
}

impl<T: Send, const N: usize> Split for Shares<'_, T, N> {
    fn count(&self) -> usize {
        self.count
    }

    fn split(self, at: usize) -> (Self, Self) {
        // Where guests begin, a portion may have fewer tiles.
        let (low, high) = self.windows.split_at(at.div_ceil(self.tiles));
        let of_low = high[0].before - low[0].before;
        let given = self.given.split_at_mut(N * of_low);
        let part = |count, windows, given| Shares {
            tiles: self.tiles,
            count,
            windows,
            given,
        };
        (part(at, low, given.0), part(self.count - at, high, given.1))
    }
}

/// What the items of one portion are given: number after number of all items.
pub struct Share<'a, T, const N: usize> {
    first: usize,
    count: usize,
    given: &'a mut [T],
}

impl<'a, T: Copy + Default, const N: usize> Shares<'a, T, N> {
    /// Nothing so far, of the only portion.
    pub fn begin(self) -> Share<'a, T, N> {
        let (first, count) = (self.windows.first()).map_or((0, 0), |w| (w.first, w.count));
        let given = &mut self.given[..N * count];
        given.fill(T::default());
        Share {
            first,
            count,
            given,
        }
    }
}

impl<const N: usize> Share<'_, Quad, N> {
    fn quad(&mut self, k: usize) -> &mut [Quad] {
        &mut self.given[k * self.count..(k + 1) * self.count]
    }

    /// Gives each node of cells its vector and a number, as its first quad.
    #[inline]
    pub fn give(
        &mut self,
        simd: Simd,
        nodes: &[[u32; 4]; LANES],
        vectors: &Corners,
        fourth: &[Lane; 4],
    ) {
        let first = self.first;
        add_corners(simd, self.quad(0), first, nodes, vectors, fourth);
    }

    /// Gives all nodes of cells the same two numbers, and each one of its own, as their last quad.
    #[inline]
    pub fn give_alike(
        &mut self,
        simd: Simd,
        nodes: &[[u32; 4]; LANES],
        numbers: [&Lane; 2],
        own: Option<&[Lane; 4]>,
    ) {
        let first = self.first;
        add_alike(simd, self.quad(N - 1), first, nodes, numbers, own);
    }
}

impl Share<'_, f64, 1> {
    /// Gives each pair of nodes of cells its number.
    #[inline]
    pub fn give_pairs(&mut self, pairs: &[[u32; 6]; LANES], numbers: &[Lane; 6]) {
        for (l, pairs) in pairs.iter().enumerate() {
            for (k, &pair) in pairs.iter().enumerate() {
                self.given[pair as usize - self.first] += numbers[k][l];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::corners::NO_CORNERS;
    use super::*;

    /// Cells along a line, each with the next four nodes: every inner node is given each number four times.
    #[test]
    fn nodes_are_given_what_all_portions_have_for_them() {
        let tiles = 3 * LEAST * PORTIONS + 5;
        let cells: Vec<[u32; 4]> = (0..(tiles * LANES) as u32)
            .map(|c| std::array::from_fn(|i| c + i as u32))
            .collect();
        let mut portions = Portions::default();
        let own = tiles - 11;
        let mut mass = ConsistentMass::default();
        mass.renew(&cells, cells.len() + 3);
        portions.renew(&cells, own, &mass);
        let cut = portions.cut();
        assert!(own.div_ceil(cut.tiles) <= PORTIONS && cut.tiles >= LEAST);
        let items = (0..tiles, portions.shares::<2>());
        cut.fold(items, &|(tiles, shares): (
            Range<usize>,
            Shares<Quad, 2>,
        )| {
            let mut share = shares.begin();
            for nodes in cells.as_chunks::<LANES>().0[tiles].iter() {
                let one = Lane::of(1.0);
                let numbers: [Lane; 4] = std::array::from_fn(|i| {
                    Lane::from(std::array::from_fn(|l| f64::from(nodes[l][i])))
                });
                let mut vectors = NO_CORNERS;
                (0..4).for_each(|i| vectors[3 * i] = one);
                share.give(Simd::best(), nodes, &vectors, &numbers);
                share.give_alike(Simd::best(), nodes, [&one, &one], Some(&numbers));
            }
        });
        let nodes = cells.len() + 3;
        for first in (0..nodes).step_by(100) {
            let range = first..(first + 100).min(nodes);
            let (mut sums, mut alike) = ([Quad::default(); 100], [Quad::default(); 100]);
            (portions.nodes).sums(range.clone(), &mut [&mut sums, &mut alike]);
            for ((n, sum), alike) in range.zip(sums).zip(alike) {
                let times = (n + 1).min(nodes - n).min(4) as f64;
                assert_eq!(sum, Quad([times, 0.0, 0.0, times * n as f64]));
                assert_eq!(alike, Quad([times, times, times * n as f64, 0.0]));
            }
        }
    }
}
