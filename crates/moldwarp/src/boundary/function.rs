//! Functions of time that scale loads and prescribed velocities.

/// A dimensionless function of the time since the run's start.
#[derive(Clone, Debug, PartialEq)]
pub enum Function {
    /// 1.
    Constant,
    /// From 0 at the start to 1 after `duration` s, then 1.
    Ramp { duration: f64 },
    /// Straight lines between points (time in s, value), constant outside them. Times increase.
    Table { points: Vec<(f64, f64)> },
    /// `count` pulses sin(πt/duration), each `period` s after the one before.
    HalfSine {
        duration: f64,
        period: f64,
        count: u32,
    },
}

impl Function {
    /// Value at time `t`, s.
    pub fn value(&self, t: f64) -> f64 {
        match self {
            Function::Constant => 1.0,
            Function::Ramp { duration } => (t / duration).clamp(0.0, 1.0),
            Function::Table { points } => table(points, t),
            Function::HalfSine {
                duration,
                period,
                count,
            } => {
                let pulse = (t / period).floor().clamp(0.0, f64::from(*count) - 1.0);
                let since = t - pulse * period;
                if (0.0..=*duration).contains(&since) {
                    libm::sin(std::f64::consts::PI * since / duration)
                } else {
                    0.0
                }
            }
        }
    }
}

fn table(points: &[(f64, f64)], t: f64) -> f64 {
    let after = points.partition_point(|p| p.0 <= t);
    if after == 0 {
        return points[0].1;
    }
    let (t0, v0) = points[after - 1];
    match points.get(after) {
        Some(&(t1, v1)) => v0 + (v1 - v0) * (t - t0) / (t1 - t0),
        None => v0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_pass_through_their_points() {
        let ramp = Function::Ramp { duration: 2.0 };
        assert_eq!(
            [ramp.value(0.0), ramp.value(1.0), ramp.value(3.0)],
            [0.0, 0.5, 1.0]
        );
        let table = Function::Table {
            points: vec![(1.0, 2.0), (2.0, 4.0), (2.5, 0.0)],
        };
        assert_eq!(
            [0.0, 1.0, 1.5, 2.25, 9.0].map(|t| table.value(t)),
            [2.0, 2.0, 3.0, 2.0, 0.0]
        );
        let blows = Function::HalfSine {
            duration: 0.02,
            period: 0.1,
            count: 3,
        };
        assert!((blows.value(0.11) - 1.0).abs() < 1e-12);
        assert_eq!(
            [blows.value(0.05), blows.value(0.31), blows.value(-0.01)],
            [0.0; 3]
        );
    }
}
