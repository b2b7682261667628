//! Sums over the particles of each cell, the first part of stage 1.

use super::correction::PAIRS;
use super::shapes::{Corners, NO_CORNERS, Shapes, all_corners, corner, set_corner};
use super::{BLOCK, CellPairs, CellStress, CellSums};
use crate::Vec3;
use crate::lanes::{LANES, Lane, VoigtLanes, Window, for_each_simd, get, set, whole};
use crate::parallel::{ByCell, fold};
use crate::simulation::Simulation;
use std::ops::Range;

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

/// Sums of all cells.
pub(super) fn run(sim: &mut Simulation) {
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
