//! ParaView frames of a simulation.

use crate::output::pvd::Collection;
use crate::output::vtu::{self, Array, Data};
use crate::output::{FileError, Folder};
use moldwarp::Simulation;

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
    let deviatoric: Vec<f64> = p.stress.iter().map(deviatoric_stress).collect();
    let density: Vec<f64> = p.mass.iter().zip(&p.volume).map(|(m, v)| m / v).collect();
    let fields = [
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
    vtu::write_points(path, sim.time(), &p.position, &fields)
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

/// q = √(3/2 s : s) with the deviator s of σ, Pa: |σ₁ − σ₃| in triaxial compression.
fn deviatoric_stress(s: &[f64; 6]) -> f64 {
    let p = mean_pressure(s);
    let normal: f64 = s[..3].iter().map(|s| (s + p) * (s + p)).sum();
    let shear: f64 = s[3..].iter().map(|s| s * s).sum();
    (1.5 * (normal + 2.0 * shear)).sqrt()
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
        assert!((deviatoric_stress(&s) - 300.0).abs() < 1e-12);
        let shear = [0.0, 0.0, 0.0, 2.0, 0.0, 0.0];
        assert!((deviatoric_stress(&shear) - 2.0 * 3f64.sqrt()).abs() < 1e-15);
    }
}
