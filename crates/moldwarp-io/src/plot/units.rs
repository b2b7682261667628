//! Units that suit the size of what is shown.

/// An SI unit as histories have it, and the units that are used for it: from which size of values on,
/// how many of them one SI unit is, and the name.
type Units = (&'static str, &'static [(f64, f64, &'static str)]);

/// The first whose size is reached is taken.
const UNITS: [Units; 9] = [
    (
        "s",
        &[(0.05, 1.0, "s"), (5e-5, 1e3, "ms"), (0.0, 1e6, "µs")],
    ),
    ("m", &[(0.1, 1.0, "m"), (1e-4, 1e3, "mm"), (0.0, 1e6, "µm")]),
    ("m/s", &[(0.05, 1.0, "m/s"), (0.0, 1e3, "mm/s")]),
    ("m/s2", &[(0.0, 1.0, "m/s²")]),
    ("m3", &[(0.0, 1.0, "m³")]),
    (
        "Pa",
        &[(1e7, 1e-6, "MPa"), (1e3, 1e-3, "kPa"), (0.0, 1.0, "Pa")],
    ),
    (
        "N",
        &[(1e6, 1e-6, "MN"), (1e3, 1e-3, "kN"), (0.0, 1.0, "N")],
    ),
    (
        "J",
        &[
            (1e6, 1e-6, "MJ"),
            (1e3, 1e-3, "kJ"),
            (1.0, 1.0, "J"),
            (1e-3, 1e3, "mJ"),
            (0.0, 1e6, "µJ"),
        ],
    ),
    ("", &[(0.0, 1.0, "")]),
];

/// A unit to show values in.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Unit {
    /// How many of it one SI unit is.
    pub factor: f64,
    pub name: String,
}

/// The unit for values of this SI unit whose greatest absolute value is `greatest`.
pub(super) fn fitting(si: &str, greatest: f64) -> Unit {
    let known = UNITS.iter().find(|u| u.0 == si).map(|u| u.1);
    let found = known.and_then(|all| {
        // Zero throughout has no size; then it is the SI unit.
        let fits = |u: &&(f64, f64, &str)| {
            if greatest > 0.0 {
                greatest >= u.0
            } else {
                u.1 == 1.0
            }
        };
        all.iter().find(fits)
    });
    match found {
        Some(&(_, factor, name)) => Unit {
            factor,
            name: name.to_owned(),
        },
        None => Unit {
            factor: 1.0,
            name: si.to_owned(),
        },
    }
}

/// The unit of this name for values of an SI unit, or the names that there are.
pub(super) fn named(si: &str, name: &str) -> Result<Unit, Vec<&'static str>> {
    let all = UNITS.iter().find(|u| u.0 == si).map_or(&[][..], |u| u.1);
    // `u` stands for µ where there is no such key.
    let plain = |text: &str| text.replace('u', "µ").replace('2', "²").replace('3', "³");
    let found = all.iter().find(|u| u.2 == name || u.2 == plain(name));
    found
        .map(|&(_, factor, name)| Unit {
            factor,
            name: name.to_owned(),
        })
        .ok_or_else(|| all.iter().map(|u| u.2).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_get_short_figures() {
        let name = |si, greatest| fitting(si, greatest).name;
        assert_eq!(name("m", 0.0067), "mm");
        assert_eq!(name("m", 12.0), "m");
        assert_eq!(name("Pa", 1.5e5), "kPa");
        assert_eq!(name("Pa", 0.0), "Pa");
        assert_eq!(name("m/s2", 3.0), "m/s²");
        assert_eq!(name("kg", 3.0), "kg");
        assert_eq!(fitting("J", 2e4).factor, 1e-3);
        assert_eq!(named("J", "uJ").unwrap().name, "µJ");
        assert_eq!(named("Pa", "kN"), Err(vec!["MPa", "kPa", "Pa"]));
    }

    #[test]
    fn every_unit_of_a_history_is_known() {
        use moldwarp::plan::{Contact, Quantity};
        let quantities = Quantity::ALL.iter().map(|q| q.1.unit());
        let contacts = Contact::COLUMNS.iter().map(|c| c.1);
        for unit in quantities.chain(contacts).chain(["s", "J"]) {
            assert!(UNITS.iter().any(|u| u.0 == unit), "{unit}");
        }
    }
}
