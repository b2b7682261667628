//! The model's update of particles side by side: the same numbers as [`MohrCoulomb::update`], bit for bit.

use super::super::{State, Strained};
use super::{MohrCoulomb, MohrCoulombState, YieldState, compose, equivalent_strain};
use crate::lanes::{
    LANES, Lane, Simd, VoigtLanes, any, either, for_each_simd, get, larger, set, whole,
};
use crate::tensor::{self, Voigt};

/// Stresses to return, and what has become of them.
struct Returned {
    stress: VoigtLanes,
    /// Number of a [`YieldState`].
    yielding: Lane,
    opening: Lane,
    /// 1 where the stress has to be returned on its own.
    odd: Lane,
}

impl Default for Returned {
    fn default() -> Returned {
        Returned {
            stress: [Lane::of(0.0); 6],
            yielding: Lane::of(0.0),
            opening: Lane::of(0.0),
            odd: Lane::of(1.0),
        }
    }
}

impl MohrCoulomb {
    pub(in super::super) fn update_lanes(&self, simd: Simd, s: &mut Strained, lanes: usize) {
        let mut sure: Lane = Lane::of(0.0);
        predict(simd, self, s, lanes, &mut sure);
        s.plastic = false;
        s.changed = any(&s.state[3][..lanes]);
        if s.changed {
            s.state[3][..lanes].fill(0.0);
        }
        // Without leaving early, that it be done side by side.
        let calm = |l: usize| (s.state[2][l] <= 0.0) & (sure[l] > 0.0);
        if (0..lanes).fold(true, |all, l| all & calm(l)) {
            return;
        }
        s.changed = true;
        if any(&s.state[2][..lanes]) {
            for l in 0..lanes {
                if s.state[2][l] > 0.0 && self.step_if_open(s, l) {
                    (s.plastic, sure[l]) = (true, 1.0);
                }
            }
        }
        let count = (sure[..lanes].iter()).fold(0, |n, &sure| n + usize::from(sure == 0.0));
        // Where most yield they are returned where they are; where few do, these are brought together.
        if 3 * count > lanes && !self.corners.has_cutoff() {
            s.plastic |= self.return_in_place(simd, s, &mut sure, lanes);
        } else if count > 0 {
            s.plastic |= self.return_few(simd, s, &sure[..lanes]);
        }
        if s.plastic {
            flow(simd, self, s, lanes);
        }
    }

    /// A step of a particle that is open; says whether it is.
    fn step_if_open(&self, s: &mut Strained, l: usize) -> bool {
        let (stress, mut state) = (get(&s.before, l), state_of(get(&s.state, l)));
        if !self.is_open(&stress, &state) {
            return false;
        }
        let step = self.open_step(&stress, &get(&s.strain, l), state.opening);
        state.opening = (state.opening + step.opening).max(0.0);
        set(&mut s.stress, l, step.stress);
        s.state[2][l] = state.opening;
        s.state[3][l] = f64::from(step.yielding as u8);
        true
    }

    /// Returns the predictors that are not sure; says whether any of them yields.
    fn return_in_place(&self, simd: Simd, s: &mut Strained, sure: &mut Lane, lanes: usize) -> bool {
        sure[lanes..whole(lanes)].fill(1.0);
        // In the place of what is sure comes what has to be returned on its own.
        let odd = sure;
        return_unsure(simd, self, s, odd, lanes);
        if any(&odd[..lanes]) {
            for l in (0..lanes).filter(|&l| odd[l] > 0.0) {
                let step = self.return_map(&get(&s.stress, l));
                let yielding = f64::from(step.yielding as u8);
                if yielding > 0.0 {
                    self.keep(s, l, step.stress, step.opening, yielding);
                }
            }
        }
        any(&s.state[3][..lanes])
    }

    fn keep(&self, s: &mut Strained, l: usize, stress: Voigt, opening: f64, yielding: f64) {
        set(&mut s.stress, l, stress);
        s.state[2][l] = (s.state[2][l] + opening).max(0.0);
        s.state[3][l] = yielding;
    }

    /// The same one after another or, without a cut-off, brought together.
    fn return_few(&self, simd: Simd, s: &mut Strained, sure: &[f64]) -> bool {
        let (mut all, mut count) = ([0u8; LANES], 0);
        for (l, _) in sure.iter().enumerate().filter(|l| *l.1 == 0.0) {
            all[count] = l as u8;
            count += 1;
        }
        let unsure = &all[..count];
        let mut r = Returned::default();
        for (i, &l) in unsure.iter().enumerate() {
            set(&mut r.stress, i, get(&s.stress, l.into()));
        }
        if !self.corners.has_cutoff() {
            return_side_by_side(simd, self, &mut r, unsure.len());
        }
        let mut any = false;
        for (i, &l) in unsure.iter().enumerate() {
            let l = usize::from(l);
            if r.odd[i] != 0.0 {
                let step = self.return_map(&get(&s.stress, l));
                set(&mut r.stress, i, step.stress);
                r.yielding[i] = f64::from(step.yielding as u8);
                r.opening[i] = step.opening;
            }
            if r.yielding[i] > 0.0 {
                any = true;
                self.keep(s, l, get(&r.stress, i), r.opening[i], r.yielding[i]);
            }
        }
        any
    }
}

fn state_of(state: State) -> MohrCoulombState {
    MohrCoulombState {
        plastic_shear: state[0],
        plastic_volume: state[1],
        opening: state[2],
        yielding: YieldState::Elastic,
    }
}

for_each_simd! {
    /// Elastic predictors, and where they are surely admissible.
    fn predict(model: &MohrCoulomb, s: &mut Strained, lanes: usize, sure: &mut Lane) {
        for l in 0..whole(lanes) {
            let trial = model.predictor(&get(&s.before, l), &get(&s.strain, l));
            sure[l] = either(model.surely_elastic(&trial), 1.0, 0.0);
            set(&mut s.stress, l, trial);
        }
    }
}

/// A predictor as [`MohrCoulomb::return_map`] returns it without a cut-off.
struct One {
    stress: Voigt,
    /// Number of a [`YieldState`].
    yielding: f64,
    opening: f64,
    /// Whether it has to be returned on its own.
    odd: bool,
}

impl One {
    #[inline(always)]
    fn of(model: &MohrCoulomb, trial: &Voigt) -> One {
        let (principal, ordinary) = tensor::principal_if_ordinary(trial);
        let [largest, _, smallest] = principal.values;
        let elastic = model.corners.shear_function(largest, smallest) <= 0.0;
        let found = model.corners.return_without_cutoff(&principal.values);
        One {
            stress: compose(&found.stress, &principal.directions),
            yielding: either(elastic, 0.0, f64::from(found.yielding as u8)),
            opening: found.opening,
            odd: !ordinary,
        }
    }
}

for_each_simd! {
    fn return_side_by_side(model: &MohrCoulomb, r: &mut Returned, lanes: usize) {
        for l in 0..whole(lanes) {
            let one = One::of(model, &get(&r.stress, l));
            set(&mut r.stress, l, one.stress);
            (r.yielding[l], r.opening[l]) = (one.yielding, one.opening);
            r.odd[l] = either(one.odd, 1.0, 0.0);
        }
    }
}

for_each_simd! {
    /// Returns where predictors are not `sure`, and puts 1 there where one has to be returned on its own, else 0.
    fn return_unsure(model: &MohrCoulomb, s: &mut Strained, sure: &mut Lane, lanes: usize) {
        for l in 0..whole(lanes) {
            let trial = get(&s.stress, l);
            let one = One::of(model, &trial);
            let unsure = sure[l] == 0.0;
            sure[l] = either(unsure & one.odd, 1.0, 0.0);
            let returned = unsure & !one.odd & (one.yielding > 0.0);
            let opened = larger(s.state[2][l] + one.opening, 0.0);
            s.state[2][l] = either(returned, opened, s.state[2][l]);
            s.state[3][l] = either(returned, one.yielding, s.state[3][l]);
            for k in 0..6 {
                s.stress[k][l] = either(returned, one.stress[k], trial[k]);
            }
        }
    }
}

for_each_simd! {
    /// Plastic strain: the part of the increment that gave no stress, C⁻¹(σ_trial − σ).
    fn flow(model: &MohrCoulomb, s: &mut Strained, lanes: usize) {
        for l in 0..whole(lanes) {
            let trial = model.predictor(&get(&s.before, l), &get(&s.strain, l));
            let stress = get(&s.stress, l);
            let excess: Voigt = std::array::from_fn(|k| trial[k] - stress[k]);
            let strain = model.compliance(&excess);
            s.state[0][l] += equivalent_strain(&strain);
            s.state[1][l] += tensor::trace(&strain);
            set(&mut s.plastic_strain, l, strain);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{MohrCoulomb, MohrCoulombParameters};
    use super::*;
    use crate::material::{LinearElastic, Material};
    use crate::random::Random;

    /// Random stresses, strains and openings, with and without a cut-off, dilation and cohesion.
    #[test]
    fn side_by_side_is_one_by_one() {
        let mut random = Random::new(11);
        let elastic = LinearElastic {
            young_modulus: 1e7,
            poisson_ratio: 0.3,
        };
        for n in 0..200 {
            let parameters = MohrCoulombParameters {
                cohesion: if n % 4 == 0 { 0.0 } else { 3e3 },
                friction_angle: 0.5,
                dilation_angle: if n % 3 == 0 { 0.2 } else { 0.0 },
                tension_cutoff: (n % 5 == 1).then_some(1e3),
            };
            let parameters = MohrCoulombParameters {
                tension_cutoff: parameters
                    .tension_cutoff
                    .filter(|_| parameters.cohesion > 0.0),
                ..parameters
            };
            let model = Material::MohrCoulomb(MohrCoulomb::new(elastic, parameters).unwrap());
            let scale = if n % 7 == 0 { 0.0 } else { 1e4 };
            let lanes = 1 + (n * 13) % LANES;
            let mut s = Strained::default();
            for l in 0..lanes {
                let open = random.within(0.0, 1.0) < 0.2;
                let mut within =
                    |a: f64| -> Voigt { std::array::from_fn(|_| random.within(-a, a)) };
                set(
                    &mut s.before,
                    l,
                    if open { [0.0; 6] } else { within(scale) },
                );
                set(&mut s.strain, l, within(1e-3));
                s.state[2][l] = if open { random.within(0.0, 1e-3) } else { 0.0 };
            }
            let before = s.clone();
            let run = |simd| {
                let mut s = before.clone();
                model.update_lanes(simd, &mut s, lanes);
                s
            };
            for name in Simd::NAMES {
                let Some(simd) = Simd::named(name) else {
                    continue;
                };
                let s = run(simd);
                for l in 0..lanes {
                    let mut state = get(&before.state, l);
                    let step =
                        model.update(&get(&before.before, l), &get(&before.strain, l), &mut state);
                    let bits =
                        |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
                    assert_eq!(
                        bits(&get(&s.stress, l)),
                        bits(&step.stress),
                        "{name} {n} {l}"
                    );
                    let close =
                        |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);
                    assert!(close(&get(&s.state, l), &state), "{name} {n} {l}");
                    if s.plastic {
                        assert!(close(&get(&s.plastic_strain, l), &step.plastic_strain));
                    }
                }
            }
        }
    }
}
