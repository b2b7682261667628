//! The stable time step, Δt = C min h_e / c_e.

use super::{BLOCK, correction};
use crate::parallel::{Smallest, fold};
use crate::simulation::Simulation;
use std::ops::Range;

/// A forced step that would be unstable, or a state that has none.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
pub enum TimeStepError {
    #[error(
        "the forced time step of {forced:?} s is above the stable one, {stable:.3e} s at Courant \
         number {courant}: force a smaller one, or none"
    )]
    AboveStable {
        forced: f64,
        stable: f64,
        courant: f64,
    },
    #[error(
        "there is no stable time step, as a stress, volume or velocity is not a finite number: \
         look for values out of proportion in materials, loads and velocities"
    )]
    NotFinite,
}

/// The step to take, s.
pub(super) fn choose(sim: &Simulation) -> Result<f64, TimeStepError> {
    let numerics = &sim.plan.numerics;
    let stable = numerics.courant * critical(sim);
    if !stable.is_finite() || stable <= 0.0 {
        return Err(TimeStepError::NotFinite);
    }
    match numerics.time_step {
        Some(forced) if forced > stable => Err(TimeStepError::AboveStable {
            forced,
            stable,
            courant: numerics.courant,
        }),
        Some(forced) => Ok(forced),
        None => Ok(numerics.max_time_step.map_or(stable, |m| m.min(stable))),
    }
}

/// min h_e / c_e over all cells, s: h_e the shortest altitude, c_e the fastest P-wave speed
/// present. In a filled cell the density is the nodes' (mass over element volume), since a full
/// element that happens to hold few particles is as stiff as any; elsewhere stiffness and mass
/// fade together and the particles' own density counts (without what has opened in tension), lowered by what the correction for
/// averaging can stiffen (`correction::stiffening`). Viscosity β lowers the step by
/// √(1+ξ²) − ξ with ξ = β c_e / h_e (the bound of a lagged damping force).
pub(crate) fn critical(sim: &Simulation) -> f64 {
    let Simulation {
        plan,
        active,
        nodes,
        cells,
        ..
    } = sim;
    let partly = correction::stiffening(plan.numerics.mass);
    let stiffest = sim.elasticity.iter().map(|e| e[2]).fold(0.0, f64::max);
    fold(0..cells.sums.len(), BLOCK, &|range: Range<usize>| {
        let mut smallest = Smallest::default();
        for c in range {
            let sum = &cells.sums[c];
            let modulus = if sum.volume > 0.0 {
                cells.stresses[c].wave_modulus
            } else {
                stiffest
            };
            let density = if cells.forces[c].filled {
                active.cell_nodes[c]
                    .iter()
                    .map(|&n| nodes[n as usize].density)
                    .sum::<f64>()
                    * 0.25
            } else if sum.solid > 0.0 {
                sum.mass.iter().sum::<f64>() / (sum.solid * partly)
            } else {
                continue;
            };
            let altitude = plan.mesh.altitudes[active.elements[c] as usize];
            let travel = altitude / (modulus / density).sqrt();
            let xi = plan.numerics.viscosity / travel;
            let step = travel * ((1.0 + xi * xi).sqrt() - xi);
            smallest = crate::parallel::Sum::plus(smallest, Smallest(step));
        }
        smallest
    })
    .0
}
