//! Rigid bodies: one velocity, no rotation, the mass of the whole body.
//!
//! Their particles have no stress and do not count in the stable step. Where a constraint holds one
//! of its nodes the whole body is held, so that on planes of symmetry it moves along them.

use super::Fields;
use crate::plan::Plan;
use crate::{Mat3, Vec3};

/// A body that moves as one.
#[derive(Clone, Copy, Debug)]
pub struct Rigid {
    pub field: usize,
    /// kg.
    pub mass: f64,
    /// Velocity before the kick, and at its end, m/s.
    pub before: Vec3,
    pub velocity: Vec3,
    /// Projects into the directions in which nothing holds it.
    pub free: Mat3,
}

/// The rigid bodies of a plan.
pub(super) fn bodies(plan: &Plan, fields: &Fields) -> Vec<Rigid> {
    let rigid = (0..plan.bodies.len()).filter(|&b| is_rigid(plan, b));
    rigid
        .map(|body| Rigid {
            field: fields.of(body as u16),
            mass: 0.0,
            before: Vec3::ZERO,
            velocity: Vec3::ZERO,
            free: Mat3::IDENTITY,
        })
        .collect()
}

/// Whether a body is of rigid material.
pub fn is_rigid(plan: &Plan, body: usize) -> bool {
    plan.materials[plan.bodies[body].material].model.is_rigid()
}

/// Directions that are held, orthonormal.
#[derive(Clone, Copy, Debug, Default)]
pub struct HeldDirections {
    directions: [Vec3; 3],
    count: usize,
}

impl HeldDirections {
    /// Adds what a projector into free directions blocks.
    pub fn add(&mut self, free: &Mat3) {
        let blocked = Mat3::IDENTITY - *free;
        for mut rest in [blocked.x_axis, blocked.y_axis, blocked.z_axis] {
            for d in &self.directions[..self.count] {
                rest -= *d * d.dot(rest);
            }
            // Round-off of normals is no direction.
            if self.count < 3 && rest.length() > 1e-6 {
                self.directions[self.count] = rest.normalize();
                self.count += 1;
            }
        }
    }

    /// Projects into what is left.
    pub fn free(&self) -> Mat3 {
        let outer = |n: Vec3| Mat3::from_cols(n * n.x, n * n.y, n * n.z);
        match self.count {
            0 => Mat3::IDENTITY,
            1 => Mat3::IDENTITY - outer(self.directions[0]),
            2 => outer(self.directions[0].cross(self.directions[1]).normalize()),
            _ => Mat3::ZERO,
        }
    }
}
