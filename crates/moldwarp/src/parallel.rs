//! Work on many items by any number of threads, with the same bits for all of them.
//!
//! Items are cut into blocks of a fixed size; each block is worked on by one thread in order; the
//! sums that blocks return are added pairwise along a tree whose shape depends on the number of
//! items alone. Nothing is allocated.

use std::ops::Range;

/// Something that can be cut in two.
pub trait Split: Send + Sized {
    fn count(&self) -> usize;
    /// The first `at` items and the rest.
    fn split(self, at: usize) -> (Self, Self);
}

/// Something that adds up.
pub trait Sum: Default + Send {
    fn plus(self, other: Self) -> Self;
}

/// Calls `work` on blocks of at most `block` items and adds up what it returns.
pub fn fold<S: Split, T: Sum>(items: S, block: usize, work: &(impl Fn(S) -> T + Sync)) -> T {
    let count = items.count();
    if count <= block {
        return work(items);
    }
    let at = count.div_ceil(block).div_ceil(2) * block;
    let (low, high) = items.split(at);
    let (low, high) = rayon::join(|| fold(low, block, work), || fold(high, block, work));
    low.plus(high)
}

/// Does work on a thread of those that share it. From any other thread each of its folds would wait for one of
/// them to wake up, 20 µs each time.
pub fn inside<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    rayon::scope(|_| work())
}

impl Split for Range<usize> {
    fn count(&self) -> usize {
        self.len()
    }
    fn split(self, at: usize) -> (Self, Self) {
        (self.start..self.start + at, self.start + at..self.end)
    }
}

impl<T: Send> Split for &mut [T] {
    fn count(&self) -> usize {
        self.len()
    }
    fn split(self, at: usize) -> (Self, Self) {
        self.split_at_mut(at)
    }
}

impl<T: Sync> Split for &[T] {
    fn count(&self) -> usize {
        self.len()
    }
    fn split(self, at: usize) -> (Self, Self) {
        self.split_at(at)
    }
}

impl<A: Split, B: Split> Split for (A, B) {
    fn count(&self) -> usize {
        self.0.count()
    }
    fn split(self, at: usize) -> (Self, Self) {
        let ((a, c), (b, d)) = (self.0.split(at), self.1.split(at));
        ((a, b), (c, d))
    }
}

impl<A: Split, B: Split, C: Split> Split for (A, B, C) {
    fn count(&self) -> usize {
        self.0.count()
    }
    fn split(self, at: usize) -> (Self, Self) {
        let ((a, x), (b, y), (c, z)) = (self.0.split(at), self.1.split(at), self.2.split(at));
        ((a, b, c), (x, y, z))
    }
}

/// Something that there may be; it does not say how many.
impl<S: Split> Split for Option<S> {
    fn count(&self) -> usize {
        self.as_ref().map_or(0, S::count)
    }
    fn split(self, at: usize) -> (Self, Self) {
        self.map(|some| some.split(at)).unzip()
    }
}

impl Split for () {
    fn count(&self) -> usize {
        0
    }
    fn split(self, _: usize) -> ((), ()) {
        ((), ())
    }
}

impl<T: Split, const N: usize> Split for [T; N] {
    fn count(&self) -> usize {
        self[0].count()
    }
    fn split(self, at: usize) -> (Self, Self) {
        let mut rest = [const { None }; N];
        let mut k = 0;
        let first = self.map(|part| {
            let (low, high) = part.split(at);
            rest[k] = Some(high);
            k += 1;
            low
        });
        (first, rest.map(|high| high.expect("one for each")))
    }
}

impl Sum for () {
    fn plus(self, (): ()) {}
}

impl Sum for f64 {
    fn plus(self, other: f64) -> f64 {
        self + other
    }
}

impl<const N: usize> Sum for [f64; N]
where
    [f64; N]: Default,
{
    fn plus(mut self, other: [f64; N]) -> [f64; N] {
        for k in 0..N {
            self[k] += other[k];
        }
        self
    }
}

/// The smallest of many values; infinity of none.
#[derive(Clone, Copy, Debug)]
pub struct Smallest(pub f64);

impl Default for Smallest {
    fn default() -> Smallest {
        Smallest(f64::INFINITY)
    }
}

impl Sum for Smallest {
    fn plus(self, other: Smallest) -> Smallest {
        // NaN must win, so that it is noticed.
        Smallest(if self.0 <= other.0 || self.0.is_nan() {
            self.0
        } else {
            other.0
        })
    }
}

/// The first of many indices; `u32::MAX` of none.
#[derive(Clone, Copy, Debug)]
pub struct First(u32);

impl First {
    /// This index is one of them.
    pub fn note(&mut self, index: usize) {
        self.0 = self.0.min(index as u32);
    }

    /// The same index by another number.
    pub fn map(self, number: impl Fn(usize) -> usize) -> First {
        self.get().map_or(self, |index| First(number(index) as u32))
    }

    pub fn get(self) -> Option<usize> {
        (self.0 != u32::MAX).then_some(self.0 as usize)
    }
}

impl Default for First {
    fn default() -> First {
        First(u32::MAX)
    }
}

impl Sum for First {
    fn plus(self, other: First) -> First {
        First(self.0.min(other.0))
    }
}

impl<A: Sum, B: Sum> Sum for (A, B) {
    fn plus(self, other: (A, B)) -> (A, B) {
        (self.0.plus(other.0), self.1.plus(other.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum_with(threads: usize, values: &[f64]) -> f64 {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| fold(values, 7, &|part: &[f64]| part.iter().sum::<f64>()))
    }

    #[test]
    fn a_sum_has_the_same_bits_for_any_number_of_threads() {
        let values: Vec<f64> = (0..1000).map(|i| 1.0 / (1.0 + f64::from(i))).collect();
        let one = sum_with(1, &values);
        assert!((one - values.iter().sum::<f64>()).abs() < 1e-12);
        for threads in [2, 3, 8] {
            assert_eq!(one.to_bits(), sum_with(threads, &values).to_bits());
        }
    }
}
