//! Results as files: frames for ParaView, histories, the summary, and the folder they are in.

pub mod compare;
pub mod container;
pub mod csv;
pub mod folder;
pub mod hash;
pub mod pvd;
pub mod summary;
pub mod vtu;
pub mod vtu_read;

pub use folder::{Folder, FolderError};
pub use hash::Hasher;
pub use summary::{Projected, Summary};

use std::io;
use std::path::{Path, PathBuf};

/// A file that could not be read or written.
#[derive(Debug, thiserror::Error)]
#[error("cannot {action} {}: {reason}", .path.display())]
pub struct FileError {
    /// `read`, `write`, `create` …
    pub action: &'static str,
    pub path: PathBuf,
    /// The system's. Not the error's source, or it would be shown twice.
    pub reason: io::Error,
}

impl FileError {
    /// For `map_err`: puts the action and the path beside the system's reason.
    pub fn at<'a>(
        action: &'static str,
        path: &'a Path,
    ) -> impl FnOnce(io::Error) -> FileError + 'a {
        move |reason| FileError {
            action,
            path: path.to_owned(),
            reason,
        }
    }
}

/// Brings a file to the disk, beyond the system's own memory.
pub(crate) fn sync(path: &Path) -> Result<(), FileError> {
    let file = std::fs::File::options().append(true).open(path);
    file.and_then(|file| file.sync_all())
        .map_err(FileError::at("write", path))
}

/// Writes a file beside its place and renames it there, so that a reader, or a run that is cut
/// off, finds either the old file or the new one and never a part.
pub(crate) fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut io::BufWriter<std::fs::File>) -> io::Result<()>,
) -> Result<(), FileError> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    let part = path.with_file_name(name);
    std::fs::File::create(&part)
        .and_then(|file| {
            let mut out = io::BufWriter::with_capacity(1 << 20, file);
            write(&mut out)?;
            io::Write::flush(&mut out)
        })
        .and_then(|()| std::fs::rename(&part, path))
        .map_err(FileError::at("write", path))
}
