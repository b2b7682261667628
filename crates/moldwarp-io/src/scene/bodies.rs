//! Bodies: which part of the mesh is filled with which material.

use super::amount::{AmountOr, Named, RawVector, Spanned, each};
use super::error::Fault;
use super::quantity::Dimension;
use super::raw::{RawBody, RawRegion, RawSpacing, Text, Texts};
use super::values::{
    at_most_one, choose, exactly_one, find, foreign, not_negative, placed, positive, required,
    span, vector,
};
use moldwarp::plan::{Body, NamedMaterial, Place, Region, Seeding, Spacing};
use moldwarp::{Mesh, Vec3};
use std::ops::Range;

pub(super) fn bodies(
    raw: &Named<RawBody>,
    mesh: &Mesh,
    materials: &[NamedMaterial],
) -> Result<Vec<Body>, Fault> {
    if raw.0.is_empty() {
        return Err(Fault::new("the scene has no bodies")
            .help("add one: [bodies.layer] with volume = \"…\" and material = \"…\""));
    }
    let mut bodies: Vec<Body> = Vec::new();
    for (name, raw) in &raw.0 {
        bodies.push(body(name, raw, mesh, materials)?);
    }
    Ok(bodies)
}

fn body(
    name: &Text,
    raw: &RawBody,
    mesh: &Mesh,
    materials: &[NamedMaterial],
) -> Result<Body, Fault> {
    exactly_one(
        (name.span(), "a body"),
        &[("volume", span(&raw.volume)), ("region", span(&raw.region))],
    )?;
    let place = match (&raw.volume, &raw.region) {
        (Some(volume), _) => Place::Volumes(volumes(volume, mesh)?),
        (None, Some(region)) => Place::Region(checked_region(region, mesh)?),
        (None, None) => return Err(Fault::new("a body needs a place")),
    };
    let names = materials.iter().map(|m| m.name.as_str());
    let material = find(placed(&raw.material), "material", "materials", names)?;
    if let Some(k0) = raw
        .k0
        .as_ref()
        .filter(|_| materials[material].model.is_rigid())
    {
        return Err(Fault::new("a rigid body has no stress")
            .at(k0.span(), "so it has no K0")
            .help("leave this out"));
    }
    Ok(Body {
        name: name.get_ref().clone(),
        place,
        material,
        seeding: seeding(raw)?,
    })
}

/// The volume's number; one without elements is an error.
pub(super) fn volume_group(name: (Range<usize>, &str), mesh: &Mesh) -> Result<usize, Fault> {
    let names = mesh.volume_groups.iter().map(|g| g.name.as_str());
    let group = find(name.clone(), "volume", "volumes of the mesh", names)?;
    if mesh.volume_groups[group].elements.is_empty() {
        return Err(Fault::new(format!("volume `{}` is empty", name.1))
            .at(name.0, "has no elements")
            .help("choose another volume, or mesh this one"));
    }
    Ok(group)
}

/// The volumes' numbers, at least one and none twice.
pub(super) fn volumes(raw: &Texts, mesh: &Mesh) -> Result<Vec<usize>, Fault> {
    let mut found = Vec::new();
    for (span, name) in each(raw) {
        let group = volume_group((span.clone(), name), mesh)?;
        if found.contains(&group) {
            return Err(Fault::new(format!("`{name}` is listed twice")).at(span, "again here"));
        }
        found.push(group);
    }
    if found.is_empty() {
        return Err(Fault::new("name at least one volume").at(raw.span(), "an empty list"));
    }
    Ok(found)
}

fn seeding(raw: &RawBody) -> Result<Seeding, Fault> {
    at_most_one(&[
        ("particles_per_element", span(&raw.particles_per_element)),
        ("particle_spacing", span(&raw.particle_spacing)),
    ])?;
    match &raw.particle_spacing {
        Some(given) => Ok(Seeding::Spacing(spacing(given)?)),
        None => per_element(raw.particles_per_element.as_ref()),
    }
}

/// The same everywhere, or graded by the distance from a line.
fn spacing(raw: &Spanned<AmountOr<RawSpacing>>) -> Result<Spacing, Fault> {
    let table = match raw.get_ref() {
        AmountOr::Amount(amount) => {
            let amount = Spanned::new(raw.span(), amount.clone());
            let spacing = positive("particle_spacing", &amount, Dimension::Length)?;
            return Ok(Spacing {
                start: Vec3::ZERO,
                end: Vec3::ZERO,
                points: vec![[0.0, spacing]],
            });
        }
        AmountOr::Table(table) => table,
    };
    let mut points: Vec<[f64; 2]> = Vec::new();
    for row in table.points.get_ref() {
        let [distance, spacing] = row.get_ref().as_slice() else {
            return Err(Fault::new("a point is a distance and a spacing")
                .at(row.span(), format!("has {} entries", row.get_ref().len()))
                .help("write points = [[\"0.5 m\", \"20 mm\"], [\"3 m\", \"100 mm\"]]"));
        };
        let from = not_negative("distance", distance, Dimension::Length)?;
        if points.last().is_some_and(|last| from <= last[0]) {
            return Err(
                Fault::new("the distances of a particle spacing must increase")
                    .at(distance.span(), "not farther than the point before"),
            );
        }
        points.push([from, positive("spacing", spacing, Dimension::Length)?]);
    }
    if points.is_empty() {
        return Err(Fault::new("a particle spacing needs at least one point")
            .at(table.points.span(), "has none"));
    }
    Ok(Spacing {
        start: vector("start", &table.start, Dimension::Length)?,
        end: vector("end", &table.end, Dimension::Length)?,
        points,
    })
}

fn per_element(raw: Option<&Spanned<i64>>) -> Result<Seeding, Fault> {
    match raw {
        None => Ok(Seeding::Four),
        Some(n) => match n.get_ref() {
            1 => Ok(Seeding::One),
            4 => Ok(Seeding::Four),
            10 => Ok(Seeding::Ten),
            _ => Err(Fault::new("`particles_per_element` must be 1, 4 or 10")
                .at(n.span(), "there is no such pattern")
                .help("4 is the usual choice, 10 where the body deforms much")),
        },
    }
}

fn checked_region(raw: &Spanned<RawRegion>, mesh: &Mesh) -> Result<Region, Fault> {
    let region = region(raw)?;
    if (0..mesh.tets.len()).any(|e| touches(mesh, e, &region)) {
        return Ok(region);
    }
    let [low, high] = mesh.bounds();
    Err(Fault::new("this body would have no particles")
        .at(raw.span(), "no element of the mesh lies in this region")
        .help(format!("the mesh reaches from {low} m to {high} m")))
}

/// Whether the element's centroid or one of its corners lies in the region.
pub(super) fn touches(mesh: &Mesh, element: usize, region: &Region) -> bool {
    region.contains(mesh.centroid(element))
        || mesh.corners(element).iter().any(|&x| region.contains(x))
}

/// Kinds of regions; what the reference says of each stands here.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Along the axes, between two corners.
    Box,
    /// Round its `centre`.
    Sphere,
    /// Between the planes through both ends of its axis.
    Cylinder,
    /// From its apex, `start`, to the plane through the other `end` of its axis, where it has its
    /// `radius`.
    Cone,
    /// The side of a plane that its normal points away from.
    HalfSpace,
}

fn region(raw: &Spanned<RawRegion>) -> Result<Region, Fault> {
    let place = raw.span();
    let raw = raw.get_ref();
    let kind = match &raw.kind {
        None => Kind::Box,
        Some(kind) => choose(
            placed(kind),
            "kind of region",
            &[
                ("box", Kind::Box),
                ("sphere", Kind::Sphere),
                ("cylinder", Kind::Cylinder),
                ("cone", Kind::Cone),
                ("half-space", Kind::HalfSpace),
            ],
        )?,
    };
    refuse_others(kind, raw)?;
    let at = |key: &str, value: &Option<RawVector>| -> Result<Vec3, Fault> {
        let value = required(
            (place.clone(), "this region"),
            key,
            value,
            "[\"0 m\", \"0 m\", \"1 m\"]",
        )?;
        vector(key, value, Dimension::Length)
    };
    let radius = || -> Result<f64, Fault> {
        let owner = (place.clone(), "this region");
        let radius = required(owner, "radius", &raw.radius, "\"1 m\"")?;
        positive("radius", radius, Dimension::Length)
    };
    let region = match kind {
        Kind::Box => Region::Box {
            min: at("min", &raw.min)?,
            max: at("max", &raw.max)?,
        },
        Kind::Sphere => Region::Sphere {
            centre: at("centre", &raw.centre)?,
            radius: radius()?,
        },
        Kind::Cylinder => Region::Cylinder {
            start: at("start", &raw.start)?,
            end: at("end", &raw.end)?,
            radius: radius()?,
        },
        Kind::Cone => Region::Cone {
            apex: at("start", &raw.start)?,
            end: at("end", &raw.end)?,
            radius: radius()?,
        },
        Kind::HalfSpace => {
            let owner = (place.clone(), "a half-space");
            let normal = required(owner, "normal", &raw.normal, "[0, 0, 1]")?;
            Region::HalfSpace {
                point: at("point", &raw.point)?,
                normal: vector("normal", normal, Dimension::Number)?,
            }
        }
    };
    not_degenerate(region, place)
}

fn refuse_others(kind: Kind, raw: &RawRegion) -> Result<(), Fault> {
    let keys = [
        ("min", span(&raw.min), &[Kind::Box][..]),
        ("max", span(&raw.max), &[Kind::Box]),
        ("centre", span(&raw.centre), &[Kind::Sphere]),
        (
            "radius",
            span(&raw.radius),
            &[Kind::Sphere, Kind::Cylinder, Kind::Cone],
        ),
        ("start", span(&raw.start), &[Kind::Cylinder, Kind::Cone]),
        ("end", span(&raw.end), &[Kind::Cylinder, Kind::Cone]),
        ("point", span(&raw.point), &[Kind::HalfSpace]),
        ("normal", span(&raw.normal), &[Kind::HalfSpace]),
    ];
    let others = keys.into_iter().filter(|k| !k.2.contains(&kind));
    let others: Vec<_> = others.map(|(key, span, _)| (key, span)).collect();
    match &raw.kind {
        Some(kind) => foreign(kind, &others),
        None => match others.into_iter().find_map(|(key, span)| Some((key, span?))) {
            None => Ok(()),
            Some((key, span)) => Err(Fault::new("this region does not say its kind")
                .at(span, format!("`{key}` does not belong to a box"))
                .help("add kind = \"sphere\", \"cylinder\", \"cone\" or \"half-space\"; without it a region is a box")),
        },
    }
}

fn not_degenerate(region: Region, place: std::ops::Range<usize>) -> Result<Region, Fault> {
    let wrong = match region {
        Region::Box { min, max } if !min.cmplt(max).all() => "`min` must be less than `max`",
        Region::Cylinder { start, end, .. }
        | Region::Cone {
            apex: start, end, ..
        } if start == end => "`start` and `end` must differ",
        Region::HalfSpace { normal, .. } if normal == Vec3::ZERO => "`normal` must not be zero",
        _ => return Ok(region),
    };
    Err(Fault::new(wrong).at(place, "this region is empty"))
}
