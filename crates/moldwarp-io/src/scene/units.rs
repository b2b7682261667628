//! Units by name, and expressions of them such as `kN/m3` or `kg·m^-1`.

use std::f64::consts::PI;

/// Exponents of length, mass, time and angle.
pub(super) type Exponents = [i32; 4];

/// Name, factor to SI as a quotient, exponents. A quotient since 5 mm is 5/1000 m, rounded
/// once, which 5 · 0.001 is not.
const UNITS: [(&str, Factor, Exponents); 18] = [
    ("m", Factor(1.0, 1.0), [1, 0, 0, 0]),
    ("cm", Factor(1.0, 1e2), [1, 0, 0, 0]),
    ("mm", Factor(1.0, 1e3), [1, 0, 0, 0]),
    ("kg", Factor(1.0, 1.0), [0, 1, 0, 0]),
    ("t", Factor(1e3, 1.0), [0, 1, 0, 0]),
    ("s", Factor(1.0, 1.0), [0, 0, 1, 0]),
    ("ms", Factor(1.0, 1e3), [0, 0, 1, 0]),
    ("min", Factor(60.0, 1.0), [0, 0, 1, 0]),
    ("h", Factor(3600.0, 1.0), [0, 0, 1, 0]),
    ("N", Factor(1.0, 1.0), [1, 1, -2, 0]),
    ("kN", Factor(1e3, 1.0), [1, 1, -2, 0]),
    ("MN", Factor(1e6, 1.0), [1, 1, -2, 0]),
    ("Pa", Factor(1.0, 1.0), [-1, 1, -2, 0]),
    ("kPa", Factor(1e3, 1.0), [-1, 1, -2, 0]),
    ("MPa", Factor(1e6, 1.0), [-1, 1, -2, 0]),
    ("GPa", Factor(1e9, 1.0), [-1, 1, -2, 0]),
    ("rad", Factor(1.0, 1.0), [0, 0, 0, 1]),
    ("deg", Factor(PI, 180.0), [0, 0, 0, 1]),
];

/// What to multiply by, what to divide by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Factor(f64, f64);

impl Factor {
    pub fn apply(self, number: f64) -> f64 {
        number * self.0 / self.1
    }

    fn times(self, unit: Factor, power: i32) -> Factor {
        let n = power.abs();
        let (above, below) = (unit.0.powi(n), unit.1.powi(n));
        if power > 0 {
            Factor(self.0 * above, self.1 * below)
        } else {
            Factor(self.0 * below, self.1 * above)
        }
    }
}

/// The names of all units.
pub(super) fn names() -> impl Iterator<Item = &'static str> + Clone {
    UNITS.iter().map(|u| u.0)
}

/// A product and quotient of units, read from left to right: its factor to SI and exponents.
/// The error is the part that is no unit.
pub(super) fn parse(text: &str) -> Result<(Factor, Exponents), &str> {
    let mut factor = Factor(1.0, 1.0);
    let mut exponents = [0; 4];
    let mut rest = text.trim();
    // The 1 of 1/s.
    if let Some(after) = rest.strip_prefix('1') {
        rest = after.trim_start();
    } else if !rest.is_empty() && !rest.starts_with('/') {
        rest = factor_and_rest(rest, 1, &mut factor, &mut exponents)?;
    }
    while !rest.is_empty() {
        let (sign, after) = match (rest.strip_prefix(['*', '·']), rest.strip_prefix('/')) {
            (Some(after), _) => (1, after),
            (_, Some(after)) => (-1, after),
            _ => return Err(rest),
        };
        rest = factor_and_rest(after.trim_start(), sign, &mut factor, &mut exponents)?;
    }
    Ok((factor, exponents))
}

fn factor_and_rest<'a>(
    text: &'a str,
    sign: i32,
    factor: &mut Factor,
    exponents: &mut Exponents,
) -> Result<&'a str, &'a str> {
    let end = text.find(['/', '*', '·']).unwrap_or(text.len());
    let part = text[..end].trim_end();
    let (unit, dimension, power) = power_of_unit(part).ok_or(part)?;
    *factor = factor.times(unit, sign * power);
    for d in 0..4 {
        exponents[d] += sign * power * dimension[d];
    }
    Ok(&text[end..])
}

/// `m`, `m3`, `m^3`, `m³`, `s^-1`, `s⁻¹`.
fn power_of_unit(part: &str) -> Option<(Factor, Exponents, i32)> {
    let end = part
        .find(|c: char| !c.is_alphabetic())
        .unwrap_or(part.len());
    let (name, power) = part.split_at(end);
    let &(_, factor, exponents) = UNITS.iter().find(|u| u.0 == name)?;
    if power.is_empty() {
        return Some((factor, exponents, 1));
    }
    let digits = power.strip_prefix('^').unwrap_or(power);
    let power: i32 = digits
        .chars()
        .map(plain_digit)
        .collect::<String>()
        .parse()
        .ok()?;
    let possible = (1..=9).contains(&power.abs());
    possible.then_some((factor, exponents, power))
}

fn plain_digit(c: char) -> char {
    match c {
        '⁻' | '−' => '-',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_written_in_three_ways() {
        let expected = parse("kN/m3").unwrap();
        assert_eq!(expected.1, [-2, 1, -2, 0]);
        assert_eq!(expected.0.apply(18.0), 18e3);
        for other in ["kN/m^3", "kN/m³", "kN / m3", "kN·m^-3", "kN*m⁻³"] {
            assert_eq!(parse(other).unwrap().1, expected.1, "{other}");
        }
        assert_eq!(parse("1/s").unwrap().1, [0, 0, -1, 0]);
        assert_eq!(parse("/s").unwrap().1, [0, 0, -1, 0]);
        assert_eq!(parse("mm²").unwrap().0.apply(5e6), 5.0);
        assert_eq!(parse("t/m3").unwrap().0.apply(2.65), 2650.0);
    }

    #[test]
    fn the_part_that_is_no_unit_is_named() {
        assert_eq!(parse("kN/ft3"), Err("ft3"));
        assert_eq!(parse("kilo"), Err("kilo"));
        assert_eq!(parse("m0"), Err("m0"));
        assert_eq!(parse("m//s"), Err(""));
        assert_eq!(parse("m/"), Err(""));
    }
}
