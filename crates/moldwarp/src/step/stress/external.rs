//! Laws that are asked for all particles of their material at once (`material/external.rs`).
//!
//! The pass of stage 6 goes through the cells in parallel and holds a few particles at a time. So a
//! pass before it collects the strains of such particles, the laws are asked one after another, and
//! the pass then finds their answers where it would call another model. Works and volumes it books as
//! for any other.

use super::super::shapes::Shapes;
use super::super::strain::Deformation;
use super::{Arrays, Bodies, Points};
use crate::lanes::{ByTile, Columns, Held, LANES, for_each_simd, held, load};
use crate::material::{External, Increments, Material, Strained};
use crate::parallel::fold;
use crate::particles::{Particles, States, Tensors};
use crate::plan::Plan;
use crate::simulation::Simulation;
use crate::step::TILES;
use crate::stop::Stop;
use rayon::prelude::*;

/// What laws are asked and what they say, by the places of particles; kept so that no step allocates.
/// Without laws all arrays are empty.
#[derive(Clone, Debug, Default)]
pub struct Answers {
    all: Talk,
    /// Whether there is any plastic strain.
    plastic: bool,
    /// Of one material, where there are others.
    part: Talk,
    places: Vec<u32>,
    id: Vec<u32>,
}

#[derive(Clone, Debug, Default)]
struct Talk {
    before: Tensors,
    strain: Tensors,
    stress: Tensors,
    plastic_strain: Tensors,
    state: States,
}

impl Talk {
    fn resize(&mut self, count: usize) {
        let tensors = [
            &mut self.before,
            &mut self.strain,
            &mut self.stress,
            &mut self.plastic_strain,
        ];
        let columns = tensors.into_iter().flat_map(Tensors::columns_mut);
        for column in columns.chain(self.state.columns_mut()) {
            column.resize(count, 0.0);
        }
    }

    /// Returns whether there are plastic strains.
    fn ask(&mut self, own: &External, id: &[u32]) -> Result<bool, String> {
        let mut plastic = false;
        own.law.update(Increments {
            id,
            before: self.before.components(),
            strain: self.strain.components(),
            stress: self.stress.components_mut(),
            plastic: &mut plastic,
            plastic_strain: self.plastic_strain.components_mut(),
            state: self.state.components_mut(),
        })?;
        let strains = self.plastic_strain.components().into_iter();
        let mut said = (self.stress.components().into_iter())
            .chain(self.state.components())
            .chain(strains.filter(|_| plastic));
        let wrong = said.find(|column| !is_finite(column));
        match wrong.and_then(|column| column.iter().position(|x| !x.is_finite())) {
            Some(place) => Err(format!(
                "has a law that says what is not a finite number, first of particle {}",
                id[place]
            )),
            None => Ok(plastic),
        }
    }
}

/// Whether all numbers are finite: nothing times zero is zero but for those that are not.
fn is_finite(numbers: &[f64]) -> bool {
    let mut zeros = [0.0; 8];
    let (groups, rest) = numbers.as_chunks::<8>();
    for group in groups {
        for (zero, x) in zeros.iter_mut().zip(group) {
            *zero += 0.0 * x;
        }
    }
    let rest = rest.iter().map(|x| 0.0 * x);
    (zeros.into_iter().chain(rest).sum::<f64>()).is_finite()
}

impl Answers {
    /// The answers for particles side by side.
    pub(super) fn give(&self, points: &mut Strained, place: usize, lanes: usize) {
        load(&mut points.stress, &self.all.stress.components(), place);
        load(&mut points.state, &self.all.state.components(), place);
        (points.plastic, points.changed) = (self.plastic, true);
        if self.plastic {
            let plastic_strain = self.all.plastic_strain.components();
            load(&mut points.plastic_strain, &plastic_strain, place);
        }
        // The pass works on whole groups of lanes; what is beyond the last particle must not spoil sums.
        let strains = points.stress.iter_mut().chain(&mut points.plastic_strain);
        strains.for_each(|lane| lane[lanes..].fill(0.0));
    }

    /// Asks the law of material `m`. Returns whether there are plastic strains.
    fn ask(
        &mut self,
        m: usize,
        own: &External,
        plan: &Plan,
        p: &Particles,
    ) -> Result<bool, String> {
        let is_own = |i: u32| plan.bodies[usize::from(p.body[i as usize])].material == m;
        // Where a guest comes from lies a particle without mass, which is not asked for.
        let is_there = |i: u32| p.mass[i as usize] > 0.0;
        let ours = (0..p.len() as u32).filter(|&i| is_own(i));
        self.places.clear();
        self.places.extend(ours.clone().filter(|&i| is_there(i)));
        if self.places.is_empty() {
            return Ok(false);
        }
        if self.places.len() == p.len() {
            let states = self.all.state.components_mut().into_iter();
            for (to, from) in states.zip(p.state.components()) {
                to.copy_from_slice(from);
            }
            return self.all.ask(own, &p.id);
        }
        let Answers {
            all,
            part,
            places,
            id,
            ..
        } = self;
        part.resize(places.len());
        for column in part.stress.components_mut() {
            column.fill(f64::NAN);
        }
        id.clear();
        id.extend(places.iter().map(|&i| p.id[i as usize]));
        gather(
            places,
            all.before.components(),
            part.before.components_mut(),
        );
        gather(
            places,
            all.strain.components(),
            part.strain.components_mut(),
        );
        gather(places, p.state.components(), part.state.components_mut());
        let plastic = part.ask(own, id)?;
        if !plastic {
            part.plastic_strain.fill([0.0; 6]);
        }
        scatter(
            places,
            part.stress.components(),
            all.stress.components_mut(),
        );
        let strains = part.plastic_strain.components();
        scatter(places, strains, all.plastic_strain.components_mut());
        scatter(places, part.state.components(), all.state.components_mut());
        // It stays as it is.
        for i in ours.filter(|&i| !is_there(i)) {
            let i = i as usize;
            all.stress.set(i, all.before.at(i));
            all.state.set(i, p.state.at(i));
            all.plastic_strain.set(i, [0.0; 6]);
        }
        Ok(plastic)
    }
}

fn gather<const N: usize>(places: &[u32], from: [&[f64]; N], to: [&mut [f64]; N]) {
    from.into_par_iter().zip(to).for_each(|(from, to)| {
        for (x, &place) in to.iter_mut().zip(places) {
            *x = from[place as usize];
        }
    });
}

fn scatter<const N: usize>(places: &[u32], from: [&[f64]; N], to: [&mut [f64]; N]) {
    from.into_par_iter().zip(to).for_each(|(from, to)| {
        for (x, &place) in from.iter().zip(places) {
            to[place as usize] = *x;
        }
    });
}

/// Asks the laws of all external materials.
pub(in crate::step) fn ask(sim: &mut Simulation) -> Result<(), Stop> {
    let is_external = |sim: &Simulation, m: usize| sim.plan.materials[m].model.external().is_some();
    if !(sim.plan.bodies.iter()).any(|body| is_external(sim, body.material)) {
        return Ok(());
    }
    let mut answers = std::mem::take(&mut sim.answers);
    answers.all.resize(sim.particles.len());
    collect(sim, &mut answers.all);
    answers.plastic = false;
    let mut asked = Ok(());
    for (m, material) in sim.plan.materials.iter().enumerate() {
        if let (Some(own), Ok(())) = (material.model.external(), &asked) {
            let said = answers.ask(m, own, &sim.plan, &sim.particles);
            answers.plastic |= said == Ok(true);
            asked = said.map(|_| ()).map_err(|problem| Stop::Law {
                material: material.name.clone(),
                problem,
                stage: sim.plan.stages[sim.clock.stage].name.clone(),
                time: sim.clock.time,
            });
        }
    }
    sim.answers = answers;
    asked
}

/// Strains and turned stresses of all particles of laws; their new stresses are not numbers yet.
fn collect(sim: &mut Simulation, to: &mut Talk) {
    let Simulation {
        plan,
        particles,
        active,
        shared,
        simd,
        ..
    } = sim;
    let (active, shared, simd) = (&*active, &*shared, *simd);
    let (materials, bodies, body) = (&plan.materials, &plan.bodies, &particles.body);
    let model = |body: u16| &materials[bodies[usize::from(body)].material].model;
    let smoothing = plan.numerics.smoothing;
    let arrays: Arrays = (
        Columns::new(particles.stress.components_mut()),
        Columns::new(particles.state.components_mut()),
        Columns::new([&mut particles.volume]),
    );
    type Out<'a> = (Columns<'a, 6>, Columns<'a, 6>, [&'a mut [f64]; 6]);
    let out: Out = (
        Columns::new(to.before.components_mut()),
        Columns::new(to.strain.components_mut()),
        to.stress.components_mut(),
    );
    let all = ByTile::new(&active.tiles, (arrays, out), ());
    fold(all, TILES, &|block: ByTile<(Arrays, Out), ()>| {
        let first = block.first();
        let tiles = block.each();
        let (arrays, (mut before, mut increment, stress)) = block.particles;
        stress.into_iter().for_each(|s| s.fill(f64::NAN));
        let (mut own, mut shapes) = (Deformation::default(), Shapes::default());
        let (mut points, mut bodies) = (Points::default(), Bodies::new(plan));
        for (number, tile) in tiles {
            let nodes = active.tile_nodes(number);
            shapes.enter(simd, nodes, &shared.places);
            own.enter(simd, &shapes, nodes, shared, smoothing);
            points.enter();
            for slot in tile.slots() {
                let (start, lanes) = (slot.start - first, slot.len());
                let body = &body[slot];
                if !body
                    .iter()
                    .any(|&b| matches!(model(b), Material::External(_)))
                {
                    continue;
                }
                fetch(simd, &mut points, &arrays, &own, start, held(lanes));
                let whose = bodies.of(body);
                points.find_separated(body, whose, &bodies, &arrays, start);
                points.strain(simd, &own);
                before.store(simd, &points.increment.before, start, lanes);
                increment.store(simd, &points.increment.strain, start, lanes);
            }
        }
    });
}

for_each_simd! {
    /// Fetches particles and turns their stresses.
    fn fetch(points: &mut Points, arrays: &Arrays, own: &Deformation, start: usize, held: &Held) {
        points.fetch(arrays, start, held);
        for l in 0..LANES {
            points.turn(own, l);
        }
        points.look_for_open(None);
    }
}
