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

use super::shapes::{Corners, corner};
use crate::lanes::LANES;
use crate::parallel::{self, Split, Sum};
use std::ops::Range;

/// Portions that cells are cut into, unless they would have fewer tiles than [`LEAST`].
const PORTIONS: usize = 32;
const LEAST: usize = 8;
/// Most numbers that a node collects at a time.
const MOST: usize = 6;

/// The portions, and what their nodes have been given.
#[derive(Clone, Debug, Default)]
pub struct Portions {
    cut: Cut,
    /// All tiles.
    count: usize,
    windows: Vec<Window>,
    numbers: Vec<f64>,
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
    pub fn fold_guests<S: Split>(self, items: S, work: &(impl Fn(S) + Sync)) {
        if items.count() > self.own {
            parallel::fold(items.split(self.own).1, self.tiles, work);
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
        self.numbers.resize(before * MOST, 0.0);
    }

    /// How tiles are cut.
    pub fn cut(&self) -> Cut {
        self.cut
    }

    /// Room for two more portions of so many nodes.
    pub fn make_room(&mut self, nodes: usize) {
        self.windows.reserve(2);
        self.numbers.reserve(2 * nodes * MOST);
    }

    /// To be split at portions, with other things kept by tile: what nodes are given N numbers of.
    pub fn shares<const N: usize>(&mut self) -> Shares<'_, N> {
        const { assert!(N <= MOST) }
        Shares {
            tiles: self.cut.tiles,
            count: self.count,
            windows: &self.windows,
            numbers: self.numbers.as_chunks_mut().0,
        }
    }

    /// The sums of these nodes.
    pub fn sums<const N: usize, const NODES: usize>(
        &self,
        nodes: Range<usize>,
    ) -> [[f64; N]; NODES] {
        let numbers: &[[f64; N]] = self.numbers.as_chunks().0;
        let mut sums = [[0.0; N]; NODES];
        for window in &self.windows {
            let own = window.nodes();
            let both = own.start.max(nodes.start)..own.end.min(nodes.end);
            if both.is_empty() {
                continue;
            }
            let at = window.before + both.start - own.start;
            let given = &numbers[at..at + both.len()];
            let sums = &mut sums[both.start - nodes.start..];
            for (sum, given) in sums.iter_mut().zip(given) {
                for k in 0..N {
                    sum[k] += given[k];
                }
            }
        }
        sums
    }
}

/// What the nodes of some portions are given.
pub struct Shares<'a, const N: usize> {
    tiles: usize,
    count: usize,
    windows: &'a [Window],
    numbers: &'a mut [[f64; N]],
}

impl<const N: usize> Split for Shares<'_, N> {
    fn count(&self) -> usize {
        self.count
    }

    fn split(self, at: usize) -> (Self, Self) {
        // Where guests begin, a portion may have fewer tiles.
        let (low, high) = self.windows.split_at(at.div_ceil(self.tiles));
        let of_low = high[0].before - low[0].before;
        let numbers = self.numbers.split_at_mut(of_low);
        let part = |count, windows, numbers| Shares {
            tiles: self.tiles,
            count,
            windows,
            numbers,
        };
        (
            part(at, low, numbers.0),
            part(self.count - at, high, numbers.1),
        )
    }
}

/// What the nodes of one portion are given.
pub struct Share<'a, const N: usize> {
    first: usize,
    numbers: &'a mut [[f64; N]],
}

impl<'a, const N: usize> Shares<'a, N> {
    /// Nothing so far, of the only portion.
    pub fn begin(self) -> Share<'a, N> {
        let (first, count) = (self.windows.first()).map_or((0, 0), |w| (w.first, w.count));
        let numbers = &mut self.numbers[..count];
        numbers.fill([0.0; N]);
        Share { first, numbers }
    }
}

impl<const N: usize> Share<'_, N> {
    /// Gives each node of a cell its numbers.
    #[inline(always)]
    pub fn give(&mut self, nodes: &[u32; 4], numbers: impl Fn(usize) -> [f64; N]) {
        for (i, &n) in nodes.iter().enumerate() {
            let sum = &mut self.numbers[n as usize - self.first];
            let more = numbers(i);
            for k in 0..N {
                sum[k] += more[k];
            }
        }
    }
}

impl Share<'_, 3> {
    /// Gives each node of cells its vector.
    #[inline(always)]
    pub fn give_corners(&mut self, nodes: &[[u32; 4]; LANES], vectors: &Corners) {
        for (l, nodes) in nodes.iter().enumerate() {
            self.give(nodes, |i| corner(vectors, l, i).to_array());
        }
    }
}

#[cfg(test)]
mod tests {
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
            for nodes in &cells[tiles.start * LANES..tiles.end * LANES] {
                share.give(nodes, |i| [1.0, f64::from(nodes[i])]);
            }
        });
        let nodes = cells.len() + 3;
        for first in (0..nodes).step_by(100) {
            let range = first..(first + 100).min(nodes);
            let sums: [[f64; 2]; 100] = portions.sums(range.clone());
            for (n, sum) in range.zip(sums) {
                let times = (n + 1).min(nodes - n).min(4) as f64;
                assert_eq!(sum, [times, times * n as f64]);
            }
        }
    }
}
