//! ParaView frames of a simulation.

use crate::output::pvd::Collection;
use crate::output::vtu::{self, Array, Data, Each, Texts};
use crate::output::{FileError, Folder, sync};
use moldwarp::NodeFields;
use moldwarp::material::StateField;
use moldwarp::particles::Particles;
use moldwarp::tensor::Voigt;
use moldwarp::{Simulation, Vec3, tensor};
use std::path::PathBuf;

/// Writes frames of the particles and of the mesh into a folder.
#[derive(Debug)]
pub(crate) struct Frames {
    folder: Folder,
    particles: Collection,
    mesh: Collection,
    /// Files that may not have reached the disk yet, beyond the system's own memory.
    fresh: Vec<PathBuf>,
}

impl Frames {
    pub fn new(folder: &Folder) -> Frames {
        Frames {
            folder: folder.clone(),
            particles: Collection::new(folder.collection("particles")),
            mesh: Collection::new(folder.collection("mesh")),
            fresh: Vec::new(),
        }
    }

    /// Goes on after frames of these times, s; later ones are removed.
    pub fn resume(folder: &Folder, times: &[f64]) -> Result<Frames, FileError> {
        let collection = |kind: &str| {
            let names = (0..).map(|number| Folder::frame(kind, number));
            let frames = times.iter().copied().zip(names).collect();
            Collection::resume(folder.collection(kind), frames)
        };
        folder.remove_frames_from(times.len())?;
        Ok(Frames {
            folder: folder.clone(),
            particles: collection("particles")?,
            mesh: collection("mesh")?,
            fresh: Vec::new(),
        })
    }

    /// Times of the frames so far, s.
    pub fn times(&self) -> Vec<f64> {
        self.particles.times().collect()
    }

    pub fn folder(&self) -> &Folder {
        &self.folder
    }

    /// Number of frames so far.
    pub fn len(&self) -> usize {
        self.particles.len()
    }

    /// Writes the simulation as it is now, at `time`, s.
    pub fn write(&mut self, sim: &Simulation, time: f64) -> Result<(), FileError> {
        let number = self.len();
        let particles = Folder::frame("particles", number);
        let mesh = Folder::frame("mesh", number);
        let paths = [&particles, &mesh].map(|f| self.folder.path().join(f));
        write_frame(sim, time, &paths)?;
        self.particles.add(time, &particles)?;
        self.mesh.add(time, &mesh)?;
        self.fresh.extend(paths);
        Ok(())
    }

    /// Brings all frames to the disk.
    pub fn sync(&mut self) -> Result<(), FileError> {
        if self.fresh.is_empty() {
            return Ok(());
        }
        let collections = ["particles", "mesh"].map(|kind| self.folder.collection(kind));
        self.fresh.extend(collections);
        self.fresh.drain(..).try_for_each(|path| sync(&path))
    }
}

/// Writes the simulation as it is now, at `time`, s: the files of particles and mesh.
pub(super) fn write_frame(
    sim: &Simulation,
    time: f64,
    [particles, mesh]: &[PathBuf; 2],
) -> Result<(), FileError> {
    write_particles(sim, time, particles, &[], &[])?;
    write_mesh(sim, time, mesh)
}

/// An array of the frames. The book's page on the output is made from these, too.
pub(crate) struct Field<V> {
    pub name: &'static str,
    /// Unit, and sign convention where one is needed.
    pub label: &'static str,
    #[cfg_attr(not(test), expect(dead_code, reason = "it is for the book"))]
    pub meaning: &'static str,
    pub values: V,
}

type OfNodes = for<'a> fn(&'a NodeFields) -> Data<'a>;

/// Where an array of the particles comes from.
#[derive(Clone, Copy)]
pub(crate) enum OfParticles {
    Numbers(for<'a> fn(&'a Particles) -> Data<'a>),
    Scalar(fn(&Particles, usize) -> f64),
    Vector(fn(&Particles, usize) -> Vec3),
    Tensor(fn(&Particles, usize) -> Voigt),
}

/// The same with the particles: what writes each value when it comes to it.
enum Values<'a> {
    Numbers(Data<'a>),
    Scalar(Box<dyn Fn(usize) -> f64 + 'a>),
    Vector(Box<dyn Fn(usize) -> Vec3 + 'a>),
    Tensor(Box<dyn Fn(usize) -> Voigt + 'a>),
}

impl OfParticles {
    fn values<'a>(&self, p: &'a Particles) -> Values<'a> {
        match *self {
            OfParticles::Numbers(all) => Values::Numbers(all(p)),
            OfParticles::Scalar(of) => Values::Scalar(Box::new(move |i| of(p, i))),
            OfParticles::Vector(of) => Values::Vector(Box::new(move |i| of(p, i))),
            OfParticles::Tensor(of) => Values::Tensor(Box::new(move |i| of(p, i))),
        }
    }
}

impl Values<'_> {
    /// Of this many particles.
    fn data(&self, count: usize) -> Data<'_> {
        match self {
            Values::Numbers(data) => *data,
            Values::Scalar(of) => Data::EachF64(Each::new(count, of)),
            Values::Vector(of) => Data::EachVector(Each::new(count, of)),
            Values::Tensor(of) => Data::EachTensor(Each::new(count, of)),
        }
    }
}

/// Of the particles, before the state variables of their models.
pub(crate) const PARTICLE_FIELDS: [Field<OfParticles>; 8] = [
    Field {
        name: "id",
        label: "",
        meaning: "Number; never changes. Bodies that are not there have theirs reserved.",
        values: OfParticles::Numbers(|p| Data::U32(&p.id)),
    },
    Field {
        name: "body",
        label: "",
        meaning: "Number of the body, from 0 in the order of the scene.",
        values: OfParticles::Numbers(|p| Data::U16(&p.body)),
    },
    Field {
        name: "velocity",
        label: "m/s",
        meaning: "Of the middle of the coming step; at the end of the run of that instant.",
        values: OfParticles::Vector(|p, i| p.velocity.at(i)),
    },
    Field {
        name: "displacement",
        label: "m",
        meaning: "Since the start, or since a stage has reset it.",
        values: OfParticles::Vector(Particles::displacement),
    },
    Field {
        name: "stress",
        label: "Pa, tension positive",
        meaning: "Cauchy stress σ.",
        values: OfParticles::Tensor(|p, i| p.stress.at(i)),
    },
    Field {
        name: "mean_pressure",
        label: "Pa, compression positive",
        meaning: "−tr σ/3.",
        values: OfParticles::Scalar(|p, i| mean_pressure(&p.stress.at(i))),
    },
    Field {
        name: "deviatoric_stress",
        label: "Pa, sqrt(3/2 s:s)",
        meaning: "q = √(3/2 s : s), s the deviator of σ.",
        values: OfParticles::Scalar(|p, i| tensor::equivalent(&p.stress.at(i))),
    },
    Field {
        name: "density",
        label: "kg/m3",
        meaning: "m_p/V_p.",
        values: OfParticles::Scalar(|p, i| p.mass[i] / p.volume[i]),
    },
];

/// Of the mesh's nodes.
pub(crate) const NODE_FIELDS: [Field<OfNodes>; 3] = [
    Field {
        name: "velocity",
        label: "m/s",
        meaning: "After the last remap, of the middle of the last step; 0 before the first step \
                  and where no particle is near.",
        values: |n| Data::Vectors(&n.velocity),
    },
    Field {
        name: "mass",
        label: "kg",
        meaning: "Lumped mass.",
        values: |n| Data::F64(&n.mass),
    },
    Field {
        name: "reaction",
        label: "N, on the material",
        meaning: "Force of all boundaries, absorbing ones included, on the material.",
        values: |n| Data::Vectors(&n.reaction),
    },
];

/// The unit of a field of the frames by its name, with its sign convention; none if it has none, or is a
/// model's.
pub(crate) fn unit(field: &str) -> Option<&'static str> {
    let of_particles = PARTICLE_FIELDS.iter().map(|f| (f.name, f.label));
    let mut all = of_particles.chain(NODE_FIELDS.iter().map(|f| (f.name, f.label)));
    all.find(|f| f.0 == field)
        .map(|f| f.1)
        .filter(|unit| !unit.is_empty())
}

/// Writes the fields above, those of the models, and `more`.
pub(super) fn write_particles(
    sim: &Simulation,
    time: f64,
    path: &std::path::Path,
    more: &[Array],
    texts: &[Texts],
) -> Result<(), FileError> {
    let p = sim.particles();
    let count = p.len();
    let own = (PARTICLE_FIELDS.iter()).map(|f| (f.name, f.label, f.values.values(p)));
    let of_models = state_fields(sim).into_iter();
    let values: Vec<_> = own
        .chain(of_models.map(|(field, values)| (field.name, field.unit, values)))
        .collect();
    let fields: Vec<Array> = (values.iter())
        .map(|(name, label, values)| Array::new(name, values.data(count), label))
        .chain(more.iter().copied())
        .collect();
    let position = |i| p.position.at(i);
    vtu::write_points(path, time, Each::new(count, &position), &fields, texts)
}

/// The state variables of all models by name; 0 for particles of models that have none of a name.
fn state_fields(sim: &Simulation) -> Vec<(StateField, Values<'_>)> {
    let (plan, particles) = (sim.plan(), sim.particles());
    let mut fields: Vec<StateField> = Vec::new();
    for field in plan.materials.iter().flat_map(|m| m.model.state_fields()) {
        if fields.iter().all(|f| f.name != field.name) {
            fields.push(*field);
        }
    }
    let values = |field: StateField| {
        // Which of its numbers it is, for each body.
        let of_body = plan.bodies.iter().map(|body| {
            let own = plan.materials[body.material].model.state_fields();
            own.iter().position(|f| f.name == field.name)
        });
        let of_body: Vec<Option<usize>> = of_body.collect();
        let value = move |p: usize| {
            let at = of_body[usize::from(particles.body[p])];
            at.map_or(0.0, |at| particles.state.components()[at][p])
        };
        (field, Values::Scalar(Box::new(value)))
    };
    fields.into_iter().map(values).collect()
}

fn write_mesh(sim: &Simulation, time: f64, path: &std::path::Path) -> Result<(), FileError> {
    let nodes = sim.node_fields();
    let fields = NODE_FIELDS.map(|f| Array::new(f.name, (f.values)(&nodes), f.label));
    let mesh = sim.mesh();
    vtu::write_mesh(path, time, &mesh.nodes, &mesh.tets, &fields)
}

/// p = −tr σ / 3, Pa.
fn mean_pressure(s: &[f64; 6]) -> f64 {
    // Not with a leading minus: no stress is to be no pressure, not -0.
    (0.0 - s[0] - s[1] - s[2]) / 3.0
}

/// Bytes of one frame of the particles and one of the mesh, headers left out.
pub(crate) fn frame_bytes(particles: usize, nodes: usize, elements: usize) -> usize {
    // Position, the fields above, and a cell of its own; node, fields; four numbers, offset, type.
    let particle = 24 + (4 + 2 + 24 + 24 + 48 + 8 + 8 + 8) + 17;
    let node = 24 + (24 + 8 + 24);
    particle * particles + node * nodes + (32 + 9) * elements
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triaxial_compression_gives_the_difference_of_the_stresses() {
        let s = [-100.0, -100.0, -400.0, 0.0, 0.0, 0.0];
        assert_eq!(mean_pressure(&s), 200.0);
        assert!((tensor::equivalent(&s) - 300.0).abs() < 1e-12);
        let shear = [0.0, 0.0, 0.0, 2.0, 0.0, 0.0];
        assert!((tensor::equivalent(&shear) - 2.0 * 3f64.sqrt()).abs() < 1e-15);
    }
}
