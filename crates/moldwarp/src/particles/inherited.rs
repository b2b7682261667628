//! Particles that bodies have from an earlier run instead of being seeded.
//!
//! They keep position, mass, volumes, stress and state; they are at rest, and displacements count
//! from here. Where they are in the mesh is found anew: it need not be the mesh of the earlier run.

use super::Particles;
use crate::Vec3;
use crate::mesh::Mesh;
use crate::plan::{Body, Plan};

/// Volumes of particles follow the smoothed strain, so that those of ground that fills an element
/// do not sum to its volume exactly. Two bodies in an element overlap by more than this share of it.
const SLACK: f64 = 0.01;

/// Why inherited particles cannot be used in a plan.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
pub enum InheritedError {
    #[error(
        "{count} particles of body `{body}` from the earlier run lie outside the mesh, the first \
         at {position} m"
    )]
    Outside {
        body: String,
        count: usize,
        position: Vec3,
    },
    #[error(
        "body `{seeded}` is seeded where body `{inherited}` from the earlier run is, in element \
         {element}"
    )]
    Overlap {
        seeded: String,
        inherited: String,
        element: u32,
    },
    #[error(
        "body `{body}` inherits particles of {inherited} kg/m3 at the start, but its material has \
         {density} kg/m3"
    )]
    Density {
        body: String,
        inherited: f64,
        density: f64,
    },
    #[error("the stress of an earlier run and the K0 procedure exclude each other")]
    InitialStress,
}

/// Which bodies inherit particles.
pub(crate) fn bodies(plan: &Plan) -> Vec<bool> {
    let mut inherits = vec![false; plan.bodies.len()];
    let bodies = plan.inherited.body.iter();
    bodies.for_each(|&b| inherits[usize::from(b)] = true);
    inherits
}

/// Adds the inherited particles to the seeded ones; their ids count from `first_id`, in the order of those
/// that they had.
pub(crate) fn append(
    mut particles: Particles,
    plan: &Plan,
    first_id: u32,
) -> Result<Particles, InheritedError> {
    let inherited = &plan.inherited;
    if inherited.is_empty() {
        return Ok(particles);
    }
    if plan.initial_stress.is_some() {
        return Err(InheritedError::InitialStress);
    }
    check_density(plan)?;
    let element = locate(&plan.mesh, &plan.bodies, inherited)?;
    check_overlap(plan, &particles, &element)?;
    let count = inherited.len();
    let mut by_id: Vec<usize> = (0..count).collect();
    by_id.sort_unstable_by_key(|&p| inherited.id[p]);
    let mut id = vec![0; count];
    for (new, &p) in (first_id..).zip(&by_id) {
        id[p] = new;
    }
    particles.append(Particles {
        id: id.into(),
        element: element.into(),
        velocity: std::iter::repeat_n(Vec3::ZERO, count).collect(),
        origin: inherited.position.clone(),
        ..inherited.clone()
    });
    Ok(particles)
}

/// Mass is inherited, so weight and inertia are those of the earlier run: a material of another
/// density would not have them.
fn check_density(plan: &Plan) -> Result<(), InheritedError> {
    let p = &plan.inherited;
    for (i, &b) in p.body.iter().enumerate() {
        let body = &plan.bodies[usize::from(b)];
        let density = plan.materials[body.material].density;
        let inherited = p.mass[i] / p.initial_volume[i];
        if (inherited / density - 1.0).abs() > 1e-9 {
            return Err(InheritedError::Density {
                body: body.name.clone(),
                inherited,
                density,
            });
        }
    }
    Ok(())
}

/// The element of each particle.
fn locate(mesh: &Mesh, bodies: &[Body], p: &Particles) -> Result<Vec<u32>, InheritedError> {
    let [low, high] = mesh.bounds();
    let reach = 1e-9 * (high - low).max_element();
    let near = |x: Vec3| x.cmpge(low - reach).all() && x.cmple(high + reach).all();
    let mut last = 0;
    let mut outside: Option<(usize, usize)> = None;
    let mut elements = Vec::with_capacity(p.len());
    for (i, x) in p.position.iter().enumerate() {
        // A walk may end at a re-entrant corner though the mesh goes on behind it.
        let found = near(x).then(|| mesh.walk(last, x).or_else(|| mesh.find(x)));
        match (found.flatten(), &mut outside) {
            (Some(element), _) => last = element,
            (None, Some((first, count))) => *count += usize::from(p.body[*first] == p.body[i]),
            (None, None) => outside = Some((i, 1)),
        }
        elements.push(last);
    }
    match outside {
        None => Ok(elements),
        Some((first, count)) => Err(InheritedError::Outside {
            body: bodies[usize::from(p.body[first])].name.clone(),
            count,
            position: p.position.at(first),
        }),
    }
}

/// `elements` are those of the inherited particles.
fn check_overlap(plan: &Plan, seeded: &Particles, elements: &[u32]) -> Result<(), InheritedError> {
    let mut filled = vec![0.0; plan.mesh.tets.len()];
    let mut owner = vec![None; filled.len()];
    for (i, &e) in elements.iter().enumerate() {
        filled[e as usize] += plan.inherited.volume[i];
        owner[e as usize].get_or_insert(plan.inherited.body[i]);
    }
    for (i, &element) in seeded.element.iter().enumerate() {
        let e = element as usize;
        filled[e] += seeded.volume[i];
        if let Some(inherited) = owner[e]
            && filled[e] > plan.mesh.volumes[e] * (1.0 + SLACK)
        {
            let name = |b: u16| plan.bodies[usize::from(b)].name.clone();
            return Err(InheritedError::Overlap {
                seeded: name(seeded.body[i]),
                inherited: name(inherited),
                element,
            });
        }
    }
    Ok(())
}
