//! Checks that many parts of a scene share: numbers in range, names that exist, keys that
//! exclude each other.

use super::amount::{Amount, RawVector, Spanned};
use super::error::Fault;
use super::quantity::{self, Dimension};
use super::raw::{RawAmount, Text};
use super::suggest;
use moldwarp::Vec3;
use std::ops::Range;

/// A finite number in SI. `key` is what the user calls it.
pub(super) fn amount(key: &str, raw: &RawAmount, dimension: Dimension) -> Result<f64, Fault> {
    amount_at(key, raw.span(), raw.get_ref(), dimension)
}

pub(super) fn amount_at(
    key: &str,
    span: Range<usize>,
    amount: &Amount,
    dimension: Dimension,
) -> Result<f64, Fault> {
    match amount {
        Amount::Number(n) if n.is_finite() => Ok(*n),
        Amount::Number(n) => Err(Fault::new(format!("`{key}` must be finite"))
            .at(span, format!("is {n}"))
            .help(dimension.example())),
        Amount::Text(text) => quantity::parse(text, dimension).map_err(|error| {
            Fault::new(format!("`{key}`: {error}"))
                .at(span, format!("should be {}", dimension.name()))
                .help(error.help())
                .caused_by(error)
        }),
    }
}

/// Greater than zero.
pub(super) fn positive(key: &str, raw: &RawAmount, dimension: Dimension) -> Result<f64, Fault> {
    let value = amount(key, raw, dimension)?;
    if value > 0.0 {
        return Ok(value);
    }
    Err(Fault::new(format!("`{key}` must be greater than zero"))
        .at(raw.span(), if value < 0.0 { "negative" } else { "zero" })
        .help(dimension.example()))
}

/// Zero or greater.
pub(super) fn not_negative(key: &str, raw: &RawAmount, dimension: Dimension) -> Result<f64, Fault> {
    let value = amount(key, raw, dimension)?;
    if value >= 0.0 {
        return Ok(value);
    }
    Err(Fault::new(format!("`{key}` must not be negative"))
        .at(raw.span(), "negative")
        .help(match dimension {
            Dimension::Length => dimension.example(),
            _ => "0 switches it off".to_owned(),
        }))
}

/// A local damping factor, in [0, 1).
pub(super) fn damping(raw: &RawAmount) -> Result<f64, Fault> {
    let value = amount("damping", raw, Dimension::Number)?;
    if (0.0..1.0).contains(&value) {
        return Ok(value);
    }
    Err(Fault::new("`damping` must be at least 0 and less than 1")
        .at(raw.span(), "outside [0, 1)")
        .help("0 is none, 0.05 is slight, 0.7 is common on the way to an equilibrium"))
}

/// x, y, z in SI.
pub(super) fn vector(key: &str, raw: &RawVector, dimension: Dimension) -> Result<Vec3, Fault> {
    let mut v = Vec3::ZERO;
    for (i, entry) in three(key, raw)?.iter().enumerate() {
        v[i] = amount(key, entry, dimension)?;
    }
    Ok(v)
}

/// The list, if it has three entries.
pub(super) fn three<'a, T>(
    key: &str,
    list: &'a Spanned<Vec<Spanned<T>>>,
) -> Result<&'a [Spanned<T>; 3], Fault> {
    let entries = list.get_ref();
    entries.as_slice().try_into().map_err(|_| {
        Fault::new(format!("`{key}` needs three entries: x, y, z"))
            .at(list.span(), format!("has {}", entries.len()))
            .help("write all three, also those that are zero")
    })
}

/// A whole number, `least` or greater.
pub(super) fn count(key: &str, raw: &Spanned<i64>, least: u32) -> Result<u64, Fault> {
    match u64::try_from(*raw.get_ref()) {
        Ok(n) if n >= u64::from(least) => Ok(n),
        _ => Err(Fault::new(format!("`{key}` must be at least {least}"))
            .at(raw.span(), format!("less than {least}"))),
    }
}

/// Which of the names this is. `what` names one of them, `all` introduces their list.
pub(super) fn find<'a>(
    (span, name): (Range<usize>, &str),
    what: &str,
    all: &str,
    names: impl IntoIterator<Item = &'a str> + Clone,
) -> Result<usize, Fault> {
    let position = names.clone().into_iter().position(|n| n == name);
    position.ok_or_else(|| {
        Fault::new(format!("there is no {what} `{name}`"))
            .at(span, format!("no such {what}"))
            .help(suggest::help(name, all, names))
    })
}

/// The meaning of a word. `later` are words that will mean something in a later version.
pub(super) fn choose<T: Copy>(
    (span, word): (Range<usize>, &str),
    what: &str,
    choices: &[(&'static str, T)],
) -> Result<T, Fault> {
    if let Some(choice) = choices.iter().find(|c| c.0 == word) {
        return Ok(choice.1);
    }
    let words = choices.iter().map(|c| c.0);
    Err(Fault::new(format!("there is no {what} `{word}`"))
        .at(span, format!("no such {what}"))
        .help(suggest::help(word, "what there is", words)))
}

/// Refuses a name that cannot be part of a column's name in a CSV file.
pub(super) fn fits_a_column(what: &str, name: &Text) -> Result<(), Fault> {
    let text = name.get_ref();
    if text.is_empty() || text.contains(['.', ',', '"', '\n', '\r']) {
        return Err(
            Fault::new(format!("a {what}'s name becomes part of a column's name"))
                .at(
                    name.span(),
                    "is empty, or has a dot, comma, quote or line break",
                )
                .help("use letters, digits, `-` and `_`"),
        );
    }
    Ok(())
}

/// The text with its place.
pub(super) fn placed(text: &Text) -> (Range<usize>, &str) {
    (text.span(), text.get_ref())
}

/// Where an optional value stands.
pub(super) fn span<T>(value: &Option<Spanned<T>>) -> Option<Range<usize>> {
    value.as_ref().map(Spanned::span)
}

/// Keys with their places in the text, where they are there.
pub(super) type Keys<'a> = [(&'a str, Option<Range<usize>>)];

/// Refuses more than one of these keys.
pub(super) fn at_most_one(keys: &Keys) -> Result<(), Fault> {
    let given: Vec<_> = keys.iter().filter(|k| k.1.is_some()).collect();
    if given.len() < 2 {
        return Ok(());
    }
    let list = suggest::list(given.iter().map(|k| k.0));
    let mut fault = Fault::new(format!("{list} exclude each other")).help("keep one of them");
    for (name, span) in given {
        fault = fault.at(span.clone().unwrap_or_default(), format!("`{name}`"));
    }
    Err(fault)
}

/// Refuses none and more than one of these keys. `owner` is who needs it.
pub(super) fn exactly_one(owner: (Range<usize>, &str), keys: &Keys) -> Result<(), Fault> {
    at_most_one(keys)?;
    if keys.iter().any(|k| k.1.is_some()) {
        return Ok(());
    }
    let list = suggest::list(keys.iter().map(|k| k.0));
    Err(Fault::new(format!("{} needs one of {list}", owner.1))
        .at(owner.0, "none is given")
        .help("add one of them"))
}

/// Refuses keys that mean nothing where `kind` was chosen.
pub(super) fn foreign(kind: &Text, keys: &Keys) -> Result<(), Fault> {
    for (name, span) in keys {
        if let Some(span) = span {
            let kind_name = kind.get_ref();
            return Err(
                Fault::new(format!("`{name}` means nothing for kind `{kind_name}`"))
                    .at(span.clone(), "does not belong here")
                    .at(kind.span(), "to this kind")
                    .help(format!("remove `{name}`, or choose another kind")),
            );
        }
    }
    Ok(())
}

/// The value of a key that its owner cannot do without.
pub(super) fn required<'a, T>(
    owner: (Range<usize>, &str),
    key: &str,
    value: &'a Option<T>,
    example: &str,
) -> Result<&'a T, Fault> {
    value.as_ref().ok_or_else(|| {
        Fault::new(format!("{} needs `{key}`", owner.1))
            .at(owner.0, format!("`{key}` is missing"))
            .help(format!("for example {key} = {example}"))
    })
}
