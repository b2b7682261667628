//! `pictures.toml`.

use super::{Failure, root};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Pictures that are made together.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// From the repository's folder.
    pub files: Vec<String>,
    /// From the examples' folder; ` --set PATH=VALUE` may follow.
    pub scenes: Vec<String>,
    /// `PATH=V1,V2,…` if the scenes are swept.
    pub sweep: Option<String>,
    /// A tool and its arguments.
    pub make: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    pictures: Vec<Entry>,
}

/// All pictures, in the order of the list.
///
/// # Errors
///
/// If the list cannot be read.
pub fn entries() -> Result<Vec<Entry>, Failure> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("pictures.toml");
    let text = std::fs::read_to_string(&path)?;
    let list: List = toml::from_str(&text).map_err(|e| format!("pictures.toml: {e}"))?;
    Ok(list.pictures)
}

impl Entry {
    /// Whether a file or a scene has this in its name.
    pub fn is_called(&self, name: &str) -> bool {
        self.files
            .iter()
            .chain(&self.scenes)
            .any(|file| file.contains(name))
    }

    /// The folder of the first scene.
    pub(super) fn folder(&self) -> PathBuf {
        let file = file_and_sets(&self.scenes[0]).0;
        file.parent().map_or(file.clone(), Path::to_owned)
    }

    /// How it is made, in one line.
    pub fn command(&self) -> String {
        self.make.join(" ")
    }
}

/// The file of a scene as the list has it, and what is set in it.
pub fn file_and_sets(scene: &str) -> (PathBuf, Vec<String>) {
    let (file, sets) = match scene.split_once(" --set ") {
        Some((file, set)) => (file, vec![set.to_owned()]),
        None => (scene, Vec::new()),
    };
    (root().join("examples").join(file), sets)
}
