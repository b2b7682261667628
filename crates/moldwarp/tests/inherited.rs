//! Bodies with the particles of an earlier run.

use moldwarp::material::{LinearElastic, Material};
use moldwarp::mesh::box_mesh;
use moldwarp::particles::{InheritedError, InitialStress};
use moldwarp::plan::*;
use moldwarp::{Particles, Plan, SetupError, Simulation, Vec3};

const G: f64 = 9.81;
/// Height of the column, m.
const H: f64 = 2.0;

const FIXED: BoundaryKind = BoundaryKind::Fixed {
    directions: [true; 3],
};

fn layer(name: &str, bottom: f64, top: f64) -> Body {
    Body {
        name: name.into(),
        place: Place::Region(Region::Box {
            min: Vec3::new(0.0, 0.0, bottom),
            max: Vec3::new(1.0, 1.0, top),
        }),
        material: 0,
        seeding: Seeding::Four,
    }
}

/// A column of soil on what is given, with a metre of room above; `cells` of 0.5 m or less.
fn column(bottom: BoundaryKind, cells: usize, stages: Vec<Stage>) -> Plan {
    let mesh = box_mesh(Vec3::new(1.0, 1.0, 3.0), [cells, cells, 3 * cells]).unwrap();
    let elastic = LinearElastic {
        young_modulus: 1e7,
        poisson_ratio: 0.3,
    };
    let boundary = |name: &str, surfaces: &[&str], kind| Boundary {
        name: name.into(),
        surfaces: surfaces.iter().map(|s| mesh.surface(s).unwrap()).collect(),
        kind,
    };
    Plan {
        title: String::new(),
        gravity: Vec3::new(0.0, 0.0, -G),
        symmetry: None,
        materials: vec![NamedMaterial {
            name: "soil".into(),
            density: 2000.0,
            model: Material::LinearElastic(elastic),
        }],
        bodies: vec![layer("soil", 0.0, H)],
        boundaries: vec![
            boundary(
                "sides",
                &["x-min", "x-max", "y-min", "y-max"],
                BoundaryKind::Roller,
            ),
            boundary("bottom", &["z-min"], bottom),
        ],
        loads: vec![],
        contacts: vec![],
        probes: vec![],
        initial_stress: None,
        inherited: Particles::default(),
        mesh_motion: None,
        numerics: Numerics::default(),
        stages,
        mesh,
    }
}

/// Gravity loading until the forces are out of balance by less than 1e-6.
fn settling() -> Stage {
    let judged = Equilibrium {
        unbalanced: 1e-6,
        kinetic: 1e-9,
        hold: None,
    };
    let mut stage = Stage::new(
        "settled",
        Until::Equilibrium {
            limit: 60.0,
            judged,
        },
    );
    stage.damping = Some(0.7);
    stage
}

fn undamped() -> Stage {
    let mut stage = Stage::new("rest", Until::Steps(100));
    stage.reset_displacement = true;
    stage
}

/// The particles at the end of the first stage, and the simulation at the end of all.
fn run(plan: Plan) -> (Particles, Simulation) {
    let mut sim = Simulation::new(plan).unwrap();
    let mut left = None;
    while !sim.finished() {
        sim.step_and(|sim| {
            left.get_or_insert_with(|| sim.particles().clone());
        })
        .unwrap();
    }
    (left.unwrap(), sim)
}

/// The greatest velocity of nodes in the run of a plan, m/s, and its end.
fn greatest_velocity(plan: Plan) -> (f64, Simulation) {
    let mut sim = Simulation::new(plan).unwrap();
    let mut greatest = 0.0f64;
    while !sim.finished() {
        sim.step().unwrap();
        let velocities = sim.node_fields().velocity;
        greatest = velocities.iter().fold(greatest, |m, v| m.max(v.length()));
    }
    (greatest, sim)
}

fn inheriting(mut plan: Plan, particles: &Particles) -> Plan {
    plan.inherited = particles.clone();
    plan
}

/// What is out of balance by 1e-6 of the forces is accelerated by that share of g: in the time t of
/// 100 steps to 1e-6 g t at most, here 9e-8 √(gH). The one run has its own such velocities, so that it
/// and the two runs agree to about that: stresses to 3e-7 ρgH, positions to 5e-10 H.
#[test]
fn ground_at_rest_stays_at_rest_and_goes_on_as_if_the_run_did() {
    let (left, one_run) = run(column(FIXED, 2, vec![settling(), undamped()]));
    let plan = inheriting(column(FIXED, 2, vec![undamped()]), &left);
    let (greatest, two_runs) = greatest_velocity(plan);
    assert!(greatest > 0.0 && greatest < 1e-6 * G * two_runs.time());

    let (a, b) = (one_run.particles(), two_runs.particles());
    let (a_places, b_places) = (a.places_by_id(), b.places_by_id());
    let places = a_places
        .into_iter()
        .flatten()
        .zip(b_places.into_iter().flatten());
    let pairs = places.map(|(i, k)| (i as usize, k as usize));
    let weight = 2000.0 * G * H;
    let (mut stress, mut moved) = (0.0f64, 0.0f64);
    for (i, k) in pairs {
        stress = (0..6).fold(stress, |m, c| {
            m.max((a.stress.at(i)[c] - b.stress.at(k)[c]).abs())
        });
        moved = moved.max((a.position.at(i) - b.position.at(k)).length());
    }
    assert!(stress < 1e-6 * weight, "{stress} Pa");
    assert!(moved < 2e-9 * H, "{moved} m");
}

/// The same bound: without R₀ the boundary would yield by about g t.
#[test]
fn an_absorbing_boundary_begins_with_the_reaction_to_the_inherited_stress() {
    let absorbing = BoundaryKind::Absorbing {
        alpha: [1.0; 2],
        virtual_thickness: Some([2.0; 2]),
    };
    let (left, _) = run(column(FIXED, 2, vec![settling()]));
    let plan = inheriting(column(absorbing, 2, vec![undamped()]), &left);
    let (greatest, sim) = greatest_velocity(plan);
    assert!(greatest < 1e-6 * G * sim.time(), "{greatest} m/s");
}

/// Mass and volume are those of the particles, whatever the mesh; all are where they were.
#[test]
fn particles_are_found_in_another_mesh() {
    let (left, _) = run(column(FIXED, 2, vec![settling()]));
    let plan = inheriting(column(FIXED, 3, vec![undamped()]), &left);
    let sim = Simulation::new(plan).unwrap();
    let p = sim.particles();
    let mesh = sim.mesh();
    assert_eq!(p.len(), left.len());
    assert_eq!(p.total_mass(), left.total_mass());
    for (id, place) in p.places_by_id().into_iter().flatten().enumerate() {
        let (i, was) = (place as usize, left.id.iter().position(|&k| k == id as u32));
        assert!(mesh.contains(p.element[i], p.position.at(i)));
        let was = was.unwrap();
        assert_eq!(p.position.at(i), left.position.at(was));
        assert_eq!(p.stress.at(i), left.stress.at(was));
        assert_eq!(p.volume[i], left.volume[was]);
    }
    assert!(p.displacements().all(|u| u == Vec3::ZERO));
}

/// The column's particles in the plan of `change`; another body fills what is above 2 m.
fn refused(change: impl Fn(&mut Plan)) -> SetupError {
    let seeded = Simulation::new(column(FIXED, 2, vec![undamped()])).unwrap();
    let mut plan = inheriting(column(FIXED, 2, vec![undamped()]), seeded.particles());
    plan.bodies.push(layer("fill", H, H + 1.0));
    Simulation::new(plan.clone()).unwrap();
    change(&mut plan);
    Simulation::new(plan).unwrap_err()
}

#[test]
fn particles_that_have_no_place_are_refused() {
    // Boxes have the same surfaces in the same order.
    let error = refused(|plan| {
        plan.bodies.pop();
        plan.mesh = box_mesh(Vec3::new(1.0, 1.0, 1.5), [2, 2, 3]).unwrap();
    });
    let SetupError::Inherited(InheritedError::Outside {
        count, position, ..
    }) = error
    else {
        panic!("{error}");
    };
    // Those of a quarter of the 2 × 2 × 4 cells of 6 elements with 4 particles each.
    assert_eq!(count, 96);
    assert!(position.z > 1.5);

    let error = refused(|plan| plan.bodies[1] = layer("fill", 1.0, H + 1.0));
    assert!(
        matches!(error, SetupError::Inherited(InheritedError::Overlap { .. })),
        "{error}"
    );
}

#[test]
fn another_density_and_another_stress_are_refused() {
    let error = refused(|plan| plan.materials[0].density *= 1.0 + 1e-8);
    assert!(
        matches!(error, SetupError::Inherited(InheritedError::Density { .. })),
        "{error}"
    );
    let error = refused(|plan| {
        plan.initial_stress = Some(InitialStress {
            k0: vec![None, Some(0.5)],
            surcharge: 0.0,
        });
    });
    assert_eq!(error, SetupError::Inherited(InheritedError::InitialStress));
}
