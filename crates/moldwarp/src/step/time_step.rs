//! The stable time step, Δt = C min h_e / c_e.

use super::shapes::Shapes;
use super::{CellFill, CellMedium, CellSums, Cells, TILES, correction};
use crate::Vec3;
use crate::lanes::{LANES, Lane, either, for_each_simd};
use crate::parallel::{Smallest, Sum, fold};
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
    let limits = Limits::of(sim);
    let own = 0..sim.active.own_tiles();
    let steps = fold(own, TILES, &|tiles: Range<usize>| {
        let (mut smallest, mut steps) = (Smallest::default(), Lane::of(0.0));
        for tile in tiles {
            find(sim, &limits, tile, &mut steps);
            for &step in steps.iter() {
                smallest = smallest.plus(Smallest(step));
            }
        }
        smallest
    });
    steps.0
}

/// The stable steps of a tile's cells.
fn find(sim: &Simulation, limits: &Limits, tile: usize, steps: &mut Lane) {
    let Cells {
        shapes,
        sums,
        medium,
        fills,
        ..
    } = &sim.cells;
    let (shapes, sum, fill) = (&shapes[tile], &sums[tile], &fills[tile]);
    match medium.get(tile) {
        None => times(sim.simd, limits, shapes, sum, &limits.alike, fill, steps),
        Some(CellMedium { wave_modulus, .. }) => {
            times(sim.simd, limits, shapes, sum, wave_modulus, fill, steps);
        }
    }
}

/// The middle of the element that has the shortest step.
fn shortest_at(sim: &Simulation) -> Vec3 {
    let limits = Limits::of(sim);
    let mut steps = Lane::of(0.0);
    let mut shortest = (f64::INFINITY, 0);
    for tile in 0..sim.active.own_tiles() {
        find(sim, &limits, tile, &mut steps);
        for (l, &step) in steps.iter().enumerate() {
            if step < shortest.0 {
                shortest = (step, tile * LANES + l);
            }
        }
    }
    sim.plan
        .mesh
        .centroid(sim.active.elements[shortest.1] as usize)
}

/// What all cells share.
struct Limits {
    partly: f64,
    stiffest: f64,
    /// The same for each cell, where all are alike.
    alike: Lane,
    viscosity: f64,
}

impl Limits {
    fn of(sim: &Simulation) -> Limits {
        let numerics = &sim.plan.numerics;
        let stiffest = sim.elasticity.iter().map(|e| e[2]).fold(0.0, f64::max);
        Limits {
            partly: correction::stiffening(numerics.mass),
            stiffest,
            alike: Lane::of(stiffest),
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
        wave_modulus: &Lane,
        fill: &CellFill,
        steps: &mut Lane,
    ) {
        for l in 0..LANES {
            let modulus = either(sum.volume[l] > 0.0, wave_modulus[l], limits.stiffest);
            let filled = fill.filled[l] > 0.0;
            let own = sum.mass[l] / (sum.solid[l] * limits.partly);
            let density = either(filled, fill.density[l], own);
            let travel = shapes.altitude[l] / (modulus / density).sqrt();
            let xi = limits.viscosity / travel;
            let step = travel * ((1.0 + xi * xi).sqrt() - xi);
            let holds = filled | (sum.solid[l] > 0.0);
            steps[l] = either(holds, step, f64::INFINITY);
        }
    }
}
