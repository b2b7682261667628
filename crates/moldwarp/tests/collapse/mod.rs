//! A plan that tests of speed share.

use moldwarp::material::{LinearElastic, Material, MohrCoulomb, MohrCoulombParameters};
use moldwarp::mesh::box_mesh;
use moldwarp::plan::*;
use moldwarp::{Plan, Vec3};

/// A block of sand of n³ cells at the side of a box four times as long, suddenly under gravity.
pub fn collapse(n: usize, cohesion: f64) -> Plan {
    let mesh = box_mesh(Vec3::new(4.0, 1.0, 1.5), [4 * n, n, 3 * n / 2]).unwrap();
    let elastic = LinearElastic {
        young_modulus: 1e6,
        poisson_ratio: 0.3,
    };
    let parameters = MohrCoulombParameters {
        cohesion,
        friction_angle: 0.45,
        dilation_angle: 0.0,
        tension_cutoff: None,
    };
    let boundary = |name: &str, kind| Boundary {
        name: name.into(),
        surfaces: vec![mesh.surface(name).unwrap()],
        kind,
    };
    let sides = ["x-min", "x-max", "y-min", "y-max"];
    let mut boundaries: Vec<Boundary> =
        (sides.iter().map(|s| boundary(s, BoundaryKind::Roller))).collect();
    boundaries.push(boundary(
        "z-min",
        BoundaryKind::Fixed {
            directions: [true; 3],
        },
    ));
    Plan {
        title: String::new(),
        gravity: Vec3::new(0.0, 0.0, -9.81),
        materials: vec![NamedMaterial {
            name: "sand".into(),
            density: 1800.0,
            model: Material::MohrCoulomb(MohrCoulomb::new(elastic, parameters).unwrap()),
        }],
        bodies: vec![Body {
            name: "block".into(),
            place: Place::Region(Region::Box {
                min: Vec3::ZERO,
                max: Vec3::ONE,
            }),
            material: 0,
            seeding: Seeding::Four,
        }],
        boundaries,
        mesh,
        symmetry: None,
        loads: vec![],
        contacts: vec![],
        probes: vec![],
        initial_stress: None,
        inherited: Default::default(),
        mesh_motion: None,
        numerics: Numerics::default(),
        stages: vec![Stage::new("collapse", Until::Steps(u64::MAX))],
    }
}
