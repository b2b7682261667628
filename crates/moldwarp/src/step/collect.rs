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
use crate::lanes::{LANES, Lane, Simd};
use crate::parallel::{self, Split, Sum};
use std::ops::Range;

/// Portions that cells are cut into, unless they would have fewer tiles than [`LEAST`].
const PORTIONS: usize = 32;
const LEAST: usize = 8;
/// Most quads that a node collects at a time.
const MOST: usize = 2;

/// The portions, and what their nodes have been given.
#[derive(Clone, Debug, Default)]
pub struct Portions {
    cut: Cut,
    /// All tiles.
    count: usize,
    windows: Vec<Window>,
    quads: Vec<Quad>,
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

/// The nodes that a portion's cells have.
#[derive(Clone, Copy, Debug)]
struct Window {
    first: usize,
    count: usize,
    /// Nodes of all the portions before.
    before: usize,
}

impl Window {
    fn nodes(&self) -> Range<usize> {
        self.first..self.first + self.count
    }
}

impl Portions {
    /// Of cells with these nodes, tile after tile, of which the first tiles are `own`.
    pub fn renew(&mut self, cell_nodes: &[[u32; 4]], own: usize) {
        let tiles = own.div_ceil(PORTIONS).max(LEAST);
        self.cut = Cut { tiles, own };
        self.windows.clear();
        let (own, guests) = cell_nodes.split_at(own * LANES);
        self.add(own);
        self.add(guests);
        self.count = cell_nodes.len() / LANES;
    }

    /// The same after guests have changed. What others have given stays.
    pub fn renew_guests(&mut self, cell_nodes: &[[u32; 4]]) {
        let own = self.cut.own;
        self.windows.truncate(own.div_ceil(self.cut.tiles));
        self.add(&cell_nodes[own * LANES..]);
        self.count = cell_nodes.len() / LANES;
    }

    fn add(&mut self, cell_nodes: &[[u32; 4]]) {
        let mut before = self.windows.last().map_or(0, |w| w.before + w.count);
        for cells in cell_nodes.chunks(self.cut.tiles * LANES) {
            let (mut first, mut last) = (u32::MAX, 0);
            for &n in cells.as_flattened() {
                first = first.min(n);
                last = last.max(n);
            }
            let (first, count) = (first as usize, (last - first) as usize + 1);
            self.windows.push(Window {
                first,
                count,
                before,
            });
            before += count;
        }
        self.quads.resize(before * MOST, Quad::default());
    }

    /// How tiles are cut.
    pub fn cut(&self) -> Cut {
        self.cut
    }

    /// Room for two more portions of so many nodes.
    pub fn make_room(&mut self, nodes: usize) {
        self.windows.reserve(2);
        self.quads.reserve(2 * nodes * MOST);
    }

    /// To be split at portions, with other things kept by tile: what nodes are given N quads of.
    pub fn shares<const N: usize>(&mut self) -> Shares<'_, N> {
        const { assert!(N <= MOST) }
        Shares {
            tiles: self.cut.tiles,
            count: self.count,
            windows: &self.windows,
            quads: &mut self.quads,
        }
    }

    /// Finds the sums of these nodes, by quads.
    #[inline]
    pub fn sums<const N: usize, const NODES: usize>(
        &self,
        nodes: Range<usize>,
        sums: &mut [[Quad; NODES]; N],
    ) {
        let count = nodes.len();
        (sums.iter_mut()).for_each(|sums| sums[..count].fill(Quad::default()));
        for window in &self.windows {
            let own = window.nodes();
            let both = own.start.max(nodes.start)..own.end.min(nodes.end);
            if both.is_empty() {
                continue;
            }
            for (k, sums) in sums.iter_mut().enumerate() {
                let at = N * window.before + k * window.count + both.start - own.start;
                let given = &self.quads[at..at + both.len()];
                for (sum, given) in sums[both.start - nodes.start..].iter_mut().zip(given) {
                    *sum += *given;
                }
            }
        }
    }
}

/// What the nodes of some portions are given.
pub struct Shares<'a, const N: usize> {
    tiles: usize,
    count: usize,
    windows: &'a [Window],
    quads: &'a mut [Quad],
}

impl<const N: usize> Split for Shares<'_, N> {
    fn count(&self) -> usize {
        self.count
    }

    fn split(self, at: usize) -> (Self, Self) {
        // Where guests begin, a portion may have fewer tiles.
        let (low, high) = self.windows.split_at(at.div_ceil(self.tiles));
        let of_low = high[0].before - low[0].before;
        let quads = self.quads.split_at_mut(N * of_low);
        let part = |count, windows, quads| Shares {
            tiles: self.tiles,
            count,
            windows,
            quads,
        };
        (part(at, low, quads.0), part(self.count - at, high, quads.1))
    }
}

/// What the nodes of one portion are given: quad after quad of all nodes.
pub struct Share<'a, const N: usize> {
    first: usize,
    count: usize,
    quads: &'a mut [Quad],
}

impl<'a, const N: usize> Shares<'a, N> {
    /// Nothing so far, of the only portion.
    pub fn begin(self) -> Share<'a, N> {
        let (first, count) = (self.windows.first()).map_or((0, 0), |w| (w.first, w.count));
        let quads = &mut self.quads[..N * count];
        quads.fill(Quad::default());
        Share {
            first,
            count,
            quads,
        }
    }
}

impl<const N: usize> Share<'_, N> {
    fn quad(&mut self, k: usize) -> &mut [Quad] {
        &mut self.quads[k * self.count..(k + 1) * self.count]
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

    /// Gives all nodes of cells the same two numbers, as their last quad.
    #[inline]
    pub fn give_alike(&mut self, simd: Simd, nodes: &[[u32; 4]; LANES], numbers: [&Lane; 2]) {
        let first = self.first;
        add_alike(simd, self.quad(N - 1), first, nodes, numbers);
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
        portions.renew(&cells, own);
        let cut = portions.cut();
        assert!(own.div_ceil(cut.tiles) <= PORTIONS && cut.tiles >= LEAST);
        let items = (0..tiles, portions.shares::<2>());
        cut.fold(items, &|(tiles, shares): (Range<usize>, Shares<2>)| {
            let mut share = shares.begin();
            for nodes in cells.as_chunks::<LANES>().0[tiles].iter() {
                let one = Lane::of(1.0);
                let numbers: [Lane; 4] = std::array::from_fn(|i| {
                    Lane::from(std::array::from_fn(|l| f64::from(nodes[l][i])))
                });
                let mut vectors = NO_CORNERS;
                (0..4).for_each(|i| vectors[3 * i] = one);
                share.give(Simd::best(), nodes, &vectors, &numbers);
                share.give_alike(Simd::best(), nodes, [&one, &one]);
            }
        });
        let nodes = cells.len() + 3;
        for first in (0..nodes).step_by(100) {
            let range = first..(first + 100).min(nodes);
            let mut quads = [[Quad::default(); 100]; 2];
            portions.sums(range.clone(), &mut quads);
            let [sums, alike] = quads;
            for ((n, sum), alike) in range.zip(sums).zip(alike) {
                let times = (n + 1).min(nodes - n).min(4) as f64;
                assert_eq!(sum, Quad([times, 0.0, 0.0, times * n as f64]));
                assert_eq!(alike, Quad([times, times, 0.0, 0.0]));
            }
        }
    }
}
