//! Constitutive models. One file a model: equations, source, update, wave speed, tests.

mod external;
mod linear_elastic;
mod mohr_coulomb;

pub use external::{External, Increments, Law};
pub use linear_elastic::LinearElastic;
pub use mohr_coulomb::{
    MohrCoulomb, MohrCoulombParameters, MohrCoulombState, ParameterError, PlasticStep, YieldState,
};

use crate::lanes::{Held, LANES, Lane, Simd, VoigtLanes, either, get, set};
use crate::tensor::Voigt;

/// Most state variables that a model may keep per particle.
pub const STATE_SIZE: usize = 4;

/// A particle's state variables; what they are is its model's affair. All zero at the start.
pub type State = [f64; STATE_SIZE];

/// Of the models that kernels know so many of the first state variables are only ever added to: a step need not know them.
pub(crate) const SUMMED: usize = 2;

/// Name and unit of a state variable, as they appear in the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateField {
    pub name: &'static str,
    pub unit: &'static str,
}

/// What a strain increment has done to a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Update {
    /// New stress, Pa.
    pub stress: Voigt,
    /// The plastic part of the strain increment.
    pub plastic_strain: Voigt,
}

/// Strain increments of particles side by side, all of one material.
#[derive(Clone, Debug)]
pub struct Strained {
    /// Stress before, rotated by the step's spin, Pa.
    pub before: VoigtLanes,
    pub strain: VoigtLanes,
    /// New stress, Pa.
    pub stress: VoigtLanes,
    /// Whether any lane has a plastic strain; without any, `plastic_strain` is not set.
    pub plastic: bool,
    pub plastic_strain: VoigtLanes,
    pub state: [Lane; STATE_SIZE],
    /// Whether any state variable has changed.
    pub changed: bool,
}

impl Default for Strained {
    fn default() -> Strained {
        let zero = [Lane::of(0.0); 6];
        Strained {
            before: zero,
            strain: zero,
            stress: zero,
            plastic: false,
            plastic_strain: zero,
            state: [Lane::of(0.0); STATE_SIZE],
            changed: false,
        }
    }
}

/// What has become of particles side by side ([`Material::advance`]), any of them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Advanced {
    /// Has to be updated on its own: nothing of this counts.
    pub odd: bool,
    pub plastic: bool,
    /// Has opened.
    pub open: bool,
    /// Has other state variables than before.
    pub changed: bool,
}

/// A material model with its parameters.
// A plan has few materials; a box would cost the step an indirection per particle.
#[expect(clippy::large_enum_variant)]
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    LinearElastic(LinearElastic),
    MohrCoulomb(MohrCoulomb),
    /// The body moves as one, without turning (`contact/rigid.rs`).
    Rigid,
    /// By a law of whoever uses the solver, which is asked for all particles at once.
    External(External),
}

/// A rigid body has no waves and takes up no strain.
const NOTHING: LinearElastic = LinearElastic {
    young_modulus: 0.0,
    poisson_ratio: 0.0,
};

impl Material {
    /// Stress after a strain increment. `stress` (Pa) has been rotated by the step's spin.
    #[inline]
    pub fn update(&self, stress: &Voigt, strain: &Voigt, state: &mut State) -> Update {
        match self {
            Material::LinearElastic(elastic) => Update {
                stress: elastic.update(stress, strain),
                plastic_strain: [0.0; 6],
            },
            Material::MohrCoulomb(soil) => soil.update_particle(stress, strain, state),
            Material::Rigid => Update {
                stress: [0.0; 6],
                plastic_strain: [0.0; 6],
            },
            Material::External(_) => unreachable!("a law is asked for all particles at once"),
        }
    }

    /// [`Material::update`] of particles side by side. A model need not have its own way of doing it.
    pub fn update_lanes(&self, simd: Simd, s: &mut Strained, lanes: usize) {
        match self {
            Material::MohrCoulomb(soil) => soil.update_lanes(simd, s, lanes),
            Material::LinearElastic(_) | Material::Rigid | Material::External(_) => {
                (s.plastic, s.changed) = (false, false);
                for l in 0..lanes {
                    let mut state = get(&s.state, l);
                    let update = self.update(&get(&s.before, l), &get(&s.strain, l), &mut state);
                    set(&mut s.stress, l, update.stress);
                    set(&mut s.plastic_strain, l, update.plastic_strain);
                    s.plastic |= update.plastic_strain != [0.0; 6];
                    s.changed |= state != get(&s.state, l);
                    set(&mut s.state, l, state);
                }
            }
        }
    }

    /// The same in a kernel: new stresses and state variables, and what a volume dissipates, J/m³, where any is plastic. If
    /// not `OPEN`, none has opened before. The first [`SUMMED`] state variables may be given as zero: then the changes come
    /// back. None where a model has only the ways above.
    #[inline(always)]
    pub(crate) fn advance<const OPEN: bool>(
        &self,
        before: &VoigtLanes,
        strain: &VoigtLanes,
        held: &Held,
        stress: &mut VoigtLanes,
        state: &mut [Lane; STATE_SIZE],
        dissipated: &mut Lane,
    ) -> Option<Advanced> {
        match self {
            Material::MohrCoulomb(soil) => {
                Some(soil.advance::<OPEN>(before, strain, held, stress, state, dissipated))
            }
            Material::LinearElastic(elastic) => {
                for l in 0..LANES {
                    set(stress, l, elastic.update(&get(before, l), &get(strain, l)));
                }
                Some(Advanced::default())
            }
            Material::Rigid | Material::External(_) => None,
        }
    }

    /// The model's state variables, in the order of a particle's [`State`].
    pub fn state_fields(&self) -> &'static [StateField] {
        match self {
            Material::LinearElastic(_) | Material::Rigid => &[],
            Material::External(own) => own.law.state_fields(),
            Material::MohrCoulomb(_) => &mohr_coulomb::STATE_FIELDS,
        }
    }

    /// Number of the state variable that is zero as long as a particle has not opened in tension; none
    /// where the material never does.
    pub fn opening(&self) -> Option<usize> {
        match self {
            Material::LinearElastic(_) | Material::Rigid | Material::External(_) => None,
            Material::MohrCoulomb(_) => Some(mohr_coulomb::OPENING),
        }
    }

    /// Share of a particle's volume that is soil: the rest has opened in tension and holds none.
    #[inline(always)]
    pub fn solid_share(&self, state: &State) -> f64 {
        match self {
            Material::LinearElastic(_) | Material::Rigid | Material::External(_) => 1.0,
            Material::MohrCoulomb(_) => mohr_coulomb::solid_share(state),
        }
    }

    /// Whether a particle has opened in tension and not closed again: no bulk stiffness ties its
    /// volume to that of its neighbours.
    #[inline(always)]
    pub fn is_separated(&self, stress: &Voigt, state: &State) -> bool {
        match self {
            Material::LinearElastic(_) | Material::Rigid | Material::External(_) => false,
            Material::MohrCoulomb(_) => mohr_coulomb::is_separated(stress, state),
        }
    }

    /// Of particles side by side what [`Material::solid_share`] says, and 1 if they are not separated, else 0; both are 1 before.
    #[inline(always)]
    pub(crate) fn find_closed(
        &self,
        stress: &VoigtLanes,
        state: &[Lane; STATE_SIZE],
        solid: &mut Lane,
        closed: &mut Lane,
    ) {
        if let Material::MohrCoulomb(_) = self {
            for l in 0..LANES {
                solid[l] = mohr_coulomb::solid_share(&get(state, l));
            }
            for l in 0..LANES {
                let separated = mohr_coulomb::is_separated(&get(stress, l), &get(state, l));
                closed[l] = either(separated, 0.0, 1.0);
            }
        }
    }

    /// Whether a stress (Pa) is beyond the strength, by more than round-off.
    pub fn yields(&self, stress: &Voigt) -> bool {
        match self {
            Material::LinearElastic(_) | Material::Rigid | Material::External(_) => false,
            Material::MohrCoulomb(soil) => {
                let size = stress.iter().fold(0.0f64, |m, s| m.max(s.abs()));
                soil.yield_function(stress) > 1e-9 * size
            }
        }
    }

    /// The law that has to be asked for all particles at once, if it is such a material.
    pub fn external(&self) -> Option<&External> {
        match self {
            Material::External(own) => Some(own),
            _ => None,
        }
    }

    /// Whether it can flow. A contact with a body that does has no gap check unless it is asked for.
    pub fn is_plastic(&self) -> bool {
        match self {
            Material::LinearElastic(_) | Material::Rigid => false,
            Material::MohrCoulomb(_) | Material::External(_) => true,
        }
    }

    /// Whether bodies of it move as one.
    pub fn is_rigid(&self) -> bool {
        matches!(self, Material::Rigid)
    }

    /// The elastic part of the model.
    pub fn elasticity(&self) -> &LinearElastic {
        match self {
            Material::LinearElastic(elastic) => elastic,
            Material::MohrCoulomb(soil) => soil.elastic(),
            Material::Rigid => &NOTHING,
            Material::External(own) => &own.elastic,
        }
    }
}
