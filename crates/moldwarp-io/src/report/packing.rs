//! Numbers as few bytes, and bytes as text that may stand in a page.
//!
//! Fields are kept as half floats, which graphics processors read as they are: their relative
//! precision is the same for large and small values, so that one particle with a great stress does
//! not cost the others theirs. The two bytes of each are put apart, since the first ones repeat and so
//! pack well.

/// Values of a field as half floats of `value / unit`. Below 6e-5 of the unit the relative precision
/// falls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coding {
    /// What 1 stands for.
    pub unit: f64,
    /// Bits after the leading one that are kept, 10 at most.
    pub bits: u32,
}

impl Coding {
    /// For values up to `greatest` in absolute value.
    pub fn new(greatest: f64, bits: u32) -> Coding {
        let sound = greatest > 0.0 && greatest.is_finite();
        Coding {
            unit: if sound { greatest } else { 1.0 },
            bits,
        }
    }

    /// The code of a value; what is no number has the code of none.
    pub fn code(&self, value: f64) -> u16 {
        half(value / self.unit, self.bits)
    }
}

/// The nearest half float with so many bits after the leading one.
fn half(value: f64, bits: u32) -> u16 {
    if value.is_nan() {
        return 0x7e00;
    }
    let sign = if value < 0.0 { 0x8000 } else { 0 };
    let x = value.abs().min(65504.0);
    // Below 2^-14 half floats have a fixed step.
    let exponent = if x > 0.0 {
        x.log2().floor().max(-14.0)
    } else {
        -14.0
    };
    let step = (exponent - f64::from(bits)).exp2();
    let rounded = (x / step).round() * step;
    // Rounding up may have reached the next power of two, which the bits' carry makes right.
    let mantissa = (rounded / (exponent - 10.0).exp2()) as u32;
    let exponent = (exponent + 14.0) as u32;
    sign | ((exponent << 10) + mantissa) as u16
}

/// All first bytes, then all second ones, packed, as text.
pub fn planes(codes: &[u16]) -> String {
    let high = codes.iter().map(|c| (c >> 8) as u8);
    let low = codes.iter().map(|c| *c as u8);
    text(&high.chain(low).collect::<Vec<u8>>())
}

/// Bytes as a zlib stream in base 64.
pub fn text(bytes: &[u8]) -> String {
    base64(&miniz_oxide::deflate::compress_to_vec_zlib(bytes, 6))
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for digit in 0..4 {
            let known = digit <= three.len();
            let value = (bits >> (18 - 6 * digit) & 63) as usize;
            text.push(if known { DIGITS[value] as char } else { '=' });
        }
    }
    text
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// What a page's script does.
    pub fn unpacked(text: &str) -> Vec<u8> {
        let digit = |c: u8| match c {
            b'A'..=b'Z' => u32::from(c - b'A'),
            b'a'..=b'z' => u32::from(c - b'a') + 26,
            b'0'..=b'9' => u32::from(c - b'0') + 52,
            b'+' => 62,
            b'/' => 63,
            _ => 0,
        };
        let four = |four: &[u8]| {
            let bits = four.iter().fold(0, |bits, &c| bits << 6 | digit(c));
            let bytes = bits.to_be_bytes();
            let padding = four.iter().filter(|&&c| c == b'=').count();
            bytes[1..4 - padding].to_vec()
        };
        let packed: Vec<u8> = text.as_bytes().chunks(4).flat_map(four).collect();
        miniz_oxide::inflate::decompress_to_vec_zlib(&packed).expect("a zlib stream")
    }

    /// The value of a half float, by its definition.
    pub fn value(code: u16) -> f64 {
        let sign = if code & 0x8000 == 0 { 1.0 } else { -1.0 };
        let (exponent, mantissa) = (i32::from(code >> 10 & 31), f64::from(code & 1023));
        match exponent {
            31 => f64::NAN,
            0 => sign * mantissa * (-24f64).exp2(),
            e => sign * (1.0 + mantissa / 1024.0) * f64::from(e - 15).exp2(),
        }
    }

    #[test]
    fn text_comes_back() {
        for length in [0, 1, 2, 3, 4, 1000] {
            let bytes: Vec<u8> = (0..length).map(|i| (i * 37 % 251) as u8).collect();
            assert_eq!(unpacked(&text(&bytes)), bytes);
        }
        assert_eq!(base64(b"Man"), "TWFu");
        assert_eq!(base64(b"Ma"), "TWE=");
        assert_eq!(base64(b"M"), "TQ==");
    }

    #[test]
    fn half_floats_keep_the_bits_that_are_asked_for() {
        for bits in [7, 8, 10] {
            let coding = Coding::new(3e6, bits);
            let most = (-f64::from(bits) - 1.0).exp2();
            for i in 0..10_000 {
                let x = 3e6 * (-f64::from(i) * 9e-4).exp() * [1.0, -1.0][i as usize % 2];
                let back = value(coding.code(x)) * coding.unit;
                assert!((back - x).abs() <= most * x.abs() * 1.001, "{x} {back}");
            }
        }
        let coding = Coding::new(0.0, 10);
        assert_eq!(value(coding.code(0.0)), 0.0);
        assert!(value(Coding::new(1.0, 10).code(f64::NAN)).is_nan());
        // The greatest value, carried over to the next power, stays finite.
        assert!(value(Coding::new(0.99999, 7).code(0.99999)).is_finite());
    }
}
