//! A mesh's faults in the numbers of the file it was read from.

use crate::text::number;
use moldwarp::mesh::MeshError;

/// What Gmsh can do about bad elements.
const MESH_AGAIN: &str = "mesh the geometry again with Mesh.Optimize = 1 in the .geo, or with \
                          `gmsh -3 -optimize`";

/// Says what is wrong with a mesh, and what to do, in its file's own tags.
///
/// [`MeshError`] counts nodes and elements from 0 in the order of the arrays; `node_tags` and
/// `element_tags` are those of the [`MeshFile`](super::MeshFile) that brought the mesh. The mesh
/// itself is not needed: [`Mesh::new`](moldwarp::mesh::Mesh::new) has consumed it.
pub fn explain_mesh_error(error: &MeshError, node_tags: &[u64], element_tags: &[u64]) -> String {
    let node = |n: usize| tag(node_tags, n);
    let element = |e: usize| tag(element_tags, e);
    let list = |nodes: &[u32; 3]| nodes.map(|n| node(n as usize)).join(", ");
    match error {
        MeshError::Empty => error.to_string(),
        MeshError::NotFinite { node: n } => {
            let n = node(*n);
            format!(
                "node {n} has a coordinate that is not a finite number; check it and `mesh.unit`"
            )
        }
        MeshError::NoSuchNode {
            element: e,
            node: n,
            ..
        } => {
            let (e, n) = (element(*e), node(*n as usize));
            format!("element {e} names node {n}, which the mesh does not have")
        }
        MeshError::Inverted {
            element: e,
            volume,
            others,
        } => {
            let (e, others) = (element(*e), more(*others));
            format!(
                "element {e} is inverted, its volume is {} m³{others}; {MESH_AGAIN}",
                number(*volume)
            )
        }
        MeshError::Flat {
            element: e,
            volume,
            others,
        } => {
            let (e, others) = (element(*e), more(*others));
            format!(
                "element {e} is flat, its volume is {} m³{others}; {MESH_AGAIN}",
                number(*volume)
            )
        }
        MeshError::FaceShared { nodes, elements } => {
            let elements: Vec<String> = elements.iter().map(|&e| element(e as usize)).collect();
            format!(
                "the elements {} share the face of nodes {}, which can have two at most; if \
                 volumes of the geometry overlap, cut them apart with `Coherence;` in the .geo",
                elements.join(", "),
                list(nodes)
            )
        }
        MeshError::NoSuchFace { surface, nodes } => format!(
            "surface `{surface}` has a triangle of nodes {} that is no face of a tetrahedron; \
             Gmsh saves only volumes that are in a Physical Volume, so check that the one behind \
             this surface is",
            list(nodes)
        ),
        MeshError::TwoVolumes {
            element: e,
            first,
            second,
        } => format!(
            "element {} is in two volume groups, `{first}` and `{second}`; take its volume out \
             of one of the two Physical Volumes",
            element(*e as usize)
        ),
    }
}

fn tag(tags: &[u64], number: usize) -> String {
    match tags.get(number) {
        Some(tag) => tag.to_string(),
        None => format!("{number} (counted from 0)"),
    }
}

fn more(others: usize) -> String {
    match others {
        0 => String::new(),
        n => format!(" (and {n} more)"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_told_in_the_files_tags() {
        let explain = |error| explain_mesh_error(&error, &[10, 20, 30, 40], &[7, 9]);
        assert_eq!(
            explain(MeshError::Inverted {
                element: 1,
                volume: -0.5,
                others: 2
            }),
            "element 9 is inverted, its volume is -0.5 m³ (and 2 more); mesh the geometry again \
             with Mesh.Optimize = 1 in the .geo, or with `gmsh -3 -optimize`"
        );
        assert_eq!(
            explain(MeshError::Flat {
                element: 0,
                volume: 0.0,
                others: 0
            }),
            "element 7 is flat, its volume is 0 m³; mesh the geometry again with \
             Mesh.Optimize = 1 in the .geo, or with `gmsh -3 -optimize`"
        );
        assert_eq!(
            explain(MeshError::FaceShared {
                nodes: [0, 1, 3],
                elements: vec![0, 1, 5]
            }),
            "the elements 7, 9, 5 (counted from 0) share the face of nodes 10, 20, 40, which can \
             have two at most; if volumes of the geometry overlap, cut them apart with \
             `Coherence;` in the .geo"
        );
        assert_eq!(
            explain(MeshError::NoSuchFace {
                surface: "top".into(),
                nodes: [1, 2, 3]
            }),
            "surface `top` has a triangle of nodes 20, 30, 40 that is no face of a tetrahedron; \
             Gmsh saves only volumes that are in a Physical Volume, so check that the one behind \
             this surface is"
        );
    }
}
