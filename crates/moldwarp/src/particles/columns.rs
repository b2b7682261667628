//! Vectors and tensors of all particles, component by component.

use super::{Column, State};
use crate::Vec3;
use crate::material::STATE_SIZE;
use crate::saved::{Broken, Bytes, Out, Saved};
use crate::tensor::Voigt;
use std::marker::PhantomData;

/// Values of N components, one array a component.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns<T, const N: usize> {
    columns: [Column<f64>; N],
    values: PhantomData<T>,
}

/// A vector a particle.
pub type Vectors = Columns<Vec3, 3>;
/// A symmetric tensor a particle.
pub type Tensors = Columns<Voigt, 6>;
/// State variables of material models.
pub type States = Columns<State, STATE_SIZE>;

impl<T, const N: usize> Default for Columns<T, N> {
    fn default() -> Columns<T, N> {
        Columns {
            columns: std::array::from_fn(|_| Column::default()),
            values: PhantomData,
        }
    }
}

impl<T: From<[f64; N]> + Into<[f64; N]>, const N: usize> Columns<T, N> {
    pub fn len(&self) -> usize {
        self.columns[0].len()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The value at a place.
    #[inline]
    pub fn at(&self, place: usize) -> T {
        T::from(std::array::from_fn(|k| self.columns[k][place]))
    }

    #[inline]
    pub fn set(&mut self, place: usize, value: T) {
        for (column, x) in self.columns.iter_mut().zip(value.into()) {
            column[place] = x;
        }
    }

    pub fn push(&mut self, value: T) {
        for (column, x) in self.columns.iter_mut().zip(value.into()) {
            column.push(x);
        }
    }

    /// All values one after another.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = T> + '_ {
        (0..self.len()).map(|place| self.at(place))
    }

    /// Gives all the same value.
    pub fn fill(&mut self, value: T) {
        for (column, x) in self.columns.iter_mut().zip(value.into()) {
            column.fill(x);
        }
    }

    /// One array a component.
    pub fn components(&self) -> [&[f64]; N] {
        self.columns.each_ref().map(|column| &column[..])
    }

    pub fn components_mut(&mut self) -> [&mut [f64]; N] {
        self.columns.each_mut().map(|column| &mut column[..])
    }

    pub(crate) fn columns_mut(&mut self) -> &mut [Column<f64>; N] {
        &mut self.columns
    }
}

impl<T: From<[f64; N]> + Into<[f64; N]>, const N: usize> FromIterator<T> for Columns<T, N> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Columns<T, N> {
        let mut columns = Columns::default();
        values.into_iter().for_each(|value| columns.push(value));
        columns
    }
}

impl<T, const N: usize> Saved for Columns<T, N> {
    fn size(&self) -> usize {
        self.columns.size()
    }

    fn save(&self, out: &mut Out) {
        self.columns.save(out);
    }

    fn load(from: &mut Bytes) -> Result<Columns<T, N>, Broken> {
        let columns = <[Column<f64>; N]>::load(from)?;
        match columns.iter().all(|c| c.len() == columns[0].len()) {
            true => Ok(Columns {
                columns,
                values: PhantomData,
            }),
            false => Err(Broken::new("components of different numbers")),
        }
    }
}
