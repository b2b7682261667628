//! How stages begin and end.

use crate::Mat3;
use crate::boundary::{Absorbing, Constraints, Outflow, surface_nodes};
use crate::material::Material;
use crate::measure::Watch;
use crate::mesh::{Driven, Face, Follower, Mesh, MotionError, Walls, Zones};
use crate::plan::{Boundary, BoundaryKind, Plan, Until};
use crate::simulation::Simulation;
use crate::stop::Stop;

impl Simulation {
    /// Makes the changes of the stage that begins, and its first half kick.
    pub(crate) fn begin_stage(&mut self) -> Result<(), Stop> {
        self.clock.stage_time = 0.0;
        self.clock.stage_steps = 0;
        // Other bodies and materials may have other steps.
        self.clock.longest = 0.0;
        self.watch = Watch::default();
        let first = self.clock.stage == 0;
        let stage = &self.plan.stages[self.clock.stage];
        let switched = self.switches.begin(stage, self.clock.time);
        for &(body, material) in &stage.materials {
            self.plan.bodies[body].material = material;
            self.elasticity[body] = moduli(&self.plan.materials[material].model);
        }
        let (reset, gives) = (
            stage.reset_displacement,
            !stage.initial_velocities.is_empty(),
        );
        let other_bodies = !(stage.add.is_empty() && stage.remove.is_empty());
        if other_bodies {
            self.change_bodies()?;
        }
        // Absorbing boundaries resist where there is material, so they are set up anew for other bodies.
        let switched = switched || other_bodies;
        self.clock.new_constraints = switched && !first;
        if switched || first {
            self.set_boundaries(first, false)
                .map_err(|error| Stop::Motion {
                    error,
                    stage: self.plan.stages[self.clock.stage].name.clone(),
                    time: self.clock.time,
                })?;
        }
        if reset {
            self.particles.reset_displacements();
            self.probes.reset_displacement();
        }
        if gives || first {
            self.give_velocities();
        }
        self.clock.next = self.kick(0.0, self.remaining())?;
        Ok(())
    }

    fn give_velocities(&mut self) {
        let given = &self.plan.stages[self.clock.stage].initial_velocities;
        for &(body, velocity) in given {
            let particles = &mut self.particles;
            for p in 0..particles.len() {
                if usize::from(particles.body[p]) == body {
                    particles.velocity.set(p, velocity);
                }
            }
        }
        self.gave_velocities();
    }

    /// Books the velocities that particles have been given.
    pub(crate) fn gave_velocities(&mut self) {
        self.clock.new_constraints = true;
        let p = &self.particles;
        let kinetic = p
            .mass
            .iter()
            .zip(p.velocity.iter())
            .map(|(m, v)| 0.5 * m * v.length_squared())
            .sum();
        self.ledger.give(kinetic);
    }

    /// Sets up the boundaries that are on. An absorbing one begins in equilibrium: with the reaction
    /// that has held its nodes, at the start of a run with that of the initial or inherited stress.
    /// `given` says that particles were given a stress.
    pub(crate) fn set_boundaries(&mut self, first: bool, given: bool) -> Result<(), MotionError> {
        let boundaries: Vec<&Boundary> = (self.plan.boundaries.iter())
            .zip(&self.switches.boundaries)
            .filter(|b| *b.1)
            .map(|b| b.0)
            .collect();
        let constraints = Constraints::new(&self.plan.mesh, &boundaries);
        let free = |n: u32| constraints.of(n).map_or(Mat3::IDENTITY, |c| c.free);
        let mut absorbing = absorbing(self, &boundaries);
        let driven = driven(self, &boundaries, free)?;
        self.follower = follower(&self.plan, &boundaries, free, |n| driven.in_zone(n));
        self.driven = driven;
        let walls = walls(&self.plan.mesh, &boundaries);
        let outflow = Outflow::new(&self.plan.mesh, &boundaries);
        let before = std::mem::take(&mut self.absorbing);
        let stressed =
            given || self.plan.initial_stress.is_some() || !self.plan.inherited.is_empty();
        if first && stressed {
            self.gravity = self.plan.gravity * self.switches.gravity(0.0);
            let unheld = crate::step::unheld(self);
            absorbing.go_on_from(&before, |n| -(free(n) * unheld(n)));
        } else if !first {
            absorbing.go_on_from(&before, |n| free(n) * self.reaction(n));
        }
        self.outflow = outflow;
        self.constraints = constraints;
        self.absorbing = absorbing;
        self.walls = walls;
        self.reorder();
        Ok(())
    }

    /// Time left in the stage, s; infinite if it is limited by steps that are not yet done.
    pub(crate) fn remaining(&self) -> f64 {
        match self.plan.stages[self.clock.stage].until {
            Until::Duration(duration)
            | Until::Equilibrium {
                limit: duration, ..
            } => {
                let left = duration - self.clock.stage_time;
                if left > 1e-12 * duration { left } else { 0.0 }
            }
            Until::Steps(steps) if self.clock.stage_steps < steps => f64::INFINITY,
            Until::Steps(_) => 0.0,
        }
    }

    /// Whether a stage that ends in equilibrium has got there.
    pub(crate) fn at_rest(&mut self) -> bool {
        match self.plan.stages[self.clock.stage].until {
            Until::Equilibrium { judged, .. } => {
                let kinetic = self.ledger.energies().kinetic_grid;
                self.watch
                    .look(&self.scale, kinetic, self.clock.stage_time, &judged)
            }
            Until::Duration(_) | Until::Steps(_) => false,
        }
    }

    /// At the end of a stage that did not come to rest: an error if it should have.
    pub(crate) fn has_to_be_at_rest(&self) -> Result<(), Stop> {
        let stage = &self.plan.stages[self.clock.stage];
        let Until::Equilibrium { judged, .. } = stage.until else {
            return Ok(());
        };
        let kinetic = self.ledger.energies().kinetic_grid;
        let [unbalanced, kinetic] = self.watch.ratios(&self.scale, kinetic);
        Err(Stop::NotAtRest {
            unbalanced,
            least_unbalanced: judged.unbalanced,
            kinetic,
            least_kinetic: judged.kinetic,
            stage: stage.name.clone(),
            time: self.clock.time,
        })
    }

    pub(crate) fn local_damping(&self) -> f64 {
        let stage = self.clock.stage.min(self.plan.stages.len() - 1);
        self.plan.stages[stage]
            .damping
            .unwrap_or(self.plan.numerics.damping)
    }
}

/// λ, G and E_c, Pa.
pub(crate) fn moduli(model: &Material) -> [f64; 3] {
    let elastic = model.elasticity();
    [
        elastic.lame(),
        elastic.shear_modulus(),
        elastic.constrained_modulus(),
    ]
}

/// What is held in all directions is a wall where it lies inside the mesh.
fn walls(mesh: &Mesh, boundaries: &[&Boundary]) -> Walls {
    let holds = |b: &&&Boundary| {
        let all = [true; 3];
        matches!(b.kind, BoundaryKind::Fixed { directions } if directions == all)
    };
    let surfaces = boundaries.iter().filter(holds).flat_map(|b| &b.surfaces);
    let faces = surfaces.flat_map(|&s| mesh.surfaces[s].faces.iter().copied());
    Walls::new(mesh, faces)
}

fn absorbing(sim: &Simulation, boundaries: &[&Boundary]) -> Absorbing {
    let plan = &sim.plan;
    Absorbing::new(&plan.mesh, boundaries, |face: Face| {
        let sides = [Some(face), plan.mesh.across(face)];
        sides.into_iter().flatten().find_map(|side| {
            let first = sim.particles_in(side.element).next()?;
            let body = usize::from(sim.particles.body[first]);
            Some(&plan.materials[plan.bodies[body].material])
        })
    })
}

fn is_absorbing(boundary: &Boundary) -> bool {
    matches!(boundary.kind, BoundaryKind::Absorbing { .. })
}

fn follower(
    plan: &Plan,
    boundaries: &[&Boundary],
    free: impl Fn(u32) -> Mat3 + Sync,
    driven: impl Fn(u32) -> bool + Sync,
) -> Follower {
    let absorbing = boundaries.iter().filter(|b| is_absorbing(b));
    let surfaces = absorbing.flat_map(|b| &b.surfaces);
    let surfaces: Vec<&[Face]> = surfaces
        .map(|&s| &plan.mesh.surfaces[s].faces[..])
        .collect();
    Follower::new(&plan.mesh, &surfaces, free, driven)
}

/// The mesh's motion with its driver. It stays on absorbing boundaries: their rest and displacement
/// belong to the material, which must not be dragged away from under them.
fn driven(
    sim: &Simulation,
    boundaries: &[&Boundary],
    free: impl Fn(u32) -> Mat3,
) -> Result<Driven, MotionError> {
    let (plan, mesh) = (&sim.plan, &sim.plan.mesh);
    let Some(motion) = &plan.mesh_motion else {
        return Ok(Driven::default());
    };
    let mut driver = vec![false; mesh.tets.len()];
    for (e, own) in driver.iter_mut().enumerate() {
        let inside = sim.particles_in(e as u32);
        let is_own = |&p: &usize| usize::from(sim.particles.body[p]) == motion.driver;
        let volume: f64 = inside.filter(is_own).map(|p| sim.particles.volume[p]).sum();
        *own = volume > 0.0;
        if *own && sim.clock.steps == 0 && (volume / mesh.volumes[e] - 1.0).abs() > 1e-9 {
            return Err(MotionError::NotOnFaces {
                driver: plan.bodies[motion.driver].name.clone(),
                element: e as u32,
            });
        }
    }
    let zones = Zones {
        driver: &driver,
        moving: &motion.moving,
        blend: &motion.blend,
    };
    let mut stays = vec![false; mesh.nodes.len()];
    for boundary in boundaries.iter().filter(|b| is_absorbing(b)) {
        surface_nodes(mesh, &boundary.surfaces)
            .into_iter()
            .for_each(|n| stays[n as usize] = true);
    }
    let holder = |n: u32| {
        let touches = |b: &&&Boundary| surface_nodes(mesh, &b.surfaces).contains(&n);
        let held = |b: &Boundary| {
            let alone = Constraints::new(mesh, &[b]);
            is_absorbing(b)
                || (alone
                    .of(n)
                    .is_some_and(|c| (c.free * motion.direction).length() < 0.9))
        };
        let mut touching = boundaries.iter().filter(touches);
        let first = touching.clone().next();
        let holding = touching.find(|b| held(b)).or(first);
        holding.map_or(String::new(), |b| b.name.clone())
    };
    Driven::new(
        mesh,
        zones,
        motion.direction,
        free,
        |n| stays[n as usize],
        holder,
    )
}
