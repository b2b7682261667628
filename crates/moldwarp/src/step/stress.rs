//! Stage 6: stresses and volumes of particles (`points.rs` goes through them).

mod external;

pub(crate) use external::Answers;
pub(super) use external::ask;

use super::strain::{Deformation, growth};
use crate::Mat3;
use crate::lanes::{
    self, LANES, Lane, Simd, alike, any, either, for_each_simd, get, load, load_one, set, store,
    store_one, whole,
};
use crate::material::{Material, STATE_SIZE, Strained};
use crate::parallel::{Smallest, Sum};
use crate::plan::Plan;
use crate::tensor::{self, Voigt};
use std::ops::Range;

/// Stresses, state variables and volumes of some particles.
pub(super) type Arrays<'a> = (
    [&'a mut [f64]; 6],
    [&'a mut [f64]; STATE_SIZE],
    &'a mut [f64],
);

/// Particles side by own.
pub(super) struct Points {
    pub increment: Strained,
    pub volume: Lane,
    /// 1 where the material is separated and keeps its cell's own volumetric strain.
    separated: Lane,
    /// Whether any is.
    apart: bool,
    /// Whether strains are those of the cells.
    alike: bool,
    /// Volume in the middle of the step, m³.
    middle: Lane,
}

/// Works on particles side by side: [elastic, left out by smoothing, plastic], J.
type Works = [Lane; 3];

/// What the stage does to cells one after another.
pub(super) struct Stresses<'a> {
    plan: &'a Plan,
    answers: &'a Answers,
    simd: Simd,
    pub points: Points,
    works: Works,
    /// Volume after the step over that before.
    least: Lane,
}

impl<'a> Stresses<'a> {
    pub fn new(plan: &'a Plan, answers: &'a Answers, simd: Simd) -> Stresses<'a> {
        Stresses {
            plan,
            answers,
            simd,
            points: Points::default(),
            works: [Lane::of(0.0); 3],
            least: Lane::of(f64::INFINITY),
        }
    }

    /// New stresses, state variables and volumes of the particles of a slot of these cells; `first` is the first
    /// of the arrays.
    #[inline]
    pub fn update(
        &mut self,
        own: &Deformation,
        slot: Range<usize>,
        body: &[u16],
        arrays: &mut Arrays,
        first: usize,
    ) {
        let Stresses {
            plan,
            answers,
            simd,
            points,
            works,
            least,
        } = self;
        let model = |body: u16| &plan.materials[plan.bodies[usize::from(body)].material].model;
        let (start, place, lanes) = (slot.start - first, slot.start, slot.len());
        points.look_up(body, model, arrays, start);
        strain(*simd, own, points, arrays, start, lanes);
        points.update(*simd, body, model, (answers, place));
        match points.apart {
            true => book_apart(*simd, own, points, works, least, lanes),
            false => book(*simd, own, points, works, least, lanes),
        }
        if points.increment.plastic {
            book_plastic(*simd, points, works, lanes);
        }
        keep(*simd, points, arrays, start, lanes);
    }

    /// The works, and the smallest share of its volume that a particle has kept.
    pub fn end(self) -> ([f64; 3], Smallest) {
        let smallest = (self.least.into_iter().map(Smallest)).fold(Smallest::default(), Sum::plus);
        (self.works.each_ref().map(lanes::sum), smallest)
    }
}

impl Default for Points {
    fn default() -> Points {
        Points {
            increment: Strained::default(),
            volume: Lane::of(0.0),
            separated: Lane::of(0.0),
            apart: false,
            alike: false,
            middle: Lane::of(0.0),
        }
    }
}

impl Points {
    /// Goes to the next cells.
    pub fn enter(&mut self) {
        self.alike = false;
    }

    /// Finds out which particles are separated.
    fn look_up<'m>(
        &mut self,
        body: &[u16],
        model: impl Fn(u16) -> &'m Material,
        (stresses, states, _): &Arrays,
        start: usize,
    ) {
        let lanes = body.len();
        self.apart = false;
        if alike(body) {
            let open = |k: usize| any(&states[k][start..start + lanes]);
            if !model(body[0]).opening().is_some_and(open) {
                return;
            }
        }
        self.separated.fill(0.0);
        for (l, &body) in body.iter().enumerate() {
            let model = model(body);
            let p = start + l;
            if model.opening().is_some_and(|k| states[k][p] > 0.0) {
                let stress = std::array::from_fn(|k| stresses[k][p]);
                let state = std::array::from_fn(|k| states[k][p]);
                let separated = model.is_separated(&stress, &state);
                self.separated[l] = f64::from(u8::from(separated));
                self.apart |= separated;
            }
        }
    }

    /// New stresses, where materials meet one material after the other.
    fn update<'m>(
        &mut self,
        simd: lanes::Simd,
        body: &[u16],
        model: impl Fn(u16) -> &'m Material,
        (answers, place): (&Answers, usize),
    ) {
        let (first, lanes) = (body[0], body.len());
        let update = |model: &Material, all: &mut Strained| match model {
            Material::External(_) => answers.give(all, place, lanes),
            _ => model.update_lanes(simd, all, lanes),
        };
        if alike(body) {
            return update(model(first), &mut self.increment);
        }
        let before = self.increment.clone();
        let mut done = [false; LANES];
        (self.increment.plastic, self.increment.changed) = (true, true);
        while let Some(next) = (0..lanes).find(|&l| !done[l]) {
            let mut all = before.clone();
            update(model(body[next]), &mut all);
            for l in (0..lanes).filter(|&l| body[l] == body[next]) {
                set(&mut self.increment.stress, l, get(&all.stress, l));
                set(&mut self.increment.state, l, get(&all.state, l));
                let plastic_strain = match all.plastic {
                    true => get(&all.plastic_strain, l),
                    false => [0.0; 6],
                };
                set(&mut self.increment.plastic_strain, l, plastic_strain);
                done[l] = true;
            }
        }
    }
}

for_each_simd! {
    /// Turns stresses and gives each particle its strain.
    fn strain(
        own: &Deformation,
        points: &mut Points,
        arrays: &Arrays,
        start: usize,
        lanes: usize,
    ) {
        let (stresses, states, volumes) = arrays;
        load(&mut points.increment.before, &stresses.each_ref().map(|s| &**s), start);
        load(&mut points.increment.state, &states.each_ref().map(|s| &**s), start);
        load_one(&mut points.volume, volumes, start);
        points.volume[lanes..whole(lanes)].fill(0.0);
        for l in 0..whole(lanes) {
            let turn = Mat3::from_cols_array(&get(&own.turn, l));
            let turned = tensor::rotate(&get(&points.increment.before, l), &turn);
            set(&mut points.increment.before, l, turned);
        }
        if points.alike && !points.apart {
            return;
        }
        points.increment.strain = own.strain;
        points.alike = !points.apart;
        if points.apart {
            for l in 0..whole(lanes) {
                let own = own.volumetric[l] - own.smoothed[l];
                let left_out = own * (1.0 / 3.0) * points.separated[l];
                (0..3).for_each(|k| points.increment.strain[k][l] += left_out);
            }
        }
    }
}

for_each_simd! {
    /// Changes volumes and books the work.
    fn book(
        own: &Deformation,
        points: &mut Points,
        works: &mut Works,
        least: &mut Lane,
        lanes: usize,
    ) {
        for l in 0..whole(lanes) {
            let left_out = own.volumetric[l] - own.smoothed[l];
            book_one(l, own.growth[l], left_out, points, works, least);
        }
    }
}

for_each_simd! {
    /// The same where some are separated.
    fn book_apart(
        own: &Deformation,
        points: &mut Points,
        works: &mut Works,
        least: &mut Lane,
        lanes: usize,
    ) {
        for l in 0..whole(lanes) {
            let volumetric = own.volumetric[l];
            let left_out = (volumetric - own.smoothed[l]) * (1.0 - points.separated[l]);
            book_one(l, growth(volumetric - left_out), left_out, points, works, least);
        }
    }
}

/// `left_out` is the volumetric strain that smoothing has taken away.
#[inline(always)]
fn book_one(
    l: usize,
    growth: f64,
    left_out: f64,
    points: &mut Points,
    works: &mut Works,
    least: &mut Lane,
) {
    let increment = &points.increment;
    least[l] = either(growth < least[l], growth, least[l]);
    let middle = middle_stress(increment, l);
    let middle_volume = 0.5 * points.volume[l] * (1.0 + growth);
    works[0][l] += tensor::dot(&middle, &get(&increment.strain, l)) * middle_volume;
    works[1][l] += tensor::trace(&middle) * (1.0 / 3.0) * left_out * middle_volume;
    points.middle[l] = middle_volume;
    points.volume[l] *= growth;
}

for_each_simd! {
    /// Books the plastic part.
    fn book_plastic(points: &Points, works: &mut Works, lanes: usize) {
        let increment = &points.increment;
        for l in 0..whole(lanes) {
            let plastic_strain = get(&increment.plastic_strain, l);
            let plastic = tensor::dot(&middle_stress(increment, l), &plastic_strain);
            let plastic = plastic * points.middle[l];
            works[0][l] -= plastic;
            works[2][l] += plastic;
        }
    }
}

/// Stress in the middle of the step, turned.
#[inline(always)]
fn middle_stress(increment: &Strained, l: usize) -> Voigt {
    let (turned, stress) = (get(&increment.before, l), get(&increment.stress, l));
    std::array::from_fn(|k| 0.5 * (turned[k] + stress[k]))
}

for_each_simd! {
    /// Copies what is new to the particles.
    fn keep(points: &Points, arrays: &mut Arrays, start: usize, lanes: usize) {
        let (stresses, states, volumes) = arrays;
        store(&points.increment.stress, stresses, start, lanes);
        if points.increment.changed {
            store(&points.increment.state, states, start, lanes);
        }
        store_one(&points.volume, volumes, start, lanes);
    }
}
