//! Figures as people read them.

/// A number with four significant digits, plain or with an exponent.
pub fn number(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = 3 - x.abs().log10().floor() as i32;
    if (-3..=7).contains(&digits) {
        let text = format!("{x:.*}", digits.max(0) as usize);
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{x:.3e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_four_digits() {
        let all = [0.0, 2.0, 0.013_546, 1_234_567.0, 5.5e-9, -17.25, 8000.0].map(number);
        assert_eq!(
            all,
            ["0", "2", "0.01355", "1234567", "5.500e-9", "-17.25", "8000"]
        );
    }
}
