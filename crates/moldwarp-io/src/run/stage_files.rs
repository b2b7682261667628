//! The particles at the end of a stage as a file, from which another run can begin.
//!
//! It is a frame with three more fields, and the names without which its numbers mean nothing.
//! Numbers are kept bit for bit.

use super::frames::write_particles;
use crate::output::vtu::{Array, Data, Texts};
use crate::output::vtu_read::{Frame, VtuError, read};
use crate::output::{FileError, Folder, sync};
use moldwarp::material::State;
use moldwarp::particles::{Particles, Vectors};
use moldwarp::{Simulation, Vec3};
use std::iter::repeat_n;
use std::path::Path;

/// Of the stage files, after those of the frames, with the unit.
const EXTRA: [(&str, &str); 3] = [("mass", "kg"), ("volume", "m3"), ("initial_volume", "m3")];

/// Writes the state at the end of the simulation's stage, before the next one begins.
pub(super) fn write(sim: &Simulation, folder: &Folder) -> Result<(), FileError> {
    let (p, plan) = (sim.particles(), sim.plan());
    let number = sim.stage();
    let stage = [plan.stages[number].name.clone()];
    let bodies: Vec<String> = plan.bodies.iter().map(|b| b.name.clone()).collect();
    let variables = plan.bodies.iter().map(|body| {
        let fields = plan.materials[body.material].model.state_fields();
        let names: Vec<&str> = fields.iter().map(|f| f.name).collect();
        names.join(",")
    });
    let variables: Vec<String> = variables.collect();
    let texts = [
        ("stage", &stage[..]),
        ("bodies", &bodies),
        ("state_variables", &variables),
    ];
    let extra = [&p.mass, &p.volume, &p.initial_volume];
    let more: Vec<Array> = (EXTRA.iter().zip(extra))
        .map(|((name, unit), values)| Array::new(name, Data::F64(values), unit))
        .collect();
    let path = folder.path().join(Folder::stage(number, &stage[0]));
    let texts = texts.map(|(name, values)| Texts { name, values });
    write_particles(sim, sim.time(), &path, &more, &texts)?;
    sync(&path)
}

/// A body of a stage file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StageBody {
    pub name: String,
    /// State variables of its model, with their values of all particles of the file.
    pub state: Vec<(String, Vec<f64>)>,
}

/// The end of a stage.
#[derive(Debug)]
pub(crate) struct StageFile {
    pub bodies: Vec<StageBody>,
    /// By the ids that they had. `body` is the number of a body above; `state` is left zero, since
    /// its order is the affair of the model that the particles will have.
    pub particles: Particles,
}

impl StageFile {
    /// Reads the file of a stage of this name.
    pub fn read(path: &Path, stage: &str) -> Result<StageFile, VtuError> {
        let frame = read(path)?;
        StageFile::new(&frame, stage).ok_or_else(|| VtuError::Format {
            path: path.to_owned(),
            problem: "it does not hold what the end of this stage should",
        })
    }

    fn new(frame: &Frame, stage: &str) -> Option<StageFile> {
        let count = frame.points.len();
        let field = |name: &str, components: usize| {
            let field = frame.field(name)?;
            let fits = field.components == components && field.values.len() == count * components;
            fits.then_some(&field.values[..])
        };
        if frame.texts("stage")? != [stage] {
            return None;
        }
        let id = field("id", 1)?;
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| id[a].total_cmp(&id[b]));
        let numbers = |name: &str| -> Option<Vec<f64>> {
            let values = field(name, 1)?;
            Some(order.iter().map(|&p| values[p]).collect())
        };
        let names = frame.texts("bodies")?.iter();
        let body = |(name, variables): (&String, &String)| {
            let variables = variables.split(',').filter(|v| !v.is_empty());
            let state = variables.map(|v| Some((v.to_owned(), numbers(v)?)));
            Some(StageBody {
                name: name.clone(),
                state: state.collect::<Option<_>>()?,
            })
        };
        let bodies: Vec<StageBody> = names
            .zip(frame.texts("state_variables")?)
            .map(body)
            .collect::<Option<_>>()?;
        let stress = field("stress", 6)?.as_chunks().0;
        let positions = order.iter().map(|&p| Vec3::from_array(frame.points[p]));
        let position: Vectors = positions.collect();
        let particles = Particles {
            id: (0..count as u32).collect(),
            body: numbers("body")?.iter().map(|&b| b as u16).collect(),
            element: vec![0; count].into(),
            origin: position.clone(),
            position,
            velocity: repeat_n(Vec3::ZERO, count).collect(),
            stress: order.iter().map(|&p| stress[p]).collect(),
            state: repeat_n(State::default(), count).collect(),
            volume: numbers("volume")?.into(),
            initial_volume: numbers("initial_volume")?.into(),
            mass: numbers("mass")?.into(),
        };
        let known = |&b: &u16| usize::from(b) < bodies.len();
        let positive = [
            &particles.mass,
            &particles.volume,
            &particles.initial_volume,
        ];
        let sound =
            particles.body.iter().all(known) && positive.into_iter().flatten().all(|&v| v > 0.0);
        sound.then_some(StageFile { bodies, particles })
    }
}
