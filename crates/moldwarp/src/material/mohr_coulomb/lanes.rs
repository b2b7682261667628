//! The model's update of particles side by side: the same numbers as [`MohrCoulomb::update`], bit for bit.

use super::super::{State, Strained};
use super::{MohrCoulomb, MohrCoulombState, YieldState, equivalent_strain};
use crate::lanes::{Held, LANES, Lane, Simd, either, for_each_simd, get, held, larger, set};
use crate::tensor::{self, Voigt};

impl MohrCoulomb {
    pub(in super::super) fn update_lanes(&self, simd: Simd, s: &mut Strained, lanes: usize) {
        let (mut unsure, mut met) = (Lane::of(0.0), Met::default());
        predict(simd, self, s, held(lanes), &mut unsure, &mut met);
        s.plastic = false;
        s.changed = met.yielded | met.unsure | met.open;
        if met.open {
            for l in 0..lanes {
                if s.state[2][l] > 0.0 && self.step_if_open(s, l) {
                    (s.plastic, unsure[l]) = (true, 0.0);
                }
            }
        }
        if met.unsure {
            s.plastic |= self.return_all(simd, s, &mut unsure);
        }
        if s.plastic {
            flow(simd, self, s);
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
    fn return_all(&self, simd: Simd, s: &mut Strained, unsure: &mut Lane) -> bool {
        // In the place of what is unsure comes what has to be returned on its own.
        let (alone, mut met) = (unsure, Met::default());
        match self.corners.has_cutoff() {
            true => met.unsure = true,
            false => return_unsure(simd, self, s, alone, &mut met),
        }
        if !met.unsure {
            return met.yielded;
        }
        for l in (0..LANES).filter(|&l| alone[l] > 0.0) {
            let step = self.return_map(&get(&s.stress, l));
            let yielding = f64::from(step.yielding as u8);
            if yielding > 0.0 {
                met.yielded = true;
                set(&mut s.stress, l, step.stress);
                s.state[2][l] = (s.state[2][l] + step.opening).max(0.0);
                s.state[3][l] = yielding;
            }
        }
        met.yielded
    }
}

/// What particles side by side have been found to be, any of them.
#[derive(Default)]
struct Met {
    /// Their predictors may not be admissible.
    unsure: bool,
    open: bool,
    /// They have yielded, before or now.
    yielded: bool,
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
    /// Elastic predictors, and which of them may not be admissible.
    fn predict(model: &MohrCoulomb, s: &mut Strained, held: &Held, unsure: &mut Lane, met: &mut Met) {
        let (mut yielded, mut open, mut doubts) = (false, false, false);
        for l in 0..LANES {
            let trial = model.predictor(&get(&s.before, l), &get(&s.strain, l));
            set(&mut s.stress, l, trial);
            let doubt = (held[l] > 0.0) & !model.surely_elastic(&trial);
            unsure[l] = either(doubt, 1.0, 0.0);
            doubts |= doubt;
            open |= (held[l] > 0.0) & (s.state[2][l] > 0.0);
            yielded |= (held[l] > 0.0) & (s.state[3][l] > 0.0);
            s.state[3][l] = 0.0;
        }
        *met = Met { unsure: doubts, open, yielded };
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
            stress: principal.with(&found.stress),
            yielding: either(elastic, 0.0, f64::from(found.yielding as u8)),
            opening: found.opening,
            odd: !ordinary,
        }
    }
}

for_each_simd! {
    /// Returns predictors that are `unsure`, and leaves 1 there where one has to be returned on its own, else 0.
    fn return_unsure(model: &MohrCoulomb, s: &mut Strained, unsure: &mut Lane, met: &mut Met) {
        let (mut odd, mut yields) = (false, false);
        for l in 0..LANES {
            let trial = get(&s.stress, l);
            let one = One::of(model, &trial);
            let returned = unsure[l] > 0.0;
            unsure[l] = either(returned & one.odd, 1.0, 0.0);
            odd |= returned & one.odd;
            let returned = returned & !one.odd & (one.yielding > 0.0);
            yields |= returned;
            let opened = larger(s.state[2][l] + one.opening, 0.0);
            s.state[2][l] = either(returned, opened, s.state[2][l]);
            s.state[3][l] = either(returned, one.yielding, s.state[3][l]);
            for k in 0..6 {
                s.stress[k][l] = either(returned, one.stress[k], trial[k]);
            }
        }
        (met.unsure, met.yielded) = (odd, yields);
    }
}

for_each_simd! {
    /// Plastic strain: the part of the increment that gave no stress, C⁻¹(σ_trial − σ).
    fn flow(model: &MohrCoulomb, s: &mut Strained) {
        for l in 0..LANES {
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
