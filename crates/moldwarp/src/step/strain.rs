//! Stage 5: strain of each cell, its volumetric part smoothed (see `smoothing`).

use super::{BLOCK, CellStrain, smoothing};
use crate::mesh::Mesh;
use crate::parallel::{Sum, fold};
use crate::simulation::Simulation;
use crate::{Mat3, Vec3};
use std::ops::Range;

pub(super) fn run(sim: &mut Simulation) {
    gradients(sim);
    smoothing::strains(sim);
}

/// Σ u_i ⊗ ∇N_i in element `e`.
#[inline]
pub(super) fn gradient(mesh: &Mesh, e: usize, u: [Vec3; 4]) -> Mat3 {
    let g = &mesh.gradients[e];
    let (a, b, c) = (u[1] - u[0], u[2] - u[0], u[3] - u[0]);
    Mat3::from_cols(
        a * g[0].x + b * g[1].x + c * g[2].x,
        a * g[0].y + b * g[1].y + c * g[2].y,
        a * g[0].z + b * g[1].z + c * g[2].z,
    )
}

fn gradients(sim: &mut Simulation) {
    let Simulation {
        plan,
        active,
        nodes,
        cells,
        ledger,
        ..
    } = sim;
    let (mesh, active, nodes) = (&plan.mesh, &*active, &nodes[..]);
    let (sums, forces) = (&cells.sums[..], &cells.forces[..]);
    let items = (0..sums.len(), &mut cells.strains[..]);
    let work = fold(items, BLOCK, &|(range, strains): (
        Range<usize>,
        &mut [CellStrain],
    )| {
        let mut work = [0.0; 4];
        for (c, strain) in range.zip(strains) {
            let moved = active.cell_nodes[c].map(|n| nodes[n as usize].moved);
            let gradient = gradient(mesh, active.elements[c] as usize, moved);
            strain.gradient = gradient;
            strain.midpoint = gradient * (Mat3::IDENTITY + gradient * 0.5).inverse();
            strain.volumetric =
                strain.midpoint.x_axis.x + strain.midpoint.y_axis.y + strain.midpoint.z_axis.z;
            let [own, mean, viscous] = forces[c].half_work(&sums[c].stress, &gradient);
            let smoothed = forces[c].half_smoothing_work(&gradient);
            work = work.plus([own, mean, viscous, smoothed]);
        }
        work
    });
    ledger.grid_stress_work([work[0], work[1], work[2]]);
    ledger.stress_smoothing_work(work[3]);
}
