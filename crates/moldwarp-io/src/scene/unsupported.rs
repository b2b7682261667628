//! What the scene format has a name for but this version cannot compute.

/// Keys, each with one that stands beside it: the same word elsewhere is just unknown.
const KEYS: [(&str, &str); 0] = [];

/// Boundaries.
pub(super) const BOUNDARIES: [&str; 1] = ["outflow"];
/// What probes record.
pub(super) const QUANTITIES: [&str; 0] = [];

/// Whether `key` is one of them where `siblings` are the keys that are known.
pub(super) fn key(key: &str, siblings: &[&str]) -> bool {
    KEYS.iter()
        .any(|&(name, beside)| name == key && siblings.contains(&beside))
}

/// For the reference: all of these names, by what they are.
#[cfg(test)]
pub(crate) fn later() -> Vec<(String, Vec<&'static str>)> {
    let mut all: Vec<(String, Vec<&str>)> = Vec::new();
    for (name, beside) in KEYS {
        let what = format!("keys beside `{beside}`");
        match all.iter_mut().find(|known| known.0 == what) {
            Some(known) => known.1.push(name),
            None => all.push((what, vec![name])),
        }
    }
    all.push(("boundaries".to_owned(), BOUNDARIES.to_vec()));
    all.push(("quantities".to_owned(), QUANTITIES.to_vec()));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use moldwarp::plan::Quantity;

    /// What is supported by now must not be called unsupported.
    #[test]
    fn nothing_of_this_is_supported() {
        for table in crate::reference::keys_of_tables() {
            let known: Vec<&str> = table.iter().map(String::as_str).collect();
            let both = known.iter().find(|name| key(name, &known));
            assert_eq!(both, None, "a key that there is");
        }
        assert!(Quantity::ALL.iter().all(|q| !QUANTITIES.contains(&q.0)));
        let kinds = crate::reference::words("boundaries::Kind");
        assert!(
            kinds
                .iter()
                .all(|name| !BOUNDARIES.contains(&name.as_str()))
        );
    }
}
