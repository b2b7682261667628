//! Probes: what is recorded where.

use super::amount::{Named, each};
use super::bodies::volume_group;
use super::error::Fault;
use super::quantity::Dimension;
use super::raw::{RawProbe, Text};
use super::surfaces::surface;
use super::values::{choose, exactly_one, find, fits_a_column, placed, span, vector};
use moldwarp::plan::{Body, Boundary, Probe, Quantity, Target};
use moldwarp::{Mesh, Vec3};

/// Column groups of the history that are not probes.
const RESERVED: [&str; 2] = ["energy", "contact"];

pub(super) fn probes(
    raw: &Named<RawProbe>,
    (mesh, gravity): (&Mesh, Vec3),
    bodies: &[Body],
    boundaries: &[Boundary],
    notes: &mut Vec<String>,
) -> Result<Vec<Probe>, Fault> {
    let mut probes = Vec::new();
    for (name, raw) in &raw.0 {
        check_name(name)?;
        let target = target(name, raw, mesh, bodies)?;
        if let Target::Point(x) = target
            && mesh.find(x).is_none()
        {
            notes.push(format!(
                "the point of probe `{}` lies outside the mesh; it follows the nearest particle",
                name.get_ref()
            ));
        }
        let quantities = quantities(raw, target, boundaries, gravity)?;
        probes.push(Probe {
            name: name.get_ref().clone(),
            target,
            quantities,
        });
    }
    Ok(probes)
}

/// The name becomes the first part of a column's name.
fn check_name(name: &Text) -> Result<(), Fault> {
    fits_a_column("probe", name)?;
    let text = name.get_ref();
    if RESERVED.contains(&text.as_str()) {
        return Err(Fault::new(format!("a probe cannot be called `{text}`"))
            .at(name.span(), "the history has columns of this name already")
            .help("choose another name"));
    }
    Ok(())
}

fn target(name: &Text, raw: &RawProbe, mesh: &Mesh, bodies: &[Body]) -> Result<Target, Fault> {
    exactly_one(
        (name.span(), "a probe"),
        &[
            ("surface", span(&raw.surface)),
            ("point", span(&raw.point)),
            ("body", span(&raw.body)),
            ("volume", span(&raw.volume)),
        ],
    )?;
    match (&raw.surface, &raw.point, &raw.body, &raw.volume) {
        (Some(name), ..) => Ok(Target::Surface(surface(placed(name), mesh)?)),
        (_, _, Some(body), _) => {
            let names = bodies.iter().map(|b| b.name.as_str());
            Ok(Target::Body(find(placed(body), "body", "bodies", names)?))
        }
        (.., Some(volume)) => Ok(Target::Volume(volume_group(placed(volume), mesh)?)),
        (_, Some(point), ..) => {
            let x = vector("point", point, Dimension::Length)?;
            let [low, high] = mesh.bounds();
            if x.cmpge(low).all() && x.cmple(high).all() {
                return Ok(Target::Point(x));
            }
            Err(Fault::new("this point lies outside the mesh")
                .at(point.span(), "there is no particle near")
                .help(format!("the mesh reaches from {low} m to {high} m")))
        }
        _ => Err(Fault::new("a probe needs a place")),
    }
}

fn quantities(
    raw: &RawProbe,
    target: Target,
    boundaries: &[Boundary],
    gravity: Vec3,
) -> Result<Vec<Quantity>, Fault> {
    let held = matches!(target, Target::Surface(s)
        if boundaries.iter().any(|b| b.surfaces.contains(&s)));
    let mut chosen = Vec::new();
    for (span, word) in each(&raw.quantities) {
        let quantity = choose((span.clone(), word), "quantity", &Quantity::ALL)?;
        if quantity == Quantity::Reaction && !held {
            return Err(
                Fault::new("`reaction` is the force on a surface with a boundary")
                    .at(span, "there is no boundary here")
                    .help(
                        "put the probe on a surface that [[boundaries]] name, or remove `reaction`",
                    ),
            );
        }
        check_volume(span.clone(), quantity, target)?;
        if quantity == Quantity::Contact && !matches!(target, Target::Surface(_)) {
            return Err(Fault::new("`contact` is the force on a surface")
                .at(span, "this probe has none")
                .help(
                    "give the probe a `surface` of a body in an aligned contact; the whole force is in \
                     the columns contact.<name>",
                ));
        }
        if quantity == Quantity::Penetration && gravity == Vec3::ZERO {
            return Err(
                Fault::new("`penetration` is the displacement along gravity")
                    .at(span, "and there is none")
                    .help("record `displacement`"),
            );
        }
        if chosen.contains(&quantity) {
            return Err(Fault::new(format!("`{word}` is listed twice")).at(span, "again here"));
        }
        chosen.push(quantity);
    }
    if chosen.is_empty() {
        return Err(Fault::new("a probe records at least one quantity")
            .at(raw.quantities.span(), "an empty list")
            .help("for example quantities = [\"displacement\"]"));
    }
    Ok(chosen)
}

/// Volumes are measured of parts of the mesh and of bodies, and of parts of the mesh nothing else.
fn check_volume(
    place: std::ops::Range<usize>,
    quantity: Quantity,
    target: Target,
) -> Result<(), Fault> {
    match (quantity, target) {
        (Quantity::Volume, Target::Surface(_) | Target::Point(_)) => Err(Fault::new(
            "only bodies and volumes of the mesh have a volume",
        )
        .at(place, "this probe has none")
        .help("give the probe a `body`, or a `volume` of the mesh")),
        (other, Target::Volume(_)) if other != Quantity::Volume => Err(Fault::new(
            "of a volume of the mesh only `volume` is measured",
        )
        .at(place, "not this")
        .help("quantities = [\"volume\"]; all else is of a body, a surface or a point")),
        _ => Ok(()),
    }
}
