//! A number of each particle, placed in memory with a mind to the cache.

use crate::saved::{Broken, Bytes, Out, Saved};
use std::ops::{Deref, DerefMut};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Bytes of a line of the cache.
const LINE: usize = 64;
/// Addresses that differ by a multiple of this share the few lines that the first cache has for them.
const PAGE: usize = 4096;
/// Lines from where a column begins in its page to where the next one does: few, that no two of a
/// simulation begin at the same place.
const APART: usize = 3;

/// An array, one item a particle, that begins with a line of the cache and at another place of its page than the
/// columns made before it.
///
/// A step reads and writes the same place of twenty of them at a time. Large arrays all begin at the same place of
/// a page, as allocators give them out, and would push each other out of the first cache.
pub struct Column<T> {
    /// The items, after as many others as it takes.
    items: Vec<T>,
    skipped: usize,
    /// How many it has room for.
    room: usize,
    /// Where it begins in its page, lines.
    place: usize,
}

/// Places that have been given out.
static PLACES: AtomicUsize = AtomicUsize::new(0);

impl<T> Default for Column<T> {
    fn default() -> Column<T> {
        Column {
            items: Vec::new(),
            skipped: 0,
            room: 0,
            place: PLACES.fetch_add(APART, Ordering::Relaxed) % (PAGE / LINE),
        }
    }
}

impl<T: Copy + Default> Column<T> {
    /// None, with room for so many.
    pub fn with_capacity(count: usize) -> Column<T> {
        let mut column = Column::default();
        column.reserve_exact(count);
        column
    }

    /// How many it has room for.
    pub fn capacity(&self) -> usize {
        self.room
    }

    /// Room for so many more.
    pub fn reserve_exact(&mut self, more: usize) {
        let wanted = self.len() + more;
        if wanted <= self.room {
            return;
        }
        // What is not a multiple of items cannot be skipped, nor need it be.
        let mut items: Vec<T> = Vec::with_capacity(wanted + PAGE / size_of::<T>());
        let begins = items.as_ptr() as usize % PAGE;
        let skipped = (self.place * LINE + PAGE - begins) % PAGE / size_of::<T>();
        items.resize(skipped, T::default());
        items.extend_from_slice(self);
        (self.items, self.skipped, self.room) = (items, skipped, wanted);
    }

    pub fn push(&mut self, item: T) {
        if self.len() == self.room {
            self.reserve_exact(self.len().max(8));
        }
        self.items.push(item);
    }

    pub fn pop(&mut self) -> Option<T> {
        if self.is_empty() {
            None
        } else {
            self.items.pop()
        }
    }

    pub fn truncate(&mut self, count: usize) {
        self.items.truncate(self.skipped + count);
    }

    pub fn resize(&mut self, count: usize, item: T) {
        self.reserve_exact(count.saturating_sub(self.len()));
        self.items.resize(self.skipped + count, item);
    }

    pub fn extend_from_slice(&mut self, more: &[T]) {
        self.reserve_exact(more.len());
        self.items.extend_from_slice(more);
    }

    /// Keeps those that are marked, in their order.
    pub fn retain(&mut self, keep: &[bool]) {
        let mut kept = 0;
        for (place, &keep) in keep.iter().enumerate() {
            if keep {
                self[kept] = self[place];
                kept += 1;
            }
        }
        self.truncate(kept);
    }
}

impl<T> Deref for Column<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.items[self.skipped..]
    }
}

impl<T> DerefMut for Column<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.items[self.skipped..]
    }
}

impl<T: Copy + Default> Clone for Column<T> {
    fn clone(&self) -> Column<T> {
        let mut column = Column::default();
        column.extend_from_slice(self);
        column
    }

    fn clone_from(&mut self, from: &Column<T>) {
        self.truncate(0);
        self.extend_from_slice(from);
    }
}

impl<T: PartialEq> PartialEq for Column<T> {
    fn eq(&self, other: &Column<T>) -> bool {
        **self == **other
    }
}

impl<T: std::fmt::Debug> std::fmt::Debug for Column<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        (**self).fmt(f)
    }
}

impl<T: Copy + Default> From<Vec<T>> for Column<T> {
    fn from(items: Vec<T>) -> Column<T> {
        let mut column = Column::default();
        column.extend_from_slice(&items);
        column
    }
}

impl<T: Copy + Default> FromIterator<T> for Column<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Column<T> {
        let items: Vec<T> = items.into_iter().collect();
        Column::from(items)
    }
}

impl<'a, T> IntoIterator for &'a Column<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> std::slice::Iter<'a, T> {
        self.iter()
    }
}

/// As a list.
impl<T: Saved + Copy + Default> Saved for Column<T> {
    fn size(&self) -> usize {
        crate::saved::list_size(self)
    }

    fn save(&self, out: &mut Out) {
        crate::saved::save_list(self, out);
    }

    fn load(from: &mut Bytes) -> Result<Column<T>, Broken> {
        Vec::load(from).map(Column::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_grow_and_begin_at_places_of_their_own() {
        let mut columns: [Column<f64>; 20] = Default::default();
        for column in &mut columns {
            (0..5000).for_each(|x| column.push(f64::from(x)));
        }
        let mut places: Vec<usize> = (columns.iter())
            .map(|column| column.as_ptr() as usize % PAGE)
            .collect();
        assert!(places.iter().all(|place| place.is_multiple_of(LINE)));
        places.sort_unstable();
        places.dedup();
        assert_eq!(places.len(), 20);
        let column = &mut columns[7];
        assert_eq!((column.len(), column[4999]), (5000, 4999.0));
        let keep: Vec<bool> = (0..5000).map(|n| n % 5 == 3).collect();
        column.retain(&keep);
        assert_eq!((column.len(), column[0], column[999]), (1000, 3.0, 4998.0));
        column.resize(1002, 7.0);
        let copy = column.clone();
        assert_eq!((column.pop(), column.len()), (Some(7.0), 1001));
        assert_eq!(copy[..1001], column[..]);
        column.truncate(0);
        assert_eq!(column.pop(), None);
        let room = column.capacity();
        column.reserve_exact(room);
        assert_eq!(column.capacity(), room);
    }
}
