//! Stage 1: masses, momenta and internal forces from particles (Jassim et al. Eq. 5–7).

use super::deformed::Deformed;
use super::shapes::{all_corners, load_nodes, set_corner};
use super::{Active, BLOCK, CellForce, CellStress, CellSums, Node, smoothing, sums};
use crate::lanes::{self, LANES, Lane, for_each_simd, get, side_by_side, whole};
use crate::measure::Part;
use crate::mesh::{Mesh, NONE};
use crate::parallel::fold;
use crate::plan::Integration;
use crate::simulation::Simulation;
use crate::tensor::{self, Voigt, add_scaled};
use crate::{Mat3, Vec3};
use std::ops::Range;

/// All four nodes of a filled cell are fuller than this.
const FILLED: f64 = 0.6;

pub(super) fn run(sim: &mut Simulation, before: f64) {
    sums::run(sim);
    sum_nodes(sim);
    sim.profile.lap(Part::ToNodes);
    cell_forces(sim, before);
    smoothing::stresses(sim, before);
    sim.profile.lap(Part::Forces);
}

/// Mass, velocity, filling and density of each node.
fn sum_nodes(sim: &mut Simulation) {
    let Simulation {
        plan,
        walls,
        contacts,
        active,
        nodes,
        cells,
        ..
    } = sim;
    let (active, sums, mesh) = (&*active, &cells.sums, &plan.mesh);
    let (walls, contacts) = (&*walls, &*contacts);
    let grid_nodes = walls.count(mesh) as u32;
    let items = (0..nodes.len(), &mut nodes[..]);
    fold(items, BLOCK, &|(slots, nodes): (
        Range<usize>,
        &mut [Node],
    )| {
        for (slot, node) in slots.zip(nodes) {
            let (mut mass, mut momentum, mut volume, mut all_mass) = (0.0, Vec3::ZERO, 0.0, 0.0);
            for &(c, local) in active.attached(slot) {
                let sum = &sums[c as usize];
                mass += sum.mass[local as usize];
                momentum += sum.momentum[local as usize];
                volume += sum.solid;
                all_mass += sum.mass[0] + sum.mass[1] + sum.mass[2] + sum.mass[3];
            }
            let grid = active.keys[slot] % grid_nodes;
            let mut whole = walls.volume(mesh, grid);
            if contacts.meets(slot) {
                // Elements that other fields fill do not make a field less full.
                let field = (active.keys[slot] / grid_nodes) as usize;
                let around = walls.elements(mesh, grid);
                let foreign = around.filter(|&e| active.is_foreign(e as usize, field));
                whole -= foreign.map(|e| mesh.volumes[e as usize]).sum::<f64>();
            }
            node.mass = mass;
            node.velocity = if mass > 0.0 {
                momentum / mass
            } else {
                Vec3::ZERO
            };
            node.filling = volume / whole;
            node.density = all_mass / whole;
            node.load = Vec3::ZERO;
        }
    });
}

/// Whether a cell with these corners counts as filled.
pub(super) fn is_filled(corners: &[u32; 4], nodes: &[Node]) -> bool {
    corners.iter().all(|&n| nodes[n as usize].filling > FILLED)
}

/// Stress times volume of each cell, the forces that it makes, and the part of its work that belongs to
/// the last drift.
fn cell_forces(sim: &mut Simulation, before: f64) {
    let Simulation {
        plan,
        active,
        nodes,
        cells,
        ledger,
        clock,
        reference,
        gravity,
        simd,
        ..
    } = sim;
    let (mesh, active, nodes, simd) = (&plan.mesh, &*active, &nodes[..], *simd);
    let (sums, stresses) = (&cells.sums[..], &cells.stresses[..]);
    let reference = reference.as_ref().map(|r| r.at(*gravity));
    let mixed = plan.numerics.integration == Integration::Mixed;
    // A viscous stress is C : ε̇ times this over the last step; there is none before the first.
    let per_step = if before > 0.0 {
        plan.numerics.viscosity / (2.0 * before)
    } else {
        0.0
    };
    debug_assert!(before == 0.0 || (2.0 * before - clock.dt).abs() <= 1e-12 * clock.dt);
    let items = (0..sums.len(), &mut cells.forces[..], &mut cells.nodal[..]);
    let work = fold(items, BLOCK, &|(range, forces, nodal): (
        Range<usize>,
        &mut [CellForce],
        &mut [[Vec3; 4]],
    )| {
        let first = range.start;
        let mut side = Deformed::default();
        let mut work: [Lane; 3] = [[0.0; LANES]; 3];
        for window in side_by_side(range) {
            for (l, c) in window.clone().enumerate() {
                let e = active.elements[c] as usize;
                let (sum, stress) = (&sums[c], &stresses[c]);
                let force = &mut forces[c - first];
                force.filled = mixed && is_filled(&active.cell_nodes[c], nodes);
                force.weighed = sum.mass;
                force.stress = if force.filled {
                    let around = around(c, active, mesh, sums, stresses);
                    let mean = match &reference {
                        Some(reference) => {
                            force.weighed = reference.weighed(mesh, e, sum.mass, &around);
                            reference.mean_stress(mesh, e, &around)
                        }
                        None => around.mean_stress(),
                    };
                    mean.map(|s| s * mesh.volumes[e])
                } else {
                    stress.stress
                };
                force.smoothed = 0.0;
                force.viscous = [0.0; 6];
                side.shapes.load_gradients(l, mesh, e);
                load_nodes(&mut side.moved, l, active, c, nodes, |n| n.moved);
                if per_step > 0.0 {
                    let fuller = if force.filled && sum.volume > 0.0 {
                        mesh.volumes[e] / sum.volume
                    } else {
                        1.0
                    };
                    let gradient = side.gradient(l);
                    force.viscous =
                        viscous(&gradient, stress.moduli.map(|m| m * per_step * fuller));
                }
                side.load_stresses(l, stress, force);
            }
            let lanes = window.len();
            side.clear(lanes);
            if before > 0.0 {
                half_work(simd, &mut side, &mut work, lanes);
            }
            push(simd, &mut side, lanes);
            for (l, c) in window.enumerate() {
                nodal[c - first] = all_corners(&side.force, l);
            }
        }
        work.each_ref().map(lanes::sum)
    });
    ledger.grid_stress_work(work);
}

/// f_i = −S ∇N_i.
pub(super) fn nodal(force: &CellForce, mesh: &Mesh, e: usize) -> [Vec3; 4] {
    let stress = std::array::from_fn(|k| force.stress[k] + force.viscous[k]);
    mesh.all_gradients(e).map(|g| -tensor::times(&stress, g))
}

for_each_simd! {
    fn half_work(side: &mut Deformed, work: &mut [Lane; 3], lanes: usize) {
        for l in 0..whole(lanes) {
            let own = side.half_work(l, &side.gradient(l));
            for k in 0..3 {
                work[k][l] += own[k];
            }
        }
    }
}

for_each_simd! {
    /// [`nodal`].
    fn push(side: &mut Deformed, lanes: usize) {
        for l in 0..whole(lanes) {
            let (cell, viscous) = (get(&side.cell, l), get(&side.viscous, l));
            let stress: Voigt = std::array::from_fn(|k| cell[k] + viscous[k]);
            let [b, c, d] = side.shapes.gradients(l);
            for (i, g) in [-(b + c + d), b, c, d].into_iter().enumerate() {
                set_corner(&mut side.force, l, i, -tensor::times(&stress, g));
            }
        }
    }
}

/// Sums that make the mean of a cell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Around {
    /// Σ σ_p V_p, J.
    pub stress: Voigt,
    /// Σ V_p, m³.
    pub volume: f64,
    /// As [`CellStress::reference`].
    pub reference: [f64; 3],
}

impl Around {
    /// σ̄ = Σ σ_p V_p / Σ V_p, Pa.
    pub fn mean_stress(&self) -> Voigt {
        if self.volume > 0.0 {
            self.stress.map(|s| s / self.volume)
        } else {
            self.stress
        }
    }

    fn add(&mut self, sum: &CellSums, stress: &CellStress) {
        add_scaled(&mut self.stress, &stress.stress, 1.0);
        self.volume += sum.volume;
        for (own, more) in self.reference.iter_mut().zip(stress.reference) {
            *own += more;
        }
    }
}

/// Sums over the particles of a cell; without any, over those of the cells across its faces, walls
/// excepted.
fn around(
    c: usize,
    active: &Active,
    mesh: &Mesh,
    sums: &[CellSums],
    stresses: &[CellStress],
) -> Around {
    let mut around = Around::default();
    if sums[c].volume > 0.0 {
        around.stress = stresses[c].stress;
        (around.volume, around.reference) = (sums[c].volume, stresses[c].reference);
        return around;
    }
    for &neighbour in mesh.neighbours[active.elements[c] as usize]
        .iter()
        .filter(|&&n| n != NONE)
    {
        let other = active.cell(neighbour as usize, usize::from(active.fields[c]));
        if let Some(other) = other.filter(|&other| active.share_a_face(c, other)) {
            around.add(&sums[other], &stresses[other]);
        }
    }
    around
}

/// Moduli (λ, G) times strain.
fn viscous(gradient: &Mat3, [lame, shear]: [f64; 2]) -> Voigt {
    let strain = tensor::strain(gradient);
    let pressure = lame * tensor::trace(&strain);
    std::array::from_fn(|k| {
        if k < 3 {
            pressure + 2.0 * shear * strain[k]
        } else {
            shear * strain[k]
        }
    })
}
