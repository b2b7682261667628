//! A suddenly loaded elastic layer on an absorbing bottom, in closed form.
//!
//! The load p₀ sends a wave down; at the bottom the down-going wave f meets the dashpot α Z and
//! the spring k = E_c/δ and sends the up-going wave g back, which the free top turns into −g:
//!
//!   f(t) = p₀ − g(t − 2T),  σ_b = f + g = α Z u̇ + k u,  Z u̇ = f − g,
//!
//! with T = L/c and Z = ρ c. Hence u̇ + λ u = 2 f / (Z (1+α)), λ = k / (Z (1+α)). Between the
//! arrivals at T, 3T, 5T … f and u are a constant plus e^{−λτ} times a polynomial, τ the time since
//! the last arrival; their coefficients follow from one interval to the next without any numerical
//! integration. Compression and downward motion are positive.

/// The layer and its bottom, SI units.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    pub load: f64,
    pub thickness: f64,
    pub modulus: f64,
    pub density: f64,
    pub bottom: Bottom,
}

/// What the layer stands on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bottom {
    Rigid,
    Dashpot { alpha: f64 },
    DashpotAndSpring { alpha: f64, virtual_thickness: f64 },
}

/// constant + e^{−λτ} Σ cᵢ τⁱ.
#[derive(Clone, Debug, Default)]
struct Wave {
    constant: f64,
    decaying: Vec<f64>,
}

impl Wave {
    fn value(&self, lambda: f64, tau: f64) -> f64 {
        let polynomial = self.decaying.iter().rev().fold(0.0, |sum, c| sum * tau + c);
        self.constant + (-lambda * tau).exp() * polynomial
    }

    /// a · self + b · other.
    fn combine(&self, a: f64, other: &Wave, b: f64) -> Wave {
        let count = self.decaying.len().max(other.decaying.len());
        let at = |w: &Wave, i: usize| w.decaying.get(i).copied().unwrap_or(0.0);
        Wave {
            constant: a * self.constant + b * other.constant,
            decaying: (0..count)
                .map(|i| a * at(self, i) + b * at(other, i))
                .collect(),
        }
    }
}

/// Bottom and top of the column over time.
#[derive(Clone, Debug)]
pub struct ColumnSolution {
    column: Column,
    lambda: f64,
    /// Displacement of the bottom and up-going wave there in each interval of 2T from T on.
    intervals: Vec<(Wave, Wave, Wave)>,
    /// Displacement of the top at each T, from the up-going wave.
    travel: f64,
}

impl Column {
    /// The paper's layer: 1 m, 100 kPa, ν = 0, 18 kN/m³, 1 kPa.
    pub fn of_the_paper(bottom: Bottom) -> Column {
        Column {
            load: 1e3,
            thickness: 1.0,
            modulus: 1e5,
            density: 18e3 / 9.81,
            bottom,
        }
    }

    /// T = L/c, s.
    pub fn travel_time(&self) -> f64 {
        self.thickness / (self.modulus / self.density).sqrt()
    }

    /// Solves up to time `end`, s.
    pub fn solve(self, end: f64) -> ColumnSolution {
        let z = (self.density * self.modulus).sqrt();
        let (alpha, k) = match self.bottom {
            Bottom::Rigid => (f64::INFINITY, 0.0),
            Bottom::Dashpot { alpha } => (alpha, 0.0),
            Bottom::DashpotAndSpring {
                alpha,
                virtual_thickness,
            } => (alpha, self.modulus / virtual_thickness),
        };
        let travel = self.travel_time();
        let lambda = k / (z * (1.0 + alpha));
        let load = Wave {
            constant: self.load,
            decaying: vec![],
        };
        let mut intervals: Vec<(Wave, Wave, Wave)> = Vec::new();
        let mut f = load.clone();
        let mut start = 0.0;
        while (2 * intervals.len() + 1) as f64 * travel <= end {
            let u = if alpha.is_infinite() {
                Wave::default()
            } else {
                bottom(&f, start, lambda, z, alpha)
            };
            let g = if alpha.is_infinite() {
                f.clone()
            } else {
                f.combine((alpha - 1.0) / (1.0 + alpha), &u, k / (1.0 + alpha))
            };
            start = u.value(lambda, 2.0 * travel);
            let next = load.combine(1.0, &g, -1.0);
            intervals.push((u, f, g));
            f = next;
        }
        ColumnSolution {
            column: self,
            lambda,
            intervals,
            travel,
        }
    }
}

/// u with u(0) = `start` and u̇ + λ u = 2 f / (Z (1+α)).
fn bottom(f: &Wave, start: f64, lambda: f64, z: f64, alpha: f64) -> Wave {
    let rate = 2.0 / (z * (1.0 + alpha));
    let mut decaying = vec![start];
    if lambda == 0.0 {
        // e^{−λτ} = 1: everything is a polynomial.
        let whole: Vec<f64> =
            std::iter::once(f.constant + f.decaying.first().copied().unwrap_or(0.0))
                .chain(f.decaying.iter().skip(1).copied())
                .collect();
        decaying.extend(
            whole
                .iter()
                .enumerate()
                .map(|(i, c)| rate * c / (i + 1) as f64),
        );
        return Wave {
            constant: 0.0,
            decaying,
        };
    }
    let constant = rate * f.constant / lambda;
    decaying[0] -= constant;
    decaying.extend(
        f.decaying
            .iter()
            .enumerate()
            .map(|(i, c)| rate * c / (i + 1) as f64),
    );
    Wave { constant, decaying }
}

impl ColumnSolution {
    fn interval(&self, t: f64) -> Option<(&(Wave, Wave, Wave), f64)> {
        if t < self.travel {
            return None;
        }
        let number =
            (((t / self.travel - 1.0) / 2.0).floor() as usize).min(self.intervals.len() - 1);
        Some((
            &self.intervals[number],
            t - (2 * number + 1) as f64 * self.travel,
        ))
    }

    /// Downward displacement of the bottom, m.
    pub fn bottom_displacement(&self, t: f64) -> f64 {
        self.interval(t)
            .map_or(0.0, |((u, _, _), tau)| u.value(self.lambda, tau))
    }

    /// Pressure at the bottom, Pa.
    pub fn bottom_pressure(&self, t: f64) -> f64 {
        self.interval(t).map_or(0.0, |((_, f, g), tau)| {
            f.value(self.lambda, tau) + g.value(self.lambda, tau)
        })
    }

    /// Greatest downward displacement of the bottom up to `end`, m.
    pub fn bottom_peak(&self, end: f64) -> f64 {
        (0..=20_000)
            .map(|i| self.bottom_displacement(end * f64::from(i) / 20_000.0))
            .fold(0.0, f64::max)
    }

    /// Downward displacement of the top, m: Z u̇ = p₀ − 2 g(t − T), integrated by Simpson's rule
    /// within intervals in which g is smooth.
    pub fn top_displacement(&self, t: f64) -> f64 {
        let z = (self.column.density * self.column.modulus).sqrt();
        let mut up = 0.0;
        for (number, (_, _, g)) in self.intervals.iter().enumerate() {
            let arrival = (2 * number + 2) as f64 * self.travel;
            let length = (t - arrival).min(2.0 * self.travel);
            if length > 0.0 {
                let h = length / 200.0;
                let weight = |i: i32| {
                    if i == 0 || i == 200 {
                        1.0
                    } else {
                        f64::from(2 + 2 * (i % 2))
                    }
                };
                up += (0..=200)
                    .map(|i| weight(i) * g.value(self.lambda, h * f64::from(i)))
                    .sum::<f64>()
                    * h
                    / 3.0;
            }
        }
        (self.column.load * t - 2.0 * up) / z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values that follow by hand from the characteristics for α = 2.5, δ = 0.5 m.
    #[test]
    fn the_papers_column_has_the_known_fronts() {
        let bottom = Bottom::DashpotAndSpring {
            alpha: 2.5,
            virtual_thickness: 0.5,
        };
        let column = Column::of_the_paper(bottom);
        let travel = column.travel_time();
        assert!((travel - 0.135457).abs() < 1e-6);
        let exact = column.solve(3.0);
        let fronts = [
            (1.0, 0.0, 1428.57, 0.0),
            (3.0, 1817.77, 1205.52, 6.81093),
            (5.0, 503.46, 765.85, 4.25471),
            (7.0, 1265.49, 1153.04, 5.17669),
            (9.0, 877.95, 926.15, 5.03199),
            (11.0, 1046.05, 1025.39, 4.92249),
        ];
        for (n, before, after, u) in fronts {
            let t = n * travel;
            assert!(
                (exact.bottom_pressure(t * (1.0 - 1e-12)) - before).abs() < 0.006,
                "{n}"
            );
            assert!(
                (exact.bottom_pressure(t * (1.0 + 1e-12)) - after).abs() < 0.006,
                "{n}"
            );
            assert!((1e3 * exact.bottom_displacement(t) - u).abs() < 6e-6, "{n}");
        }
    }

    #[test]
    fn a_rigid_bottom_doubles_the_stress_and_a_dashpot_creeps() {
        let rigid = Column::of_the_paper(Bottom::Rigid);
        let travel = rigid.travel_time();
        let exact = rigid.solve(2.0);
        for (n, pressure) in [(2.0, 2e3), (4.0, 0.0), (6.0, 2e3)] {
            assert!((exact.bottom_pressure(n * travel) - pressure).abs() < 1e-9);
        }
        assert!((exact.top_displacement(2.0 * travel) - 0.02).abs() < 1e-12);
        assert!(exact.top_displacement(4.0 * travel).abs() < 1e-12);
        let exact = Column::of_the_paper(Bottom::Dashpot { alpha: 2.5 }).solve(6.0);
        for (n, pressure) in [(2.0, 1428.57), (4.0, 816.33), (6.0, 1078.72), (8.0, 966.26)] {
            assert!((exact.bottom_pressure(n * travel) - pressure).abs() < 0.01);
        }
        let creep = exact.bottom_displacement(6.0) - exact.bottom_displacement(5.0);
        assert!((1e3 * creep - 29.53).abs() < 0.01, "{creep}");
    }
}
