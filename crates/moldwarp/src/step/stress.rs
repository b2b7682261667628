//! Stage 6: stresses and volumes of particles.

use super::BLOCK;
use crate::parallel::{ByCell, fold};
use crate::simulation::Simulation;
use crate::tensor::{self, Voigt};

/// Volume and stress arrays of some particles.
type Arrays<'a> = (&'a mut [Voigt], &'a mut [f64]);

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
    let arrays = (&mut particles.stress[..], &mut particles.volume[..]);
    let block = ByCell::new(&active.offsets, arrays);
    let work = fold(block, BLOCK, &|block: ByCell<Arrays>| {
        let first = block.first();
        let (stresses, volumes) = block.particles;
        let mut work = [0.0; 2];
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
                *stress = material.update(&turned, &increment);
                let middle: Voigt = std::array::from_fn(|k| 0.5 * (turned[k] + stress[k]));
                let middle_volume = 0.5 * *volume * (1.0 + growth);
                *volume *= growth;
                work[0] += tensor::dot(&middle, &increment) * middle_volume;
                work[1] +=
                    tensor::trace(&middle) / 3.0 * (strain.volumetric - volumetric) * middle_volume;
            }
        }
        work
    });
    ledger.particle_stress_work(work);
}
