//! An exponential function without branches, for lanes side by side.

use super::either;

/// 1.5 · 2⁵²: what is added to it is rounded to whole numbers, which are its last bits.
const SHIFT: f64 = 6_755_399_441_055_744.0;
/// ln 2, but for its last bits: so many whole multiples of it are exact. And these.
const LN_2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
/// From here on down the function is this one's value: there is no number with so small an exponent.
const LEAST: f64 = -700.0;
/// 1 / k!
const TERMS: [f64; 14] = {
    let (mut terms, mut k) = ([1.0; 14], 1);
    while k < 14 {
        terms[k] = terms[k - 1] / k as f64;
        k += 1;
    }
    terms
};

/// eˣ of a number of at most 700, to two units in the last place: 2ⁿ eʳ with |r| ≤ ln 2 / 2, where Taylor's series is cut off
/// below round-off.
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    let x = either(x > LEAST, x, LEAST);
    let shifted = x * std::f64::consts::LOG2_E + SHIFT;
    let n = shifted - SHIFT;
    let r = (x - n * LN_2[0]) - n * LN_2[1];
    let (r2, t) = (r * r, TERMS);
    let (r4, pair) = (r2 * r2, |k: usize| t[k] + t[k + 1] * r);
    let four = |k: usize| pair(k) + pair(k + 2) * r2;
    let series = (four(0) + four(4) * r4) + (four(8) + pair(12) * r4) * (r4 * r4);
    series * f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_librarys() {
        for k in -7000..=7000 {
            let x = 0.099_73 * f64::from(k);
            let (own, exact) = (exp(x), libm::exp(x));
            assert!((own - exact).abs() <= 4.5e-16 * exact, "{x}: {own} {exact}");
        }
        assert_eq!(exp(0.0), 1.0);
        assert!(exp(-1e9) < 1e-300);
    }
}
