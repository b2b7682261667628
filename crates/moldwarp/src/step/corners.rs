//! Nodal values of cells side by side: how they come from nodes and go to them.
//!
//! A node has four numbers together, which are loaded at once; a tile has each number of a corner in lanes. Between
//! them lies the transposition of four or eight cells at a time, which compilers do not find: it is written with
//! AVX2 or AVX-512 instructions where the processor has them. What is added has the same order with and without.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;

use crate::Vec3;
use crate::lanes::{
    LANES, Lane, NUMBERS_AHEAD, RECORDS_AHEAD, Simd, for_each_simd, prefetch_number,
    prefetch_record,
};

/// A vector of a node with one more number, or up to four numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub struct Quad(pub [f64; 4]);

impl From<Vec3> for Quad {
    fn from(v: Vec3) -> Quad {
        Quad([v.x, v.y, v.z, 0.0])
    }
}

impl Quad {
    /// Its first three numbers.
    pub fn vector(self) -> Vec3 {
        let [x, y, z, _] = self.0;
        Vec3::new(x, y, z)
    }
}

impl std::ops::AddAssign for Quad {
    #[inline(always)]
    fn add_assign(&mut self, other: Quad) {
        for (sum, more) in self.0.iter_mut().zip(other.0) {
            *sum += more;
        }
    }
}

/// The nodes of cells, or pairs of their nodes, N a cell, and what those of each tile lie between.
#[derive(Clone, Debug, Default)]
pub struct Numbers<const N: usize> {
    cells: Vec<[u32; N]>,
    /// One a tile. (Asked for in each step, so that what is given by number need not be looked at again.)
    spans: Vec<Span>,
}

/// The same of cells side by side.
#[derive(Clone, Copy)]
pub struct TileNumbers<'a, const N: usize> {
    cells: &'a [[u32; N]; LANES],
    span: Span,
}

/// Nodes of the cells of a tile.
pub type TileNodes<'a> = TileNumbers<'a, 4>;
/// Pairs of their nodes.
pub type TilePairs<'a> = TileNumbers<'a, 6>;

/// What numbers lie between.
#[derive(Clone, Copy, Debug)]
struct Span {
    least: u32,
    greatest: u32,
}

impl Span {
    const NOTHING: Span = Span {
        least: u32::MAX,
        greatest: 0,
    };

    fn add(&mut self, numbers: &[u32]) {
        for &n in numbers {
            self.least = self.least.min(n);
            self.greatest = self.greatest.max(n);
        }
    }
}

impl<const N: usize> Numbers<N> {
    pub fn clear(&mut self) {
        self.cells.clear();
        self.spans.clear();
    }

    /// Room for so many more cells.
    pub fn reserve(&mut self, cells: usize) {
        self.cells.reserve(cells);
        self.spans.reserve(cells.div_ceil(LANES));
    }

    pub fn push(&mut self, cell: [u32; N]) {
        if self.cells.len().is_multiple_of(LANES) {
            self.spans.push(Span::NOTHING);
        }
        self.cells.push(cell);
        self.spans.last_mut().expect("there is one").add(&cell);
    }

    /// Has them changed.
    pub fn change(&mut self, change: impl FnOnce(&mut [[u32; N]])) {
        change(&mut self.cells);
        let tiles = self.cells.chunks(LANES);
        for (span, tile) in self.spans.iter_mut().zip(tiles) {
            *span = Span::NOTHING;
            span.add(tile.as_flattened());
        }
    }

    /// Those of a tile; those of one that comes later are fetched from memory.
    #[inline(always)]
    pub fn tile(&self, tile: usize) -> TileNumbers<'_, N> {
        let tiles = self.cells.as_chunks().0;
        prefetch_record(tiles, tile + RECORDS_AHEAD);
        prefetch_number(&self.spans, tile + NUMBERS_AHEAD);
        TileNumbers {
            cells: &tiles[tile],
            span: self.spans[tile],
        }
    }
}

impl<const N: usize> std::ops::Deref for Numbers<N> {
    type Target = [[u32; N]];

    #[inline(always)]
    fn deref(&self) -> &[[u32; N]] {
        &self.cells
    }
}

impl<const N: usize> TileNumbers<'_, N> {
    /// Whether they are among so many from this one on.
    #[inline]
    fn are_among(self, from: usize, count: usize) -> bool {
        let Span { least, greatest } = self.span;
        least as usize >= from && greatest as usize - from < count
    }
}

impl<const N: usize> std::ops::Deref for TileNumbers<'_, N> {
    type Target = [[u32; N]; LANES];

    #[inline(always)]
    fn deref(&self) -> &[[u32; N]; LANES] {
        self.cells
    }
}

/// Vectors at the four nodes of cells side by side.
pub type Corners = [Lane; 12];

pub(super) const NO_CORNERS: Corners = [Lane::of(0.0); 12];

#[inline(always)]
pub(super) fn corner(corners: &Corners, l: usize, i: usize) -> Vec3 {
    Vec3::new(
        corners[3 * i][l],
        corners[3 * i + 1][l],
        corners[3 * i + 2][l],
    )
}

#[inline(always)]
pub(super) fn all_corners(corners: &Corners, l: usize) -> [Vec3; 4] {
    [
        corner(corners, l, 0),
        corner(corners, l, 1),
        corner(corners, l, 2),
        corner(corners, l, 3),
    ]
}

#[inline(always)]
pub(super) fn set_corner(corners: &mut Corners, l: usize, i: usize, value: Vec3) {
    corners[3 * i][l] = value.x;
    corners[3 * i + 1][l] = value.y;
    corners[3 * i + 2][l] = value.z;
}

/// Sums of a number of the nodes of cells side by side.
#[inline(always)]
pub(super) fn sum_nodes(sums: &mut Lane, nodes: TileNodes, numbers: &[f64]) {
    for (sum, cell) in sums.iter_mut().zip(*nodes) {
        *sum = cell.iter().map(|&n| numbers[n as usize]).sum();
    }
}

/// Instructions that a kernel is compiled for (`for_each_simd!`).
pub trait Instructions {
    /// The numbers of node `i` of each cell.
    ///
    /// # Safety
    /// The processor has the instructions, and all nodes are there.
    unsafe fn corner(quads: *const Quad, nodes: &[[u32; 4]; LANES], i: usize) -> [Lane; 4];

    /// Stores the first numbers of a lane.
    ///
    /// # Safety
    /// The processor has the instructions, and there is room.
    #[inline(always)]
    unsafe fn store(to: *mut f64, lane: Lane, count: usize) {
        for l in 0..count {
            // SAFETY: the caller's.
            unsafe { *to.add(l) = lane[l] };
        }
    }

    /// Vectors of the nodes of cells side by side, and the sums of their fourth numbers.
    #[inline(always)]
    fn corners(nodes: TileNodes, quads: &[Quad]) -> (Corners, Lane) {
        assert!(nodes.are_among(0, quads.len()));
        let (mut corners, mut sums) = (NO_CORNERS, Lane::of(0.0));
        for i in 0..4 {
            // SAFETY: nodes have been looked at; a kernel asks for the instructions that it is called for.
            let [x, y, z, fourth] = unsafe { Self::corner(quads.as_ptr(), &nodes, i) };
            (corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]) = (x, y, z);
            for l in 0..LANES {
                sums[l] += fourth[l];
            }
        }
        (corners, sums)
    }
}

/// Those that any processor has.
pub struct Plain;
#[cfg(target_arch = "x86_64")]
pub struct Avx2;
#[cfg(target_arch = "x86_64")]
pub struct Avx512;

impl Instructions for Plain {
    #[inline(always)]
    unsafe fn corner(quads: *const Quad, nodes: &[[u32; 4]; LANES], i: usize) -> [Lane; 4] {
        let mut lanes = [Lane::of(0.0); 4];
        for l in 0..LANES {
            // SAFETY: the caller's.
            let quad = unsafe { *quads.add(nodes[l][i] as usize) }.0;
            for k in 0..4 {
                lanes[k][l] = quad[k];
            }
        }
        lanes
    }
}

#[cfg(target_arch = "x86_64")]
impl Instructions for Avx2 {
    #[inline(always)]
    unsafe fn corner(quads: *const Quad, nodes: &[[u32; 4]; LANES], i: usize) -> [Lane; 4] {
        // SAFETY: the caller's.
        unsafe { avx2::corner(quads.cast(), nodes, i) }
    }
}

#[cfg(target_arch = "x86_64")]
impl Instructions for Avx512 {
    #[inline(always)]
    unsafe fn corner(quads: *const Quad, nodes: &[[u32; 4]; LANES], i: usize) -> [Lane; 4] {
        // SAFETY: the caller's.
        unsafe { avx512::corner(quads.cast(), nodes, i) }
    }

    #[inline(always)]
    unsafe fn store(to: *mut f64, lane: Lane, count: usize) {
        // SAFETY: the caller's.
        unsafe { avx512::store(to, lane, count) }
    }
}

for_each_simd! {
    /// Copies vectors of the nodes of cells side by side.
    pub(super) fn load_nodes(corners: &mut Corners, nodes: TileNodes, vectors: &[Quad]) {
        *corners = S::corners(nodes, vectors).0;
    }
}

/// Adds to numbers of nodes, of which those of node `first` come first: a vector and a number for each corner.
pub(super) fn add_corners(
    simd: Simd,
    to: &mut [Quad],
    first: usize,
    nodes: TileNodes,
    vectors: &Corners,
    fourth: &[Lane; 4],
) {
    #[cfg(target_arch = "x86_64")]
    if simd.has_avx2() {
        // SAFETY: the processor has the instructions.
        return unsafe { avx2::add_corners(to, first, nodes, vectors, fourth) };
    }
    let _ = simd;
    for (four, cells) in nodes.as_chunks::<4>().0.iter().enumerate() {
        for i in 0..4 {
            for (j, cell) in cells.iter().enumerate() {
                let l = 4 * four + j;
                let [x, y, z] = corner(vectors, l, i).to_array();
                to[cell[i] as usize - first] += Quad([x, y, z, fourth[i][l]]);
            }
        }
    }
}

/// Adds to the numbers of pairs of nodes, of which that of pair `first` comes first.
pub(super) fn add_pairs(to: &mut [f64], first: usize, pairs: TilePairs, numbers: &[Lane; 6]) {
    assert!(pairs.are_among(first, to.len()));
    for (l, pairs) in pairs.iter().enumerate() {
        for (k, &pair) in pairs.iter().enumerate() {
            // SAFETY: it is among those that are there.
            *unsafe { to.get_unchecked_mut(pair as usize - first) } += numbers[k][l];
        }
    }
}

/// Adds to numbers of nodes, as [`add_corners`], two that are alike for all corners.
pub(super) fn add_alike(
    simd: Simd,
    to: &mut [Quad],
    first: usize,
    nodes: TileNodes,
    [a, b]: [&Lane; 2],
) {
    #[cfg(target_arch = "x86_64")]
    if simd.has_avx2() {
        // SAFETY: the processor has the instructions.
        return unsafe { avx2::add_alike(to, first, nodes, [a, b]) };
    }
    let _ = simd;
    for (four, cells) in nodes.as_chunks::<4>().0.iter().enumerate() {
        for i in 0..4 {
            for (j, cell) in cells.iter().enumerate() {
                let l = 4 * four + j;
                to[cell[i] as usize - first] += Quad([a[l], b[l], 0.0, 0.0]);
            }
        }
    }
}

/// A vector and a number for each corner; two that are alike for all corners, and one for each.
type Both<'a> = ((&'a Corners, &'a [Lane; 4]), ([&'a Lane; 2], &'a [Lane; 4]));

/// Adds to numbers of nodes a vector and a number for each corner, and two that are alike for all corners with one for each.
pub(super) fn add_both(
    simd: Simd,
    to: &mut [[Quad; 2]],
    first: usize,
    nodes: TileNodes,
    both: Both,
) {
    #[cfg(target_arch = "x86_64")]
    if simd.has_avx512() {
        // SAFETY: the processor has the instructions.
        return unsafe { avx512::add_both(to, first, nodes, both) };
    }
    #[cfg(target_arch = "x86_64")]
    if simd.has_avx2() {
        // SAFETY: the processor has the instructions.
        return unsafe { avx2::add_both(to, first, nodes, both) };
    }
    let _ = simd;
    let ((vectors, fourth), ([a, b], third)) = both;
    for (four, cells) in nodes.as_chunks::<4>().0.iter().enumerate() {
        for i in 0..4 {
            for (j, cell) in cells.iter().enumerate() {
                let l = 4 * four + j;
                let [x, y, z] = corner(vectors, l, i).to_array();
                let to = &mut to[cell[i] as usize - first];
                to[0] += Quad([x, y, z, fourth[i][l]]);
                to[1] += Quad([a[l], b[l], third[i][l], 0.0]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    for_each_simd! {
        fn load_and_sum(corners: &mut Corners, sums: &mut Lane, nodes: TileNodes, quads: &[Quad]) {
            (*corners, *sums) = S::corners(nodes, quads);
        }
    }

    /// Cells that share nodes, by what the instructions of this processor do and without them.
    #[test]
    fn instructions_change_no_bit() {
        let cells: [[u32; 4]; LANES] =
            std::array::from_fn(|l| std::array::from_fn(|i| 7 + ((l * 3 + i * 5) % 23) as u32));
        let mut numbers = Numbers::default();
        cells.into_iter().for_each(|cell| numbers.push(cell));
        let nodes = numbers.tile(0);
        let number = |k: usize| (k as f64 * 0.37).sin();
        let quads: Vec<Quad> = (0..40)
            .map(|n| Quad(std::array::from_fn(|k| number(4 * n + k))))
            .collect();
        let plain = Simd::named("scalar").unwrap();
        let both = |work: &dyn Fn(Simd) -> Vec<Quad>| assert_eq!(work(plain), work(Simd::best()));
        both(&|simd| {
            let mut corners = NO_CORNERS;
            let mut sums = Lane::of(0.0);
            load_and_sum(simd, &mut corners, &mut sums, nodes, &quads);
            let vectors = (0..LANES).flat_map(|l| all_corners(&corners, l));
            let sums = sums.iter().map(|&sum| Quad([sum, 0.0, 0.0, 0.0]));
            vectors.map(Quad::from).chain(sums).collect()
        });
        let lane = |k: usize| Lane::from(std::array::from_fn(|l| number(100 * k + l)));
        let vectors: Corners = std::array::from_fn(lane);
        both(&|simd| {
            let mut sums = vec![Quad::default(); 23];
            let fourth = std::array::from_fn(|k| lane(k + 12));
            add_corners(simd, &mut sums, 7, nodes, &vectors, &fourth);
            add_alike(simd, &mut sums, 7, nodes, [&lane(20), &lane(21)]);
            let mut both = vec![[Quad::default(); 2]; 23];
            let alike = ([&lane(22), &lane(23)], &fourth);
            add_both(simd, &mut both, 7, nodes, ((&vectors, &fourth), alike));
            sums.extend(both.as_flattened());
            sums
        });
        let mut corners = NO_CORNERS;
        load_nodes(Simd::best(), &mut corners, nodes, &quads);
        let expected = quads[cells[5][2] as usize].vector();
        assert_eq!(corner(&corners, 5, 2), expected);
    }

    /// Each set of instructions says so in words of its own.
    #[test]
    #[should_panic]
    fn nodes_of_others_are_not_given_anything() {
        let mut sums = vec![Quad::default(); 3];
        let cells = [[5, 6, 7, 8]; LANES];
        let zero = Lane::of(0.0);
        let mut numbers = Numbers::default();
        cells.into_iter().for_each(|cell| numbers.push(cell));
        let nodes = numbers.tile(0);
        add_alike(Simd::best(), &mut sums, 5, nodes, [&zero, &zero]);
    }
}
