//! The stable time step, Δt = C min h_e / c_e.

use super::shapes::Shapes;
use super::{CellForce, CellStress, CellSums, TILES, correction};
use crate::Vec3;
use crate::lanes::{LANES, Lane, either, for_each_simd, get};
use crate::parallel::{Smallest, Sum, fold};
use crate::simulation::Simulation;

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
        "the stable time step has collapsed from {longest:.3e} s to {stable:.3e} s, around {place} m: an \
         element there is nearly flat, or its material has become as dense or light as it should never be; \
         look at the last frame, and make elements larger or loads smaller there"
    )]
    Collapsed {
        longest: f64,
        stable: f64,
        place: Vec3,
    },
    #[error(
        "there is no stable time step, as a stress, volume or velocity is not a finite number: \
         look for values out of proportion in materials, loads and velocities"
    )]
    NotFinite,
}

/// A stable step below this part of the longest of the stage will not come to an end. (A mesh that moves
/// compresses elements to a fiftieth.)
const COLLAPSED: f64 = 1e-4;

/// The step to take, s.
pub(super) fn choose(sim: &mut Simulation) -> Result<f64, TimeStepError> {
    let stable = sim.plan.numerics.courant * critical(sim);
    if !stable.is_finite() || stable <= 0.0 {
        return Err(TimeStepError::NotFinite);
    }
    let longest = sim.clock.longest.max(stable);
    sim.clock.longest = longest;
    if stable < COLLAPSED * longest {
        return Err(TimeStepError::Collapsed {
            longest,
            stable,
            place: shortest_at(sim),
        });
    }
    let numerics = &sim.plan.numerics;
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
    let Simulation { cells, simd, .. } = sim;
    let limits = Limits::of(sim);
    let records = (
        &cells.shapes[..],
        (&cells.sums[..], &cells.stresses[..], &cells.forces[..]),
    );
    type Records<'a> = (
        &'a [Shapes],
        (&'a [CellSums], &'a [CellStress], &'a [CellForce]),
    );
    fold(
        records,
        TILES,
        &|(shapes, (sums, stresses, forces)): Records| {
            let mut smallest = Smallest::default();
            let mut steps = Lane::of(0.0);
            let records = shapes.iter().zip(sums).zip(stresses).zip(forces);
            for (((shapes, sum), stress), force) in records {
                times(*simd, &limits, shapes, sum, stress, force, &mut steps);
                for &step in steps.iter() {
                    smallest = smallest.plus(Smallest(step));
                }
            }
            smallest
        },
    )
    .0
}

/// The middle of the element that has the shortest step.
fn shortest_at(sim: &Simulation) -> Vec3 {
    let limits = Limits::of(sim);
    let Simulation {
        plan, cells, simd, ..
    } = sim;
    let mut steps = Lane::of(0.0);
    let mut shortest = (f64::INFINITY, 0);
    for tile in 0..cells.sums.len() {
        let (shapes, sum) = (&cells.shapes[tile], &cells.sums[tile]);
        let (stress, force) = (&cells.stresses[tile], &cells.forces[tile]);
        times(*simd, &limits, shapes, sum, stress, force, &mut steps);
        for (l, &step) in steps.iter().enumerate() {
            if step < shortest.0 {
                shortest = (step, tile * LANES + l);
            }
        }
    }
    plan.mesh.centroid(sim.active.elements[shortest.1] as usize)
}

/// What all cells share.
struct Limits {
    partly: f64,
    stiffest: f64,
    viscosity: f64,
}

impl Limits {
    fn of(sim: &Simulation) -> Limits {
        let numerics = &sim.plan.numerics;
        Limits {
            partly: correction::stiffening(numerics.mass),
            stiffest: sim.elasticity.iter().map(|e| e[2]).fold(0.0, f64::max),
            viscosity: numerics.viscosity,
        }
    }
}

for_each_simd! {
    /// The stable step of each cell; infinite where there is no material.
    fn times(
        limits: &Limits,
        shapes: &Shapes,
        sum: &CellSums,
        stress: &CellStress,
        force: &CellForce,
        steps: &mut Lane,
    ) {
        for l in 0..LANES {
            let modulus = either(sum.volume[l] > 0.0, stress.wave_modulus[l], limits.stiffest);
            let mass = get(&sum.mass, l).iter().sum::<f64>();
            let filled = force.filled[l] > 0.0;
            let own = mass / (sum.solid[l] * limits.partly);
            let density = either(filled, force.density[l], own);
            let travel = shapes.altitude[l] / (modulus / density).sqrt();
            let xi = limits.viscosity / travel;
            let step = travel * ((1.0 + xi * xi).sqrt() - xi);
            let holds = filled | (sum.solid[l] > 0.0);
            steps[l] = either(holds, step, f64::INFINITY);
        }
    }
}
