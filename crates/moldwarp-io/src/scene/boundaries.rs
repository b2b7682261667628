//! Boundaries: where the mesh is held, moved or open to waves.

use super::amount::{Amount, OneOrMany, Spanned, each};
use super::error::Fault;
use super::functions::function;
use super::quantity::Dimension;
use super::raw::{RawBoundary, Text, Texts};
use super::surfaces::{joined, surfaces, unique};
use super::values::{amount, amount_at, choose, foreign, placed, required, span, three};
use moldwarp::Mesh;
use moldwarp::plan::{Boundary, BoundaryKind};

/// Kinds of boundaries; what the reference says of each stands here.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// No motion in the directions that are held. Inside the mesh a surface held in all is a wall.
    Fixed,
    /// No motion normal to the surface.
    Roller,
    /// A given velocity, in all directions that are not free.
    Prescribed,
    /// Waves go out: a dashpot, and a spring if there is a virtual thickness; see
    /// [absorbing boundaries](../theory/method.md#absorbing-boundaries).
    Absorbing,
    /// Material leaves the mesh here: a particle that comes to the surface is taken out and counted. Nothing
    /// holds the surface.
    Outflow,
}

pub(super) fn boundaries(
    raw: &[Spanned<RawBoundary>],
    mesh: &Mesh,
) -> Result<Vec<Boundary>, Fault> {
    check_names(raw)?;
    let mut done: Vec<Boundary> = Vec::new();
    for item in raw {
        let surfaces = surfaces(&item.get_ref().surface, mesh)?;
        let name = match &item.get_ref().name {
            Some(name) => name.get_ref().clone(),
            None => {
                let earlier = done.iter().map(|b| b.name.as_str());
                let taken = given_names(raw)
                    .map(|n| n.get_ref().as_str())
                    .chain(earlier);
                unique(joined(&surfaces, mesh), taken)
            }
        };
        let boundary = Boundary {
            name,
            surfaces,
            kind: kind(item)?,
        };
        agrees_with(&boundary, &done, raw, mesh)?;
        done.push(boundary);
    }
    Ok(done)
}

fn given_names(raw: &[Spanned<RawBoundary>]) -> impl Iterator<Item = &Text> + Clone {
    raw.iter().filter_map(|b| b.get_ref().name.as_ref())
}

fn check_names(raw: &[Spanned<RawBoundary>]) -> Result<(), Fault> {
    for (i, name) in given_names(raw).enumerate() {
        let mut earlier = given_names(raw).take(i);
        if let Some(first) = earlier.find(|n| n.get_ref() == name.get_ref()) {
            return Err(
                Fault::new(format!("two boundaries are called `{}`", name.get_ref()))
                    .at(first.span(), "first")
                    .at(name.span(), "second")
                    .help("give each its own name, or one boundary a list of surfaces"),
            );
        }
    }
    Ok(())
}

fn kind(item: &Spanned<RawBoundary>) -> Result<BoundaryKind, Fault> {
    let raw = item.get_ref();
    let kind = choose(
        placed(&raw.kind),
        "kind of boundary",
        &[
            ("fixed", Kind::Fixed),
            ("roller", Kind::Roller),
            ("prescribed", Kind::Prescribed),
            ("absorbing", Kind::Absorbing),
            ("outflow", Kind::Outflow),
        ],
    )?;
    let keys = [
        ("directions", span(&raw.directions), Kind::Fixed),
        ("velocity", span(&raw.velocity), Kind::Prescribed),
        ("function", span(&raw.function), Kind::Prescribed),
        ("alpha", span(&raw.alpha), Kind::Absorbing),
        (
            "virtual_thickness",
            span(&raw.virtual_thickness),
            Kind::Absorbing,
        ),
    ];
    let others = keys.into_iter().filter(|k| k.2 != kind);
    let others: Vec<_> = others.map(|(key, span, _)| (key, span)).collect();
    foreign(&raw.kind, &others)?;
    match kind {
        Kind::Fixed => Ok(BoundaryKind::Fixed {
            directions: match &raw.directions {
                None => [true; 3],
                Some(list) => directions(list)?,
            },
        }),
        Kind::Roller => Ok(BoundaryKind::Roller),
        Kind::Prescribed => prescribed(item),
        Kind::Absorbing => absorbing(raw),
        Kind::Outflow => Ok(BoundaryKind::Outflow),
    }
}

fn directions(raw: &Texts) -> Result<[bool; 3], Fault> {
    let mut held = [false; 3];
    for (span, name) in each(raw) {
        let axes = [("x", 0), ("y", 1), ("z", 2)];
        held[choose((span, name), "direction", &axes)?] = true;
    }
    if held == [false; 3] {
        return Err(Fault::new("`directions` must name at least one direction")
            .at(raw.span(), "an empty list")
            .help("leave it out to hold all three"));
    }
    Ok(held)
}

fn prescribed(item: &Spanned<RawBoundary>) -> Result<BoundaryKind, Fault> {
    let raw = item.get_ref();
    let owner = (raw.kind.span(), "a prescribed boundary");
    let example = "[\"free\", \"free\", \"-0.1 m/s\"]";
    let written = required(owner, "velocity", &raw.velocity, example)?;
    let mut velocity = [None; 3];
    for (i, entry) in three("velocity", written)?.iter().enumerate() {
        velocity[i] = match entry.get_ref() {
            Amount::Text(text) if text.trim() == "free" => None,
            _ => Some(amount("velocity", entry, Dimension::Velocity)?),
        };
    }
    if velocity == [None; 3] {
        return Err(
            Fault::new("a prescribed boundary must move in some direction")
                .at(written.span(), "free in all directions")
                .help("remove this boundary: surfaces without one are free"),
        );
    }
    Ok(BoundaryKind::Prescribed {
        velocity,
        function: function(raw.function.as_ref())?,
    })
}

/// α is 1 where none is given: the dashpot that is exact for waves along the normal.
fn absorbing(raw: &RawBoundary) -> Result<BoundaryKind, Fault> {
    let alpha = match &raw.alpha {
        None => [1.0; 2],
        Some(alpha) => normal_and_shear("alpha", alpha, Dimension::Number)?,
    };
    let virtual_thickness = match &raw.virtual_thickness {
        None => None,
        Some(thickness) => Some(normal_and_shear(
            "virtual_thickness",
            thickness,
            Dimension::Length,
        )?),
    };
    Ok(BoundaryKind::Absorbing {
        alpha,
        virtual_thickness,
    })
}

/// One value for both, or two.
fn normal_and_shear(
    key: &str,
    raw: &Spanned<OneOrMany<Amount>>,
    dimension: Dimension,
) -> Result<[f64; 2], Fault> {
    let mut values = Vec::new();
    for (span, amount) in each(raw) {
        let value = amount_at(key, span.clone(), amount, dimension)?;
        if value <= 0.0 {
            let sign = if value < 0.0 { "negative" } else { "zero" };
            return Err(Fault::new(format!("`{key}` must be greater than zero"))
                .at(span, sign)
                .help(match dimension {
                    Dimension::Length => "leave it out for a dashpot alone",
                    _ => "1 absorbs waves along the normal; surfaces without a boundary are free",
                }));
        }
        values.push(value);
    }
    match values[..] {
        [both] => Ok([both, both]),
        [normal, shear] => Ok([normal, shear]),
        _ => Err(
            Fault::new(format!("`{key}` is one value or [normal, shear]"))
                .at(raw.span(), format!("has {} entries", values.len())),
        ),
    }
}

/// Refuses a boundary that asks of a surface what an earlier one forbids.
fn agrees_with(
    boundary: &Boundary,
    earlier: &[Boundary],
    raw: &[Spanned<RawBoundary>],
    mesh: &Mesh,
) -> Result<(), Fault> {
    for (other, raw_other) in earlier.iter().zip(raw) {
        let shared = boundary.surfaces.iter();
        for &surface in shared.filter(|s| other.surfaces.contains(s)) {
            if contradict(&boundary.kind, &other.kind, surface, mesh) {
                let name = &mesh.surfaces[surface].name;
                let raw = raw[earlier.len()].get_ref();
                return Err(Fault::new(format!(
                    "two boundaries contradict each other on `{name}`"
                ))
                .at(raw_other.get_ref().kind.span(), "first")
                .at(raw.kind.span(), "second")
                .help(format!("remove `{name}` from one of them")));
            }
        }
    }
    Ok(())
}

/// An absorbing boundary and an outflow need their surface for themselves. A prescribed velocity must not be given
/// in a direction that is held, or given again.
fn contradict(a: &BoundaryKind, b: &BoundaryKind, surface: usize, mesh: &Mesh) -> bool {
    use BoundaryKind::*;
    let given = |velocity: &[Option<f64>; 3]| velocity.map(|v| v.is_some());
    let both = |a: [bool; 3], b: [bool; 3]| (0..3).any(|d| a[d] && b[d]);
    match (a, b) {
        (Absorbing { .. } | Outflow, _) | (_, Absorbing { .. } | Outflow) => true,
        (Fixed { .. } | Roller, Fixed { .. } | Roller) => false,
        (Prescribed { velocity: a, .. }, Prescribed { velocity: b, .. }) => {
            both(given(a), given(b))
        }
        (Prescribed { velocity, .. }, Fixed { directions })
        | (Fixed { directions }, Prescribed { velocity, .. }) => both(given(velocity), *directions),
        (Prescribed { velocity, .. }, Roller) | (Roller, Prescribed { velocity, .. }) => {
            both(given(velocity), normal_directions(surface, mesh))
        }
    }
}

/// The directions in which some face of the surface has a normal component.
fn normal_directions(surface: usize, mesh: &Mesh) -> [bool; 3] {
    let mut any = [false; 3];
    for &face in &mesh.surfaces[surface].faces {
        let normal = mesh.face_area(face).normalize();
        for d in 0..3 {
            any[d] |= normal[d].abs() > 1e-6;
        }
    }
    any
}
