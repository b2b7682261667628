//! Probes: quantities on surfaces, at points and of bodies over time.
//!
//! A surface that carries a boundary is measured on its nodes (area-weighted mean; displacement
//! is the integral of nodal velocity, the reaction a sum), any other surface on the particles
//! seeded next to it; a point on the particle nearest to it at the start; a body on the
//! mass-weighted mean of its particles; a part of the mesh on the particles in its elements.

use crate::Vec3;
use crate::contact::Contacts;
use crate::mesh::{Mesh, NONE};
use crate::parallel::fold;
use crate::particles::{Order, Particles};
use crate::plan::{Plan, Probe, Quantity, Target};
use crate::simulation::Simulation;
use crate::tensor::Voigt;
use std::ops::Range;

/// What one probe looks at.
#[derive(Clone, Debug)]
enum Place {
    Nodes {
        nodes: Vec<SurfaceNode>,
        elements: Vec<(u32, f64)>,
    },
    /// Places in the particle arrays with weights that sum to 1.
    Particles(Vec<(u32, f64)>),
    Body(u16),
    /// A volume group of the mesh.
    Volume(usize),
}

#[derive(Clone, Debug)]
struct SurfaceNode {
    node: u32,
    /// Share of the surface's area.
    weight: f64,
    start: Vec3,
    displacement: Vec3,
}

/// All probes of a simulation.
#[derive(Clone, Debug, Default)]
pub struct Probes {
    places: Vec<Place>,
    /// Of probes that record the force of a contact: nodes of the surface, ascending, each with the
    /// part of its body's faces there that belong to it. Nothing for others.
    touching: Vec<Vec<(u32, f64)>>,
}

crate::saved_enum!(Place {
    0 => Nodes { nodes, elements },
    1 => Particles(particles),
    2 => Body(body),
    3 => Volume(group),
});
crate::saved!(SurfaceNode {
    node,
    weight,
    start,
    displacement
});
crate::saved!(Probes { places, touching });

impl Probes {
    /// Whether they are probes of this plan, with so many particles.
    pub(crate) fn fit(&self, plan: &Plan, particles: usize) -> bool {
        let there = |place: &Place| match place {
            Place::Particles(list) => list.iter().all(|p| (p.0 as usize) < particles),
            Place::Nodes { .. } | Place::Body(_) | Place::Volume(_) => true,
        };
        self.places.len() == plan.probes.len() && self.places.iter().all(there)
    }

    pub(crate) fn new(plan: &Plan, particles: &Particles, order: &Order) -> Probes {
        let place = |probe: &Probe| match probe.target {
            Target::Surface(s) if plan.boundaries.iter().any(|b| b.surfaces.contains(&s)) => {
                boundary_surface(&plan.mesh, s, order)
            }
            Target::Surface(s) => Place::Particles(next_to(&plan.mesh, s, order)),
            Target::Point(x) => {
                let distance = |p: &usize| (particles.position.at(*p) - x).length_squared();
                let nearest =
                    (0..particles.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
                Place::Particles(vec![(nearest.unwrap_or(0) as u32, 1.0)])
            }
            Target::Body(b) => Place::Body(b as u16),
            Target::Volume(group) => Place::Volume(group),
        };
        Probes {
            places: plan.probes.iter().map(place).collect(),
            touching: Vec::new(),
        }
    }

    /// Finds the parts of contacts that probes look at; the name of one that looks at none is the
    /// error.
    pub(crate) fn find_contacts(&mut self, plan: &Plan, contacts: &Contacts) -> Result<(), String> {
        for probe in &plan.probes {
            let wanted = probe.quantities.contains(&Quantity::Contact);
            let found = match probe.target {
                Target::Surface(s) if wanted => contacts.shares(&plan.mesh, s),
                _ => Vec::new(),
            };
            if wanted && found.is_empty() {
                return Err(probe.name.clone());
            }
            self.touching.push(found);
        }
        Ok(())
    }

    /// Surfaces with a boundary have other elements beside them, as bodies have come or gone.
    pub(crate) fn bodies_changed(&mut self, plan: &Plan, order: &Order) {
        for (place, probe) in self.places.iter_mut().zip(&plan.probes) {
            if let (Place::Nodes { elements, .. }, Target::Surface(s)) = (place, probe.target) {
                *elements = occupied_elements(&plan.mesh, s, order);
            }
        }
    }

    /// The bodies whose particles a probe looks at; none if it looks at nodes of the mesh.
    pub(crate) fn bodies(&self, probe: usize, particles: &Particles) -> Option<Vec<usize>> {
        let body = |place: u32| particles.body.get(place as usize).copied();
        match &self.places[probe] {
            Place::Nodes { .. } | Place::Volume(_) => None,
            Place::Body(body) => Some(vec![usize::from(*body)]),
            Place::Particles(places) => {
                let bodies = places.iter().filter_map(|p| body(p.0));
                Some(bodies.map(usize::from).collect())
            }
        }
    }

    /// Follows particles to their new places. Of those without one the others take over the weight; a probe
    /// of none has no values any more.
    pub(crate) fn reorder(&mut self, destination: &[u32]) {
        for place in &mut self.places {
            let Place::Particles(particles) = place else {
                continue;
            };
            let count = particles.len();
            particles
                .iter_mut()
                .for_each(|p| p.0 = destination[p.0 as usize]);
            particles.retain(|p| p.0 != NONE);
            if particles.len() < count {
                let whole: f64 = particles.iter().map(|p| p.1).sum();
                particles.iter_mut().for_each(|p| p.1 /= whole);
            }
        }
    }

    /// Adds the last drift to the displacements of surface nodes.
    pub(crate) fn add_drift(&mut self, moved: impl Fn(u32) -> Vec3) {
        for place in &mut self.places {
            if let Place::Nodes { nodes, .. } = place {
                nodes
                    .iter_mut()
                    .for_each(|n| n.displacement += moved(n.node));
            }
        }
    }

    /// Displacements of surface nodes count from now.
    pub(crate) fn reset_displacement(&mut self) {
        for place in &mut self.places {
            if let Place::Nodes { nodes, .. } = place {
                for node in nodes {
                    node.start += node.displacement;
                    node.displacement = Vec3::ZERO;
                }
            }
        }
    }

    /// Name and unit of each column.
    pub(crate) fn columns(plan: &Plan) -> Vec<(String, &'static str)> {
        let mut columns = Vec::new();
        for probe in &plan.probes {
            for quantity in &probe.quantities {
                let names = quantity.columns(&probe.name);
                columns.extend(names.map(|name| (name, quantity.unit())));
            }
        }
        columns
    }

    /// Appends the values of all columns.
    pub(crate) fn values(&self, sim: &Simulation, out: &mut Vec<f64>) {
        let down = sim.plan().gravity.normalize_or_zero();
        for (number, (probe, place)) in sim.plan().probes.iter().zip(&self.places).enumerate() {
            for &quantity in &probe.quantities {
                match quantity {
                    Quantity::Penetration => {
                        out.push(place.vector(sim, Quantity::Displacement).dot(down) + 0.0);
                    }
                    Quantity::Contact => {
                        out.extend(sim.contact_force(&self.touching[number]).to_array());
                    }
                    Quantity::Stress => out.extend(place.stress(sim)),
                    Quantity::Volume => out.push(place.volume(sim)),
                    _ => out.extend(place.vector(sim, quantity).to_array()),
                }
            }
        }
    }
}

impl Place {
    fn vector(&self, sim: &Simulation, quantity: Quantity) -> Vec3 {
        match self {
            Place::Nodes { nodes, .. } => {
                let weight = |n: &SurfaceNode| {
                    if quantity == Quantity::Reaction {
                        1.0
                    } else {
                        n.weight
                    }
                };
                nodes
                    .iter()
                    .map(|n| n.vector(sim, quantity) * weight(n))
                    .sum()
            }
            Place::Particles(gone) if gone.is_empty() => Vec3::NAN,
            Place::Particles(particles) => particles
                .iter()
                .map(|&(p, w)| particle_vector(sim, p as usize, quantity) * w)
                .sum(),
            Place::Body(body) => {
                let mean = body_mean(sim, *body, |p| particle_vector(sim, p, quantity).to_array());
                Vec3::from_array(mean)
            }
            Place::Volume(_) => Vec3::ZERO,
        }
    }

    /// Volume of the material without what has opened in tension, m³.
    fn volume(&self, sim: &Simulation) -> f64 {
        let (plan, particles) = (sim.plan(), sim.particles());
        let solid = |p: usize| {
            let body = &plan.bodies[usize::from(particles.body[p])];
            let model = &plan.materials[body.material].model;
            particles.volume[p] * model.solid_share(&particles.state.at(p))
        };
        // The sum of nothing is −0.
        let volume: f64 = match self {
            Place::Volume(group) => {
                let elements = &plan.mesh.volume_groups[*group].elements;
                let inside = |&e: &u32| sim.particles_in(e);
                elements.iter().flat_map(inside).map(solid).sum()
            }
            Place::Body(body) => {
                let all = 0..particles.len();
                all.filter(|&p| particles.body[p] == *body).map(solid).sum()
            }
            Place::Nodes { .. } | Place::Particles(_) => 0.0,
        };
        volume + 0.0
    }

    fn stress(&self, sim: &Simulation) -> Voigt {
        let mut mean = [0.0; 6];
        match self {
            Place::Nodes { elements, .. } => {
                for &(e, weight) in elements {
                    if let Some(stress) = sim.element_stress(e) {
                        crate::tensor::add_scaled(&mut mean, &stress, weight);
                    }
                }
            }
            Place::Particles(gone) if gone.is_empty() => mean = [f64::NAN; 6],
            Place::Particles(particles) => {
                for &(p, weight) in particles {
                    crate::tensor::add_scaled(
                        &mut mean,
                        &sim.particles().stress.at(p as usize),
                        weight,
                    );
                }
            }
            Place::Body(body) => mean = body_mean(sim, *body, |p| sim.particles().stress.at(p)),
            Place::Volume(_) => {}
        }
        mean
    }
}

impl SurfaceNode {
    fn vector(&self, sim: &Simulation, quantity: Quantity) -> Vec3 {
        let node = sim.node(self.node);
        match quantity {
            Quantity::Displacement => self.displacement,
            Quantity::Position => self.start + self.displacement,
            Quantity::Velocity => node.map_or(Vec3::ZERO, |n| n.grid_velocity),
            Quantity::Acceleration => node.map_or(Vec3::ZERO, |n| n.acceleration),
            Quantity::Reaction => sim.reaction(self.node),
            Quantity::Stress | Quantity::Volume | Quantity::Penetration | Quantity::Contact => {
                Vec3::ZERO
            }
        }
    }
}

fn particle_vector(sim: &Simulation, p: usize, quantity: Quantity) -> Vec3 {
    let particles = sim.particles();
    match quantity {
        Quantity::Displacement => particles.displacement(p),
        Quantity::Position => particles.position.at(p),
        Quantity::Velocity => particles.velocity.at(p),
        Quantity::Acceleration => sim.acceleration_at(p),
        Quantity::Reaction
        | Quantity::Stress
        | Quantity::Volume
        | Quantity::Penetration
        | Quantity::Contact => Vec3::ZERO,
    }
}

/// Mass-weighted mean over the particles of a body.
fn body_mean<const N: usize>(
    sim: &Simulation,
    body: u16,
    value: impl Fn(usize) -> [f64; N] + Sync,
) -> [f64; N]
where
    [f64; N]: Default,
{
    let particles = sim.particles();
    let (sum, mass) = fold(0..particles.len(), 4096, &|range: Range<usize>| {
        let mut sum = (<[f64; N]>::default(), 0.0);
        for p in range.filter(|&p| particles.body[p] == body) {
            let m = particles.mass[p];
            let x = value(p);
            (0..N).for_each(|k| sum.0[k] += m * x[k]);
            sum.1 += m;
        }
        sum
    });
    sum.map(|x| x / mass)
}

fn boundary_surface(mesh: &Mesh, surface: usize, order: &Order) -> Place {
    let faces = &mesh.surfaces[surface].faces;
    let area: f64 = faces.iter().map(|&f| mesh.face_area(f).length()).sum();
    let mut shares: Vec<(u32, f64)> = faces
        .iter()
        .flat_map(|&f| {
            mesh.face_nodes(f)
                .map(|n| (n, mesh.face_area(f).length() / (3.0 * area)))
        })
        .collect();
    shares.sort_by_key(|s| s.0);
    let nodes = shares.chunk_by(|a, b| a.0 == b.0).map(|same| SurfaceNode {
        node: same[0].0,
        weight: same.iter().map(|s| s.1).sum(),
        start: mesh.nodes[same[0].0 as usize],
        displacement: Vec3::ZERO,
    });
    Place::Nodes {
        nodes: nodes.collect(),
        elements: occupied_elements(mesh, surface, order),
    }
}

/// Elements with particles next to a surface, with their shares of its area.
fn occupied_elements(mesh: &Mesh, surface: usize, order: &Order) -> Vec<(u32, f64)> {
    let occupied = |e: u32| !order.inside(e as usize).is_empty();
    let mut elements = Vec::new();
    for &face in &mesh.surfaces[surface].faces {
        let sides = [Some(face), mesh.across(face)];
        if let Some(side) = sides.into_iter().flatten().find(|f| occupied(f.element)) {
            elements.push((side.element, mesh.face_area(side).length()));
        }
    }
    let total: f64 = elements.iter().map(|e| e.1).sum();
    elements
        .iter()
        .map(|&(e, area)| (e, area / total))
        .collect()
}

/// Particles next to a surface; those of an element share its faces' area equally.
fn next_to(mesh: &Mesh, surface: usize, order: &Order) -> Vec<(u32, f64)> {
    occupied_elements(mesh, surface, order)
        .into_iter()
        .flat_map(|(e, weight)| {
            let inside = order.inside(e as usize);
            let share = weight / inside.len() as f64;
            inside.iter().map(move |&p| (p, share))
        })
        .collect()
}
