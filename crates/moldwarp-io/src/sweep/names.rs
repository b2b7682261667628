//! Names of the runs' folders: readable, and possible on every file system.

use super::values::Variation;
use std::collections::HashSet;

/// A name is cut off here; file systems take 255 bytes, and paths may have an end, too.
const LONGEST: usize = 100;

/// A name for each run, of the values it has of the variations: `courant-0.3_cohesion-5-kPa`.
pub(super) fn names(variations: &[Variation], runs: &[Vec<String>]) -> Vec<String> {
    let keys: Vec<String> = variations.iter().map(|v| key(v, variations)).collect();
    let mut taken = HashSet::new();
    runs.iter()
        .map(|values| {
            let parts = keys.iter().zip(values);
            let parts: Vec<String> = parts.map(|(k, v)| format!("{k}-{}", safe(v))).collect();
            let mut name = parts.join("_");
            name.truncate(LONGEST);
            unique(name.trim_end_matches(['.', '-']), &mut taken)
        })
        .collect()
}

/// The path's last key if it tells the variations apart, else all of them.
fn key(variation: &Variation, all: &[Variation]) -> String {
    let last = variation.keys.last();
    match all.iter().filter(|v| v.keys.last() == last).count() {
        1 => safe(last.map_or("", String::as_str)),
        _ => safe(&variation.keys.join(".")),
    }
}

/// Letters, digits, `.`, `_` and signs stay, all between them becomes one `-`. So a negative number
/// keeps its sign: `gravity-0-0--9.81`.
pub(crate) fn safe(text: &str) -> String {
    let mut safe = String::new();
    let mut gap = false;
    for c in text.chars() {
        if !(c.is_ascii_alphanumeric() || "._-".contains(c)) {
            gap = true;
            continue;
        }
        if std::mem::take(&mut gap) && !safe.is_empty() {
            safe.push('-');
        }
        safe.push(c);
    }
    match safe.trim_end_matches(['.', '-']) {
        "" => "empty".to_owned(),
        rest => rest.to_owned(),
    }
}

/// With a number behind it if the name is taken. Some file systems do not tell `m` from `M`.
fn unique(name: &str, taken: &mut HashSet<String>) -> String {
    let numbered = (2..).map(|n| format!("{name}-{n}"));
    std::iter::once(name.to_owned())
        .chain(numbered)
        .find(|name| taken.insert(name.to_lowercase()))
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(entries: &[&str]) -> Vec<String> {
        let entries: Vec<String> = entries.iter().map(|&e| e.to_owned()).collect();
        let variations = Variation::parse_all(&entries, &[]).unwrap();
        names(&variations, &super::super::combinations(&variations))
    }

    #[test]
    fn names_can_be_read() {
        assert_eq!(
            all(&[
                "materials.soil.friction_angle=20 deg,\"30 deg\"",
                "numerics.courant=0.3"
            ]),
            [
                "friction_angle-20-deg_courant-0.3",
                "friction_angle-30-deg_courant-0.3"
            ]
        );
        assert_eq!(
            all(&["gravity=[0, 0, -9.81],[\"0 m/s2\", 0, 1.62]"]),
            ["gravity-0-0--9.81", "gravity-0-m-s2-0-1.62"]
        );
        assert_eq!(
            all(&["materials.a.cohesion=1", "materials.b.cohesion=2"]),
            ["materials.a.cohesion-1_materials.b.cohesion-2"]
        );
    }

    #[test]
    fn names_are_apart_on_every_file_system() {
        assert_eq!(all(&["e=5 mPa,5 MPa"]), ["e-5-mPa", "e-5-MPa-2"]);
        assert_eq!(all(&["e=\"\",\"°\""]), ["e-empty", "e-empty-2"]);
        let (a, b) = ("x".repeat(200), format!("{}y", "x".repeat(200)));
        let long = all(&[&format!("e={a},{b}")]);
        assert_ne!(long[0], long[1]);
        assert!(long.iter().all(|name| name.len() < 110));
        assert!(
            all(&["e=../../x,C:\\y"])
                .iter()
                .all(|n| !n.contains(['/', '\\', ':']))
        );
    }
}
