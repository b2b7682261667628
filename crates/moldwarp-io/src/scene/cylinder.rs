//! The scene's `cylinder`: a mesh of a sector of a body of revolution.
//!
//! What makes a good sector is checked by its generator; here its answers get their places.

use super::amount::{Amount, OneOrMany, Spanned, each};
use super::error::Fault;
use super::mesh::{MOST_CELLS, has_volumes};
use super::quantity::Dimension;
use super::raw::{RawCylinder, RawDirections, RawProfile};
use super::values::{amount, amount_at, choose, count, placed};
use moldwarp::Mesh;
use moldwarp::mesh::{CylinderError, CylinderSector, Split};
use std::ops::Range;

pub(super) fn cylinder(raw: &Spanned<RawCylinder>) -> Result<Mesh, Fault> {
    let place = raw.span();
    let raw = raw.get_ref();
    let (radial, around, vertical) = cells(&raw.cells)?;
    let (radial_grading, vertical_grading) = match &raw.grading {
        Some(raw) => grading(raw)?,
        None => (1.0, vec![1.0]),
    };
    let split = match &raw.split {
        Some(word) => {
            let splits = [("six", Split::Six), ("symmetric", Split::Symmetric)];
            choose(placed(word), "split", &splits)?
        }
        None => Split::default(),
    };
    let sector = CylinderSector {
        outer: profile("profile", &raw.profile)?,
        inner: match &raw.inner {
            Some(inner) => Some(profile("inner", inner)?),
            None => None,
        },
        angle: amount("angle", &raw.angle, Dimension::Angle)?,
        radial,
        around,
        vertical,
        radial_grading,
        vertical_grading,
        split,
    };
    few_enough(&sector, raw)?;
    sector
        .mesh()
        .map_err(|e| explain(&e, &sector, raw, place).caused_by(e))
        .and_then(|mesh| match has_volumes(&mesh) {
            true => Ok(mesh),
            false => Err(no_volumes(raw)),
        })
}

fn profile(key: &str, raw: &RawProfile) -> Result<Vec<[f64; 2]>, Fault> {
    let point = |row: &super::amount::RawVector| match row.get_ref().as_slice() {
        [radius, height] => Ok([
            amount(key, radius, Dimension::Length)?,
            amount(key, height, Dimension::Length)?,
        ]),
        other => Err(Fault::new(format!(
            "a point of `{key}` has two entries: radius and height"
        ))
        .at(row.span(), format!("has {}", other.len()))
        .help(format!(
            "for example {key} = [[\"0.5 m\", \"0 m\"], [\"0.5 m\", \"1 m\"]]"
        ))),
    };
    raw.get_ref().iter().map(point).collect()
}

/// Numbers of cells: radial, around, vertical.
fn cells(raw: &RawDirections<i64>) -> Result<(usize, usize, Vec<usize>), Fault> {
    let [radial, around, vertical] = raw.get_ref().as_slice() else {
        return Err(
            Fault::new("`cells` needs three entries: radial, around, vertical")
                .at(raw.span(), format!("has {}", raw.get_ref().len()))
                .help("the last may be a list, one number for each segment of the profile"),
        );
    };
    let one = |(span, &n): (Range<usize>, &i64)| -> Result<usize, Fault> {
        Ok(count("cells", &Spanned::new(span, n), 1)? as usize)
    };
    let single = |entry: &Spanned<OneOrMany<i64>>| match entry.get_ref() {
        OneOrMany::One(n) => one((entry.span(), n)),
        OneOrMany::Many(_) => Err(one_only(entry, "cells")),
    };
    let vertical: Result<_, _> = each(vertical).into_iter().map(one).collect();
    Ok((single(radial)?, single(around)?, vertical?))
}

/// Last size over first: radial, vertical.
fn grading(raw: &RawDirections<Amount>) -> Result<(f64, Vec<f64>), Fault> {
    let [radial, vertical] = raw.get_ref().as_slice() else {
        return Err(Fault::new("`grading` needs two entries: radial, vertical")
            .at(raw.span(), format!("has {}", raw.get_ref().len()))
            .help("1 makes all cells alike; the second may be a list, one for each segment"));
    };
    let one = |(span, n): (Range<usize>, &Amount)| amount_at("grading", span, n, Dimension::Number);
    let radial = match radial.get_ref() {
        OneOrMany::One(n) => one((radial.span(), n))?,
        OneOrMany::Many(_) => return Err(one_only(radial, "grading")),
    };
    let vertical: Result<_, _> = each(vertical).into_iter().map(one).collect();
    Ok((radial, vertical?))
}

fn one_only<T>(entry: &Spanned<T>, key: &str) -> Fault {
    Fault::new(format!("this entry of `{key}` is one number"))
        .at(entry.span(), "a list")
        .help("only the vertical one, the last, may be a list: one for each segment of the profile")
}

fn few_enough(sector: &CylinderSector, raw: &RawCylinder) -> Result<(), Fault> {
    let vertical = match sector.vertical[..] {
        [one] => (one as u64).checked_mul(sector.segments() as u64),
        _ => sector
            .vertical
            .iter()
            .try_fold(0u64, |sum, &n| sum.checked_add(n as u64)),
    };
    let counts = [
        Some(sector.radial as u64),
        Some(sector.around as u64),
        vertical,
    ];
    let each = sector.split.most_tets();
    let total = counts.into_iter().try_fold(each, |p, n| p.checked_mul(n?));
    if total.is_some_and(|n| n <= 6 * MOST_CELLS) {
        return Ok(());
    }
    Err(Fault::new("the cylinder has too many cells")
        .at(
            raw.cells.span(),
            format!("more than {}", 6 * MOST_CELLS / each),
        )
        .help(format!(
            "each cell becomes up to {each} elements; take fewer"
        )))
}

/// Where in the scene the generator's refusal comes from.
fn explain(
    error: &CylinderError,
    sector: &CylinderSector,
    raw: &RawCylinder,
    whole: Range<usize>,
) -> Fault {
    let row = |profile: &RawProfile, point: usize| profile.get_ref()[point].span();
    let outer = |point| row(&raw.profile, point);
    let inner = |point| {
        raw.inner
            .as_ref()
            .map_or(whole.clone(), |inner| row(inner, point))
    };
    let cells = |direction: usize| raw.cells.get_ref()[direction].span();
    let grading = |direction: usize| {
        let grading = raw.grading.as_ref();
        grading.map_or(whole.clone(), |g| g.get_ref()[direction].span())
    };
    let message = error.to_string();
    let (problem, remedy) = message.split_once("; ").unwrap_or((&message, ""));
    let fault = Fault::new(problem).help(remedy);
    match *error {
        CylinderError::OnePoint => fault.at(raw.profile.span(), "too few points"),
        CylinderError::Height { point } => fault.at(outer(point), "not above the one before"),
        CylinderError::Radius { point } => fault.at(outer(point), "not greater than zero"),
        CylinderError::InnerCount { .. } => match &raw.inner {
            Some(inner) => fault.at(inner.span(), "another number of points"),
            None => fault,
        },
        CylinderError::InnerHeight { point } => fault
            .at(outer(point), "this point")
            .at(inner(point), "is at another height"),
        CylinderError::InnerRadius { point } => fault
            .at(outer(point), "the outer point")
            .at(inner(point), "does not lie inside it"),
        CylinderError::InnerMixed { point } => fault
            .at(inner(0), "one of the two is zero")
            .at(inner(point), "the other is not"),
        CylinderError::Angle => fault.at(raw.angle.span(), "no angle of a sector"),
        CylinderError::Wide => fault
            .at(raw.angle.span(), "this angle")
            .at(cells(1), "over so many cells"),
        CylinderError::Cells { direction } => fault.at(cells(direction), "less than 1"),
        CylinderError::Segments { given, .. } => {
            let place = match sector.vertical.len() == given {
                true => cells(2),
                false => grading(1),
            };
            fault.at(place, format!("has {given}"))
        }
        CylinderError::Grading { direction } => fault.at(grading(direction), "not greater than 0"),
        CylinderError::Mesh(_) => no_volumes(raw),
    }
}

fn no_volumes(raw: &RawCylinder) -> Fault {
    Fault::new("the cylinder's cells are too small or too large to compute their volumes")
        .at(raw.profile.span(), "are the units right?")
        .at(raw.cells.span(), "over so many cells")
        .help("write the unit in each length, as in [\"0.5 m\", \"20 cm\"]")
}
