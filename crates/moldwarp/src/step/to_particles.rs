//! Stage 3: velocities of particles, v_p += h Σ N_i a_i (Jassim et al. Eq. 8), and what they are then at the nodes, for
//! the remap.
//!
//! Nodes need not ask particles what these have received. With M_ij = Σ m_p N_i N_j, which cells have, the momenta of the
//! updated particles are
//!
//!   Σ_p m_p v_p' N_i = m_i v_i + h Σ_j M_ij a_j,
//!
//! and their energy Σ ½ m_p |v_p|² + h Σ m_i v_i · a_i + ½ h² Σ a_i · M_ij a_j. So particles receive their velocities
//! when the next drift goes through them (`points.rs`), or as soon as anyone wants to see them ([`Simulation::settle`]).

use super::corners::{Quad, TileNodes, all_corners};
use super::shapes::Shapes;
use super::{BLOCK, Node, Shared, strain};
use crate::lanes::{
    AHEAD, ByTile, Columns, LANES, Lane, Simd, for_each_simd, get, load, prefetch, set,
    sum as sum_lanes,
};
use crate::parallel::{self, fold};
use crate::simulation::Simulation;
use crate::{Mat3, Vec3};
use std::ops::Range;

/// A kick that particles have not received yet.
#[derive(Clone, Copy, Debug)]
pub struct Pending {
    /// Its length, s.
    h: f64,
    /// Part of the mesh's velocity that particles take on.
    blend: f64,
}

/// A vector that varies linearly in cells side by side: at node 0, and its gradient by columns.
struct Linear {
    origin: [Lane; 3],
    gradient: [Lane; 9],
}

/// Cells side by side, and what particles are given in them.
pub(super) struct Kick {
    received: Linear,
    /// v_i + h a_i, for relaxation.
    grid: Linear,
    /// Σ ½ m v², J.
    kinetic: Lane,
}

impl Default for Linear {
    fn default() -> Linear {
        Linear {
            origin: [Lane::of(0.0); 3],
            gradient: [Lane::of(0.0); 9],
        }
    }
}

impl Default for Kick {
    fn default() -> Kick {
        Kick {
            received: Linear::default(),
            grid: Linear::default(),
            kinetic: Lane::of(0.0),
        }
    }
}

/// What nodes give to particles: accelerations, and velocities where there is relaxation.
#[derive(Clone, Copy)]
pub(super) struct Given<'a> {
    pub pending: Option<Pending>,
    pub received: &'a [Quad],
    pub grid: &'a [Quad],
}

impl Kick {
    /// Goes to the next cells.
    #[inline]
    pub fn enter(&mut self, simd: Simd, given: &Given, nodes: TileNodes, shapes: &Shapes) {
        let Some(pending) = given.pending else {
            return;
        };
        vary(simd, &mut self.received, nodes, given.received, shapes);
        if pending.blend > 0.0 {
            vary(simd, &mut self.grid, nodes, given.grid, shapes);
        }
    }

    /// The velocity of a particle here, `arm` from node 0, with what it has not received yet.
    #[inline(always)]
    pub fn receive(&self, l: usize, arm: Vec3, mut v: Vec3, pending: Pending) -> Vec3 {
        v += self.received.at(l, arm) * pending.h;
        if pending.blend > 0.0 {
            v += (self.grid.at(l, arm) - v) * pending.blend;
        }
        v
    }

    /// Counts the energy of a particle.
    #[inline(always)]
    pub fn count(&mut self, l: usize, mass: f64, v: Vec3) {
        self.kinetic[l] += 0.5 * mass * v.length_squared();
    }

    /// Energy of motion of all particles, J.
    pub fn kinetic(&self) -> f64 {
        sum_lanes(&self.kinetic)
    }
}

for_each_simd! {
    fn vary(linear: &mut Linear, nodes: TileNodes, given: &[Quad], shapes: &Shapes) {
        let (corners, _) = S::corners(nodes, given);
        for l in 0..LANES {
            let corners = all_corners(&corners, l);
            let gradient = strain::gradient(&shapes.gradients(l), corners);
            set(&mut linear.origin, l, corners[0].to_array());
            set(&mut linear.gradient, l, gradient.to_cols_array());
        }
    }
}

impl Linear {
    #[inline(always)]
    fn at(&self, l: usize, arm: Vec3) -> Vec3 {
        let gradient = Mat3::from_cols_array(&get(&self.gradient, l));
        Vec3::from_array(get(&self.origin, l)) + gradient * arm
    }
}

for_each_simd! {
    /// Gives particles of these velocities what they have not received yet.
    fn accelerate(
        velocity: &mut [Lane; 3],
        kick: &Kick,
        shapes: &Shapes,
        position: &[Lane; 3],
        pending: Pending,
    ) {
        for l in 0..LANES {
            let arm = shapes.arm(l, Vec3::from_array(get(position, l)));
            let v = Vec3::from_array(get(velocity, l));
            set(velocity, l, kick.receive(l, arm, v, pending).to_array());
        }
    }
}

/// Velocities of the updated particles at the nodes. Returns their energy of motion, J.
pub(super) fn run(sim: &mut Simulation, before: f64, after: f64) -> f64 {
    let h = before + after;
    let blend = -libm::expm1(-sim.plan.numerics.pic_rate * h);
    let first = sim.kinetic.take().unwrap_or_else(|| kinetic(sim));
    let [gain, square] = exchange(
        sim,
        |shared| &shared.received,
        |node, received, product| {
            let works = [node.momentum().dot(received), product.dot(received)];
            node.average = match node.mass {
                0.0 => Vec3::ZERO,
                mass => node.velocity + product * (h / mass),
            };
            works
        },
    );
    let free = first + h * gain + 0.5 * h * h * square;
    let mut kinetic = free;
    if blend > 0.0 {
        let Shared { grid, received, .. } = &mut sim.shared;
        let own = |(node, received): (&Node, &Quad)| node.velocity + received.vector() * h;
        grid.clear();
        grid.extend(sim.nodes.iter().zip(&*received).map(own).map(Quad::from));
        let [mixed, grid] = exchange(
            sim,
            |shared| &shared.grid,
            |node, own, product| {
                let works = [node.mass * node.average.dot(own), product.dot(own)];
                if node.mass > 0.0 {
                    node.average = node.average * (1.0 - blend) + product * (blend / node.mass);
                }
                works
            },
        );
        let rest = 1.0 - blend;
        kinetic = rest * rest * free + blend * rest * mixed + 0.5 * blend * blend * grid;
    }
    sim.pending = Some(Pending { h, blend });
    let sums = [square, free - kinetic, kinetic];
    sim.ledger.end_kick(sums, before, after);
    kinetic
}

impl Node {
    /// Momentum before the kick, N s.
    fn momentum(&self) -> Vec3 {
        self.velocity * self.mass
    }
}

/// Calls `work` on each node with what it shares, w_i, and Σ_j M_ij w_j, and adds up what it says.
fn exchange(
    sim: &mut Simulation,
    w: fn(&Shared) -> &[Quad],
    work: impl Fn(&mut Node, Vec3, Vec3) -> [f64; 2] + Sync,
) -> [f64; 2] {
    let Simulation {
        nodes,
        shared,
        cells,
        simd,
        ..
    } = sim;
    let (w, matrix, simd) = (w(shared), &cells.mass, *simd);
    let items = (0..nodes.len(), &mut nodes[..]);
    fold(items, BLOCK, &|(slots, nodes): (
        Range<usize>,
        &mut [Node],
    )| {
        let (mut all, mut products) = ([0.0; 2], [Quad::default(); BLOCK]);
        matrix.products(simd, slots.clone(), w, &mut products);
        for ((node, own), product) in nodes.iter_mut().zip(&w[slots]).zip(&products) {
            node.prefetch(0..2);
            let works = work(node, own.vector(), product.vector());
            (all[0], all[1]) = (all[0] + works[0], all[1] + works[1]);
        }
        all
    })
}

/// Σ ½ m v² of the particles as they are, J.
fn kinetic(sim: &Simulation) -> f64 {
    let (mass, velocity) = (&sim.particles.mass[..], &sim.particles.velocity);
    fold(0..mass.len(), BLOCK, &|particles: Range<usize>| {
        let of = |p: usize| 0.5 * mass[p] * velocity.at(p).length_squared();
        particles.map(of).sum::<f64>()
    })
}

impl Simulation {
    /// Gives particles what they have not received yet of the last kick, so that their velocities can be seen.
    pub fn settle(&mut self) {
        if let Some(pending) = self.pending.take() {
            parallel::inside(|| {
                self.guests_arrive();
                settle(self, pending);
            });
        }
        self.guests_leave();
    }
}

fn settle(sim: &mut Simulation, pending: Pending) {
    let Simulation {
        particles,
        active,
        shared,
        simd,
        ..
    } = sim;
    let given = Given {
        pending: Some(pending),
        received: &shared.received,
        grid: &shared.grid,
    };
    let (active, places, simd) = (&*active, &shared.places[..], *simd);
    let position = particles.position.components();
    let velocities = Columns::new(particles.velocity.components_mut());
    let all = ByTile::new(&active.tiles, velocities, ());
    fold(all, super::TILES, &|block: ByTile<Columns<3>, ()>| {
        let first = block.first();
        let tiles = block.each();
        let mut own = block.particles;
        let mut shapes = Shapes::default();
        let mut kick = Kick::default();
        let (mut x, mut v) = ([Lane::of(0.0); 3], [Lane::of(0.0); 3]);
        for (number, tile) in tiles {
            let nodes = active.tile_nodes(number);
            shapes.enter(simd, nodes, places);
            kick.enter(simd, &given, nodes, &shapes);
            for slot in tile.slots() {
                let (start, lanes) = (slot.start - first, slot.len());
                prefetch(&position, slot.end + AHEAD);
                load(&mut x, &position, slot.start);
                own.load(&mut v, start);
                accelerate(simd, &mut v, &kick, &shapes, &x, pending);
                own.store(simd, &v, start, lanes);
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{LinearElastic, Material};
    use crate::mesh::box_mesh;
    use crate::plan::*;

    /// A heap that falls apart, some of its particles being guests: what nodes know of the updated particles is what these
    /// have when they have received it, and when they do makes no difference.
    #[test]
    fn nodes_know_what_particles_receive() {
        let heap = |pic_rate: f64| {
            let elastic = LinearElastic {
                young_modulus: 1e5,
                poisson_ratio: 0.2,
            };
            let (min, max) = (Vec3::ZERO, Vec3::new(1.0, 1.0, 2.0));
            let mesh = box_mesh(Vec3::new(3.0, 1.0, 3.0), [6, 2, 6]).unwrap();
            let bottom = mesh.surface("z-min").unwrap();
            let plan = Plan {
                title: String::new(),
                gravity: Vec3::new(0.0, 0.0, -9.81),
                mesh,
                symmetry: None,
                materials: vec![NamedMaterial {
                    name: "jelly".into(),
                    density: 1000.0,
                    model: Material::LinearElastic(elastic),
                }],
                bodies: vec![Body {
                    name: "heap".into(),
                    place: Place::Region(Region::Box { min, max }),
                    material: 0,
                    seeding: Seeding::Four,
                }],
                boundaries: vec![Boundary {
                    name: "floor".into(),
                    surfaces: vec![bottom],
                    kind: BoundaryKind::Fixed {
                        directions: [true; 3],
                    },
                }],
                loads: vec![],
                contacts: vec![],
                probes: vec![],
                initial_stress: None,
                inherited: Default::default(),
                mesh_motion: None,
                numerics: Numerics {
                    pic_rate,
                    ..Numerics::default()
                },
                stages: vec![Stage::new("run", Until::Steps(100))],
            };
            let mut sim = Simulation::new(plan).unwrap();
            sim.set_velocity(|x| Vec3::new(0.3 * x.z, 0.0, 0.2 * (x.x - 0.5)))
                .unwrap();
            sim
        };
        for pic_rate in [0.0, 20.0] {
            let (mut sim, mut other) = (heap(pic_rate), heap(pic_rate));
            let (mut met, mut guests) = (0, 0);
            while !sim.finished() {
                sim.step_and(|_| ()).unwrap();
                other.step().unwrap();
                let averages: Vec<Vec3> = sim.nodes.iter().map(|node| node.average).collect();
                if sim.steps().is_multiple_of(5) {
                    sim.settle();
                }
                if sim.pending.is_some() {
                    continue;
                }
                assert_eq!(sim.particles.velocity, other.particles.velocity);
                let known = sim.ledger.particles();
                assert!((kinetic(&sim) / known - 1.0).abs() < 1e-12);
                let mut momenta = vec![Vec3::ZERO; sim.nodes.len()];
                for p in 0..sim.particles.len() {
                    let e = sim.particles.element[p];
                    guests += usize::from(e != sim.order.filed[p]);
                    let n = (sim.plan.mesh).barycentric(e as usize, sim.particles.position.at(p));
                    let cell = sim.active.cell(e as usize, 0).unwrap();
                    let momentum = sim.particles.velocity.at(p) * sim.particles.mass[p];
                    for (n, slot) in n.into_iter().zip(sim.active.cell_nodes[cell]) {
                        momenta[slot as usize] += momentum * n;
                    }
                }
                for ((node, average), momentum) in sim.nodes.iter().zip(averages).zip(momenta) {
                    let own = average * node.mass;
                    assert!(
                        (own - momentum).length() <= 1e-12 * node.mass,
                        "{own} {momentum}"
                    );
                }
                met += 1;
            }
            assert!(met >= 20 && guests > 0, "{met} {guests}");
        }
    }
}
