//! Fields that are numbers in ASCII or in binary, as the file's header says.

use super::super::{GmshProblem, MeshFileError};
use super::Result;
use super::cursor::{Cursor, Encoding, number_of};

impl Cursor<'_> {
    /// Turns to binary; here stands the integer 1.
    pub(super) fn set_binary(&mut self) -> Result<()> {
        self.encoding = Encoding::Binary { big_endian: false };
        let one: [u8; 4] = self.array("the integer 1")?;
        match one {
            [1, 0, 0, 0] => Ok(()),
            [0, 0, 0, 1] => {
                self.encoding = Encoding::Binary { big_endian: true };
                Ok(())
            }
            _ => {
                let what = "the integer 1, which shows the order of bytes";
                Err(self.unexpected(what, &format!("the bytes {one:02x?}")))
            }
        }
    }

    pub(super) fn is_binary(&self) -> bool {
        self.encoding != Encoding::Ascii
    }

    #[inline]
    fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N]> {
        self.last = self.at;
        match self.bytes[self.at..].first_chunk() {
            Some(chunk) => {
                self.at += N;
                Ok(*chunk)
            }
            None => {
                let length = self.bytes.len();
                let left = length - self.at;
                self.at = length;
                let what = format!("{what} in {N} bytes");
                Err(self.unexpected_end(&what, left))
            }
        }
    }

    fn unexpected_end(&self, expected: &str, left: usize) -> MeshFileError {
        let found = match left {
            0 => "the end of the file".to_owned(),
            n => format!("the end of the file after {n}"),
        };
        self.wrong(GmshProblem::Expected {
            expected: expected.to_owned(),
            found,
        })
    }

    /// An `int`, 4 bytes in binary.
    #[inline]
    pub(super) fn int(&mut self, what: &str) -> Result<i64> {
        match self.encoding {
            Encoding::Ascii => self.text_integer(what),
            Encoding::Binary { big_endian: false } => {
                Ok(i32::from_le_bytes(self.array(what)?).into())
            }
            Encoding::Binary { big_endian: true } => {
                Ok(i32::from_be_bytes(self.array(what)?).into())
            }
        }
    }

    /// A `size_t`, 8 bytes in binary.
    #[inline]
    pub(super) fn size(&mut self, what: &str) -> Result<u64> {
        match self.encoding {
            Encoding::Ascii => {
                let number = self.text_integer(what)?;
                u64::try_from(number).map_err(|_| self.unexpected(what, &number.to_string()))
            }
            Encoding::Binary { big_endian: false } => Ok(u64::from_le_bytes(self.array(what)?)),
            Encoding::Binary { big_endian: true } => Ok(u64::from_be_bytes(self.array(what)?)),
        }
    }

    /// An `int` that is 1 or more.
    #[inline]
    pub(super) fn int_tag(&mut self, what: &str) -> Result<u64> {
        let tag = self.int(what)?;
        match u64::try_from(tag) {
            Ok(tag) if tag > 0 => Ok(tag),
            _ => Err(self.unexpected(&format!("{what}, 1 or more"), &tag.to_string())),
        }
    }

    /// A `size_t` that is 1 or more.
    #[inline]
    pub(super) fn size_tag(&mut self, what: &str) -> Result<u64> {
        match self.size(what)? {
            0 => Err(self.unexpected(&format!("{what}, 1 or more"), "0")),
            tag => Ok(tag),
        }
    }

    /// A finite `double`.
    #[inline]
    pub(super) fn real(&mut self, what: &str) -> Result<f64> {
        let number = match self.encoding {
            Encoding::Ascii => {
                let word = self.word(what)?;
                let text = std::str::from_utf8(word).ok();
                match text.and_then(|w| w.parse().ok()) {
                    Some(number) => number,
                    None => return Err(self.unexpected(what, &String::from_utf8_lossy(word))),
                }
            }
            Encoding::Binary { big_endian: false } => f64::from_le_bytes(self.array(what)?),
            Encoding::Binary { big_endian: true } => f64::from_be_bytes(self.array(what)?),
        };
        if number.is_finite() {
            Ok(number)
        } else {
            let what = format!("{what}, a finite number");
            Err(self.unexpected(&what, &number.to_string()))
        }
    }

    /// A coordinate. Volumes of what is larger than any mesh in any unit would be no numbers.
    #[inline]
    pub(super) fn coordinate(&mut self) -> Result<f64> {
        const MOST: f64 = 1e30;
        let x = self.real("a coordinate")?;
        match x.abs() <= MOST {
            true => Ok(x),
            false => Err(self.unexpected("a coordinate, at most 1e30", &format!("{x:e}"))),
        }
    }

    /// Steps over `count` fields of `bytes` each.
    pub(super) fn skip(&mut self, count: u64, bytes: usize, what: &str) -> Result<()> {
        if !self.is_binary() {
            return (0..count).try_for_each(|_| self.word(what).map(|_| ()));
        }
        self.last = self.at;
        let left = self.bytes.len() - self.at;
        let wanted = count.saturating_mul(bytes as u64);
        match usize::try_from(wanted) {
            Ok(wanted) if wanted <= left => {
                self.at += wanted;
                Ok(())
            }
            _ => Err(self.unexpected_end(&format!("{what} in {wanted} bytes"), left)),
        }
    }

    /// A `size_t` that says how many things follow. Each takes `fields` numbers, which are two
    /// bytes or more in ASCII, and `bytes` or more in binary: what cannot be true is refused
    /// before memory is taken for it.
    pub(super) fn count(&mut self, what: &'static str, fields: usize, bytes: usize) -> Result<u64> {
        let count = self.size(what).map_err(|e| number_of(what, e))?;
        let least = if self.is_binary() { bytes } else { 2 * fields };
        self.check_room(count, what, least)?;
        Ok(count)
    }

    /// Refuses a count of things that the rest of the file has no room for.
    pub(super) fn check_room(&self, count: u64, what: &'static str, least: usize) -> Result<()> {
        let room = self.bytes.len() - self.at;
        if count > (room / least.max(1)) as u64 {
            return Err(self.wrong(GmshProblem::TooMany { count, what, room }));
        }
        Ok(())
    }

    /// An ASCII record begins on a line of its own.
    #[inline]
    pub(super) fn begin_record(&mut self) {
        if !self.is_binary() {
            self.skip_blank();
        }
    }

    /// An ASCII record ends with its line.
    #[inline]
    pub(super) fn end_record(&mut self) -> Result<()> {
        if self.is_binary() {
            Ok(())
        } else {
            self.end_text_line()
        }
    }
}
