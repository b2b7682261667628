//! The scene's `symmetry`: what the mesh is of the whole body.

use super::error::Fault;
use super::quantity::Dimension;
use super::raw::{RawScene, RawSymmetry};
use super::values::{amount, choose, foreign, placed, required, span};
use moldwarp::symmetry::{SymmetryError, SymmetryKind};
use moldwarp::{Mesh, Symmetry, Vec3};
use std::ops::Range;

#[derive(Clone, Copy)]
enum Kind {
    Sector,
    Half,
}

/// The symmetry, checked against the mesh and against gravity. What it means for the figures goes to
/// `notes`.
pub(super) fn symmetry(
    scene: &RawScene,
    mesh: &Mesh,
    gravity: Vec3,
    notes: &mut Vec<String>,
) -> Result<Option<Symmetry>, Fault> {
    let Some(raw) = &scene.symmetry else {
        return Ok(None);
    };
    let place = raw.span();
    let raw = raw.get_ref();
    let kinds = [("sector", Kind::Sector), ("half", Kind::Half)];
    let kind = choose(placed(&raw.kind), "kind of symmetry", &kinds)?;
    let axes = [("x", 0), ("y", 1), ("z", 2)];
    let axis = choose(placed(&raw.axis), "axis", &axes)?;
    let symmetry = match kind {
        Kind::Sector => {
            let owner = (place.clone(), "a sector");
            let raw = required(owner, "angle", &raw.angle, "\"20 deg\"")?;
            Symmetry::sector(mesh, axis, amount("angle", raw, Dimension::Angle)?)
        }
        Kind::Half => {
            foreign(&raw.kind, &[("angle", span(&raw.angle))])?;
            Symmetry::half(mesh, axis)
        }
    };
    let symmetry = symmetry.map_err(|e| explain(&e, raw, place).caused_by(e))?;
    allowed("gravity", gravity, scene.gravity.span(), Some(&symmetry))?;
    notes.push(meaning(&symmetry));
    Ok(Some(symmetry))
}

/// Refuses what acts on the whole body and is not symmetric.
pub(super) fn allowed(
    key: &str,
    vector: Vec3,
    place: Range<usize>,
    symmetry: Option<&Symmetry>,
) -> Result<(), Fault> {
    let Some(symmetry) = symmetry.filter(|s| !s.allows(vector)) else {
        return Ok(());
    };
    let axis = ["x", "y", "z"][symmetry.axis];
    let (wrong, right) = match symmetry.kind {
        SymmetryKind::Sector { .. } => ("across the axis of the sector", format!("along {axis}")),
        SymmetryKind::Half => (
            "across the plane between the halves",
            format!("within the plane {axis} = 0"),
        ),
    };
    Err(Fault::new(format!("`{key}` is not symmetric"))
        .at(place, wrong)
        .help(format!(
            "`{key}` is that of the whole body: let it act {right} only, or compute the whole body \
             without [symmetry]"
        )))
}

fn explain(error: &SymmetryError, raw: &RawSymmetry, place: Range<usize>) -> Fault {
    let fault = Fault::new(error.to_string());
    let angle = span(&raw.angle).unwrap_or(place);
    // The coordinates that follow the axis in the order x, y, z, x, y.
    let name = |d: usize| {
        let axis = "xyz".find(raw.axis.get_ref().as_str()).unwrap_or(0);
        ["x", "y", "z"][(axis + d) % 3]
    };
    match error {
        SymmetryError::Angle => fault.at(angle, "no angle of a sector").help(
            "a sector lies between θ = 0 and the angle; for 180 deg there is kind = \"half\", too",
        ),
        SymmetryError::NoMeridian { axis, .. } => fault
            .at(angle, "the sector is said to lie between 0 and this angle")
            .at(raw.axis.span(), "about this axis")
            .help(format!(
                "give the angle and the axis of the mesh; a sector begins in the half-plane of its \
                 axis {axis} and the direction {0}, and the angle counts towards {1}",
                name(1),
                name(2)
            )),
        SymmetryError::NotRound { .. } => fault
            .at(raw.kind.span(), "a sector is a part of a body of revolution")
            .help("leave [symmetry] out if the mesh is no part of such a body"),
        SymmetryError::NoPlane { .. } => fault.at(raw.axis.span(), "the normal of that plane").help(
            "`axis` is the normal of the plane of symmetry, which passes through the origin; move \
             the mesh there, or name another axis",
        ),
        SymmetryError::BothSides { .. } => fault
            .at(raw.axis.span(), "the normal of that plane")
            .help("a half lies on one side of its plane; mesh one half only, or leave [symmetry] out"),
    }
}

fn meaning(symmetry: &Symmetry) -> String {
    let part = match symmetry.kind {
        SymmetryKind::Sector { .. } => "sector",
        SymmetryKind::Half => "half",
    };
    format!(
        "the mesh is a {part}, {:.4} % of the whole body: forces, reactions, masses and energies are \
         those of the whole body; frames show the {part}",
        100.0 * symmetry.share
    )
}
