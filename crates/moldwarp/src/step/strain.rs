//! Stage 5: strain of each cell, its volumetric part smoothed (see `smoothing`).

use super::deformed::Deformed;
use super::shapes::load_nodes;
use super::{BLOCK, CellStrain, smoothing};
use crate::lanes::{self, LANES, Lane, for_each_simd, get, set, side_by_side, whole};
use crate::parallel::fold;
use crate::simulation::Simulation;
use crate::{Mat3, Vec3};
use std::ops::Range;

pub(super) fn run(sim: &mut Simulation) {
    gradients(sim);
    smoothing::strains(sim);
}

/// Σ u_i ⊗ ∇N_i.
#[inline(always)]
pub(super) fn gradient(g: &[Vec3; 3], u: [Vec3; 4]) -> Mat3 {
    let (a, b, c) = (u[1] - u[0], u[2] - u[0], u[3] - u[0]);
    Mat3::from_cols(
        a * g[0].x + b * g[1].x + c * g[2].x,
        a * g[0].y + b * g[1].y + c * g[2].y,
        a * g[0].z + b * g[1].z + c * g[2].z,
    )
}

/// ∇Δu (I + ½∇Δu)⁻¹.
#[inline(always)]
fn midpoint(gradient: &Mat3) -> Mat3 {
    let middle = Mat3::IDENTITY + *gradient * 0.5;
    let (x, y, z) = (middle.x_axis, middle.y_axis, middle.z_axis);
    let (a, b, c) = (y.cross(z), z.cross(x), x.cross(y));
    let over = 1.0 / z.dot(c);
    // Rows of the inverse are a, b and c over the determinant.
    let inverse = Mat3::from_cols(a * over, b * over, c * over).transpose();
    *gradient * inverse
}

/// Results side by side.
struct Strains {
    midpoint: [Lane; 9],
    volumetric: Lane,
    work: [Lane; 4],
}

for_each_simd! {
    fn deform(side: &mut Deformed, strains: &mut Strains, lanes: usize) {
        for l in 0..whole(lanes) {
            let gradient = side.gradient(l);
            let midpoint = midpoint(&gradient);
            let volumetric = midpoint.x_axis.x + midpoint.y_axis.y + midpoint.z_axis.z;
            set(&mut strains.midpoint, l, midpoint.to_cols_array());
            strains.volumetric[l] = volumetric;
            let work = side.half_work(l, &gradient);
            for k in 0..4 {
                strains.work[k][l] += work[k];
            }
        }
    }
}

fn gradients(sim: &mut Simulation) {
    let Simulation {
        plan,
        active,
        nodes,
        cells,
        ledger,
        simd,
        ..
    } = sim;
    let (mesh, active, nodes, simd) = (&plan.mesh, &*active, &nodes[..], *simd);
    let (sums, stresses, forces) = (&cells.sums[..], &cells.stresses[..], &cells.forces[..]);
    let items = (
        0..sums.len(),
        &mut cells.strains[..],
        &mut cells.weights[..],
    );
    let work = fold(items, BLOCK, &|(range, results, weights): (
        Range<usize>,
        &mut [CellStrain],
        &mut [[f64; 2]],
    )| {
        let first = range.start;
        let mut side = Deformed::default();
        let mut strains = Strains {
            midpoint: [[0.0; LANES]; 9],
            volumetric: [0.0; LANES],
            work: [[0.0; LANES]; 4],
        };
        for window in side_by_side(range) {
            for (l, c) in window.clone().enumerate() {
                let e = active.elements[c] as usize;
                side.shapes.load_gradients(l, mesh, e);
                load_nodes(&mut side.moved, l, active, c, nodes, |n| n.moved);
                side.load_stresses(l, &stresses[c], &forces[c]);
            }
            side.clear(window.len());
            deform(simd, &mut side, &mut strains, window.len());
            for (l, c) in window.enumerate() {
                let volumetric = strains.volumetric[l];
                results[c - first] = CellStrain {
                    midpoint: Mat3::from_cols_array(&get(&strains.midpoint, l)),
                    volumetric,
                };
                let volume = mesh.volumes[active.elements[c] as usize];
                let weight = smoothing::weight(&forces[c], &sums[c], stresses[c].closed, volume);
                weights[c - first] = [volumetric * weight, weight];
            }
        }
        strains.work.each_ref().map(lanes::sum)
    });
    ledger.grid_stress_work([work[0], work[1], work[2]]);
    ledger.stress_smoothing_work(work[3]);
}
