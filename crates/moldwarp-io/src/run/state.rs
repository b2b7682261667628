//! The fingerprint of a simulation's state.

use crate::output::Hasher;
use moldwarp::Simulation;
use moldwarp::material::STATE_SIZE;
use moldwarp::particles::Particles;
use std::convert::Infallible;

/// Fingerprint of every array of the state, all that a checkpoint holds of it, with particles in the
/// order of their ids: two runs ended the same, bit for bit, when it is the same.
pub fn state_hash(sim: &Simulation) -> String {
    let mut h = Hasher::new();
    particles(&mut h, sim.particles());
    let Ok(()) = sim.save(|name, section| {
        if name != "particles" {
            h.section(name, &section);
        }
        Ok::<(), Infallible>(())
    });
    h.finish()
}

fn particles(h: &mut Hasher, particles: &Particles) {
    // Taken apart, so that an array added to the particles is not forgotten here.
    let Particles {
        id,
        body,
        element,
        position,
        velocity,
        origin,
        stress,
        state,
        volume,
        initial_volume,
        mass,
    } = particles;
    let mut order: Vec<u32> = (0..id.len() as u32).collect();
    order.sort_unstable_by_key(|&p| id[p as usize]);
    let by_id = || order.iter().map(|&p| p as usize);
    h.numbers("id", by_id().map(|p| id[p].into()));
    h.numbers("body", by_id().map(|p| body[p].into()));
    h.numbers("element", by_id().map(|p| element[p].into()));
    h.vectors("position", by_id().map(|p| position.at(p)));
    h.vectors("velocity", by_id().map(|p| velocity.at(p)));
    h.vectors("origin", by_id().map(|p| origin.at(p)));
    for c in 0..6 {
        h.floats("stress", by_id().map(|p| stress.components()[c][p]));
    }
    for c in 0..STATE_SIZE {
        h.floats("state", by_id().map(|p| state.components()[c][p]));
    }
    h.floats("volume", by_id().map(|p| volume[p]));
    h.floats("initial_volume", by_id().map(|p| initial_volume[p]));
    h.floats("mass", by_id().map(|p| mass[p]));
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use moldwarp::saved::{load, to_bytes};

    /// A loaded column on an absorbing boundary, with a probe.
    pub const SCENE: &str = r#"
        version = 1
        gravity = [0, 0, -10]
        [mesh]
        box = { size = [0.1, 0.1, 0.4], cells = [1, 1, 4] }
        [materials.soil]
        model = "mohr-coulomb"
        young_modulus = "100 kPa"
        poisson_ratio = 0.2
        cohesion = "1 kPa"
        friction_angle = "30 deg"
        unit_weight = "18 kN/m3"
        [bodies.layer]
        volume = "box"
        material = "soil"
        [[boundaries]]
        surface = "z-min"
        kind = "absorbing"
        [[loads]]
        surface = "z-max"
        body = "layer"
        pressure = "1 kPa"
        [probes.bottom]
        surface = "z-min"
        quantities = ["displacement"]
        [[stages]]
        name = "all"
        steps = 100
    "#;

    fn column() -> Simulation {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("scene.toml");
        std::fs::write(&path, SCENE).unwrap();
        let scene = crate::scene::load(&path, &[]).unwrap();
        let mut sim = Simulation::new(scene.plan).unwrap();
        (0..20).for_each(|_| sim.step().unwrap());
        sim
    }

    fn hash(particles: &Particles) -> String {
        let mut h = Hasher::new();
        super::particles(&mut h, particles);
        h.finish()
    }

    /// One bit in any array of the particles, at its beginning, middle or end.
    #[test]
    fn a_flipped_bit_of_a_particle_gives_another_hash() {
        let sim = column();
        let mut bytes = to_bytes(sim.particles());
        let (whole, count) = (hash(sim.particles()), bytes.len());
        let mut flipped = 0;
        // A stride that shares no factor with the sizes of numbers hits every array and every bit.
        for bit in (0..8 * count).step_by(251) {
            bytes[bit / 8] ^= 1 << (bit % 8);
            // In a length it makes arrays that do not belong together, or nothing at all.
            if let Ok(particles) = load::<Particles>(&bytes) {
                assert_ne!(hash(&particles), whole, "bit {bit} of {}", 8 * count);
                flipped += 1;
            }
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        assert!(flipped > 200, "{flipped}");
    }

    /// The same of all else that is kept.
    #[test]
    fn a_flipped_bit_of_any_section_gives_another_hash() {
        let sim = column();
        let of = |flip: Option<(&str, usize)>| {
            let mut h = Hasher::new();
            let Ok(()) = sim.save(|name, section| {
                let mut bytes = section.to_bytes();
                if let Some((_, bit)) = flip.filter(|f| f.0 == name) {
                    bytes[bit / 8] ^= 1 << (bit % 8);
                }
                h.bytes(name, &bytes);
                Ok::<(), Infallible>(())
            });
            h.finish()
        };
        let whole = of(None);
        let mut sections = Vec::new();
        let Ok(()) = sim.save(|name, section| {
            sections.push((name, 8 * section.size()));
            Ok::<(), Infallible>(())
        });
        assert!(sections.len() > 20);
        for (name, bits) in sections {
            for bit in [0, bits / 2, bits - 1] {
                assert_ne!(of(Some((name, bit))), whole, "bit {bit} of {name}");
            }
        }
    }
}
