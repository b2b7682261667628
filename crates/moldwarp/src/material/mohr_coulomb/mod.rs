//! Mohr-Coulomb: linear elasticity, perfect plasticity with cohesion c, friction angle φ,
//! dilation angle ψ and a tension cut-off T. Tresca's material is φ = 0.
//!
//! # Yield and flow
//!
//! With principal stresses σ₁ ≥ σ₂ ≥ σ₃, tension positive,
//!
//! ```text
//! shear      f = (σ₁ − σ₃) + (σ₁ + σ₃) sin φ − 2 c cos φ ≤ 0,   flow along ∂g/∂σ, g = f with ψ for φ
//! cut-off    σ₁ ≤ T ≤ c cot φ,                                  flow along ∂σ₁/∂σ (Rankine)
//! ```
//!
//! and the same for every pair and every one of the principal stresses: six planes and three.
//! The elastic predictor σ_tr is returned exactly, without iteration, to the plane, edge or
//! corner for which C⁻¹(σ_tr − σ) is a combination with non-negative factors of the active
//! planes' flow directions (see `corners.rs`); this is the plastic strain increment. Without a
//! cut-off below c cot φ the planes end in the apex σ = c cot φ I. For ψ = 0 plastic flow on
//! planes and edges keeps the mean stress p and cannot reach the apex; states with p ≥ c cot φ
//! are returned to it directly, the limit of ψ → 0.
//!
//! References: R. de Borst, Int. J. Numer. Anal. Methods Geomech. 11 (1987); J. Clausen,
//! L. Damkilde and L. Andersen, Computers & Structures 85 (2007); E. A. de Souza Neto, D. Perić and
//! D. R. J. Owen, Computational Methods for Plasticity (2008), chapter 8.
//!
//! # Separated material
//!
//! At the tensile corner (all principal stresses equal to T, or the apex) perfect plasticity
//! lets a particle's volume grow without end, and compressing it would at once give pressure,
//! though its grains are far apart. So the model remembers the *opening* w ≥ 0, the volumetric
//! plastic strain of the cut-off planes and of the apex (not of dilation on the shear planes).
//! Material is *open* while w > 0 and its stress is isotropic and not compressive: once the
//! tensile corner was reached, until w has been used up. Open material behaves like a gap in
//! series with the strength. With p its mean stress and K the bulk modulus,
//!
//! ```text
//! p* = p + K Δε_v      p* > T        p = T,   w grows by (p* − T)/K
//!                      0 ≤ p* ≤ T    p = p*,  w stays: elastic
//!                      p* < 0        p = 0,   w shrinks by −p*/K, at most to zero
//! ```
//!
//! and shear strain gives no stress. When w comes to zero within a step, the share of the strain
//! increment that is left acts on stress-free, intact material. So expansion by some strain and
//! compression by the same strain lead back to where they began, there is no pressure before,
//! and the plastic work T Δw ≥ 0 (opening) or 0 (closing) is never negative. For c = 0 open
//! material has no stress at all.
//!
//! The opening has no direction. A crack across one direction of a particle that is still
//! compressed in another (T < c cot φ only) closes as an elastic-plastic solid, with pressure
//! from the first instant; its opening is kept and taken up when the particle is next free of
//! stress. Material that was never in tension at the cut-off has w = 0 and is not concerned.

mod corners;
mod lanes;
mod parameters;
mod particle;
#[cfg(test)]
mod paths;
#[cfg(test)]
mod return_tests;

pub use parameters::{MohrCoulombParameters, ParameterError};
pub(super) use particle::{OPENING, STATE_FIELDS, is_separated, solid_share};

use super::LinearElastic;
use crate::tensor::{self, Voigt};
use corners::Corners;
use std::fmt;

/// The model with the constants that its return needs.
#[derive(Clone, Copy, PartialEq)]
pub struct MohrCoulomb {
    elastic: LinearElastic,
    parameters: MohrCoulombParameters,
    corners: Corners,
    /// λ, G and K, Pa.
    lame: f64,
    shear_modulus: f64,
    bulk_modulus: f64,
    /// 1/(2G) and 1/(3K), 1/Pa.
    over_shear: f64,
    over_bulk: f64,
    /// √(1 + sin²φ/3): the cone within the pyramid; and its square with little more.
    cone: f64,
    cone_squared: f64,
    /// Stresses below this count as none, Pa.
    negligible: f64,
}

/// A scene's fingerprint is made of this. So what only saves arithmetic is left out: a scene stays the same without it.
impl fmt::Debug for MohrCoulomb {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("MohrCoulomb")
            .field("elastic", &self.elastic)
            .field("parameters", &self.parameters)
            .field("corners", &self.corners)
            .field("lame", &self.lame)
            .field("shear_modulus", &self.shear_modulus)
            .field("bulk_modulus", &self.bulk_modulus)
            .field("cone", &self.cone)
            .field("negligible", &self.negligible)
            .finish()
    }
}

/// What a stress point did in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum YieldState {
    /// No plastic strain.
    #[default]
    Elastic = 0,
    /// On a shear plane.
    Shear = 1,
    /// On an edge of two shear planes: two principal stresses are equal.
    Edge = 2,
    /// At σ = c cot φ I.
    Apex = 3,
    /// On the cut-off, or open.
    Tension = 4,
}

impl YieldState {
    /// All states, in the order of their numbers.
    pub const ALL: [YieldState; 5] = [
        YieldState::Elastic,
        YieldState::Shear,
        YieldState::Edge,
        YieldState::Apex,
        YieldState::Tension,
    ];

    pub fn name(self) -> &'static str {
        match self {
            YieldState::Elastic => "elastic",
            YieldState::Shear => "shear",
            YieldState::Edge => "edge",
            YieldState::Apex => "apex",
            YieldState::Tension => "tension",
        }
    }
}

/// State variables of a particle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MohrCoulombState {
    /// Opening w ≥ 0: volumetric strain by which the material is separated.
    pub opening: f64,
    /// Σ √(2/3 Δe^p : Δe^p), the accumulated equivalent deviatoric plastic strain.
    pub plastic_shear: f64,
    /// Accumulated volumetric plastic strain, dilation and opening together.
    pub plastic_volume: f64,
    /// In the last step.
    pub yielding: YieldState,
}

/// Result of a step of one stress point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlasticStep {
    /// Admissible stress, Pa.
    pub stress: Voigt,
    /// Plastic strain increment, engineering shear strains: the part of the strain increment
    /// that gave no stress, Δε − C⁻¹ Δσ.
    pub plastic_strain: Voigt,
    pub yielding: YieldState,
    /// Change of the opening w.
    pub opening: f64,
}

impl PlasticStep {
    fn elastic(stress: Voigt) -> PlasticStep {
        PlasticStep {
            stress,
            plastic_strain: [0.0; 6],
            yielding: YieldState::Elastic,
            opening: 0.0,
        }
    }

    /// tr Δε^p.
    #[inline(always)]
    pub fn plastic_volume(&self) -> f64 {
        tensor::trace(&self.plastic_strain)
    }

    /// √(2/3 Δe^p : Δe^p) with Δe^p the deviator of the plastic strain increment.
    #[inline(always)]
    pub fn plastic_shear(&self) -> f64 {
        equivalent_strain(&self.plastic_strain)
    }
}

/// √(2/3 e : e) with e the deviator of a strain.
#[inline(always)]
fn equivalent_strain(e: &Voigt) -> f64 {
    let mean = tensor::trace(e) * (1.0 / 3.0);
    let (x, y, z) = (e[0] - mean, e[1] - mean, e[2] - mean);
    let normal = x * x + y * y + z * z;
    let shear = 0.5 * (e[3] * e[3] + e[4] * e[4] + e[5] * e[5]);
    (2.0 / 3.0 * (normal + shear)).sqrt()
}

impl MohrCoulomb {
    /// Checks the parameters. `elastic` must have E > 0 and −1 < ν < ½.
    pub fn new(
        elastic: LinearElastic,
        parameters: MohrCoulombParameters,
    ) -> Result<MohrCoulomb, ParameterError> {
        parameters.check()?;
        let corners = Corners::new(&elastic, &parameters);
        let sin = corners.sin_friction();
        let shear_modulus = elastic.shear_modulus();
        let bulk_modulus = elastic.lame() + 2.0 / 3.0 * shear_modulus;
        Ok(MohrCoulomb {
            elastic,
            parameters,
            corners,
            lame: elastic.lame(),
            shear_modulus,
            bulk_modulus,
            over_shear: 0.5 / shear_modulus,
            over_bulk: 1.0 / (3.0 * bulk_modulus),
            cone: (1.0 + sin * sin / 3.0).sqrt(),
            cone_squared: (1.0 + sin * sin / 3.0) * (1.0 + 1e-9),
            negligible: 1e-12 * (elastic.young_modulus + corners.tip()),
        })
    }

    pub fn elastic(&self) -> &LinearElastic {
        &self.elastic
    }

    pub fn parameters(&self) -> &MohrCoulombParameters {
        &self.parameters
    }

    /// The largest tension that the material takes in all directions, Pa: the cut-off, or
    /// c cot φ without one.
    pub fn tensile_strength(&self) -> f64 {
        self.corners.tip()
    }

    /// max of f and, with a cut-off, σ₁ − T, Pa: positive outside the admissible stresses.
    pub fn yield_function(&self, stress: &Voigt) -> f64 {
        let [largest, _, smallest] = tensor::principal(stress).values;
        self.corners.yield_function(largest, smallest)
    }

    /// A step of one stress point. `stress` (Pa) has been rotated by the step's spin, `strain` is
    /// the increment with engineering shear strains.
    #[inline]
    pub fn update(
        &self,
        stress: &Voigt,
        strain: &Voigt,
        state: &mut MohrCoulombState,
    ) -> PlasticStep {
        let step = if self.is_open(stress, state) {
            self.open_step(stress, strain, state.opening)
        } else {
            self.return_map(&self.predictor(stress, strain))
        };
        state.yielding = step.yielding;
        if step.yielding != YieldState::Elastic {
            state.opening = (state.opening + step.opening).max(0.0);
            state.plastic_shear += step.plastic_shear();
            state.plastic_volume += step.plastic_volume();
        }
        step
    }

    /// The admissible stress of an elastic predictor, Pa.
    #[inline]
    pub fn return_map(&self, trial: &Voigt) -> PlasticStep {
        if self.surely_elastic(trial) {
            return PlasticStep::elastic(*trial);
        }
        self.return_unsure(trial)
    }

    /// Apart, so that the elastic case is small enough for its caller to take in.
    #[inline(never)]
    fn return_unsure(&self, trial: &Voigt) -> PlasticStep {
        let principal = tensor::principal(trial);
        let [largest, _, smallest] = principal.values;
        if self.corners.yield_function(largest, smallest) <= 0.0 {
            return PlasticStep::elastic(*trial);
        }
        let found = self.corners.return_map(&principal.values);
        let stress = principal.with(&found.stress);
        let excess: Voigt = std::array::from_fn(|k| trial[k] - stress[k]);
        PlasticStep {
            stress,
            plastic_strain: self.compliance(&excess),
            yielding: found.yielding,
            opening: found.opening,
        }
    }

    /// The cone inscribed in the pyramid and the sphere-like bound on σ₁: no principal values. Where it holds, the yield
    /// function of principal values is negative in spite of round-off (but within a millionth of the tip): whoever asks that at
    /// once finds the same.
    #[inline(always)]
    fn surely_elastic(&self, s: &Voigt) -> bool {
        let mean = tensor::trace(s) * (1.0 / 3.0);
        let (x, y, z) = (s[0] - mean, s[1] - mean, s[2] - mean);
        let j2 = 0.5 * (x * x + y * y + z * z) + (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
        let shear = self.corners.half_strength() - mean * self.corners.sin_friction();
        let tension = self.corners.tip() - mean;
        // No branches: this is asked of particles side by side.
        (shear >= 0.0)
            & (tension >= 0.0)
            & (j2 * self.cone_squared <= shear * shear)
            & (4.0 / 3.0 * j2 <= tension * tension)
    }

    /// Opened, and neither closed nor in shear since.
    #[inline]
    fn is_open(&self, stress: &Voigt, state: &MohrCoulombState) -> bool {
        if state.opening <= 0.0 {
            return false;
        }
        let mean = tensor::trace(stress) / 3.0;
        mean >= -self.negligible
            && (0..3).all(|k| {
                (stress[k] - mean).abs() <= self.negligible
                    && stress[k + 3].abs() <= self.negligible
            })
    }

    /// A step of open material, see the module's text.
    #[inline(never)]
    fn open_step(&self, stress: &Voigt, strain: &Voigt, opening: f64) -> PlasticStep {
        let tip = self.corners.tip();
        let volumetric = tensor::trace(strain);
        let mean = tensor::trace(stress) / 3.0;
        let trial = mean + self.bulk_modulus * volumetric;
        let closing = (-trial / self.bulk_modulus).max(0.0);
        let mut step = PlasticStep::elastic([0.0; 6]);
        if closing > opening {
            // `volumetric` is compressive here, but for round-off in a stress that is none.
            let share = if volumetric < 0.0 {
                ((closing - opening) / -volumetric).min(1.0)
            } else {
                0.0
            };
            let rest: Voigt = std::array::from_fn(|k| share * strain[k]);
            step = self.return_map(&self.predictor(&[0.0; 6], &rest));
            step.opening -= opening;
        } else {
            let new = trial.clamp(0.0, tip);
            step.stress = [new, new, new, 0.0, 0.0, 0.0];
            step.opening = (trial - new) / self.bulk_modulus;
        }
        let change: Voigt = std::array::from_fn(|k| step.stress[k] - stress[k]);
        let elastic_strain = self.compliance(&change);
        step.plastic_strain = std::array::from_fn(|k| strain[k] - elastic_strain[k]);
        if step.yielding == YieldState::Elastic {
            step.yielding = YieldState::Tension;
        }
        step
    }

    /// [`LinearElastic::update`] with its moduli at hand.
    #[inline(always)]
    fn predictor(&self, stress: &Voigt, strain: &Voigt) -> Voigt {
        let (mean, shear) = (self.lame * tensor::trace(strain), self.shear_modulus);
        std::array::from_fn(|k| {
            stress[k]
                + if k < 3 {
                    mean + 2.0 * shear * strain[k]
                } else {
                    shear * strain[k]
                }
        })
    }

    /// C⁻¹ σ, with engineering shear strains.
    #[inline(always)]
    fn compliance(&self, stress: &Voigt) -> Voigt {
        self.strain_of(stress).0
    }

    /// C⁻¹ σ, √(2/3 e : e) with its deviator e, and its trace.
    #[inline(always)]
    fn strain_of(&self, stress: &Voigt) -> (Voigt, f64, f64) {
        let (half, mean) = (self.over_shear, tensor::trace(stress) * (1.0 / 3.0));
        let bulk = mean * self.over_bulk;
        let (x, y, z) = (stress[0] - mean, stress[1] - mean, stress[2] - mean);
        let shear = [stress[3], stress[4], stress[5]];
        let strain = [
            x * half + bulk,
            y * half + bulk,
            z * half + bulk,
            2.0 * half * shear[0],
            2.0 * half * shear[1],
            2.0 * half * shear[2],
        ];
        let mixed = shear[0] * shear[0] + shear[1] * shear[1] + shear[2] * shear[2];
        let square = (x * x + y * y + z * z) + 2.0 * mixed;
        (strain, (2.0 / 3.0 * square).sqrt() * half, 3.0 * bulk)
    }
}
