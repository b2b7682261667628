//! With AVX2: four cells at a time.

use super::{Both, Corners, LANES, Lane, Quad, TileNodes};
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

/// The numbers of node `i` of each cell.
///
/// # Safety
/// All nodes must be there.
#[inline]
#[target_feature(enable = "avx2")]
pub unsafe fn corner(quads: *const f64, nodes: &[[u32; 4]; LANES], i: usize) -> [Lane; 4] {
    let mut lanes = [Lane::of(0.0); 4];
    for (k, nodes) in nodes.as_chunks::<4>().0.iter().enumerate() {
        // SAFETY: the caller's; there are eight places in a lane.
        unsafe {
            let row = |l: usize| _mm256_load_pd(quads.add(4 * nodes[l][i] as usize));
            let columns = transpose(row(0), row(1), row(2), row(3));
            for (lane, column) in lanes.iter_mut().zip(columns) {
                _mm256_store_pd(lane.as_mut_ptr().add(4 * k), column);
            }
        }
    }
    lanes
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
    nodes: TileNodes,
    vectors: &Corners,
    fourth: &[Lane; 4],
) {
    assert!(nodes.are_among(first, to.len()));
    for (k, cells) in nodes.as_chunks::<4>().0.iter().enumerate() {
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
pub fn add_alike(to: &mut [Quad], first: usize, nodes: TileNodes, [a, b]: [&Lane; 2]) {
    assert!(nodes.are_among(first, to.len()));
    let zero = _mm256_setzero_pd();
    for (k, cells) in nodes.as_chunks::<4>().0.iter().enumerate() {
        let rows = transpose(four(a, 4 * k), four(b, 4 * k), zero, zero);
        for i in 0..4 {
            for j in 0..4 {
                // SAFETY: all nodes are there.
                unsafe { add(to, cells[j][i] as usize - first, rows[j]) };
            }
        }
    }
}

/// Both quads of corner `i` of the `k`-th four cells.
#[inline]
#[target_feature(enable = "avx2")]
pub fn rows_of_both(
    ((vectors, fourth), ([a, b], third)): Both,
    k: usize,
    i: usize,
) -> ([__m256d; 4], [__m256d; 4]) {
    let four = |lane: &Lane| four(lane, 4 * k);
    let [x, y, z] = [0, 1, 2].map(|c| four(&vectors[3 * i + c]));
    let own = transpose(x, y, z, four(&fourth[i]));
    let alike = transpose(four(a), four(b), four(&third[i]), _mm256_setzero_pd());
    (own, alike)
}

#[target_feature(enable = "avx2")]
pub fn add_both(to: &mut [[Quad; 2]], first: usize, nodes: TileNodes, both: Both) {
    assert!(nodes.are_among(first, to.len()));
    let to = to.as_flattened_mut();
    for (k, cells) in nodes.as_chunks::<4>().0.iter().enumerate() {
        for i in 0..4 {
            let (own, alike) = rows_of_both(both, k, i);
            for j in 0..4 {
                let at = 2 * (cells[j][i] as usize - first);
                // SAFETY: all nodes are there, each with two.
                unsafe {
                    add(to, at, own[j]);
                    add(to, at + 1, alike[j]);
                }
            }
        }
    }
}
