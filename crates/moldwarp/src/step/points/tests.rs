//! The pass over particles does the same whichever way a slot is taken.

use crate::material::{LinearElastic, Material, MohrCoulomb, MohrCoulombParameters};
use crate::mesh::box_mesh;
use crate::plan::*;
use crate::{Simulation, Vec3};
use std::sync::atomic::{AtomicBool, Ordering};

/// Other tests that run meanwhile should not notice.
pub static IN_PARTS: AtomicBool = AtomicBool::new(false);

/// Soil that is thrown up, yields, opens and crosses elements.
fn heap(model: Material) -> Simulation {
    let (min, max) = (Vec3::ZERO, Vec3::new(1.0, 1.0, 1.5));
    let mesh = box_mesh(Vec3::new(3.0, 1.0, 3.0), [6, 2, 6]).unwrap();
    let surface = |name| mesh.surface(name).unwrap();
    let bottom = surface("z-min");
    let sides = ["x-min", "x-max", "y-min", "y-max"].map(surface);
    let plan = Plan {
        title: String::new(),
        gravity: Vec3::new(0.0, 0.0, -9.81),
        mesh,
        symmetry: None,
        materials: vec![NamedMaterial {
            name: "soil".into(),
            density: 1800.0,
            model,
        }],
        bodies: vec![Body {
            name: "heap".into(),
            place: Place::Region(Region::Box { min, max }),
            material: 0,
            seeding: Seeding::Four,
        }],
        boundaries: vec![
            Boundary {
                name: "floor".into(),
                surfaces: vec![bottom],
                kind: BoundaryKind::Fixed {
                    directions: [true; 3],
                },
            },
            Boundary {
                name: "sides".into(),
                surfaces: sides.to_vec(),
                kind: BoundaryKind::Roller,
            },
        ],
        loads: vec![],
        contacts: vec![],
        probes: vec![],
        initial_stress: None,
        inherited: Default::default(),
        mesh_motion: None,
        numerics: Numerics::default(),
        stages: vec![Stage::new("run", Until::Steps(150))],
    };
    let mut sim = Simulation::new(plan).unwrap();
    sim.set_velocity(|x| Vec3::new(0.8 * x.z, 0.0, 1.5 * x.z))
        .unwrap();
    sim
}

#[test]
fn usual_slots_are_the_same_in_parts() {
    let elastic = LinearElastic {
        young_modulus: 1e6,
        poisson_ratio: 0.3,
    };
    let parameters = MohrCoulombParameters {
        cohesion: 100.0,
        friction_angle: 0.5,
        dilation_angle: 0.1,
        tension_cutoff: None,
    };
    let cut = MohrCoulombParameters {
        tension_cutoff: Some(50.0),
        ..parameters
    };
    let soil = |p| Material::MohrCoulomb(MohrCoulomb::new(elastic, p).unwrap());
    for model in [
        soil(parameters),
        soil(cut),
        Material::LinearElastic(elastic),
    ] {
        let run = |in_parts| {
            IN_PARTS.store(in_parts, Ordering::Relaxed);
            let mut sim = heap(model.clone());
            while !sim.finished() {
                sim.step().unwrap();
            }
            IN_PARTS.store(false, Ordering::Relaxed);
            sim
        };
        let (usual, parts) = (run(false), run(true));
        assert_eq!(usual.particles.position, parts.particles.position);
        assert_eq!(usual.particles.velocity, parts.particles.velocity);
        assert_eq!(usual.particles.stress, parts.particles.stress);
        assert_eq!(usual.particles.state, parts.particles.state);
        assert_eq!(usual.particles.volume, parts.particles.volume);
        let states = &usual.particles.state;
        let met = |k: usize| states.iter().filter(|state| state[k] > 0.0).count();
        if matches!(model, Material::MohrCoulomb(_)) {
            assert!(met(2) > 0 && met(3) > 0, "{} {}", met(2), met(3));
        }
    }
}
