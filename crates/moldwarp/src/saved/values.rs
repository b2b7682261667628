//! Numbers, vectors, lists and texts.

use super::{Broken, Bytes, Saved};
use crate::{Mat3, Vec3};

macro_rules! numbers {
    ($($number:ty),*) => {$(
        impl Saved for $number {
            #[inline]
            fn save(&self, out: &mut Vec<u8>) {
                out.extend_from_slice(&self.to_le_bytes());
            }

            #[inline]
            fn load(from: &mut Bytes) -> Result<$number, Broken> {
                let bytes = from.take(size_of::<$number>())?;
                let bytes = bytes.first_chunk().expect("as many as were asked for");
                Ok(<$number>::from_le_bytes(*bytes))
            }
        }
    )*};
}

numbers!(u8, u16, u32, u64, f64);

impl Saved for usize {
    fn save(&self, out: &mut Vec<u8>) {
        (*self as u64).save(out);
    }

    fn load(from: &mut Bytes) -> Result<usize, Broken> {
        let number = u64::load(from)?;
        usize::try_from(number).map_err(|_| Broken::new("a number"))
    }
}

impl Saved for bool {
    fn save(&self, out: &mut Vec<u8>) {
        out.push(u8::from(*self));
    }

    fn load(from: &mut Bytes) -> Result<bool, Broken> {
        match from.take(1)? {
            [0] => Ok(false),
            [1] => Ok(true),
            _ => Err(Broken::new("a yes or no")),
        }
    }
}

impl Saved for Vec3 {
    #[inline]
    fn save(&self, out: &mut Vec<u8>) {
        self.to_array().save(out);
    }

    #[inline]
    fn load(from: &mut Bytes) -> Result<Vec3, Broken> {
        <[f64; 3]>::load(from).map(Vec3::from_array)
    }
}

impl Saved for Mat3 {
    fn save(&self, out: &mut Vec<u8>) {
        self.to_cols_array().save(out);
    }

    fn load(from: &mut Bytes) -> Result<Mat3, Broken> {
        Ok(Mat3::from_cols_array(&<[f64; 9]>::load(from)?))
    }
}

impl<T: Saved, const N: usize> Saved for [T; N] {
    #[inline]
    fn save(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|item| item.save(out));
    }

    #[inline]
    fn load(from: &mut Bytes) -> Result<[T; N], Broken> {
        let mut items = [const { None }; N];
        for item in &mut items {
            *item = Some(T::load(from)?);
        }
        Ok(items.map(|item| item.expect("all have been loaded")))
    }
}

impl<T: Saved> Saved for Vec<T> {
    fn save(&self, out: &mut Vec<u8>) {
        self.len().save(out);
        self.iter().for_each(|item| item.save(out));
    }

    fn load(from: &mut Bytes) -> Result<Vec<T>, Broken> {
        let count = usize::load(from)?;
        // A length that is wrong must not ask for all memory; numbers take as many bytes as in memory.
        let mut items = Vec::with_capacity(count.min(from.left() / size_of::<T>().max(1)));
        for _ in 0..count {
            items.push(T::load(from)?);
        }
        Ok(items)
    }
}

impl<T: Saved> Saved for Option<T> {
    fn save(&self, out: &mut Vec<u8>) {
        self.is_some().save(out);
        self.iter().for_each(|item| item.save(out));
    }

    fn load(from: &mut Bytes) -> Result<Option<T>, Broken> {
        bool::load(from)?.then(|| T::load(from)).transpose()
    }
}

impl<A: Saved, B: Saved> Saved for (A, B) {
    fn save(&self, out: &mut Vec<u8>) {
        self.0.save(out);
        self.1.save(out);
    }

    fn load(from: &mut Bytes) -> Result<(A, B), Broken> {
        Ok((A::load(from)?, B::load(from)?))
    }
}

impl Saved for String {
    fn save(&self, out: &mut Vec<u8>) {
        self.len().save(out);
        out.extend_from_slice(self.as_bytes());
    }

    fn load(from: &mut Bytes) -> Result<String, Broken> {
        let count = usize::load(from)?;
        let bytes = from.take(count)?.to_vec();
        String::from_utf8(bytes).map_err(|_| Broken::new("a text"))
    }
}

#[cfg(test)]
mod tests {
    use super::super::load;
    use super::*;

    #[test]
    fn values_come_back_bit_for_bit() {
        let odd = f64::from_bits(0x7ff8_0000_0000_1234);
        let list = vec![
            (Some(-0.0), "Böschung".to_owned()),
            (None, String::new()),
            (Some(odd), "b".to_owned()),
        ];
        let mut bytes = Vec::new();
        list.save(&mut bytes);
        let back: Vec<(Option<f64>, String)> = load(&bytes).unwrap();
        for ((a, name), (b, other)) in list.iter().zip(&back) {
            assert_eq!(a.map(f64::to_bits), b.map(f64::to_bits));
            assert_eq!(name, other);
        }
        for short in 0..bytes.len() {
            assert!(load::<Vec<(Option<f64>, String)>>(&bytes[..short]).is_err());
        }
        bytes.push(0);
        assert!(load::<Vec<(Option<f64>, String)>>(&bytes).is_err());
        let endless = u64::MAX.to_le_bytes();
        assert!(load::<Vec<f64>>(&endless).is_err());
    }
}
