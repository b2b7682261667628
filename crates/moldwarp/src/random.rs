//! Seeded random numbers for tests: equal on every machine and in every version.

use crate::{Mat3, Vec3};

/// SplitMix64 (Steele, Lea and Flood 2014).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random(seed)
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [low, high).
    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// A rotation, uniform over all (from a quaternion within the unit ball).
    pub(crate) fn rotation(&mut self) -> Mat3 {
        loop {
            let [w, x, y, z]: [f64; 4] = std::array::from_fn(|_| self.within(-1.0, 1.0));
            let square = w * w + x * x + y * y + z * z;
            if square > 0.1 && square <= 1.0 {
                let (w, v) = (w / square.sqrt(), Vec3::new(x, y, z) / square.sqrt());
                let cross = Mat3::from_cols(
                    Vec3::new(0.0, v.z, -v.y),
                    Vec3::new(-v.z, 0.0, v.x),
                    Vec3::new(v.y, -v.x, 0.0),
                );
                return Mat3::IDENTITY + cross * (2.0 * w) + cross * cross * 2.0;
            }
        }
    }
}
