//! Stage 3: velocities of particles, v_p += h Σ N_i a_i (Jassim et al. Eq. 8), and the momenta
//! of the updated particles for the remap.

use super::shapes::{
    Corners, NO_CORNERS, Shapes, all_corners, corner, interpolate, load_nodes, set_corner,
};
use super::{BLOCK, CellSums};
use crate::Vec3;
use crate::lanes::{LANES, Lane, Window, for_each_simd, get, set, sum, whole};
use crate::parallel::{ByCell, fold};
use crate::simulation::Simulation;

/// Cells and particles side by side.
struct Kick {
    shapes: Shapes,
    received: Corners,
    /// v_i + h a_i, for relaxation.
    grid: Corners,
    momentum: Corners,
    position: [Lane; 3],
    velocity: [Lane; 3],
    mass: Lane,
    /// Sums for the ledger: Σ m |a|², energy taken by relaxation, Σ ½ m v².
    energy: [Lane; 3],
}

impl Default for Kick {
    fn default() -> Kick {
        let vector = [[0.0; LANES]; 3];
        Kick {
            shapes: Shapes::default(),
            received: NO_CORNERS,
            grid: NO_CORNERS,
            momentum: NO_CORNERS,
            position: vector,
            velocity: vector,
            mass: [0.0; LANES],
            energy: vector,
        }
    }
}

pub(super) fn run(sim: &mut Simulation, before: f64, after: f64) {
    let h = before + after;
    let Simulation {
        plan,
        particles,
        active,
        nodes,
        cells,
        ledger,
        simd,
        ..
    } = sim;
    let (mesh, active, nodes, simd) = (&plan.mesh, &*active, &nodes[..], *simd);
    // Share of the mesh's velocity that particles take on in a kick.
    let blend = -libm::expm1(-plan.numerics.pic_rate * h);
    let (position, mass) = (&particles.position, &particles.mass);
    let block = ByCell::new(&active.offsets, &mut particles.velocity[..]);
    let sums = fold((block, &mut cells.sums[..]), BLOCK, &|(block, sums): (
        ByCell<&mut [Vec3]>,
        &mut [CellSums],
    )| {
        let (first, first_cell) = (block.first(), block.cells.start);
        let velocities = block.particles;
        sums.iter_mut().for_each(|s| s.momentum = [Vec3::ZERO; 4]);
        let mut kick = Kick::default();
        for window in Window::of(block.cells, &active.offsets) {
            for (l, &c) in window.cells().iter().enumerate() {
                let c = c as usize;
                kick.shapes.load(l, mesh, active.elements[c] as usize);
                load_nodes(&mut kick.received, l, active, c, nodes, |n| n.received);
                if blend > 0.0 {
                    let moved = |n: &super::Node| n.velocity + n.received * h;
                    load_nodes(&mut kick.grid, l, active, c, nodes, moved);
                }
            }
            kick.momentum = NO_CORNERS;
            window.slots(|slot| {
                for (l, &p) in slot.iter().enumerate() {
                    let p = p as usize;
                    set(&mut kick.position, l, position[p].to_array());
                    set(&mut kick.velocity, l, velocities[p - first].to_array());
                    kick.mass[l] = mass[p];
                }
                kick.mass[slot.len()..whole(slot.len())].fill(0.0);
                accelerate(simd, &mut kick, h, blend, slot.len());
                for (l, &p) in slot.iter().enumerate() {
                    velocities[p as usize - first] = Vec3::from_array(get(&kick.velocity, l));
                }
            });
            for (l, &c) in window.cells().iter().enumerate() {
                let momentum = &mut sums[c as usize - first_cell].momentum;
                for i in 0..4 {
                    momentum[i] += corner(&kick.momentum, l, i);
                }
            }
        }
        kick.energy.each_ref().map(sum)
    });
    ledger.end_kick(sums, before, after);
}

for_each_simd! {
    fn accelerate(kick: &mut Kick, h: f64, blend: f64, lanes: usize) {
        for l in 0..whole(lanes) {
            let n = kick.shapes.at(l, Vec3::from_array(get(&kick.position, l)));
            let a = interpolate(n, all_corners(&kick.received, l));
            let m = kick.mass[l];
            let mut v = Vec3::from_array(get(&kick.velocity, l));
            v += a * h;
            kick.energy[0][l] += m * a.length_squared();
            let own = v.length_squared();
            if blend > 0.0 {
                let grid = interpolate(n, all_corners(&kick.grid, l));
                v += (grid - v) * blend;
                kick.energy[1][l] += 0.5 * m * (own - v.length_squared());
            }
            kick.energy[2][l] += 0.5 * m * v.length_squared();
            set(&mut kick.velocity, l, v.to_array());
            for i in 0..4 {
                let sum = corner(&kick.momentum, l, i) + v * (n[i] * m);
                set_corner(&mut kick.momentum, l, i, sum);
            }
        }
    }
}
