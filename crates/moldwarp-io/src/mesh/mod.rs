//! Mesh files: Gmsh's MSH 2.2 and 4.1, ASCII and binary.

mod error;
mod explain;
mod gmsh;
mod missing;
mod overlap;
mod quality;

pub use error::{GmshProblem, MeshFileError, Place};
pub use explain::explain_mesh_error;
pub use overlap::{Overlap, check_overlap};
pub use quality::describe_quality;

use moldwarp::mesh::{PlaneMesh, RawMesh};
use std::fs;
use std::io;
use std::path::Path;

/// A mesh as read, with the numbers its file gave to nodes and elements.
///
/// [`Mesh::new`](moldwarp::mesh::Mesh::new) takes `raw`; should it refuse,
/// [`explain_mesh_error`] says why in the file's own numbers.
#[derive(Debug)]
pub struct MeshFile {
    /// Coordinates are the file's own, in whatever unit it was drawn.
    pub raw: RawMesh,
    /// The file's tag of each node of `raw`.
    pub node_tags: Vec<u64>,
    /// The file's tag of each tetrahedron of `raw`.
    pub element_tags: Vec<u64>,
    /// What a user should know, e.g. unused nodes that were dropped.
    pub notes: Vec<String>,
}

/// Reads a Gmsh file.
///
/// Volume groups are the physical groups of 4-node tetrahedra, surface groups those of 3-node
/// triangles, in the order of their tags; a group without a name is called by its tag. Points and
/// lines are left out. Nodes and elements keep the file's order and orientation.
///
/// # Errors
///
/// Whatever keeps the file from being a mesh of tetrahedra, with the line (ASCII) or byte (binary)
/// and what to do about it.
pub fn read_gmsh(path: &Path) -> Result<MeshFile, MeshFileError> {
    parse_gmsh(path, &bytes(path, gmsh::mesh_command)?)
}

fn bytes(path: &Path, command: fn(&Path) -> String) -> Result<Vec<u8>, MeshFileError> {
    read_bytes(path).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => missing::error(path, command),
        _ => MeshFileError::Unreadable {
            file: path.to_owned(),
            source,
        },
    })
}

/// A plane mesh as read, with the numbers its file gave to nodes.
#[derive(Debug)]
pub struct PlaneFile {
    /// Coordinates are the file's own, in whatever unit it was drawn.
    pub plane: PlaneMesh,
    /// The file's tag of each node.
    pub node_tags: Vec<u64>,
    /// What a user should know, e.g. unused nodes that were dropped.
    pub notes: Vec<String>,
}

/// Reads the plane mesh of a meridian from a Gmsh file, in x and z (y = 0) or in x and y (z = 0); x
/// is the radius.
///
/// Areas are the physical groups of 3-node triangles, lines those of 2-node lines, in the order of
/// their tags; triangles in no group are left out.
///
/// # Errors
///
/// Whatever keeps the file from being such a mesh, with the line (ASCII) or byte (binary) and what to
/// do about it.
pub fn read_plane_gmsh(path: &Path) -> Result<PlaneFile, MeshFileError> {
    parse_plane_gmsh(path, &bytes(path, gmsh::plane_command)?)
}

/// Reads a plane mesh from memory; `file` is its name in messages.
///
/// # Errors
///
/// As [`read_plane_gmsh`].
pub fn parse_plane_gmsh(file: &Path, bytes: &[u8]) -> Result<PlaneFile, MeshFileError> {
    gmsh::parse_plane(file, bytes)
}

/// Reads a Gmsh file from memory; `file` is its name in messages.
///
/// # Errors
///
/// As [`read_gmsh`].
pub fn parse_gmsh(file: &Path, bytes: &[u8]) -> Result<MeshFile, MeshFileError> {
    gmsh::parse(file, bytes)
}

/// The whole of a regular file; a pipe or a device may have no end.
fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    if fs::metadata(path)?.is_file() {
        fs::read(path)
    } else {
        Err(io::Error::other("it is not a regular file"))
    }
}
