//! Numbers and words out of the bytes of a file, ASCII or binary.

use super::super::{GmshProblem, MeshFileError, Place};
use super::Result;
use std::path::Path;

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    Ascii,
    Binary { big_endian: bool },
}

/// A place in the bytes of a file, and how to read on from there.
///
/// The methods with `text` in their name read ASCII even in a binary file. `what` says what
/// should stand there, for the message when it does not. An ASCII record is a line: fields are
/// looked for up to its end only, so that a missing one is found where it is missing.
pub(super) struct Cursor<'a> {
    pub(super) file: &'a Path,
    pub(super) bytes: &'a [u8],
    pub(super) at: usize,
    /// Where the value read last begins.
    pub(super) last: usize,
    pub(super) encoding: Encoding,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(file: &'a Path, bytes: &'a [u8]) -> Self {
        let mark = b"\xef\xbb\xbf";
        let at = if bytes.starts_with(mark) { 3 } else { 0 };
        Cursor {
            file,
            bytes,
            at,
            last: at,
            encoding: Encoding::Ascii,
        }
    }

    /// A fault at the value read last.
    pub(super) fn wrong(&self, problem: GmshProblem) -> MeshFileError {
        let place = match self.encoding {
            Encoding::Ascii => {
                let before = &self.bytes[..self.last];
                Place::Line(1 + before.iter().filter(|&&b| b == b'\n').count())
            }
            Encoding::Binary { .. } => Place::Byte(self.last),
        };
        MeshFileError::At {
            file: self.file.to_owned(),
            place,
            problem,
        }
    }

    /// The value read last should have been another.
    pub(super) fn unexpected(&self, expected: &str, found: &str) -> MeshFileError {
        self.wrong(GmshProblem::Expected {
            expected: expected.to_owned(),
            found: excerpt(found.as_bytes()),
        })
    }

    /// From here on something else should stand.
    fn unexpected_here(&mut self, expected: &str) -> MeshFileError {
        self.last = self.at;
        let found = self.peek();
        self.wrong(GmshProblem::Expected {
            expected: expected.to_owned(),
            found,
        })
    }

    /// What stands here, for a message.
    pub(super) fn peek(&self) -> String {
        let rest = &self.bytes[self.at..];
        match rest {
            [] => "the end of the file".to_owned(),
            [b'\n' | b'\r', ..] => "the end of the line".to_owned(),
            _ => {
                let line = |b: &u8| !matches!(b, b'\n' | b'\r');
                let length = rest.iter().take(60).take_while(|b| line(b)).count();
                excerpt(&rest[..length])
            }
        }
    }

    // Sections.

    pub(super) fn skip_blank(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().take_while(|b| b.is_ascii_whitespace()).count();
    }

    /// Whether these bytes come next, after blanks.
    pub(super) fn begins_with(&mut self, start: &[u8]) -> bool {
        self.skip_blank();
        self.last = self.at;
        self.bytes[self.at..].starts_with(start)
    }

    /// The rest of the line, which is left behind together with its end.
    fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&b| b == b'\n');
        let (line, next) = match length {
            Some(n) => (&rest[..n], n + 1),
            None => (rest, rest.len()),
        };
        self.at += next;
        line.strip_suffix(b"\r").unwrap_or(line)
    }

    /// The name of the section that begins here, without its `$`; `None` at the end of the file.
    pub(super) fn section(&mut self) -> Result<Option<&'a str>> {
        self.skip_blank();
        self.last = self.at;
        if self.at == self.bytes.len() {
            return Ok(None);
        }
        if self.bytes[self.at] != b'$' || self.bytes[self.at..].starts_with(b"$End") {
            return Err(self.unexpected_here("a section, `$Name`"));
        }
        let line = self.rest_of_line().trim_ascii_end();
        match std::str::from_utf8(&line[1..]) {
            Ok(name) if !name.is_empty() => Ok(Some(name)),
            _ => {
                self.at = self.last;
                Err(self.unexpected_here("a section, `$Name`"))
            }
        }
    }

    /// Steps over `$EndName`.
    pub(super) fn end_section(&mut self, name: &str) -> Result<()> {
        let end = format!("$End{name}");
        if !self.begins_with(end.as_bytes()) {
            return Err(self.unexpected_here(&format!("`{end}`")));
        }
        self.at += end.len();
        self.end_text_line()
    }

    /// Steps over all up to and with `$EndName`.
    pub(super) fn skip_section(&mut self, name: &str) -> Result<()> {
        let end = format!("$End{name}");
        let rest = &self.bytes[self.at..];
        // Only from one dollar to the next, so that a long section is searched once.
        let mut from = 0;
        while let Some(step) = rest[from..].iter().position(|&b| b == b'$') {
            from += step;
            if rest[from..].starts_with(end.as_bytes()) {
                self.at += from + end.len();
                self.rest_of_line();
                return Ok(());
            }
            from += 1;
        }
        // `last` is still the section's beginning: the end of the file would say nothing.
        Err(self.wrong(GmshProblem::Expected {
            expected: format!("`{end}` somewhere after `${name}`"),
            found: "none".to_owned(),
        }))
    }

    // Text.

    /// Goes to the next line that is not blank.
    pub(super) fn begin_text_line(&mut self) {
        self.skip_blank();
    }

    /// The next word of this line.
    pub(super) fn text(&mut self, what: &str) -> Result<&'a str> {
        let word = self.word(what)?;
        match std::str::from_utf8(word) {
            Ok(word) => Ok(word),
            Err(_) => {
                self.at = self.last;
                Err(self.unexpected_here(what))
            }
        }
    }

    #[inline]
    pub(super) fn word(&mut self, what: &str) -> Result<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let blank = rest
            .iter()
            .take_while(|&&b| b == b' ' || b == b'\t')
            .count();
        let length = rest[blank..]
            .iter()
            .take_while(|b| !b.is_ascii_whitespace())
            .count();
        self.last = self.at + blank;
        if length == 0 {
            self.at = self.last;
            return Err(self.unexpected_here(what));
        }
        self.at = self.last + length;
        Ok(&rest[blank..blank + length])
    }

    /// The next integer of this line.
    pub(super) fn text_integer(&mut self, what: &str) -> Result<i64> {
        let word = self.word(what)?;
        match parse_integer(word) {
            Some(number) => Ok(number),
            None => Err(self.unexpected(what, &String::from_utf8_lossy(word))),
        }
    }

    /// A line with the number of things to come, each of `least` bytes or more.
    pub(super) fn text_count(&mut self, what: &'static str, least: usize) -> Result<u64> {
        self.begin_text_line();
        let count = self.text_integer(what).map_err(|e| number_of(what, e))?;
        let Ok(count) = u64::try_from(count) else {
            return Err(self.unexpected(&format!("the number of {what}"), &count.to_string()));
        };
        self.end_text_line()?;
        self.check_room(count, what, least)?;
        Ok(count)
    }

    /// The rest of the line, between double quotes.
    pub(super) fn quoted(&mut self, what: &str) -> Result<&'a str> {
        self.last = self.at;
        let line = self.rest_of_line().trim_ascii();
        let inner = line.strip_prefix(b"\"").and_then(|l| l.strip_suffix(b"\""));
        match inner.map(std::str::from_utf8) {
            Some(Ok(name)) if !name.is_empty() => Ok(name),
            _ => Err(self.unexpected(what, &String::from_utf8_lossy(line))),
        }
    }

    /// Nothing more may stand on this line; it is left behind.
    pub(super) fn end_text_line(&mut self) -> Result<()> {
        let rest = &self.bytes[self.at..];
        let blank = rest
            .iter()
            .take_while(|b| matches!(b, b' ' | b'\t' | b'\r'))
            .count();
        self.at += blank;
        match rest.get(blank) {
            None => Ok(()),
            Some(b'\n') => {
                self.at += 1;
                Ok(())
            }
            Some(_) => Err(self.unexpected_here("the end of the line")),
        }
    }
}

/// Where the number of some things was expected, not these.
pub(super) fn number_of(what: &str, mut error: MeshFileError) -> MeshFileError {
    if let MeshFileError::At {
        problem: GmshProblem::Expected { expected, .. },
        ..
    } = &mut error
        && expected.starts_with(what)
    {
        *expected = format!("the number of {expected}");
    }
    error
}

#[inline]
fn parse_integer(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, word),
    };
    if digits.is_empty() {
        return None;
    }
    let mut number: i64 = 0;
    for &b in digits {
        let digit = b.wrapping_sub(b'0');
        if digit > 9 {
            return None;
        }
        number = number.checked_mul(10)?.checked_add(digit.into())?;
    }
    Some(if negative { -number } else { number })
}

/// Bytes of a file for a message: short, in backticks, without control characters.
pub(super) fn excerpt(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let mut shown: String = text.trim_end().chars().take(40).collect();
    if shown.len() < text.trim_end().len() {
        shown.push('…');
    }
    format!("`{}`", shown.replace(char::is_control, "\u{fffd}"))
}
