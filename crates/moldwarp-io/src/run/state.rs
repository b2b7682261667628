//! The fingerprint of a simulation's state.

use crate::output::Hasher;
use moldwarp::Simulation;
use moldwarp::material::STATE_SIZE;
use moldwarp::measure::Energies;
use moldwarp::particles::Particles;

/// Fingerprint of every array of the state, particles in the order of their ids: two runs ended
/// the same, bit for bit, when it is the same.
pub fn state_hash(sim: &Simulation) -> String {
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
    } = sim.particles();
    let mut order: Vec<usize> = (0..id.len()).collect();
    order.sort_unstable_by_key(|&p| id[p]);
    let by_id = || order.iter().copied();
    let mut h = Hasher::new();
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
    let nodes = sim.node_fields();
    h.vectors("node position", sim.mesh().nodes.iter().copied());
    h.vectors("node velocity", nodes.velocity.iter().copied());
    h.floats("node mass", nodes.mass.iter().copied());
    h.vectors("node reaction", nodes.reaction.iter().copied());
    for (name, energy) in Energies::NAMES.into_iter().zip(sim.energies().values()) {
        h.floats(name, [energy].into_iter());
    }
    h.floats("time", [sim.time()].into_iter());
    h.numbers("steps", [sim.steps()].into_iter());
    h.finish()
}
