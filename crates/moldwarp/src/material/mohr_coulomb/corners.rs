//! The return in the space of sorted principal stresses.
//!
//! Isotropic elasticity keeps the order of the principal stresses, so a sorted predictor can only
//! end on the planes that touch the sextant σ₁ ≥ σ₂ ≥ σ₃: shear planes of the pairs 13, 23 (on the
//! edge σ₁ = σ₂) and 12 (on the edge σ₂ = σ₃), and the cut-off planes 1, 2, 3. Which of their
//! corners (planes, edges and points, all called corners here) takes a predictor is decided by
//! conditions on the result: factors of the flow directions not negative, other planes not
//! exceeded. The regions of the corners tile the space, because all the determinants met here are
//! positive for ψ ≤ φ < 90° and any admissible elasticity, so exactly one corner
//! satisfies its conditions; at borders, where round-off may let none, the corner is taken that
//! violates them least, and is in error by round-off too.

use super::{MohrCoulombParameters, YieldState};
use crate::lanes::{either, larger, smaller};
use crate::material::LinearElastic;
use std::fmt;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Corner {
    /// Shear plane 13.
    Plane,
    /// Shear planes 13 and 23, σ₁ = σ₂.
    UpperEdge,
    /// Shear planes 13 and 12, σ₂ = σ₃.
    LowerEdge,
    /// All shear planes, without a cut-off.
    Apex,
    /// Cut-off planes 1; 1 and 2; 1, 2 and 3.
    CutoffPlane,
    CutoffEdge,
    CutoffPoint,
    /// Cut-off plane 1 and shear plane 13.
    MixedEdge,
    /// (T, T, z): cut-off planes 1 and 2, shear planes 13 and 23.
    UpperPoint,
    /// (T, z, z): cut-off plane 1, shear planes 13 and 12.
    LowerPoint,
}

impl Corner {
    #[inline(always)]
    fn yielding(self) -> YieldState {
        match self {
            Corner::Plane => YieldState::Shear,
            Corner::UpperEdge | Corner::LowerEdge => YieldState::Edge,
            Corner::Apex => YieldState::Apex,
            _ => YieldState::Tension,
        }
    }
}

/// Result of the return.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub stress: [f64; 3],
    pub corner: Corner,
    /// What `corner` is called outside. (Kept, as a table of it would keep loops over lanes scalar.)
    pub yielding: YieldState,
    /// Volumetric plastic strain of the cut-off planes, or at the apex.
    pub opening: f64,
    /// Largest violation of the corner's conditions, Pa.
    pub violation: f64,
}

impl Found {
    /// This one if it violates nothing, else the one of the two that violates less.
    #[inline(always)]
    fn or(self, other: Found) -> Found {
        let better = (self.violation > 0.0) & (other.violation < self.violation);
        Found {
            stress: [
                either(better, other.stress[0], self.stress[0]),
                either(better, other.stress[1], self.stress[1]),
                either(better, other.stress[2], self.stress[2]),
            ],
            corner: either(better, other.corner, self.corner),
            yielding: either(better, other.yielding, self.yielding),
            opening: either(better, other.opening, self.opening),
            violation: either(better, other.violation, self.violation),
        }
    }
}

/// Constants of the surface and of the flow. What the return needs is computed once: what is the same for all particles
/// would still be computed for each few.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Corners {
    /// sin φ, 1 + sin φ, 1 − sin φ (without cancellation), 2 c cos φ.
    sin: f64,
    up: f64,
    down: f64,
    strength: f64,
    /// 1 + sin ψ, 1 − sin ψ: shear plane ij flows along (1 + sin ψ) eᵢ − (1 − sin ψ) eⱼ. And their reciprocals.
    flow_up: f64,
    flow_down: f64,
    over_flow_up: f64,
    over_flow_down: f64,
    /// T, or c cot φ.
    tip: f64,
    has_cutoff: bool,
    /// Smallest principal stress where shear plane and cut-off meet.
    foot: f64,
    /// λ, 2G, 1/(2G), ν, and ν/(1 + ν).
    lame: f64,
    shear: f64,
    over_shear: f64,
    poisson: f64,
    poisson_share: f64,
    /// C times the flow direction of plane 13, and means of its two upper and its two lower components.
    relief: [f64; 3],
    upper_relief: f64,
    lower_relief: f64,
    /// 1 / n₁₃ · C m₁₃, and 1 / n₁₃ · C (m₁₃ + m₂₃), 1 / n₁₃ · C (m₁₃ + m₁₂).
    plane: f64,
    upper: f64,
    lower: f64,
}

/// A scene's fingerprint is made of this. So what only saves arithmetic is left out: a scene stays the same without it.
impl fmt::Debug for Corners {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("Corners")
            .field("sin", &self.sin)
            .field("up", &self.up)
            .field("down", &self.down)
            .field("half_strength", &self.half_strength())
            .field("flow_up", &self.flow_up)
            .field("flow_down", &self.flow_down)
            .field("tip", &self.tip)
            .field("has_cutoff", &self.has_cutoff)
            .field("foot", &self.foot)
            .field("lame", &self.lame)
            .field("shear", &self.shear)
            .field("poisson", &self.poisson)
            .field("poisson_share", &self.poisson_share)
            .field("relief", &self.relief)
            .field("plane", &self.plane)
            .field("upper", &self.upper)
            .field("lower", &self.lower)
            .finish()
    }
}

impl Corners {
    pub(super) fn new(elastic: &LinearElastic, parameters: &MohrCoulombParameters) -> Corners {
        let sine = |angle: f64| {
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            (sin, cos, 1.0 + sin, cos * cos / (1.0 + sin))
        };
        let (sin, cos, up, down) = sine(parameters.friction_angle);
        let (flow_sin, _, flow_up, flow_down) = sine(parameters.dilation_angle);
        let strength = 2.0 * parameters.cohesion * cos;
        let cutoff = parameters.effective_cutoff();
        let tip = cutoff.or(parameters.apex()).unwrap_or(f64::INFINITY);
        let (lame, shear) = (elastic.lame(), 2.0 * elastic.shear_modulus());
        let volume = lame * 2.0 * flow_sin;
        let relief = [volume + shear * flow_up, volume, volume - shear * flow_down];
        let own = up * relief[0] - down * relief[2];
        let poisson = elastic.poisson_ratio;
        Corners {
            sin,
            up,
            down,
            strength,
            flow_up,
            flow_down,
            over_flow_up: 1.0 / flow_up,
            over_flow_down: 1.0 / flow_down,
            tip,
            has_cutoff: cutoff.is_some(),
            foot: (up * tip - strength) / down,
            lame,
            shear,
            over_shear: 1.0 / shear,
            poisson,
            poisson_share: poisson / (1.0 + poisson),
            relief,
            upper_relief: 0.5 * (relief[0] + relief[1]),
            lower_relief: 0.5 * (relief[1] + relief[2]),
            plane: 1.0 / own,
            upper: 1.0 / (2.0 * own - shear * up * flow_up),
            lower: 1.0 / (2.0 * own - shear * down * flow_down),
        }
    }

    pub(super) fn sin_friction(&self) -> f64 {
        self.sin
    }

    /// c cos φ, Pa.
    pub(super) fn half_strength(&self) -> f64 {
        0.5 * self.strength
    }

    /// T, or c cot φ.
    pub(super) fn tip(&self) -> f64 {
        self.tip
    }

    /// f of a pair of principal stresses.
    #[inline(always)]
    pub(super) fn shear_function(&self, a: f64, b: f64) -> f64 {
        self.up * a - self.down * b - self.strength
    }

    /// max(f, σ₁ − T) from the largest and the smallest principal stress.
    pub(super) fn yield_function(&self, largest: f64, smallest: f64) -> f64 {
        let shear = self.shear_function(largest, smallest);
        if self.has_cutoff {
            shear.max(largest - self.tip)
        } else {
            shear
        }
    }

    /// The admissible stress of a sorted predictor `t` outside the surface.
    pub(super) fn return_map(&self, t: &[f64; 3]) -> Found {
        if !self.has_cutoff {
            return self.return_without_cutoff(t);
        }
        // Most often.
        let mut best = self.onto_plane(t);
        if best.violation <= 0.0 {
            return best;
        }
        let tries: [fn(&Corners, &[f64; 3]) -> Found; 8] = [
            Corners::onto_upper_edge,
            Corners::onto_lower_edge,
            Corners::onto_cutoff_plane,
            Corners::onto_cutoff_edge,
            Corners::onto_cutoff_point,
            Corners::onto_mixed_edge,
            Corners::onto_upper_point,
            Corners::onto_lower_point,
        ];
        for onto_corner in tries {
            let found = onto_corner(self, t);
            if found.violation <= 0.0 {
                return found;
            }
            if found.violation < best.violation {
                best = found;
            }
        }
        best
    }

    pub(super) fn has_cutoff(&self) -> bool {
        self.has_cutoff
    }

    /// The same without a cut-off, and without branches, so that several can be returned side by side.
    #[inline(always)]
    pub(super) fn return_without_cutoff(&self, t: &[f64; 3]) -> Found {
        // The same as one after another; two pairs wait less for each other.
        let upper = self.onto_plane(t).or(self.onto_upper_edge(t));
        let lower = self.onto_lower_edge(t).or(self.onto_apex(t));
        upper.or(lower)
    }

    /// 2G C⁻¹ d.
    #[inline(always)]
    fn strain(&self, d: [f64; 3]) -> [f64; 3] {
        let mean = self.poisson_share * (d[0] + d[1] + d[2]);
        [d[0] - mean, d[1] - mean, d[2] - mean]
    }

    /// A result without opening. Without a cut-off its conditions on σ₁ never matter more than
    /// those that keep σ below the apex.
    #[inline(always)]
    fn shear_result(&self, stress: [f64; 3], corner: Corner, violation: f64) -> Found {
        let order = larger(stress[1] - stress[0], stress[2] - stress[1]);
        Found {
            stress,
            corner,
            yielding: corner.yielding(),
            opening: 0.0,
            violation: larger(larger(violation, order), stress[0] - self.tip),
        }
    }

    /// `opening` and `violation` in units of 2G times a strain.
    #[inline(always)]
    fn cutoff_result(
        &self,
        stress: [f64; 3],
        corner: Corner,
        opening: f64,
        violation: f64,
    ) -> Found {
        Found {
            stress,
            corner,
            yielding: corner.yielding(),
            opening: larger(opening, 0.0) * self.over_shear,
            violation,
        }
    }

    #[inline(always)]
    fn onto_plane(&self, t: &[f64; 3]) -> Found {
        let factor = self.shear_function(t[0], t[2]) * self.plane;
        let stress = [
            t[0] - factor * self.relief[0],
            t[1] - factor * self.relief[1],
            t[2] - factor * self.relief[2],
        ];
        self.shear_result(stress, Corner::Plane, -factor * self.shear)
    }

    /// Sum s of both planes' factors from f₁₃ + f₂₃ = 0, their difference from σ₁ = σ₂.
    #[inline(always)]
    fn onto_upper_edge(&self, t: &[f64; 3]) -> Found {
        let sum = (self.shear_function(t[0], t[2]) + self.shear_function(t[1], t[2])) * self.upper;
        let difference = (t[0] - t[1]) * self.over_flow_up;
        let high = 0.5 * (t[0] + t[1]) - sum * self.upper_relief;
        let stress = [high, high, t[2] - sum * self.relief[2]];
        self.shear_result(stress, Corner::UpperEdge, difference - sum * self.shear)
    }

    #[inline(always)]
    fn onto_lower_edge(&self, t: &[f64; 3]) -> Found {
        let sum = (self.shear_function(t[0], t[2]) + self.shear_function(t[0], t[1])) * self.lower;
        let difference = (t[1] - t[2]) * self.over_flow_down;
        let low = 0.5 * (t[1] + t[2]) - sum * self.lower_relief;
        let stress = [t[0] - sum * self.relief[0], low, low];
        self.shear_result(stress, Corner::LowerEdge, difference - sum * self.shear)
    }

    /// The cone of flow directions; for ψ = 0 its closure, all increments with tr ε ≥ 0.
    #[inline(always)]
    fn onto_apex(&self, t: &[f64; 3]) -> Found {
        let e = self.strain(t.map(|t| t - self.tip));
        let (up, down) = (self.flow_up, self.flow_down);
        let violation = -smaller(
            down * (e[0] + e[1]) + up * e[2],
            down * e[0] + up * (e[1] + e[2]),
        );
        self.cutoff_result([self.tip; 3], Corner::Apex, e[0] + e[1] + e[2], violation)
    }

    fn onto_cutoff_plane(&self, t: &[f64; 3]) -> Found {
        let factor = (t[0] - self.tip) / (self.lame + self.shear);
        let stress = [
            self.tip,
            t[1] - self.lame * factor,
            t[2] - self.lame * factor,
        ];
        let opening = factor * self.shear;
        let violation = (-opening)
            .max(stress[1] - self.tip)
            .max(self.shear_function(self.tip, stress[2]));
        self.cutoff_result(stress, Corner::CutoffPlane, opening, violation)
    }

    fn onto_cutoff_edge(&self, t: &[f64; 3]) -> Found {
        let sum = (t[0] - self.tip + t[1] - self.tip) / (2.0 * self.lame + self.shear);
        let opening = sum * self.shear;
        let low = t[2] - self.lame * sum;
        let violation = (t[0] - t[1] - opening)
            .max(low - self.tip)
            .max(self.shear_function(self.tip, low));
        self.cutoff_result(
            [self.tip, self.tip, low],
            Corner::CutoffEdge,
            opening,
            violation,
        )
    }

    fn onto_cutoff_point(&self, t: &[f64; 3]) -> Found {
        let e = self.strain(t.map(|t| t - self.tip));
        self.cutoff_result(
            [self.tip; 3],
            Corner::CutoffPoint,
            e[0] + e[1] + e[2],
            -e[2],
        )
    }

    /// σ₁ and σ₃ are known, σ₂ follows from a plastic strain without component 2.
    fn onto_mixed_edge(&self, t: &[f64; 3]) -> Found {
        let (d1, d3) = (t[0] - self.tip, t[2] - self.foot);
        let middle = t[1] - self.poisson * (d1 + d3);
        let e1 = d1 - self.poisson * (d1 + d3);
        let e3 = d3 - self.poisson * (d1 + d3);
        let opening = e1 + self.flow_up / self.flow_down * e3;
        let violation = (-opening)
            .max(e3)
            .max(middle - self.tip)
            .max(self.foot - middle);
        self.cutoff_result(
            [self.tip, middle, self.foot],
            Corner::MixedEdge,
            opening,
            violation,
        )
    }

    fn onto_upper_point(&self, t: &[f64; 3]) -> Found {
        let stress = [self.tip, self.tip, self.foot];
        let e = self.strain(std::array::from_fn(|i| t[i] - stress[i]));
        let opening = e[0] + e[1] + self.flow_up / self.flow_down * e[2];
        let violation = (-opening).max(e[2]).max(-e[1]);
        self.cutoff_result(stress, Corner::UpperPoint, opening, violation)
    }

    fn onto_lower_point(&self, t: &[f64; 3]) -> Found {
        let stress = [self.tip, self.foot, self.foot];
        let e = self.strain(std::array::from_fn(|i| t[i] - stress[i]));
        let opening = e[0] + self.flow_up / self.flow_down * (e[1] + e[2]);
        let violation = (-opening).max(e[1]);
        self.cutoff_result(stress, Corner::LowerPoint, opening, violation)
    }
}
