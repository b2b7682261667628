//! Plans that several cases share.

use crate::ledgers::{self, Watch};
use moldwarp::boundary::Function;
use moldwarp::material::{LinearElastic, Material, MohrCoulomb, MohrCoulombParameters};
use moldwarp::mesh::box_mesh;
use moldwarp::plan::*;
use moldwarp::{Mesh, Plan, Simulation, Vec3};

/// A column of cubic cells of Kuhn tetrahedra: 2 × 2 × n cells, 1 m high, standing on z = 0.
pub fn column_mesh(n: usize) -> Mesh {
    let h = 1.0 / n as f64;
    box_mesh(Vec3::new(2.0 * h, 2.0 * h, 1.0), [2, 2, n]).expect("a box is a good mesh")
}

/// The same column with a fifth of its height of empty elements above.
pub fn column_with_room(n: usize, material: NamedMaterial, end: f64) -> Plan {
    let room = n.div_ceil(5);
    let h = 1.0 / n as f64;
    let size = Vec3::new(2.0 * h, 2.0 * h, (n + room) as f64 * h);
    let mesh = box_mesh(size, [2, 2, n + room]).expect("a box is a good mesh");
    let mut plan = column(mesh, material, end);
    let max = Vec3::new(size.x, size.y, 1.0);
    plan.bodies[0].place = Place::Region(Region::Box {
        min: Vec3::ZERO,
        max,
    });
    plan
}

/// The paper's soil (Section 7): 100 kPa, ν = 0, 18 kN/m³.
pub fn papers_soil() -> NamedMaterial {
    elastic(1e5, 0.0, 18e3 / 9.81)
}

pub fn elastic(young_modulus: f64, poisson_ratio: f64, density: f64) -> NamedMaterial {
    let model = Material::LinearElastic(LinearElastic {
        young_modulus,
        poisson_ratio,
    });
    NamedMaterial {
        name: "soil".to_owned(),
        density,
        model,
    }
}

/// One body that fills the whole mesh, nothing holds or loads it.
pub fn free_body(mesh: Mesh, material: NamedMaterial, end: f64) -> Plan {
    Plan {
        title: String::new(),
        gravity: Vec3::ZERO,
        mesh,
        symmetry: None,
        materials: vec![material],
        bodies: vec![Body {
            name: "body".to_owned(),
            place: Place::Volumes(vec![0]),
            material: 0,
            seeding: Seeding::Four,
        }],
        boundaries: Vec::new(),
        loads: Vec::new(),
        contacts: Vec::new(),
        probes: Vec::new(),
        initial_stress: None,
        inherited: Default::default(),
        mesh_motion: None,
        numerics: Numerics::default(),
        stages: vec![Stage::new("run", Until::Duration(end))],
    }
}

/// Adds a boundary on named surfaces.
pub fn bound(plan: &mut Plan, surfaces: &[&str], kind: BoundaryKind) {
    let name = surfaces.join("+");
    let surfaces = surfaces.iter().map(|s| surface(plan, s)).collect();
    plan.boundaries.push(Boundary {
        name,
        surfaces,
        kind,
    });
}

/// Adds a traction that is there from the start.
pub fn load(plan: &mut Plan, on: &str, traction: Vec3) {
    let surfaces = vec![surface(plan, on)];
    let (kind, function) = (LoadKind::Traction(traction), Function::Constant);
    plan.loads.push(Load {
        name: on.to_owned(),
        surfaces,
        body: 0,
        kind,
        function,
    });
}

/// Adds a probe on a surface.
pub fn probe(plan: &mut Plan, name: &str, on: &str, quantities: &[Quantity]) {
    let target = Target::Surface(surface(plan, on));
    plan.probes.push(Probe {
        name: name.to_owned(),
        target,
        quantities: quantities.to_vec(),
    });
}

fn surface(plan: &Plan, name: &str) -> usize {
    plan.mesh
        .surface(name)
        .unwrap_or_else(|| panic!("the mesh has no surface {name}"))
}

pub const FIXED: BoundaryKind = BoundaryKind::Fixed {
    directions: [true; 3],
};
pub const SIDES: [&str; 4] = ["x-min", "x-max", "y-min", "y-max"];

/// A column with rollers on its sides.
pub fn column(mesh: Mesh, material: NamedMaterial, end: f64) -> Plan {
    let mut plan = free_body(mesh, material, end);
    bound(&mut plan, &SIDES, BoundaryKind::Roller);
    plan
}

/// What a run comes to in the ledger.
#[derive(Clone, Copy, Debug, Default)]
pub struct Balance {
    /// Greatest |residual| over the energy turned over.
    pub residual: f64,
    /// Greatest sum of the absolute numerical terms over the energy turned over.
    pub numerical: f64,
    /// What impulses along the normals of contacts have taken, over the energy turned over.
    pub contact: f64,
}

/// Runs to the end; `look` is called at the start and after every step.
pub fn run(plan: Plan, look: impl FnMut(&Simulation)) -> Balance {
    run_from(
        Simulation::new(plan).unwrap_or_else(|e| panic!("{e}")),
        look,
    )
}

/// Runs a simulation to its end; `look` is called at the start and after every step.
pub fn run_from(mut simulation: Simulation, mut look: impl FnMut(&Simulation)) -> Balance {
    let mut watch = Watch::default();
    look(&simulation);
    while !simulation.finished() {
        simulation.step().unwrap_or_else(|e| panic!("{e}"));
        watch.see(simulation.energies());
        look(&simulation);
    }
    let entry = watch.end(&simulation);
    let balance = Balance {
        residual: entry.residual,
        numerical: entry.numerical(),
        contact: simulation.energies().contact / entry.turned_over,
    };
    ledgers::note(entry);
    balance
}

/// The value of a probe's column.
pub fn value(simulation: &Simulation, column: &str) -> f64 {
    let at = simulation
        .probe_columns()
        .iter()
        .position(|c| c.0 == column);
    let mut values = Vec::new();
    simulation.probe_values(&mut values);
    values[at.unwrap_or_else(|| panic!("no column {column}"))]
}

/// A box of Kuhn tetrahedra between given coordinates, m. Its surfaces are the box's.
pub fn graded_box(at: [Vec<f64>; 3]) -> Mesh {
    let cells = [0, 1, 2].map(|d| at[d].len() - 1);
    let size = Vec3::from_array(cells.map(|n| n as f64));
    let unit = box_mesh(size, cells).expect("a box is a good mesh");
    moved(&unit, |x| {
        Vec3::from_array([0, 1, 2].map(|d| at[d][x[d].round() as usize]))
    })
}

/// The faces of a plane z = `height` whose nodes all are `wanted`, as a surface of its own.
pub fn with_surface_at(
    mesh: &Mesh,
    name: &str,
    height: f64,
    wanted: impl Fn(Vec3) -> bool,
) -> Mesh {
    let on = |n: u32| {
        let x = mesh.nodes[n as usize];
        (x.z - height).abs() < 1e-9 && wanted(x)
    };
    let mut faces: Vec<[u32; 3]> = Vec::new();
    for tet in &mesh.tets {
        for local in moldwarp::mesh::FACE_NODES {
            let mut face = local.map(|i| tet[i]);
            face.sort_unstable();
            if face.iter().all(|&n| on(n)) && !faces.contains(&face) {
                faces.push(face);
            }
        }
    }
    rebuilt(mesh, mesh.nodes.clone(), vec![(name.to_owned(), faces)])
}

/// The mesh with volumes made anew: each element belongs to what `name` says of its centroid.
pub fn with_volumes(mesh: &Mesh, name: impl Fn(Vec3) -> &'static str) -> Mesh {
    let mut groups: Vec<(String, Vec<u32>)> = Vec::new();
    for e in 0..mesh.tets.len() {
        let name = name(mesh.centroid(e));
        match groups.iter_mut().find(|g| g.0 == name) {
            Some(group) => group.1.push(e as u32),
            None => groups.push((name.to_owned(), vec![e as u32])),
        }
    }
    let groups = groups.into_iter();
    let groups = groups.map(|(name, elements)| moldwarp::mesh::VolumeGroup { name, elements });
    let mut mesh = mesh.clone();
    mesh.volume_groups = groups.collect();
    mesh
}

/// The mesh with its nodes moved.
pub fn moved(mesh: &Mesh, place: impl Fn(Vec3) -> Vec3) -> Mesh {
    rebuilt(
        mesh,
        mesh.nodes.iter().map(|&x| place(x)).collect(),
        Vec::new(),
    )
}

/// The mesh with other node coordinates and more surfaces.
fn rebuilt(mesh: &Mesh, nodes: Vec<Vec3>, more: Vec<(String, Vec<[u32; 3]>)>) -> Mesh {
    let surface = |s: &moldwarp::mesh::Surface| {
        let faces = s.faces.iter().map(|&f| mesh.face_nodes(f)).collect();
        (s.name.clone(), faces)
    };
    Mesh::new(moldwarp::mesh::RawMesh {
        nodes,
        tets: mesh.tets.clone(),
        volume_groups: mesh
            .volume_groups
            .iter()
            .map(|g| (g.name.clone(), g.elements.clone()))
            .collect(),
        surface_groups: mesh.surfaces.iter().map(surface).chain(more).collect(),
    })
    .expect("a mesh with moved nodes is as good as before")
}

/// Coordinates from `start` on: `uniform` cells of width `h`, then cells that grow by `ratio` to
/// `end` or just beyond.
pub fn growing(start: f64, h: f64, uniform: usize, ratio: f64, end: f64) -> Vec<f64> {
    let sign = (end - start).signum();
    let mut at: Vec<f64> = (0..=uniform).map(|i| start + sign * h * i as f64).collect();
    let (mut last, mut width) = (at[uniform], h);
    while (end - last) * sign > 0.5 * width {
        width *= ratio;
        last += sign * width;
        at.push(last);
    }
    at
}

/// Mohr-Coulomb soil. Angles in degrees; no dilation.
pub fn mohr_coulomb(
    elastic: (f64, f64),
    cohesion: f64,
    friction: f64,
    tension_cutoff: Option<f64>,
    density: f64,
) -> NamedMaterial {
    let elastic = LinearElastic {
        young_modulus: elastic.0,
        poisson_ratio: elastic.1,
    };
    let parameters = MohrCoulombParameters {
        cohesion,
        friction_angle: friction.to_radians(),
        dilation_angle: 0.0,
        tension_cutoff,
    };
    let model = MohrCoulomb::new(elastic, parameters).expect("parameters of the case are sound");
    NamedMaterial {
        name: "soil".to_owned(),
        density,
        model: Material::MohrCoulomb(model),
    }
}

/// Dry sand: 5 MPa, ν = 0.3, φ = 30°, neither cohesion nor dilation, 1600 kg/m³.
pub fn sand() -> NamedMaterial {
    mohr_coulomb((5e6, 0.3), 0.0, 30.0, None, 1600.0)
}
