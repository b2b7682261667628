//! Fuzzing of the readers.
//!
//! Each target is one function, in [`targets`]. `cargo fuzz` calls it with what libfuzzer makes up;
//! without it, on stable Rust, the same binary calls it with files of the corpus `tests/bad/` that
//! [`mutate`] has changed, each made from the number of the case alone, so that a case can be run
//! again. A short run of the same is a test of moldwarp-io, which includes these files.

pub mod memory;
pub mod mutate;
pub mod runner;
pub mod targets;
