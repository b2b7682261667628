//! Cells side by side with their deformation in a step and the stresses that do work on it.

use super::shapes::{Corners, NO_CORNERS, Shapes, all_corners};
use super::{CellForce, CellStress, strain};
use crate::Mat3;
use crate::lanes::{LANES, Lane, VoigtLanes, get, set, whole};
use crate::tensor;

/// Cells side by side with their deformation in a step and what works on it.
pub(super) struct Deformed {
    pub shapes: Shapes,
    pub moved: Corners,
    /// Stress times volume of particles and of the cell, and the viscous part, J.
    particles: VoigtLanes,
    pub cell: VoigtLanes,
    pub viscous: VoigtLanes,
    /// Part of `cell` that is left out of the work.
    smoothed: Lane,
    /// What the stresses make at the nodes, N.
    pub force: Corners,
}

impl Default for Deformed {
    fn default() -> Deformed {
        let zero = [[0.0; LANES]; 6];
        Deformed {
            shapes: Shapes::default(),
            moved: NO_CORNERS,
            particles: zero,
            cell: zero,
            viscous: zero,
            smoothed: [0.0; LANES],
            force: NO_CORNERS,
        }
    }
}

impl Deformed {
    #[inline(always)]
    pub fn load_stresses(&mut self, l: usize, stress: &CellStress, force: &CellForce) {
        set(&mut self.particles, l, stress.stress);
        set(&mut self.cell, l, force.stress);
        set(&mut self.viscous, l, force.viscous);
        self.smoothed[l] = force.smoothed;
    }

    /// No stresses in the lanes beyond these.
    pub fn clear(&mut self, lanes: usize) {
        let rest = lanes..whole(lanes);
        let arrays = (self.particles.iter_mut())
            .chain(&mut self.cell)
            .chain(&mut self.viscous);
        arrays.for_each(|a| a[rest.clone()].fill(0.0));
        self.smoothed[rest].fill(0.0);
    }

    /// ∇Δu.
    #[inline(always)]
    pub fn gradient(&self, l: usize) -> Mat3 {
        strain::gradient(&self.shapes.gradients(l), all_corners(&self.moved, l))
    }

    /// Half the work of the stresses on the deformation: as [`CellForce::half_work`], and of smoothing.
    #[inline(always)]
    pub fn half_work(&self, l: usize, gradient: &Mat3) -> [f64; 4] {
        let strain = tensor::strain(gradient);
        let own = 0.5 * tensor::dot(&get(&self.particles, l), &strain);
        let smoothed = 0.5 * self.smoothed[l] * tensor::trace(&strain);
        let all = 0.5 * tensor::dot(&get(&self.cell, l), &strain) - smoothed;
        let viscous = 0.5 * tensor::dot(&get(&self.viscous, l), &strain);
        [own, all - own, viscous, smoothed]
    }
}
