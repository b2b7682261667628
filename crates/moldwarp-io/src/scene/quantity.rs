//! Numbers with units, read into SI: "100 kPa", "18 kN/m3", "0 1/s".

use super::suggest;
use super::units::{self, Exponents};

/// What kind of quantity is expected somewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    Number,
    Length,
    Time,
    Mass,
    Force,
    Stress,
    UnitWeight,
    Density,
    Velocity,
    Acceleration,
    Rate,
    Angle,
}

/// Dimension, its name, exponents of length, mass, time, angle, an example and its units.
const DIMENSIONS: [(Dimension, &str, Exponents, &str, &str); 12] = {
    use Dimension::*;
    [
        (Number, "a number without unit", [0, 0, 0, 0], "0.3", ""),
        (Length, "a length", [1, 0, 0, 0], "0.5 m", "m, cm, mm"),
        (Time, "a time", [0, 0, 1, 0], "2 s", "s, ms, min, h"),
        (Mass, "a mass", [0, 1, 0, 0], "20 kg", "kg, t"),
        (Force, "a force", [1, 1, -2, 0], "5 kN", "N, kN, MN"),
        (
            Stress,
            "a stress",
            [-1, 1, -2, 0],
            "100 kPa",
            "Pa, kPa, MPa, GPa, kN/m2",
        ),
        (
            UnitWeight,
            "a unit weight",
            [-2, 1, -2, 0],
            "18 kN/m3",
            "N/m3, kN/m3",
        ),
        (
            Density,
            "a density",
            [-3, 1, 0, 0],
            "1800 kg/m3",
            "kg/m3, t/m3",
        ),
        (
            Velocity,
            "a velocity",
            [1, 0, -1, 0],
            "0.2 m/s",
            "m/s, cm/s, mm/min",
        ),
        (
            Acceleration,
            "an acceleration",
            [1, 0, -2, 0],
            "-9.81 m/s2",
            "m/s2",
        ),
        (Rate, "a rate", [0, 0, -1, 0], "10 1/s", "1/s, 1/ms"),
        (Angle, "an angle", [0, 0, 0, 1], "30 deg", "deg, rad"),
    ]
};

/// What is wrong with a quantity.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum QuantityError {
    #[error("expected {}, found the text \"{text}\"", .expected.name())]
    NotANumber { text: String, expected: Dimension },
    #[error("\"{text}\" has no unit")]
    NoUnit { text: String, expected: Dimension },
    #[error("`{part}` is not a unit")]
    NotAUnit { part: String, expected: Dimension },
    /// Decimals behind a comma, or thousands before it.
    #[error("\"{text}\" has a comma")]
    Comma { text: String, expected: Dimension },
    #[error("a sign has no unit behind it")]
    SignWithoutUnit { expected: Dimension },
    #[error("expected {}, found {found} (\"{text}\")", .expected.name())]
    WrongDimension {
        text: String,
        /// With its article: "a length".
        found: String,
        expected: Dimension,
    },
    #[error("\"{text}\" is too large")]
    TooLarge { text: String, expected: Dimension },
}

impl QuantityError {
    /// What to write instead.
    pub fn help(&self) -> String {
        match self {
            QuantityError::NotANumber { expected, .. }
            | QuantityError::NoUnit { expected, .. }
            | QuantityError::SignWithoutUnit { expected }
            | QuantityError::WrongDimension { expected, .. }
            | QuantityError::TooLarge { expected, .. } => expected.example(),
            QuantityError::Comma { expected, .. } => format!(
                "decimals stand behind a point, as in 1.5, and thousands are not parted; {}",
                expected.example()
            ),
            QuantityError::NotAUnit { part, expected } => {
                let letters = part.trim_end_matches(|c: char| !c.is_alphabetic());
                let near = suggest::nearest(letters, units::names());
                match near.filter(|_| !letters.is_empty()) {
                    Some(near) => format!("did you mean `{near}`? {}", expected.example()),
                    None => expected.example(),
                }
            }
        }
    }
}

impl Dimension {
    fn row(
        self,
    ) -> &'static (
        Dimension,
        &'static str,
        Exponents,
        &'static str,
        &'static str,
    ) {
        // The table is in the order of the variants.
        &DIMENSIONS[self as usize]
    }

    /// With its article: "a stress".
    pub fn name(self) -> &'static str {
        self.row().1
    }

    /// How such a quantity is written.
    pub fn example(self) -> String {
        match self {
            Dimension::Number => "write a bare number such as 0.3".to_owned(),
            _ => format!(
                "write {} as \"{}\"; units that fit: {}; a bare number is in SI",
                self.name(),
                self.row().3,
                self.row().4
            ),
        }
    }
}

/// A dimension in the words of the reference.
#[cfg(test)]
pub(crate) struct Described {
    /// Without an article.
    pub name: &'static str,
    pub units: &'static str,
    pub example: &'static str,
}

/// All dimensions that have units.
#[cfg(test)]
pub(crate) fn dimensions() -> impl Iterator<Item = Described> {
    let with_units = DIMENSIONS.iter().filter(|d| !d.4.is_empty());
    with_units.map(|d| Described {
        name: d.1.split_once(' ').map_or(d.1, |article| article.1),
        units: d.4,
        example: d.3,
    })
}

/// The number in SI units.
///
/// # Errors
///
/// A text that is no number, or has another unit than one of `expected`.
pub fn parse(text: &str, expected: Dimension) -> Result<f64, QuantityError> {
    use QuantityError::*;
    let written = text.trim();
    let text = written.to_owned();
    let Some((number, unit)) = leading_number(written) else {
        return Err(NotANumber { text, expected });
    };
    if unit.is_empty() && expected != Dimension::Number {
        return Err(NoUnit { text, expected });
    }
    if unit.starts_with(',') {
        return Err(Comma { text, expected });
    }
    let (factor, exponents) = units::parse(unit).map_err(|part| match part {
        "" => SignWithoutUnit { expected },
        part => NotAUnit {
            part: part.to_owned(),
            expected,
        },
    })?;
    if exponents != expected.row().2 {
        return Err(WrongDimension {
            text,
            found: describe(exponents),
            expected,
        });
    }
    match factor.apply(number) {
        value if value.is_finite() => Ok(value),
        _ => Err(TooLarge { text, expected }),
    }
}

fn describe(exponents: Exponents) -> String {
    match DIMENSIONS.iter().find(|d| d.2 == exponents) {
        Some(d) => d.1.to_owned(),
        None => {
            let powers: Vec<String> = ["m", "kg", "s", "rad"]
                .iter()
                .zip(exponents)
                .filter(|p| p.1 != 0)
                .map(|(unit, power)| match power {
                    1 => unit.to_string(),
                    _ => format!("{unit}^{power}"),
                })
                .collect();
            format!("a quantity in {}", powers.join("·"))
        }
    }
}

/// The number that a text begins with, and the rest. An `e` belongs to the number only if an
/// exponent follows; the minus sign may be the typographic one.
fn leading_number(text: &str) -> Option<(f64, &str)> {
    let digits = |s: &str| s.len() - s.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let sign = |s: &str| match s.chars().next() {
        Some(c @ ('+' | '-' | '−')) => c.len_utf8(),
        _ => 0,
    };
    let mut end = sign(text);
    end += digits(&text[end..]);
    if text[end..].starts_with('.') {
        end += 1 + digits(&text[end + 1..]);
    }
    if text[end..].starts_with(['e', 'E']) {
        let signed = end + 1 + sign(&text[end + 1..]);
        match digits(&text[signed..]) {
            0 => {}
            n => end = signed + n,
        }
    }
    let number: f64 = text[..end].replace('−', "-").parse().ok()?;
    Some((number, text[end..].trim_start()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use Dimension::*;

    #[test]
    fn the_table_is_in_the_order_of_the_variants() {
        for (i, row) in DIMENSIONS.iter().enumerate() {
            assert_eq!(row.0 as usize, i);
            if row.0 != Number {
                assert!(parse(row.3, row.0).is_ok(), "{}", row.3);
            }
            for unit in row.4.split(", ").filter(|u| !u.is_empty()) {
                assert!(parse(&format!("1 {unit}"), row.0).is_ok(), "{unit}");
            }
        }
    }

    #[test]
    fn quantities_become_si() {
        for (text, dimension, expected) in [
            ("100 kPa", Stress, 1e5),
            ("1e3 kPa", Stress, 1e6),
            ("1e3kPa", Stress, 1e6),
            ("2.5E-3 GPa", Stress, 2.5e6),
            ("-1 kPa", Stress, -1e3),
            ("−1 kPa", Stress, -1e3),
            ("1e−3 MPa", Stress, 1e3),
            ("+.5 m", Length, 0.5),
            ("3. m", Length, 3.0),
            ("30cm", Length, 0.3),
            ("7 mm", Length, 0.007),
            ("18 kN/m3", UnitWeight, 18e3),
            ("18 kN/m^3", UnitWeight, 18e3),
            ("18kN/m³", UnitWeight, 18e3),
            ("2.65 t/m3", Density, 2650.0),
            ("0.2 ms", Time, 0.0002),
            ("5 min", Time, 300.0),
            ("1 h", Time, 3600.0),
            ("9.81 m/s²", Acceleration, 9.81),
            ("0 1/s", Rate, 0.0),
            ("4/s", Rate, 4.0),
            ("180 deg", Angle, std::f64::consts::PI),
            ("1 rad", Angle, 1.0),
            ("3 MN", Force, 3e6),
            ("0.25", Number, 0.25),
        ] {
            assert_eq!(parse(text, dimension), Ok(expected), "{text}");
        }
    }

    #[test]
    fn what_does_not_fit_is_named() {
        for (text, message) in [
            ("2 m", "expected a stress, found a length (\"2 m\")"),
            (
                "2 kg/m",
                "expected a stress, found a quantity in m^-1·kg (\"2 kg/m\")",
            ),
            ("kPa", "expected a stress, found the text \"kPa\""),
            ("", "expected a stress, found the text \"\""),
            ("2", "\"2\" has no unit"),
            ("2 kpa", "`kpa` is not a unit"),
            ("2 3 kPa", "`3 kPa` is not a unit"),
            ("1e kPa", "`e kPa` is not a unit"),
            ("1e400 kPa", "\"1e400 kPa\" is too large"),
            ("inf kPa", "expected a stress, found the text \"inf kPa\""),
            ("2 kPa/", "a sign has no unit behind it"),
            ("1,5 kPa", "\"1,5 kPa\" has a comma"),
        ] {
            assert_eq!(parse(text, Stress).unwrap_err().to_string(), message);
        }
        assert!(
            parse("2 kpa", Stress)
                .unwrap_err()
                .help()
                .starts_with("did you mean `kPa`?")
        );
    }
}
