//! Least and greatest values of the fields of frames, and where they are.

use super::ResultsError;
use crate::output::vtu_read::{self, Frame};
use crate::run::unit_of_field;
use serde::Serialize;
use std::path::Path;

/// The range of a field's component.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FieldRange {
    /// `displacement.z`, `displacement.norm`, `stress.zz`, `plastic_strain`.
    pub name: String,
    /// With its sign convention; none of what has no unit.
    pub unit: Option<&'static str>,
    pub least: Extreme,
    pub greatest: Extreme,
    /// Values that are no finite numbers.
    pub not_finite: usize,
}

/// A value and where it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Extreme {
    pub value: f64,
    /// s.
    pub time: f64,
    /// m.
    pub position: [f64; 3],
    /// Of the particle; none of a node.
    pub id: Option<u64>,
}

/// Fields that name things and measure nothing.
const NAMES: [&str; 2] = ["id", "body"];

/// The ranges of all fields over these frames, in the order of the first one's fields.
///
/// # Errors
///
/// If a frame cannot be read.
pub fn field_ranges<'a>(
    paths: impl IntoIterator<Item = &'a Path>,
) -> Result<Vec<FieldRange>, ResultsError> {
    let mut ranges: Vec<FieldRange> = Vec::new();
    for path in paths {
        for range in of_frame(&vtu_read::read(path)?) {
            match ranges.iter_mut().find(|r| r.name == range.name) {
                Some(known) => known.widen(&range),
                None => ranges.push(range),
            }
        }
    }
    Ok(ranges)
}

impl FieldRange {
    fn widen(&mut self, other: &FieldRange) {
        if other.least.value < self.least.value {
            self.least = other.least;
        }
        if other.greatest.value > self.greatest.value {
            self.greatest = other.greatest;
        }
        self.not_finite += other.not_finite;
    }
}

fn of_frame(frame: &Frame) -> Vec<FieldRange> {
    let mut ranges = Vec::new();
    for field in frame
        .fields
        .iter()
        .filter(|f| !NAMES.contains(&&f.name[..]))
    {
        let components: &[&str] = match field.components {
            3 => &["x", "y", "z"],
            6 => &["xx", "yy", "zz", "xy", "yz", "zx"],
            _ => &[],
        };
        if components.is_empty() {
            ranges.extend(range(
                frame,
                field.name.clone(),
                field.values.iter().copied(),
            ));
        }
        for (at, component) in components.iter().enumerate() {
            let values = field
                .values
                .iter()
                .skip(at)
                .step_by(field.components)
                .copied();
            ranges.extend(range(frame, format!("{}.{component}", field.name), values));
        }
        if field.components == 3 {
            let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
            let values = field.values.chunks_exact(3).map(norm);
            ranges.extend(range(frame, format!("{}.norm", field.name), values));
        }
    }
    ranges
}

/// None where no value is finite and there is none that is not.
fn range(frame: &Frame, name: String, values: impl Iterator<Item = f64>) -> Option<FieldRange> {
    let mut least: Option<(f64, usize)> = None;
    let mut greatest: Option<(f64, usize)> = None;
    let mut not_finite = 0;
    for (at, value) in values.enumerate() {
        if !value.is_finite() {
            not_finite += 1;
            continue;
        }
        if least.is_none_or(|l| value < l.0) {
            least = Some((value, at));
        }
        if greatest.is_none_or(|g| value > g.0) {
            greatest = Some((value, at));
        }
    }
    let extreme = |found: Option<(f64, usize)>| {
        let (value, at) = match (found, not_finite) {
            (Some(found), _) => found,
            (None, 0) => return None,
            (None, _) => (f64::NAN, 0),
        };
        let ids = frame.field("id");
        Some(Extreme {
            value,
            time: frame.time,
            position: *frame.points.get(at)?,
            id: ids.and_then(|ids| ids.values.get(at)).map(|&id| id as u64),
        })
    };
    let field = name.split('.').next().unwrap_or_default();
    Some(FieldRange {
        unit: unit_of_field(field),
        name,
        least: extreme(least)?,
        greatest: extreme(greatest)?,
        not_finite,
    })
}
