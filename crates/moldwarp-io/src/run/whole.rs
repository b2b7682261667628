//! What is reported: of a part of a body, what it stands for of the whole one.
//!
//! The simulation's own figures are those of the part that it computes. All figures on their way to
//! the history, the summary and the forecast pass through here; frames show the part.

use moldwarp::measure::Energies;
use moldwarp::plan::{Contact, Quantity};
use moldwarp::{Simulation, Vec3};

/// Masses, volumes and energies of the whole body for one of the part.
pub(crate) fn factor(sim: &Simulation) -> f64 {
    sim.plan()
        .symmetry
        .map_or(1.0, |symmetry| symmetry.whole(1.0))
}

/// kg.
pub(crate) fn mass(sim: &Simulation) -> f64 {
    sim.particles().total_mass() * factor(sim)
}

/// J.
pub(crate) fn energies(sim: &Simulation) -> Energies {
    sim.energies().times(factor(sim))
}

/// J.
pub(crate) fn energy_turned_over(sim: &Simulation) -> f64 {
    sim.energy_turned_over() * factor(sim)
}

/// Appends the probes' values, in the order of the columns: forces and volumes are those of the whole
/// body, all else is what it is at the place of the probe.
pub(crate) fn probe_values(sim: &Simulation, out: &mut Vec<f64>) {
    let mut at = out.len();
    sim.probe_values(out);
    let Some(symmetry) = sim.plan().symmetry else {
        return;
    };
    for quantity in sim.plan().probes.iter().flat_map(|p| &p.quantities) {
        let values = &mut out[at..at + quantity.components().len()];
        match quantity {
            Quantity::Reaction | Quantity::Contact => {
                let part = Vec3::from_slice(values);
                values.copy_from_slice(&symmetry.whole_force(part).to_array());
            }
            Quantity::Volume => values[0] *= factor(sim),
            _ => {}
        }
        at += values.len();
    }
}

/// Appends what contacts do, in the order of the columns: forces are those on the whole body, numbers
/// of nodes those of the part.
pub(crate) fn contact_values(sim: &Simulation, out: &mut Vec<f64>) {
    let at = out.len();
    sim.contact_values(out);
    let Some(symmetry) = sim.plan().symmetry else {
        return;
    };
    for values in out[at..].chunks_exact_mut(Contact::COLUMNS.len()) {
        for force in values[..6].chunks_exact_mut(3) {
            let whole = symmetry.whole_force(Vec3::from_slice(force));
            force.copy_from_slice(&whole.to_array());
        }
    }
}
