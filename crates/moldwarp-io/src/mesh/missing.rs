//! The mesh file that is not there: how to make it, or which one was meant.

use super::MeshFileError;
use std::path::Path;

/// `command` makes the mesh of a geometry beside it.
pub(super) fn error(path: &Path, command: fn(&Path) -> String) -> MeshFileError {
    let advice = if path.with_extension("geo").is_file() {
        format!("make it with `{}`", command(path))
    } else {
        neighbours(path)
    };
    MeshFileError::Missing {
        file: path.to_owned(),
        advice,
    }
}

/// The .msh files in the same folder, the most alike first.
fn neighbours(path: &Path) -> String {
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let Ok(entries) = folder.read_dir() else {
        return format!("there is no folder {}", folder.display());
    };
    let wanted = name(path);
    let mut names: Vec<(usize, String)> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|p| p.extension().is_some_and(|e| e == "msh"))
        .map(|p| (distance(&wanted, &name(&p)), name(&p)))
        .collect();
    names.sort();
    if names.is_empty() {
        return "neither is there a .geo of the same name to mesh, nor any .msh file beside it"
            .to_owned();
    }
    let nearest: Vec<String> = names
        .into_iter()
        .take(3)
        .map(|(_, name)| format!("`{name}`"))
        .collect();
    format!(
        "there is no .geo of the same name to mesh either; the folder has {}",
        nearest.join(", ")
    )
}

fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

/// Levenshtein's distance: letters to insert, delete or replace.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    #[test]
    fn distance_counts_letters() {
        assert_eq!(super::distance("column.msh", "colum.msh"), 1);
        assert_eq!(super::distance("", "abc"), 3);
        assert_eq!(super::distance("kitten", "sitting"), 3);
    }
}
