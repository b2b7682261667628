//! Stage 5: strain of each cell, its volumetric part smoothed (see `smoothing`).

use super::collect::Shares;
use super::corners::{Corners, NO_CORNERS, Quad, TileNodes, all_corners, load_nodes};
use super::shapes::Shapes;
use super::state::are_void;
use super::{CellFill, CellForce, CellSums, Cells, Shared, TILES, smoothing};
use crate::lanes::{
    self, LANES, Lane, RECORDS_AHEAD, Simd, VoigtLanes, either, for_each_simd, get,
    prefetch_record, set,
};
use crate::parallel::fold;
use crate::plan::Smoothing;
use crate::simulation::Simulation;
use crate::tensor::{self, Voigt, half_spin, spin_rotation};
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

/// ∇Δu (I + ½∇Δu)⁻¹, the gradient in the configuration in the middle of the step, as a matrix A and what it is to be
/// divided by, d: a rigid rotation has none of it but spin, and its trace is the logarithmic volume strain to third order.
///
/// As adj(I + ½G) = (1 + ½I₁) I − ½G + ¼ adj G, and adj G = G² − I₁G + I₂I, with the invariants of G = ∇Δu
///
///   A = G − ½ adj G + (½I₂ + ¼I₃) I,   d = det(I + ½G) = 1 + ½I₁ + ¼I₂ + ⅛I₃,   tr A = I₁ + I₂ + ¾I₃.
#[inline(always)]
pub(super) fn midpoint(gradient: &Mat3) -> (Mat3, f64) {
    let (x, y, z) = (gradient.x_axis, gradient.y_axis, gradient.z_axis);
    // Rows of the adjugate.
    let (a, b, c) = (y.cross(z), z.cross(x), x.cross(y));
    let first = x.x + y.y + z.z;
    let (second, third) = (a.x + b.y + c.z, x.dot(a));
    let own = 0.5 * second + 0.25 * third;
    let middle = Mat3::from_cols(
        x + Vec3::new(own - 0.5 * a.x, -0.5 * b.x, -0.5 * c.x),
        y + Vec3::new(-0.5 * a.y, own - 0.5 * b.y, -0.5 * c.y),
        z + Vec3::new(-0.5 * a.z, -0.5 * b.z, own - 0.5 * c.z),
    );
    let determinant = 1.0 + 0.5 * first + 0.25 * second + 0.125 * third;
    (middle, determinant)
}

/// Deformation of cells side by side in a step.
pub(super) struct Deformation {
    /// ∇Δu = Σ Δu_i ⊗ ∇N_i in the configuration at the start of the step, by columns.
    pub gradient: [Lane; 9],
    /// Δu of node 0, m.
    pub origin: [Lane; 3],
    /// Trace of the gradient in the middle of the step ([`midpoint`]).
    pub volumetric: Lane,
    /// The part of it that smoothing takes away.
    pub left_out: Lane,
    /// Strain in the middle of the step with the smoothed trace.
    pub strain: VoigtLanes,
    /// Rotation of the step, by columns.
    pub turn: [Lane; 9],
    /// Volume after a step over that before, of what has the smoothed strain.
    pub growth: Lane,
}

impl Default for Deformation {
    fn default() -> Deformation {
        Deformation {
            gradient: [Lane::of(0.0); 9],
            origin: [Lane::of(0.0); 3],
            volumetric: Lane::of(0.0),
            left_out: Lane::of(0.0),
            strain: [Lane::of(0.0); 6],
            turn: [Lane::of(0.0); 9],
            growth: Lane::of(1.0),
        }
    }
}

impl Deformation {
    /// Goes to the next cells.
    pub fn enter(
        &mut self,
        simd: Simd,
        shapes: &Shapes,
        nodes: TileNodes,
        shared: &Shared,
        smoothing: Smoothing,
    ) {
        let smooth = smoothing != Smoothing::Off;
        deform(simd, nodes, &shared.moved, shapes, smooth, self);
    }
}

for_each_simd! {
    fn deform(
        nodes: TileNodes,
        moved: &[Quad],
        shapes: &Shapes,
        smooth: bool,
        d: &mut Deformation,
    ) {
        let (moved, averaged) = S::corners(nodes, moved);
        for l in 0..LANES {
            let corners = all_corners(&moved, l);
            let gradient = gradient(&shapes.gradients(l), corners);
            let (middle, determinant) = midpoint(&gradient);
            let trace = middle.x_axis.x + middle.y_axis.y + middle.z_axis.z;
            // Growth is what is `after` over what is `before`.
            let half = 0.125 * averaged[l];
            let after = either(smooth, 1.0 + half, determinant + 0.5 * trace);
            let before = either(smooth, 1.0 - half, determinant - 0.5 * trace);
            let spin = half_spin(&middle);
            let square = determinant * determinant + spin.length_squared();
            // One quotient in place of three, which wait for each other.
            let over_all = 1.0 / (determinant * before * square);
            let over = over_all * (before * square);
            let midpoint = middle * over;
            // Up to round-off that of `volumetric`.
            let volumetric = trace * over;
            let smoothed = either(smooth, 0.25 * averaged[l], volumetric);
            let mut strain = tensor::strain(&midpoint);
            let change = (smoothed - volumetric) * (1.0 / 3.0);
            (0..3).for_each(|k| strain[k] += change);
            let turn = spin_rotation(spin, determinant, 2.0 * over_all * (determinant * before));
            set(&mut d.gradient, l, gradient.to_cols_array());
            set(&mut d.origin, l, corners[0].to_array());
            (d.volumetric[l], d.left_out[l]) = (volumetric, volumetric - smoothed);
            d.growth[l] = after * over_all * (determinant * square);
            set(&mut d.strain, l, strain);
            set(&mut d.turn, l, turn.to_cols_array());
        }
    }
}

impl Deformation {
    /// Strain of a particle, the part of its trace that smoothing has taken away, and its volume after the step over that
    /// before. What is separated keeps its cell's own trace.
    #[inline(always)]
    pub fn of_particle(&self, l: usize, separated: bool) -> (Voigt, f64, f64) {
        let mut strain = get(&self.strain, l);
        let given_back = either(separated, self.left_out[l] * (1.0 / 3.0), 0.0);
        (0..3).for_each(|k| strain[k] += given_back);
        let own = growth(self.volumetric[l]);
        (
            strain,
            either(separated, 0.0, self.left_out[l]),
            either(separated, own, self.growth[l]),
        )
    }
}

/// Of a tetrahedron with these edges from node 0 on, and of what these grow by, the trace of what [`midpoint`] finds, as what
/// is to be divided by the second number; and its volume times six. With the invariants of ∇Δu, (I₁ + I₂ + ¾ I₃) /
/// (1 + ½ I₁ + ¼ I₂ + ⅛ I₃).
#[inline(always)]
fn volumetric([a, b, c]: [Vec3; 3], [p, q, r]: [Vec3; 3]) -> (f64, f64, f64) {
    // Products of three, so that no gradients are needed: all are times six volumes.
    let (bc, qr) = (b.cross(c), q.cross(r));
    let first = p.dot(bc) + q.dot(c.cross(a)) + r.dot(a.cross(b));
    let second = a.dot(qr) + b.dot(r.cross(p)) + c.dot(p.cross(q));
    let (whole, third) = (a.dot(bc), p.dot(qr));
    (
        first + second + 0.75 * third,
        whole + 0.5 * first + 0.25 * second + 0.125 * third,
        whole,
    )
}

/// Volume after a strain over that before, exact for a homogeneous compression.
#[inline(always)]
fn growth(volumetric: f64) -> f64 {
    (1.0 + 0.5 * volumetric) / (1.0 - 0.5 * volumetric)
}

for_each_simd! {
    /// Half the work of the particles' stresses on the deformation of their cells, J.
    pub(super) fn own_work(deformation: &Deformation, sum: &CellSums, work: &mut Lane) {
        for l in 0..LANES {
            let strain = tensor::strain(&Mat3::from_cols_array(&get(&deformation.gradient, l)));
            work[l] += 0.5 * tensor::dot(&get(&sum.stress, l), &strain);
        }
    }
}

for_each_simd! {
    /// The same, from what nodes have moved by.
    pub(super) fn half_work(shapes: &Shapes, moved: &Corners, sum: &CellSums, work: &mut Lane) {
        for l in 0..LANES {
            let gradient = gradient(&shapes.gradients(l), all_corners(moved, l));
            let strain = tensor::strain(&gradient);
            work[l] += 0.5 * tensor::dot(&get(&sum.stress, l), &strain);
        }
    }
}

/// Books the half of the work that the pass over particles ([`own_work`]) does not find any more when cells are numbered anew
/// before.
pub(super) fn begin_work(sim: &mut Simulation) {
    let Simulation {
        active,
        shared,
        cells,
        ledger,
        simd,
        ..
    } = sim;
    let (active, shared, simd) = (&*active, &*shared, *simd);
    let sums = &cells.sums[..active.own_tiles()];
    let work = fold(0..sums.len(), TILES, &|tiles: Range<usize>| {
        let (mut moved, mut shapes, mut work) = (NO_CORNERS, Shapes::default(), Lane::of(0.0));
        for tile in tiles {
            let nodes = active.tile_nodes(tile);
            shapes.enter(simd, nodes, &shared.places);
            load_nodes(simd, &mut moved, nodes, &shared.moved);
            half_work(simd, &shapes, &moved, &sums[tile], &mut work);
        }
        lanes::sum(&work)
    });
    ledger.grid_stress_work(work);
}

/// Records of a tile that tell how much its cells weigh in the means of their nodes.
struct Weighed<'a> {
    sum: &'a CellSums,
    fill: &'a CellFill,
}

for_each_simd! {
    /// θ_e w_e and w_e.
    fn weigh(
        tile: &Weighed,
        nodes: TileNodes,
        places: &[Quad],
        moved: &[Quad],
        weights: &mut [Lane; 2],
    ) {
        let Weighed { sum, fill } = tile;
        let ((places, _), (moved, _)) = (S::corners(nodes, places), S::corners(nodes, moved));
        for l in 0..LANES {
            let edges = |corners| {
                let [first, a, b, c] = all_corners(corners, l);
                [a - first, b - first, c - first]
            };
            let (strain, of, whole) = volumetric(edges(&places), edges(&moved));
            let (volume, closed) = (sum.volume[l], sum.closed[l]);
            let weight = smoothing::whole_weight(fill.filled[l], volume, whole * (1.0 / 6.0));
            // One quotient in place of two.
            let some = either(volume > 0.0, volume, 1.0);
            let over = 1.0 / (of * some);
            let share = either(closed < volume, closed * (of * over), 1.0);
            let weight = weight * share;
            set(weights, l, [strain * (some * over) * weight, weight]);
        }
    }
}

for_each_simd! {
    /// Half the work of viscous stresses, and of what smoothing has added, J.
    fn more_work(shapes: &Shapes, moved: &Corners, force: &CellForce, works: &mut [Lane; 2]) {
        for l in 0..LANES {
            let gradient = gradient(&shapes.gradients(l), all_corners(moved, l));
            let strain = tensor::strain(&gradient);
            works[0][l] += 0.5 * tensor::dot(&get(&force.viscous, l), &strain);
            works[1][l] += 0.5 * force.smoothed[l] * tensor::trace(&strain);
        }
    }
}

/// What nodes need for their means of the volumetric strain.
fn gradients(sim: &mut Simulation) {
    let Simulation {
        active,
        shared,
        cells,
        ledger,
        simd,
        ..
    } = sim;
    let (active, shared, simd) = (&*active, &*shared, *simd);
    let Cells {
        sums,
        fills,
        forces,
        portions,
        ..
    } = cells;
    let sums = &sums[..];
    let (fills, forces) = (&fills[..], &forces[..]);
    let cut = portions.cut();
    let items = (0..sums.len(), portions.shares());
    let work = cut.fold_own(items, &|(tiles, shares): (
        Range<usize>,
        Shares<Quad, 1>,
    )| {
        let (mut moved, mut shapes) = (NO_CORNERS, Shapes::default());
        let mut share = shares.begin();
        let (mut weights, mut works) = ([Lane::of(0.0); 2], [Lane::of(0.0); 2]);
        for tile in tiles {
            let nodes = active.tile_nodes(tile);
            prefetch_record(sums, tile + RECORDS_AHEAD);
            let (sum, fill) = (&sums[tile], &fills[tile]);
            if are_void(sum, fill) {
                continue;
            }
            let weighed = Weighed { sum, fill };
            weigh(
                simd,
                &weighed,
                nodes,
                &shared.places,
                &shared.moved,
                &mut weights,
            );
            if let Some(force) = forces.get(tile) {
                shapes.enter(simd, nodes, &shared.places);
                load_nodes(simd, &mut moved, nodes, &shared.moved);
                more_work(simd, &shapes, &moved, force, &mut works);
            }
            share.give_alike(simd, nodes, weights.each_ref());
        }
        works.each_ref().map(lanes::sum)
    });
    ledger.viscous_work(work[0]);
    ledger.stress_smoothing_work(work[1]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::tetrahedron_gradients;
    use crate::random::Random;

    #[test]
    fn the_gradient_in_the_middle_is_what_its_definition_says() {
        let mut random = Random::new(5);
        for n in 0..200 {
            let size = if n % 2 == 0 { 0.3 } else { 1e-6 };
            let mut vector =
                |a: f64| Vec3::from_array(std::array::from_fn(|_| random.within(-a, a)));
            let corners = [
                vector(0.1),
                vector(0.1) + Vec3::X,
                vector(0.1) + Vec3::Y,
                vector(0.1) + Vec3::Z,
            ];
            let moved: [Vec3; 4] = std::array::from_fn(|_| vector(size));
            let (gradients, volume) = tetrahedron_gradients(corners);
            let gradient = gradient(&gradients, moved);
            let (middle, determinant) = midpoint(&gradient);
            let half = Mat3::IDENTITY + gradient * 0.5;
            assert!((determinant / half.determinant() - 1.0).abs() < 1e-14);
            let defined = gradient * half.inverse();
            assert!((middle * (1.0 / determinant)).abs_diff_eq(defined, 1e-14 * size));
            let edges = |x: [Vec3; 4]| [x[1] - x[0], x[2] - x[0], x[3] - x[0]];
            let (trace, of, whole) = volumetric(edges(corners), edges(moved));
            let defined = defined.x_axis.x + defined.y_axis.y + defined.z_axis.z;
            assert!((trace / of - defined).abs() < 1e-14 * size);
            assert!((whole / volume - 6.0).abs() < 1e-13);
        }
    }
}
