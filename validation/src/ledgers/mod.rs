//! The ledgers of all cases and examples in one table: does every run close its books, and how large are
//! its numerical terms?
//!
//! The table of runs is written after each case, and a case that is computed anew replaces its rows only,
//! so that every row names the commit that it comes from.

mod entry;
mod table;

pub use entry::{Entry, Kind, RESIDUAL_LIMIT, Watch, note};

use crate::made::commit;
use crate::{Fidelity, cases, setup};
use moldwarp_io::scene;
use std::path::{Path, PathBuf};
use std::time::Instant;
use table::Ledgers;

type Failure = Box<dyn std::error::Error>;

/// Examples and their scenes, as they are in the repository: whole, and whatever the fidelity of the
/// cases. What `fine.toml` needs is not in the repository, and scenes of sweeps have no one ledger.
const EXAMPLES: [(&str, &[&str]); 5] = [
    (
        "examples/absorbing-column",
        &["scene.toml", "dashpot.toml", "rigid.toml"],
    ),
    ("examples/slope", &["scene.toml"]),
    ("examples/tunnel-face", &["scene.toml", "stand.toml"]),
    ("examples/drop-anchor", &["scene.toml"]),
    ("examples/dynamic-probing", &["scene.toml"]),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Names of cases and examples, in the order of the table.
fn names() -> impl Iterator<Item = &'static str> {
    let cases = cases::ALL.iter().map(|c| c.name);
    cases.chain(EXAMPLES.iter().map(|e| e.0))
}

/// `[coarse|fine] [NAME]…`: computes the cases and examples of these names, all if there is none, and
/// writes the table. Returns whether all their ledgers keep the limits.
pub fn tabulate(arguments: &[String]) -> Result<bool, Failure> {
    let (fidelity, chosen) = match arguments.split_first() {
        Some((first, rest)) if first == "fine" => (Fidelity::Fine, rest),
        Some((first, rest)) if first == "coarse" => (Fidelity::Coarse, rest),
        _ => (Fidelity::Coarse, arguments),
    };
    if let Some(unknown) = chosen.iter().find(|c| !names().any(|n| n == *c)) {
        let all: Vec<_> = names().collect();
        return Err(format!("no ledgers of `{unknown}`; there are {}", all.join(", ")).into());
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("results")
        .join(fidelity.name());
    std::fs::create_dir_all(&folder)?;
    let (csv, page) = (folder.join("ledgers.csv"), folder.join("ledgers.md"));
    let order: Vec<_> = names().collect();
    let mut ledgers = Ledgers::read(&csv)?;
    let (commit, mut all_hold) = (commit(), true);
    for name in names().filter(|n| chosen.is_empty() || chosen.iter().any(|c| c == n)) {
        let start = Instant::now();
        let entries = compute(name, fidelity)?;
        println!("{name}: {:.1} s", start.elapsed().as_secs_f64());
        for entry in &entries {
            let mark = if entry.holds() { "ok  " } else { "OVER" };
            let percent = 100.0 * entry.numerical();
            let (residual, run) = (entry.residual, &entry.run);
            println!("  {mark} {percent:.3} %, residual {residual:.1e}: {run}");
        }
        all_hold &= entries.iter().all(Entry::holds);
        ledgers.replace(name, &entries, &commit, &order);
        std::fs::write(&csv, ledgers.csv())?;
        std::fs::write(&page, ledgers.markdown())?;
    }
    println!("{}\n{}", csv.display(), page.display());
    Ok(all_hold)
}

/// The ledgers of a case's or an example's runs.
fn compute(name: &str, fidelity: Fidelity) -> Result<Vec<Entry>, Failure> {
    entry::taken();
    if let Some(case) = cases::find(name) {
        (case.run)(fidelity);
    }
    for (folder, scenes) in EXAMPLES.iter().filter(|e| e.0 == name) {
        for file in *scenes {
            let mut plan = scene::load(&root().join(folder).join(file), &[])?.plan;
            plan.title = file.to_string();
            setup::run(plan, |_| {});
        }
    }
    Ok(entry::taken())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A case that is new has to be computed: `moldwarp-validation ledgers NAME`.
    #[test]
    fn the_committed_table_has_all_cases_and_is_made_of_the_committed_rows() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("results/coarse");
        let ledgers = Ledgers::read(&folder.join("ledgers.csv")).expect("ledgers.csv");
        assert!(names().eq(ledgers.cases()));
        let page = std::fs::read_to_string(folder.join("ledgers.md")).expect("ledgers.md");
        assert!(
            page == ledgers.markdown(),
            "ledgers.md is not of ledgers.csv"
        );
    }
}
