//! The stable time step, Δt = C min h_e / c_e.

use super::shapes::Shapes;
use super::{CellFill, CellMedium, CellSums, correction};
use crate::Vec3;
use crate::lanes::{LANES, Lane, Simd, either, for_each_simd};
use crate::mesh::steepest_squared;
use crate::parallel::{Smallest, Sum};
use crate::plan::Numerics;
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

/// The stable steps of cells at their Courant number 1.
///
/// min h_e / c_e over all cells, s: h_e the shortest altitude, c_e the fastest P-wave speed
/// present. In a filled cell the density is the nodes' (mass over element volume), since a full
/// element that happens to hold few particles is as stiff as any; elsewhere stiffness and mass
/// fade together and the particles' own density counts (without what has opened in tension), lowered by what the correction for
/// averaging can stiffen (`correction::stiffening`). Viscosity β lowers the step by
/// √(1+ξ²) − ξ with ξ = β c_e / h_e (the bound of a lagged damping force).
pub(super) struct Steps {
    /// (h_e / c_e)² of the last cells, s²; infinite where there is no material.
    own: Lane,
    /// The smallest in each lane, s².
    shortest: Lane,
}

impl Default for Steps {
    fn default() -> Steps {
        Steps {
            own: Lane::of(f64::INFINITY),
            shortest: Lane::of(f64::INFINITY),
        }
    }
}

impl Steps {
    /// Adds cells.
    #[inline]
    pub fn add(
        &mut self,
        simd: Simd,
        limits: &Limits,
        shapes: &Shapes,
        sum: &CellSums,
        medium: Option<&CellMedium>,
        fill: &CellFill,
    ) {
        let wave_modulus = medium.map_or(&limits.alike, |medium| &medium.wave_modulus);
        travel(simd, limits, shapes, sum, wave_modulus, fill, self);
    }

    /// The shortest of all.
    pub fn shortest(&self, limits: &Limits) -> Smallest {
        let squares = self.shortest.iter().map(|&squared| Smallest(squared));
        let travel = squares.fold(Smallest::default(), Sum::plus).0.sqrt();
        if travel.is_infinite() {
            return Smallest(travel);
        }
        // A longer way has a longer step with viscosity, too.
        let xi = limits.viscosity / travel;
        Smallest(travel * ((1.0 + xi * xi).sqrt() - xi))
    }
}

/// min h_e / c_e over all cells, s, when forces were last found.
pub(crate) fn critical(sim: &Simulation) -> f64 {
    sim.cells.shortest
}

/// The middle of the element that has the shortest step.
fn shortest_at(sim: &Simulation) -> Vec3 {
    let Simulation {
        plan,
        active,
        shared,
        cells,
        simd,
        ..
    } = sim;
    let limits = Limits::new(&plan.numerics, &sim.elasticity);
    let (mut steps, mut shapes) = (Steps::default(), Shapes::default());
    let mut shortest = (f64::INFINITY, 0);
    for tile in 0..active.own_tiles() {
        let nodes = active.tile_nodes(tile);
        shapes.enter(*simd, nodes, &shared.places);
        let (sum, fill) = (&cells.sums[tile], &cells.fills[tile]);
        steps.add(*simd, &limits, &shapes, sum, cells.medium.get(tile), fill);
        for (l, &step) in steps.own.iter().enumerate() {
            if step < shortest.0 {
                shortest = (step, tile * LANES + l);
            }
        }
    }
    plan.mesh.centroid(active.elements[shortest.1] as usize)
}

/// What all cells share.
pub(super) struct Limits {
    partly: f64,
    stiffest: f64,
    /// The same for each cell, where all are alike.
    alike: Lane,
    viscosity: f64,
}

impl Limits {
    /// λ, G and E_c of all bodies, Pa.
    pub fn new(numerics: &Numerics, elasticity: &[[f64; 3]]) -> Limits {
        let stiffest = elasticity.iter().map(|e| e[2]).fold(0.0, f64::max);
        Limits {
            partly: correction::stiffening(numerics.mass),
            stiffest,
            alike: Lane::of(stiffest),
            viscosity: numerics.viscosity,
        }
    }
}

for_each_simd! {
    /// (h_e / c_e)² of each cell; infinite where there is no material.
    fn travel(
        limits: &Limits,
        shapes: &Shapes,
        sum: &CellSums,
        wave_modulus: &Lane,
        fill: &CellFill,
        steps: &mut Steps,
    ) {
        for l in 0..LANES {
            let modulus = either(sum.volume[l] > 0.0, wave_modulus[l], limits.stiffest);
            // One division for the density and the square of the altitude.
            let filled = fill.filled[l] > 0.0;
            let mass = either(filled, fill.density[l], sum.mass[l]);
            let volume = either(filled, 1.0, sum.solid[l] * limits.partly);
            let steepness = steepest_squared(&shapes.gradients(l));
            let squared = mass / (volume * modulus * steepness);
            let holds = filled | (sum.solid[l] > 0.0);
            let squared = either(holds, squared, f64::INFINITY);
            steps.own[l] = squared;
            // What is not a number must win, so that it is noticed.
            let least = steps.shortest[l];
            steps.shortest[l] = either((least <= squared) | least.is_nan(), least, squared);
        }
    }
}
