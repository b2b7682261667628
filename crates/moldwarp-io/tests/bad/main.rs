//! Wrong input: the files of `tests/bad/` at the repository's root, and what is said of each.
//!
//! A file dropped into one of its folders is a case. Its message, as a user sees it, is kept as a
//! snapshot beside it; a new one is written by
//!
//!     INSTA_UPDATE=always cargo test -p moldwarp-io --test bad
//!
//! Cases that turn out to be right have what is said of them then. All must come without a panic, and
//! with little memory: see [`memory`].

mod cases;
#[path = "../../../../fuzz/src/memory.rs"]
mod memory;
mod messages;
mod paths;
mod variants;
mod wordings;

#[global_allocator]
static MEMORY: memory::Bounded = memory::Bounded;
