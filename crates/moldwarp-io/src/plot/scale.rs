//! An axis: its ends, its ticks, and where a value lies.

/// Values from `low` to `high`, along a straight or a logarithmic axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    pub low: f64,
    pub high: f64,
    pub log: bool,
}

/// A logarithmic axis goes no farther below its greatest value than this factor: what is smaller is
/// round-off, most of the time.
const DEEPEST: f64 = 1e-9;
/// Share of the values' range that is left free at either end.
const MARGIN: f64 = 0.03;

impl Scale {
    /// Ends of an axis for these values; `given` ends stay as they are.
    pub fn of(
        values: impl Iterator<Item = f64>,
        given: Option<[f64; 2]>,
        log: bool,
        margin: bool,
    ) -> Option<Scale> {
        if let Some([low, high]) = given {
            return Some(Scale { low, high, log });
        }
        let shown = values.filter(|v| v.is_finite() && !(log && *v <= 0.0));
        let (low, high) = shown.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
            (l.min(v), h.max(v))
        });
        if low > high {
            return None;
        }
        if log {
            let low = low.max(DEEPEST * high);
            // Whole decades, unless the values take up less than one.
            let (low, high) = match (high / low).log10() < 1.0 {
                true => (low / 1.5, high * 1.5),
                false => (
                    10f64.powf((low.log10() + 1e-9).floor()),
                    10f64.powf((high.log10() - 1e-9).ceil()),
                ),
            };
            return Some(Scale { low, high, log });
        }
        let wide = high - low;
        if wide <= 1e-12 * high.abs().max(low.abs()) {
            let around = if high == 0.0 { 1.0 } else { 0.1 * high.abs() };
            return Some(Scale {
                low: low - around,
                high: high + around,
                log,
            });
        }
        let room = if margin { MARGIN * wide } else { 0.0 };
        Some(Scale {
            low: low - room,
            high: high + room,
            log,
        })
    }

    /// 0 at the lower, 1 at the upper end. No number for what a logarithmic axis does not have.
    pub fn share(&self, value: f64) -> f64 {
        match self.log {
            false => (value - self.low) / (self.high - self.low),
            true if value <= 0.0 => f64::NAN,
            true => (value / self.low).log10() / (self.high / self.low).log10(),
        }
    }

    /// Values with their labels, at most about `most` of them.
    pub fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        match self.log {
            true => self.decades(most),
            false => self.even(most),
        }
    }

    fn even(&self, most: usize) -> Vec<(f64, String)> {
        let step = step((self.high - self.low) / most.max(2) as f64);
        let slack = 1e-9 * (self.high - self.low);
        let first = ((self.low - slack) / step).ceil() as i64;
        let last = ((self.high + slack) / step).floor() as i64;
        let values: Vec<f64> = (first..=last).map(|i| i as f64 * step).collect();
        let greatest = values.iter().fold(0.0, |g: f64, v| g.max(v.abs()));
        values
            .into_iter()
            .map(|v| (v, label(v, step, greatest)))
            .collect()
    }

    fn decades(&self, most: usize) -> Vec<(f64, String)> {
        let (first, last) = (
            (self.low.log10() - 1e-9).ceil() as i32,
            (self.high.log10() + 1e-9).floor() as i32,
        );
        if last - first < 1 {
            // Less than two decades are inside: round values between them.
            let marks = (first - 1..=last + 1)
                .flat_map(|d| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(d)))
                .filter(|v| (self.low * (1.0 - 1e-9)..=self.high * (1.0 + 1e-9)).contains(v));
            return marks.map(|v| (v, crate::text::number(v))).collect();
        }
        let every = (((last - first + 1) as usize).div_ceil(most.max(2))) as i32;
        (first..=last)
            .filter(|d| d.rem_euclid(every) == 0)
            .map(|d| (10f64.powi(d), power(d)))
            .collect()
    }
}

/// The least of 1, 2, 2.5, 5 × 10ⁿ that is not below `least`.
fn step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    let round = [1.0, 2.0, 2.5, 5.0, 10.0];
    let factor = round
        .into_iter()
        .find(|m| m * power >= least * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

/// As many decimals as the step has; an exponent where figures would be long.
fn label(value: f64, step: f64, greatest: f64) -> String {
    let value = if value.abs() < 1e-6 * step {
        0.0
    } else {
        value
    };
    let exponent = if greatest > 0.0 {
        greatest.log10().floor() as i32
    } else {
        0
    };
    if !(-4..6).contains(&exponent) {
        if value == 0.0 {
            return "0".to_owned();
        }
        let digits = (exponent - step.log10().floor() as i32).clamp(0, 4) as usize;
        let text = format!("{:.*}", digits + 1, value / 10f64.powi(exponent));
        let text = text.trim_end_matches('0').trim_end_matches('.');
        return minus(&format!("{text}·{}", power(exponent)));
    }
    let mut decimals = (-step.log10().floor()).max(0.0) as usize;
    // 0.25 needs one more than 0.2.
    let scaled = step * 10f64.powi(decimals as i32);
    if (scaled - scaled.round()).abs() > 1e-6 {
        decimals += 1;
    }
    minus(&format!("{value:.decimals$}"))
}

/// With a true minus sign, which is as wide as a figure.
fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// 10 to a power.
fn power(exponent: i32) -> String {
    if exponent == 0 {
        return "1".to_owned();
    }
    let figures = exponent.to_string();
    let raised = figures.chars().map(|c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32('⁰' as u32 + c as u32 - '0' as u32).unwrap_or(c),
    });
    format!("10{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, log: bool) -> String {
        let ticks = Scale { low, high, log }.ticks(6);
        let labels: Vec<String> = ticks.into_iter().map(|t| t.1).collect();
        labels.join(" ")
    }

    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(labels(0.0, 2.0, false), "0.0 0.5 1.0 1.5 2.0");
        assert_eq!(labels(-7.3, 0.4, false), "−6 −4 −2 0");
        assert_eq!(
            labels(0.0, 1.5, false),
            "0.00 0.25 0.50 0.75 1.00 1.25 1.50"
        );
        assert_eq!(
            labels(0.0, 3e7, false),
            "0 0.5·10⁷ 1·10⁷ 1.5·10⁷ 2·10⁷ 2.5·10⁷ 3·10⁷"
        );
        assert_eq!(
            labels(1e-9, 2e-9, false),
            "1·10⁻⁹ 1.2·10⁻⁹ 1.4·10⁻⁹ 1.6·10⁻⁹ 1.8·10⁻⁹ 2·10⁻⁹"
        );
        assert_eq!(labels(1e-3, 1e2, true), "10⁻³ 10⁻² 10⁻¹ 1 10¹ 10²");
        assert_eq!(labels(1e-12, 1e12, true), "10⁻¹⁰ 10⁻⁵ 1 10⁵ 10¹⁰");
        assert_eq!(labels(2.0, 9.0, true), "2 5");
    }

    #[test]
    fn the_ends_enclose_the_values() {
        let of = |values: &[f64], log| Scale::of(values.iter().copied(), None, log, true);
        let scale = of(&[0.0, 10.0, f64::NAN], false).unwrap();
        assert!(scale.low < 0.0 && scale.high > 10.0 && scale.high < 11.0);
        assert_eq!(of(&[5.0], false).unwrap().share(5.0), 0.5);
        assert_eq!(of(&[f64::NAN], false), None);
        assert_eq!(of(&[-1.0, 0.0], true), None);
        let log = of(&[0.0, 0.02, 30.0], true).unwrap();
        assert!((log.low - 0.01).abs() < 1e-12 && (log.high - 100.0).abs() < 1e-9);
        let deep = of(&[1e-30, 1.0], true).unwrap();
        assert!((deep.low / 1e-9 - 1.0).abs() < 1e-9);
        assert!((log.share(1.0) - 0.5).abs() < 1e-12 && log.share(0.0).is_nan());
    }
}
