//! A law that is given to the solver is one of its own, and what it says goes through the same books.

use moldwarp::material::{
    External, Increments, Law, LinearElastic, Material, MohrCoulomb, MohrCoulombParameters,
    STATE_SIZE, StateField,
};
use moldwarp::mesh::box_mesh;
use moldwarp::plan::*;
use moldwarp::{Plan, Simulation, Stop, Vec3};
use std::sync::Arc;

const ELASTIC: LinearElastic = LinearElastic {
    young_modulus: 1e6,
    poisson_ratio: 0.3,
};

/// Clay that yields but does not open: a law from outside knows nothing of separation.
fn clay() -> Material {
    let parameters = MohrCoulombParameters {
        cohesion: 300.0,
        friction_angle: 0.0,
        dilation_angle: 0.0,
        tension_cutoff: Some(1e6),
    };
    Material::MohrCoulomb(MohrCoulomb::new(ELASTIC, parameters).unwrap())
}

/// Any model, one particle after the other.
#[derive(Debug)]
struct Another(Material);

impl Law for Another {
    fn update(&self, step: Increments) -> Result<(), String> {
        let Increments {
            id,
            before,
            strain,
            stress,
            plastic,
            plastic_strain,
            mut state,
        } = step;
        *plastic = matches!(self.0, Material::MohrCoulomb(_));
        for p in 0..id.len() {
            let mut own = std::array::from_fn(|k| state[k][p]);
            let (before, strain) = (before.map(|b| b[p]), strain.map(|e| e[p]));
            let update = self.0.update(&before, &strain, &mut own);
            for k in 0..6 {
                stress[k][p] = update.stress[k];
                plastic_strain[k][p] = update.plastic_strain[k];
            }
            (0..STATE_SIZE).for_each(|k| state[k][p] = own[k]);
        }
        Ok(())
    }

    fn state_fields(&self) -> &'static [StateField] {
        self.0.state_fields()
    }
}

fn given(model: Material) -> Material {
    Material::External(External {
        elastic: *model.elasticity(),
        law: Arc::new(Another(model)),
    })
}

/// Two blocks of two materials side by side that fall on a floor.
fn fall(left: Material, right: Material) -> Plan {
    let mesh = box_mesh(Vec3::new(1.0, 0.5, 0.5), [8, 4, 4]).unwrap();
    let material = |name: &str, model| NamedMaterial {
        name: name.into(),
        density: 2000.0,
        model,
    };
    // The middle elements have particles of both.
    let block = |name: &str, from: f64, to: f64, material| Body {
        name: name.into(),
        place: Place::Region(Region::Box {
            min: Vec3::new(from, 0.1, 0.0),
            max: Vec3::new(to, 0.4, 0.4),
        }),
        material,
        seeding: Seeding::Four,
    };
    let floor = Boundary {
        name: "floor".into(),
        surfaces: vec![mesh.surface("z-min").unwrap()],
        kind: BoundaryKind::Roller,
    };
    Plan {
        title: String::new(),
        gravity: Vec3::new(0.0, 0.0, -10.0),
        symmetry: None,
        materials: vec![material("left", left), material("right", right)],
        bodies: vec![block("left", 0.1, 0.45, 0), block("right", 0.4501, 0.9, 1)],
        boundaries: vec![floor],
        loads: vec![],
        contacts: vec![],
        probes: vec![],
        initial_stress: None,
        inherited: Default::default(),
        mesh_motion: None,
        numerics: Numerics::default(),
        stages: vec![Stage::new("fall", Until::Steps(150))],
        mesh,
    }
}

fn ended(plan: Plan) -> Simulation {
    let mut sim = Simulation::new(plan).unwrap();
    while !sim.finished() {
        sim.step().unwrap();
    }
    sim
}

fn bytes(sim: &Simulation) -> Vec<u8> {
    let mut all = Vec::new();
    let Ok(()) = sim.save(|_, section| {
        all.extend(section.to_bytes());
        Ok::<(), std::convert::Infallible>(())
    });
    all
}

/// Bit for bit, with all energies: beside another material in the same elements, two of them, and alone,
/// with particles that cross elements.
#[test]
fn a_law_that_says_the_same_is_the_same() {
    let elastic = || Material::LinearElastic(ELASTIC);
    let own = ended(fall(elastic(), clay()));
    assert!(own.energies().plastic > 1e-3 * own.energy_turned_over());
    let own = bytes(&own);
    assert!(own == bytes(&ended(fall(given(elastic()), clay()))));
    assert!(own == bytes(&ended(fall(elastic(), given(clay())))));
    assert!(own == bytes(&ended(fall(given(elastic()), given(clay())))));
    for model in [elastic(), clay()] {
        let mut one = fall(model.clone(), elastic());
        one.bodies[1].material = 0;
        let mut same = fall(given(model), elastic());
        same.bodies[1].material = 0;
        assert!(bytes(&ended(one)) == bytes(&ended(same)));
    }
}

/// Says nonsense after a while.
#[derive(Debug)]
struct Wrong {
    says: fn() -> Result<f64, String>,
}

impl Law for Wrong {
    fn update(&self, mut step: Increments) -> Result<(), String> {
        let stress = (self.says)()?;
        step.stress.iter_mut().for_each(|s| s.fill(0.0));
        step.stress[2][7] = stress;
        Ok(())
    }

    fn state_fields(&self) -> &'static [StateField] {
        &[]
    }
}

#[test]
fn a_law_that_fails_stops_the_run() {
    let stop = |says| {
        let law = Arc::new(Wrong { says });
        let own = Material::External(External {
            elastic: ELASTIC,
            law,
        });
        let mut sim = Simulation::new(fall(own, clay())).unwrap();
        let id = sim.particles().id.clone();
        let body = sim.particles().body.clone();
        let left: Vec<u32> = id
            .iter()
            .zip(&body)
            .filter(|p| *p.1 == 0)
            .map(|p| *p.0)
            .collect();
        (sim.step().unwrap_err(), left[7])
    };
    let (failed, _) = stop(|| Err("has no answer".into()));
    assert!(
        matches!(&failed, Stop::Law { material, problem, .. }
            if material == "left" && problem == "has no answer"),
        "{failed}"
    );
    for nonsense in [f64::NAN, f64::INFINITY] {
        let says: fn() -> Result<f64, String> = match nonsense.is_nan() {
            true => || Ok(f64::NAN),
            false => || Ok(f64::INFINITY),
        };
        let (failed, id) = stop(says);
        let end = format!("first of particle {id}");
        assert!(
            matches!(&failed, Stop::Law { problem, .. } if problem.ends_with(&end)),
            "{failed}"
        );
    }
}

/// Only the main thread of a Python program hears Ctrl-C.
#[test]
fn a_law_is_asked_by_the_thread_that_makes_the_step() {
    let asked = || format!("{:?}", std::thread::current().id());
    let law = Arc::new(Wrong {
        says: || Err(format!("{:?}", std::thread::current().id())),
    });
    let own = Material::External(External {
        elastic: ELASTIC,
        law,
    });
    let mut sim = Simulation::new(fall(own, clay())).unwrap();
    let failed = sim.step().unwrap_err();
    assert!(matches!(&failed, Stop::Law { problem, .. } if *problem == asked()));
}
