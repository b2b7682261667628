//! The model's state variables as particles carry them.

use super::super::{State, StateField, Update};
use super::{MohrCoulomb, MohrCoulombState, YieldState};
use crate::lanes::{either, exp};
use crate::tensor::Voigt;

/// In the order of a particle's [`State`]; `yielding` is the number of a [`YieldState`].
pub(in super::super) const STATE_FIELDS: [StateField; 4] = [
    StateField {
        name: "plastic_strain",
        unit: "equivalent deviatoric plastic strain",
    },
    StateField {
        name: "plastic_volume",
        unit: "volumetric plastic strain",
    },
    StateField {
        name: "opening",
        unit: "volumetric strain by which the material is separated",
    },
    StateField {
        name: "yielding",
        unit: "0 elastic, 1 shear, 2 edge, 3 apex, 4 tension",
    },
];

/// The number of `opening` among them.
pub(in super::super) const OPENING: usize = 2;

/// Volume without opening over volume: the opening w is a logarithmic strain.
#[inline(always)]
pub(in super::super) fn solid_share(state: &State) -> f64 {
    let opening = state[OPENING];
    either(opening > 0.0, exp(-opening), 1.0)
}

/// Opened, and not compressed again.
#[inline(always)]
pub(in super::super) fn is_separated(stress: &Voigt, state: &State) -> bool {
    (state[OPENING] > 0.0) & (crate::tensor::trace(stress) >= 0.0)
}

impl MohrCoulomb {
    /// [`MohrCoulomb::update`] on a particle's state.
    #[inline]
    pub(in super::super) fn update_particle(
        &self,
        stress: &Voigt,
        strain: &Voigt,
        state: &mut State,
    ) -> Update {
        let mut own = MohrCoulombState {
            plastic_shear: state[0],
            plastic_volume: state[1],
            opening: state[2],
            yielding: YieldState::Elastic,
        };
        let step = self.update(stress, strain, &mut own);
        *state = [
            own.plastic_shear,
            own.plastic_volume,
            own.opening,
            f64::from(own.yielding as u8),
        ];
        Update {
            stress: step.stress,
            plastic_strain: step.plastic_strain,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{LinearElastic, Material, MohrCoulombParameters};

    /// Dry sand that is drawn apart by 10 % and pushed together again: as much of it counts as
    /// soil as before, and the state is that of the model.
    #[test]
    fn a_particle_keeps_the_models_state() {
        let elastic = LinearElastic {
            young_modulus: 1e7,
            poisson_ratio: 0.3,
        };
        let parameters = MohrCoulombParameters {
            cohesion: 0.0,
            friction_angle: 0.5,
            dilation_angle: 0.0,
            tension_cutoff: None,
        };
        let sand = Material::MohrCoulomb(MohrCoulomb::new(elastic, parameters).unwrap());
        let (mut state, zero) = (State::default(), [0.0; 6]);
        let apart = [0.05, 0.03, 0.02, 0.0, 0.0, 0.0];
        let stretched = sand.update(&zero, &apart, &mut state);
        assert_eq!(stretched.stress, zero);
        assert!((state[2] - 0.1).abs() < 1e-12);
        assert!((sand.solid_share(&state) - libm::exp(-0.1)).abs() < 1e-12);
        assert!(sand.is_separated(&stretched.stress, &state));
        let names: Vec<&str> = sand.state_fields().iter().map(|f| f.name).collect();
        assert_eq!(
            names,
            ["plastic_strain", "plastic_volume", "opening", "yielding"]
        );
        let together = sand.update(&stretched.stress, &apart.map(|e| -e), &mut state);
        assert!(together.stress.iter().all(|s| s.abs() < 1e-6));
        assert!((sand.solid_share(&state) - 1.0).abs() < 1e-12);
    }
}
