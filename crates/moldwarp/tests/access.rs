//! What is given to particles between steps is what a plan would give them, and is booked.

use moldwarp::material::{LinearElastic, Material};
use moldwarp::mesh::box_mesh;
use moldwarp::particles::{Tensors, Vectors};
use moldwarp::plan::*;
use moldwarp::{Plan, Simulation, Vec3};

fn plan() -> Plan {
    let mesh = box_mesh(Vec3::new(0.4, 0.4, 0.8), [2, 2, 4]).unwrap();
    let model = Material::LinearElastic(LinearElastic {
        young_modulus: 1e6,
        poisson_ratio: 0.2,
    });
    let all = |name: &str, kind| Boundary {
        name: name.into(),
        surfaces: vec![mesh.surface(name).unwrap()],
        kind,
    };
    let absorbing = BoundaryKind::Absorbing {
        alpha: [1.0, 1.0],
        virtual_thickness: Some([0.5, 0.5]),
    };
    Plan {
        title: String::new(),
        gravity: Vec3::new(0.0, 0.0, -10.0),
        symmetry: None,
        materials: vec![NamedMaterial {
            name: "soil".into(),
            density: 1000.0,
            model,
        }],
        bodies: vec![Body {
            name: "soil".into(),
            place: Place::Volumes(vec![0]),
            material: 0,
            seeding: Seeding::Four,
        }],
        boundaries: vec![
            all("z-min", absorbing),
            all("x-min", BoundaryKind::Roller),
            all("x-max", BoundaryKind::Roller),
            all("y-min", BoundaryKind::Roller),
            all("y-max", BoundaryKind::Roller),
        ],
        loads: vec![],
        contacts: vec![],
        probes: vec![],
        initial_stress: None,
        inherited: Default::default(),
        mesh_motion: None,
        numerics: Numerics::default(),
        stages: vec![Stage::new("run", Until::Steps(200))],
        mesh,
    }
}

fn run(sim: &mut Simulation, steps: usize) {
    (0..steps).for_each(|_| sim.step().unwrap());
}

/// Velocities at the start are those that a stage gives, bit for bit.
#[test]
fn a_given_start_is_the_plans() {
    let velocity = Vec3::new(0.0, 0.0, 0.1);
    let mut by_plan = plan();
    by_plan.stages[0].initial_velocities = vec![(0, velocity)];
    let mut by_plan = Simulation::new(by_plan).unwrap();
    let mut given = Simulation::new(plan()).unwrap();
    let stress = given.particles().stress.clone();
    assert!(
        by_plan
            .velocities_at_the_start()
            .iter()
            .all(|v| v == velocity)
    );
    let velocities: Vectors = stress.iter().map(|_| velocity).collect();
    given.begin_with(&velocities, &stress, false).unwrap();
    run(&mut by_plan, 50);
    run(&mut given, 50);
    assert_eq!(by_plan.particles().position, given.particles().position);
    assert_eq!(by_plan.energies(), given.energies());
}

/// A stress that balances gravity holds soil on an absorbing boundary at rest.
#[test]
fn a_given_stress_is_in_equilibrium_with_absorbing_boundaries() {
    let mut sim = Simulation::new(plan()).unwrap();
    let rest = sim.velocities_at_the_start();
    let stress: Tensors = (sim.particles().position.iter())
        .map(|x| {
            let vertical = -1e4 * (0.8 - x.z);
            [0.25 * vertical, 0.25 * vertical, vertical, 0.0, 0.0, 0.0]
        })
        .collect();
    sim.begin_with(&rest, &stress, true).unwrap();
    run(&mut sim, 200);
    let fastest = sim.particles().velocity.iter().map(Vec3::length);
    let fastest = fastest.fold(0.0, f64::max);
    // It would fall by 0.1 m/s in each hundredth of a second.
    assert!(
        sim.time() > 0.02 && fastest < 2e-4,
        "{fastest} m/s after {} s",
        sim.time()
    );
}

/// What a change of velocities gives is in the ledger: nothing is missing.
#[test]
fn changed_velocities_are_booked() {
    let mut sim = Simulation::new(plan()).unwrap();
    run(&mut sim, 40);
    let before = sim.energies().kinetic;
    let faster: Vectors = (sim.particles().velocity.iter()).map(|v| 2.0 * v).collect();
    let given: f64 = (sim
        .particles()
        .mass
        .iter()
        .zip(sim.particles().velocity.iter()))
    .map(|(m, v)| 1.5 * m * v.length_squared())
    .sum();
    sim.assign_velocity(faster);
    let gain = sim.energies().kinetic - before;
    assert!((gain / given - 1.0).abs() < 1e-12, "{gain} {given}");
    run(&mut sim, 160);
    assert!(sim.energies().residual.abs() < 1e-10 * sim.energy_turned_over());
}

/// What was taken out stays where it is in memory, and the simulation is none the worse.
#[test]
fn particles_that_are_taken_out_stay() {
    let (mut sim, mut untouched) = (
        Simulation::new(plan()).unwrap(),
        Simulation::new(plan()).unwrap(),
    );
    run(&mut sim, 10);
    run(&mut untouched, 10);
    let place = sim.particles().position.components()[2].as_ptr();
    let taken = sim.take_particles();
    assert_eq!(taken.position.components()[2].as_ptr(), place);
    let then = taken.position.clone();
    run(&mut sim, 10);
    run(&mut untouched, 10);
    assert_eq!(taken.position, then);
    assert_eq!(sim.particles().position, untouched.particles().position);
    assert_ne!(sim.particles().position, then);
}
