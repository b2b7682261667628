//! Contact: bodies that touch, slide and part (Jassim et al. Section 5).
//!
//! Bodies that may slide on each other move with a velocity field each. Where particles of several
//! fields are around a node, the node exists once in each field (`step/active.rs`), so that masses,
//! forces, filling and smoothing know of one field only; the fields *meet* there, and impulses keep
//! them apart (`meeting`). Meetings are found anew whenever particles change elements; no node
//! belongs to a contact beforehand.

mod depth;
mod fields;
mod meeting;
mod rigid;
mod separation;

pub use fields::Fields;
pub use meeting::{Mass, Meeting, NORMALS, State, Strength, move_together, solve};
pub use rigid::{HeldDirections, Rigid, is_rigid};
pub use separation::{Ball, outermost, separate};

use crate::Vec3;
use crate::mesh::{Face, Mesh, NONE};
use crate::particles::{Order, Particles};
use crate::plan::{Contact, ContactSurface, Plan};
use crate::step::Active;

/// Faces of an aligned structure whose normals differ by less than this count as one (20°).
const SMOOTH_COSINE: f64 = 0.939_692_620_785_908_4;

/// What a contact does at an instant.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Force on the first side, N: along the normals, and along the surface.
    pub normal: Vec3,
    pub tangential: Vec3,
    /// Number of nodes in each state.
    pub sticking: u32,
    pub sliding: u32,
    pub open: u32,
}

/// Particles that were put back onto their side of an aligned face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Projections {
    pub count: u64,
    /// Sum of the distances, and the greatest, m.
    pub sum: f64,
    pub greatest: f64,
    /// Sum of the absolute works of gravity on the way, J.
    pub work: f64,
}

impl Projections {
    pub(crate) fn add(&mut self, distance: f64, work: f64) {
        self.count += 1;
        self.work += work.abs();
        self.sum += distance;
        self.greatest = self.greatest.max(distance);
    }
}

/// Why a contact cannot be used.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
pub enum ContactError {
    #[error("body `{body}` is rigid and cannot hang together with others in a contact")]
    RigidWithOthers { body: String },
    #[error(
        "contact `{contact}` is aligned, but its first side does not fill whole elements: element \
         {element} is filled in part"
    )]
    NotOnFaces { contact: String, element: u32 },
}

/// All contacts of a simulation.
#[derive(Clone, Debug, Default)]
pub struct Contacts {
    /// Contact of each pair of fields.
    of_fields: Vec<Option<u32>>,
    /// Field of the first side of each contact.
    first: Vec<usize>,
    /// Distance of each particle to its body's surface by id, m.
    pub depth: Vec<f64>,
    /// Of each aligned contact the faces of its first side by node; otherwise none.
    faces: Vec<Vec<(u32, Face)>>,
    /// Ordered by grid node.
    pub meetings: Vec<Meeting>,
    /// Field of the aligned structure that fills each element, or [`NONE`]; nothing if there is none.
    structure: Vec<u32>,
    /// Particles that were put back onto their side of a face.
    pub projections: Projections,
    /// Whether fields meet at each node of the step; nothing if there is one field only.
    meets: Vec<bool>,
    pub tallies: Vec<Tally>,
    pub rigid: Vec<Rigid>,
    /// The same before a trial, kept so that no step allocates.
    pub rigid_before: Vec<Rigid>,
    /// Index into `rigid` of each field.
    pub rigid_of_field: Vec<Option<usize>>,
    /// Masses of the fields at the node that is worked on.
    pub masses: Vec<Mass>,
}

crate::saved!(Contacts {
    of_fields,
    first,
    depth,
    faces,
    meetings,
    structure,
    projections,
    meets,
    tallies,
    rigid,
    rigid_before,
    rigid_of_field,
    masses,
});

impl Contacts {
    pub fn new(
        plan: &Plan,
        fields: &Fields,
        particles: &Particles,
        order: &Order,
    ) -> Result<Contacts, ContactError> {
        let count = fields.count();
        let mut contacts = Contacts {
            of_fields: vec![None; count * count],
            tallies: vec![Tally::default(); plan.contacts.len()],
            masses: vec![Mass::default(); count],
            ..Contacts::default()
        };
        check_rigid(plan)?;
        for (number, contact) in plan.contacts.iter().enumerate() {
            let [a, b] = [0, 1].map(|side| fields.of(contact.bodies[side][0] as u16));
            contacts.of_fields[a * count + b] = Some(number as u32);
            contacts.of_fields[b * count + a] = Some(number as u32);
            contacts.first.push(a);
            contacts.faces.push(Vec::new());
            if contact.surface == ContactSurface::Aligned {
                let inside = elements(&plan.mesh, contact, particles, order)?;
                contacts.faces[number] = depth::faces_by_node(&plan.mesh, &inside);
                contacts.structure.resize(inside.len(), NONE);
                let own = contacts.structure.iter_mut().zip(inside).filter(|e| e.1);
                own.for_each(|(field, _)| *field = a as u32);
            }
        }
        contacts.rigid = rigid::bodies(plan, fields);
        contacts.rigid_of_field = vec![None; count];
        for (number, rigid) in contacts.rigid.iter().enumerate() {
            contacts.rigid_of_field[rigid.field] = Some(number);
        }
        if !plan.contacts.is_empty() {
            contacts.measure(plan, particles);
        }
        Ok(contacts)
    }

    /// Measures how deep particles lie that have not been measured yet.
    pub fn measure(&mut self, plan: &Plan, particles: &Particles) {
        let depths = depth::depths(&plan.mesh, &plan.bodies, particles);
        let most = particles.id.iter().map(|&id| id as usize + 1).max();
        let size = most.unwrap_or(0).max(self.depth.len());
        self.depth.resize(size, f64::NAN);
        let mut inherits = vec![false; plan.bodies.len()];
        let inherited = plan.inherited.body.iter();
        inherited.for_each(|&b| inherits[usize::from(b)] = true);
        for (p, &id) in particles.id.iter().enumerate() {
            let known = &mut self.depth[id as usize];
            if known.is_nan() {
                // Where a body comes from an earlier run its region is not its surface any more.
                *known = match inherits[usize::from(particles.body[p])] {
                    true => 0.5 * particles.volume[p].cbrt(),
                    false => depths[p].max(0.0),
                };
            }
        }
    }

    /// The contact of two fields.
    pub fn of(&self, a: usize, b: usize) -> Option<u32> {
        self.of_fields[a * self.masses.len() + b]
    }

    /// Whether a field is the first side of a contact.
    pub fn is_first(&self, contact: u32, field: usize) -> bool {
        self.first[contact as usize] == field
    }

    /// Nodes of a surface on faces of aligned contacts, ascending, each with the part of the faces'
    /// area there that belongs to the surface.
    pub fn shares(&self, mesh: &Mesh, surface: usize) -> Vec<(u32, f64)> {
        let mut corners: Vec<[u32; 3]> = mesh.surfaces[surface]
            .faces
            .iter()
            .map(|&f| sorted(mesh.face_nodes(f)))
            .collect();
        corners.sort_unstable();
        let mut nodes: Vec<u32> = corners.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let share = |&n: &u32| {
            let faces = self.faces.iter().flat_map(|faces| depth::at(faces, n));
            let (mut own, mut all) = (0.0, 0.0);
            for face in faces {
                let area = mesh.face_area(face).length();
                all += area;
                if corners
                    .binary_search(&sorted(mesh.face_nodes(face)))
                    .is_ok()
                {
                    own += area;
                }
            }
            (own > 0.0).then_some((n, own / all))
        };
        nodes.iter().filter_map(share).collect()
    }

    /// Whether a particle of a field must not go from an element to another one: it would pass a face
    /// of an aligned contact.
    #[inline]
    pub fn blocks(&self, field: usize, from: u32, to: u32) -> bool {
        if self.structure.is_empty() {
            return false;
        }
        let [from, to] = [from, to].map(|e| self.structure[e as usize]);
        let leaves = from == field as u32 && to != from;
        leaves || (to != NONE && to != from && self.aligned(field, to).is_some())
    }

    /// Nodes of the faces of aligned contacts.
    pub fn nodes_of_faces(&self) -> impl Iterator<Item = u32> {
        self.faces.iter().flatten().map(|f| f.0)
    }

    /// Whether an element is that of an aligned structure of another field.
    pub fn is_foreign(&self, field: usize, element: u32) -> bool {
        let structure = self.structure.get(element as usize);
        structure.is_some_and(|&s| s != NONE && s != field as u32)
    }

    /// The aligned contact of a field with a structure.
    fn aligned(&self, field: usize, structure: u32) -> Option<u32> {
        let contact = self.of(field, structure as usize)?;
        let first = self.first[contact as usize] == structure as usize;
        (first && !self.faces[contact as usize].is_empty()).then_some(contact)
    }

    /// The face that a particle of a field has passed on its way from an element to another one: the
    /// normal back to its side, and how far it is beyond, m.
    pub fn passed(
        &self,
        mesh: &Mesh,
        field: usize,
        from: u32,
        to: u32,
        x: Vec3,
    ) -> Option<(Vec3, f64)> {
        let leaves = self.structure[from as usize] == field as u32;
        let contact = if leaves {
            let own = |&k: &usize| self.first[k] == field && !self.faces[k].is_empty();
            (0..self.first.len()).find(own)? as u32
        } else {
            self.aligned(field, self.structure[to as usize])?
        };
        let nodes = mesh.tets[if leaves { from } else { to } as usize];
        let faces = nodes
            .into_iter()
            .flat_map(|n| depth::at(&self.faces[contact as usize], n));
        let beyond = faces.map(|face| {
            let n = mesh.face_area(face).normalize() * if leaves { -1.0 } else { 1.0 };
            let origin = mesh.nodes[mesh.face_nodes(face)[0] as usize];
            (n, (origin - x).dot(n))
        });
        // Of the faces that it is behind the one that it has passed by least.
        let behind = beyond.filter(|b| b.1 >= 0.0);
        behind.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Whether fields meet at a node.
    #[inline]
    pub fn meets(&self, slot: usize) -> bool {
        self.meets.get(slot) == Some(&true)
    }

    /// Finds the nodes at which fields meet.
    pub fn find(&mut self, active: &Active) {
        let (fields, grid_nodes) = (self.masses.len(), active.grid_nodes);
        if fields < 2 {
            return;
        }
        self.meetings.clear();
        self.meets.clear();
        self.meets.resize(active.nodes.len(), false);
        for grid in 0..grid_nodes {
            for a in 0..fields {
                for b in a + 1..fields {
                    let slots = [a, b].map(|f| active.slot_of_key[f * grid_nodes + grid]);
                    if slots.iter().all(|&s| (s as usize) < active.nodes.len()) {
                        let contact = self.of(a, b);
                        slots.iter().for_each(|&s| self.meets[s as usize] = true);
                        self.meetings.push(Meeting::new(slots, contact));
                    }
                }
            }
        }
    }

    /// Normals of the faces of an aligned structure at a node, out of it, and the part of their area
    /// that belongs to the node and is covered by another body, m². `covered` says how much of an element
    /// that body fills, and nothing if it is not there; only faces with such elements behind them count,
    /// unless there is none. Those that differ by less than 20° are one.
    pub fn face_normals(
        &self,
        mesh: &Mesh,
        contact: u32,
        node: u32,
        covered: impl Fn(u32) -> Option<f64>,
    ) -> ([Vec3; NORMALS], usize, f64) {
        let mut sums = [Vec3::ZERO; NORMALS];
        let (mut count, mut area) = (0, 0.0);
        let faces = || depth::at(&self.faces[contact as usize], node);
        let behind = |face: Face| covered(mesh.across(face)?.element);
        let any = faces().any(|f| behind(f).is_some());
        for face in faces() {
            let part = behind(face);
            if any && part.is_none() {
                continue;
            }
            let own = mesh.face_area(face);
            area += part.unwrap_or(0.0) * own.length() / 3.0;
            let alike = |sum: &Vec3| sum.normalize().dot(own.normalize()) > SMOOTH_COSINE;
            match sums[..count].iter().position(alike) {
                Some(k) => sums[k] += own,
                None if count < NORMALS => {
                    sums[count] = own;
                    count += 1;
                }
                // A fourth direction goes to the one that is nearest.
                None => {
                    let cosine = |k: &usize| sums[*k].normalize().dot(own);
                    let nearest = (0..NORMALS).max_by(|a, b| cosine(a).total_cmp(&cosine(b)));
                    sums[nearest.unwrap_or(0)] += own;
                }
            }
        }
        (sums.map(|s| s.normalize_or_zero()), count, area)
    }
}

fn sorted(mut nodes: [u32; 3]) -> [u32; 3] {
    nodes.sort_unstable();
    nodes
}

/// The elements that an aligned contact's first side fills.
fn elements(
    mesh: &Mesh,
    contact: &Contact,
    particles: &Particles,
    order: &Order,
) -> Result<Vec<bool>, ContactError> {
    let mut inside = vec![false; mesh.tets.len()];
    for (e, inside) in inside.iter_mut().enumerate() {
        let held = order.inside(e).iter().map(|&p| p as usize);
        let own = |&p: &usize| contact.bodies[0].contains(&usize::from(particles.body[p]));
        let volume: f64 = held.filter(own).map(|p| particles.volume[p]).sum();
        *inside = volume > 0.0;
        if *inside && (volume / mesh.volumes[e] - 1.0).abs() > 1e-9 {
            return Err(ContactError::NotOnFaces {
                contact: contact.name.clone(),
                element: e as u32,
            });
        }
    }
    Ok(inside)
}

/// A rigid body has a velocity of its own.
fn check_rigid(plan: &Plan) -> Result<(), ContactError> {
    let sides = plan.contacts.iter().flat_map(|c| &c.bodies);
    let mut several = sides.filter(|side| side.len() > 1).flatten();
    match several.find(|&&body| is_rigid(plan, body)) {
        None => Ok(()),
        Some(&body) => Err(ContactError::RigidWithOthers {
            body: plan.bodies[body].name.clone(),
        }),
    }
}
