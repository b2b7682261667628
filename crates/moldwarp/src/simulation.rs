//! A plan being computed.

use crate::Vec3;
use crate::bodies;
use crate::boundary::{
    Absorbing, Constraints, LoadPoint, Outflow, Outflown, Surroundings, load_points, surface_nodes,
};
use crate::contact::{Contacts, Fields, is_rigid};
use crate::lanes::Simd;
use crate::measure::{Ledger, Part, Probes, Profile, Scale, Watch};
use crate::mesh::{Driven, Follower, NONE, Walls};
use crate::parallel;
use crate::particles::initial_stress::{self, Ground};
use crate::particles::{Order, Particles, Seed, SeedingError};
use crate::plan::{LoadKind, Plan, Quantity, Target};
use crate::stages::moduli;
use crate::step::{
    Active, Answers, Cells, Grid, Guests, Node, Pending, Reference, Remembered, Shared,
    TimeStepError,
};
use crate::stop::{SetupError, Stop};
use crate::switches::Switches;

/// Where in time a simulation is.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clock {
    pub time: f64,
    pub steps: u64,
    pub stage: usize,
    pub stage_time: f64,
    pub stage_steps: u64,
    /// Last step, s.
    pub dt: f64,
    /// Coming step, s.
    pub next: f64,
    /// Longest stable step of the stage so far, s.
    pub longest: f64,
    /// Whether bodies were given velocities, came or went, or boundaries switched, when the stage began: what
    /// moves in held directions has to stop.
    pub new_constraints: bool,
}

/// A plan, the state of its bodies, and the books.
#[derive(Clone, Debug)]
pub struct Simulation {
    pub(crate) plan: Plan,
    pub(crate) particles: Particles,
    /// Seeds of the bodies that stages add.
    pub(crate) reserve: Vec<Seed>,
    pub(crate) order: Order,
    pub(crate) walls: Walls,
    pub(crate) fields: Fields,
    pub(crate) contacts: Contacts,
    pub(crate) active: Active,
    pub(crate) guests: Guests,
    pub(crate) nodes: Vec<Node>,
    pub(crate) shared: Shared,
    pub(crate) cells: Cells,
    pub(crate) constraints: Constraints,
    pub(crate) absorbing: Absorbing,
    pub(crate) outflow: Outflow,
    pub(crate) outflown: Outflown,
    /// Number of particles that there should be.
    pub(crate) present: u64,
    pub(crate) follower: Follower,
    pub(crate) driven: Driven,
    pub(crate) loads: Vec<LoadPoint>,
    /// λ, G and E_c of each body, Pa.
    pub(crate) elasticity: Vec<[f64; 3]>,
    /// Where a mesh moves through ground with an initial stress.
    pub(crate) reference: Option<Reference>,
    pub(crate) ledger: Ledger,
    pub(crate) probes: Probes,
    pub(crate) clock: Clock,
    /// Gravity now, m/s².
    pub(crate) gravity: Vec3,
    pub(crate) switches: Switches,
    pub(crate) watch: Watch,
    pub(crate) scale: Scale,
    /// What particles have not received yet.
    pub(crate) pending: Option<Pending>,
    /// Σ ½ m v² of the particles at the end of the last drift, J, if it is known.
    pub(crate) kinetic: Option<f64>,
    /// What external laws have said in this step.
    pub(crate) answers: Answers,
    pub(crate) simd: Simd,
    pub(crate) profile: Profile,
    /// What was to be remembered of nodes before they were numbered anew, and their keys, kept so that no step allocates.
    pub(crate) remembered: Vec<Remembered>,
    pub(crate) spare_numbers: Vec<u32>,
}

impl Simulation {
    /// Fills the bodies with particles and gets the first stage going.
    pub fn new(plan: Plan) -> Result<Simulation, SetupError> {
        if plan.stages.is_empty() {
            return Err(SetupError::NoStage);
        }
        check_reactions(&plan)?;
        let (mut particles, reserve) = bodies::at_the_start(&plan)?;
        let mut order = Order::default();
        let fields = Fields::new(plan.bodies.len(), &plan.contacts, |b| is_rigid(&plan, b));
        order.find(&particles, plan.mesh.tets.len(), &fields);
        let contacts = Contacts::new(&plan, &fields, &particles, &order)?;
        let (loads, ground) = ground(&plan, &mut particles, &order, &contacts)?;
        let reference = reference(&plan, ground);
        let mut probes = Probes::new(&plan, &particles, &order);
        let found = probes.find_contacts(&plan, &contacts);
        found.map_err(|probe| SetupError::NoContact { probe })?;
        let elasticity = plan
            .bodies
            .iter()
            .map(|body| moduli(&plan.materials[body.material].model))
            .collect();
        let present = particles.len() as u64;
        let mut simulation = Simulation {
            gravity: plan.gravity,
            switches: Switches::new(&plan),
            plan,
            particles,
            reserve,
            order,
            walls: Walls::default(),
            fields,
            contacts,
            active: Active::default(),
            guests: Guests::default(),
            nodes: Vec::new(),
            shared: Shared::default(),
            cells: Cells::default(),
            constraints: Constraints::default(),
            absorbing: Absorbing::default(),
            outflow: Outflow::default(),
            outflown: Outflown::default(),
            present,
            follower: Follower::default(),
            driven: Driven::default(),
            loads,
            elasticity,
            reference,
            ledger: Ledger::default(),
            probes,
            clock: Clock::default(),
            watch: Watch::default(),
            scale: Scale::default(),
            pending: None,
            kinetic: None,
            answers: Answers::default(),
            simd: Simd::default(),
            profile: Profile::default(),
            remembered: Vec::new(),
            spare_numbers: Vec::new(),
        };
        bodies::check_probes(&simulation)?;
        simulation.scale = Scale::new(&simulation);
        simulation.reorder();
        simulation.begin_stage().map_err(|stop| match stop {
            Stop::TimeStep { error, .. } => SetupError::TimeStep(error),
            Stop::NotFinite { .. } => SetupError::TimeStep(TimeStepError::NotFinite),
            Stop::Motion { error, .. } => SetupError::Motion(error),
            Stop::NoRoom {
                body: second,
                other: first,
                element,
                ..
            } => SetupError::Seeding(SeedingError::Overlap {
                first,
                second,
                element,
            }),
            Stop::LeftTheMesh { .. }
            | Stop::PassedAFace { .. }
            | Stop::TurnedOver { .. }
            | Stop::Degenerate { .. }
            | Stop::Empty { .. }
            | Stop::Crushed { .. }
            | Stop::Law { .. }
            | Stop::NotAtRest { .. } => {
                unreachable!("nothing has moved yet")
            }
        })?;
        // They are among the particles now.
        simulation.plan.inherited = Particles::default();
        simulation.settle();
        Ok(simulation)
    }

    /// Has the step use these instructions; without it, it uses the best that there are. Results are
    /// the same.
    pub fn use_simd(&mut self, simd: Simd) {
        self.simd = simd;
    }

    /// Where the time has gone.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// What was done since the last step was output: the profile keeps its time apart.
    pub fn wrote_output(&mut self) {
        self.profile.lap(Part::Output);
    }

    /// Gives every particle the velocity (m/s) that `velocity` has at its position (m). For the
    /// start of a run, before the first step.
    pub fn set_velocity(&mut self, velocity: impl Fn(Vec3) -> Vec3) -> Result<(), Stop> {
        self.particles.velocity = self.particles.position.iter().map(velocity).collect();
        self.ledger = Ledger::default();
        self.gave_velocities();
        self.clock.next = self.kick(0.0, self.remaining())?;
        self.settle();
        Ok(())
    }

    /// One time step, and what has to be done if it is the last of a stage.
    pub fn step(&mut self) -> Result<(), Stop> {
        let stepped = self.step_and(|_| ());
        self.settle();
        stepped
    }

    /// The same, but that particles' velocities wait for [`settle`](Simulation::settle): they receive them in passing in
    /// the next step. `ended` sees the end of a stage, settled, before the next one changes anything.
    pub fn step_and(&mut self, ended: impl FnOnce(&Simulation)) -> Result<(), Stop> {
        if self.finished() {
            return Ok(());
        }
        // A law of a program is asked by the thread that makes the step: only that may be heard, or interrupted.
        let is_over = match (self.plan.materials.iter()).any(|m| m.model.external().is_some()) {
            true => self.drift_and_kick()?,
            false => parallel::inside(|| self.drift_and_kick())?,
        };
        if !is_over {
            return Ok(());
        }
        self.settle();
        self.profile.lap(Part::Between);
        ended(self);
        self.profile.lap(Part::Output);
        self.clock.stage += 1;
        if self.finished() {
            Ok(())
        } else {
            self.begin_stage()
        }
    }

    /// Returns whether the stage is over.
    fn drift_and_kick(&mut self) -> Result<bool, Stop> {
        let dt = self.clock.next;
        self.drift(dt)?;
        self.clock.steps += 1;
        self.clock.stage_steps += 1;
        self.clock.time += dt;
        self.clock.stage_time += dt;
        self.clock.dt = dt;
        let at_rest = self.at_rest();
        let remaining = self.remaining();
        let is_over = remaining <= 0.0 || at_rest;
        let limit = if is_over { 0.0 } else { remaining };
        let next = parallel::inside(|| self.kick(0.5 * dt, limit))?;
        if !is_over {
            self.clock.next = next;
        } else if !at_rest {
            self.has_to_be_at_rest()?;
        }
        Ok(is_over)
    }

    /// Brings particles into the order of their elements and numbers the active cells and nodes anew.
    pub(crate) fn reorder(&mut self) {
        self.remembered.clear();
        (self.remembered).extend(self.shared.remember(&self.nodes));
        std::mem::swap(&mut self.active.keys, &mut self.spare_numbers);
        let mesh = &self.plan.mesh;
        let away = (self.guests).begin_to_leave(&mut self.particles, &mut self.order.filed);
        self.order
            .find(&self.particles, mesh.tets.len(), &self.fields);
        let margin = self.may_have_guests();
        let grid = Grid {
            mesh,
            walls: &self.walls,
            fields: &self.fields,
            margin,
        };
        self.active.rebuild(&grid, &mut self.order);
        let away = away.then(|| self.guests.places(self.particles.len()));
        self.order.begin_to_move(away.into_iter().flatten());
        self.guests.clear();
        let Simulation {
            plan,
            particles,
            order,
            active,
            nodes,
            shared,
            cells,
            ..
        } = self;
        let active = &*active;
        let guests = match margin {
            true => Guests::most_tiles(particles.len(), active.own_tiles()),
            false => 0,
        };
        // Particles move while cells learn of their nodes: the latter takes one thread.
        rayon::join(
            || order.settle(particles),
            || {
                cells.renew(active, guests);
                nodes.clear();
                nodes.resize(active.nodes.len(), Node::default());
                shared.renew(nodes);
                for (own, &key) in self.remembered.iter().zip(&self.spare_numbers) {
                    if let Some(&slot) = active.slot_of_key.get(key as usize)
                        && slot != NONE
                    {
                        shared.recall(nodes, slot as usize, own);
                    }
                }
                shared.place(active, &plan.mesh);
            },
        );
        let destination = &self.order.destination;
        for point in &mut self.loads {
            point.particle = destination[point.particle as usize];
        }
        self.probes.reorder(destination);
        self.contacts.find(&self.active);
        if margin {
            self.guests.make_room(&mut self.particles, &mut self.order);
            self.active.make_room(guests);
            self.cells.make_room(guests);
        }
    }
}

/// The initial stress of all particles, the points of the loads, and the ground.
fn ground(
    plan: &Plan,
    particles: &mut Particles,
    order: &Order,
    contacts: &Contacts,
) -> Result<(Vec<LoadPoint>, Option<Ground>), SetupError> {
    let ground = plan.initial_stress.as_ref().map(|setting| {
        let switched = (&plan.boundaries, &plan.loads);
        let surfaces = switched.0.iter().map(|b| &b.surfaces);
        let surfaces = surfaces.chain(switched.1.iter().map(|l| &l.surfaces));
        let mut held = vec![false; plan.mesh.nodes.len()];
        for n in surfaces.flat_map(|s| surface_nodes(&plan.mesh, s)) {
            held[n as usize] = true;
        }
        // A structure in the ground holds it.
        for n in contacts.nodes_of_faces() {
            held[n as usize] = true;
        }
        let filled = (&*particles, order);
        let soils = (&plan.bodies[..], &plan.materials[..]);
        let held = |n: u32| held[n as usize];
        Ground::new(setting, &plan.mesh, soils, plan.gravity, filled, held).map(|g| (g, setting))
    });
    let ground = ground.transpose()?;
    if let Some((ground, setting)) = &ground {
        initial_stress::apply(ground, setting, particles, &plan.bodies, &plan.materials)?;
    }
    let k0 = |body: usize| ground.as_ref().and_then(|g| g.1.k0[body]);
    for load in plan
        .loads
        .iter()
        .filter(|l| l.kind == LoadKind::InitialStress)
    {
        if k0(load.body).is_none() {
            return Err(SetupError::NoInitialStress {
                load: load.name.clone(),
                body: plan.bodies[load.body].name.clone(),
            });
        }
    }
    let surroundings = Surroundings {
        share: plan.symmetry.map_or(1.0, |s| s.share),
        up: -plan.gravity.normalize_or_zero(),
        stress: &|body, x| match (&ground, k0(body)) {
            (Some((ground, _)), Some(k0)) => ground.stress(x, k0),
            _ => [0.0; 6],
        },
    };
    let points = load_points(
        &plan.mesh,
        (plan.loads.iter().enumerate()).filter(|l| plan.there_at_the_start(l.1.body)),
        particles,
        order,
        &surroundings,
    )?;
    Ok((points, ground.map(|g| g.0)))
}

/// A mesh that moves needs a reference stress. Where it stays, particles are where their stresses
/// balance to begin with, and flow takes them to where the initial stress means nothing.
fn reference(plan: &Plan, ground: Option<Ground>) -> Option<Reference> {
    let setting = plan.initial_stress.as_ref()?;
    plan.mesh_motion.as_ref()?;
    Some(Reference {
        ground: ground?,
        k0: setting.k0.clone(),
        gravity: plan.gravity,
    })
}

fn check_reactions(plan: &Plan) -> Result<(), SetupError> {
    for probe in plan
        .probes
        .iter()
        .filter(|p| p.quantities.contains(&Quantity::Reaction))
    {
        let Target::Surface(s) = probe.target else {
            return Err(SetupError::NoReaction {
                probe: probe.name.clone(),
            });
        };
        if !plan.boundaries.iter().any(|b| b.surfaces.contains(&s)) {
            return Err(SetupError::NoReaction {
                probe: probe.name.clone(),
            });
        }
    }
    Ok(())
}
