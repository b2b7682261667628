//! Loads on surfaces, carried by particles.
//!
//! Each triangle has three surface points with equal shares of its area, at barycentric
//! coordinates 2/3, 1/6, 1/6 (exact for pressures linear over the triangle). A point is bound to
//! the nearest particle of its body in the element and keeps its offset from it; its force acts
//! on the nodes of the particle's element with the shape functions at the point, extrapolated
//! where the point lies outside. Force and moment are then right wherever the particle goes.

use crate::Vec3;
use crate::mesh::{Face, Mesh};
use crate::particles::{Order, Particles};
use crate::plan::{Load, LoadKind};
use crate::tensor::{self, Voigt};

/// Barycentric coordinates of the surface points of a triangle.
const POINTS: [[f64; 3]; 3] = {
    let (a, b) = (2.0 / 3.0, 1.0 / 6.0);
    [[a, b, b], [b, a, b], [b, b, a]]
};

/// A point of a loaded surface.
#[derive(Clone, Debug)]
pub struct LoadPoint {
    /// Index into the plan's loads.
    pub load: u32,
    /// Place of the particle that carries it in the particle arrays.
    pub particle: u32,
    /// Point minus particle, m.
    pub offset: Vec3,
    /// Force at function value 1, N.
    pub force: Vec3,
}

/// A loaded surface has a triangle that its body does not touch.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("load `{load}`: body has no particles next to {count} of the surface's {total} triangles")]
pub struct LoadError {
    pub load: String,
    pub count: usize,
    pub total: usize,
}

/// What loads have to know beyond surfaces and particles.
pub struct Surroundings<'a> {
    /// Part of the whole body that the mesh is, by which forces of the whole body are cut down.
    pub share: f64,
    /// Unit vector against gravity; 0 without gravity.
    pub up: Vec3,
    /// Initial stress of a body at a point, Pa.
    pub stress: &'a dyn Fn(usize, Vec3) -> Voigt,
}

/// The points of loads, each given with its number.
pub fn load_points<'a>(
    mesh: &Mesh,
    loads: impl Iterator<Item = (usize, &'a Load)>,
    particles: &Particles,
    order: &Order,
    ground: &Surroundings,
) -> Result<Vec<LoadPoint>, LoadError> {
    let mut points = Vec::new();
    for (number, load) in loads {
        let faces: Vec<Face> = load
            .surfaces
            .iter()
            .flat_map(|&s| mesh.surfaces[s].faces.iter().copied())
            .collect();
        let total: f64 = faces.iter().map(|&f| mesh.face_area(f).length()).sum();
        let mut missing = 0;
        for &face in &faces {
            let Some(side) = side_of_body(mesh, face, load.body, particles, order) else {
                missing += 1;
                continue;
            };
            let area = mesh.face_area(side);
            let force = |x: Vec3| match load.kind {
                LoadKind::Traction(t) => t * area.length(),
                LoadKind::Pressure(p) => -area * p,
                LoadKind::LinearPressure {
                    value,
                    gradient,
                    level,
                } => -area * (value + gradient * (level - x.dot(ground.up))),
                LoadKind::Force(f) => f * (ground.share * area.length() / total),
                LoadKind::InitialStress => tensor::times(&(ground.stress)(load.body, x), area),
            };
            let corners = mesh.face_nodes(side).map(|n| mesh.nodes[n as usize]);
            for weights in POINTS {
                let x: Vec3 = (0..3).map(|i| corners[i] * weights[i]).sum();
                let particle = nearest(x, side.element, load.body, particles, order);
                let offset = x - particles.position.at(particle as usize);
                points.push(LoadPoint {
                    load: number as u32,
                    particle,
                    offset,
                    force: force(x) / 3.0,
                });
            }
        }
        if missing > 0 {
            return Err(LoadError {
                load: load.name.clone(),
                count: missing,
                total: faces.len(),
            });
        }
    }
    Ok(points)
}

/// The face seen from the element that holds particles of the body.
fn side_of_body(
    mesh: &Mesh,
    face: Face,
    body: usize,
    particles: &Particles,
    order: &Order,
) -> Option<Face> {
    let own = |p: &u32| usize::from(particles.body[*p as usize]) == body;
    let holds = |f: &Face| order.inside(f.element as usize).iter().any(own);
    Some(face)
        .filter(holds)
        .or_else(|| mesh.across(face).filter(holds))
}

fn nearest(x: Vec3, e: u32, body: usize, particles: &Particles, order: &Order) -> u32 {
    let distance = |p: u32| (particles.position.at(p as usize) - x).length_squared();
    let inside = order.inside(e as usize).iter().copied();
    inside
        .filter(|&p| usize::from(particles.body[p as usize]) == body)
        .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        .expect("the side of the body holds its particles")
}
