//! Contact between bodies: after the equation of motion, and again after the remap (Jassim et al.
//! Eq. 10–14; the impulses are in `contact/meeting.rs`).

use super::{Active, Node};
use crate::boundary::Constraints;
use crate::contact::{
    Ball, Contacts, Mass, Meeting, NORMALS, State, Strength, Tally, move_together, separate, solve,
};
use crate::plan::ContactSurface;
use crate::simulation::Simulation;
use crate::{Mat3, Vec3};

/// A normal of which less than this is left in the free directions of a node is none.
const LEAST_NORMAL: f64 = 0.1;

/// Impulses of a kick of `before` + `after` seconds, and the second half of their work in the last
/// drift.
pub(super) fn kick(sim: &mut Simulation, before: f64, after: f64) {
    if sim.contacts.meetings.is_empty() {
        return;
    }
    let mut contacts = std::mem::take(&mut sim.contacts);
    let drift = 2.0 * before.max(after);
    for k in 0..contacts.meetings.len() {
        let meeting = contacts.meetings[k];
        contacts.meetings[k] = met(sim, &mut contacts, meeting, drift);
    }
    let Contacts {
        meetings, masses, ..
    } = &mut contacts;
    let h = before + after;
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
    for group in meetings.chunk_by_mut(|a, b| same_node(active, a, b)) {
        let free = free(constraints, active, &group[0]);
        load(masses, group, active, |slot| {
            let node = &nodes[slot];
            (node.mass, node.velocity + node.acceleration * h)
        });
        solve(group, |m| fields(active, m), masses, &free, strength, h);
        for meeting in group.iter() {
            let force = meeting.normal_force + meeting.friction;
            let [a, b] = meeting.slots.map(|s| s as usize);
            let masses = [nodes[a].mass, nodes[b].mass];
            nodes[a].acceleration -= force / masses[0];
            nodes[b].acceleration += force / masses[1];
        }
    }
    contacts.take_stock(active);
    sim.contacts = contacts;
    if before > 0.0 {
        work(sim);
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
        meetings, masses, ..
    } = contacts;
    for group in meetings.chunk_by(|a, b| same_node(active, a, b)) {
        if group.iter().all(|m| m.state == State::Open) {
            continue;
        }
        let free = free(constraints, active, &group[0]);
        load(masses, group, active, |slot| {
            (nodes[slot].mass, *velocity(&mut nodes[slot]))
        });
        move_together(group, |m| fields(active, m), masses, &free);
        for slot in group.iter().flat_map(|m| m.slots).map(|s| s as usize) {
            *velocity(&mut nodes[slot]) = masses[active.field(slot)].velocity;
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

/// Masses and velocities of the fields at a node.
fn load(
    masses: &mut [Mass],
    group: &[Meeting],
    active: &Active,
    mut of: impl FnMut(usize) -> (f64, Vec3),
) {
    for slot in group.iter().flat_map(|m| m.slots).map(|s| s as usize) {
        let (mass, velocity) = of(slot);
        masses[active.field(slot)] = Mass { mass, velocity };
    }
}

/// A meeting with its normals, gaps and area as they are now.
fn met(sim: &Simulation, contacts: &mut Contacts, mut meeting: Meeting, drift: f64) -> Meeting {
    let Some(number) = meeting.contact else {
        return meeting;
    };
    let active = &sim.active;
    let contact = &sim.plan.contacts[number as usize];
    let free = free(&sim.constraints, active, &meeting);
    let mut balls = std::mem::take(&mut contacts.balls);
    for (balls, slot) in balls.iter_mut().zip(meeting.slots) {
        fill(balls, sim, contacts, slot as usize);
    }
    let faces = match contact.surface {
        ContactSurface::Aligned => face_normals(sim, contacts, &meeting, number),
        ContactSurface::Free => None,
    };
    meeting.count = 0;
    let mut add = |n: Vec3, gap: f64| {
        let k = meeting.count;
        meeting.normals[k] = n;
        let gap = if contact.gap_check { gap } else { 0.0 };
        meeting.allowed[k] = gap.max(0.0) / drift;
        meeting.count += 1;
    };
    if let Some((normals, count, area)) = faces {
        for n in normals[..count].iter().map(|n| free * *n) {
            if n.length() > LEAST_NORMAL {
                let n = n.normalize();
                add(n, gap(&balls[0], &balls[1], n));
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
            let (n, gap) = separate(&balls[0], &balls[1], n, &free);
            add(n, gap);
            let [a, b] = gradients.map(|g| g.dot(n).abs());
            meeting.area = a.min(b);
        }
    }
    contacts.balls = balls;
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
    let touched = |e: u32| active.cell(e as usize, other).is_some();
    let mesh = &sim.plan.mesh;
    let (mut normals, count, area) = contacts.face_normals(mesh, number, active.nodes[a], touched);
    if !first {
        normals = normals.map(|n| -n);
    }
    (count > 0).then_some((normals, count, area))
}

/// Σ V_p ∇N of a node over the particles of its field. Where they fill elements this is ∫ N n dA over
/// their surface with its normal out of them: it points outwards, and its length is the part of the
/// surface that belongs to the node, m².
fn volume_gradient(sim: &Simulation, slot: usize) -> Vec3 {
    let (active, mesh, sums) = (&sim.active, &sim.plan.mesh, &sim.cells.sums);
    let gradient = |&(c, local): &(u32, u8)| {
        let c = c as usize;
        let own = mesh.all_gradients(active.elements[c] as usize)[local as usize];
        own * sums[c].volume
    };
    active.attached(slot).iter().map(gradient).sum()
}

/// The particles around a node that can be the outermost of their body.
fn fill(balls: &mut Vec<Ball>, sim: &Simulation, contacts: &Contacts, slot: usize) {
    let (active, particles) = (&sim.active, &sim.particles);
    let origin = sim.plan.mesh.nodes[active.nodes[slot] as usize];
    balls.clear();
    for &(c, _) in active.attached(slot) {
        let c = c as usize;
        for p in active.offsets[c] as usize..active.offsets[c + 1] as usize {
            let depth = contacts.depth[particles.id[p] as usize];
            balls.push((particles.position[p] - origin, depth));
        }
    }
}

/// Distance along n between two bodies, m.
fn gap(a: &[Ball], b: &[Ball], n: Vec3) -> f64 {
    let reach = |balls: &[Ball], n: Vec3| {
        let reach = balls.iter().map(|(x, depth)| x.dot(n) + depth);
        reach.fold(f64::NEG_INFINITY, f64::max)
    };
    -reach(b, -n) - reach(a, n)
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
