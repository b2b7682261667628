//! A sector of an elastic cylinder under its own weight, suddenly there: what is computed does not
//! depend on the angle.

use moldwarp::material::{LinearElastic, Material};
use moldwarp::mesh::{CylinderSector, Split};
use moldwarp::plan::*;
use moldwarp::{Plan, Simulation, Vec3};

const ANGLE: f64 = 20.0;

fn plan(split: Split, mass: MassMatrix) -> Plan {
    let sector = CylinderSector {
        outer: vec![[0.5, 0.0], [0.5, 1.0]],
        inner: None,
        angle: ANGLE.to_radians(),
        radial: 3,
        around: 2,
        vertical: vec![4],
        radial_grading: 1.0,
        vertical_grading: vec![1.0],
        split,
    };
    let mesh = sector.mesh().unwrap();
    let surfaces = ["theta-min", "theta-max", "z-min"].map(|name| mesh.surface(name).unwrap());
    let model = Material::LinearElastic(LinearElastic {
        young_modulus: 1e5,
        poisson_ratio: 0.3,
    });
    Plan {
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
            name: "body".into(),
            place: Place::Volumes(vec![0]),
            material: 0,
            seeding: Seeding::Four,
        }],
        boundaries: vec![Boundary {
            name: "rollers".into(),
            surfaces: surfaces.to_vec(),
            kind: BoundaryKind::Roller,
        }],
        loads: vec![],
        contacts: vec![],
        probes: vec![],
        initial_stress: None,
        inherited: Default::default(),
        mesh_motion: None,
        numerics: Numerics {
            mass,
            ..Numerics::default()
        },
        stages: vec![Stage::new("fall", Until::Steps(50))],
    }
}

/// Radial, circumferential and vertical component at a place.
fn cylindrical(x: Vec3, v: Vec3) -> Vec3 {
    let radial = Vec3::new(x.x, x.y, 0.0).normalize_or_zero();
    Vec3::new(radial.dot(v), Vec3::Z.cross(radial).dot(v), v.z)
}

/// After 50 steps: the greatest difference of nodal displacements at the same radius and height, and
/// the greatest displacement round the axis, over the greatest radial one. The axis stays where it is
/// exactly in every step.
fn dependence_on_angle(split: Split, mass: MassMatrix) -> f64 {
    let mut sim = Simulation::new(plan(split, mass)).unwrap();
    let mut moved = vec![Vec3::ZERO; sim.mesh().nodes.len()];
    while !sim.finished() {
        sim.step().unwrap();
        let velocity = sim.node_fields().velocity;
        for ((x, v), u) in sim.mesh().nodes.iter().zip(&velocity).zip(&mut moved) {
            *u += *v * sim.time_step();
            if x.x == 0.0 && x.y == 0.0 {
                assert_eq!((v.x, v.y), (0.0, 0.0), "at {x} in step {}", sim.steps());
            }
        }
    }
    // Corners of cells, and middles of their faces and of themselves, by radius and height.
    let place = |x: Vec3| [x.truncate().length(), x.z].map(|c| (c * 1e9).round() as i64);
    let nodes = sim.mesh().nodes.iter().zip(&moved);
    let mut rings: Vec<_> = nodes
        .map(|(&x, &u)| (place(x), cylindrical(x, u)))
        .collect();
    rings.sort_by_key(|r| r.0);
    let differences = rings
        .chunk_by(|a, b| a.0 == b.0)
        .flat_map(|ring| ring.iter().map(|r| (r.1 - ring[0].1).abs().max_element()));
    let around = rings.iter().map(|r| r.1.y.abs());
    let greatest = rings.iter().map(|r| r.1.x.abs()).fold(0.0, f64::max);
    differences.chain(around).fold(0.0, f64::max) / greatest
}

/// A roller on a plane of symmetry is a mirror: it makes no difference whether a node lies on it or
/// between two cells that are mirror images.
#[test]
fn symmetric_cells_make_motion_independent_of_the_angle() {
    for mass in [MassMatrix::Lumped, MassMatrix::Corrected] {
        let dependence = dependence_on_angle(Split::Symmetric, mass);
        assert!(dependence < 1e-12, "{mass:?}: {dependence:e}");
    }
}

/// Cells in six are not symmetric themselves: the angle makes a difference as elements do, here with
/// three of them over the radius.
#[test]
fn cells_in_six_make_motion_nearly_independent_of_the_angle() {
    for mass in [MassMatrix::Lumped, MassMatrix::Corrected] {
        let dependence = dependence_on_angle(Split::Six, mass);
        assert!(
            (1e-6..0.1).contains(&dependence),
            "{mass:?}: {dependence:e}"
        );
    }
}
