//! With AVX-512: eight cells at a time.

use super::avx2::rows_of_both;
use super::{Both, LANES, Lane, Quad, TileNodes};
use std::arch::x86_64::*;

/// The numbers of node `i` of each cell.
///
/// # Safety
/// All nodes must be there.
#[inline]
#[target_feature(enable = "avx512f")]
pub unsafe fn corner(quads: *const f64, nodes: &[[u32; 4]; LANES], i: usize) -> [Lane; 4] {
    // SAFETY: the caller's; a lane has eight numbers.
    unsafe {
        let row = |l: usize| _mm256_load_pd(quads.add(4 * nodes[l][i] as usize));
        // Of cells l and l + 2: halves are interleaved with those of the next cells, and then put side by side.
        let two = |l: usize| _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(row(l)), row(l + 2));
        let (a, b, c, d) = (two(0), two(1), two(4), two(5));
        let (low, low_next) = (_mm512_unpacklo_pd(a, b), _mm512_unpacklo_pd(c, d));
        let (high, high_next) = (_mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d));
        let columns = [
            _mm512_shuffle_f64x2::<0b10_00_10_00>(low, low_next),
            _mm512_shuffle_f64x2::<0b10_00_10_00>(high, high_next),
            _mm512_shuffle_f64x2::<0b11_01_11_01>(low, low_next),
            _mm512_shuffle_f64x2::<0b11_01_11_01>(high, high_next),
        ];
        let mut lanes = [Lane::of(0.0); 4];
        for (lane, column) in lanes.iter_mut().zip(columns) {
            _mm512_store_pd(lane.as_mut_ptr(), column);
        }
        lanes
    }
}

/// Stores the first numbers of a lane.
///
/// # Safety
/// There must be room for them.
#[inline]
#[target_feature(enable = "avx512f")]
pub unsafe fn store(to: *mut f64, lane: Lane, count: usize) {
    // SAFETY: the caller's.
    unsafe {
        let eight = _mm512_load_pd(lane.as_ptr());
        if count == LANES {
            _mm512_storeu_pd(to, eight);
        } else {
            _mm512_mask_storeu_pd(to, ((1u32 << count) - 1) as u8, eight);
        }
    }
}

/// With both quads of a node at a time.
#[target_feature(enable = "avx2,avx512f")]
pub fn add_both(to: &mut [[Quad; 2]], first: usize, nodes: TileNodes, both: Both) {
    assert!(nodes.are_among(first, to.len()));
    for (k, cells) in nodes.as_chunks::<4>().0.iter().enumerate() {
        for i in 0..4 {
            let (own, alike) = rows_of_both(both, k, i);
            for j in 0..4 {
                let more = _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(own[j]), alike[j]);
                // SAFETY: all nodes are there, each with eight numbers.
                unsafe {
                    let to = to.as_mut_ptr().add(cells[j][i] as usize - first);
                    let to = to.cast::<f64>();
                    _mm512_storeu_pd(to, _mm512_add_pd(_mm512_loadu_pd(to), more));
                }
            }
        }
    }
}
