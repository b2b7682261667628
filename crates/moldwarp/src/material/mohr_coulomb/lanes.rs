//! The model's update of particles side by side: the same numbers as [`MohrCoulomb::update`], bit for bit.

use super::super::{Advanced, STATE_SIZE, Strained};
use super::{MohrCoulomb, YieldState};
use crate::lanes::{
    Held, LANES, Lane, Simd, VoigtLanes, any, either, for_each_simd, get, held, larger, set,
};
use crate::tensor::{self, Voigt};

impl MohrCoulomb {
    /// [`Material::advance`](super::super::Material::advance).
    #[inline(always)]
    pub(in super::super) fn advance<const OPEN: bool>(
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
        let (mut unsure, mut gaps, mut widening) = (*held, Lane::of(0.0), Lane::of(0.0));
        for l in 0..LANES {
            let trial = self.predictor(&get(before, l), &get(strain, l));
            set(stress, l, trial);
        }
        if OPEN {
            for l in 0..LANES {
                let gap = Gap::of(self, &get(before, l), &get(strain, l), state[2][l]);
                (gaps[l], widening[l]) = (gap.kind, gap.widening);
                for k in 0..6 {
                    stress[k][l] = either(gap.kind > 0.0, gap.trial[k], stress[k][l]);
                }
                unsure[l] = either(gap.kind < STAYS, unsure[l], 0.0);
            }
        }
        // Where some have yielded, some will again: then principal values tell of all.
        let yielded = any(&*state[3]);
        if !yielded {
            self.find_unsure(stress, &mut unsure);
        }
        let doubts = yielded || any(&*unsure);
        state[3] = Lane::of(0.0);
        let mut advanced = Advanced {
            changed: doubts | OPEN,
            ..Advanced::default()
        };
        if doubts | OPEN {
            if self.corners.has_cutoff() {
                advanced.odd = true;
                return advanced;
            }
            let mut odd = Lane::of(0.0);
            for l in 0..LANES {
                let mut trial = get(stress, l);
                let one = One::of(self, &trial);
                odd[l] = either(one.odd, unsure[l], 0.0);
                let yields = (unsure[l] > 0.0) & !one.odd & (one.yielding > 0.0);
                let new: Voigt = std::array::from_fn(|k| either(yields, one.stress[k], trial[k]));
                let before = get(before, l);
                let opening = state[2][l];
                let (mut wider, mut yielding) = (one.opening, one.yielding);
                let mut changes = yields;
                if OPEN {
                    trial = self.predictor(&before, &get(strain, l));
                    let returned = either(yields, one.opening, 0.0);
                    wider = either(gaps[l] < STAYS, returned + widening[l], widening[l]);
                    yielding = either(yields, yielding, f64::from(YieldState::Tension as u8));
                    changes |= gaps[l] > 0.0;
                }
                let excess: Voigt = std::array::from_fn(|k| trial[k] - new[k]);
                let (plastic_strain, shear, volume) = self.strain_of(&excess);
                let both: Voigt = std::array::from_fn(|k| before[k] + new[k]);
                dissipated[l] = 0.5 * tensor::dot(&both, &plastic_strain);
                set(stress, l, new);
                state[0][l] += shear;
                state[1][l] += volume;
                state[2][l] = either(changes, larger(opening + wider, 0.0), opening);
                state[3][l] = either(changes, yielding, 0.0);
            }
            advanced.plastic = true;
            if any(&*odd) {
                self.find_unsure(stress, &mut odd);
                advanced.odd = any(&*odd);
            }
            advanced.open = any(&*state[2]);
        }
        advanced
    }

    /// Leaves only those of `unsure` that are not surely elastic.
    #[inline(always)]
    fn find_unsure(&self, stress: &VoigtLanes, unsure: &mut Lane) {
        for l in 0..LANES {
            let sure = self.surely_elastic(&get(stress, l));
            unsure[l] = either(sure, 0.0, unsure[l]);
        }
    }

    pub(in super::super) fn update_lanes(&self, simd: Simd, s: &mut Strained, lanes: usize) {
        let (state, mut advanced) = (s.state, Advanced::default());
        match any(&state[2][..lanes]) {
            true => advance_open(simd, self, s, held(lanes), &mut advanced),
            false => advance(simd, self, s, held(lanes), &mut advanced),
        }
        if advanced.odd {
            // One by one.
            for l in 0..lanes {
                let mut state = get(&state, l);
                let update =
                    self.update_particle(&get(&s.before, l), &get(&s.strain, l), &mut state);
                set(&mut s.stress, l, update.stress);
                set(&mut s.state, l, state);
            }
            (advanced.plastic, advanced.changed) = (true, true);
        }
        (s.plastic, s.changed) = (advanced.plastic, advanced.changed);
        if s.plastic {
            flow(simd, self, s);
        }
    }
}

/// Of [`Gap::kind`]: it takes up or gives all of the strain.
const STAYS: f64 = 2.0;

/// An opening as [`MohrCoulomb::open_step`] has it.
struct Gap {
    /// 0 if the material is not open, 1 if it closes, [`STAYS`] if not.
    kind: f64,
    /// Stress if it is open, before it is returned if it closes.
    trial: Voigt,
    /// Change of the opening, before it is returned if it closes.
    widening: f64,
}

impl Gap {
    #[inline(always)]
    fn of(model: &MohrCoulomb, before: &Voigt, strain: &Voigt, opening: f64) -> Gap {
        let (tip, bulk) = (model.corners.tip(), model.bulk_modulus);
        let (mean, volumetric) = (tensor::trace(before) / 3.0, tensor::trace(strain));
        let mut is_open = (opening > 0.0) & (mean >= -model.negligible);
        for k in 0..3 {
            is_open &= (before[k] - mean).abs() <= model.negligible;
            is_open &= before[k + 3].abs() <= model.negligible;
        }
        let trial = mean + bulk * volumetric;
        let closing = larger(-trial / bulk, 0.0);
        let closes = closing > opening;
        let share = (closing - opening) / -volumetric;
        let share = either(share < 1.0, share, 1.0);
        let share = either(volumetric < 0.0, share, 0.0);
        let rest = model.predictor(&[0.0; 6], &strain.map(|e| share * e));
        let new = either(trial < 0.0, 0.0, trial);
        let new = either(new > tip, tip, new);
        let kind = either(closes, 1.0, STAYS);
        Gap {
            kind: either(is_open, kind, 0.0),
            trial: std::array::from_fn(|k| either(closes, rest[k], if k < 3 { new } else { 0.0 })),
            widening: either(is_open, either(closes, -opening, (trial - new) / bulk), 0.0),
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
        *advanced = model.advance::<false>(before, strain, held, stress, state, &mut dissipated);
    }
}

for_each_simd! {
    /// The same where some may be open.
    fn advance_open(model: &MohrCoulomb, s: &mut Strained, held: &Held, advanced: &mut Advanced) {
        let mut dissipated = Lane::of(0.0);
        let Strained { before, strain, stress, state, .. } = s;
        *advanced = model.advance::<true>(before, strain, held, stress, state, &mut dissipated);
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
                    match (open, n % 2) {
                        (true, 0) => [0.0; 6],
                        (true, _) => [500.0, 500.0, 500.0, 0.0, 0.0, 0.0],
                        _ => within(scale),
                    },
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
