//! Stage 1: masses, momenta and internal forces from particles (Jassim et al. Eq. 5–7).

use super::correction::PAIRS;
use super::shapes::{Corners, NO_CORNERS, Shapes, all_corners, corner, load_nodes, set_corner};
use super::{Active, BLOCK, CellForce, CellPairs, CellStress, CellSums, Node, smoothing, strain};
use crate::lanes::{
    self, LANES, Lane, VoigtLanes, Window, for_each_simd, get, set, side_by_side, whole,
};
use crate::measure::Part;
use crate::mesh::{Mesh, NONE};
use crate::parallel::{ByCell, fold};
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

/// Cells and particles side by side.
struct Side {
    shapes: Shapes,
    mass: [Lane; 4],
    momentum: Corners,
    pairs: [Lane; 6],
    stress: VoigtLanes,
    /// Σ V_p, without what has opened, and of particles that are not separated.
    volumes: [Lane; 3],
    /// Of particles: position, velocity, mass, volume; stress; shares of the volume in the second and
    /// third sum of volumes.
    x: [Lane; 3],
    v: [Lane; 3],
    m: Lane,
    volume: Lane,
    sigma: VoigtLanes,
    shares: [Lane; 2],
}

impl Default for Side {
    fn default() -> Side {
        let vector = [[0.0; LANES]; 3];
        Side {
            shapes: Shapes::default(),
            mass: [[0.0; LANES]; 4],
            momentum: NO_CORNERS,
            pairs: [[0.0; LANES]; 6],
            stress: [[0.0; LANES]; 6],
            volumes: vector,
            x: vector,
            v: vector,
            m: [0.0; LANES],
            volume: [0.0; LANES],
            sigma: [[0.0; LANES]; 6],
            shares: [[1.0; LANES]; 2],
        }
    }
}

for_each_simd! {
    /// Adds a particle to each cell.
    fn add(side: &mut Side, lanes: usize) {
        for l in 0..whole(lanes) {
            let n = side.shapes.at(l, Vec3::from_array(get(&side.x, l)));
            let (m, v) = (side.m[l], Vec3::from_array(get(&side.v, l)));
            for i in 0..4 {
                let share = n[i] * m;
                side.mass[i][l] += share;
                let momentum = corner(&side.momentum, l, i) + v * share;
                set_corner(&mut side.momentum, l, i, momentum);
            }
            for k in 0..6 {
                let (i, j) = PAIRS[k];
                side.pairs[k][l] += n[i] * n[j] * m;
            }
            let volume = side.volume[l];
            for k in 0..6 {
                side.stress[k][l] += side.sigma[k][l] * volume;
            }
            side.volumes[0][l] += volume;
            side.volumes[1][l] += volume * side.shares[0][l];
            side.volumes[2][l] += volume * side.shares[1][l];
        }
    }
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
        simd,
        ..
    } = sim;
    let (mesh, active, particles, elasticity) = (&plan.mesh, &*active, &*particles, &*elasticity);
    let (reference, simd) = (reference.as_ref(), *simd);
    let viscous = plan.numerics.viscosity > 0.0;
    let sums = (
        &mut cells.sums[..],
        &mut cells.pairs[..],
        &mut cells.stresses[..],
    );
    let items = (ByCell::new(&active.offsets, 0..particles.len()), sums);
    type Sums<'a> = (
        &'a mut [CellSums],
        &'a mut [CellPairs],
        &'a mut [CellStress],
    );
    fold(items, BLOCK, &|(block, (sums, pairs, stresses)): (
        ByCell<Range<usize>>,
        Sums,
    )| {
        let cells = block.cells.clone();
        let first = cells.start;
        sums.fill(CellSums::default());
        pairs.fill(CellPairs::default());
        stresses.fill(CellStress::default());
        let mut side = Side::default();
        for window in Window::of(block.cells, &active.offsets) {
            let lanes = window.cells().len();
            for (l, &c) in window.cells().iter().enumerate() {
                side.shapes
                    .load(l, mesh, active.elements[c as usize] as usize);
            }
            side.begin(lanes);
            window.slots(|slot| {
                for (l, &p) in slot.iter().enumerate() {
                    let p = p as usize;
                    let (stress, state) = (&particles.stress[p], &particles.state[p]);
                    set(&mut side.x, l, particles.position[p].to_array());
                    set(&mut side.v, l, particles.velocity[p].to_array());
                    set(&mut side.sigma, l, *stress);
                    side.m[l] = particles.mass[p];
                    side.volume[l] = particles.volume[p];
                    let body = particles.body[p] as usize;
                    let model = &plan.materials[plan.bodies[body].material].model;
                    let closed = !model.is_separated(stress, state);
                    side.shares[0][l] = model.solid_share(state);
                    side.shares[1][l] = f64::from(u8::from(closed));
                }
                let rest = slot.len()..whole(slot.len());
                side.m[rest.clone()].fill(0.0);
                side.volume[rest].fill(0.0);
                add(simd, &mut side, slot.len());
            });
            for (l, &c) in window.cells().iter().enumerate() {
                let own = c as usize - first;
                let (sum, stress) = (&mut sums[own], &mut stresses[own]);
                let momentum = all_corners(&side.momentum, l);
                for i in 0..4 {
                    sum.mass[i] += side.mass[i][l];
                    sum.momentum[i] += momentum[i];
                }
                sum.volume += side.volumes[0][l];
                sum.solid += side.volumes[1][l];
                stress.closed += side.volumes[2][l];
                for k in 0..6 {
                    pairs[own][k] += side.pairs[k][l];
                    stress.stress[k] += side.stress[k][l];
                }
            }
        }
        for (stress, c) in stresses.iter_mut().zip(cells) {
            let inside = active.offsets[c] as usize..active.offsets[c + 1] as usize;
            for p in inside {
                let body = particles.body[p] as usize;
                let [lame, shear, wave] = elasticity[body];
                stress.wave_modulus = stress.wave_modulus.max(wave);
                if viscous {
                    stress.moduli[0] += lame * particles.volume[p];
                    stress.moduli[1] += shear * particles.volume[p];
                }
                if let Some(reference) = reference {
                    let (x, volume) = (particles.position[p], particles.volume[p]);
                    reference.add(stress, body, x, volume);
                }
            }
        }
    });
}

impl Side {
    /// Sums of nothing.
    fn begin(&mut self, lanes: usize) {
        let lanes = whole(lanes);
        let sums = (self.mass.iter_mut())
            .chain(&mut self.momentum)
            .chain(&mut self.pairs)
            .chain(&mut self.stress)
            .chain(&mut self.volumes);
        sums.for_each(|sum| sum[..lanes].fill(0.0));
    }
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

/// Cells side by side with their deformation in a step and what works on it.
pub(super) struct Deformed {
    pub shapes: Shapes,
    pub moved: Corners,
    /// Stress times volume of particles and of the cell, and the viscous part, J.
    particles: VoigtLanes,
    cell: VoigtLanes,
    viscous: VoigtLanes,
    /// Part of `cell` that is left out of the work.
    smoothed: Lane,
    force: Corners,
}

impl Default for Deformed {
    fn default() -> Deformed {
        let zero = [[0.0; LANES]; 6];
        Deformed {
            shapes: Shapes::default(),
            moved: NO_CORNERS,
            particles: zero,
            cell: zero,
            viscous: zero,
            smoothed: [0.0; LANES],
            force: NO_CORNERS,
        }
    }
}

impl Deformed {
    #[inline(always)]
    pub fn load_stresses(&mut self, l: usize, stress: &CellStress, force: &CellForce) {
        set(&mut self.particles, l, stress.stress);
        set(&mut self.cell, l, force.stress);
        set(&mut self.viscous, l, force.viscous);
        self.smoothed[l] = force.smoothed;
    }

    /// No stresses in the lanes beyond these.
    pub fn clear(&mut self, lanes: usize) {
        let rest = lanes..whole(lanes);
        let arrays = (self.particles.iter_mut())
            .chain(&mut self.cell)
            .chain(&mut self.viscous);
        arrays.for_each(|a| a[rest.clone()].fill(0.0));
        self.smoothed[rest].fill(0.0);
    }

    /// ∇Δu.
    #[inline(always)]
    pub fn gradient(&self, l: usize) -> Mat3 {
        strain::gradient(&self.shapes.gradients(l), all_corners(&self.moved, l))
    }

    /// Half the work of the stresses on the deformation: as [`CellForce::half_work`], and of smoothing.
    #[inline(always)]
    pub fn half_work(&self, l: usize, gradient: &Mat3) -> [f64; 4] {
        let strain = tensor::strain(gradient);
        let own = 0.5 * tensor::dot(&get(&self.particles, l), &strain);
        let smoothed = 0.5 * self.smoothed[l] * tensor::trace(&strain);
        let all = 0.5 * tensor::dot(&get(&self.cell, l), &strain) - smoothed;
        let viscous = 0.5 * tensor::dot(&get(&self.viscous, l), &strain);
        [own, all - own, viscous, smoothed]
    }
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
