//! The name that was probably meant.

/// Least number of letters inserted, removed, replaced or swapped with their neighbour that
/// turns `a` into `b`.
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replace = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replace.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

/// Longer texts are no slips of names, bytes.
const LONGEST: usize = 200;

/// The name most like `wrong`, if one is like it at all. Case, `-` and `_` do not matter.
pub(crate) fn nearest<'a>(
    wrong: &str,
    names: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let plain = |name: &str| name.to_lowercase().replace('-', "_");
    // The distance takes time and memory in proportion to the product of lengths.
    let is_a_name = |name: &str| name.len() <= LONGEST;
    if !is_a_name(wrong) {
        return None;
    }
    let wrong = plain(wrong);
    names
        .into_iter()
        .filter(|name| is_a_name(name))
        .map(|name| (distance(&wrong, &plain(name)), name))
        .filter(|&(d, name)| d <= (name.chars().count().max(wrong.chars().count()) / 3).max(1))
        .min_by_key(|&(d, _)| d)
        .map(|(_, name)| name)
}

/// "did you mean …?" if something is near, and the names there are.
pub(crate) fn help<'a>(
    wrong: &str,
    what: &str,
    names: impl IntoIterator<Item = &'a str> + Clone,
) -> String {
    let list = list(names.clone());
    match (nearest(wrong, names), list.is_empty()) {
        (_, true) => format!("there are no {what}"),
        (Some(name), _) => format!("did you mean `{name}`? {what}: {list}"),
        (None, _) => format!("{what}: {list}"),
    }
}

/// `a`, `b`, `c`; no more than twenty of them.
pub(crate) fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<String> = names.into_iter().map(|n| format!("`{n}`")).collect();
    match names.get(20..) {
        Some(rest) if !rest.is_empty() => {
            format!("{} and {} more", names[..20].join(", "), rest.len())
        }
        _ => names.join(", "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_of_the_keyboard_are_one_apart() {
        for slip in ["botom", "bottoom", "bottim", "bototm"] {
            assert_eq!(distance(slip, "bottom"), 1, "{slip}");
        }
        assert_eq!(distance("", "abc"), 3);
    }

    #[test]
    fn only_a_like_name_is_proposed() {
        let names = ["x-min", "x-max", "z-max"];
        assert_eq!(nearest("zmax", names), Some("z-max"));
        assert_eq!(nearest("X_MIN", names), Some("x-min"));
        assert_eq!(nearest("bottom", names), None);
        let long = "x".repeat(10_000_000);
        assert_eq!(nearest(&long, [&*long]), None);
    }
}
