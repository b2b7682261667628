//! Particles never pass a face of an aligned contact: one that would is put back onto its side, keeps
//! its velocity, and is counted.

use super::state::Summed;
use crate::Vec3;
use crate::simulation::Simulation;
use crate::stop::Stop;

/// Most that a particle may be put back by, as a share of its element's shortest altitude. What is
/// farther has not slipped through by a hair: the body leaves its elements.
const FARTHEST: f64 = 0.1;
/// A particle is put this share of an altitude beyond the face.
const CLEAR: f64 = 1e-9;
/// Faces of an edge or corner are tried in turn.
const TRIES: usize = 4;

/// Puts back all particles that have passed a face; their elements are still the ones before.
pub(super) fn put_back(sim: &mut Simulation) -> Result<bool, Stop> {
    let mut crossed = false;
    sim.cells.summed = Summed::Nothing;
    for p in 0..sim.particles.len() {
        let (before, x) = (sim.particles.element[p], sim.particles.position.at(p));
        if sim.plan.mesh.contains(before, x) {
            continue;
        }
        let Some(place) = settle(sim, p) else {
            return Err(sim.passed_a_face(p));
        };
        let (found, at) = place;
        let moved = at - x;
        crossed |= found != before;
        sim.particles.element[p] = found;
        sim.particles.position.set(p, at);
        let work = sim.particles.mass[p] * sim.gravity.dot(moved);
        sim.ledger.gravity_work(work);
        sim.contacts.projections.add(moved.length(), work);
    }
    Ok(crossed)
}

/// Element and position on the particle's own side of the faces.
fn settle(sim: &Simulation, p: usize) -> Option<(u32, Vec3)> {
    let (mesh, contacts) = (&sim.plan.mesh, &sim.contacts);
    let field = sim.fields.of(sim.particles.body[p]);
    let (before, start) = (sim.particles.element[p], sim.particles.position.at(p));
    let mut x = start;
    for _ in 0..TRIES {
        let found = mesh.walk(before, x)?;
        if !contacts.blocks(field, before, found) {
            return Some((found, x));
        }
        let size = mesh.altitude(found as usize);
        let (n, depth) = contacts.passed(mesh, field, before, found, x)?;
        x += n * (depth + CLEAR * size);
        if (x - start).length() > FARTHEST * size {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Plan;
    use crate::material::{LinearElastic, Material};
    use crate::mesh::box_mesh;
    use crate::plan::*;

    /// Two cubes of a metre, one on the other, in elements of half a metre.
    fn tower() -> Simulation {
        let cube = |name: &str, bottom: f64| Body {
            name: name.into(),
            place: Place::Region(Region::Box {
                min: Vec3::new(0.0, 0.0, bottom),
                max: Vec3::new(1.0, 1.0, bottom + 1.0),
            }),
            material: 0,
            seeding: Seeding::Four,
        };
        let elastic = LinearElastic {
            young_modulus: 1e6,
            poisson_ratio: 0.0,
        };
        let plan = Plan {
            title: String::new(),
            gravity: Vec3::new(0.0, 0.0, -10.0),
            mesh: box_mesh(Vec3::new(1.0, 1.0, 3.0), [2, 2, 6]).unwrap(),
            symmetry: None,
            materials: vec![NamedMaterial {
                name: "rubber".into(),
                density: 1000.0,
                model: Material::LinearElastic(elastic),
            }],
            bodies: vec![cube("low", 0.0), cube("high", 1.0)],
            boundaries: vec![],
            loads: vec![],
            contacts: vec![Contact {
                name: "joint".into(),
                bodies: [vec![0], vec![1]],
                friction: 0.0,
                adhesion: 0.0,
                surface: ContactSurface::Aligned,
                gap_check: true,
            }],
            probes: vec![],
            initial_stress: None,
            inherited: Default::default(),
            mesh_motion: None,
            numerics: Numerics::default(),
            stages: vec![Stage::new("run", Until::Steps(1))],
        };
        Simulation::new(plan).unwrap()
    }

    /// The lowest particle of the upper cube goes below the face, the highest of the lower one above
    /// it: both come back to their side of it. One that is far beyond stops the run.
    #[test]
    fn particles_come_back_to_their_side() {
        let mut sim = tower();
        let own = |sim: &Simulation, body: u16| -> Vec<usize> {
            let body = |&p: &usize| sim.particles.body[p] == body;
            (0..sim.particles.len()).filter(body).collect()
        };
        let put = |sim: &mut Simulation, p: usize, z: f64| {
            let x = sim.particles.position.at(p);
            sim.particles.position.set(p, x.with_z(z));
        };
        let height = |sim: &Simulation, p: usize| sim.particles.position.at(p).z;
        for (body, sign) in [(1, -1.0), (0, 1.0)] {
            let nearest = |a: &usize, b: &usize| {
                let distance = |p: usize| (height(&sim, p) - 1.0).abs();
                distance(*a).total_cmp(&distance(*b))
            };
            let p = own(&sim, body).into_iter().min_by(nearest).unwrap();
            put(&mut sim, p, 1.0 + 0.01 * sign);
            assert!(put_back(&mut sim).is_ok());
            assert!((height(&sim, p) - 1.0) * sign < 0.0, "back on its side");
            assert!((height(&sim, p) - 1.0).abs() < 1e-8);
            let e = sim.particles.element[p];
            assert!(sim.plan.mesh.contains(e, sim.particles.position.at(p)));
        }
        let done = sim.contacts.projections;
        assert_eq!(done.count, 2);
        assert!((done.sum - 0.02).abs() < 1e-6);
        let p = own(&sim, 1)[0];
        put(&mut sim, p, 0.8);
        assert!(matches!(put_back(&mut sim), Err(Stop::PassedAFace { .. })));
    }
}
