//! Loads on surfaces, each carried by one body.

use super::amount::{AmountOr, Spanned};
use super::bodies::touches;
use super::error::Fault;
use super::functions::function;
use super::quantity::Dimension;
use super::raw::{RawLinear, RawLoad, Text};
use super::surfaces::{joined, surfaces, unique};
use super::symmetry::allowed;
use super::values::{amount, amount_at, exactly_one, find, placed, span, vector};
use moldwarp::plan::{Body, Load, LoadKind, Place};
use moldwarp::{Mesh, Symmetry};

pub(super) fn loads(
    raw: &[Spanned<RawLoad>],
    mesh: &Mesh,
    symmetry: Option<&Symmetry>,
    bodies: &[Body],
) -> Result<Vec<Load>, Fault> {
    let mut loads: Vec<Load> = Vec::new();
    for item in raw {
        let raw = item.get_ref();
        let surfaces = surfaces(&raw.surface, mesh)?;
        let body = body(item, bodies)?;
        bears(raw, &surfaces, &bodies[body], mesh)?;
        let name = match &raw.name {
            Some(name) if loads.iter().any(|l| &l.name == name.get_ref()) => {
                return Err(
                    Fault::new(format!("two loads are called `{}`", name.get_ref()))
                        .at(name.span(), "the second of this name")
                        .help("give each its own name"),
                );
            }
            Some(name) => name.get_ref().clone(),
            None => unique(
                joined(&surfaces, mesh),
                loads.iter().map(|l| l.name.as_str()),
            ),
        };
        loads.push(Load {
            name,
            surfaces,
            body,
            kind: kind(item, symmetry)?,
            function: function(raw.function.as_ref())?,
        });
    }
    Ok(loads)
}

/// The only body need not be named.
fn body(item: &Spanned<RawLoad>, bodies: &[Body]) -> Result<usize, Fault> {
    let names = bodies.iter().map(|b| b.name.as_str());
    match &item.get_ref().body {
        Some(name) => find(placed(name), "body", "bodies", names),
        None if bodies.len() == 1 => Ok(0),
        None => Err(Fault::new("a load needs `body`, since there are several")
            .at(item.get_ref().surface.span(), "which body bears this load?")
            .help(format!("bodies: {}", super::suggest::list(names)))),
    }
}

fn kind(item: &Spanned<RawLoad>, symmetry: Option<&Symmetry>) -> Result<LoadKind, Fault> {
    let raw = item.get_ref();
    exactly_one(
        (raw.surface.span(), "a load"),
        &[
            ("traction", span(&raw.traction)),
            ("pressure", span(&raw.pressure)),
            ("force", span(&raw.force)),
            ("initial_stress", span(&raw.initial_stress)),
        ],
    )?;
    if let Some(asked) = &raw.initial_stress {
        return match asked.get_ref() {
            true => Ok(LoadKind::InitialStress),
            false => Err(Fault::new("a load without size")
                .at(asked.span(), "holds nothing")
                .help("initial_stress = true, or another size")),
        };
    }
    match (&raw.traction, &raw.pressure, &raw.force) {
        (Some(t), _, _) => Ok(LoadKind::Traction(vector(
            "traction",
            t,
            Dimension::Stress,
        )?)),
        (_, Some(p), _) => pressure(p),
        (_, _, Some(f)) => {
            let force = vector("force", f, Dimension::Force)?;
            allowed("force", force, f.span(), symmetry)?;
            Ok(LoadKind::Force(force))
        }
        _ => Err(Fault::new("a load needs a size")),
    }
}

fn pressure(raw: &Spanned<AmountOr<RawLinear>>) -> Result<LoadKind, Fault> {
    match raw.get_ref() {
        AmountOr::Amount(value) => Ok(LoadKind::Pressure(amount_at(
            "pressure",
            raw.span(),
            value,
            Dimension::Stress,
        )?)),
        AmountOr::Table(linear) => Ok(LoadKind::LinearPressure {
            value: amount("value", &linear.value, Dimension::Stress)?,
            gradient: amount("gradient", &linear.gradient, Dimension::UnitWeight)?,
            level: amount("level", &linear.level, Dimension::Length)?,
        }),
    }
}

/// Each triangle must have an element of the body beside it, else its share of the load would
/// act on nothing.
fn bears(raw: &RawLoad, surfaces: &[usize], body: &Body, mesh: &Mesh) -> Result<(), Fault> {
    let filled = filled(body, mesh);
    let holds = |element: u32| filled[element as usize];
    let faces = || surfaces.iter().flat_map(|&s| &mesh.surfaces[s].faces);
    let bare = faces()
        .filter(|&&face| {
            let across = mesh.across(face).map(|f| f.element);
            !holds(face.element) && !across.is_some_and(holds)
        })
        .count();
    if bare == 0 {
        return Ok(());
    }
    let total = faces().count();
    let surface = raw.surface.span();
    let mut fault = Fault::new(format!(
        "{bare} of {total} triangles of this load do not touch body `{}`",
        body.name
    ))
    .at(surface, "nothing would bear the load there")
    .help("load a surface of this body, or name the body that this surface belongs to");
    if let Some(name) = raw.body.as_ref().map(Text::span) {
        fault = fault.at(name, "this body");
    }
    Err(fault)
}

/// Which elements the body fills, at least in part.
fn filled(body: &Body, mesh: &Mesh) -> Vec<bool> {
    match &body.place {
        Place::Volumes(groups) => {
            let mut filled = vec![false; mesh.tets.len()];
            let groups = groups.iter().map(|&g| &mesh.volume_groups[g]);
            for &e in groups.flat_map(|g| &g.elements) {
                filled[e as usize] = true;
            }
            filled
        }
        Place::Region(region) => (0..mesh.tets.len())
            .map(|e| touches(mesh, e, region))
            .collect(),
    }
}
