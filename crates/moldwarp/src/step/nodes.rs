//! Stage 2: the equation of motion at the nodes, a_i = F_i / m_i (Jassim et al. Eq. 8), with
//! local damping, absorbing boundaries, fixities, rollers and prescribed velocities.

use super::corners::Quad;
use super::{BLOCK, Node, contact, rigid};
use crate::boundary::AbsorbingNode;
use crate::measure::{DriftWork, Forces};
use crate::parallel::fold;
use crate::plan::Until;
use crate::simulation::Simulation;
use crate::{Mat3, Vec3};
use std::ops::Range;

pub(super) fn run(sim: &mut Simulation, before: f64, after: f64) {
    let h = before + after;
    if h == 0.0 {
        return;
    }
    apply_loads(sim);
    let damping = sim.local_damping();
    let Simulation {
        plan,
        clock,
        active,
        nodes,
        cells,
        constraints,
        absorbing,
        gravity,
        reference,
        shared,
        contacts,
        ..
    } = sim;
    let weighs = reference.is_some();
    let (active, gravity, portions) = (&*active, *gravity, &cells.portions);
    let (constraints, absorbing) = (&*constraints, &*absorbing);
    let booking = Booking {
        gravity,
        drifted: before > 0.0,
        judged: matches!(plan.stages[clock.stage].until, Until::Equilibrium { .. }),
    };
    // Else other nodes and bodies have a say.
    let alone = contacts.rigid.is_empty() && contacts.meetings.is_empty();
    let items = (0..nodes.len(), &mut nodes[..], &mut shared.given[..]);
    let booked = fold(items, BLOCK, &|(slots, nodes, given): (
        Range<usize>,
        &mut [Node],
        &mut [Quad],
    )| {
        let (mut sums, mut books) = ([Quad::default(); BLOCK], Books::default());
        (portions.nodes).own_sums(slots.clone(), &mut [&mut sums]);
        for (((slot, node), &sum), given) in slots.zip(nodes).zip(&sums).zip(given) {
            node.prefetch(0..3);
            if node.mass == 0.0 {
                let grid = (node.grid_velocity, node.moved);
                *node = Node {
                    grid_velocity: grid.0,
                    moved: grid.1,
                    ..Node::default()
                };
                *given = Quad::default();
                continue;
            }
            let mesh_node = active.nodes[slot];
            let (internal, weighed) = pushed(sum);
            node.internal = internal;
            node.weighed = if weighs { weighed } else { node.mass };
            let (constraint, boundary) = (constraints.of(mesh_node), absorbing.of(mesh_node));
            let mut force = internal + gravity * node.weighed;
            let held = constraint.is_some() || boundary.is_some();
            if !(held || damping != 0.0 || node.is_acted_on) {
                node.acceleration = force / node.mass;
                if alone {
                    book(node, given, &booking, &mut books);
                }
                continue;
            }
            force += node.load;
            // What a constraint or an absorbing boundary holds is balanced and not to be damped.
            let free = constraint.map_or(Mat3::IDENTITY, |c| c.free);
            let driving = force + boundary.map_or(Vec3::ZERO, AbsorbingNode::support);
            node.damping = free * (-damping * (free * driving).abs() * signs(node.velocity));
            force += node.damping;
            node.absorbing = Vec3::ZERO;
            if let Some(boundary) = boundary {
                // The velocity that has moved the boundary, if it has moved.
                let begin = if before > 0.0 {
                    node.grid_velocity
                } else {
                    node.velocity
                };
                let end = boundary.solve(node.mass, begin, force, h, constraints);
                node.absorbing = boundary.force(begin, end, h);
                force += node.absorbing;
            }
            node.acceleration = force / node.mass;
            node.reaction = Vec3::ZERO;
            if let Some(constraint) = constraint {
                let held = constraints.acceleration(constraint, node.velocity, h);
                node.acceleration = constraint.free * node.acceleration + held;
                node.reaction = node.acceleration * node.mass - force;
            }
            node.is_acted_on = held || damping != 0.0 || node.load != Vec3::ZERO;
            if alone {
                book(node, given, &booking, &mut books);
            }
        }
        books
    });
    let (work, forces) = if alone {
        booked
    } else {
        rigid::predict(sim, h);
        contact::kick(sim, before, after);
        book_all(sim, &booking)
    };
    sim.ledger.kick(work);
    sim.watch.forces = forces;
}

/// Half the work of the nodes' forces in the last drift, and their sums.
type Books = (DriftWork, Forces);

/// What is booked of nodes.
struct Booking {
    gravity: Vec3,
    /// Whether there has been a drift.
    drifted: bool,
    /// Whether the stage ends in equilibrium.
    judged: bool,
}

/// Books a node's forces, and gives its acceleration to the nodes around.
#[inline]
fn book(node: &Node, given: &mut Quad, booking: &Booking, books: &mut Books) {
    *given = node.acceleration.into();
    if node.mass == 0.0 {
        return;
    }
    if booking.judged {
        books.1.add(node, booking.gravity);
    }
    if booking.drifted {
        books.0.add(node, booking.gravity);
    }
}

fn book_all(sim: &mut Simulation, booking: &Booking) -> Books {
    let items = (&sim.nodes[..], &mut sim.shared.given[..]);
    fold(items, BLOCK, &|(nodes, given): (&[Node], &mut [Quad])| {
        let mut books = Books::default();
        for (node, given) in nodes.iter().zip(given) {
            book(node, given, booking, &mut books);
        }
        books
    })
}

/// −Σ S ∇N_i of a node, N, and the mass whose weight pulls at it where there is a reference stress, kg.
fn pushed(sum: Quad) -> (Vec3, f64) {
    (sum.vector(), sum.0[3])
}

/// Forces that nodes would follow were nothing to hold them, N, by mesh node: for what is to begin
/// in equilibrium.
pub(crate) fn unheld(sim: &mut Simulation) -> impl Fn(u32) -> Vec3 + '_ {
    super::to_nodes::run(sim, 0.0);
    apply_loads(sim);
    let sim = &*sim;
    move |mesh_node| {
        sim.slots(mesh_node)
            .map(|slot| {
                let node = &sim.nodes[slot];
                let mut sum = [Quad::default()];
                (sim.cells.portions.nodes).own_sums(slot..slot + 1, &mut [&mut sum]);
                let (internal, weighed) = pushed(sum[0]);
                let weighed = sim.reference.as_ref().map_or(node.mass, |_| weighed);
                internal + sim.gravity * weighed + node.load
            })
            .sum()
    }
}

/// Loads on particles, at the shape functions of the points they act on.
fn apply_loads(sim: &mut Simulation) {
    let Simulation {
        plan,
        particles,
        active,
        nodes,
        loads,
        clock,
        switches,
        fields,
        guests,
        ..
    } = sim;
    if plan.loads.is_empty() {
        return;
    }
    fold(&mut nodes[..], BLOCK, &|nodes: &mut [Node]| {
        nodes.iter_mut().for_each(|node| node.load = Vec3::ZERO);
    });
    let mesh = &plan.mesh;
    for point in loads.iter() {
        let p = guests.whereabouts(point.particle as usize, particles);
        let e = particles.element[p] as usize;
        let n = mesh.barycentric(e, particles.position.at(p) + point.offset);
        let load = point.load as usize;
        let factor = switches.load(load, clock.time);
        let force = point.force * (factor * plan.loads[load].function.value(clock.time));
        let cell = active.cell(e, fields.of(particles.body[p]));
        let cell = cell.expect("the element of a particle is a cell of its field");
        for (slot, share) in active.cell_nodes[cell].into_iter().zip(n) {
            let node = &mut nodes[slot as usize];
            node.load += force * share;
            node.is_acted_on = true;
        }
    }
}

/// −1, 0 or 1 per component.
pub(super) fn signs(v: Vec3) -> Vec3 {
    v.to_array()
        .map(|x| if x == 0.0 { 0.0 } else { x.signum() })
        .into()
}
