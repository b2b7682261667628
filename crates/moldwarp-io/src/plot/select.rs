//! Columns of a history by name, by the beginning of the name, or by a pattern.

use crate::scene::suggest;

/// Why there are no such columns.
#[derive(Clone, Debug, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum SelectError {
    #[error("the history has no column `{wanted}`")]
    #[diagnostic(help("{help}"))]
    Unknown { wanted: String, help: String },
    #[error("a name of a column is missing in `{0}`")]
    #[diagnostic(help(
        "columns are parted by single commas: `--what tip.displacement.z,tip.velocity.z`"
    ))]
    Nothing(String),
}

/// The columns that `wanted` names, each once, in the order in which they are named. An entry may be
/// several with commas between them; each is a name, the beginning of names up to a dot (`energy` is all
/// `energy.…`), or a pattern in which `*` stands for anything.
///
/// # Errors
///
/// If one names no column.
pub(super) fn select(wanted: &[String], columns: &[String]) -> Result<Vec<usize>, SelectError> {
    let mut found: Vec<usize> = Vec::new();
    for entry in wanted {
        for name in entry.split(',').map(str::trim) {
            if name.is_empty() {
                return Err(SelectError::Nothing(entry.clone()));
            }
            let named = one(name, columns);
            if named.is_empty() {
                return Err(unknown(name, columns));
            }
            for column in named {
                if !found.contains(&column) {
                    found.push(column);
                }
            }
        }
    }
    Ok(found)
}

fn one(name: &str, columns: &[String]) -> Vec<usize> {
    if let Some(exact) = columns.iter().position(|c| c == name) {
        return vec![exact];
    }
    let prefix = format!("{}.", name.trim_end_matches('.'));
    let wanted = |column: &str| match name.contains('*') {
        // What every history begins with, time and the like, is meant by its name only.
        true => column.contains('.') && matches(name, column),
        false => column.starts_with(&prefix),
    };
    let all = columns.iter().enumerate();
    all.filter(|(_, column)| wanted(column))
        .map(|(at, _)| at)
        .collect()
}

/// Whether a text is as a pattern says.
fn matches(pattern: &str, text: &str) -> bool {
    let mut parts = pattern.split('*');
    let Some(mut rest) = text.strip_prefix(parts.next().unwrap_or_default()) else {
        return false;
    };
    let parts: Vec<&str> = parts.collect();
    let Some((last, between)) = parts.split_last() else {
        return rest.is_empty();
    };
    for part in between {
        match rest.find(part) {
            Some(at) => rest = &rest[at + part.len()..],
            None => return false,
        }
    }
    rest.ends_with(last)
}

fn unknown(name: &str, columns: &[String]) -> SelectError {
    let list = suggest::list(columns.iter().map(String::as_str));
    let whole = columns.iter().map(String::as_str);
    let all: Vec<&str> = whole
        .chain(columns.iter().flat_map(|c| beginnings(c)))
        .collect();
    SelectError::Unknown {
        wanted: name.to_owned(),
        help: match suggest::nearest(name.trim_end_matches('.'), all) {
            Some(near) => format!("did you mean `{near}`? columns: {list}"),
            None => format!("columns: {list}"),
        },
    }
}

/// `a` and `a.b` of `a.b.c`.
fn beginnings(column: &str) -> impl Iterator<Item = &str> {
    column.match_indices('.').map(|(at, _)| &column[..at])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns() -> Vec<String> {
        let names = "time step tip.displacement.x tip.displacement.z tip.volume energy.kinetic energy.elastic";
        names.split(' ').map(str::to_owned).collect()
    }

    fn selected(wanted: &str) -> Result<Vec<String>, SelectError> {
        let columns = columns();
        let found = select(&[wanted.to_owned()], &columns)?;
        Ok(found.into_iter().map(|at| columns[at].clone()).collect())
    }

    #[test]
    fn names_beginnings_and_patterns() {
        let kinds = ["energy.kinetic", "energy.elastic"];
        for all in [
            "energy",
            "energy.",
            "energy.*",
            "en*",
            "energy.kinetic,energy",
        ] {
            assert_eq!(selected(all).unwrap(), kinds, "{all}");
        }
        assert_eq!(selected("tip.displacement").unwrap().len(), 2);
        assert_eq!(
            selected("*.z, time").unwrap(),
            ["tip.displacement.z", "time"]
        );
        assert_eq!(selected("*").unwrap().len(), 5);
        assert_eq!(selected("t*.v*").unwrap(), ["tip.volume"]);
        assert_eq!(selected("tip*x").unwrap(), ["tip.displacement.x"]);
    }

    #[test]
    fn what_is_no_column_gets_the_nearest_one() {
        let help = |wanted| match selected(wanted) {
            Err(SelectError::Unknown { help, .. }) => help,
            other => panic!("{other:?}"),
        };
        assert!(help("tip.displacment.z").starts_with("did you mean `tip.displacement.z`?"));
        assert!(help("enrgy").starts_with("did you mean `energy`?"));
        assert!(help("tip.displcement").starts_with("did you mean `tip.displacement`?"));
        assert!(help("pressure").starts_with("columns: `time`, "));
        assert!(help("energ").contains("energy"));
        assert!(matches!(
            selected("time,,step"),
            Err(SelectError::Nothing(_))
        ));
    }
}
