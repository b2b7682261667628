//! What is shown of particles, and the numbers that can be made of a field.

use crate::output::vtu_read::{Field, Frame};

/// How a field is called and measured.
pub struct About {
    pub name: &'static str,
    /// For people.
    pub title: &'static str,
    pub unit: &'static str,
    /// Sign convention or meaning; may be empty.
    pub note: &'static str,
}

/// Of the frames. Fields of other names are shown under their own, without a unit.
pub const KNOWN: [About; 12] = [
    About::new(
        "displacement",
        "Displacement",
        "m",
        "since the start, or since a stage has reset it",
    ),
    About::new("velocity", "Velocity", "m/s", ""),
    About::new("stress", "Stress", "Pa", "tension positive"),
    About::new(
        "mean_pressure",
        "Mean stress p",
        "Pa",
        "compression positive",
    ),
    About::new(
        "deviatoric_stress",
        "Deviatoric stress q",
        "Pa",
        "√(3/2 s : s)",
    ),
    About::new(
        "plastic_strain",
        "Plastic strain",
        "",
        "equivalent deviatoric",
    ),
    About::new(
        "plastic_volume",
        "Plastic volume strain",
        "",
        "volume increase positive",
    ),
    About::new(
        "opening",
        "Opening",
        "",
        "volume strain by which the material is separated",
    ),
    About::new("yielding", "Material state", "", "in the last step"),
    About::new("body", "Body", "", ""),
    About::new("density", "Density", "kg/m3", "mass over volume"),
    About::new("id", "Number", "", ""),
];

impl About {
    const fn new(
        name: &'static str,
        title: &'static str,
        unit: &'static str,
        note: &'static str,
    ) -> About {
        About {
            name,
            title,
            unit,
            note,
        }
    }

    pub fn of(name: &str) -> Option<&'static About> {
        KNOWN.iter().find(|a| a.name == name)
    }
}

/// Fields whose values are numbers of things, with what they stand for; bodies have their names.
pub const STATES: [&str; 5] = ["elastic", "shear", "edge", "apex", "tension"];

pub fn is_of_kinds(name: &str) -> bool {
    name == "yielding" || name == "body"
}

/// A number that is made of a field: a component, or the length of a vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    Whole,
    Component(usize),
}

impl Part {
    /// All that a field with so many components has, in the order of the menu.
    pub fn all(components: usize) -> Vec<Part> {
        match components {
            1 => vec![Part::Component(0)],
            3 => [Part::Whole]
                .into_iter()
                .chain((0..3).map(Part::Component))
                .collect(),
            n => (0..n).map(Part::Component).collect(),
        }
    }

    pub fn value(self, values: &[f64]) -> f64 {
        match self {
            Part::Whole => values.iter().map(|v| v * v).sum::<f64>().sqrt(),
            Part::Component(i) => values[i],
        }
    }
}

/// Fields that are shown: all but the particles' numbers, those known first, in their order.
pub fn shown(frame: &Frame) -> Vec<&Field> {
    let rank = |f: &Field| {
        KNOWN
            .iter()
            .position(|a| a.name == f.name)
            .unwrap_or(KNOWN.len())
    };
    let fields = frame.fields.iter().filter(|f| f.name != "id");
    let mut fields: Vec<&Field> = fields
        .filter(|f| [1, 3, 6].contains(&f.components))
        .collect();
    fields.sort_by_key(|f| rank(f));
    fields
}
