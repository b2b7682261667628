//! How far a history is from an expected one.

/// The greatest difference of a history from its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Greatest |history − reference| over the times they share, in the column's unit.
    pub greatest: f64,
    /// When it was reached, s.
    pub time: f64,
    /// Greatest |reference| over its whole length, in the column's unit.
    pub peak: f64,
}

impl Difference {
    /// Greatest difference over the reference's peak.
    pub fn relative(&self) -> f64 {
        self.greatest / self.peak
    }
}

/// Why a history and a reference cannot be compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CompareError {
    #[error("it has no rows")]
    Empty,
    #[error("row {row} below its header holds a number that is not finite")]
    NotFinite { row: usize },
    #[error("its times go back at {time} s")]
    NotOrdered { time: f64 },
    #[error("it is zero throughout, so that no difference can be related to its peak")]
    Flat,
    #[error("the history (to {end} s) and the reference (from {begin} s) share no time")]
    NoOverlap { begin: f64, end: f64 },
}

/// Compares a history with a reference, both as (time in s, value) in the order of time.
///
/// The reference is taken along straight lines between its rows, at the history's times, as far
/// as it reaches; where two of its rows have the same time it jumps.
pub fn difference(
    history: impl Iterator<Item = (f64, f64)>,
    reference: &[(f64, f64)],
) -> Result<Difference, CompareError> {
    let peak = reference_peak(reference)?;
    let (first, last) = (reference[0], reference[reference.len() - 1]);
    let mut worst: Option<(f64, f64)> = None;
    let mut end = f64::NEG_INFINITY;
    for (time, value) in history {
        end = time;
        if !(first.0..=last.0).contains(&time) {
            continue;
        }
        let apart = (value - at(reference, time)).abs();
        // A value that is no number is as far off as can be; `>` alone would pass over it.
        if worst.is_none_or(|w| apart > w.1) || apart.is_nan() {
            worst = Some((time, apart));
        }
        if apart.is_nan() {
            break;
        }
    }
    let (time, greatest) = worst.ok_or(CompareError::NoOverlap {
        begin: first.0,
        end,
    })?;
    Ok(Difference {
        greatest,
        time,
        peak,
    })
}

/// Greatest |value| of a reference, or why it cannot be one.
pub fn reference_peak(reference: &[(f64, f64)]) -> Result<f64, CompareError> {
    if reference.is_empty() {
        return Err(CompareError::Empty);
    }
    let finite = |r: &(f64, f64)| r.0.is_finite() && r.1.is_finite();
    if let Some(row) = reference.iter().position(|r| !finite(r)) {
        return Err(CompareError::NotFinite { row: row + 1 });
    }
    if let Some(pair) = reference.windows(2).find(|w| w[0].0 > w[1].0) {
        return Err(CompareError::NotOrdered { time: pair[1].0 });
    }
    let peak = reference.iter().fold(0.0, |p: f64, r| p.max(r.1.abs()));
    if peak == 0.0 {
        return Err(CompareError::Flat);
    }
    Ok(peak)
}

/// The reference at a time within its range.
fn at(reference: &[(f64, f64)], time: f64) -> f64 {
    let after = reference.partition_point(|r| r.0 <= time);
    let (t0, v0) = reference[after.saturating_sub(1)];
    match reference.get(after) {
        Some(&(t1, v1)) => v0 + (v1 - v0) * (time - t0) / (t1 - t0),
        None => v0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_greatest_difference_is_between_the_references_rows() {
        let reference = [(0.0, 0.0), (1.0, -4.0), (1.0, 2.0), (3.0, 0.0)];
        let history = [(0.5, -2.0), (1.0, 2.5), (2.0, 0.25), (4.0, 99.0)];
        let d = difference(history.into_iter(), &reference).unwrap();
        assert_eq!((d.greatest, d.time, d.peak), (0.75, 2.0, 4.0));
        assert_eq!(d.relative(), 0.1875);
    }

    #[test]
    fn a_value_that_is_no_number_is_not_passed_over() {
        let history = [(0.0, 1.0), (0.5, f64::NAN), (1.0, 1.0)];
        let d = difference(history.into_iter(), &[(0.0, 1.0), (1.0, 1.0)]).unwrap();
        assert!(d.relative().is_nan() && d.time == 0.5);
    }

    #[test]
    fn what_cannot_be_compared_is_said() {
        let history = || [(0.0, 1.0), (1.0, 1.0)].into_iter();
        assert_eq!(difference(history(), &[]), Err(CompareError::Empty));
        assert_eq!(
            difference(history(), &[(0.0, 0.0)]),
            Err(CompareError::Flat)
        );
        assert_eq!(
            difference(history(), &[(0.0, 1.0), (1.0, f64::NAN)]),
            Err(CompareError::NotFinite { row: 2 })
        );
        assert_eq!(
            difference(history(), &[(1.0, 1.0), (0.5, 1.0)]),
            Err(CompareError::NotOrdered { time: 0.5 })
        );
        assert_eq!(
            difference(history(), &[(2.0, 1.0)]),
            Err(CompareError::NoOverlap {
                begin: 2.0,
                end: 1.0
            })
        );
    }
}
