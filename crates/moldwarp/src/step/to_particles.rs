//! Stage 3: velocities of particles, v_p += h Σ N_i a_i (Jassim et al. Eq. 8), and the momenta
//! of the updated particles for the remap.

use super::collect::{Portions, Shares};
use super::corners::{
    Corners, NO_CORNERS, all_corners, corner, interpolate, load_nodes, set_corner,
};
use super::shapes::Shapes;
use super::{BLOCK, Node};
use crate::Vec3;
use crate::lanes::{
    ByTile, Lane, for_each_simd, get, load, load_one, prefetch, set, store, sum as sum_lanes, whole,
};
use crate::parallel::fold;
use crate::simulation::Simulation;
use std::ops::Range;

/// Cells and particles side by side.
struct Kick {
    received: Corners,
    /// v_i + h a_i, for relaxation.
    grid: Corners,
    /// Σ m_p v_p N_i of each cell.
    momentum: Corners,
    position: [Lane; 3],
    velocity: [Lane; 3],
    mass: Lane,
    /// Sums for the ledger: Σ m |a|², energy taken by relaxation, Σ ½ m v².
    energy: [Lane; 3],
}

impl Default for Kick {
    fn default() -> Kick {
        let vector = [Lane::of(0.0); 3];
        Kick {
            received: NO_CORNERS,
            grid: NO_CORNERS,
            momentum: NO_CORNERS,
            position: vector,
            velocity: vector,
            mass: Lane::of(0.0),
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
    // Part of the mesh's velocity that particles take on in a kick.
    let blend = -libm::expm1(-plan.numerics.pic_rate * h);
    if blend > 0.0 {
        for (grid, node) in shared.grid.iter_mut().zip(&*nodes) {
            *grid = (node.velocity + node.received * h).into();
        }
    }
    let (active, shared, simd) = (&*active, &*shared, *simd);
    let (position, mass) = (particles.position.components(), &particles.mass[..]);
    type Velocities<'a> = [&'a mut [f64]; 3];
    let velocities = particles.velocity.components_mut();
    let cut = cells.portions.cut();
    let records = (cells.portions.shares(), &cells.shapes[..]);
    let all = ByTile::new(&active.tiles, velocities, records);
    type Records<'a> = (Shares<'a, 1>, &'a [Shapes]);
    let sums = cut.fold(all, &|block: ByTile<Velocities, Records>| {
        let first = block.first();
        let tiles = block.each();
        let (mut velocity, (shares, shapes)) = (block.particles, block.cells);
        let (mut kick, mut share) = (Kick::default(), shares.begin());
        let nothing = [Lane::of(0.0); 4];
        for ((number, tile), shapes) in tiles.zip(shapes) {
            let nodes = active.tile_nodes(number);
            load_nodes(simd, &mut kick.received, nodes, &shared.given);
            if blend > 0.0 {
                load_nodes(simd, &mut kick.grid, nodes, &shared.grid);
            }
            kick.momentum = NO_CORNERS;
            for slot in tile.slots() {
                let points = Points {
                    position,
                    mass,
                    start: slot.start,
                    first,
                };
                let (own, lanes) = (&mut velocity, slot.len());
                prefetch(&position, slot.end);
                prefetch(&[mass], slot.end);
                prefetch(&own.each_ref().map(|v| &**v), slot.end - first);
                accelerate(simd, &mut kick, &points, shapes, own, h, blend, lanes);
            }
            tile.gather(&mut kick.momentum);
            share.give(simd, nodes, &kick.momentum, &nothing);
        }
        kick.energy.each_ref().map(sum_lanes)
    });
    average(nodes, &cells.portions);
    ledger.end_kick(sums, before, after);
    sums[2]
}

/// v̄_i.
fn average(nodes: &mut [Node], portions: &Portions) {
    fold((0..nodes.len(), nodes), BLOCK, &|(slots, nodes): (
        Range<usize>,
        &mut [Node],
    )| {
        let [momenta]: [[_; BLOCK]; 1] = portions.sums(slots);
        for (node, momentum) in nodes.iter_mut().zip(momenta) {
            node.average = if node.mass > 0.0 {
                momentum.vector() / node.mass
            } else {
                Vec3::ZERO
            };
        }
    });
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
                let sum = corner(&kick.momentum, l, i) + v * (n[i] * m);
                set_corner(&mut kick.momentum, l, i, sum);
            }
        }
        store(&kick.velocity, velocity, own, lanes);
    }
}
