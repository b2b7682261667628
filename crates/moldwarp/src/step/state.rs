//! What the step keeps per node and per cell.

use super::Active;
use crate::tensor::Voigt;
use crate::{Mat3, Vec3};

/// A node that particles touch. Forces in N, work in J.
#[derive(Clone, Copy, Debug, Default)]
pub struct Node {
    /// m_i = Σ m_p N_i, kg.
    pub mass: f64,
    /// v_i = Σ m_p v_p N_i / m_i before the kick, m/s.
    pub velocity: Vec3,
    /// (change of velocity in the kick) / h: F_i / m_i with all that holds the node, m/s².
    pub acceleration: Vec3,
    /// What particles receive of it, corrected for averaging, m/s².
    pub received: Vec3,
    /// Loads.
    pub load: Vec3,
    /// Local damping.
    pub damping: Vec3,
    /// Force of an absorbing boundary.
    pub absorbing: Vec3,
    /// Force of fixities, rollers and prescribed velocities.
    pub reaction: Vec3,
    /// Σ m_p v_p N_i / m_i of the updated particles, m/s.
    pub average: Vec3,
    /// Velocity after the remap, with which the mesh moves the material, m/s.
    pub grid_velocity: Vec3,
    /// Δu_i of the last drift, m.
    pub moved: Vec3,
    /// φ: volume of particles over volume of elements, of all elements attached.
    pub filling: f64,
    /// Mass over volume of all elements attached, kg/m³.
    pub density: f64,
    /// The mass whose weight pulls at the node, kg: `mass`, but for a reference stress (see
    /// `step/reference.rs`).
    pub weighed: f64,
    /// Averaged volumetric strain of the attached cells.
    pub volumetric: f64,
    /// A quarter of the averaged mean stress of the attached cells, Pa.
    pub mean_stress: f64,
}

/// Sums over the particles of a cell that its nodes gather.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellSums {
    /// Σ m_p N_i for each node, kg.
    pub mass: [f64; 4],
    /// Σ m_p v_p N_i for each node, kg m/s; after stage 3 with the new velocities.
    pub momentum: [Vec3; 4],
    /// Σ V_p, m³.
    pub volume: f64,
    /// Σ V_p without what has opened in tension, m³: it judges filling.
    pub solid: f64,
}

/// M_ij = Σ m_p N_i N_j of each pair of a cell's nodes: 01, 02, 03, 12, 13, 23, kg.
pub type CellPairs = [f64; 6];

/// Sums over the particles of a cell that make its stress.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellStress {
    /// Σ σ_p V_p, J.
    pub stress: Voigt,
    /// Σ V_p of particles that are not separated, m³.
    pub closed: f64,
    /// Σ λ V_p and Σ G V_p, J; kept where there is viscosity only.
    pub moduli: [f64; 2],
    /// Greatest constrained modulus of its particles, Pa.
    pub wave_modulus: f64,
    /// Of particles with a reference stress: Σ σ_v V_p and Σ K₀ σ_v V_p, J, and Σ V_p, m³.
    pub reference: [f64; 3],
}

/// Stress times volume that acts on a cell's nodes: f_i = −S ∇N_i.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellForce {
    /// σ̄ V_e if filled, else Σ σ_p V_p, J.
    pub stress: Voigt,
    /// What smoothing has added to its mean, J.
    pub smoothed: f64,
    /// The viscous part, J.
    pub viscous: Voigt,
    /// The mass whose weight pulls at each node, kg; set where there is a reference stress only.
    pub weighed: [f64; 4],
    /// Whether the cell counts as filled.
    pub filled: bool,
}

impl CellForce {
    /// Half the work of what smoothing has added, J.
    pub(super) fn half_smoothing_work(&self, gradient: &Mat3) -> f64 {
        0.5 * self.smoothed * (gradient.x_axis.x + gradient.y_axis.y + gradient.z_axis.z)
    }
}

/// Displacements in the last drift by mesh node, m: the mean of all fields by mass; zero where no
/// particle is near.
pub(super) fn moved<'a>(active: &'a Active, nodes: &'a [Node]) -> impl Fn(u32) -> Vec3 + 'a {
    |mesh_node| {
        let keys = (mesh_node as usize..active.slot_of_key.len()).step_by(active.grid_nodes);
        let slots = keys.filter_map(|key| nodes.get(active.slot_of_key[key] as usize));
        let mut present = slots.filter(|node| node.mass > 0.0);
        let Some(first) = present.next() else {
            return Vec3::ZERO;
        };
        let Some(second) = present.next() else {
            return first.moved;
        };
        let (mut mass, mut sum) = (0.0, Vec3::ZERO);
        for node in [first, second].into_iter().chain(present) {
            mass += node.mass;
            sum += node.moved * node.mass;
        }
        sum / mass
    }
}

/// Deformation of a cell in a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct CellStrain {
    /// With ∇Δu = Σ Δu_i ⊗ ∇N_i in the configuration at the start of the step, the same in its middle,
    /// ∇Δu (I + ½∇Δu)⁻¹: a rigid rotation has none of it but
    /// spin, and its trace is the logarithmic volume strain to third order.
    pub midpoint: Mat3,
    /// Trace of `midpoint`.
    pub volumetric: f64,
}
