//! A short run of the fuzzing targets in `fuzz/`, and the corpus as it is.

#[path = "../../../../fuzz/src/memory.rs"]
mod memory;
#[path = "../../../../fuzz/src/mutate.rs"]
mod mutate;
#[path = "../../../../fuzz/src/runner.rs"]
#[allow(dead_code)] // its command line
mod runner;
#[path = "../../../../fuzz/src/targets.rs"]
mod targets;

use std::time::Duration;

#[global_allocator]
static MEMORY: memory::Bounded = memory::Bounded;

#[test]
fn the_corpus_is_read_without_a_panic() {
    for target in targets::ALL {
        let tally = runner::replay(target);
        // Checkpoints are made, not collected.
        let (cases, right) = match target.name {
            "checkpoint" => (1, 1),
            _ => (100, 10),
        };
        let enough = tally.cases >= cases && tally.right >= right;
        assert!(enough, "{}: {tally:?}", target.name);
    }
}

#[test]
fn changed_files_are_read_without_a_panic() {
    for target in targets::ALL {
        let limit = Duration::from_secs(60);
        let tally = runner::run(target, 0, 3000, limit).unwrap_or_else(|number| {
            let name = target.name;
            panic!(
                "case {number} of `{name}`: in fuzz/, cargo run --release --bin {name} 1 {number}"
            )
        });
        // A mutator that leaves nothing right would test the first line of each reader only.
        assert!(
            tally.cases == 3000 && tally.right >= 30,
            "{}: {tally:?}",
            target.name
        );
        assert!(
            tally.slowest.0 < Duration::from_secs(5),
            "{}: {tally:?}",
            target.name
        );
    }
}
