//! A ParaView collection: which frame is at which time.

use super::vtu::escape;
use super::{FileError, write_whole};
use std::io::Write;
use std::path::PathBuf;

/// A collection on disk, complete after every frame: a run that is cut off can still be opened.
#[derive(Debug)]
pub struct Collection {
    path: PathBuf,
    /// Time in s, and the frame's path from the collection's folder.
    frames: Vec<(f64, String)>,
}

impl Collection {
    /// A collection without frames; the file appears with the first one.
    pub fn new(path: PathBuf) -> Collection {
        Collection {
            path,
            frames: Vec::new(),
        }
    }

    /// A collection that goes on after these frames, and is cut off behind them.
    pub fn resume(path: PathBuf, frames: Vec<(f64, String)>) -> Result<Collection, FileError> {
        let collection = Collection { path, frames };
        match collection.is_empty() {
            false => collection.write()?,
            true if collection.path.exists() => std::fs::remove_file(&collection.path)
                .map_err(FileError::at("remove", &collection.path))?,
            true => {}
        }
        Ok(collection)
    }

    /// Adds a frame that has been written: its time in s and its path from the collection's
    /// folder, with `/` between the parts.
    pub fn add(&mut self, time: f64, frame: &str) -> Result<(), FileError> {
        self.frames.push((time, frame.to_owned()));
        self.write()
    }

    fn write(&self) -> Result<(), FileError> {
        write_whole(&self.path, |out| {
            writeln!(
                out,
                "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>"
            )?;
            for (time, frame) in &self.frames {
                writeln!(
                    out,
                    "<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{}\"/>",
                    escape(frame)
                )?;
            }
            writeln!(out, "</Collection>\n</VTKFile>")
        })
    }

    /// Times of the frames so far, s.
    pub fn times(&self) -> impl Iterator<Item = f64> + '_ {
        self.frames.iter().map(|f| f.0)
    }

    /// Number of frames so far.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether there is no frame yet.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_is_whole_after_every_frame() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("particles.pvd");
        let mut pvd = Collection::new(path.clone());
        assert!(!path.exists());
        for i in 0..3 {
            pvd.add(0.1 * f64::from(i), &format!("frames/p{i}.vtu"))
                .unwrap();
            let text = std::fs::read_to_string(&path).unwrap();
            assert_eq!(text.matches("<DataSet ").count(), pvd.len());
            assert!(text.ends_with("</VTKFile>\n"));
        }
        assert!(
            std::fs::read_to_string(&path)
                .unwrap()
                .contains("timestep=\"0.2\" part=\"0\" file=\"frames/p2.vtu\"")
        );
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
    }
}
