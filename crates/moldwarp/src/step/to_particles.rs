//! Stage 3: velocities of particles, v_p += h Σ N_i a_i (Jassim et al. Eq. 8), and the momenta
//! of the updated particles for the remap.

use super::shapes::{
    Corners, NO_CORNERS, Shapes, all_corners, corner, interpolate, load_nodes, set_corner,
};
use super::{CellSums, TILES};
use crate::Vec3;
use crate::lanes::{
    ByTile, LANES, Lane, for_each_simd, get, load, load_one, set, store, sum as sum_lanes, whole,
};
use crate::parallel::fold;
use crate::simulation::Simulation;

/// Cells and particles side by side.
struct Kick {
    received: Corners,
    /// v_i + h a_i, for relaxation.
    grid: Corners,
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
            received: NO_CORNERS,
            grid: NO_CORNERS,
            position: vector,
            velocity: vector,
            mass: [0.0; LANES],
            energy: vector,
        }
    }
}

/// Returns the energy of motion of the particles, J.
pub(super) fn run(sim: &mut Simulation, before: f64, after: f64) -> f64 {
    let h = before + after;
    let Simulation {
        plan,
        particles,
        active,
        nodes,
        shared,
        cells,
        ledger,
        simd,
        ..
    } = sim;
    // Share of the mesh's velocity that particles take on in a kick.
    let blend = -libm::expm1(-plan.numerics.pic_rate * h);
    if blend > 0.0 {
        for (grid, node) in shared.grid.iter_mut().zip(&*nodes) {
            *grid = node.velocity + node.received * h;
        }
    }
    let (active, shared, simd) = (&*active, &*shared, *simd);
    let (position, mass) = (particles.position.components(), &particles.mass[..]);
    type Velocities<'a> = [&'a mut [f64]; 3];
    let velocities = particles.velocity.components_mut();
    let records = (&mut cells.sums[..], &cells.shapes[..]);
    let all = ByTile::new(&active.tiles, velocities, records);
    type Records<'a> = (&'a mut [CellSums], &'a [Shapes]);
    let sums = fold(all, TILES, &|block: ByTile<Velocities, Records>| {
        let first = block.first();
        let tiles = block.each();
        let (mut velocity, (sums, shapes)) = (block.particles, block.cells);
        let mut kick = Kick::default();
        for (((number, tile), sum), shapes) in tiles.zip(sums).zip(shapes) {
            let nodes = active.tile_nodes(number);
            load_nodes(&mut kick.received, nodes, &shared.given);
            if blend > 0.0 {
                load_nodes(&mut kick.grid, nodes, &shared.grid);
            }
            sum.momentum = NO_CORNERS;
            for slot in tile.slots() {
                let points = Points {
                    position,
                    mass,
                    start: slot.start,
                    first,
                };
                let (momentum, lanes) = (&mut sum.momentum, slot.len());
                let own = &mut velocity;
                accelerate(
                    simd, &mut kick, &points, shapes, own, momentum, h, blend, lanes,
                );
            }
            tile.gather(&mut sum.momentum);
        }
        kick.energy.each_ref().map(sum_lanes)
    });
    ledger.end_kick(sums, before, after);
    sums[2]
}

/// The particles of a slot.
struct Points<'a> {
    position: [&'a [f64]; 3],
    mass: &'a [f64],
    /// The first of them, and the first of the block.
    start: usize,
    first: usize,
}

for_each_simd! {
    fn accelerate(
        kick: &mut Kick,
        points: &Points,
        shapes: &Shapes,
        velocity: &mut [&mut [f64]; 3],
        momentum: &mut Corners,
        h: f64,
        blend: f64,
        lanes: usize,
    ) {
        let own = points.start - points.first;
        load(&mut kick.position, &points.position, points.start);
        load(&mut kick.velocity, &velocity.each_ref().map(|v| &**v), own);
        load_one(&mut kick.mass, points.mass, points.start);
        kick.mass[lanes..whole(lanes)].fill(0.0);
        for l in 0..whole(lanes) {
            let n = shapes.at(l, Vec3::from_array(get(&kick.position, l)));
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
                let sum = corner(momentum, l, i) + v * (n[i] * m);
                set_corner(momentum, l, i, sum);
            }
        }
        store(&kick.velocity, velocity, own, lanes);
    }
}
