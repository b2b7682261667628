//! Stage 6: stresses and volumes of particles (`points.rs` goes through them).

mod external;

pub(crate) use external::Answers;
pub(super) use external::ask;

use super::strain::Deformation;
use crate::Mat3;
use crate::lanes::{
    self, Columns, Held, LANES, Lane, Simd, VoigtLanes, alike, either, for_each_simd, get, only,
    set,
};
use crate::material::{Material, STATE_SIZE, Strained};
use crate::parallel::{Smallest, Sum};
use crate::plan::Plan;
use crate::step::Instructions;
use crate::tensor::{self, Voigt};

/// Stresses, state variables and volumes of some particles.
pub(super) type Arrays<'a> = (Columns<'a, 6>, Columns<'a, STATE_SIZE>, Columns<'a, 1>);

/// Particles side by side.
pub(super) struct Points {
    pub increment: Strained,
    pub volume: Lane,
    /// 1 where the material is separated and keeps its cell's own volumetric strain.
    separated: Lane,
    /// Whether any is.
    apart: bool,
    /// Whether any may have opened.
    pub open: bool,
    /// Whether strains are those of the cells.
    alike: bool,
    /// Volume in the middle of the step, m³.
    middle: Lane,
    /// Volume after the step over that before.
    growth: Lane,
    /// The volumetric strain that smoothing has taken away.
    left_out: Lane,
}

/// The bodies of a plan, and what there is to know of the particles of a slot.
pub(super) struct Bodies<'a> {
    plan: &'a Plan,
    /// Of the body that was met last.
    last: Whose<'a>,
}

/// Of which body the particles of a slot are.
#[derive(Clone, Copy)]
pub(super) struct Whose<'a> {
    /// None, if they are of several.
    pub body: Option<u16>,
    /// Theirs, if they are of one body.
    pub model: Option<&'a Material>,
    /// The state variable that is greater than zero where one has opened.
    pub opening: Option<usize>,
}

impl Whose<'_> {
    const SEVERAL: Whose<'static> = Whose {
        body: None,
        model: None,
        opening: None,
    };

    /// Whether any of them can open.
    #[inline]
    pub fn can_open(self) -> bool {
        self.body.is_none() || self.opening.is_some()
    }
}

impl<'a> Bodies<'a> {
    pub fn new(plan: &'a Plan) -> Bodies<'a> {
        let mut bodies = Bodies {
            plan,
            last: Whose::SEVERAL,
        };
        if let [_] = plan.bodies[..] {
            bodies.of_one(0);
        }
        bodies
    }

    #[inline]
    pub fn model(&self, body: u16) -> &'a Material {
        &self.plan.materials[self.plan.bodies[usize::from(body)].material].model
    }

    fn of_one(&mut self, body: u16) -> Whose<'a> {
        let model = self.model(body);
        self.last = Whose {
            body: Some(body),
            model: Some(model),
            opening: model.opening(),
        };
        self.last
    }

    /// Whose particles these are.
    #[inline]
    pub fn of(&mut self, bodies: &[u16]) -> Whose<'a> {
        if self.plan.bodies.len() == 1 {
            return self.last;
        }
        if !alike(bodies) {
            return Whose::SEVERAL;
        }
        if self.last.body == Some(bodies[0]) {
            return self.last;
        }
        self.of_one(bodies[0])
    }
}

/// What the stage does to cells one after another.
pub(super) struct Stresses<'a> {
    pub whose: Bodies<'a>,
    answers: &'a Answers,
    simd: Simd,
    pub points: Points,
    pub booked: Booked,
}

/// Works on particles side by side.
pub(super) struct Booked {
    /// [elastic, left out by smoothing, plastic], J.
    works: [Lane; 3],
    /// Volume after the step over that before.
    least: Lane,
}

impl Booked {
    /// Books the work on a particle of a strain and of what smoothing has taken from its trace, with its stresses before
    /// (turned) and after, and returns its volume in the middle of the step, m³.
    #[inline(always)]
    pub fn add(
        &mut self,
        l: usize,
        [turned, new]: [Voigt; 2],
        strain: &Voigt,
        left_out: f64,
        volume: f64,
        growth: f64,
    ) -> f64 {
        self.least[l] = either(growth < self.least[l], growth, self.least[l]);
        let both: Voigt = std::array::from_fn(|k| turned[k] + new[k]);
        let volume = 0.5 * volume * (1.0 + growth);
        let half = 0.5 * volume;
        let left_out = tensor::trace(&both) * (1.0 / 3.0) * left_out;
        self.works[0][l] += tensor::dot(&both, strain) * half;
        self.works[1][l] += left_out * half;
        volume
    }

    /// Books what of the work is plastic, J.
    #[inline(always)]
    pub fn add_plastic(&mut self, l: usize, plastic: f64) {
        self.works[0][l] -= plastic;
        self.works[2][l] += plastic;
    }
}

impl<'a> Stresses<'a> {
    pub fn new(plan: &'a Plan, answers: &'a Answers, simd: Simd) -> Stresses<'a> {
        Stresses {
            whose: Bodies::new(plan),
            answers,
            simd,
            points: Points::default(),
            booked: Booked {
                works: [Lane::of(0.0); 3],
                least: Lane::of(f64::INFINITY),
            },
        }
    }

    /// New stresses and state variables of the particles of a slot of these cells, whose stresses have turned but for those in
    /// the arrays.
    #[inline]
    pub fn update(
        &mut self,
        own: &Deformation,
        place: usize,
        body: &[u16],
        whose: Whose<'a>,
        (arrays, start): (&Arrays, usize),
    ) {
        let Stresses {
            whose: bodies,
            answers,
            simd,
            points,
            ..
        } = self;
        points.find_separated(body, whose, bodies, arrays, start);
        points.strain(*simd, own);
        points.update(*simd, body, whose, bodies, (answers, place));
    }

    /// Books what is plastic, after the rest.
    #[inline]
    pub fn book_plastic(&mut self) {
        if self.points.increment.plastic {
            book_plastic(self.simd, &self.points, &mut self.booked);
        }
    }

    /// The works, and the smallest share of its volume that a particle has kept.
    pub fn end(self) -> ([f64; 3], Smallest) {
        let least = self.booked.least.into_iter().map(Smallest);
        let smallest = least.fold(Smallest::default(), Sum::plus);
        (self.booked.works.each_ref().map(lanes::sum), smallest)
    }
}

impl Default for Points {
    fn default() -> Points {
        Points {
            increment: Strained::default(),
            volume: Lane::of(0.0),
            separated: Lane::of(0.0),
            apart: false,
            open: true,
            alike: false,
            middle: Lane::of(0.0),
            growth: Lane::of(1.0),
            left_out: Lane::of(0.0),
        }
    }
}

impl Points {
    /// Goes to the next cells.
    pub fn enter(&mut self) {
        self.alike = false;
    }

    /// Finds out whether any particle that is here may have opened.
    #[inline(always)]
    pub fn look_for_open(&mut self, opening: Option<usize>) {
        self.open = true;
        if let Some(k) = opening {
            let (state, volume) = (&self.increment.state[k], &self.volume);
            let open = |l: usize| (volume[l] > 0.0) & (state[l] > 0.0);
            self.open = (0..LANES).fold(false, |any, l| any | open(l));
        }
    }

    /// Finds out which particles are separated.
    #[inline]
    pub fn find_separated(
        &mut self,
        body: &[u16],
        whose: Whose,
        bodies: &Bodies,
        (stresses, ..): &Arrays,
        start: usize,
    ) {
        self.apart = false;
        if !whose.can_open() || !self.open {
            return;
        }
        self.separated.fill(0.0);
        for (l, &body) in body.iter().enumerate() {
            let model = bodies.model(body);
            let state = get(&self.increment.state, l);
            if model.opening().is_some_and(|k| state[k] > 0.0) {
                let separated = model.is_separated(&stresses.at(start + l), &state);
                self.separated[l] = f64::from(u8::from(separated));
                self.apart |= separated;
            }
        }
    }

    /// Fetches particles.
    #[inline(always)]
    pub fn fetch(&mut self, (stresses, states, volumes): &Arrays, start: usize, held: &Held) {
        stresses.load(&mut self.increment.before, start);
        states.load(&mut self.increment.state, start);
        let mut volume = [Lane::of(0.0)];
        volumes.load(&mut volume, start);
        self.volume = only(held, &volume[0]);
    }

    /// Turns a stress with its cell.
    #[inline(always)]
    pub fn turn(&mut self, own: &Deformation, l: usize) {
        let turn = Mat3::from_cols_array(&get(&own.turn, l));
        let turned = tensor::rotate(&get(&self.increment.before, l), &turn);
        set(&mut self.increment.before, l, turned);
    }

    /// Gives particles their strains.
    #[inline]
    fn strain(&mut self, simd: Simd, own: &Deformation) {
        if self.alike && !self.apart {
            return;
        }
        self.increment.strain = own.strain;
        (self.growth, self.left_out) = (own.growth, own.left_out);
        self.alike = !self.apart;
        if self.apart {
            separate(simd, own, self);
        }
    }

    /// New stresses, where materials meet one material after the other.
    #[inline]
    fn update(
        &mut self,
        simd: Simd,
        body: &[u16],
        whose: Whose,
        bodies: &Bodies,
        (answers, place): (&Answers, usize),
    ) {
        let lanes = body.len();
        let update = |model: &Material, all: &mut Strained| match model {
            Material::External(_) => answers.give(all, place, lanes),
            _ => model.update_lanes(simd, all, lanes),
        };
        if let Some(model) = whose.model {
            return update(model, &mut self.increment);
        }
        let before = self.increment.clone();
        let mut done = [false; LANES];
        (self.increment.plastic, self.increment.changed) = (true, true);
        while let Some(next) = (0..lanes).find(|&l| !done[l]) {
            let mut all = before.clone();
            update(bodies.model(body[next]), &mut all);
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

    /// Changes a volume and books the work.
    #[inline(always)]
    pub fn book(&mut self, booked: &mut Booked, l: usize) {
        let (increment, growth) = (&self.increment, self.growth[l]);
        let both = [&increment.before, &increment.stress].map(|stress| get(stress, l));
        let strain = get(&increment.strain, l);
        let volume = self.volume[l];
        self.middle[l] = booked.add(l, both, &strain, self.left_out[l], volume, growth);
        self.volume[l] *= growth;
    }

    /// These are new, and whether any may have opened.
    #[inline(always)]
    pub fn come_to(
        &mut self,
        stress: VoigtLanes,
        state: [Lane; STATE_SIZE],
        volume: Lane,
        open: bool,
    ) {
        (self.increment.stress, self.increment.state) = (stress, state);
        (self.volume, self.open) = (volume, open);
    }

    /// Copies what is new to the particles.
    #[inline(always)]
    pub fn keep<S: Instructions>(&self, to: &mut Arrays, start: usize, lanes: usize) {
        let (stresses, states, volumes) = to;
        stresses.put::<S>(&self.increment.stress, start, lanes);
        if self.increment.changed {
            states.put::<S>(&self.increment.state, start, lanes);
        }
        volumes.put::<S>(std::array::from_ref(&self.volume), start, lanes);
    }
}

for_each_simd! {
    /// Gives what is separated its own volumetric strain.
    fn separate(own: &Deformation, points: &mut Points) {
        for l in 0..LANES {
            let (strain, left_out, growth) = own.of_particle(l, points.separated[l] > 0.0);
            set(&mut points.increment.strain, l, strain);
            (points.left_out[l], points.growth[l]) = (left_out, growth);
        }
    }
}

for_each_simd! {
    /// Books the plastic part.
    fn book_plastic(points: &Points, booked: &mut Booked) {
        let increment = &points.increment;
        for l in 0..LANES {
            let (turned, new) = (get(&increment.before, l), get(&increment.stress, l));
            let middle: Voigt = std::array::from_fn(|k| 0.5 * (turned[k] + new[k]));
            let plastic = tensor::dot(&middle, &get(&increment.plastic_strain, l));
            booked.add_plastic(l, plastic * points.middle[l]);
        }
    }
}
