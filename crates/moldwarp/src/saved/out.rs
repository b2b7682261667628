//! Where the bytes of a state go.

use super::Saved;

/// Bytes that are handed on at a time: few enough for a cache, enough for a disk.
const PIECE: usize = 1 << 16;

/// Takes bytes and hands them on in pieces, whatever the size of what is written.
pub struct Out<'a> {
    piece: Vec<u8>,
    to: &'a mut dyn FnMut(&[u8]),
}

impl<'a> Out<'a> {
    /// Hands pieces on to `to`; the last one comes with [`Out::finish`].
    pub fn new(to: &'a mut dyn FnMut(&[u8])) -> Out<'a> {
        let piece = Vec::new();
        Out { piece, to }
    }

    /// Writes bytes.
    #[inline]
    pub fn put(&mut self, bytes: &[u8]) {
        if self.piece.len() + bytes.len() > PIECE {
            self.hand_on();
            if bytes.len() > PIECE {
                return (self.to)(bytes);
            }
        }
        self.piece.extend_from_slice(bytes);
    }

    /// Writes numbers of N bytes each.
    pub(super) fn put_all<T: Copy, const N: usize>(
        &mut self,
        numbers: &[T],
        bytes: impl Fn(T) -> [u8; N],
    ) {
        for numbers in numbers.chunks(PIECE / N) {
            if self.piece.len() + numbers.len() * N > PIECE {
                self.hand_on();
            }
            let begin = self.piece.len();
            self.piece.resize(begin + numbers.len() * N, 0);
            let room = self.piece[begin..].as_chunks_mut().0;
            for (room, &number) in room.iter_mut().zip(numbers) {
                *room = bytes(number);
            }
        }
    }

    /// Hands on what is left.
    pub fn finish(mut self) {
        self.hand_on();
    }

    fn hand_on(&mut self) {
        if !self.piece.is_empty() {
            (self.to)(&self.piece);
            self.piece.clear();
        }
    }
}

/// A part of a state, which is made into bytes when it is asked for them.
pub struct Section<'a>(&'a dyn Part);

impl<'a> Section<'a> {
    pub fn new(part: &'a dyn Part) -> Section<'a> {
        Section(part)
    }

    /// Number of bytes.
    pub fn size(&self) -> usize {
        self.0.count()
    }

    /// Hands on all bytes, piece by piece.
    pub fn pieces(&self, to: &mut dyn FnMut(&[u8])) {
        let mut out = Out::new(to);
        self.0.write(&mut out);
        out.finish();
    }

    /// All bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.size());
        self.pieces(&mut |piece| bytes.extend_from_slice(piece));
        bytes
    }
}

/// The bytes of something small.
pub fn to_bytes<T: Saved>(value: &T) -> Vec<u8> {
    Section::new(value).to_bytes()
}

/// What can be written as bytes: [`Saved`], as far as it need not know the type.
pub trait Part {
    /// Number of bytes.
    fn count(&self) -> usize;

    /// Writes them.
    fn write(&self, out: &mut Out);
}

impl<T: Saved> Part for T {
    fn count(&self) -> usize {
        self.size()
    }

    fn write(&self, out: &mut Out) {
        self.save(out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sizes are foretold, and pieces make the whole, for lists shorter and longer than a piece and
    /// for numbers that do not divide it.
    #[test]
    fn pieces_make_the_whole() {
        for count in [0, 1, PIECE / 8, PIECE / 8 + 1, PIECE / 3] {
            let list: Vec<(u8, [f64; 3])> = (0..count).map(|i| (i as u8, [i as f64; 3])).collect();
            let columns: [Vec<f64>; 2] = [vec![1.5; count], vec![-0.0; count]];
            let both = (list, columns);
            type Both = (Vec<(u8, [f64; 3])>, [Vec<f64>; 2]);
            let (mut bytes, mut greatest) = (Vec::new(), 0);
            let section = Section::new(&both);
            section.pieces(&mut |piece| {
                bytes.extend_from_slice(piece);
                greatest = greatest.max(piece.len());
            });
            assert_eq!(bytes.len(), section.size());
            assert!(greatest <= PIECE);
            let back: Both = crate::saved::load(&bytes).unwrap();
            assert!(back == both);
        }
        let mut long = Vec::new();
        let mut to = |piece: &[u8]| long.push(piece.len());
        let mut out = Out::new(&mut to);
        out.put(&[1]);
        out.put(&[2; PIECE + 1]);
        out.finish();
        assert_eq!(long, [1, PIECE + 1]);
    }
}
