//! Stages and initial stress: what is switched on begins in equilibrium.

use moldwarp::boundary::Function;
use moldwarp::material::{LinearElastic, Material};
use moldwarp::mesh::box_mesh;
use moldwarp::particles::{InitialStress, InitialStressError};
use moldwarp::plan::*;
use moldwarp::{Mesh, Plan, SetupError, Simulation, Stop, Vec3};

const G: f64 = 9.81;

fn soil(name: &str, density: f64) -> NamedMaterial {
    let elastic = LinearElastic {
        young_modulus: 1e7,
        poisson_ratio: 0.3,
    };
    NamedMaterial {
        name: name.into(),
        density,
        model: Material::LinearElastic(elastic),
    }
}

fn layer(name: &str, material: usize, bottom: f64, top: f64) -> Body {
    Body {
        name: name.into(),
        place: Place::Region(Region::Box {
            min: Vec3::new(0.0, 0.0, bottom),
            max: Vec3::new(1.0, 1.0, top),
        }),
        material,
        seeding: Seeding::Four,
    }
}

fn boundary(mesh: &Mesh, name: &str, surfaces: &[&str], kind: BoundaryKind) -> Boundary {
    Boundary {
        name: name.into(),
        surfaces: surfaces.iter().map(|s| mesh.surface(s).unwrap()).collect(),
        kind,
    }
}

const ABSORBING: BoundaryKind = BoundaryKind::Absorbing {
    alpha: [1.0; 2],
    virtual_thickness: Some([2.0; 2]),
};

/// Two layers, 3 m high in all, with a metre of room above, on rollers and what is given below.
fn ground(bottom: BoundaryKind) -> Plan {
    let mesh = box_mesh(Vec3::new(1.0, 1.0, 4.0), [2, 2, 8]).unwrap();
    let sides = ["x-min", "x-max", "y-min", "y-max"];
    Plan {
        title: String::new(),
        gravity: Vec3::new(0.0, 0.0, -G),
        symmetry: None,
        materials: vec![soil("clay", 1600.0), soil("sand", 2000.0)],
        bodies: vec![layer("clay", 0, 2.0, 3.0), layer("sand", 1, 0.0, 2.0)],
        boundaries: vec![
            boundary(&mesh, "sides", &sides, BoundaryKind::Roller),
            boundary(&mesh, "bottom", &["z-min"], bottom),
        ],
        loads: vec![],
        contacts: vec![],
        probes: vec![],
        initial_stress: Some(InitialStress {
            k0: vec![Some(0.5), Some(0.4)],
            surcharge: 0.0,
        }),
        inherited: Default::default(),
        mesh_motion: None,
        numerics: Numerics::default(),
        stages: vec![Stage::new("rest", Until::Steps(1000))],
        mesh,
    }
}

fn run(plan: Plan) -> Simulation {
    let mut sim = Simulation::new(plan).unwrap();
    while !sim.finished() {
        sim.step().unwrap();
    }
    sim
}

fn greatest_displacement(sim: &Simulation) -> f64 {
    let lengths = sim.particles().displacements().map(|u| u.length());
    lengths.fold(0.0, f64::max)
}

/// σ_v is the weight above, at the particle's own depth; σ_h is K₀ σ_v.
#[test]
fn the_stress_of_layers_is_the_weight_above() {
    let sim = Simulation::new(ground(BoundaryKind::Roller)).unwrap();
    let p = sim.particles();
    for (x, stress) in p.position.iter().zip(p.stress.iter()) {
        let (vertical, k0) = match x.z {
            z if z > 2.0 => (-1600.0 * G * (3.0 - z), 0.5),
            z => (-G * (1600.0 + 2000.0 * (2.0 - z)), 0.4),
        };
        let expected = [k0 * vertical, k0 * vertical, vertical, 0.0, 0.0, 0.0];
        let close = |(a, b): (&f64, f64)| (a - b).abs() < 1e-9 * G * 5600.0;
        assert!(stress.iter().zip(expected).all(close), "{x}: {stress:?}");
    }
}

#[test]
fn ground_on_rollers_and_on_an_absorbing_bottom_stays_at_rest() {
    for bottom in [BoundaryKind::Roller, ABSORBING] {
        let sim = run(ground(bottom));
        assert!(greatest_displacement(&sim) < 1e-12);
        assert!(sim.energies().residual.abs() < 1e-12);
    }
}

/// Gravity on rollers with damping, then the bottom becomes absorbing: nothing happens.
#[test]
fn an_absorbing_bottom_takes_over_what_a_roller_has_held() {
    let mut plan = ground(BoundaryKind::Roller);
    plan.initial_stress = None;
    let absorbing = boundary(&plan.mesh, "soft", &["z-min"], ABSORBING);
    plan.boundaries.push(absorbing);
    let limit = 10.0;
    let judged = Equilibrium {
        unbalanced: 1e-9,
        kinetic: 1e-18,
        hold: None,
    };
    plan.stages = vec![
        Stage {
            damping: Some(0.7),
            ..Stage::new("gravity", Until::Equilibrium { limit, judged })
        },
        Stage {
            on: vec![Item::Boundary(2)],
            off: vec![Item::Boundary(1)],
            reset_displacement: true,
            ..Stage::new("soft", Until::Steps(1000))
        },
    ];
    let mut sim = Simulation::new(plan).unwrap();
    while sim.stage() == 0 {
        sim.step().unwrap();
    }
    let settled = G * (1600.0 * 0.5 + 1600.0 * 2.0 + 2000.0 * 2.0) / (1e7 * 1.346);
    assert_eq!(greatest_displacement(&sim), 0.0, "reset");
    while !sim.finished() {
        sim.step().unwrap();
    }
    assert!(greatest_displacement(&sim) < 1e-6 * settled);
}

/// A face that a pressure of the initial stress holds stays: on a mesh that follows the layers no
/// particle is faster than 1e-10 √(gH) in 100 steps. With a tenth less it moves.
#[test]
fn a_face_held_by_its_initial_stress_stays() {
    for (factor, moves) in [(1.0, false), (0.9, true)] {
        let mut plan = ground(BoundaryKind::Roller);
        plan.boundaries[0].surfaces.remove(1);
        for body in 0..2 {
            plan.loads.push(Load {
                name: format!("face {body}"),
                surfaces: vec![],
                body,
                kind: LoadKind::InitialStress,
                function: Function::Constant,
            });
        }
        // The faces of x = 1 m by the layer that they belong to, without the room above.
        let side = plan.mesh.surface("x-max").unwrap();
        let faces = plan.mesh.surfaces[side].faces.clone();
        for (body, (low, high)) in [(2.0, 3.0), (0.0, 2.0)].into_iter().enumerate() {
            let middle = |f: moldwarp::mesh::Face| {
                let nodes = plan
                    .mesh
                    .face_nodes(f)
                    .map(|n| plan.mesh.nodes[n as usize].z);
                nodes.iter().sum::<f64>() / 3.0
            };
            let own = faces
                .iter()
                .copied()
                .filter(|&f| (low..high).contains(&middle(f)));
            let surface = moldwarp::mesh::Surface {
                name: format!("face {body}"),
                faces: own.collect(),
            };
            plan.loads[body].surfaces = vec![plan.mesh.surfaces.len()];
            plan.mesh.surfaces.push(surface);
        }
        let ramp = Ramp {
            from: None,
            to: factor,
            over: 0.0,
        };
        plan.stages[0].levels = vec![(Level::Load(0), ramp), (Level::Load(1), ramp)];
        plan.stages[0].until = Until::Steps(100);
        let mut sim = Simulation::new(plan).unwrap();
        let mut greatest = 0.0f64;
        while !sim.finished() {
            sim.step().unwrap();
            let speeds = sim.particles().velocity.iter().map(|v| v.length());
            greatest = speeds.fold(greatest, f64::max);
        }
        greatest /= (G * 3.0).sqrt();
        println!("load × {factor}: greatest velocity {greatest:e} √(gH)");
        assert_eq!(greatest > 1e-10, moves, "{greatest}");
    }
}

#[test]
fn what_the_k0_procedure_cannot_do_is_refused() {
    let error = |plan: Plan| match Simulation::new(plan) {
        Err(SetupError::InitialStress(error)) => error,
        other => panic!("{:?}", other.err()),
    };
    let mut plan = ground(BoundaryKind::Roller);
    plan.gravity = Vec3::ZERO;
    assert_eq!(error(plan), InitialStressError::NoGravity);
    let mut plan = ground(BoundaryKind::Roller);
    plan.bodies[0].place = Place::Region(Region::Box {
        min: Vec3::new(0.0, 0.0, 2.0),
        max: Vec3::new(0.5, 1.0, 3.0),
    });
    assert!(matches!(error(plan), InitialStressError::Sloping { .. }));
    let mut plan = ground(BoundaryKind::Roller);
    plan.bodies[0].place = Place::Region(Region::HalfSpace {
        point: Vec3::new(0.0, 0.0, 2.6),
        normal: Vec3::Z,
    });
    assert!(matches!(Simulation::new(plan), Err(SetupError::Seeding(_))));
    let mut plan = ground(BoundaryKind::Roller);
    plan.bodies[0] = layer("clay", 0, 2.0, 2.7);
    assert!(matches!(error(plan), InitialStressError::NotOnFaces { .. }));
}

/// A stage that does not come to rest in time says so with what it measured.
#[test]
fn no_equilibrium_within_the_limit_stops_the_run() {
    let mut plan = ground(BoundaryKind::Roller);
    plan.initial_stress = None;
    plan.stages[0].until = Until::Equilibrium {
        limit: 0.05,
        judged: Equilibrium::default(),
    };
    let mut sim = Simulation::new(plan).unwrap();
    let stop = std::iter::repeat_with(|| sim.step())
        .find_map(Result::err)
        .unwrap();
    assert!(
        matches!(stop, Stop::NotAtRest { unbalanced, .. } if unbalanced > 0.01),
        "{stop}"
    );
}

/// At rest on rollers with K₀ = ν/(1 − ν) of its material, ground that becomes half as stiff stays:
/// stresses do not change, only what further strain does to them. With less strength it yields.
#[test]
fn a_body_becomes_another_material() {
    let mut plan = ground(BoundaryKind::Roller);
    plan.boundaries[0].surfaces.remove(1);
    let elastic = LinearElastic {
        young_modulus: 1e7,
        poisson_ratio: 0.3,
    };
    for (name, cohesion) in [("strong", 1e5), ("weak", 1e2)] {
        let parameters = moldwarp::material::MohrCoulombParameters {
            cohesion,
            friction_angle: 0.3,
            dilation_angle: 0.0,
            tension_cutoff: None,
        };
        let soil = moldwarp::material::MohrCoulomb::new(elastic, parameters).unwrap();
        plan.materials.push(NamedMaterial {
            name: name.into(),
            density: 1600.0,
            model: Material::MohrCoulomb(soil),
        });
    }
    plan.bodies.truncate(1);
    plan.bodies[0] = layer("clay", 2, 0.0, 3.0);
    plan.initial_stress = None;
    let judged = Equilibrium::default();
    plan.stages = vec![
        Stage {
            damping: Some(0.7),
            ..Stage::new("strong", Until::Equilibrium { limit: 5.0, judged })
        },
        Stage {
            materials: vec![(0, 3)],
            reset_displacement: true,
            ..Stage::new("weak", Until::Duration(0.1))
        },
    ];
    let room = plan.mesh.surface("x-max").unwrap();
    plan.boundaries[0].surfaces.retain(|&s| s != room);
    let sim = run(plan);
    assert!(
        greatest_displacement(&sim) > 1e-4,
        "{}",
        greatest_displacement(&sim)
    );
    assert!(sim.energies().plastic > 0.0);
}
