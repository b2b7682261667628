//! Sweeps: one scene with several values. The runs themselves are made by who calls this.

mod folder;
mod names;
mod table;
mod values;

pub use folder::{Member, SweepFolder, members};
pub use table::{End, Table, extremes};
pub use values::Variation;

pub(crate) use names::safe;

use crate::output::Folder;
use std::path::PathBuf;

/// One run of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Its folder's name within the sweep's.
    pub folder: String,
    /// Its value of each variation, as the user wrote it.
    pub values: Vec<String>,
    /// The same as entries `PATH=VALUE`.
    pub varied: Vec<String>,
}

/// Every combination of the values, the last variation's changing fastest.
pub fn runs(variations: &[Variation]) -> Vec<Run> {
    let all = combinations(variations);
    let folders = names::names(variations, &all);
    let entry = |(v, value): (&Variation, &String)| format!("{}={value}", v.path);
    folders
        .into_iter()
        .zip(all)
        .map(|(folder, values)| Run {
            folder,
            varied: variations.iter().zip(&values).map(entry).collect(),
            values,
        })
        .collect()
}

fn combinations(variations: &[Variation]) -> Vec<Vec<String>> {
    variations.iter().fold(vec![Vec::new()], |all, variation| {
        let longer = |first: &Vec<String>| {
            let with = |value: &String| [&first[..], std::slice::from_ref(value)].concat();
            variation.values.iter().map(with).collect::<Vec<_>>()
        };
        all.iter().flat_map(longer).collect()
    })
}

/// Where a sweep goes unless another folder is named: `out/<case>-sweep`.
pub fn default_path(case: &str) -> PathBuf {
    Folder::default_path(&format!("{case}-sweep"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_variation_changes_fastest() {
        let entries = ["a.b=1,2".to_owned(), "c=[0,1],x".to_owned()];
        let runs = runs(&Variation::parse_all(&entries, &[]).unwrap());
        let varied: Vec<String> = runs.iter().map(|r| r.varied.join(" ")).collect();
        assert_eq!(
            varied,
            ["a.b=1 c=[0,1]", "a.b=1 c=x", "a.b=2 c=[0,1]", "a.b=2 c=x"]
        );
    }
}
