//! How deep particles lie in their body.
//!
//! The ball around a particle that reaches to its body's surface lies inside the body. So the body
//! reaches at least as far in a direction n as any of its balls, x_p · n + d_p, and for flat faces and
//! spheres exactly as far: the gap between two bodies is found from their particles wherever these
//! were seeded.

use crate::Vec3;
use crate::mesh::{Face, Mesh};
use crate::particles::Particles;
use crate::plan::{Body, Place, Region};

/// d_p of each particle, m, by its place. Faces on the outside of the mesh are no surface that
/// another body could touch.
pub(super) fn depths(mesh: &Mesh, bodies: &[Body], particles: &Particles) -> Vec<f64> {
    let surfaces: Vec<Surface> = bodies
        .iter()
        .map(|b| Surface::new(mesh, &b.place))
        .collect();
    let depth = |p: usize| {
        let surface = &surfaces[usize::from(particles.body[p])];
        surface.depth(mesh, particles.element[p], particles.position.at(p))
    };
    (0..particles.len()).map(depth).collect()
}

enum Surface {
    Region(Region, [Vec3; 2]),
    /// Faces of a volume by their nodes, ascending.
    Faces(Vec<(u32, Face)>),
}

impl Surface {
    fn new(mesh: &Mesh, place: &Place) -> Surface {
        match place {
            Place::Region(region) => Surface::Region(*region, mesh.bounds()),
            Place::Volumes(groups) => {
                let mut inside = vec![false; mesh.tets.len()];
                let groups = groups.iter().map(|&g| &mesh.volume_groups[g]);
                let elements = groups.flat_map(|g| &g.elements);
                elements.for_each(|&e| inside[e as usize] = true);
                Surface::Faces(faces_by_node(mesh, &inside))
            }
        }
    }

    fn depth(&self, mesh: &Mesh, element: u32, x: Vec3) -> f64 {
        match self {
            Surface::Region(region, bounds) => region_depth(region, bounds, x),
            Surface::Faces(faces) => {
                let distance = |face: Face| {
                    let origin = mesh.nodes[mesh.face_nodes(face)[0] as usize];
                    (x - origin).dot(mesh.face_area(face).normalize()).abs()
                };
                let near = mesh.tets[element as usize]
                    .into_iter()
                    .flat_map(|n| at(faces, n));
                // No face near: the particle cannot be the outermost of its body.
                let least = near.map(distance).fold(f64::INFINITY, f64::min);
                if least.is_finite() { least } else { 0.0 }
            }
        }
    }
}

/// Faces between elements that are marked and such that are not, seen from the marked ones, by each
/// of their nodes, ascending.
pub(super) fn faces_by_node(mesh: &Mesh, inside: &[bool]) -> Vec<(u32, Face)> {
    let mut faces = Vec::new();
    for element in (0..inside.len()).filter(|&e| inside[e]) {
        for local in 0..4 {
            let face = Face {
                element: element as u32,
                local,
            };
            if mesh
                .across(face)
                .is_some_and(|f| !inside[f.element as usize])
            {
                faces.extend(mesh.face_nodes(face).map(|n| (n, face)));
            }
        }
    }
    faces.sort_by_key(|f| (f.0, f.1.element, f.1.local));
    faces
}

/// The faces at a node.
pub(super) fn at(faces: &[(u32, Face)], node: u32) -> impl Iterator<Item = Face> + '_ {
    let first = faces.partition_point(|f| f.0 < node);
    let own = faces[first..].iter().take_while(move |f| f.0 == node);
    own.map(|f| f.1)
}

/// Distance of a point in a region to its surface; planes that bound the mesh do not count.
fn region_depth(region: &Region, bounds: &[Vec3; 2], x: Vec3) -> f64 {
    let size = (bounds[1] - bounds[0]).max_element();
    let inside = |c: Vec3| {
        let margin = (c - bounds[0]).min(bounds[1] - c);
        margin.min_element() > 1e-9 * size
    };
    match *region {
        Region::Box { min, max } => {
            let mut depth = f64::INFINITY;
            for k in 0..3 {
                if min[k] > bounds[0][k] + 1e-9 * size {
                    depth = depth.min(x[k] - min[k]);
                }
                if max[k] < bounds[1][k] - 1e-9 * size {
                    depth = depth.min(max[k] - x[k]);
                }
            }
            depth
        }
        Region::Sphere { centre, radius } => radius - (x - centre).length(),
        Region::Cylinder { start, end, radius } => {
            let length = (end - start).length();
            let along = (end - start) / length;
            let height = (x - start).dot(along);
            let mut depth = radius - (x - start - height * along).length();
            if inside(start) {
                depth = depth.min(height);
            }
            if inside(end) {
                depth = depth.min(length - height);
            }
            depth
        }
        Region::Cone { apex, end, radius } => {
            let length = (end - apex).length();
            let along = (end - apex) / length;
            let height = (x - apex).dot(along);
            let across = (x - apex - height * along).length();
            // The distance from the flank is that across, by the cosine of the half angle.
            let flank = (radius * height / length - across) * length / length.hypot(radius);
            if inside(end) {
                flank.min(length - height)
            } else {
                flank
            }
        }
        Region::HalfSpace { point, normal } => (point - x).dot(normal) / normal.length(),
    }
}
