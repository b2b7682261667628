//! Contact between bodies: after the equation of motion, and again after the remap (Jassim et al.
//! Eq. 10–14; the impulses are in `contact/meeting.rs`).

use super::nodes::signs;
use super::to_nodes::is_filled;
use super::{Active, Node};
use crate::boundary::Constraints;
use crate::contact::{
    Ball, Contacts, Mass, Meeting, NORMALS, State, Strength, Tally, move_together, outermost,
    separate, solve,
};
use crate::mesh::Corner;
use crate::parallel::fold;
use crate::plan::ContactSurface;
use crate::simulation::Simulation;
use crate::{Mat3, Vec3};

/// A normal of which less than this is left in the free directions of a node is none.
const LEAST_NORMAL: f64 = 0.1;
/// Bodies touch where the gap is less than this part of the shortest altitude of the elements there.
/// The gap is found from depths of the start, so it is known to the strain of about half an element:
/// this allows for one of some per cent. What quivers on a surface leaves it by much less.
const TOUCHING: f64 = 0.05;

/// Most sweeps over all meetings where a rigid body ties them together.
const SWEEPS: usize = 200;
/// Meetings that one thread works on at a time.
const BLOCK: usize = 8;

/// Impulses of a kick of `before` + `after` seconds, and the second half of their work in the last
/// drift.
pub(super) fn kick(sim: &mut Simulation, before: f64, after: f64) {
    if sim.contacts.meetings.is_empty() {
        return;
    }
    let mut contacts = std::mem::take(&mut sim.contacts);
    look(sim, &mut contacts, 2.0 * before.max(after));
    let damping = sim.local_damping();
    if damping > 0.0 {
        damp(sim, &mut contacts, damping, before + after);
    }
    push(sim, &mut contacts, before + after);
    contacts.take_stock(&sim.active);
    sim.contacts = contacts;
    if before > 0.0 {
        work(sim);
    }
}

/// Normals, gaps and areas as they are now. `drift` is how long nodes will move with the velocities of
/// the kick, s.
fn look(sim: &Simulation, contacts: &mut Contacts, drift: f64) {
    let mut meetings = std::mem::take(&mut contacts.meetings);
    let known = &*contacts;
    fold(&mut meetings[..], BLOCK, &|meetings: &mut [Meeting]| {
        for meeting in meetings {
            *meeting = met(sim, known, *meeting, drift);
        }
    });
    contacts.meetings = meetings;
}

/// Local damping at nodes where bodies meet, anew: it has been found without the forces of contact, but
/// what these balance is not to be damped.
fn damp(sim: &mut Simulation, contacts: &mut Contacts, damping: f64, h: f64) {
    let change = |sim: &mut Simulation, contacts: &Contacts, sign: f64| {
        for (slot, node) in sim.nodes.iter_mut().enumerate() {
            if contacts.meets(slot) {
                node.acceleration += node.damping * (sign / node.mass);
            }
        }
    };
    change(sim, contacts, -1.0);
    // Fields have few rigid bodies: their velocities before the trial, to go back to.
    let mut rigid = std::mem::take(&mut contacts.rigid_before);
    rigid.clear();
    rigid.extend_from_slice(&contacts.rigid);
    push(sim, contacts, h);
    for (slot, node) in sim.nodes.iter_mut().enumerate() {
        let field = sim.active.field(slot);
        if contacts.meets(slot) && contacts.rigid_of_field[field].is_none() {
            let constraint = sim.constraints.of(sim.active.nodes[slot]);
            let free = constraint.map_or(Mat3::IDENTITY, |c| c.free);
            let driving = free * node.acceleration * node.mass;
            node.damping = free * (-damping * driving.abs() * signs(node.velocity));
        }
    }
    for meeting in &contacts.meetings {
        let force = meeting.normal_force + meeting.friction;
        let [a, b] = meeting.slots.map(|s| s as usize);
        let masses = [sim.nodes[a].mass, sim.nodes[b].mass];
        sim.nodes[a].acceleration += force / masses[0];
        sim.nodes[b].acceleration -= force / masses[1];
    }
    contacts.rigid.copy_from_slice(&rigid);
    contacts.rigid_before = rigid;
    for body in &contacts.rigid {
        super::rigid::spread(body, &sim.active, &mut sim.nodes, h);
    }
    change(sim, contacts, 1.0);
}

/// The impulses of a kick of length `h`.
fn push(sim: &mut Simulation, contacts: &mut Contacts, h: f64) {
    let Contacts {
        meetings,
        masses,
        rigid,
        rigid_of_field,
        ..
    } = contacts;
    let Simulation {
        plan,
        active,
        nodes,
        constraints,
        ..
    } = sim;
    let strength = |meeting: &Meeting| {
        meeting.contact.map(|contact| {
            let contact = &plan.contacts[contact as usize];
            Strength {
                friction: contact.friction,
                adhesion: contact.adhesion * meeting.area * h,
            }
        })
    };
    meetings.iter_mut().for_each(Meeting::begin);
    let sweeps = if rigid.is_empty() { 1 } else { SWEEPS };
    for _ in 0..sweeps {
        let (mut changed, mut total) = (0.0, 0.0);
        for group in meetings.chunk_by_mut(|a, b| same_node(active, a, b)) {
            let free = free(constraints, active, &group[0]);
            for (field, slot) in slots(active, group) {
                let node = &nodes[slot];
                masses[field] = match rigid_of_field[field] {
                    Some(r) => Mass {
                        inverse: 1.0 / rigid[r].mass,
                        velocity: rigid[r].velocity,
                    },
                    None => Mass {
                        inverse: 1.0 / node.mass,
                        velocity: node.velocity + node.acceleration * h,
                    },
                };
            }
            let of = |m: &Meeting| fields(active, m);
            let [change, all] = solve(group, of, masses, &free, strength);
            changed += change;
            total += all;
            if change == 0.0 {
                continue;
            }
            for (field, slot) in slots(active, group) {
                let (node, velocity) = (&mut nodes[slot], masses[field].velocity);
                match rigid_of_field[field] {
                    // What holds the body elsewhere takes the rest.
                    Some(r) => rigid[r].velocity = rigid[r].free * velocity,
                    None => node.acceleration = (velocity - node.velocity) / h,
                }
            }
        }
        if changed <= 1e-13 * total {
            break;
        }
    }
    meetings.iter_mut().for_each(|m| m.settle(h));
    for body in rigid.iter() {
        super::rigid::spread(body, active, nodes, h);
    }
}

/// Corrects the velocities that move the nodes. `velocity` is the one to correct.
pub(super) fn remap(sim: &mut Simulation, velocity: impl Fn(&mut Node) -> &mut Vec3) {
    let Simulation {
        active,
        nodes,
        constraints,
        contacts,
        ..
    } = sim;
    let Contacts {
        meetings,
        masses,
        rigid_of_field,
        ..
    } = contacts;
    for group in meetings.chunk_by(|a, b| same_node(active, a, b)) {
        if group.iter().all(|m| m.state == State::Open) {
            continue;
        }
        let free = free(constraints, active, &group[0]);
        for (field, slot) in slots(active, group) {
            let inverse = match rigid_of_field[field] {
                Some(_) => 0.0,
                None => 1.0 / nodes[slot].mass,
            };
            let velocity = *velocity(&mut nodes[slot]);
            masses[field] = Mass { inverse, velocity };
        }
        move_together(group, |m| fields(active, m), masses, &free);
        for (field, slot) in slots(active, group) {
            *velocity(&mut nodes[slot]) = masses[field].velocity;
        }
    }
}

/// Half the work of the contact forces in the last drift.
pub(super) fn work(sim: &mut Simulation) {
    let (nodes, mut sums) = (&sim.nodes, [0.0; 2]);
    for meeting in &sim.contacts.meetings {
        let [a, b] = meeting.slots.map(|s| nodes[s as usize].moved);
        sums[0] += 0.5 * meeting.normal_force.dot(b - a);
        sums[1] += 0.5 * meeting.friction.dot(b - a);
    }
    sim.ledger.contact_work(sums);
}

fn same_node(active: &Active, a: &Meeting, b: &Meeting) -> bool {
    let grid = |m: &Meeting| active.keys[m.slots[0] as usize] as usize % active.grid_nodes;
    grid(a) == grid(b)
}

fn fields(active: &Active, meeting: &Meeting) -> [usize; 2] {
    meeting.slots.map(|s| active.field(s as usize))
}

fn free(constraints: &Constraints, active: &Active, meeting: &Meeting) -> Mat3 {
    let node = active.nodes[meeting.slots[0] as usize];
    constraints.of(node).map_or(Mat3::IDENTITY, |c| c.free)
}

/// Fields and nodes of a group of meetings; one comes up as often as it meets others.
fn slots<'a>(
    active: &'a Active,
    group: &'a [Meeting],
) -> impl Iterator<Item = (usize, usize)> + use<'a> {
    let slots = group.iter().flat_map(|m| m.slots).map(|s| s as usize);
    slots.map(|slot| (active.field(slot), slot))
}

/// A meeting with its normals, gaps and area as they are now.
fn met(sim: &Simulation, contacts: &Contacts, mut meeting: Meeting, drift: f64) -> Meeting {
    let Some(number) = meeting.contact else {
        return meeting;
    };
    let active = &sim.active;
    let contact = &sim.plan.contacts[number as usize];
    let free = free(&sim.constraints, active, &meeting);
    let [a, b] = meeting
        .slots
        .map(|slot| move || balls(sim, contacts, slot as usize));
    let faces = match contact.surface {
        ContactSurface::Aligned => face_normals(sim, contacts, &meeting, number),
        ContactSurface::Free => None,
    };
    (meeting.count, meeting.area, meeting.touching) = (0, 0.0, false);
    let near = match contact.adhesion {
        0.0 => f64::NEG_INFINITY,
        _ => touching_gap(sim, &meeting),
    };
    let mut add = |n: Vec3, gap: f64| {
        let k = meeting.count;
        meeting.normals[k] = n;
        meeting.touching |= gap <= near;
        let gap = if contact.gap_check { gap } else { 0.0 };
        meeting.allowed[k] = gap.max(0.0) / drift;
        meeting.count += 1;
    };
    if let Some((normals, count, area)) = faces {
        for n in normals[..count].iter().map(|n| free * *n) {
            if n.length() > LEAST_NORMAL {
                let n = n.normalize();
                let gap = -outermost(b(), -n).1 - outermost(a(), n).1;
                add(n, gap);
            }
        }
        meeting.area = area;
    } else {
        // What is held is no direction to part in: on a roller the mesh's outside is no surface.
        let gradients = meeting
            .slots
            .map(|s| free * volume_gradient(sim, s as usize));
        let n = (gradients[0] - gradients[1]).normalize_or_zero();
        if n != Vec3::ZERO {
            let (n, gap) = separate(a, b, n, &free);
            add(n, gap);
            // Both point out of their bodies.
            let [a, b] = gradients.map(|g| g.dot(n));
            meeting.area = a.min(-b).max(0.0);
        }
    }
    meeting
}

/// Normals of an aligned structure's faces from a to b, their number, and the area that is touched;
/// nothing away from its faces.
fn face_normals(
    sim: &Simulation,
    contacts: &Contacts,
    meeting: &Meeting,
    number: u32,
) -> Option<([Vec3; NORMALS], usize, f64)> {
    let active = &sim.active;
    let [a, b] = meeting.slots.map(|s| s as usize);
    let first = contacts.is_first(number, active.field(a));
    let other = active.field(if first { b } else { a });
    let covered = |e: u32| active.cell(e as usize, other).map(|c| fill(sim, c));
    let mesh = &sim.plan.mesh;
    let (mut normals, count, area) = contacts.face_normals(mesh, number, active.nodes[a], covered);
    if !first {
        normals = normals.map(|n| -n);
    }
    (count > 0).then_some((normals, count, area))
}

/// Σ V_p ∇N of a node over the particles of its field. Where they fill elements this is ∫ N n dA over
/// their surface with its normal out of them: it points outwards, and its length is the part of the
/// surface that belongs to the node, m².
fn volume_gradient(sim: &Simulation, slot: usize) -> Vec3 {
    let (active, mesh) = (&sim.active, &sim.plan.mesh);
    let gradient = |at: &Corner| {
        let e = active.elements[at.owner()] as usize;
        mesh.all_gradients(e)[at.local()] * sim.cells.volume(at.owner())
    };
    active.attached(slot).iter().map(gradient).sum()
}

/// Part of a cell's element that its field fills. What counts as filled is full: particles come into an
/// element and leave it one by one, and the faces under the middle of a body are covered all the same.
fn fill(sim: &Simulation, c: usize) -> f64 {
    let (active, mesh) = (&sim.active, &sim.plan.mesh);
    if is_filled(&active.cell_nodes[c], &sim.shared.filling) {
        return 1.0;
    }
    let whole = mesh.volumes[active.elements[c] as usize];
    (sim.cells.volume(c) / whole).min(1.0)
}

/// The greatest gap at which bodies touch, m.
fn touching_gap(sim: &Simulation, meeting: &Meeting) -> f64 {
    let cells = meeting.slots.map(|s| sim.active.attached(s as usize));
    let elements = cells.into_iter().flatten();
    let altitudes = elements.map(|a| {
        let e = sim.active.elements[a.owner()];
        sim.plan.mesh.altitude(e as usize)
    });
    TOUCHING * altitudes.fold(f64::INFINITY, f64::min)
}

/// The particles of a node's field around it.
fn balls<'a>(
    sim: &'a Simulation,
    contacts: &'a Contacts,
    slot: usize,
) -> impl Iterator<Item = Ball> + use<'a> {
    let (active, particles) = (&sim.active, &sim.particles);
    let origin = sim.plan.mesh.nodes[active.nodes[slot] as usize];
    let cells = active.attached(slot).iter().map(|at| at.owner());
    let inside = cells.flat_map(|c| sim.order.places(active.ranks(c)));
    inside.map(move |&p| {
        let p = p as usize;
        let depth = contacts.depth[particles.id[p] as usize];
        (particles.position.at(p) - origin, depth)
    })
}

impl Contacts {
    /// Sums up what contacts do now.
    fn take_stock(&mut self, active: &Active) {
        self.tallies.fill(Tally::default());
        for meeting in &self.meetings {
            let Some(number) = meeting.contact else {
                continue;
            };
            // Forces are those on b.
            let first = self.is_first(number, active.field(meeting.slots[0] as usize));
            let sign = if first { -1.0 } else { 1.0 };
            let tally = &mut self.tallies[number as usize];
            tally.normal += meeting.normal_force * sign;
            tally.tangential += meeting.friction * sign;
            match meeting.state {
                State::Open => tally.open += 1,
                State::Sliding => tally.sliding += 1,
                State::Sticking => tally.sticking += 1,
            }
        }
    }
}
