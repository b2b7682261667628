//! Mesh files.

use moldwarp::mesh::RawMesh;
use std::path::Path;

/// A mesh as read, with the numbers its file gave to nodes and elements.
#[derive(Debug)]
pub struct MeshFile {
    pub raw: RawMesh,
    /// The file's tag of each node of `raw`.
    pub node_tags: Vec<u64>,
    /// The file's tag of each tetrahedron of `raw`.
    pub element_tags: Vec<u64>,
    /// What a user should know, e.g. unused nodes that were dropped.
    pub notes: Vec<String>,
}

/// Why a mesh file could not be read.
#[derive(Debug, thiserror::Error)]
#[error("not read yet")]
pub struct MeshFileError;

/// Reads a Gmsh file.
pub fn read_gmsh(_path: &Path) -> Result<MeshFile, MeshFileError> {
    Err(MeshFileError)
}
