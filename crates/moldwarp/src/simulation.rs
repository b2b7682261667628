//! A plan being computed.

use crate::boundary::{Absorbing, Constraints, LoadError, LoadPoint, load_points};
use crate::measure::{Ledger, Probes};
use crate::mesh::{Face, Follower};
use crate::particles::{Order, Particles, SeedingError, seed};
use crate::plan::{BoundaryKind, Plan, Quantity, Target, Until};
use crate::step::{Active, CellForce, CellStrain, CellSums, Node, TimeStepError};
use crate::{Mat3, Vec3};

/// Why a plan cannot be computed.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum SetupError {
    #[error(transparent)]
    Seeding(#[from] SeedingError),
    #[error(transparent)]
    Load(#[from] LoadError),
    #[error(transparent)]
    TimeStep(#[from] TimeStepError),
    #[error("probe `{probe}` asks for a reaction, but is no surface that carries a boundary")]
    NoReaction { probe: String },
    #[error("there is no stage")]
    NoStage,
}

/// Why a simulation had to stop before its end.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum Stop {
    #[error(
        "particle {id} of body `{body}` left the mesh at {position} m, {time:e} s after the start \
         in stage `{stage}`: give it room, or check boundaries, loads and stiffness"
    )]
    LeftTheMesh {
        id: u32,
        body: String,
        position: Vec3,
        stage: String,
        time: f64,
    },
    #[error(
        "element {element} (counted from 0) turned over as the mesh followed an absorbing \
         boundary, {time:e} s after the start in stage `{stage}`: the boundary yields by more than \
         an element; give it a virtual thickness, or larger elements next to it"
    )]
    TurnedOver {
        element: u32,
        stage: String,
        time: f64,
    },
    #[error("stage `{stage}`, {time:e} s after the start: {error}")]
    TimeStep {
        error: TimeStepError,
        stage: String,
        time: f64,
    },
}

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
    /// Whether bodies were given velocities when the stage began.
    pub given_velocities: bool,
}

/// What the step keeps per cell.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cells {
    pub sums: Vec<CellSums>,
    pub forces: Vec<CellForce>,
    pub strains: Vec<CellStrain>,
}

/// A plan, the state of its bodies, and the books.
#[derive(Clone, Debug)]
pub struct Simulation {
    pub(crate) plan: Plan,
    pub(crate) particles: Particles,
    pub(crate) order: Order,
    pub(crate) active: Active,
    pub(crate) nodes: Vec<Node>,
    pub(crate) cells: Cells,
    pub(crate) constraints: Constraints,
    pub(crate) absorbing: Absorbing,
    pub(crate) follower: Follower,
    pub(crate) loads: Vec<LoadPoint>,
    /// λ, G and E_c of each body, Pa.
    pub(crate) elasticity: Vec<[f64; 3]>,
    pub(crate) ledger: Ledger,
    pub(crate) probes: Probes,
    pub(crate) clock: Clock,
    /// Nodes before the last renumbering and their mesh nodes, kept so that no step allocates.
    spare_nodes: Vec<Node>,
    spare_numbers: Vec<u32>,
}

impl Simulation {
    /// Fills the bodies with particles and gets the first stage going.
    pub fn new(plan: Plan) -> Result<Simulation, SetupError> {
        if plan.stages.is_empty() {
            return Err(SetupError::NoStage);
        }
        check_reactions(&plan)?;
        let mut particles = seed(&plan.mesh, &plan.bodies, &plan.materials)?;
        let mut order = Order::default();
        order.sort(&mut particles, plan.mesh.tets.len());
        let share = plan.symmetry.map_or(1.0, |s| s.share);
        let loads = load_points(&plan.mesh, &plan.loads, &particles, &order.offsets, share)?;
        let probes = Probes::new(&plan, &particles, &order.offsets);
        let constraints = Constraints::new(&plan.mesh, &plan.boundaries);
        let absorbing = absorbing(&plan, &particles, &order.offsets);
        let follower = follower(&plan, &constraints);
        let elasticity = plan
            .bodies
            .iter()
            .map(|body| {
                let elastic = plan.materials[body.material].model.elasticity();
                [
                    elastic.lame(),
                    elastic.shear_modulus(),
                    elastic.constrained_modulus(),
                ]
            })
            .collect();
        let mut simulation = Simulation {
            plan,
            particles,
            order,
            active: Active::default(),
            nodes: Vec::new(),
            cells: Cells::default(),
            constraints,
            absorbing,
            follower,
            loads,
            elasticity,
            ledger: Ledger::default(),
            probes,
            clock: Clock::default(),
            spare_nodes: Vec::new(),
            spare_numbers: Vec::new(),
        };
        simulation.activate();
        simulation.begin_stage().map_err(|stop| match stop {
            Stop::TimeStep { error, .. } => SetupError::TimeStep(error),
            Stop::LeftTheMesh { .. } | Stop::TurnedOver { .. } => {
                unreachable!("nothing has moved yet")
            }
        })?;
        Ok(simulation)
    }

    /// Gives every particle the velocity (m/s) that `velocity` has at its position (m). For the
    /// start of a run, before the first step.
    pub fn set_velocity(&mut self, velocity: impl Fn(Vec3) -> Vec3) -> Result<(), Stop> {
        for (v, &x) in self
            .particles
            .velocity
            .iter_mut()
            .zip(&self.particles.position)
        {
            *v = velocity(x);
        }
        self.ledger = Ledger::default();
        self.given_velocities();
        self.clock.next = self.kick(0.0, self.remaining())?;
        Ok(())
    }

    /// One time step, and what has to be done if it is the last of a stage.
    pub fn step(&mut self) -> Result<(), Stop> {
        if self.finished() {
            return Ok(());
        }
        let dt = self.clock.next;
        self.drift(dt)?;
        self.clock.steps += 1;
        self.clock.stage_steps += 1;
        self.clock.time += dt;
        self.clock.stage_time += dt;
        self.clock.dt = dt;
        let remaining = self.remaining();
        if remaining > 0.0 {
            self.clock.next = self.kick(0.5 * dt, remaining)?;
            return Ok(());
        }
        self.kick(0.5 * dt, 0.0)?;
        self.clock.stage += 1;
        if self.finished() {
            Ok(())
        } else {
            self.begin_stage()
        }
    }

    fn begin_stage(&mut self) -> Result<(), Stop> {
        self.clock.stage_time = 0.0;
        self.clock.stage_steps = 0;
        let stage = &self.plan.stages[self.clock.stage];
        self.clock.given_velocities = false;
        if !stage.initial_velocities.is_empty() || self.clock.stage == 0 {
            for &(body, velocity) in &stage.initial_velocities {
                let of_body = self.particles.body.iter().map(|&b| usize::from(b) == body);
                for (v, _) in self
                    .particles
                    .velocity
                    .iter_mut()
                    .zip(of_body)
                    .filter(|p| p.1)
                {
                    *v = velocity;
                }
            }
            self.given_velocities();
        }
        self.clock.next = self.kick(0.0, self.remaining())?;
        Ok(())
    }

    fn given_velocities(&mut self) {
        self.clock.given_velocities = true;
        let p = &self.particles;
        let kinetic = p
            .mass
            .iter()
            .zip(&p.velocity)
            .map(|(m, v)| 0.5 * m * v.length_squared())
            .sum();
        self.ledger.give(kinetic);
    }

    /// Time left in the stage, s; infinite if it is limited by steps that are not yet done.
    fn remaining(&self) -> f64 {
        match self.plan.stages[self.clock.stage].until {
            Until::Duration(duration) => {
                let left = duration - self.clock.stage_time;
                if left > 1e-12 * duration { left } else { 0.0 }
            }
            Until::Steps(steps) if self.clock.stage_steps < steps => f64::INFINITY,
            Until::Steps(_) => 0.0,
        }
    }

    pub(crate) fn local_damping(&self) -> f64 {
        let stage = self.clock.stage.min(self.plan.stages.len() - 1);
        self.plan.stages[stage]
            .damping
            .unwrap_or(self.plan.numerics.damping)
    }

    /// Sorts particles by element and numbers the active cells and nodes anew.
    pub(crate) fn reorder(&mut self) {
        self.order
            .sort(&mut self.particles, self.plan.mesh.tets.len());
        for point in &mut self.loads {
            point.particle = self.order.destination[point.particle as usize];
        }
        self.probes.reorder(&self.order.destination);
        self.activate();
    }

    fn activate(&mut self) {
        // The last drift of nodes that stay active is still needed for its work.
        std::mem::swap(&mut self.nodes, &mut self.spare_nodes);
        std::mem::swap(&mut self.active.nodes, &mut self.spare_numbers);
        self.active.rebuild(&self.plan.mesh, &self.order.offsets);
        self.nodes.clear();
        self.nodes.resize(self.active.nodes.len(), Node::default());
        for (node, &mesh_node) in self.spare_nodes.iter().zip(&self.spare_numbers) {
            if let Some(new) = self
                .nodes
                .get_mut(self.active.slot_of_node[mesh_node as usize] as usize)
            {
                *new = *node;
            }
        }
        let cells = self.active.elements.len();
        self.cells.sums.resize(cells, CellSums::default());
        self.cells.forces.resize(cells, CellForce::default());
        self.cells.strains.resize(cells, CellStrain::default());
    }

    pub(crate) fn no_time_step(&self, error: TimeStepError) -> Stop {
        let stage = self.plan.stages[self.clock.stage].name.clone();
        Stop::TimeStep {
            error,
            stage,
            time: self.clock.time,
        }
    }

    pub(crate) fn turned_over(&self, element: u32) -> Stop {
        let stage = self.plan.stages[self.clock.stage].name.clone();
        Stop::TurnedOver {
            element,
            stage,
            time: self.clock.time,
        }
    }

    pub(crate) fn left_the_mesh(&self, particle: usize) -> Stop {
        Stop::LeftTheMesh {
            id: self.particles.id[particle],
            body: self.plan.bodies[usize::from(self.particles.body[particle])]
                .name
                .clone(),
            position: self.particles.position[particle],
            stage: self.plan.stages[self.clock.stage].name.clone(),
            time: self.clock.time,
        }
    }
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

fn absorbing(plan: &Plan, particles: &Particles, offsets: &[u32]) -> Absorbing {
    Absorbing::new(&plan.mesh, &plan.boundaries, |face: Face| {
        let sides = [Some(face), plan.mesh.across(face)];
        sides.into_iter().flatten().find_map(|side| {
            let first = offsets[side.element as usize];
            (first < offsets[side.element as usize + 1]).then(|| {
                let body = usize::from(particles.body[first as usize]);
                &plan.materials[plan.bodies[body].material]
            })
        })
    })
}

fn follower(plan: &Plan, constraints: &Constraints) -> Follower {
    let is_absorbing = |kind: &BoundaryKind| matches!(kind, BoundaryKind::Absorbing { .. });
    let surfaces: Vec<&[Face]> = plan
        .boundaries
        .iter()
        .filter(|b| is_absorbing(&b.kind))
        .flat_map(|b| b.surfaces.iter().map(|&s| &plan.mesh.surfaces[s].faces[..]))
        .collect();
    Follower::new(&plan.mesh, &surfaces, |n| {
        constraints.of(n).map_or(Mat3::IDENTITY, |c| c.free)
    })
}
