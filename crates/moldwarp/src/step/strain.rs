//! Stage 5: strain of each cell, its volumetric part smoothed (see `smoothing`).

use super::collect::Shares;
use super::corners::{Corners, NO_CORNERS, all_corners, load_nodes};
use super::shapes::Shapes;
use super::{CellForce, CellStrain, CellStress, CellSums, Cells, smoothing};
use crate::lanes::{self, LANES, Lane, for_each_simd, get, set};
use crate::plan::Smoothing;
use crate::simulation::Simulation;
use crate::{Mat3, Vec3, tensor};
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

/// ∇Δu (I + ½∇Δu)⁻¹, the gradient in the configuration in the middle of the step: a rigid rotation has none of it but
/// spin, and its trace is the logarithmic volume strain to third order.
#[inline(always)]
pub(super) fn midpoint(gradient: &Mat3) -> Mat3 {
    let middle = Mat3::IDENTITY + *gradient * 0.5;
    let (x, y, z) = (middle.x_axis, middle.y_axis, middle.z_axis);
    let (a, b, c) = (y.cross(z), z.cross(x), x.cross(y));
    let over = 1.0 / z.dot(c);
    // Rows of the inverse are a, b and c over the determinant.
    let inverse = Mat3::from_cols(a * over, b * over, c * over).transpose();
    *gradient * inverse
}

for_each_simd! {
    /// Half the work of the particles' stresses on the deformation of their cells, J.
    pub(super) fn own_work(strains: &CellStrain, stress: &CellStress, work: &mut Lane) {
        for l in 0..LANES {
            let strain = tensor::strain(&Mat3::from_cols_array(&get(&strains.gradient, l)));
            work[l] += 0.5 * tensor::dot(&get(&stress.stress, l), &strain);
        }
    }
}

for_each_simd! {
    /// The same of viscous stresses, and of what smoothing has added.
    fn more_work(strains: &CellStrain, force: &CellForce, works: &mut [Lane; 2]) {
        for l in 0..LANES {
            let strain = tensor::strain(&Mat3::from_cols_array(&get(&strains.gradient, l)));
            works[0][l] += 0.5 * tensor::dot(&get(&force.viscous, l), &strain);
            works[1][l] += 0.5 * force.smoothed[l] * tensor::trace(&strain);
        }
    }
}

/// Records of a tile that the deformation works on.
struct Worked<'a> {
    shapes: &'a Shapes,
    sum: &'a CellSums,
    stress: &'a CellStress,
    force: &'a CellForce,
}

for_each_simd! {
    fn deform(
        tile: &Worked,
        moved: &Corners,
        strains: &mut CellStrain,
        weights: &mut [Lane; 2],
    ) {
        let Worked { shapes, sum, stress, force } = tile;
        for l in 0..LANES {
            let corners = all_corners(moved, l);
            let gradient = gradient(&shapes.gradients(l), corners);
            let midpoint = midpoint(&gradient);
            let volumetric = midpoint.x_axis.x + midpoint.y_axis.y + midpoint.z_axis.z;
            set(&mut strains.gradient, l, gradient.to_cols_array());
            set(&mut strains.origin, l, corners[0].to_array());
            strains.volumetric[l] = volumetric;
            let (volume, whole) = (sum.volume[l], shapes.volume[l]);
            let weight = smoothing::weight(force.filled[l], volume, stress.closed[l], whole);
            set(weights, l, [volumetric * weight, weight]);
        }
    }
}

fn gradients(sim: &mut Simulation) {
    let Simulation {
        plan,
        active,
        shared,
        cells,
        ledger,
        simd,
        ..
    } = sim;
    let numerics = &plan.numerics;
    let more = numerics.viscosity > 0.0 || numerics.smoothing == Smoothing::Conjugate;
    let (active, shared, simd) = (&*active, &*shared, *simd);
    let Cells {
        shapes,
        sums,
        stresses,
        forces,
        strains,
        portions,
        ..
    } = cells;
    let (shapes, sums) = (&shapes[..], &sums[..]);
    let (stresses, forces) = (&stresses[..], &forces[..]);
    let cut = portions.cut();
    let items = (0..sums.len(), &mut strains[..], portions.shares());
    let work = cut.fold(items, &|(tiles, strains, shares): (
        Range<usize>,
        &mut [CellStrain],
        Shares<1>,
    )| {
        let (mut moved, mut share) = (NO_CORNERS, shares.begin());
        let (mut weights, mut works) = ([Lane::of(0.0); 2], [Lane::of(0.0); 2]);
        for (tile, strains) in tiles.zip(strains) {
            let nodes = active.tile_nodes(tile);
            load_nodes(simd, &mut moved, nodes, &shared.moved);
            let tile = Worked {
                shapes: &shapes[tile],
                sum: &sums[tile],
                stress: &stresses[tile],
                force: &forces[tile],
            };
            deform(simd, &tile, &moved, strains, &mut weights);
            if more {
                more_work(simd, strains, tile.force, &mut works);
            }
            share.give_alike(simd, nodes, weights.each_ref());
        }
        works.each_ref().map(lanes::sum)
    });
    ledger.viscous_work(work[0]);
    ledger.stress_smoothing_work(work[1]);
}
