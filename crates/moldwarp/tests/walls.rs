//! A fixed surface inside the mesh parts the material on its two sides.

use moldwarp::material::{LinearElastic, Material};
use moldwarp::mesh::{Face, Surface, box_mesh};
use moldwarp::plan::*;
use moldwarp::{Plan, Simulation, Vec3};

/// A box of 1 × 1 × 2 m with a wall at half its height. The bodies: `below` of particles under the
/// wall, and soil above it.
fn halves(below: bool) -> Plan {
    let mut mesh = box_mesh(Vec3::new(1.0, 1.0, 2.0), [2, 2, 4]).unwrap();
    let faces = (0..mesh.tets.len() as u32)
        .flat_map(|element| (0..4).map(move |local| Face { element, local }));
    // Each once, seen from below.
    let level = |f: &Face| {
        let corners = mesh.face_nodes(*f).map(|n| mesh.nodes[n as usize].z);
        corners.iter().all(|z| (z - 1.0).abs() < 1e-12) && mesh.face_area(*f).z > 0.0
    };
    let wall = Surface {
        name: "wall".into(),
        faces: faces.filter(level).collect(),
    };
    mesh.surfaces.push(wall);
    let half = |name: &str, bottom: f64| Body {
        name: name.into(),
        place: Place::Region(Region::Box {
            min: Vec3::new(0.0, 0.0, bottom),
            max: Vec3::new(1.0, 1.0, bottom + 1.0),
        }),
        material: 0,
        seeding: Seeding::Four,
    };
    let mut bodies = vec![half("above", 1.0)];
    if below {
        bodies.push(half("below", 0.0));
    }
    let boundary = |name: &str, kind| Boundary {
        name: name.into(),
        surfaces: vec![mesh.surface(name).unwrap()],
        kind,
    };
    let sides = ["x-min", "x-max", "y-min", "y-max", "z-min", "z-max"];
    let mut boundaries: Vec<_> = sides.map(|s| boundary(s, BoundaryKind::Roller)).into();
    boundaries.push(boundary(
        "wall",
        BoundaryKind::Fixed {
            directions: [true; 3],
        },
    ));
    let elastic = LinearElastic {
        young_modulus: 1e6,
        poisson_ratio: 0.3,
    };
    Plan {
        title: String::new(),
        gravity: Vec3::ZERO,
        symmetry: None,
        materials: vec![NamedMaterial {
            name: "soil".into(),
            density: 2000.0,
            model: Material::LinearElastic(elastic),
        }],
        bodies,
        boundaries,
        loads: vec![],
        contacts: vec![],
        probes: vec![Probe {
            name: "wall".into(),
            target: Target::Surface(mesh.surface("wall").unwrap()),
            quantities: vec![Quantity::Reaction],
        }],
        initial_stress: None,
        inherited: Default::default(),
        mesh_motion: None,
        numerics: Numerics::default(),
        stages: vec![Stage::new("run", Until::Steps(50))],
        mesh,
    }
}

/// Runs with the upper half thrown at the wall.
fn thrown(plan: Plan) -> Simulation {
    let mut sim = Simulation::new(plan).unwrap();
    sim.set_velocity(|x| Vec3::new(0.1, 0.0, -1.0) * f64::from(x.z > 1.0))
        .unwrap();
    while !sim.finished() {
        sim.step().unwrap();
    }
    sim
}

/// What lies below does not feel what happens above, and above nothing changes, bit for bit, by what
/// lies below: neither masses nor volumetric strains nor filling go through.
#[test]
fn nothing_goes_through_a_wall() {
    let (both, alone) = (thrown(halves(true)), thrown(halves(false)));
    let p = both.particles();
    for i in (0..p.len()).filter(|&i| p.body[i] == 1) {
        assert_eq!((p.velocity.at(i), p.stress.at(i)), (Vec3::ZERO, [0.0; 6]));
        assert_eq!(p.volume[i], p.initial_volume[i]);
    }
    let places = p.places_by_id().into_iter().flatten();
    let above: Vec<u32> = places.filter(|&i| p.body[i as usize] == 0).collect();
    let q = alone.particles();
    assert_eq!(above.len(), q.len());
    for (&i, k) in above.iter().zip(q.places_by_id().into_iter().flatten()) {
        let (i, k) = (i as usize, k as usize);
        assert_eq!(p.position.at(i), q.position.at(k));
        assert_eq!(p.stress.at(i), q.stress.at(k));
    }
    assert!(q.stress.iter().any(|s| s[2].abs() > 1e3), "it hit the wall");
    let mut reaction = Vec::new();
    both.probe_values(&mut reaction);
    assert!(reaction[2] > 0.0, "the wall holds the upper half up");
}
