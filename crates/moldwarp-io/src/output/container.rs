//! A file of named sections of bytes that notices any damage.
//!
//! | bytes | content |
//! |---|---|
//! | 8 | [`MAGIC`] |
//! | 4 | version of this layout |
//! | 4, n, 8, m | length of a section's name, the name, length of the section, the section; as often as there are sections |
//! | 32 | BLAKE3 of everything before |
//!
//! Numbers are little-endian.

use super::FileError;
use moldwarp::saved::Section;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// What the file begins with: no text, and other bytes once anything has taken it for one.
const MAGIC: [u8; 8] = *b"\x89MWC\r\n\x1a\n";
/// Of this layout.
const VERSION: u32 = 1;
const CHECKSUM: usize = blake3::OUT_LEN;

/// A file that is being written.
#[derive(Debug)]
pub struct Sections<W: Write> {
    out: W,
    hash: blake3::Hasher,
}

impl<W: Write> Sections<W> {
    fn begin(out: W) -> io::Result<Sections<W>> {
        let hash = blake3::Hasher::new();
        let mut sections = Sections { out, hash };
        sections.put(&MAGIC)?;
        sections.put(&VERSION.to_le_bytes())?;
        Ok(sections)
    }

    /// Adds a section.
    pub fn add(&mut self, name: &str, bytes: &[u8]) -> io::Result<()> {
        self.begin_section(name, bytes.len())?;
        self.put(bytes)
    }

    /// Adds a section that is made piece by piece.
    pub fn add_pieces(&mut self, name: &str, section: &Section) -> io::Result<()> {
        self.begin_section(name, section.size())?;
        let (mut written, mut left) = (Ok(()), section.size());
        section.pieces(&mut |piece| {
            left = left.wrapping_sub(piece.len());
            if written.is_ok() {
                written = self.put(piece);
            }
        });
        assert!(left == 0, "section {name} is not of the size it said");
        written
    }

    fn begin_section(&mut self, name: &str, size: usize) -> io::Result<()> {
        self.put(&(name.len() as u32).to_le_bytes())?;
        self.put(name.as_bytes())?;
        self.put(&(size as u64).to_le_bytes())
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hash.update(bytes);
        self.out.write_all(bytes)
    }

    fn end(mut self) -> io::Result<W> {
        self.out.write_all(self.hash.finalize().as_bytes())?;
        Ok(self.out)
    }
}

/// Writes a file beside its place, brings it to the disk and renames it there: whatever happens
/// meanwhile, there is the old file or the new one.
pub fn write(
    path: &Path,
    fill: impl FnOnce(&mut Sections<BufWriter<File>>) -> io::Result<()>,
) -> Result<(), FileError> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    let part = path.with_file_name(name);
    let written = File::create(&part).and_then(|file| {
        let mut sections = Sections::begin(BufWriter::with_capacity(1 << 20, file))?;
        fill(&mut sections)?;
        let file = sections.end()?.into_inner().map_err(|e| e.into_error())?;
        file.sync_all()?;
        fs::rename(&part, path)?;
        sync_folder(path)
    });
    written.map_err(|reason| {
        // It is of no use, and where a disk is full its room is needed.
        let _ = fs::remove_file(&part);
        FileError::at("write", path)(reason)
    })
}

/// Brings the new name to the disk, too.
fn sync_folder(path: &Path) -> io::Result<()> {
    match path.parent() {
        Some(folder) if cfg!(unix) => File::open(folder)?.sync_all(),
        _ => Ok(()),
    }
}

/// Why a file cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Damage {
    #[error("it is no checkpoint of moldwarp")]
    Foreign,
    #[error("it is of another version of moldwarp (layout {0})")]
    Version(u32),
    #[error("it is damaged")]
    Damaged,
}

/// The sections of a file with their names, in order; nothing of it has been changed since it was
/// written.
///
/// # Errors
///
/// If it has, or is no such file.
pub fn read(bytes: &[u8]) -> Result<Vec<(&str, &[u8])>, Damage> {
    if !bytes.starts_with(&MAGIC) {
        return Err(Damage::Foreign);
    }
    let (content, checksum) = split(bytes)?;
    if blake3::hash(content).as_bytes() != checksum {
        return Err(Damage::Damaged);
    }
    sections(bytes)
}

/// The same of bytes that have been [`read`] before.
pub fn sections(bytes: &[u8]) -> Result<Vec<(&str, &[u8])>, Damage> {
    let (content, _) = split(bytes)?;
    let mut rest = &content[MAGIC.len()..];
    match u32::from_le_bytes(chunk(&mut rest)?) {
        VERSION => {}
        other => return Err(Damage::Version(other)),
    }
    let mut sections = Vec::new();
    while !rest.is_empty() {
        let length = u32::from_le_bytes(chunk(&mut rest)?);
        let name = take(&mut rest, length.into())?;
        let name = std::str::from_utf8(name).map_err(|_| Damage::Damaged)?;
        let length = u64::from_le_bytes(chunk(&mut rest)?);
        sections.push((name, take(&mut rest, length)?));
    }
    Ok(sections)
}

/// Gives bytes that have been changed the checksum that belongs to them, for tests of what comes after it.
pub fn seal(bytes: &mut [u8]) {
    let content = bytes.len().saturating_sub(CHECKSUM);
    let (content, checksum) = bytes.split_at_mut(content);
    let right = blake3::hash(content);
    checksum.copy_from_slice(&right.as_bytes()[CHECKSUM - checksum.len()..]);
}

/// What the checksum is of, and the checksum.
fn split(bytes: &[u8]) -> Result<(&[u8], &[u8; CHECKSUM]), Damage> {
    let parts = bytes.split_last_chunk();
    let long_enough = |parts: &(&[u8], _)| parts.0.len() >= MAGIC.len();
    parts.filter(long_enough).ok_or(Damage::Damaged)
}

fn chunk<const N: usize>(bytes: &mut &[u8]) -> Result<[u8; N], Damage> {
    let (first, rest) = bytes.split_first_chunk().ok_or(Damage::Damaged)?;
    *bytes = rest;
    Ok(*first)
}

fn take<'a>(bytes: &mut &'a [u8], count: u64) -> Result<&'a [u8], Damage> {
    let count = usize::try_from(count).map_err(|_| Damage::Damaged)?;
    let (first, rest) = bytes.split_at_checked(count).ok_or(Damage::Damaged)?;
    *bytes = rest;
    Ok(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No bit can turn over, and nothing can be cut off or added, without being noticed.
    #[test]
    fn any_damage_is_noticed() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.checkpoint");
        write(&path, |sections| {
            sections.add_pieces("numbers", &Section::new(&[1u8, 2, 3]))?;
            sections.add("nothing", &[])
        })
        .unwrap();
        let mut bytes = fs::read(&path).unwrap();
        let sections = [("numbers", &[1, 2, 3][..]), ("nothing", &[])];
        assert_eq!(read(&bytes).unwrap(), sections);
        for bit in 0..8 * bytes.len() {
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert!(read(&bytes).is_err(), "bit {bit}");
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        for length in 0..bytes.len() {
            assert!(read(&bytes[..length]).is_err(), "{length} bytes");
        }
        bytes.push(0);
        assert!(read(&bytes).is_err());
    }

    /// A file that cannot be written leaves the one before and nothing else.
    #[test]
    fn the_old_file_stays_until_there_is_a_new_one() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.checkpoint");
        write(&path, |sections| sections.add("old", &[1])).unwrap();
        let full = || io::Error::from(io::ErrorKind::StorageFull);
        let failed = write(&path, |sections| {
            sections.add("new", &[2])?;
            Err(full())
        });
        assert!(failed.is_err());
        let bytes = fs::read(&path).unwrap();
        assert_eq!(read(&bytes).unwrap(), [("old", &[1][..])]);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }
}
