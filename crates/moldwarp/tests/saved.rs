//! A simulation that is saved and restored goes on bit for bit.

use moldwarp::boundary::Function;
use moldwarp::material::{LinearElastic, Material, MohrCoulomb, MohrCoulombParameters};
use moldwarp::mesh::{VolumeGroup, box_mesh};
use moldwarp::particles::InitialStress;
use moldwarp::plan::*;
use moldwarp::saved::Section;
use moldwarp::{Mesh, Plan, Simulation, Vec3};

type Sections = Vec<(&'static str, Vec<u8>)>;

fn save(sim: &Simulation) -> Sections {
    let mut all = Sections::new();
    let keep = |name, section: Section| -> Result<(), ()> {
        all.push((name, section.to_bytes()));
        Ok(())
    };
    sim.save(keep).unwrap();
    all
}

fn restore(plan: &Plan, saved: &Sections) -> Result<Simulation, moldwarp::saved::Broken> {
    let section = |name| saved.iter().find(|s| s.0 == name).map(|s| &s.1[..]);
    Simulation::restore(plan.clone(), section)
}

const LOW: Vec3 = Vec3::new(0.6, 0.1, 0.5);

/// Volumes of a moving mesh around a punch that stands on soil.
fn mesh() -> Mesh {
    let mut mesh = box_mesh(Vec3::new(0.6, 0.1, 1.0), [6, 1, 10]).unwrap();
    let name = |x: Vec3| match x {
        _ if x.z > 0.6 && x.z < 0.8 && x.x < 0.3 => "punch",
        _ if x.z > 0.5 && x.x < 0.4 => "zone",
        _ if x.z > 0.6 => "air",
        _ => "soil",
    };
    let groups = ["punch", "zone", "air", "soil"].map(|group| VolumeGroup {
        name: group.into(),
        elements: (0..mesh.tets.len() as u32)
            .filter(|&e| name(mesh.centroid(e as usize)) == group)
            .collect(),
    });
    mesh.volume_groups = groups.into();
    mesh
}

/// A punch that hits soil and takes the mesh along, and everything else that a simulation can have
/// to remember: initial stress, an absorbing side, a shaken one, loads, a body that comes and goes.
fn plan() -> Plan {
    let mesh = mesh();
    let elastic = |young_modulus| LinearElastic {
        young_modulus,
        poisson_ratio: 0.3,
    };
    let parameters = MohrCoulombParameters {
        cohesion: 2e4,
        friction_angle: 0.5,
        dilation_angle: 0.1,
        tension_cutoff: None,
    };
    let material = |name: &str, density, model| NamedMaterial {
        name: name.into(),
        density,
        model,
    };
    let soil = Material::MohrCoulomb(MohrCoulomb::new(elastic(5e6), parameters).unwrap());
    let body = |name: &str, place, material| Body {
        name: name.into(),
        place,
        material,
        seeding: Seeding::Four,
    };
    let block = |min, max| Place::Region(Region::Box { min, max });
    let boundary = |surface: &str, kind| Boundary {
        name: surface.into(),
        surfaces: vec![mesh.surface(surface).unwrap()],
        kind,
    };
    let probe = |name: &str, target, quantities: &[Quantity]| Probe {
        name: name.into(),
        target,
        quantities: quantities.into(),
    };
    let stage = |name: &str| Stage::new(name, Until::Steps(12));
    Plan {
        title: String::new(),
        gravity: Vec3::new(0.0, 0.0, -10.0),
        symmetry: None,
        materials: vec![
            material("soil", 2000.0, soil),
            material("steel", 1e5, Material::LinearElastic(elastic(5e7))),
            material("soft", 2000.0, Material::LinearElastic(elastic(4e6))),
        ],
        bodies: vec![
            body("ground", block(Vec3::ZERO, Vec3::new(0.6, 0.1, 0.6)), 0),
            body("punch", Place::Volumes(vec![0]), 1),
            body(
                "fill",
                block(Vec3::new(0.5, 0.0, 0.7), Vec3::new(0.6, 0.1, 0.8)),
                2,
            ),
        ],
        boundaries: vec![
            boundary("x-min", BoundaryKind::Roller),
            boundary("y-min", BoundaryKind::Roller),
            boundary("y-max", BoundaryKind::Roller),
            boundary(
                "x-max",
                BoundaryKind::Absorbing {
                    alpha: [1.0, 0.5],
                    virtual_thickness: Some([0.5; 2]),
                },
            ),
            boundary(
                "z-min",
                BoundaryKind::Prescribed {
                    velocity: [None, None, Some(0.1)],
                    function: Function::HalfSine {
                        duration: 1e-3,
                        period: 2e-3,
                        count: 3,
                    },
                },
            ),
        ],
        loads: vec![Load {
            name: "push".into(),
            surfaces: vec![mesh.surface("z-min").unwrap()],
            body: 0,
            kind: LoadKind::InitialStress,
            function: Function::Ramp { duration: 0.01 },
        }],
        contacts: vec![Contact {
            name: "sole".into(),
            bodies: [vec![1], vec![0]],
            friction: 0.3,
            adhesion: 1e3,
            surface: ContactSurface::Aligned,
            gap_check: true,
        }],
        probes: vec![
            probe(
                "bottom",
                Target::Surface(mesh.surface("z-min").unwrap()),
                &[Quantity::Reaction, Quantity::Displacement],
            ),
            probe("inside", Target::Point(LOW * 0.5), &[Quantity::Stress]),
        ],
        initial_stress: Some(InitialStress {
            k0: vec![Some(0.6), None, None],
            surcharge: 1e3,
        }),
        inherited: Default::default(),
        mesh_motion: Some(MeshMotion {
            driver: 1,
            direction: -Vec3::Z,
            moving: vec![1],
            blend: vec![2, 3],
        }),
        numerics: Numerics {
            viscosity: 1e-5,
            pic_rate: 1.0,
            damping: 0.1,
            ..Numerics::default()
        },
        stages: vec![
            Stage {
                initial_velocities: vec![(1, Vec3::new(0.0, 0.0, -5.0))],
                off: vec![Item::Boundary(3)],
                ..stage("hit")
            },
            Stage {
                on: vec![Item::Boundary(3)],
                add: vec![2],
                materials: vec![(0, 2)],
                levels: vec![(
                    Level::Load(0),
                    Ramp {
                        from: None,
                        to: 0.5,
                        over: 0.01,
                    },
                )],
                ..stage("filled")
            },
            Stage {
                remove: vec![2],
                off: vec![Item::Boundary(4)],
                reset_displacement: true,
                ..stage("rest")
            },
        ],
        mesh,
    }
}

/// If each step from a restored state ends in the same state, bit for bit, then so do all that follow.
#[test]
fn a_restored_simulation_makes_the_same_steps() {
    let plan = plan();
    let mut sim = Simulation::new(plan.clone()).unwrap();
    while !sim.finished() {
        let saved = save(&sim);
        let mut twin = restore(&plan, &saved).unwrap();
        assert!(save(&twin) == saved);
        sim.step().unwrap();
        twin.step().unwrap();
        for (own, other) in save(&sim).iter().zip(save(&twin)) {
            assert!(own.1 == other.1, "{} at step {}", own.0, sim.steps());
        }
    }
    let first = mesh().nodes;
    assert!(sim.mesh().nodes != first, "the mesh has moved");
    assert!(sim.energies().friction != 0.0 && sim.energies().absorbed != 0.0);
    let restored = restore(&plan, &save(&sim)).unwrap();
    assert!(restored.finished());
}

/// What is not a state of the plan is refused and does no harm.
#[test]
fn what_does_not_fit_is_refused() {
    let plan = plan();
    let sim = Simulation::new(plan.clone()).unwrap();
    let saved = save(&sim);
    for (missing, (name, bytes)) in saved.iter().enumerate() {
        let mut others = saved.clone();
        others.remove(missing);
        assert!(restore(&plan, &others).is_err(), "without {name}");
        let mut short = saved.clone();
        short[missing].1.truncate(bytes.len() - 1);
        assert!(restore(&plan, &short).is_err(), "{name} cut off");
    }
    let mut other = plan.clone();
    other.mesh = box_mesh(Vec3::ONE, [1, 1, 1]).unwrap();
    assert!(restore(&other, &saved).is_err());
}
