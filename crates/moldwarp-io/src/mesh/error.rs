//! What can be wrong with a mesh file.

use std::fmt;
use std::io;
use std::path::PathBuf;

/// Why a mesh file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum MeshFileError {
    /// There is no such file.
    #[error("{} does not exist: {advice}", file.display())]
    Missing { file: PathBuf, advice: String },
    /// The system refuses to read it.
    #[error("{} cannot be read: {source}", file.display())]
    Unreadable { file: PathBuf, source: io::Error },
    /// One place of the file is wrong.
    #[error("{}, {place}: {problem}", file.display())]
    At {
        file: PathBuf,
        place: Place,
        problem: GmshProblem,
    },
    /// The file as a whole is wrong.
    #[error("{}: {problem}", file.display())]
    Whole { file: PathBuf, problem: GmshProblem },
}

/// A place in a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Line of an ASCII file, from 1.
    Line(usize),
    /// Byte of a binary file, from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(line) => write!(f, "line {line}"),
            Place::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// What is wrong with a Gmsh file. Nodes, elements and groups are named by their tags;
/// `command` is what a user types to put it right.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GmshProblem {
    #[error("a Gmsh mesh begins with `$MeshFormat`, this with {found}{advice}")]
    NotGmsh { found: String, advice: String },
    #[error("MSH format {version}; 2.2 and 4.1 can be read: `{command}`")]
    Version { version: String, command: String },
    #[error("expected {expected}, found {found}")]
    Expected { expected: String, found: String },
    #[error(
        "the file claims {count} {what}, but only {room} bytes follow; it may be cut short: copy it \
         again or mesh it again"
    )]
    TooMany {
        count: u64,
        what: &'static str,
        room: usize,
    },
    #[error(
        "the file has no section `${name}`; it is cut short or was saved before it was meshed: \
         `{command}`"
    )]
    NoSection { name: &'static str, command: String },
    #[error("`$Elements` comes before `$Nodes`; Gmsh writes the nodes first")]
    ElementsFirst,
    #[error(
        "`$Entities` comes after `$Elements`, whose groups it says; put it behind `$PhysicalNames`, as \
         Gmsh does"
    )]
    EntitiesLast,
    #[error("the mesh is partitioned; mesh it again without `-part`: `{command}`")]
    Partitioned { command: String },
    #[error("nodes with parameters in MSH 2.2 cannot be read; convert them: `{command}`")]
    ParametricNodes { command: String },
    #[error("two nodes have the tag {0}")]
    TwoNodes(u64),
    #[error("element {element} names node {node}, which the file does not have")]
    NoSuchNode { element: u64, node: u64 },
    #[error(
        "{shape} of higher order (Gmsh's element type {kind}), but moldwarp computes with 4-node \
         tetrahedra; take Mesh.ElementOrder and SetOrder out of the .geo and mesh it again: \
         `{command}`"
    )]
    HigherOrder {
        shape: &'static str,
        kind: i64,
        command: String,
    },
    #[error(
        "{shape} (Gmsh's element type {kind}), but moldwarp computes with tetrahedra only; take \
         Recombine out of the .geo, set Mesh.RecombineAll = 0, Mesh.Recombine3DAll = 0 and \
         Mesh.SubdivisionAlgorithm = 0, and mesh it again: `{command}`"
    )]
    NotTetrahedral {
        shape: &'static str,
        kind: i64,
        command: String,
    },
    #[error(
        "Gmsh's element type {0} is not known; 3-node triangles (2) and 4-node tetrahedra (4) are"
    )]
    UnknownElement(i64),
    #[error(
        "the file has no tetrahedra; mesh the geometry in 3D: `{command}`; or `revolve` it if it is the \
         plane mesh of a meridian"
    )]
    NoTetrahedra { command: String },
    #[error(
        "the file has no triangles in a physical group; give the surfaces of the meridian physical \
         groups and mesh it in 2D: `{command}`"
    )]
    NoTriangles { command: String },
    #[error(
        "the mesh has tetrahedra, but a plane mesh of a meridian is revolved; leave `revolve` out"
    )]
    NotPlane,
    #[error(
        "node {0} lies in neither of the planes y = 0 and z = 0; draw the meridian in x (the radius) \
         and z, or in x and y"
    )]
    OutOfPlane(u64),
    #[error("node {0} has a negative radius; draw the meridian on the side x ≥ 0 of the axis")]
    NegativeRadius(u64),
    #[error(
        "the triangle of nodes {} has no area; mesh the geometry again",
        list(nodes)
    )]
    FlatTriangle { nodes: Vec<u64> },
    #[error(
        "the triangles of nodes {} and {} overlap; if surfaces of the geometry overlap, cut them apart \
         with `Coherence;` in the .geo",
        list(first),
        list(second)
    )]
    TrianglesOverlap { first: Vec<u64>, second: Vec<u64> },
    #[error(
        "curve `{curve}` has a line of nodes {} that is no edge of a triangle; Gmsh saves only surfaces \
         that are in a Physical Surface, so check that the one beside this curve is",
        list(nodes)
    )]
    NoEdge { curve: String, nodes: Vec<u64> },
    #[error(
        "a triangle is in two physical surfaces, `{first}` and `{second}`; take it out of one of them"
    )]
    TwoAreas { first: String, second: String },
    #[error(
        "element {element} is in two volume groups, `{first}` and `{second}`; take its volume out \
         of one of the two Physical Volumes"
    )]
    TwoVolumes {
        element: u64,
        first: String,
        second: String,
    },
    #[error(
        "elements {first} and {second} have the same four nodes; if two volumes of the geometry \
         coincide, remove one"
    )]
    SameTetrahedron { first: u64, second: u64 },
    #[error("two tetrahedra have the tag {0}")]
    TwoElements(u64),
    #[error("the physical {kind}s {first} and {second} are both called `{name}`; rename one")]
    TwoNames {
        kind: &'static str,
        first: u64,
        second: u64,
        name: String,
    },
    #[error(
        "the physical group {tag} of dimension {dimension} is called both `{first}` and `{second}`; keep \
         one of the names"
    )]
    TwoNamesOfOne {
        dimension: i64,
        tag: u64,
        first: String,
        second: String,
    },
}

fn list(tags: &[u64]) -> String {
    let tags: Vec<String> = tags.iter().map(u64::to_string).collect();
    tags.join(", ")
}
