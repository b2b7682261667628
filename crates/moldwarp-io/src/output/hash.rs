//! Fingerprints by which two scenes, or the final states of two runs, are told to be the same.

use moldwarp::saved::{Out, Saved, Section};
use moldwarp::{Particles, Plan, Vec3};

/// BLAKE3 over named arrays of little-endian values.
///
/// Names and lengths are part of what is hashed: moving a value from one array to the next, or
/// renaming an array, gives another fingerprint.
#[derive(Default)]
pub struct Hasher(blake3::Hasher);

impl Hasher {
    pub fn new() -> Hasher {
        Hasher::default()
    }

    /// Adds an array of numbers; -0 and 0 differ, as bits do.
    pub fn floats(&mut self, name: &str, values: impl ExactSizeIterator<Item = f64>) {
        self.values(name, values, |out, v| out.put(&v.to_le_bytes()));
    }

    /// Adds an array of vectors.
    pub fn vectors(&mut self, name: &str, values: impl ExactSizeIterator<Item = Vec3>) {
        self.values(name, values, |out, v| v.save(out));
    }

    /// Adds an array of whole numbers.
    pub fn numbers(&mut self, name: &str, values: impl ExactSizeIterator<Item = u64>) {
        self.values(name, values, |out, v| out.put(&v.to_le_bytes()));
    }

    fn values<T>(
        &mut self,
        name: &str,
        values: impl ExactSizeIterator<Item = T>,
        put: impl Fn(&mut Out, T),
    ) {
        self.begin(name, values.len());
        let mut add = |bytes: &[u8]| {
            self.0.update(bytes);
        };
        let mut out = Out::new(&mut add);
        values.for_each(|v| put(&mut out, v));
        out.finish();
    }

    /// Adds a part of a state.
    pub fn section(&mut self, name: &str, section: &Section) {
        self.begin(name, section.size());
        section.pieces(&mut |bytes| {
            self.0.update(bytes);
        });
    }

    /// Adds a text.
    pub fn text(&mut self, name: &str, text: &str) {
        self.bytes(name, text.as_bytes());
    }

    /// Adds bytes.
    pub fn bytes(&mut self, name: &str, bytes: &[u8]) {
        self.begin(name, bytes.len());
        self.0.update(bytes);
    }

    /// The fingerprint in 64 hexadecimal digits.
    pub fn finish(&self) -> String {
        self.0.finalize().to_hex().to_string()
    }

    fn begin(&mut self, name: &str, count: usize) {
        self.0.update(&(name.len() as u64).to_le_bytes());
        self.0.update(name.as_bytes());
        self.0.update(&(count as u64).to_le_bytes());
    }
}

/// Fingerprint of everything that decides a simulation's result, with the mesh, without the
/// output and the number of threads. It may change with moldwarp's version.
pub fn scene_hash(plan: &Plan) -> String {
    // Taken apart, so that a part added to the plan is not forgotten here.
    let Plan {
        title: _,
        gravity,
        mesh,
        mesh_motion,
        symmetry,
        materials,
        bodies,
        boundaries,
        loads,
        contacts,
        probes,
        initial_stress,
        inherited,
        numerics,
        stages,
    } = plan;
    let mut h = Hasher::new();
    h.vectors("nodes", mesh.nodes.iter().copied());
    h.numbers("tets", mesh.tets.as_flattened().iter().map(|&n| n.into()));
    for group in &mesh.volume_groups {
        h.numbers(&group.name, group.elements.iter().map(|&e| e.into()));
    }
    for surface in &mesh.surfaces {
        let face = |f: &moldwarp::mesh::Face| u64::from(f.element) << 8 | u64::from(f.local);
        h.numbers(&surface.name, surface.faces.iter().map(face));
    }
    // Debug prints every f64 so that it reads back the same: no digit is lost.
    h.text("gravity", &format!("{gravity:?}"));
    if let Some(motion) = mesh_motion {
        h.text("mesh_motion", &format!("{motion:?}"));
    }
    h.text("symmetry", &format!("{symmetry:?}"));
    h.text("materials", &format!("{materials:?}"));
    h.text("bodies", &format!("{bodies:?}"));
    h.text("boundaries", &format!("{boundaries:?}"));
    h.text("loads", &format!("{loads:?}"));
    h.text("contacts", &format!("{contacts:?}"));
    h.text("probes", &format!("{probes:?}"));
    h.text("initial_stress", &format!("{initial_stress:?}"));
    inherited_particles(&mut h, inherited);
    h.text("numerics", &format!("{numerics:?}"));
    h.text("stages", &format!("{stages:?}"));
    h.finish()
}

/// What counts of inherited particles.
fn inherited_particles(h: &mut Hasher, p: &Particles) {
    h.numbers("inherited", p.body.iter().map(|&b| b.into()));
    h.vectors("position", p.position.iter());
    let (stress, state) = (p.stress.components(), p.state.components());
    for component in stress.into_iter().chain(state) {
        h.floats("stress and state", component.iter().copied());
    }
    h.floats("volume", p.volume.iter().copied());
    h.floats("initial_volume", p.initial_volume.iter().copied());
    h.floats("mass", p.mass.iter().copied());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(add: impl Fn(&mut Hasher)) -> String {
        let mut h = Hasher::new();
        add(&mut h);
        h.finish()
    }

    #[test]
    fn names_lengths_and_bits_count() {
        let base = of(|h| h.floats("a", [1.0, 2.0].into_iter()));
        assert_eq!(base.len(), 64);
        assert_eq!(base, of(|h| h.floats("a", [1.0, 2.0].into_iter())));
        assert_ne!(base, of(|h| h.floats("b", [1.0, 2.0].into_iter())));
        let split = of(|h| {
            h.floats("a", [1.0].into_iter());
            h.floats("", [2.0].into_iter());
        });
        assert_ne!(base, split);
        let zero = of(|h| h.floats("a", [0.0].into_iter()));
        assert_ne!(zero, of(|h| h.floats("a", [-0.0].into_iter())));
    }
}
