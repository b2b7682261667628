//! The background mesh: four-node tetrahedra with linear shape functions.
//!
//! A tetrahedron with nodes 0…3 is positively oriented, det(x₁−x₀, x₂−x₀, x₃−x₀) = 6V > 0.
//! The shape functions are the barycentric coordinates N₀…N₃; their gradients are constant in
//! the element. Local face `f` is the one opposite node `f`, where N_f = 0.

mod cylinder;
mod generate;
mod geometry;
mod locate;
mod motion;
mod quality;
mod revolve;
mod saved;
mod topology;
mod walls;

pub use cylinder::{CylinderError, CylinderSector, Split};
pub use generate::box_mesh;
pub use geometry::{barycentric, shortest_altitude, steepest_squared, tetrahedron_gradients};
pub(crate) use locate::is_outside;
pub use motion::{Driven, Follower, MotionError, Visit, Zones};
pub use quality::Quality;
pub use revolve::{PlaneMesh, Revolved};
pub use saved::MeshAt;
pub use walls::Walls;

use crate::Vec3;
use generate::KUHN_ORDERS;

/// No element, no node, no neighbour.
pub const NONE: u32 = u32::MAX;

/// Nodes of the face opposite each node, counter-clockwise seen from outside.
pub const FACE_NODES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// A face as seen from one of its elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    pub element: u32,
    /// The local node opposite the face.
    pub local: u8,
}

/// A corner of an element or of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Corner(u32);

impl Corner {
    pub(crate) fn new(owner: usize, local: usize) -> Corner {
        debug_assert!(owner < 1 << 30 && local < 4);
        Corner((owner << 2 | local) as u32)
    }

    /// Number of the element or cell.
    #[inline(always)]
    pub fn owner(self) -> usize {
        (self.0 >> 2) as usize
    }

    /// Local number of the node in it.
    #[inline(always)]
    pub fn local(self) -> usize {
        (self.0 & 3) as usize
    }
}

/// A named set of elements.
#[derive(Clone, Debug)]
pub struct VolumeGroup {
    pub name: String,
    pub elements: Vec<u32>,
}

/// A named set of faces. A face between two elements is listed once, from either side.
#[derive(Clone, Debug)]
pub struct Surface {
    pub name: String,
    pub faces: Vec<Face>,
}

/// What a mesh is made of before its connectivity is known: what a file or a generator brings.
#[derive(Clone, Debug, Default)]
pub struct RawMesh {
    /// Coordinates, m.
    pub nodes: Vec<Vec3>,
    /// Four node numbers each.
    pub tets: Vec<[u32; 4]>,
    /// Name and element numbers.
    pub volume_groups: Vec<(String, Vec<u32>)>,
    /// Name and triangles, each by its three node numbers in any order.
    pub surface_groups: Vec<(String, Vec<[u32; 3]>)>,
}

/// A tetrahedral mesh with all that the step needs to know of it.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Node coordinates, m.
    pub nodes: Vec<Vec3>,
    /// Nodes of each element, positively oriented.
    pub tets: Vec<[u32; 4]>,
    /// Element volumes, m³.
    pub volumes: Vec<f64>,
    /// The element across each local face, or [`NONE`].
    pub neighbours: Vec<[u32; 4]>,
    /// Volume of all elements attached to each node, m³.
    pub node_volumes: Vec<f64>,
    node_offsets: Vec<u32>,
    node_elements: Vec<Corner>,
    pub volume_groups: Vec<VolumeGroup>,
    pub surfaces: Vec<Surface>,
}

/// What can be wrong with a mesh. Elements and nodes are numbered from 0 in the order given.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum MeshError {
    #[error("the mesh has no tetrahedra")]
    Empty,
    #[error("node {node} has a coordinate that is not a finite number")]
    NotFinite { node: usize },
    #[error("element {element} names node {node}, but there are only {count} nodes")]
    NoSuchNode {
        element: usize,
        node: u32,
        count: usize,
    },
    #[error("element {element} is inverted: its volume is {volume:e} m³ (and {others} more)")]
    Inverted {
        element: usize,
        volume: f64,
        others: usize,
    },
    #[error("element {element} is flat: its volume is {volume:e} m³ (and {others} more)")]
    Flat {
        element: usize,
        volume: f64,
        others: usize,
    },
    #[error("more than two elements share the face of nodes {nodes:?} (elements {elements:?})")]
    FaceShared { nodes: [u32; 3], elements: Vec<u32> },
    #[error(
        "surface `{surface}` has a triangle of nodes {nodes:?} that is no face of a tetrahedron"
    )]
    NoSuchFace { surface: String, nodes: [u32; 3] },
    #[error("element {element} is in two volume groups, `{first}` and `{second}`")]
    TwoVolumes {
        element: u32,
        first: String,
        second: String,
    },
}

impl Mesh {
    /// Corners of elements at a node.
    pub fn attached(&self, node: u32) -> &[Corner] {
        let node = node as usize;
        &self.node_elements[self.node_offsets[node] as usize..self.node_offsets[node + 1] as usize]
    }

    /// Number of the surface with this name.
    pub fn surface(&self, name: &str) -> Option<usize> {
        self.surfaces.iter().position(|s| s.name == name)
    }

    /// Number of the volume group with this name.
    pub fn volume_group(&self, name: &str) -> Option<usize> {
        self.volume_groups.iter().position(|g| g.name == name)
    }

    /// Node numbers of a face, counter-clockwise seen from outside the face's element.
    pub fn face_nodes(&self, face: Face) -> [u32; 3] {
        let tet = &self.tets[face.element as usize];
        FACE_NODES[face.local as usize].map(|i| tet[i])
    }

    /// The same face seen from the element on its other side, if there is one.
    pub fn across(&self, face: Face) -> Option<Face> {
        let other = self.neighbours[face.element as usize][face.local as usize];
        (other != NONE).then(|| {
            let back = self.neighbours[other as usize]
                .iter()
                .position(|&n| n == face.element);
            Face {
                element: other,
                local: back.expect("neighbours are mutual") as u8,
            }
        })
    }

    /// Area times unit normal of a face, out of its element, m².
    pub fn face_area(&self, face: Face) -> Vec3 {
        let [a, b, c] = self.face_nodes(face).map(|n| self.nodes[n as usize]);
        0.5 * (b - a).cross(c - a)
    }

    /// All faces on the outside of the mesh.
    pub fn boundary_faces(&self) -> impl Iterator<Item = Face> + '_ {
        self.neighbours.iter().enumerate().flat_map(|(e, sides)| {
            sides
                .iter()
                .enumerate()
                .filter(|&(_, &n)| n == NONE)
                .map(move |(local, _)| Face {
                    element: e as u32,
                    local: local as u8,
                })
        })
    }

    /// Smallest and largest coordinates, m.
    pub fn bounds(&self) -> [Vec3; 2] {
        let first = [self.nodes[0]; 2];
        self.nodes
            .iter()
            .fold(first, |[low, high], &x| [low.min(x), high.max(x)])
    }

    /// Sum of the element volumes, m³.
    pub fn total_volume(&self) -> f64 {
        self.volumes.iter().sum()
    }
}
