//! A mesh that moves with a body.

use moldwarp::boundary::Function;
use moldwarp::material::{LinearElastic, Material};
use moldwarp::mesh::{MotionError, VolumeGroup, box_mesh};
use moldwarp::particles::InitialStress;
use moldwarp::plan::*;
use moldwarp::{Mesh, Plan, SetupError, Simulation, Stop, Vec3};

const G: f64 = 10.0;

/// A box of cubic cells whose volumes are named by what `name` says of the elements' centroids.
fn mesh(size: Vec3, cells: [usize; 3], name: impl Fn(Vec3) -> &'static str) -> Mesh {
    let mut mesh = box_mesh(size, cells).unwrap();
    let names: Vec<_> = (0..mesh.tets.len())
        .map(|e| name(mesh.centroid(e)))
        .collect();
    let mut known = names.clone();
    known.sort_unstable();
    known.dedup();
    let group = |name: &str| VolumeGroup {
        name: name.into(),
        elements: (0..names.len() as u32)
            .filter(|&e| names[e as usize] == name)
            .collect(),
    };
    mesh.volume_groups = known.into_iter().map(group).collect();
    mesh
}

fn elastic(name: &str, young_modulus: f64, density: f64) -> NamedMaterial {
    NamedMaterial {
        name: name.into(),
        density,
        model: Material::LinearElastic(LinearElastic {
            young_modulus,
            poisson_ratio: 0.3,
        }),
    }
}

fn groups(mesh: &Mesh, names: &[&str]) -> Vec<usize> {
    names
        .iter()
        .map(|n| mesh.volume_group(n).unwrap())
        .collect()
}

fn boundary(mesh: &Mesh, surface: &str, kind: BoundaryKind) -> Boundary {
    Boundary {
        name: surface.into(),
        surfaces: vec![mesh.surface(surface).unwrap()],
        kind,
    }
}

/// Ground and a driver in the volumes of these names, on rollers.
fn plan(mesh: Mesh, [ground, driver]: [&[&str]; 2], direction: Vec3, zones: [&[&str]; 2]) -> Plan {
    let body = |name: &str, volumes: &[&str], material| Body {
        name: name.into(),
        place: Place::Volumes(groups(&mesh, volumes)),
        material,
        seeding: Seeding::Four,
    };
    let sides = ["x-min", "x-max", "y-min", "y-max"];
    Plan {
        title: String::new(),
        gravity: Vec3::ZERO,
        symmetry: None,
        materials: vec![elastic("soil", 5e6, 2000.0), elastic("steel", 5e7, 8000.0)],
        bodies: vec![body("ground", ground, 0), body("driver", driver, 1)],
        boundaries: sides
            .map(|s| boundary(&mesh, s, BoundaryKind::Roller))
            .into(),
        loads: vec![],
        contacts: vec![],
        probes: vec![],
        initial_stress: None,
        inherited: Default::default(),
        mesh_motion: Some(MeshMotion {
            driver: 1,
            direction,
            moving: groups(&mesh, zones[0]),
            blend: groups(&mesh, zones[1]),
        }),
        numerics: Numerics::default(),
        stages: vec![Stage::new("run", Until::Steps(200))],
        mesh,
    }
}

const ALL: BoundaryKind = BoundaryKind::Fixed {
    directions: [true; 3],
};

/// An elastic punch hits soil with 5 m/s; faces of elements are between them.
fn punch() -> Plan {
    let mesh = mesh(Vec3::new(0.6, 0.1, 1.0), [6, 1, 10], |x| match x {
        _ if x.z > 0.6 && x.z < 0.8 && x.x < 0.3 => "punch",
        _ if x.z > 0.5 && x.x < 0.4 => "zone",
        _ if x.z > 0.6 => "air",
        _ => "soil",
    });
    let mut plan = plan(
        mesh,
        [&["soil"], &["punch"]],
        -Vec3::Z,
        [&["zone"], &["air", "soil"]],
    );
    plan.bodies[0].place = Place::Region(Region::Box {
        min: Vec3::ZERO,
        max: Vec3::new(0.6, 0.1, 0.6),
    });
    plan.boundaries.push(boundary(&plan.mesh, "z-min", ALL));
    plan.contacts = vec![Contact {
        name: "sole".into(),
        bodies: [vec![1], vec![0]],
        friction: 0.3,
        adhesion: 0.0,
        surface: ContactSurface::Aligned,
        gap_check: false,
    }];
    plan.materials[1].density = 1e5;
    plan.stages[0].initial_velocities = vec![(1, Vec3::new(0.0, 0.0, -5.0))];
    plan
}

/// A driver's nodes move with its material: its particles keep element and barycentric coordinates to
/// 1e-9 while it goes by most of an element, and the books close.
#[test]
fn particles_of_the_driver_keep_their_places() {
    let mut sim = Simulation::new(punch()).unwrap();
    let places = |s: &Simulation| {
        let p = s.particles();
        let own = (0..p.len()).filter(|&i| p.body[i] == 1);
        let place = |i: usize| {
            let e = p.element[i];
            (
                p.id[i],
                e,
                s.mesh().barycentric(e as usize, p.position.at(i)),
            )
        };
        let mut places: Vec<_> = own.map(place).collect();
        places.sort_by_key(|p| p.0);
        places
    };
    let before = places(&sim);
    while !sim.finished() {
        sim.step().unwrap();
    }
    let p = sim.particles();
    let own = (0..p.len()).filter(|&i| p.body[i] == 1);
    let way = own
        .map(|i| -p.displacement(i).z)
        .fold(f64::INFINITY, f64::min);
    for (now, then) in places(&sim).iter().zip(&before) {
        assert_eq!((now.0, now.1), (then.0, then.1));
        let moved = now.2.iter().zip(then.2).map(|(a, b)| (a - b).abs());
        assert!(moved.fold(0.0, f64::max) < 1e-9);
    }
    let residual = sim.energies().residual.abs() / sim.energy_turned_over();
    println!("way {way:.3} m, residual {residual:.1e}");
    assert!(way > 0.05 && residual < 1e-9);
}

/// Results are equal bit for bit for 1 and 2 threads.
#[test]
fn a_moving_mesh_does_not_depend_on_threads() {
    let state = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let mut sim = Simulation::new(punch()).unwrap();
            (0..60).for_each(|_| sim.step().unwrap());
            let p = sim.particles();
            (
                p.position.clone(),
                p.stress.clone(),
                sim.mesh().nodes.clone(),
            )
        })
    };
    assert!(state(1) == state(2));
}

/// K₀ ground of 24 rows under a driver that takes the mesh along x, by a sixth of a cell in each step.
fn ground() -> Plan {
    let h = 0.1;
    let mesh = mesh(Vec3::new(1.2, h, 2.8), [12, 1, 28], |x| match x {
        _ if x.z > 2.6 && x.z < 2.7 && x.x > 0.5 && x.x < 0.7 => "driver",
        _ if x.z < 2.4 && (x.x - 0.6).abs() < 0.2 && x.z > 0.3 => "ground-zone",
        _ if x.z < 2.4 => "ground",
        _ if (x.x - 0.6).abs() < 0.2 => "air-zone",
        _ => "air",
    });
    let zones: [&[&str]; 2] = [&["ground-zone", "air-zone"], &["ground", "air"]];
    let mut plan = plan(
        mesh,
        [&["ground", "ground-zone"], &["driver"]],
        Vec3::X,
        zones,
    );
    plan.boundaries.push(boundary(&plan.mesh, "z-min", ALL));
    plan.gravity = Vec3::new(0.0, 0.0, -G);
    plan.initial_stress = Some(InitialStress {
        k0: vec![Some(0.43), None],
        surcharge: 0.0,
    });
    plan.stages[0].initial_velocities = vec![(1, Vec3::new(50.0, 0.0, 0.0))];
    plan
}

/// With stresses taken about the initial one, ground at rest is in equilibrium to round-off however far
/// the mesh has moved through it: what comes from the free surface, where elements are not filled, has
/// not come down here yet. There it stays under a twentieth of gravity.
#[test]
fn ground_at_rest_stays_in_equilibrium() {
    let mut sim = Simulation::new(ground()).unwrap();
    let nodes = sim.mesh().nodes.clone();
    let elements = sim.particles().element.clone();
    let (mut deep, mut shallow, mut time) = (0.0f64, 0.0f64, 0.0);
    for _ in 0..3 {
        sim.step().unwrap();
        time += sim.time_step();
        let fields = sim.node_fields();
        for (v, x) in fields.velocity.iter().zip(&nodes) {
            match x.z {
                z if z < 1.2 => deep = deep.max(v.length() / time),
                z if z < 2.45 => shallow = shallow.max(v.length() / time),
                _ => {}
            }
        }
    }
    let changed = sim
        .particles()
        .element
        .iter()
        .zip(&elements)
        .filter(|e| e.0 != e.1)
        .count();
    println!(
        "deep {:.1e} g, shallow {:.1e} g, {changed} particles in other elements",
        deep / G,
        shallow / G
    );
    assert!(changed > 100);
    assert!(deep < 1e-10 * G && shallow < 0.05 * G);
}

/// Zones that leave a volume out, and a moving one at a boundary that holds the mesh, are refused by name.
#[test]
fn zones_are_checked() {
    let mut plan = ground();
    let motion = plan.mesh_motion.as_mut().unwrap();
    motion.blend.pop();
    let group = "air".to_owned();
    let error = Simulation::new(plan).unwrap_err();
    assert_eq!(error, SetupError::Motion(MotionError::NotCovered { group }));
    let mut plan = ground();
    let motion = plan.mesh_motion.as_mut().unwrap();
    let blend = std::mem::take(&mut motion.blend);
    motion.moving.extend(blend);
    match Simulation::new(plan).unwrap_err() {
        SetupError::Motion(MotionError::Held { boundary, .. }) => {
            assert!(boundary.starts_with("x-"))
        }
        other => panic!("{other}"),
    }
}

/// A driver that goes on until the mesh ahead of it is flat stops the run, with the name of the volume,
/// when it is fast and elements turn over within a step, too.
#[test]
fn a_flat_element_stops_the_run() {
    for speed in [20.0, 100.0] {
        goes_on_until_flat(speed);
    }
}

fn goes_on_until_flat(speed: f64) {
    let mesh = mesh(Vec3::new(0.1, 0.1, 0.8), [1, 1, 8], |x| match x.z {
        z if z > 0.7 => "driver",
        z if z > 0.3 => "zone",
        z if z > 0.1 => "air",
        _ => "ground",
    });
    let mut plan = plan(
        mesh,
        [&["ground"], &["driver"]],
        -Vec3::Z,
        [&["zone"], &["air", "ground"]],
    );
    plan.boundaries.push(boundary(&plan.mesh, "z-min", ALL));
    let velocity = [None, None, Some(-speed)];
    let function = Function::Constant;
    let kind = BoundaryKind::Prescribed { velocity, function };
    plan.boundaries.push(boundary(&plan.mesh, "z-max", kind));
    plan.stages[0] = Stage {
        initial_velocities: vec![(1, Vec3::new(0.0, 0.0, -speed))],
        ..Stage::new("run", Until::Duration(1.0))
    };
    let mut sim = Simulation::new(plan).unwrap();
    let stop = std::iter::repeat_with(|| sim.step())
        .find_map(Result::err)
        .unwrap();
    println!("{stop}");
    assert!(matches!(stop, Stop::Degenerate { zone, .. } if zone == "ground" || zone == "air"));
}
