//! Comparisons of moldwarp with exact solutions.
pub mod exact;
