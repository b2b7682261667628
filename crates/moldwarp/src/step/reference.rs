//! A reference stress that mean stresses are taken about.
//!
//! In filled cells the mean of the particles' stresses stands for the stress at the centroid. Under
//! gravity stress grows with depth, so that a cell whose particles happen to lie low has too much of
//! it, and ground at rest trembles as soon as a mesh moves through it. Therefore the mean is taken
//! about the ground's initial stress σ₀(x), and gravity is integrated as σ₀'s gradient is:
//!
//!   σ̄ = Σ (σ_p − σ₀(x_p)) V_p / Σ V_p + σ₀(x_c),   f_i = γ V_e/4 at each node.
//!
//! Where particles have their initial stress the forces then balance exactly, wherever they are.
//! (Well-balanced schemes: the idea is that of Greenberg and Leroux 1996.) The difference between
//! this weight and that of the particles goes to `integration` in the ledger.

use super::CellMedium;
use super::to_nodes::Around;
use crate::Vec3;
use crate::mesh::Mesh;
use crate::particles::initial_stress::Ground;
use crate::tensor::{Voigt, add_scaled};

/// The initial stress, kept.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    pub ground: Ground,
    /// K₀ of each body; one without it has no reference stress.
    pub k0: Vec<Option<f64>>,
    /// Gravity for which it is the ground's stress, m/s².
    pub gravity: Vec3,
}

/// The same under the gravity of an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scaled<'a> {
    reference: &'a Reference,
    /// Gravity over that of the plan.
    level: f64,
}

impl Reference {
    /// Adds a particle to the sums of the cell in a lane.
    #[inline]
    pub fn add(&self, medium: &mut CellMedium, lane: usize, body: usize, x: Vec3, volume: f64) {
        if let Some(k0) = self.k0[body] {
            let vertical = self.ground.vertical(x) * volume;
            medium.reference[0][lane] += vertical;
            medium.reference[1][lane] += k0 * vertical;
            medium.reference[2][lane] += volume;
        }
    }

    pub(super) fn at(&self, gravity: Vec3) -> Scaled<'_> {
        Scaled {
            reference: self,
            level: gravity.length() / self.gravity.length(),
        }
    }
}

impl Scaled<'_> {
    /// σ̄ of an element, Pa.
    pub fn mean_stress(&self, mesh: &Mesh, e: usize, around: &Around) -> Voigt {
        let [vertical, horizontal, volume] = around.reference;
        if volume == 0.0 {
            return around.mean_stress();
        }
        let ground = &self.reference.ground;
        let mut mean = around.stress;
        add_scaled(&mut mean, &ground.tensor(vertical, horizontal), -self.level);
        let k0 = if vertical == 0.0 {
            0.0
        } else {
            horizontal / vertical
        };
        let own = ground.stress(mesh.centroid(e), k0);
        add_scaled(&mut mean, &own, self.level * volume);
        mean.map(|s| s / around.volume)
    }

    /// The mass whose weight pulls at each node, kg: γ V_e/4g for the share of the material that has a
    /// reference stress, and of the rest what the particles have there.
    pub fn weighed(&self, mesh: &Mesh, e: usize, mass: [f64; 4], around: &Around) -> [f64; 4] {
        let share = around.reference[2] / around.volume;
        if around.volume == 0.0 || share == 0.0 {
            return mass;
        }
        let unit_weight = self.reference.ground.unit_weight(mesh.centroid(e));
        let even = unit_weight / self.reference.gravity.length() * mesh.volumes[e] / 4.0;
        mass.map(|m| share * even + (1.0 - share) * m)
    }
}
