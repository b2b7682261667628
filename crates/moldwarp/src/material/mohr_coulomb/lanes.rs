//! The model's update of particles side by side: the same numbers as [`MohrCoulomb::update`], bit for bit.

use super::super::{Advanced, STATE_SIZE, State, Strained};
use super::{MohrCoulomb, MohrCoulombState, YieldState, equivalent_strain};
use crate::lanes::{
    Held, LANES, Lane, Simd, VoigtLanes, any, either, for_each_simd, get, held, larger, set,
};
use crate::tensor::{self, Voigt};

impl MohrCoulomb {
    /// [`Material::advance`](super::super::Material::advance).
    #[inline(always)]
    pub(in super::super) fn advance(
        &self,
        before: &VoigtLanes,
        strain: &VoigtLanes,
        held: &Held,
        stress: &mut VoigtLanes,
        state: &mut [Lane; STATE_SIZE],
        dissipated: &mut Lane,
    ) -> Advanced {
        // Flags are looked for in loops of their own: one that finds them and computes stays a loop until it is too late
        // to keep what it computes in registers.
        let mut unsure = Lane::of(0.0);
        for l in 0..LANES {
            let trial = self.predictor(&get(before, l), &get(strain, l));
            let doubt = (held[l] > 0.0) & !self.surely_elastic(&trial);
            unsure[l] = either(doubt, 1.0, 0.0);
            set(stress, l, trial);
        }
        let (doubts, yielded) = (any(&*unsure), any(&*state[3]));
        state[3] = Lane::of(0.0);
        let mut advanced = Advanced {
            changed: doubts | yielded,
            ..Advanced::default()
        };
        if doubts {
            let mut odd = Lane::of(0.0);
            for l in 0..LANES {
                let trial = get(stress, l);
                let one = One::of(self, &trial);
                let unsure = unsure[l] > 0.0;
                odd[l] = either(unsure & one.odd, 1.0, 0.0);
                let yields = unsure & (one.yielding > 0.0);
                let new: Voigt = std::array::from_fn(|k| either(yields, one.stress[k], trial[k]));
                let excess: Voigt = std::array::from_fn(|k| trial[k] - new[k]);
                let plastic_strain = self.compliance(&excess);
                let before = get(before, l);
                let middle: Voigt = std::array::from_fn(|k| 0.5 * (before[k] + new[k]));
                dissipated[l] = tensor::dot(&middle, &plastic_strain);
                set(stress, l, new);
                state[0][l] += equivalent_strain(&plastic_strain);
                state[1][l] += tensor::trace(&plastic_strain);
                let opened = larger(state[2][l] + one.opening, 0.0);
                state[2][l] = either(yields, opened, state[2][l]);
                state[3][l] = either(yields, one.yielding, 0.0);
            }
            advanced.odd = any(&*odd) | self.corners.has_cutoff();
            (advanced.plastic, advanced.open) = (true, any(&*state[2]));
        }
        advanced
    }

    pub(in super::super) fn update_lanes(&self, simd: Simd, s: &mut Strained, lanes: usize) {
        let (state, mut intact, mut advanced) = (s.state, *held(lanes), Advanced::default());
        for l in 0..lanes {
            if self.is_open(&get(&s.before, l), &state_of(get(&state, l))) {
                intact[l] = 0.0;
            }
        }
        advance(simd, self, s, &intact, &mut advanced);
        if advanced.odd {
            s.state = state;
        }
        for l in 0..lanes {
            let open = intact[l] == 0.0;
            if open | advanced.odd {
                let mut state = get(&state, l);
                let update =
                    self.update_particle(&get(&s.before, l), &get(&s.strain, l), &mut state);
                set(&mut s.stress, l, update.stress);
                set(&mut s.state, l, state);
                (advanced.plastic, advanced.changed) = (true, true);
            }
        }
        (s.plastic, s.changed) = (advanced.plastic, advanced.changed);
        if s.plastic {
            flow(simd, self, s);
        }
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
    fn advance(model: &MohrCoulomb, s: &mut Strained, held: &Held, advanced: &mut Advanced) {
        let mut dissipated = Lane::of(0.0);
        let Strained { before, strain, stress, state, .. } = s;
        *advanced = model.advance(before, strain, held, stress, state, &mut dissipated);
    }
}

for_each_simd! {
    /// Plastic strain: the part of the increment that gave no stress, C⁻¹(σ_trial − σ).
    fn flow(model: &MohrCoulomb, s: &mut Strained) {
        for l in 0..LANES {
            let trial = model.predictor(&get(&s.before, l), &get(&s.strain, l));
            let stress = get(&s.stress, l);
            let excess: Voigt = std::array::from_fn(|k| trial[k] - stress[k]);
            set(&mut s.plastic_strain, l, model.compliance(&excess));
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
