//! The scene's mesh: from a file or a generator.

use super::amount::Spanned;
use super::error::Fault;
use super::quantity::{self, Dimension};
use super::raw::{RawBox, RawMesh, Text};
use super::values::{exactly_one, span, three, vector};
use crate::mesh::{MeshFile, read_gmsh};
use moldwarp::Mesh;
use moldwarp::mesh::{MeshError, box_mesh};
use std::path::Path;

/// More cells than this are a slip, not a mesh: 24 million elements.
const MOST_CELLS: u64 = 4_000_000;

/// The mesh in metres. What its reader has to say goes to `notes`.
pub(super) fn mesh(
    raw: &Spanned<RawMesh>,
    folder: &Path,
    notes: &mut Vec<String>,
) -> Result<Mesh, Fault> {
    let place = raw.span();
    let raw = raw.get_ref();
    exactly_one(
        (place, "the mesh"),
        &[("file", span(&raw.file)), ("box", span(&raw.cuboid))],
    )?;
    match (&raw.file, &raw.cuboid, &raw.unit) {
        (Some(file), _, unit) => from_file(file, unit.as_ref(), folder, notes),
        (None, Some(_), Some(unit)) => Err(Fault::new("`unit` is for mesh files")
            .at(unit.span(), "a generated mesh does not need it")
            .help("write the unit in the box's size: size = [\"1 m\", \"1 m\", \"20 cm\"]")),
        (None, Some(cuboid), None) => generated(cuboid),
        (None, None, _) => Err(Fault::new("the scene has no mesh")),
    }
}

fn generated(cuboid: &Spanned<RawBox>) -> Result<Mesh, Fault> {
    let raw = cuboid.get_ref();
    let size = vector("size", &raw.size, Dimension::Length)?;
    if let Some(axis) = (0..3).find(|&d| size[d] <= 0.0) {
        return Err(Fault::new("a box needs a size greater than zero")
            .at(raw.size.get_ref()[axis].span(), "not greater than zero"));
    }
    let mut cells = [0; 3];
    for (i, n) in three("cells", &raw.cells)?.iter().enumerate() {
        cells[i] = super::values::count("cells", n, 1)? as usize;
    }
    let total = cells.iter().try_fold(1u64, |p, &n| p.checked_mul(n as u64));
    if total.is_none_or(|n| n > MOST_CELLS) {
        return Err(Fault::new("the box has too many cells")
            .at(raw.cells.span(), format!("more than {MOST_CELLS}"))
            .help("each cell becomes six elements; take fewer"));
    }
    box_mesh(size, cells).map_err(|e| damaged(e.to_string(), cuboid.span()))
}

fn from_file(
    file: &Text,
    unit: Option<&Text>,
    folder: &Path,
    notes: &mut Vec<String>,
) -> Result<Mesh, Fault> {
    let scale = match unit {
        Some(unit) => length_unit(unit)?,
        None => 1.0,
    };
    let path = folder.join(file.get_ref());
    if !path.exists() {
        return Err(missing(file, &path));
    }
    let mut read = read_gmsh(&path).map_err(|e| damaged(e.to_string(), file.span()))?;
    for x in &mut read.raw.nodes {
        *x *= scale;
    }
    notes.append(&mut read.notes);
    let raw = std::mem::take(&mut read.raw);
    Mesh::new(raw).map_err(|e| damaged(in_file_numbers(e, &read).to_string(), file.span()))
}

fn length_unit(unit: &Text) -> Result<f64, Fault> {
    quantity::parse(&format!("1 {}", unit.get_ref()), Dimension::Length).map_err(|_| {
        Fault::new(format!("`{}` is not a unit of length", unit.get_ref()))
            .at(unit.span(), "should be m, cm or mm")
            .help("unit = \"mm\" if the mesh was drawn in millimetres")
    })
}

/// A mesh is often made from a .geo beside it that was not meshed yet.
fn missing(file: &Text, path: &Path) -> Fault {
    let name = file.get_ref();
    let geometry = Path::new(name).with_extension("geo");
    let help = if path.with_extension("geo").exists() {
        format!(
            "make it in the scene's folder with `gmsh -3 {} -o {name}`",
            geometry.display()
        )
    } else {
        "paths are relative to the scene's folder".to_owned()
    };
    Fault::new(format!("there is no mesh file `{name}`"))
        .at(file.span(), "no such file")
        .help(help)
}

fn damaged(message: String, place: std::ops::Range<usize>) -> Fault {
    Fault::new(message).at(place, "this mesh")
}

/// The user knows the elements and nodes by their numbers in the file.
fn in_file_numbers(error: MeshError, file: &MeshFile) -> MeshError {
    let of = |tags: &[u64], i: usize| tags.get(i).map_or(i, |&tag| tag as usize);
    let small = |tags: &[u64], i: u32| u32::try_from(of(tags, i as usize)).unwrap_or(i);
    let (nodes, elements) = (&file.node_tags, &file.element_tags);
    match error {
        MeshError::NotFinite { node } => MeshError::NotFinite {
            node: of(nodes, node),
        },
        MeshError::Inverted {
            element,
            volume,
            others,
        } => MeshError::Inverted {
            element: of(elements, element),
            volume,
            others,
        },
        MeshError::Flat {
            element,
            volume,
            others,
        } => MeshError::Flat {
            element: of(elements, element),
            volume,
            others,
        },
        MeshError::FaceShared {
            nodes: n,
            elements: e,
        } => MeshError::FaceShared {
            nodes: n.map(|i| small(nodes, i)),
            elements: e.into_iter().map(|i| small(elements, i)).collect(),
        },
        MeshError::NoSuchFace { surface, nodes: n } => MeshError::NoSuchFace {
            surface,
            nodes: n.map(|i| small(nodes, i)),
        },
        MeshError::TwoVolumes {
            element,
            first,
            second,
        } => MeshError::TwoVolumes {
            element: small(elements, element),
            first,
            second,
        },
        other @ (MeshError::Empty | MeshError::NoSuchNode { .. }) => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use moldwarp::mesh::RawMesh;

    #[test]
    fn a_damaged_element_has_its_number_in_the_file() {
        let file = MeshFile {
            raw: RawMesh::default(),
            node_tags: vec![10, 20, 30],
            element_tags: vec![100, 200],
            notes: Vec::new(),
        };
        let error = MeshError::Flat {
            element: 1,
            volume: 0.0,
            others: 0,
        };
        let message = in_file_numbers(error, &file).to_string();
        assert!(message.starts_with("element 200 is flat"), "{message}");
        let error = MeshError::FaceShared {
            nodes: [0, 1, 2],
            elements: vec![0, 1],
        };
        let message = in_file_numbers(error, &file).to_string();
        assert!(message.contains("[10, 20, 30]") && message.contains("[100, 200]"));
    }
}
