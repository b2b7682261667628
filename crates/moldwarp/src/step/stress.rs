//! Stage 6: stresses and volumes of particles.

use super::{BLOCK, CellStrain, smoothing};
use crate::material::State;
use crate::parallel::{ByCell, fold};
use crate::plan::Smoothing;
use crate::simulation::Simulation;
use crate::tensor::{self, Voigt};

/// Stresses, state variables and volumes of some particles.
type Arrays<'a> = (&'a mut [Voigt], &'a mut [State], &'a mut [f64]);

/// What happens to a particle in a step.
#[derive(Clone, Copy)]
struct Increment {
    strain: Voigt,
    /// Volume after the step over that before.
    growth: f64,
    /// Volumetric strain of the cell that smoothing has left out.
    left_out: f64,
}

impl Increment {
    fn new(cell: &CellStrain, volumetric: f64) -> Increment {
        let mut strain = tensor::strain(&cell.midpoint);
        let change = (volumetric - cell.volumetric) / 3.0;
        (0..3).for_each(|k| strain[k] += change);
        Increment {
            strain,
            // Exact for the volume of a homogeneous compression: (1 + ½tr) / (1 − ½tr).
            growth: (1.0 + 0.5 * volumetric) / (1.0 - 0.5 * volumetric),
            left_out: cell.volumetric - volumetric,
        }
    }
}

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
    let smooth = plan.numerics.smoothing != Smoothing::Off;
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
            let own = Increment::new(strain, strain.volumetric);
            let smoothed = if smooth {
                Increment::new(strain, smoothing::cell(&active.cell_nodes[c], nodes))
            } else {
                own
            };
            let spin = tensor::spin_rotation(&strain.midpoint);
            for p in active.offsets[c] as usize..active.offsets[c + 1] as usize {
                let stress = &mut stresses[p - first];
                let volume = &mut volumes[p - first];
                let material = &materials[bodies[body[p] as usize].material].model;
                let state = &mut states[p - first];
                let separated = material.is_separated(stress, state);
                let step = if separated { &own } else { &smoothed };
                let turned = tensor::rotate(stress, &spin);
                let update = material.update(&turned, &step.strain, state);
                *stress = update.stress;
                let middle: Voigt = std::array::from_fn(|k| 0.5 * (turned[k] + stress[k]));
                let middle_volume = 0.5 * *volume * (1.0 + step.growth);
                *volume *= step.growth;
                let plastic = tensor::dot(&middle, &update.plastic_strain) * middle_volume;
                work[0] += tensor::dot(&middle, &step.strain) * middle_volume - plastic;
                work[2] += plastic;
                work[1] += tensor::trace(&middle) / 3.0 * step.left_out * middle_volume;
            }
        }
        work
    });
    ledger.particle_stress_work(work);
}
