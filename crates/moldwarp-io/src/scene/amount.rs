//! The shapes of values in a scene, each with its place in the text.

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;
use std::ops::Range;

pub(super) use toml::Spanned;

/// A number as written: bare, or a text with its unit.
#[derive(Clone, Debug)]
pub(super) enum Amount {
    Number(f64),
    Text(String),
}

/// Three amounts, if the user wrote three.
pub(super) type RawVector = Spanned<Vec<Spanned<Amount>>>;

/// One value or a list of values.
#[derive(Clone, Debug)]
pub(super) enum OneOrMany<T> {
    One(T),
    Many(Vec<Spanned<T>>),
}

/// A table whose keys are names, in the order of the text.
#[derive(Clone, Debug)]
pub(super) struct Named<T>(pub Vec<(Spanned<String>, T)>);

/// An amount, or a table that says how to come by it.
#[derive(Clone, Debug)]
pub(super) enum AmountOr<T> {
    Amount(Amount),
    Table(T),
}

/// `true`, `false` or a word between the two.
#[derive(Clone, Debug)]
pub(super) struct Switch(pub String);

/// The values with their places; that of a single one is the whole value's.
pub(super) fn each<T>(values: &Spanned<OneOrMany<T>>) -> Vec<(Range<usize>, &T)> {
    match values.get_ref() {
        OneOrMany::One(one) => vec![(values.span(), one)],
        OneOrMany::Many(many) => many.iter().map(|v| (v.span(), v.get_ref())).collect(),
    }
}

impl<T> Default for Named<T> {
    fn default() -> Named<T> {
        Named(Vec::new())
    }
}

impl<'de> Deserialize<'de> for Amount {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Amount, D::Error> {
        struct Numbers;
        impl Visitor<'_> for Numbers {
            type Value = Amount;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number or a text with a unit, such as \"100 kPa\"")
            }

            fn visit_i64<E>(self, v: i64) -> Result<Amount, E> {
                Ok(Amount::Number(v as f64))
            }

            fn visit_f64<E>(self, v: f64) -> Result<Amount, E> {
                Ok(Amount::Number(v))
            }

            fn visit_str<E>(self, v: &str) -> Result<Amount, E> {
                Ok(Amount::Text(v.to_owned()))
            }
        }
        deserializer.deserialize_any(Numbers)
    }
}

impl<'de> Deserialize<'de> for Switch {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Switch, D::Error> {
        struct Words;
        impl Visitor<'_> for Words {
            type Value = Switch;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("true, false or a word")
            }

            fn visit_bool<E>(self, v: bool) -> Result<Switch, E> {
                Ok(Switch(v.to_string()))
            }

            fn visit_str<E>(self, v: &str) -> Result<Switch, E> {
                Ok(Switch(v.to_owned()))
            }
        }
        deserializer.deserialize_any(Words)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for AmountOr<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<AmountOr<T>, D::Error> {
        struct Either<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Either<T> {
            type Value = AmountOr<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, a text with a unit, or a table")
            }

            fn visit_i64<E>(self, v: i64) -> Result<AmountOr<T>, E> {
                Ok(AmountOr::Amount(Amount::Number(v as f64)))
            }

            fn visit_f64<E>(self, v: f64) -> Result<AmountOr<T>, E> {
                Ok(AmountOr::Amount(Amount::Number(v)))
            }

            fn visit_str<E>(self, v: &str) -> Result<AmountOr<T>, E> {
                Ok(AmountOr::Amount(Amount::Text(v.to_owned())))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<AmountOr<T>, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(AmountOr::Table)
            }
        }
        deserializer.deserialize_any(Either(PhantomData))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OneOrMany<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<OneOrMany<T>, D::Error> {
        struct Both<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Both<T> {
            type Value = OneOrMany<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("one value or a list of values")
            }

            fn visit_i64<E: serde::de::Error>(self, v: i64) -> Result<OneOrMany<T>, E> {
                T::deserialize(v.into_deserializer()).map(OneOrMany::One)
            }

            fn visit_f64<E: serde::de::Error>(self, v: f64) -> Result<OneOrMany<T>, E> {
                T::deserialize(v.into_deserializer()).map(OneOrMany::One)
            }

            fn visit_str<E: serde::de::Error>(self, v: &str) -> Result<OneOrMany<T>, E> {
                T::deserialize(v.into_deserializer()).map(OneOrMany::One)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<OneOrMany<T>, A::Error> {
                let mut many = Vec::new();
                while let Some(value) = seq.next_element()? {
                    many.push(value);
                }
                Ok(OneOrMany::Many(many))
            }
        }
        deserializer.deserialize_any(Both(PhantomData))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Named<T>, D::Error> {
        struct Entries<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = Named<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a table with a name for each entry")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
                let mut entries: Vec<(Spanned<String>, T)> = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                entries.sort_by_key(|(name, _)| name.span().start);
                Ok(Named(entries))
            }
        }
        deserializer.deserialize_map(Entries(PhantomData))
    }
}
