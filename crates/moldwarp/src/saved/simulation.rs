//! The whole state, section by section.

use super::{Broken, Saved, Section, load};
use crate::Vec3;
use crate::boundary::LoadPoint;
use crate::contact::Contacts;
use crate::lanes::Simd;
use crate::measure::Profile;
use crate::particles::{Order, Particles};
use crate::plan::Plan;
use crate::simulation::Simulation;
use crate::stages::moduli;
use crate::step::{Active, Answers, Cells, Guests, Known, Node, Shared, homes};

/// Time in s and number of steps of a state that [`Simulation::save`] has handed out.
///
/// # Errors
///
/// If there is no such section.
pub fn instant<'a>(section: impl Fn(&str) -> Option<&'a [u8]>) -> Result<(f64, u64), Broken> {
    let clock = section("clock").ok_or_else(|| Broken::new("clock"))?;
    let clock: crate::simulation::Clock = load(clock)?;
    Ok((clock.time, clock.steps))
}

impl Simulation {
    /// Hands out everything that the simulation needs to go on, in sections with names; the plan is
    /// not among it.
    ///
    /// # Errors
    ///
    /// Those of `section`, the first of which is the last call.
    pub fn save<E>(
        &self,
        mut section: impl FnMut(&'static str, Section) -> Result<(), E>,
    ) -> Result<(), E> {
        assert_eq!(self.guests.twice(), 0, "particles are settled");
        let Simulation {
            plan,
            particles,
            reserve,
            // Particles are in order, but for guests.
            order,
            walls,
            fields,
            contacts,
            // Numbered from the particles' elements.
            active: _,
            guests,
            nodes,
            // Taken from the nodes, or written by each step before it is read.
            shared: _,
            cells,
            constraints,
            absorbing,
            outflow,
            outflown,
            present,
            follower,
            driven,
            loads,
            // Of the bodies' materials.
            elasticity: _,
            reference,
            ledger,
            probes,
            clock,
            gravity,
            switches,
            watch,
            scale,
            answers: _,
            simd: _,
            profile: _,
            remembered: _,
            spare_numbers: _,
            // Particles have received all, and the next drift adds up their energy.
            pending,
            kinetic: _,
        } = self;
        assert!(pending.is_none(), "particles are settled");
        let materials: Vec<usize> = plan.bodies.iter().map(|b| b.material).collect();
        section("clock", Section::new(clock))?;
        section("particles", Section::new(particles))?;
        section("guests", Section::new(&guests.known(order)))?;
        section("mesh nodes", Section::new(&plan.mesh.nodes))?;
        section("materials", Section::new(&materials))?;
        section("reserve", Section::new(reserve))?;
        section("walls", Section::new(walls))?;
        section("fields", Section::new(fields))?;
        section("contacts", Section::new(contacts))?;
        section("nodes", Section::new(nodes))?;
        section("cells", Section::new(cells))?;
        section("constraints", Section::new(constraints))?;
        section("absorbing", Section::new(absorbing))?;
        section("outflow", Section::new(outflow))?;
        section("outflown", Section::new(outflown))?;
        section("present", Section::new(present))?;
        section("follower", Section::new(follower))?;
        section("driven", Section::new(driven))?;
        section("loads", Section::new(loads))?;
        section("reference", Section::new(reference))?;
        section("ledger", Section::new(ledger))?;
        section("probes", Section::new(probes))?;
        section("gravity", Section::new(gravity))?;
        section("switches", Section::new(switches))?;
        section("watch", Section::new(watch))?;
        section("scale", Section::new(scale))
    }

    /// The simulation that was saved. `plan` is that with which it was set up, but for the ends of
    /// stages, which may have changed; `section` finds a section by its name.
    ///
    /// # Errors
    ///
    /// If the sections do not hold a simulation of this plan.
    pub fn restore<'a>(
        mut plan: Plan,
        section: impl Fn(&'static str) -> Option<&'a [u8]>,
    ) -> Result<Simulation, Broken> {
        let from = Sections(section);
        let materials: Vec<usize> = from.load("materials")?;
        let known = |m: &usize| *m < plan.materials.len();
        check(
            "materials",
            materials.len() == plan.bodies.len() && materials.iter().all(known),
        )?;
        for (body, material) in plan.bodies.iter_mut().zip(materials) {
            body.material = material;
        }
        let elasticity = (plan.bodies.iter())
            .map(|body| moduli(&plan.materials[body.material].model))
            .collect();
        move_mesh(&mut plan, from.load("mesh nodes")?)?;
        let particles: Particles = from.load("particles")?;
        check_particles(&particles, &plan)?;
        let contacts: Contacts = from.load("contacts")?;
        let nodes: Vec<Node> = from.load("nodes")?;
        let cells: Cells = from.load("cells")?;
        let mut simulation = Simulation {
            particles,
            reserve: from.load("reserve")?,
            order: Order::default(),
            walls: from.load("walls")?,
            fields: from.load("fields")?,
            contacts: Contacts::default(),
            active: Active::default(),
            guests: Guests::default(),
            nodes: Vec::new(),
            shared: Shared::default(),
            cells: Cells::default(),
            constraints: from.load("constraints")?,
            absorbing: from.load("absorbing")?,
            outflow: from.load("outflow")?,
            outflown: from.load("outflown")?,
            present: from.load("present")?,
            follower: from.load("follower")?,
            driven: from.load("driven")?,
            loads: from.load("loads")?,
            elasticity,
            reference: from.load("reference")?,
            ledger: from.load("ledger")?,
            probes: from.load("probes")?,
            clock: from.load("clock")?,
            gravity: from.load("gravity")?,
            switches: from.load("switches")?,
            watch: from.load("watch")?,
            scale: from.load("scale")?,
            pending: None,
            kinetic: None,
            answers: Answers::default(),
            simd: Simd::default(),
            profile: Profile::default(),
            remembered: Vec::new(),
            spare_numbers: Vec::new(),
            plan,
        };
        simulation.check_numbers()?;
        simulation.number(from.load("guests")?)?;
        simulation.take_kick(nodes, cells)?;
        simulation.contacts = contacts;
        Ok(simulation)
    }

    /// That what the numbering meets is there. All else is taken on trust: a file that has been changed since
    /// it was written has another checksum.
    fn check_numbers(&self) -> Result<(), Broken> {
        let count = self.particles.len();
        check("fields", self.fields.fit(self.plan.bodies.len()))?;
        check("walls", self.walls.fit(&self.plan.mesh))?;
        check("probes", self.probes.fit(&self.plan, count))?;
        let there = |point: &LoadPoint| {
            (point.particle as usize) < count && (point.load as usize) < self.plan.loads.len()
        };
        check("loads", self.loads.iter().all(there))
    }

    /// Numbers cells and nodes as they were: particles are in order already, but for guests.
    fn number(&mut self, guests: Known) -> Result<(), Broken> {
        let (elements, count) = (self.plan.mesh.tets.len(), self.particles.len());
        let [from, into, _, filed] = &guests;
        let homes: Vec<usize> = homes(from, count).collect();
        check("guests", homes.len() == filed.len())?;
        let known = |&e: &u32| (e as usize) < elements;
        check("guests", filed.iter().chain(into).all(known))?;
        // Those that are guests lie under other elements than their own.
        let own = &mut self.particles.element;
        let replaced = homes.iter().zip(filed);
        let own: Vec<u32> = replaced
            .map(|(&p, &e)| std::mem::replace(&mut own[p], e))
            .collect();
        self.reorder();
        let mut places = self.order.destination.iter().zip(0..);
        check("particles", places.all(|(a, b)| *a == b))?;
        for (&p, e) in homes.iter().zip(own) {
            self.particles.element[p] = e;
        }
        check("guests", self.expect(&guests))
    }

    /// Takes over what the last kick has left at nodes and in cells.
    fn take_kick(&mut self, nodes: Vec<Node>, kick: Cells) -> Result<(), Broken> {
        let count = self.active.tiles.len();
        check("nodes", nodes.len() == self.active.nodes.len())?;
        let all_or_none = |kept: usize| kept == count || kept == 0;
        check("cells", kick.sums.len() == count)?;
        check("cells", kick.fills.len() == count)?;
        check("cells", all_or_none(kick.medium.len()))?;
        check("cells", all_or_none(kick.forces.len()))?;
        let pairs = self.cells.mass.values.len();
        check("pairs of nodes", kick.mass.values.len() == pairs)?;
        self.shared.renew(&nodes);
        self.nodes = nodes;
        // The others have their sizes from the numbering.
        let Cells {
            sums,
            medium,
            fills,
            forces,
            mass,
            shortest,
            ..
        } = kick;
        self.cells.sums = sums;
        self.cells.medium = medium;
        self.cells.fills = fills;
        self.cells.forces = forces;
        self.cells.mass.values = mass.values;
        self.cells.shortest = shortest;
        Ok(())
    }
}

struct Sections<F>(F);

impl<'a, F: Fn(&'static str) -> Option<&'a [u8]>> Sections<F> {
    fn load<T: Saved>(&self, name: &'static str) -> Result<T, Broken> {
        let bytes = (self.0)(name).ok_or_else(|| Broken::new(name))?;
        load(bytes).map_err(|e| Broken::new(format!("{name}: {}", e.what)))
    }
}

fn check(what: &str, right: bool) -> Result<(), Broken> {
    match right {
        true => Ok(()),
        false => Err(Broken::new(what)),
    }
}

/// Geometry is always that of the nodes where they are.
fn move_mesh(plan: &mut Plan, nodes: Vec<Vec3>) -> Result<(), Broken> {
    check("mesh nodes", nodes.len() == plan.mesh.nodes.len())?;
    plan.mesh.nodes = nodes;
    plan.mesh.update_geometry();
    Ok(())
}

/// That all particles are in elements of the mesh and of bodies of the plan.
fn check_particles(particles: &Particles, plan: &Plan) -> Result<(), Broken> {
    let (count, elements) = (particles.len(), plan.mesh.tets.len());
    let inside = |e: &u32| (*e as usize) < elements;
    let known = |b: &u16| usize::from(*b) < plan.bodies.len();
    let right = particles.element.iter().all(inside) && particles.body.iter().all(known);
    check(
        "particles",
        right && particles.element.len() == count && particles.body.len() == count,
    )
}
