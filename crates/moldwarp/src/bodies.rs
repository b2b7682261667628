//! Bodies that stages add (fill) and take away (excavation).
//!
//! Seeds are found once, in the mesh at the start, for all bodies of the plan. So every particle has
//! its id, and every load its faces, whenever its body comes; and a body comes to the elements that
//! it was planned for, wherever the mesh has moved them.

use crate::boundary::{Surroundings, load_points};
use crate::measure::Scale;
use crate::mesh::NONE;
use crate::particles::{Order, Particles, Seed, check_overlap, inherited, particles, seeds};
use crate::plan::{Load, Plan};
use crate::simulation::Simulation;
use crate::stop::{SetupError, Stop};

/// The particles at the start, not ordered, and the seeds of bodies that stages add.
pub(crate) fn at_the_start(plan: &Plan) -> Result<(Particles, Vec<Seed>), SetupError> {
    let count = plan.bodies.len();
    let there: Vec<bool> = (0..count).map(|b| plan.there_at_the_start(b)).collect();
    let added: Vec<bool> = (0..count)
        .map(|b| plan.stages.iter().any(|s| s.add.contains(&b)))
        .collect();
    let inherits = inherited::bodies(plan);
    let all = seeds(&plan.mesh, &plan.bodies, |b| added[b] || !inherits[b])?;
    let first = (all.iter().copied()).filter(|s| {
        let body = usize::from(s.body);
        there[body] && !inherits[body]
    });
    let first = particles(first, &plan.mesh, &plan.bodies, &plan.materials);
    check_overlap(&first, &plan.bodies, &plan.mesh)?;
    let first = inherited::append(first, plan, all.len() as u32)?;
    let reserve = (all.iter().copied())
        .filter(|s| added[usize::from(s.body)])
        .collect();
    for (load, later) in plan.loads.iter().enumerate().filter(|l| added[l.1.body]) {
        let own = all.iter().copied();
        let own = own.filter(|s| usize::from(s.body) == later.body);
        check_load(plan, (load, later), own)?;
    }
    Ok((first, reserve))
}

/// Whether the particles of a body that comes later will be next to all faces of its load.
fn check_load(
    plan: &Plan,
    load: (usize, &Load),
    seeds: impl Iterator<Item = Seed> + Clone,
) -> Result<(), SetupError> {
    let particles = particles(seeds, &plan.mesh, &plan.bodies, &plan.materials);
    let order = Order::of(&particles.element, plan.mesh.tets.len());
    let ground = stress_free(plan);
    let loads = std::iter::once(load);
    load_points(&plan.mesh, loads, &particles, &order, &ground)?;
    Ok(())
}

/// What loads have to know of a body that comes later: it has no initial stress.
fn stress_free(plan: &Plan) -> Surroundings<'_> {
    Surroundings {
        share: plan.symmetry.map_or(1.0, |s| s.share),
        up: -plan.gravity.normalize_or_zero(),
        stress: &|_, _| [0.0; 6],
    }
}

/// Probes must look at particles that are there in all stages.
pub(crate) fn check_probes(sim: &Simulation) -> Result<(), SetupError> {
    let stages = &sim.plan.stages;
    if stages
        .iter()
        .all(|s| s.add.is_empty() && s.remove.is_empty())
    {
        return Ok(());
    }
    for (number, probe) in sim.plan.probes.iter().enumerate() {
        let Some(bodies) = sim.probes.bodies(number, &sim.particles) else {
            continue;
        };
        if bodies.is_empty() {
            let probe = probe.name.clone();
            return Err(SetupError::ProbeOfNothing { probe });
        }
        for body in bodies {
            let changes = stages.iter().find_map(|stage| {
                let removes = stage.remove.contains(&body);
                (removes || stage.add.contains(&body)).then_some((stage, removes))
            });
            if let Some((stage, removes)) = changes {
                return Err(SetupError::ProbeOfChange {
                    probe: probe.name.clone(),
                    body: sim.plan.bodies[body].name.clone(),
                    stage: stage.name.clone(),
                    change: if removes { "removed" } else { "added" },
                });
            }
        }
    }
    Ok(())
}

impl Simulation {
    /// Takes away and adds the bodies of the stage that begins.
    pub(crate) fn change_bodies(&mut self) -> Result<(), Stop> {
        let stage = &self.plan.stages[self.clock.stage];
        let added = |s: &&Seed| stage.add.contains(&usize::from(s.body));
        let seeds: Vec<Seed> = self.reserve.iter().filter(added).copied().collect();
        self.check_room(&seeds)?;
        self.take_away();
        let plan = &self.plan;
        let new = particles(
            seeds.iter().copied(),
            &plan.mesh,
            &plan.bodies,
            &plan.materials,
        );
        self.present += new.len() as u64;
        self.particles.append(new);
        if !self.plan.contacts.is_empty() {
            self.contacts.measure(&self.plan, &self.particles);
        }
        self.reorder();
        self.load_added_bodies();
        self.probes.bodies_changed(&self.plan, &self.order);
        self.scale = Scale::new(self);
        Ok(())
    }

    /// Elements that a body is to fill must hold nothing of another one that stays or comes.
    fn check_room(&self, seeds: &[Seed]) -> Result<(), Stop> {
        let stage = &self.plan.stages[self.clock.stage];
        let mut owner = vec![None; self.plan.mesh.tets.len()];
        let (bodies, elements) = (&self.particles.body, &self.particles.element);
        let stay = bodies.iter().zip(elements);
        for (&body, &element) in stay.filter(|p| !stage.remove.contains(&usize::from(*p.0))) {
            owner[element as usize] = Some(body);
        }
        for seed in seeds {
            let owner = owner[seed.element as usize].get_or_insert(seed.body);
            if *owner != seed.body {
                let name = |body: u16| self.plan.bodies[usize::from(body)].name.clone();
                return Err(Stop::NoRoom {
                    body: name(seed.body),
                    other: name(*owner),
                    element: seed.element,
                    stage: stage.name.clone(),
                    time: self.clock.time,
                });
            }
        }
        Ok(())
    }

    /// Takes away the particles of removed bodies.
    fn take_away(&mut self) {
        let removed = &self.plan.stages[self.clock.stage].remove;
        if removed.is_empty() {
            return;
        }
        let stays = |body: &u16| !removed.contains(&usize::from(*body));
        let keep: Vec<bool> = self.particles.body.iter().map(stays).collect();
        self.discard(&keep);
    }

    /// Takes out and counts the particles that have left through outflow surfaces: they are in no element.
    pub(crate) fn let_out(&mut self) -> Result<(), Stop> {
        let particles = &self.particles;
        let keep: Vec<bool> = particles.element.iter().map(|&e| e != NONE).collect();
        let gone = || (0..particles.len()).filter(|&p| !keep[p]);
        self.outflown.particles += gone().count() as u64;
        self.outflown.mass += gone().map(|p| particles.mass[p]).sum::<f64>();
        self.discard(&keep);
        if self.particles.is_empty() {
            return Err(Stop::Empty {
                stage: self.plan.stages[self.clock.stage].name.clone(),
                time: self.clock.time,
            });
        }
        Ok(())
    }

    /// Keeps only these particles. What looks at the others and loads them goes with them.
    fn discard(&mut self, keep: &[bool]) {
        let Simulation {
            particles,
            ledger,
            loads,
            probes,
            present,
            kinetic,
            ..
        } = self;
        *kinetic = None;
        let gone = || (0..particles.len()).filter(|&p| !keep[p]);
        let square = |p: usize| particles.velocity.at(p).length_squared();
        ledger.remove(gone().map(|p| 0.5 * particles.mass[p] * square(p)).sum());
        *present -= gone().count() as u64;
        let mut left = 0;
        let place = |&stays: &bool| {
            let place = if stays { left } else { NONE };
            left += u32::from(stays);
            place
        };
        let places: Vec<u32> = keep.iter().map(place).collect();
        particles.retain(keep);
        loads.retain(|point| keep[point.particle as usize]);
        for point in loads {
            point.particle = places[point.particle as usize];
        }
        probes.reorder(&places);
    }

    fn load_added_bodies(&mut self) {
        let plan = &self.plan;
        let added = &plan.stages[self.clock.stage].add;
        let own = plan.loads.iter().enumerate();
        let own = own.filter(|l| added.contains(&l.1.body));
        let filled = (&self.particles, &self.order);
        let points = load_points(&plan.mesh, own, filled.0, filled.1, &stress_free(plan));
        let points = points.expect("the faces of loads have been checked at the start");
        self.loads.extend(points);
    }
}
