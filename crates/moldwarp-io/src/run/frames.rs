//! ParaView frames of a simulation.

use crate::output::pvd::Collection;
use crate::output::vtu::{self, Array, Data};
use crate::output::{FileError, Folder};
use moldwarp::material::StateField;
use moldwarp::{Simulation, tensor};

/// Writes frames of the particles and of the mesh into a folder.
#[derive(Debug)]
pub(crate) struct Frames {
    folder: Folder,
    particles: Collection,
    mesh: Collection,
}

impl Frames {
    pub fn new(folder: &Folder) -> Frames {
        Frames {
            folder: folder.clone(),
            particles: Collection::new(folder.collection("particles")),
            mesh: Collection::new(folder.collection("mesh")),
        }
    }

    /// Number of frames so far.
    pub fn len(&self) -> usize {
        self.particles.len()
    }

    /// Writes the simulation as it is now.
    pub fn write(&mut self, sim: &Simulation) -> Result<(), FileError> {
        let number = self.len();
        let particles = Folder::frame("particles", number);
        write_particles(sim, &self.folder.path().join(&particles))?;
        self.particles.add(sim.time(), &particles)?;
        let mesh = Folder::frame("mesh", number);
        write_mesh(sim, &self.folder.path().join(&mesh))?;
        self.mesh.add(sim.time(), &mesh)
    }
}

fn write_particles(sim: &Simulation, path: &std::path::Path) -> Result<(), FileError> {
    let p = sim.particles();
    let pressure: Vec<f64> = p.stress.iter().map(mean_pressure).collect();
    let deviatoric: Vec<f64> = p.stress.iter().map(tensor::equivalent).collect();
    let density: Vec<f64> = p.mass.iter().zip(&p.volume).map(|(m, v)| m / v).collect();
    let states = state_fields(sim);
    let mut fields = vec![
        Array::new("id", Data::U32(&p.id), ""),
        Array::new("body", Data::U16(&p.body), ""),
        Array::new("velocity", Data::Vectors(&p.velocity), "m/s"),
        Array::new("displacement", Data::Vectors(&p.displacement), "m"),
        Array::new("stress", Data::Tensors(&p.stress), "Pa, tension positive"),
        Array::new(
            "mean_pressure",
            Data::F64(&pressure),
            "Pa, compression positive",
        ),
        Array::new(
            "deviatoric_stress",
            Data::F64(&deviatoric),
            "Pa, sqrt(3/2 s:s)",
        ),
        Array::new("density", Data::F64(&density), "kg/m3"),
    ];
    for (field, values) in &states {
        fields.push(Array::new(field.name, Data::F64(values), field.unit));
    }
    vtu::write_points(path, sim.time(), &p.position, &fields)
}

/// The state variables of all models by name; 0 for particles of models that have none of a name.
fn state_fields(sim: &Simulation) -> Vec<(StateField, Vec<f64>)> {
    let (plan, particles) = (sim.plan(), sim.particles());
    let model = |body: u16| &plan.materials[plan.bodies[usize::from(body)].material].model;
    let mut fields: Vec<StateField> = Vec::new();
    for field in plan.materials.iter().flat_map(|m| m.model.state_fields()) {
        if fields.iter().all(|f| f.name != field.name) {
            fields.push(*field);
        }
    }
    let value = |p: usize, name: &str| {
        let own = model(particles.body[p]).state_fields();
        let at = own.iter().position(|f| f.name == name);
        at.map_or(0.0, |at| particles.state[p][at])
    };
    fields
        .into_iter()
        .map(|field| {
            (
                field,
                (0..particles.len()).map(|p| value(p, field.name)).collect(),
            )
        })
        .collect()
}

fn write_mesh(sim: &Simulation, path: &std::path::Path) -> Result<(), FileError> {
    let nodes = sim.node_fields();
    let fields = [
        Array::new("velocity", Data::Vectors(&nodes.velocity), "m/s"),
        Array::new("mass", Data::F64(&nodes.mass), "kg"),
        Array::new(
            "reaction",
            Data::Vectors(&nodes.reaction),
            "N, on the material",
        ),
    ];
    let mesh = sim.mesh();
    vtu::write_mesh(path, sim.time(), &mesh.nodes, &mesh.tets, &fields)
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
