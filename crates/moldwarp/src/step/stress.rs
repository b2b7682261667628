//! Stage 6: stresses and volumes of particles.

use super::BLOCK;
use crate::material::State;
use crate::parallel::{ByCell, fold};
use crate::simulation::Simulation;
use crate::tensor::{self, Voigt};

/// Stresses, state variables and volumes of some particles.
type Arrays<'a> = (&'a mut [Voigt], &'a mut [State], &'a mut [f64]);

pub(super) fn run(sim: &mut Simulation) {
    let Simulation {
        plan,
        particles,
        active,
        nodes,
        cells,
        ledger,
        ..
    } = sim;
    let (active, nodes, strains) = (&*active, &nodes[..], &cells.strains[..]);
    let body = &particles.body;
    let (materials, bodies) = (&plan.materials, &plan.bodies);
    let smoothing = plan.numerics.smoothing;
    let arrays = (
        &mut particles.stress[..],
        &mut particles.state[..],
        &mut particles.volume[..],
    );
    let block = ByCell::new(&active.offsets, arrays);
    let work = fold(block, BLOCK, &|block: ByCell<Arrays>| {
        let first = block.first();
        let (stresses, states, volumes) = block.particles;
        let mut work = [0.0; 3];
        for c in block.cells {
            let strain = &strains[c];
            let volumetric = if smoothing {
                active.cell_nodes[c]
                    .iter()
                    .map(|&n| nodes[n as usize].volumetric)
                    .sum::<f64>()
                    * 0.25
            } else {
                strain.volumetric
            };
            let mut increment = tensor::strain(&strain.midpoint);
            let change = (volumetric - strain.volumetric) / 3.0;
            (0..3).for_each(|k| increment[k] += change);
            let spin = tensor::spin_rotation(&strain.midpoint);
            // Exact for the volume of a homogeneous compression: (1 + ½tr) / (1 − ½tr).
            let growth = (1.0 + 0.5 * volumetric) / (1.0 - 0.5 * volumetric);
            for p in active.offsets[c] as usize..active.offsets[c + 1] as usize {
                let stress = &mut stresses[p - first];
                let volume = &mut volumes[p - first];
                let material = &materials[bodies[body[p] as usize].material].model;
                let turned = tensor::rotate(stress, &spin);
                let update = material.update(&turned, &increment, &mut states[p - first]);
                *stress = update.stress;
                let middle: Voigt = std::array::from_fn(|k| 0.5 * (turned[k] + stress[k]));
                let middle_volume = 0.5 * *volume * (1.0 + growth);
                *volume *= growth;
                let plastic = tensor::dot(&middle, &update.plastic_strain) * middle_volume;
                work[0] += tensor::dot(&middle, &increment) * middle_volume - plastic;
                work[2] += plastic;
                work[1] +=
                    tensor::trace(&middle) / 3.0 * (strain.volumetric - volumetric) * middle_volume;
            }
        }
        work
    });
    ledger.particle_stress_work(work);
}
