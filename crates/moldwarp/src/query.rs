//! What can be asked of a simulation.

use crate::Vec3;
use crate::measure::{Energies, Probes};
use crate::mesh::Mesh;
use crate::particles::Particles;
use crate::plan::{Contact, Plan};
use crate::simulation::Simulation;
use crate::step::Node;
use crate::tensor::Voigt;

/// Fields over all nodes of the mesh; zero where there is no material.
#[derive(Clone, Debug)]
pub struct NodeFields {
    /// m/s.
    pub velocity: Vec<Vec3>,
    /// kg.
    pub mass: Vec<f64>,
    /// Force of boundaries on the material, N.
    pub reaction: Vec<Vec3>,
}

impl Simulation {
    /// Whether all stages are done.
    pub fn finished(&self) -> bool {
        self.clock.stage >= self.plan.stages.len()
    }

    /// Time since the start, s.
    pub fn time(&self) -> f64 {
        self.clock.time
    }

    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.clock.steps
    }

    /// Length of the last step, s; 0 before the first.
    pub fn time_step(&self) -> f64 {
        self.clock.dt
    }

    /// Length of the coming step, s.
    pub fn next_time_step(&self) -> f64 {
        self.clock.next
    }

    /// Courant number times the critical step of the present state, s, whatever is forced.
    pub fn stable_time_step(&self) -> f64 {
        self.plan.numerics.courant * crate::step::critical(self)
    }

    /// Number of the stage, counted from 0; the number of stages when all are done.
    pub fn stage(&self) -> usize {
        self.clock.stage
    }

    /// Time since the stage's start, s.
    pub fn stage_time(&self) -> f64 {
        self.clock.stage_time
    }

    /// Steps since the stage's start.
    pub fn stage_steps(&self) -> u64 {
        self.clock.stage_steps
    }

    /// The plan, with the mesh as it is now.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The mesh as it is now.
    pub fn mesh(&self) -> &Mesh {
        &self.plan.mesh
    }

    /// # Panics
    ///
    /// If they are still to receive a kick: see [`settle`](Simulation::settle).
    pub fn particles(&self) -> &Particles {
        let settled = self.pending.is_none() && self.guests.twice() == 0;
        assert!(settled, "particles are settled");
        &self.particles
    }

    /// Number of particles.
    pub fn particle_count(&self) -> usize {
        self.particles.len() - self.guests.twice()
    }

    /// Number of elements that take part in the step.
    pub fn active_elements(&self) -> usize {
        self.active.cell_count()
    }

    /// Energies since the start, J.
    pub fn energies(&self) -> Energies {
        self.ledger.energies()
    }

    /// The energy turned over so far, J, against which errors are judged.
    pub fn energy_turned_over(&self) -> f64 {
        self.ledger.turned_over()
    }

    /// What has left through outflow surfaces.
    pub fn outflown(&self) -> crate::boundary::Outflown {
        self.outflown
    }

    /// Number of particles that are missing: those at the start and added by stages, without those removed
    /// by stages and let out, against those that are there. Any is a bug.
    pub fn lost_particles(&self) -> u64 {
        self.present.abs_diff(self.particle_count() as u64)
    }

    /// Particles that were put back onto their side of aligned contacts.
    pub fn projections(&self) -> crate::contact::Projections {
        self.contacts.projections
    }

    /// Number of particles in elements that the structure of an aligned contact fills and that is not
    /// their own.
    pub fn foreign_particles(&self) -> usize {
        let foreign = |p: &usize| {
            let field = self.fields.of(self.particles.body[*p]);
            self.contacts.is_foreign(field, self.particles.element[*p])
        };
        (0..self.particles.len()).filter(foreign).count()
    }

    /// Where the moving mesh will hold fewest particles, should it go `travel` metres on: half the way
    /// that is ahead of its moving zone, if nothing is given. None if the mesh does not move.
    pub fn fewest_visited(&self, travel: Option<f64>) -> Option<crate::mesh::Visit> {
        let (mesh, driver) = (&self.plan.mesh, self.plan.mesh_motion.as_ref()?.driver);
        let travel = travel.unwrap_or_else(|| self.driven.room(mesh));
        let body = |p: usize| usize::from(self.particles.body[p]);
        let own = |e: u32| self.particles_in(e).any(|p| body(p) == driver);
        let driven: Vec<bool> = (0..mesh.tets.len() as u32).map(own).collect();
        let inside = |e: u32| self.particles_in(e).count();
        self.driven
            .fewest(mesh, travel, |e| driven[e as usize], inside)
    }

    /// What each contact of the plan does now.
    pub fn contact_tallies(&self) -> &[crate::contact::Tally] {
        &self.contacts.tallies
    }

    /// Sum of the nodal masses, kg.
    pub fn nodal_mass(&self) -> f64 {
        self.nodes.iter().map(|n| n.mass).sum()
    }

    /// Name and unit of each probe's columns.
    pub fn probe_columns(&self) -> Vec<(String, &'static str)> {
        Probes::columns(&self.plan)
    }

    /// Appends the probes' values, in the order of the columns.
    pub fn probe_values(&self, out: &mut Vec<f64>) {
        self.probes.values(self, out);
    }

    /// Name and unit of each contact's columns.
    pub fn contact_columns(&self) -> Vec<(String, &'static str)> {
        let contacts = self.plan.contacts.iter();
        contacts.flat_map(Contact::columns).collect()
    }

    /// Appends what contacts do, in the order of the columns: forces on their first sides, means over
    /// the last kick.
    pub fn contact_values(&self, out: &mut Vec<f64>) {
        for tally in &self.contacts.tallies {
            out.extend(tally.normal.to_array());
            out.extend(tally.tangential.to_array());
            out.extend([tally.sticking, tally.sliding, tally.open].map(f64::from));
        }
    }

    /// Force of aligned contacts on their first sides at nodes of the mesh, ascending, each with the
    /// part of it that counts, N.
    pub(crate) fn contact_force(&self, shares: &[(u32, f64)]) -> Vec3 {
        let mut force = Vec3::ZERO;
        for meeting in &self.contacts.meetings {
            let (Some(number), slot) = (meeting.contact, meeting.slots[0] as usize) else {
                continue;
            };
            let node = self.active.nodes[slot];
            if let Ok(at) = shares.binary_search_by_key(&node, |s| s.0) {
                // Forces are those on b.
                let first = self.contacts.is_first(number, self.active.field(slot));
                let sign = if first { -1.0 } else { 1.0 };
                force += (meeting.normal_force + meeting.friction) * (sign * shares[at].1);
            }
        }
        force
    }

    /// Fields over all nodes of the mesh.
    pub fn node_fields(&self) -> NodeFields {
        let count = self.plan.mesh.nodes.len();
        let zero = vec![Vec3::ZERO; count];
        let mut fields = NodeFields {
            velocity: zero.clone(),
            mass: vec![0.0; count],
            reaction: zero,
        };
        for (node, &n) in self.nodes.iter().zip(&self.active.nodes) {
            // Of all parts of a node the velocity is the mean, by mass.
            let (velocity, mass) = (
                &mut fields.velocity[n as usize],
                &mut fields.mass[n as usize],
            );
            *velocity = if *mass > 0.0 {
                (*velocity * *mass + node.grid_velocity * node.mass) / (*mass + node.mass)
            } else {
                node.grid_velocity
            };
            *mass += node.mass;
            fields.reaction[n as usize] += node.reaction + node.absorbing;
        }
        fields
    }

    /// Places of a mesh node's parts that particles touch; more than one if a wall splits it or bodies
    /// meet there.
    pub(crate) fn slots(&self, mesh_node: u32) -> impl Iterator<Item = usize> + '_ {
        let (mesh, walls) = (&self.plan.mesh, &self.walls);
        let nodes = walls.count(mesh);
        let fields = (0..self.fields.count()).map(move |field| field * nodes);
        let keys = fields.flat_map(move |first| {
            let grid = walls.grid_nodes(mesh, mesh_node);
            grid.map(move |g| first + g as usize)
        });
        let slots = keys.map(|key| self.active.slot_of_key[key] as usize);
        slots.filter(|&slot| slot < self.nodes.len())
    }

    /// A mesh node, if particles touch it: the first of its parts if there are more.
    pub(crate) fn node(&self, mesh_node: u32) -> Option<&Node> {
        self.slots(mesh_node).next().map(|slot| &self.nodes[slot])
    }

    /// Force of all boundaries on the material at a mesh node, N.
    pub(crate) fn reaction(&self, mesh_node: u32) -> Vec3 {
        let nodes = self.slots(mesh_node).map(|slot| &self.nodes[slot]);
        nodes.map(|n| n.reaction + n.absorbing).sum()
    }

    /// Places of the particles in an element.
    pub(crate) fn particles_in(&self, e: u32) -> impl Iterator<Item = usize> {
        let filed = self.order.inside(e as usize).iter().map(|&p| p as usize);
        let stayed = filed.filter(move |&p| self.particles.element[p] == e);
        stayed.chain(self.guests.inside(e))
    }

    /// Mean stress of the particles in an element, Pa, if there are any.
    pub(crate) fn element_stress(&self, e: u32) -> Option<Voigt> {
        let (mut stress, mut volume) = ([0.0; 6], 0.0);
        for p in self.particles_in(e) {
            crate::tensor::add_scaled(
                &mut stress,
                &self.particles.stress.at(p),
                self.particles.volume[p],
            );
            volume += self.particles.volume[p];
        }
        (volume > 0.0).then(|| stress.map(|s| s / volume))
    }

    /// Σ N_i a_i at a particle, m/s².
    pub(crate) fn acceleration_at(&self, p: usize) -> Vec3 {
        let e = self.particles.element[p] as usize;
        let n = self.plan.mesh.barycentric(e, self.particles.position.at(p));
        let cell = self.active.cell(e, self.fields.of(self.particles.body[p]));
        let cell = cell.expect("the element of a particle is a cell of its field");
        let corners = self.active.cell_nodes[cell];
        let acceleration = |i: usize| self.nodes[corners[i] as usize].acceleration;
        (0..4).map(|i| acceleration(i) * n[i]).sum()
    }
}
