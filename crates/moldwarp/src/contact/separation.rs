//! The direction in which two clouds of particles are apart.
//!
//! Mass gradients point wherever particles happen to be: as bodies slide through the mesh they
//! waver by tens of degrees, and a block is held back by normals that lean against it. But the
//! bodies themselves are known, as balls inside of them (`depth`). Along n the gap between a and b is
//!
//!   gap(n) = min_b (x_b · n − d_b) − max_a (x_a · n + d_a),
//!
//! and the normal is the direction in which it is greatest: the plane that separates both best. For
//! flat faces it is theirs, at edges that of the other body's face; it is unique and the same for both.

use crate::{Mat3, Vec3};

/// First change of direction, rad, and what each one is of the last.
const FIRST: f64 = 0.4;
const DECAY: f64 = 0.8;
const CHANGES: usize = 32;

/// A particle: its position from the node, and its depth, m.
pub type Ball = (Vec3, f64);

/// The direction from a to b, found from `start` (a unit vector) within the directions that are
/// `free`, and the gap along it, m.
pub fn separate<A, B>(a: impl Fn() -> A, b: impl Fn() -> B, start: Vec3, free: &Mat3) -> (Vec3, f64)
where
    A: Iterator<Item = Ball>,
    B: Iterator<Item = Ball>,
{
    let mut n = start;
    let (mut best, mut widest) = (n, f64::NEG_INFINITY);
    let mut change = FIRST;
    for _ in 0..CHANGES {
        let (far, reach) = outermost(a(), n);
        let (near, other) = outermost(b(), -n);
        let gap = -other - reach;
        if gap > widest {
            (best, widest) = (n, gap);
        }
        // The gap grows fastest towards the difference of the two that bound it.
        let towards = *free * (near - far);
        let across = (towards - n * n.dot(towards)).normalize_or_zero();
        if across == Vec3::ZERO {
            break;
        }
        n = (n + across * change).normalize();
        change *= DECAY;
    }
    (best, widest)
}

/// The ball that reaches farthest along n, and how far.
pub fn outermost(balls: impl Iterator<Item = Ball>, n: Vec3) -> (Vec3, f64) {
    let mut found = (Vec3::ZERO, f64::NEG_INFINITY);
    for (x, depth) in balls {
        let reach = x.dot(n) + depth;
        if reach > found.1 {
            found = (x, reach);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Particles of a floor and of the corner of a block that stands on it, at heights that are not
    /// alike: the normal is the floor's to a tenth of a degree, though the block ends here.
    #[test]
    fn a_corner_on_a_floor_has_the_floors_normal() {
        let (mut floor, mut block) = (Vec::new(), Vec::new());
        for i in -8..8 {
            for j in -8..8 {
                let height = 0.1 + 0.05 * f64::from((3 * i + 5 * j) % 4).abs();
                let [x, y] = [i, j].map(|k| (f64::from(k) + 0.5) / 8.0);
                floor.push((Vec3::new(x, y, -height), height));
                if x < 0.0 && y < 0.0 {
                    let depth = height.min(-x).min(-y);
                    block.push((Vec3::new(x, y, 0.01 + height), depth));
                }
            }
        }
        let start = Vec3::new(0.5, 0.4, 0.7).normalize();
        let (n, gap) = separate(
            || floor.iter().copied(),
            || block.iter().copied(),
            start,
            &Mat3::IDENTITY,
        );
        assert!(n.z > 0.999_998, "{n}");
        assert!((gap - 0.01).abs() < 1e-3, "{gap}");
    }
}
