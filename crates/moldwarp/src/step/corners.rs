//! Nodal values of cells side by side: how they come from nodes and go to them.
//!
//! A node has four numbers together, which are loaded at once; a tile has each number of a corner in lanes. Between
//! them lies the transposition of four cells at a time, which compilers do not find: it is written with
//! AVX2 instructions where the processor has them. What is added has the same order with and without.

use crate::Vec3;
use crate::lanes::{LANES, Lane, Simd};

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
pub(super) fn sum_nodes(sums: &mut Lane, cells: &[[u32; 4]; LANES], numbers: &[f64]) {
    for (sum, cell) in sums.iter_mut().zip(cells) {
        *sum = cell.iter().map(|&n| numbers[n as usize]).sum();
    }
}

/// Copies vectors of the nodes of cells side by side.
pub(super) fn load_nodes(
    simd: Simd,
    corners: &mut Corners,
    cells: &[[u32; 4]; LANES],
    vectors: &[Quad],
) {
    #[cfg(target_arch = "x86_64")]
    if simd.has_avx2() {
        // SAFETY: the processor has the instructions.
        return unsafe { avx2::load_nodes(corners, None, cells, vectors) };
    }
    let _ = simd;
    load_plainly(corners, None, cells, vectors);
}

/// The same, and sums up their fourth numbers.
pub(super) fn load_and_sum(
    simd: Simd,
    corners: &mut Corners,
    sums: &mut Lane,
    cells: &[[u32; 4]; LANES],
    quads: &[Quad],
) {
    #[cfg(target_arch = "x86_64")]
    if simd.has_avx2() {
        // SAFETY: the processor has the instructions.
        return unsafe { avx2::load_nodes(corners, Some(sums), cells, quads) };
    }
    let _ = simd;
    load_plainly(corners, Some(sums), cells, quads);
}

fn load_plainly(
    corners: &mut Corners,
    mut sums: Option<&mut Lane>,
    cells: &[[u32; 4]; LANES],
    quads: &[Quad],
) {
    for (l, cell) in cells.iter().enumerate() {
        let mut sum = 0.0;
        for (i, &n) in cell.iter().enumerate() {
            set_corner(corners, l, i, quads[n as usize].vector());
            sum += quads[n as usize].0[3];
        }
        if let Some(sums) = &mut sums {
            sums[l] = sum;
        }
    }
}

/// Adds to numbers of nodes, of which those of node `first` come first: a vector and a number for each corner.
pub(super) fn add_corners(
    simd: Simd,
    to: &mut [Quad],
    first: usize,
    cells: &[[u32; 4]; LANES],
    vectors: &Corners,
    fourth: &[Lane; 4],
) {
    #[cfg(target_arch = "x86_64")]
    if simd.has_avx2() {
        // SAFETY: the processor has the instructions.
        return unsafe { avx2::add_corners(to, first, cells, vectors, fourth) };
    }
    let _ = simd;
    for (four, cells) in cells.as_chunks::<4>().0.iter().enumerate() {
        for i in 0..4 {
            for (j, cell) in cells.iter().enumerate() {
                let l = 4 * four + j;
                let [x, y, z] = corner(vectors, l, i).to_array();
                to[cell[i] as usize - first] += Quad([x, y, z, fourth[i][l]]);
            }
        }
    }
}

/// The same with two numbers that are alike for all corners, and perhaps one for each.
pub(super) fn add_alike(
    simd: Simd,
    to: &mut [Quad],
    first: usize,
    cells: &[[u32; 4]; LANES],
    [a, b]: [&Lane; 2],
    own: Option<&[Lane; 4]>,
) {
    #[cfg(target_arch = "x86_64")]
    if simd.has_avx2() {
        // SAFETY: the processor has the instructions.
        return unsafe { avx2::add_alike(to, first, cells, [a, b], own) };
    }
    let _ = simd;
    for (four, cells) in cells.as_chunks::<4>().0.iter().enumerate() {
        for i in 0..4 {
            for (j, cell) in cells.iter().enumerate() {
                let l = 4 * four + j;
                let own = own.map_or(0.0, |own| own[i][l]);
                to[cell[i] as usize - first] += Quad([a[l], b[l], own, 0.0]);
            }
        }
    }
}

/// Whether all nodes are among so many from the first one on.
#[inline(always)]
fn within(cells: &[[u32; 4]; LANES], from: usize, count: usize) -> bool {
    let (mut first, mut last) = ([u32::MAX; 16], [0; 16]);
    for group in cells.as_flattened().as_chunks::<16>().0 {
        for (k, &n) in group.iter().enumerate() {
            first[k] = first[k].min(n);
            last[k] = last[k].max(n);
        }
    }
    let first = first.into_iter().fold(u32::MAX, u32::min);
    let last = last.into_iter().fold(0, u32::max);
    first as usize >= from && last as usize - from < count
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::{Corners, LANES, Lane, Quad, within};
    use std::arch::x86_64::*;

    /// Rows to columns.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn transpose(a: __m256d, b: __m256d, c: __m256d, d: __m256d) -> [__m256d; 4] {
        let (ab, cd) = (_mm256_unpacklo_pd(a, b), _mm256_unpacklo_pd(c, d));
        let (ab_odd, cd_odd) = (_mm256_unpackhi_pd(a, b), _mm256_unpackhi_pd(c, d));
        [
            _mm256_permute2f128_pd::<0x20>(ab, cd),
            _mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd),
            _mm256_permute2f128_pd::<0x31>(ab, cd),
            _mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd),
        ]
    }

    /// Four lanes, beginning with `l`, which is a multiple of four.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn four(lane: &Lane, l: usize) -> __m256d {
        let four: &[f64; 4] = &lane.as_chunks::<4>().0[l / 4];
        // SAFETY: there are four.
        unsafe { _mm256_loadu_pd(four.as_ptr()) }
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn set_four(lane: &mut Lane, l: usize, four: __m256d) {
        let to: &mut [f64; 4] = &mut lane.as_chunks_mut::<4>().0[l / 4];
        // SAFETY: there are four.
        unsafe { _mm256_storeu_pd(to.as_mut_ptr(), four) }
    }

    #[target_feature(enable = "avx2")]
    pub fn load_nodes(
        corners: &mut Corners,
        mut sums: Option<&mut Lane>,
        cells: &[[u32; 4]; LANES],
        quads: &[Quad],
    ) {
        assert!(within(cells, 0, quads.len()));
        let from = quads.as_ptr().cast::<f64>();
        for (k, cells) in cells.as_chunks::<4>().0.iter().enumerate() {
            let mut sum = _mm256_setzero_pd();
            for i in 0..4 {
                // SAFETY: all nodes are there.
                let rows = unsafe {
                    [
                        _mm256_load_pd(from.add(4 * cells[0][i] as usize)),
                        _mm256_load_pd(from.add(4 * cells[1][i] as usize)),
                        _mm256_load_pd(from.add(4 * cells[2][i] as usize)),
                        _mm256_load_pd(from.add(4 * cells[3][i] as usize)),
                    ]
                };
                let [x, y, z, fourth] = transpose(rows[0], rows[1], rows[2], rows[3]);
                sum = _mm256_add_pd(sum, fourth);
                set_four(&mut corners[3 * i], 4 * k, x);
                set_four(&mut corners[3 * i + 1], 4 * k, y);
                set_four(&mut corners[3 * i + 2], 4 * k, z);
            }
            if let Some(sums) = &mut sums {
                set_four(sums, 4 * k, sum);
            }
        }
    }

    /// # Safety
    /// The node must be there.
    #[inline]
    #[target_feature(enable = "avx2")]
    unsafe fn add(to: &mut [Quad], at: usize, more: __m256d) {
        // SAFETY: the caller's.
        unsafe {
            let to = to.as_mut_ptr().add(at).cast::<f64>();
            _mm256_store_pd(to, _mm256_add_pd(_mm256_load_pd(to), more));
        }
    }

    #[target_feature(enable = "avx2")]
    pub fn add_corners(
        to: &mut [Quad],
        first: usize,
        cells: &[[u32; 4]; LANES],
        vectors: &Corners,
        fourth: &[Lane; 4],
    ) {
        assert!(within(cells, first, to.len()));
        for (k, cells) in cells.as_chunks::<4>().0.iter().enumerate() {
            for i in 0..4 {
                let [x, y, z] = [0, 1, 2].map(|c| four(&vectors[3 * i + c], 4 * k));
                let rows = transpose(x, y, z, four(&fourth[i], 4 * k));
                for j in 0..4 {
                    // SAFETY: all nodes are there.
                    unsafe { add(to, cells[j][i] as usize - first, rows[j]) };
                }
            }
        }
    }

    #[target_feature(enable = "avx2")]
    pub fn add_alike(
        to: &mut [Quad],
        first: usize,
        cells: &[[u32; 4]; LANES],
        [a, b]: [&Lane; 2],
        own: Option<&[Lane; 4]>,
    ) {
        assert!(within(cells, first, to.len()));
        let zero = _mm256_setzero_pd();
        for (k, cells) in cells.as_chunks::<4>().0.iter().enumerate() {
            let (a, b) = (four(a, 4 * k), four(b, 4 * k));
            let alike = transpose(a, b, zero, zero);
            for i in 0..4 {
                let rows = match own {
                    Some(own) => transpose(a, b, four(&own[i], 4 * k), zero),
                    None => alike,
                };
                for j in 0..4 {
                    // SAFETY: all nodes are there.
                    unsafe { add(to, cells[j][i] as usize - first, rows[j]) };
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells that share nodes, by what the instructions of this processor do and without them.
    #[test]
    fn instructions_change_no_bit() {
        let cells: [[u32; 4]; LANES] =
            std::array::from_fn(|l| std::array::from_fn(|i| 7 + ((l * 3 + i * 5) % 23) as u32));
        let number = |k: usize| (k as f64 * 0.37).sin();
        let quads: Vec<Quad> = (0..40)
            .map(|n| Quad(std::array::from_fn(|k| number(4 * n + k))))
            .collect();
        let plain = Simd::named("scalar").unwrap();
        let both = |work: &dyn Fn(Simd) -> Vec<Quad>| assert_eq!(work(plain), work(Simd::best()));
        both(&|simd| {
            let mut corners = NO_CORNERS;
            let mut sums = Lane::of(0.0);
            load_and_sum(simd, &mut corners, &mut sums, &cells, &quads);
            let vectors = (0..LANES).flat_map(|l| all_corners(&corners, l));
            let sums = sums.iter().map(|&sum| Quad([sum, 0.0, 0.0, 0.0]));
            vectors.map(Quad::from).chain(sums).collect()
        });
        let lane = |k: usize| Lane::from(std::array::from_fn(|l| number(100 * k + l)));
        let vectors: Corners = std::array::from_fn(lane);
        both(&|simd| {
            let mut sums = vec![Quad::default(); 23];
            let fourth = std::array::from_fn(|k| lane(k + 12));
            add_corners(simd, &mut sums, 7, &cells, &vectors, &fourth);
            add_alike(simd, &mut sums, 7, &cells, [&lane(20), &lane(21)], None);
            add_alike(
                simd,
                &mut sums,
                7,
                &cells,
                [&lane(22), &lane(23)],
                Some(&fourth),
            );
            sums
        });
        let mut corners = NO_CORNERS;
        load_nodes(Simd::best(), &mut corners, &cells, &quads);
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
        add_alike(Simd::best(), &mut sums, 5, &cells, [&zero, &zero], None);
    }
}
