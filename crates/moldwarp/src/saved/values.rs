//! Numbers, vectors, lists and texts.

use super::{Broken, Bytes, Out, Saved};
use crate::{Mat3, Vec3};

macro_rules! numbers {
    ($($number:ty),*) => {$(
        impl Saved for $number {
            #[inline]
            fn size(&self) -> usize {
                size_of::<$number>()
            }

            #[inline]
            fn save(&self, out: &mut Out) {
                out.put(&self.to_le_bytes());
            }

            fn save_all(items: &[$number], out: &mut Out) {
                out.put_all(items, <$number>::to_le_bytes);
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
    fn size(&self) -> usize {
        size_of::<u64>()
    }

    fn save(&self, out: &mut Out) {
        (*self as u64).save(out);
    }

    fn load(from: &mut Bytes) -> Result<usize, Broken> {
        let number = u64::load(from)?;
        usize::try_from(number).map_err(|_| Broken::new("a number"))
    }
}

impl Saved for bool {
    fn size(&self) -> usize {
        1
    }

    fn save(&self, out: &mut Out) {
        out.put(&[u8::from(*self)]);
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
    fn size(&self) -> usize {
        size_of::<[f64; 3]>()
    }

    #[inline]
    fn save(&self, out: &mut Out) {
        out.put(self.to_array().map(f64::to_le_bytes).as_flattened());
    }

    #[inline]
    fn load(from: &mut Bytes) -> Result<Vec3, Broken> {
        <[f64; 3]>::load(from).map(Vec3::from_array)
    }
}

impl Saved for Mat3 {
    fn size(&self) -> usize {
        size_of::<[f64; 9]>()
    }

    fn save(&self, out: &mut Out) {
        self.to_cols_array().save(out);
    }

    fn load(from: &mut Bytes) -> Result<Mat3, Broken> {
        Ok(Mat3::from_cols_array(&<[f64; 9]>::load(from)?))
    }
}

impl<T: Saved, const N: usize> Saved for [T; N] {
    #[inline]
    fn size(&self) -> usize {
        self.iter().map(T::size).sum()
    }

    #[inline]
    fn save(&self, out: &mut Out) {
        T::save_all(self, out);
    }

    fn save_all(items: &[[T; N]], out: &mut Out) {
        T::save_all(items.as_flattened(), out);
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

/// Number of bytes of a list.
pub(crate) fn list_size<T: Saved>(items: &[T]) -> usize {
    items.len().size() + items.iter().map(T::size).sum::<usize>()
}

/// Its length and its items.
pub(crate) fn save_list<T: Saved>(items: &[T], out: &mut Out) {
    items.len().save(out);
    T::save_all(items, out);
}

impl<T: Saved> Saved for Vec<T> {
    fn size(&self) -> usize {
        list_size(self)
    }

    fn save(&self, out: &mut Out) {
        save_list(self, out);
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
    fn size(&self) -> usize {
        1 + self.as_ref().map_or(0, T::size)
    }

    fn save(&self, out: &mut Out) {
        self.is_some().save(out);
        self.iter().for_each(|item| item.save(out));
    }

    fn load(from: &mut Bytes) -> Result<Option<T>, Broken> {
        bool::load(from)?.then(|| T::load(from)).transpose()
    }
}

impl<A: Saved, B: Saved> Saved for (A, B) {
    #[inline]
    fn size(&self) -> usize {
        self.0.size() + self.1.size()
    }

    fn save(&self, out: &mut Out) {
        self.0.save(out);
        self.1.save(out);
    }

    fn load(from: &mut Bytes) -> Result<(A, B), Broken> {
        Ok((A::load(from)?, B::load(from)?))
    }
}

impl Saved for String {
    fn size(&self) -> usize {
        self.len().size() + self.len()
    }

    fn save(&self, out: &mut Out) {
        self.len().save(out);
        out.put(self.as_bytes());
    }

    fn load(from: &mut Bytes) -> Result<String, Broken> {
        let count = usize::load(from)?;
        let bytes = from.take(count)?.to_vec();
        String::from_utf8(bytes).map_err(|_| Broken::new("a text"))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{load, to_bytes};

    #[test]
    fn values_come_back_bit_for_bit() {
        let odd = f64::from_bits(0x7ff8_0000_0000_1234);
        let list = vec![
            (Some(-0.0), "Böschung".to_owned()),
            (None, String::new()),
            (Some(odd), "b".to_owned()),
        ];
        let mut bytes = to_bytes(&list);
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
