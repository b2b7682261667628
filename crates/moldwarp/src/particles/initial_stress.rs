//! The stress that ground is in before anything is done to it, by the K₀ procedure.
//!
//! Under a horizontal surface the vertical stress at a depth is the weight above, σ_v = −(q + ∫ γ dz)
//! with the unit weights γ of the layers and a surcharge q, and the horizontal stress is K₀ σ_v.
//! Every particle gets the stress of its own depth: with the linear field and seeding that integrates
//! it exactly, nodal forces balance gravity to round-off. (With the stress of the element's centroid
//! the ground would tremble.)

use super::{Order, Particles};
use crate::Vec3;
use crate::mesh::{FACE_NODES, Mesh};
use crate::plan::{Body, NamedMaterial};
use crate::tensor::Voigt;

/// The K₀ procedure.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialStress {
    /// K₀ of each body, horizontal over vertical stress; none leaves a body free of stress, and its
    /// weight does not count.
    pub k0: Vec<Option<f64>>,
    /// Pressure on the surface, Pa.
    pub surcharge: f64,
}

/// Why the procedure cannot be used.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
pub enum InitialStressError {
    #[error("the K0 procedure needs gravity, and it is zero")]
    NoGravity,
    #[error(
        "the ground has a free face that is not horizontal or not at its surface: at {position} m \
         it faces up, {depth:e} m below the highest point"
    )]
    Sloping { position: Vec3, depth: f64 },
    #[error(
        "bodies `{first}` and `{second}` have different weights side by side: their elevations \
         overlap"
    )]
    SideBySide { first: String, second: String },
    #[error(
        "body `{body}` fills elements only in part: the K0 procedure needs layers that end on faces \
         of elements"
    )]
    NotOnFaces { body: String },
    #[error("the initial stress is beyond the strength of body `{body}`, first at {position:.4} m")]
    Yields { body: String, position: Vec3 },
}

/// Stress over depth in layered ground.
#[derive(Clone, Debug)]
pub struct Ground {
    up: Vec3,
    /// Bottom and top elevation, m, unit weight, N/m³, and overburden on top, Pa, from the top down.
    layers: Vec<Layer>,
    surcharge: f64,
}

#[derive(Clone, Copy, Debug)]
struct Layer {
    bottom: f64,
    top: f64,
    unit_weight: f64,
    overburden: f64,
}

crate::saved!(Layer {
    bottom,
    top,
    unit_weight,
    overburden
});
crate::saved!(Ground {
    up,
    layers,
    surcharge
});

impl Ground {
    /// `held` says whether anything holds or loads
    /// a mesh node, so that a face there needs not be the ground's surface.
    pub fn new(
        setting: &InitialStress,
        mesh: &Mesh,
        (bodies, materials): (&[Body], &[NamedMaterial]),
        gravity: Vec3,
        (particles, order): (&Particles, &Order),
        held: impl Fn(u32) -> bool,
    ) -> Result<Ground, InitialStressError> {
        let g = gravity.length();
        if g == 0.0 {
            return Err(InitialStressError::NoGravity);
        }
        let up = -gravity / g;
        let owner = owners(setting, mesh, bodies, particles, order)?;
        let layers = layers(mesh, &owner, up, bodies, |b| {
            materials[bodies[b].material].density * g
        })?;
        let mut ground = Ground {
            up,
            layers,
            surcharge: setting.surcharge,
        };
        let mut overburden = setting.surcharge;
        for layer in &mut ground.layers {
            layer.overburden = overburden;
            overburden += (layer.top - layer.bottom) * layer.unit_weight;
        }
        ground.check_surface(mesh, &owner, held)?;
        Ok(ground)
    }

    /// σ_v at a point, Pa, tension positive. Above the surface it goes on linearly.
    pub fn vertical(&self, x: Vec3) -> f64 {
        let z = x.dot(self.up);
        let layer = self
            .layers
            .iter()
            .find(|l| z >= l.bottom)
            .or(self.layers.last());
        layer.map_or(-self.surcharge, |l| {
            -(l.overburden + (l.top - z) * l.unit_weight)
        })
    }

    /// Unit weight at a point, N/m³; above the surface that of the uppermost layer.
    pub fn unit_weight(&self, x: Vec3) -> f64 {
        let z = x.dot(self.up);
        let layer = self.layers.iter().find(|l| z >= l.bottom);
        layer.or(self.layers.last()).map_or(0.0, |l| l.unit_weight)
    }

    /// Stress at a point of ground with this K₀, Pa.
    pub fn stress(&self, x: Vec3, k0: f64) -> Voigt {
        let vertical = self.vertical(x);
        self.tensor(vertical, k0 * vertical)
    }

    /// The tensor of a vertical and a horizontal stress.
    pub fn tensor(&self, vertical: f64, horizontal: f64) -> Voigt {
        let n = self.up;
        let along = |a: f64, b: f64| (vertical - horizontal) * a * b;
        [
            horizontal + along(n.x, n.x),
            horizontal + along(n.y, n.y),
            horizontal + along(n.z, n.z),
            along(n.x, n.y),
            along(n.y, n.z),
            along(n.z, n.x),
        ]
    }

    /// The ground's faces that look up and that nothing holds must be its surface.
    fn check_surface(
        &self,
        mesh: &Mesh,
        owner: &[Option<usize>],
        held: impl Fn(u32) -> bool,
    ) -> Result<(), InitialStressError> {
        let surface = self.layers.first().map_or(0.0, |l| l.top);
        let height = surface - self.layers.last().map_or(0.0, |l| l.bottom);
        for (e, tet) in mesh
            .tets
            .iter()
            .enumerate()
            .filter(|(e, _)| owner[*e].is_some())
        {
            for (local, corners) in FACE_NODES.iter().enumerate() {
                let across = mesh.neighbours[e][local] as usize;
                if owner.get(across).is_some_and(Option::is_some) {
                    continue;
                }
                let nodes = corners.map(|i| tet[i]);
                let [a, b, c] = nodes.map(|n| mesh.nodes[n as usize]);
                let area = (b - a).cross(c - a);
                if area.dot(self.up) < 1e-6 * area.length() || nodes.iter().all(|&n| held(n)) {
                    continue;
                }
                for position in [a, b, c] {
                    let depth = surface - position.dot(self.up);
                    if depth > 1e-6 * height {
                        return Err(InitialStressError::Sloping { position, depth });
                    }
                }
            }
        }
        Ok(())
    }
}

/// The body with initial stress that fills each element.
fn owners(
    setting: &InitialStress,
    mesh: &Mesh,
    bodies: &[Body],
    particles: &Particles,
    order: &Order,
) -> Result<Vec<Option<usize>>, InitialStressError> {
    let mut owners = vec![None; mesh.tets.len()];
    for (e, owner) in owners.iter_mut().enumerate() {
        let inside = order.inside(e);
        let volume: f64 = inside.iter().map(|&p| particles.volume[p as usize]).sum();
        let body = inside
            .first()
            .map(|&p| usize::from(particles.body[p as usize]));
        let Some(body) = body.filter(|&b| setting.k0[b].is_some()) else {
            continue;
        };
        if (volume / mesh.volumes[e] - 1.0).abs() > 1e-9 {
            let body = bodies[body].name.clone();
            return Err(InitialStressError::NotOnFaces { body });
        }
        *owner = Some(body);
    }
    Ok(owners)
}

/// Layers from the top down.
fn layers(
    mesh: &Mesh,
    owner: &[Option<usize>],
    up: Vec3,
    bodies: &[Body],
    unit_weight: impl Fn(usize) -> f64,
) -> Result<Vec<Layer>, InitialStressError> {
    let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; bodies.len()];
    for (e, body) in owner.iter().enumerate() {
        let Some(body) = *body else { continue };
        for &n in &mesh.tets[e] {
            let z = mesh.nodes[n as usize].dot(up);
            ranges[body] = [ranges[body][0].min(z), ranges[body][1].max(z)];
        }
    }
    let present = || (0..bodies.len()).filter(|&b| ranges[b][0] < ranges[b][1]);
    let mut levels: Vec<f64> = present().flat_map(|b| ranges[b]).collect();
    levels.sort_by(|a, b| b.total_cmp(a));
    let height = levels.first().copied().unwrap_or(0.0) - levels.last().copied().unwrap_or(0.0);
    levels.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * height);
    let mut found = Vec::new();
    for pair in levels.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        let mut here = present().filter(|&b| ranges[b][0] < middle && middle < ranges[b][1]);
        let Some(first) = here.next() else { continue };
        let weight = unit_weight(first);
        if let Some(second) = here.find(|&b| (unit_weight(b) / weight - 1.0).abs() > 1e-12) {
            return Err(InitialStressError::SideBySide {
                first: bodies[first].name.clone(),
                second: bodies[second].name.clone(),
            });
        }
        found.push(Layer {
            bottom: pair[1],
            top: pair[0],
            unit_weight: weight,
            overburden: 0.0,
        });
    }
    Ok(found)
}

/// Gives every particle its initial stress and checks it against the strength.
pub fn apply(
    ground: &Ground,
    setting: &InitialStress,
    particles: &mut Particles,
    bodies: &[Body],
    materials: &[NamedMaterial],
) -> Result<(), InitialStressError> {
    for p in 0..particles.len() {
        let body = usize::from(particles.body[p]);
        let Some(k0) = setting.k0[body] else { continue };
        let (position, body) = (particles.position.at(p), &bodies[body]);
        let stress = ground.stress(position, k0);
        if materials[body.material].model.yields(&stress) {
            let body = body.name.clone();
            return Err(InitialStressError::Yields { body, position });
        }
        particles.stress.set(p, stress);
    }
    Ok(())
}
