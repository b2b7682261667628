//! A mesh that moves with a body.

use super::amount::Spanned;
use super::bodies::volumes;
use super::error::Fault;
use super::quantity::Dimension;
use super::raw::RawMeshMotion;
use super::values::{find, placed, positive, vector};
use moldwarp::mesh::MotionError;
use moldwarp::plan::{Body, MeshMotion};
use moldwarp::{Mesh, Vec3};
use std::ops::Range;

pub(super) fn mesh_motion(
    raw: Option<&Spanned<RawMeshMotion>>,
    mesh: &Mesh,
    bodies: &[Body],
    gravity: Vec3,
) -> Result<Option<MeshMotion>, Fault> {
    let Some(raw) = raw else { return Ok(None) };
    let (place, raw) = (raw.span(), raw.get_ref());
    let names = bodies.iter().map(|b| b.name.as_str());
    let driver = find(placed(&raw.driver), "body", "bodies", names)?;
    let moving = volumes(&raw.moving, mesh)?;
    let blend = raw.blend.as_ref().map(|blend| volumes(blend, mesh));
    let blend = blend.transpose()?.unwrap_or_default();
    if let Some(&twice) = blend.iter().find(|g| moving.contains(g)) {
        let blend = raw.blend.as_ref().map_or(place, Spanned::span);
        let name = &mesh.volume_groups[twice].name;
        return Err(Fault::new(format!(
            "volume `{name}` cannot both move rigidly and be stretched"
        ))
        .at(raw.moving.span(), "it is here")
        .at(blend, "and here")
        .help("leave it out in one of the lists"));
    }
    let direction = match &raw.direction {
        Some(given) => vector("direction", given, Dimension::Number)?,
        None => gravity,
    };
    let direction = direction.try_normalize().ok_or_else(|| {
        let at = raw.direction.as_ref().map_or(place, Spanned::span);
        Fault::new("the mesh needs a direction to move in")
            .at(at, "has none")
            .help("without gravity give one: direction = [0, 0, -1]")
    })?;
    Ok(Some(MeshMotion {
        driver,
        direction,
        moving,
        blend,
    }))
}

/// How far to look ahead, m.
pub(super) fn travel(raw: Option<&Spanned<RawMeshMotion>>) -> Result<Option<f64>, Fault> {
    let travel = raw.and_then(|raw| raw.get_ref().travel.as_ref());
    travel
        .map(|travel| positive("travel", travel, Dimension::Length))
        .transpose()
}

/// What the solver found when it set up the motion, at the scene's table.
pub(super) fn explain(error: &MotionError, place: Option<Range<usize>>) -> Fault {
    let text = error.to_string();
    let (problem, label) = text.split_once(": ").unwrap_or((&text, "this motion"));
    let help = match error {
        MotionError::NotOnFaces { .. } => {
            "give the driver a `volume` of the mesh, which fills its elements"
        }
        MotionError::NotCovered { .. } | MotionError::NoGroup { .. } => {
            "name all volumes of the mesh but the driver's in `moving` or `blend`"
        }
        MotionError::Held { .. } => {
            "end the moving zone before the boundary, with a volume of the `blend` between them; a roller \
             along the direction of the motion is no obstacle"
        }
    };
    let fault = Fault::new(problem).help(help);
    match place {
        Some(place) => fault.at(place, label),
        None => fault,
    }
}
