//! What the scene format has a name for but this version cannot compute.

/// Keys, each with one that stands beside it: the same word elsewhere is just unknown.
const KEYS: [(&str, &str); 9] = [
    ("contacts", "gravity"),
    ("particle_spacing", "particles_per_element"),
    ("until", "duration"),
    ("on", "duration"),
    ("off", "duration"),
    ("add", "duration"),
    ("remove", "duration"),
    ("reset", "duration"),
    ("checkpoint_interval", "frames"),
];

/// Boundaries.
pub(super) const BOUNDARIES: [&str; 1] = ["outflow"];
/// What probes record.
pub(super) const QUANTITIES: [&str; 1] = ["penetration"];
/// Energies in the history.
pub(super) const ENERGIES: [&str; 3] = ["friction", "contact", "removed"];

/// Whether `key` is one of them where `siblings` are the keys that are known.
pub(super) fn key(key: &str, siblings: &[&str]) -> bool {
    KEYS.iter()
        .any(|&(name, beside)| name == key && siblings.contains(&beside))
}
