//! Stage 1: masses, momenta and internal forces from particles (Jassim et al. Eq. 5–7).

use super::correction::PAIRS;
use super::{BLOCK, CellForce, CellSums, Node, smoothing};
use crate::measure::Part;
use crate::mesh::NONE;
use crate::parallel::{ByCell, Sum, fold};
use crate::plan::Integration;
use crate::simulation::Simulation;
use crate::tensor::{self, Voigt, add_scaled};
use crate::{Mat3, Vec3};
use std::ops::Range;

/// All four nodes of a filled cell are fuller than this.
const FILLED: f64 = 0.6;

pub(super) fn run(sim: &mut Simulation, before: f64) {
    sum_cells(sim);
    sum_nodes(sim);
    sim.profile.lap(Part::ToNodes);
    cell_forces(sim, before);
    smoothing::stresses(sim, before);
    sim.profile.lap(Part::Forces);
}

/// Sums over the particles of each cell.
fn sum_cells(sim: &mut Simulation) {
    let Simulation {
        plan,
        particles,
        active,
        cells,
        elasticity,
        reference,
        ..
    } = sim;
    let (mesh, active, particles, elasticity) = (&plan.mesh, &*active, &*particles, &*elasticity);
    let reference = reference.as_ref();
    let items = (
        ByCell::new(&active.offsets, 0..particles.len()),
        &mut cells.sums[..],
    );
    fold(items, BLOCK, &|(block, sums): (
        ByCell<Range<usize>>,
        &mut [CellSums],
    )| {
        for (sum, c) in sums.iter_mut().zip(block.cells) {
            *sum = CellSums::default();
            let e = active.elements[c] as usize;
            let origin = mesh.nodes[mesh.tets[e][0] as usize];
            let gradients = &mesh.gradients[e];
            for p in active.offsets[c] as usize..active.offsets[c + 1] as usize {
                let n = crate::mesh::barycentric(origin, gradients, particles.position[p]);
                let (m, v) = (particles.mass[p], particles.velocity[p]);
                for i in 0..4 {
                    let share = n[i] * m;
                    sum.mass[i] += share;
                    sum.momentum[i] += v * share;
                }
                for (pair, &(i, j)) in sum.pairs.iter_mut().zip(&PAIRS) {
                    *pair += n[i] * n[j] * m;
                }
                let volume = particles.volume[p];
                sum.volume += volume;
                let body = particles.body[p] as usize;
                let model = &plan.materials[plan.bodies[body].material].model;
                let (stress, state) = (&particles.stress[p], &particles.state[p]);
                add_scaled(&mut sum.stress, stress, volume);
                sum.solid += volume * model.solid_share(state);
                if !model.is_separated(stress, state) {
                    sum.closed += volume;
                }
                let [lame, shear, wave] = elasticity[body];
                sum.moduli[0] += lame * volume;
                sum.moduli[1] += shear * volume;
                sum.wave_modulus = sum.wave_modulus.max(wave);
                if let Some(reference) = reference {
                    reference.add(sum, body, particles.position[p], volume);
                }
            }
        }
    });
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

/// Stress times volume of each cell, and the part of its work that belongs to the last drift.
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
        ..
    } = sim;
    let (mesh, active, nodes, sums) = (&plan.mesh, &*active, &nodes[..], &cells.sums[..]);
    let reference = reference.as_ref().map(|r| r.at(*gravity));
    let mixed = plan.numerics.integration == Integration::Mixed;
    // A viscous stress is C : ε̇ times this over the last step; there is none before the first.
    let per_step = if before > 0.0 {
        plan.numerics.viscosity / (2.0 * before)
    } else {
        0.0
    };
    debug_assert!(before == 0.0 || (2.0 * before - clock.dt).abs() <= 1e-12 * clock.dt);
    let items = (0..sums.len(), &mut cells.forces[..]);
    let work = fold(items, BLOCK, &|(range, forces): (
        Range<usize>,
        &mut [CellForce],
    )| {
        let mut work = [0.0; 3];
        for (c, force) in range.zip(forces) {
            let e = active.elements[c] as usize;
            let corners = active.cell_nodes[c].map(|n| &nodes[n as usize]);
            let sum = &sums[c];
            force.filled = mixed && is_filled(&active.cell_nodes[c], nodes);
            force.weighed = sum.mass;
            force.stress = if force.filled {
                let around = around(c, active, mesh, sums);
                let mean = match &reference {
                    Some(reference) => {
                        force.weighed = reference.weighed(mesh, e, sum.mass, &around);
                        reference.mean_stress(mesh, e, &around)
                    }
                    None => around.mean_stress(),
                };
                mean.map(|s| s * mesh.volumes[e])
            } else {
                sum.stress
            };
            force.smoothed = 0.0;
            force.viscous = [0.0; 6];
            if before == 0.0 {
                continue;
            }
            let gradient = super::strain::gradient(mesh, e, corners.map(|n| n.moved));
            if per_step > 0.0 {
                let fuller = if force.filled && sum.volume > 0.0 {
                    mesh.volumes[e] / sum.volume
                } else {
                    1.0
                };
                force.viscous = viscous(&gradient, sum.moduli.map(|m| m * per_step * fuller));
            }
            work = work.plus(force.half_work(&sum.stress, &gradient));
        }
        work
    });
    ledger.grid_stress_work(work);
}

/// Sums that make the mean of a cell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Around {
    /// Σ σ_p V_p, J.
    pub stress: Voigt,
    /// Σ V_p, m³.
    pub volume: f64,
    /// As [`CellSums::reference`].
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

    fn add(&mut self, sum: &CellSums) {
        add_scaled(&mut self.stress, &sum.stress, 1.0);
        self.volume += sum.volume;
        for (own, more) in self.reference.iter_mut().zip(sum.reference) {
            *own += more;
        }
    }
}

/// Sums over the particles of a cell; without any, over those of the cells across its faces, walls
/// excepted.
fn around(c: usize, active: &super::Active, mesh: &crate::Mesh, sums: &[CellSums]) -> Around {
    let mut around = Around::default();
    if sums[c].volume > 0.0 {
        around.stress = sums[c].stress;
        (around.volume, around.reference) = (sums[c].volume, sums[c].reference);
        return around;
    }
    for &neighbour in mesh.neighbours[active.elements[c] as usize]
        .iter()
        .filter(|&&n| n != NONE)
    {
        let other = active.cell(neighbour as usize, usize::from(active.fields[c]));
        if let Some(other) = other.filter(|&other| active.share_a_face(c, other)) {
            around.add(&sums[other]);
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
