//! The consistent mass matrix M_ij = Σ_p m_p N_i N_j, by pairs of nodes.
//!
//! There are about seven pairs a node and five to six cells a node, each with six pairs: kept by pairs the matrix
//! is a sixth of what it is cell by cell, and a product with it goes through nodes in order.

use super::BLOCK;
use super::collect::Portions;
use super::corners::{Numbers, Quad, TilePairs};
use crate::lanes::{Simd, for_each_simd};
use crate::parallel::fold;
use std::ops::Range;

/// The pairs of a cell's nodes.
pub(super) const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// The matrix, and which pairs there are.
#[derive(Clone, Debug, Default)]
pub struct ConsistentMass {
    /// Number of each node's first pair with a node of a higher number, and one past the last.
    first: Vec<u32>,
    /// Pairs of the nodes of each lane's cell, in the order of [`PAIRS`].
    pairs: Numbers<6>,
    /// Where the links of each node begin, and one past the last.
    links: Vec<u32>,
    linked: Vec<Link>,
    /// M_ij of each pair, kg.
    pub values: Vec<f64>,
    /// M_ii, kg.
    pub diagonal: Vec<f64>,
    /// Of the search, kept so that no step allocates.
    room: Vec<u32>,
    found: Vec<u32>,
}

/// Another node that has a cell in common with a node, and the number of their pair.
#[derive(Clone, Copy, Debug, Default)]
struct Link {
    node: u32,
    pair: u32,
}

impl ConsistentMass {
    /// Finds the pairs of so many nodes, of the cells that have these.
    pub fn renew(&mut self, cell_nodes: &[[u32; 4]], nodes: usize) {
        let ConsistentMass {
            first,
            pairs,
            links,
            linked,
            values,
            diagonal,
            room,
            found,
        } = self;
        let ends = |cell: &[u32; 4]| {
            PAIRS.map(|(i, j)| (cell[i].min(cell[j]) as usize, cell[i].max(cell[j])))
        };
        // Room for each node's pairs, were no two cells to have one in common.
        room.clear();
        room.resize(nodes + 1, 0);
        for cell in cell_nodes {
            for (low, _) in ends(cell) {
                room[low + 1] += 1;
            }
        }
        for n in 0..nodes {
            room[n + 1] += room[n];
        }
        found.resize(room[nodes] as usize, 0);
        first.clear();
        first.resize(nodes + 1, 0);
        pairs.clear();
        for cell in cell_nodes {
            pairs.push(ends(cell).map(|(low, high)| {
                let (begin, count) = (room[low] as usize, &mut first[low + 1]);
                let known = &found[begin..begin + *count as usize];
                let place = known.iter().position(|&n| n == high);
                place.map_or_else(
                    || {
                        found[begin + *count as usize] = high;
                        *count += 1;
                        *count - 1
                    },
                    |place| place as u32,
                )
            }));
        }
        for n in 0..nodes {
            first[n + 1] += first[n];
        }
        pairs.change(|pairs| {
            for (own, cell) in pairs.iter_mut().zip(cell_nodes) {
                for (pair, (low, _)) in own.iter_mut().zip(ends(cell)) {
                    *pair += first[low];
                }
            }
        });
        let count = first[nodes] as usize;
        values.clear();
        values.resize(count, 0.0);
        diagonal.clear();
        diagonal.resize(nodes, 0.0);
        link(first, |low, k| found[room[low] as usize + k], links, linked);
    }

    /// The same after guests have come: each of their lanes' cells has the pairs of another lane.
    pub fn add_guests(&mut self, same: impl Iterator<Item = usize>) {
        for lane in same {
            self.pairs.push(self.pairs[lane]);
        }
    }

    /// Room for so many more lanes.
    pub fn make_room(&mut self, lanes: usize) {
        self.pairs.reserve(lanes);
    }

    /// Numbers of the pairs of these nodes with ones of higher numbers.
    pub fn pairs_of(&self, nodes: Range<usize>) -> Range<usize> {
        self.first[nodes.start] as usize..self.first[nodes.end] as usize
    }

    /// Pairs of the nodes of a tile's cells.
    #[inline(always)]
    pub fn tile_pairs(&self, tile: usize) -> TilePairs<'_> {
        self.pairs.tile(tile)
    }

    /// Adds up what portions have for each pair.
    pub fn collect(&mut self, portions: &Portions) {
        let items = (0..self.values.len(), &mut self.values[..]);
        fold(items, 8 * BLOCK, &|(pairs, values): (
            Range<usize>,
            &mut [f64],
        )| {
            values.fill(0.0);
            portions.pairs.sums(pairs, &mut [values]);
        });
    }

    /// Σ_j M_ij w_j of each of these nodes.
    #[inline]
    pub fn products(&self, simd: Simd, nodes: Range<usize>, w: &[Quad], sums: &mut [Quad]) {
        products(simd, self, nodes, w, sums);
    }

    /// Σ_j M_ij (w_i − w_j) of each of these nodes.
    #[inline]
    pub fn flows(&self, simd: Simd, nodes: Range<usize>, w: &[Quad], sums: &mut [Quad]) {
        flows(simd, self, nodes, w, sums);
    }

    #[inline(always)]
    fn links(&self, node: usize) -> &[Link] {
        &self.linked[self.links[node] as usize..self.links[node + 1] as usize]
    }
}

for_each_simd! {
    fn products(matrix: &ConsistentMass, nodes: Range<usize>, w: &[Quad], sums: &mut [Quad]) {
        for (node, to) in nodes.zip(sums) {
            let mut sum = w[node].0.map(|x| x * matrix.diagonal[node]);
            for link in matrix.links(node) {
                let (m, w) = (matrix.values[link.pair as usize], w[link.node as usize].0);
                for k in 0..4 {
                    sum[k] += m * w[k];
                }
            }
            *to = Quad(sum);
        }
    }
}

for_each_simd! {
    fn flows(matrix: &ConsistentMass, nodes: Range<usize>, w: &[Quad], sums: &mut [Quad]) {
        for (node, to) in nodes.zip(sums) {
            let (own, mut sum) = (w[node].0, [0.0; 4]);
            for link in matrix.links(node) {
                let (m, w) = (matrix.values[link.pair as usize], w[link.node as usize].0);
                for k in 0..4 {
                    sum[k] += m * (own[k] - w[k]);
                }
            }
            *to = Quad(sum);
        }
    }
}

/// Links every node with the others of its pairs; `other` is the other node of the k-th pair of a node with ones of
/// higher numbers.
fn link(
    first: &[u32],
    other: impl Fn(usize, usize) -> u32,
    links: &mut Vec<u32>,
    linked: &mut Vec<Link>,
) {
    let nodes = first.len() - 1;
    let pairs = || {
        (0..nodes).flat_map(|low| {
            let range = first[low]..first[low + 1];
            range.zip(0..).map(move |(pair, k)| (low, k, pair))
        })
    };
    links.clear();
    links.resize(nodes + 1, 0);
    for (low, k, _) in pairs() {
        links[low + 1] += 1;
        links[other(low, k) as usize + 1] += 1;
    }
    for n in 0..nodes {
        links[n + 1] += links[n];
    }
    linked.resize(links[nodes] as usize, Link::default());
    for (low, k, pair) in pairs() {
        let high = other(low, k);
        for (of, node) in [(low, high), (high as usize, low as u32)] {
            linked[links[of] as usize] = Link { node, pair };
            links[of] += 1;
        }
    }
    // Each has moved on to the next node's; move them back.
    links.copy_within(0..nodes, 1);
    links[0] = 0;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two cells with a face in common, and a third one that has one node with them.
    #[test]
    fn cells_share_pairs() {
        let cells = [[3, 0, 1, 2], [4, 1, 2, 3], [7, 6, 5, 4]];
        let mut mass = ConsistentMass::default();
        mass.renew(&cells, 8);
        assert_eq!(mass.values.len(), 6 + 3 + 6);
        assert_eq!(mass.pairs_of(0..8), 0..15);
        for (cell, pairs) in cells.iter().zip(mass.pairs.iter()) {
            for ((i, j), &pair) in PAIRS.into_iter().zip(pairs) {
                mass.values[pair as usize] =
                    f64::from(10 * cell[i].min(cell[j]) + cell[i].max(cell[j]));
            }
        }
        mass.diagonal = (0..8).map(|n| f64::from(100 * (n + 1))).collect();
        let w: Vec<Quad> = (0..8)
            .map(|n| Quad([1.0, f64::from(n), 0.0, 0.0]))
            .collect();
        // Node 4 has pairs with 1, 2, 3, 5, 6 and 7.
        let others = [
            (1, 14.0),
            (2, 24.0),
            (3, 34.0),
            (5, 45.0),
            (6, 46.0),
            (7, 47.0),
        ];
        let sum: f64 = others.iter().map(|(_, m)| m).sum();
        let moment: f64 = others.iter().map(|(n, m)| f64::from(*n) * m).sum();
        for simd in Simd::NAMES.iter().filter_map(|name| Simd::named(name)) {
            let mut sums = [Quad::default(); 2];
            mass.products(simd, 3..5, &w, &mut sums);
            assert_eq!(sums[1].0[..2], [sum + 500.0, moment + 2000.0]);
            mass.flows(simd, 3..5, &w, &mut sums);
            assert_eq!(sums[1].0[..2], [0.0, 4.0 * sum - moment]);
        }
    }
}
