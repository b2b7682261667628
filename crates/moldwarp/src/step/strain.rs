//! Stage 5: strain of each cell, its volumetric part smoothed by nodal mixed discretisation
//! (Detournay and Dzik 2006; Jassim et al. Eq. 15–16).

use super::{BLOCK, CellForce, CellStrain, CellSums, Node};
use crate::mesh::Mesh;
use crate::parallel::{Sum, fold};
use crate::simulation::Simulation;
use crate::{Mat3, Vec3};
use std::ops::Range;

pub(super) fn run(sim: &mut Simulation) {
    gradients(sim);
    if sim.plan.numerics.smoothing {
        average_at_nodes(sim);
    }
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
        let mut work = [0.0; 3];
        for (c, strain) in range.zip(strains) {
            let moved = active.cell_nodes[c].map(|n| nodes[n as usize].moved);
            let gradient = gradient(mesh, active.elements[c] as usize, moved);
            strain.gradient = gradient;
            strain.midpoint = gradient * (Mat3::IDENTITY + gradient * 0.5).inverse();
            strain.volumetric =
                strain.midpoint.x_axis.x + strain.midpoint.y_axis.y + strain.midpoint.z_axis.z;
            work = work.plus(forces[c].half_work(&sums[c].stress, &gradient));
        }
        work
    });
    ledger.grid_stress_work(work);
}

/// Volume with which a cell counts in a node's average: V_e in the bulk, min(Σ V_p, V_e) at free
/// surfaces.
#[inline]
fn weight(force: &CellForce, sum: &CellSums, volume: f64) -> f64 {
    if force.filled {
        volume
    } else {
        sum.volume.min(volume)
    }
}

fn average_at_nodes(sim: &mut Simulation) {
    let Simulation {
        plan,
        active,
        nodes,
        cells,
        ..
    } = sim;
    let (mesh, active, cells) = (&plan.mesh, &*active, &*cells);
    let items = (0..nodes.len(), &mut nodes[..]);
    fold(items, BLOCK, &|(slots, nodes): (
        Range<usize>,
        &mut [Node],
    )| {
        for (slot, node) in slots.zip(nodes) {
            let (mut sum, mut weights) = (0.0, 0.0);
            for &(c, _) in active.attached(slot) {
                let c = c as usize;
                let volume = mesh.volumes[active.elements[c] as usize];
                let weight = weight(&cells.forces[c], &cells.sums[c], volume);
                sum += cells.strains[c].volumetric * weight;
                weights += weight;
            }
            node.volumetric = if weights > 0.0 { sum / weights } else { 0.0 };
        }
    });
}
