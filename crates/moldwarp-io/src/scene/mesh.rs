//! The scene's mesh: from a file or a generator.

use super::amount::Spanned;
use super::cylinder::cylinder;
use super::error::Fault;
use super::given::Given;
use super::quantity::{self, Dimension};
use super::raw::{RawBox, RawMesh, RawRevolve, Text};
use super::values::{exactly_one, positive, span, three, vector};
use crate::mesh::{
    MeshFile, MeshFileError, check_overlap, explain_mesh_error, read_gmsh, read_plane_gmsh,
};
use moldwarp::Mesh;
use moldwarp::mesh::box_mesh;
use std::path::Path;

/// More cells than this are a slip, not a mesh: 24 million elements.
pub(super) const MOST_CELLS: u64 = 4_000_000;

/// The mesh in metres, and the tags of its elements if a file gave them some. What its reader has
/// to say goes to `notes`.
pub(super) fn mesh(
    raw: &Spanned<RawMesh>,
    (folder, given): (&Path, &Given),
    notes: &mut Vec<String>,
) -> Result<(Mesh, Vec<u64>), Fault> {
    let place = raw.span();
    let raw = raw.get_ref();
    exactly_one(
        (place, "the mesh"),
        &[
            ("file", span(&raw.file)),
            ("box", span(&raw.cuboid)),
            ("cylinder", span(&raw.cylinder)),
        ],
    )?;
    if let (None, Some(revolve)) = (&raw.file, &raw.revolve) {
        return Err(Fault::new("`revolve` is for mesh files")
            .at(revolve.span(), "there is no `file`")
            .help("name the plane mesh of the meridian: file = \"meridian.msh\""));
    }
    match (&raw.file, &raw.unit) {
        (Some(file), unit) => {
            let scale = unit.as_ref().map_or(Ok(1.0), length_unit)?;
            return match &raw.revolve {
                Some(revolve) => revolved(file, scale, revolve, folder, notes),
                None => from_file(file, scale, (folder, given), notes),
            };
        }
        (None, Some(unit)) => {
            return Err(Fault::new("`unit` is for mesh files")
                .at(unit.span(), "a generated mesh does not need it")
                .help(
                    "write the unit in each length, as in size = [\"1 m\", \"1 m\", \"20 cm\"]",
                ));
        }
        (None, None) => {}
    }
    let mesh = match (&raw.cuboid, &raw.cylinder) {
        (Some(cuboid), _) => generated(cuboid)?,
        (None, Some(sector)) => cylinder(sector)?,
        (None, None) => return Err(Fault::new("the scene has no mesh")),
    };
    Ok((mesh, Vec::new()))
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
    let fault = || {
        Fault::new("the box's cells are too small or too large to compute their volumes")
            .at(raw.size.span(), "are the units right?")
            .at(raw.cells.span(), "over so many cells")
            .help("write the unit in each length, as in size = [\"1 m\", \"1 m\", \"20 cm\"]")
    };
    let mesh = box_mesh(size, cells).map_err(|error| fault().caused_by(error))?;
    match has_volumes(&mesh) {
        true => Ok(mesh),
        false => Err(fault()),
    }
}

/// Whether the volumes of a generated mesh are numbers; files are checked by their reader.
pub(super) fn has_volumes(mesh: &Mesh) -> bool {
    mesh.total_volume().is_finite()
}

fn from_file(
    file: &Text,
    scale: f64,
    (folder, given): (&Path, &Given),
    notes: &mut Vec<String>,
) -> Result<(Mesh, Vec<u64>), Fault> {
    let path = folder.join(file.get_ref());
    let mut read = match given.meshes.get(file.get_ref()) {
        Some(raw) => MeshFile {
            raw: raw.clone(),
            // Arrays are counted from 0.
            node_tags: (0..raw.nodes.len() as u64).collect(),
            element_tags: (0..raw.tets.len() as u64).collect(),
            notes: Vec::new(),
        },
        None => read_gmsh(&path).map_err(|e| unreadable(e, file, &path))?,
    };
    for x in &mut read.raw.nodes {
        *x *= scale;
    }
    notes.append(&mut read.notes);
    let mesh = Mesh::new(read.raw).map_err(|e| {
        let message = explain_mesh_error(&e, &read.node_tags, &read.element_tags);
        damaged(&format!("{}: {message}", path.display()), file.span()).caused_by(e)
    })?;
    check_overlap(&mesh, &read.element_tags).map_err(|overlap| {
        damaged(&format!("{}: {overlap}", path.display()), file.span()).caused_by(overlap)
    })?;
    Ok((mesh, read.element_tags))
}

/// Groups that a revolved mesh has of itself.
const SIDES: [&str; 2] = ["theta-min", "theta-max"];

/// A sector from the plane mesh of its meridian. Elements have no tags of their own.
fn revolved(
    file: &Text,
    scale: f64,
    revolve: &Spanned<RawRevolve>,
    folder: &Path,
    notes: &mut Vec<String>,
) -> Result<(Mesh, Vec<u64>), Fault> {
    let raw = revolve.get_ref();
    let cells = match &raw.cells {
        Some(cells) => super::values::count("cells", cells, 1)?,
        None => 1,
    };
    let angle = positive("angle", &raw.angle, Dimension::Angle)?;
    if angle > std::f64::consts::PI || angle / cells as f64 >= std::f64::consts::FRAC_PI_2 {
        return Err(Fault::new(
            "a mesh is revolved by at most 180°, and less than 90° for each cell",
        )
        .at(raw.angle.span(), "too much")
        .help("20 deg in one cell is usual; more `cells` allow for more"));
    }
    let path = folder.join(file.get_ref());
    let mut read = read_plane_gmsh(&path).map_err(|e| unreadable(e, file, &path))?;
    notes.append(&mut read.notes);
    read.plane
        .nodes
        .iter_mut()
        .flatten()
        .for_each(|x| *x *= scale);
    let taken = read.plane.lines.iter().find(|l| SIDES.contains(&&l.0[..]));
    if let Some((name, _)) = taken {
        return Err(Fault::new(format!("a physical curve of the mesh is called `{name}`"))
            .at(file.span(), "this mesh")
            .help("a revolved mesh has the surfaces `theta-min` and `theta-max` of itself: rename the curve"));
    }
    let elements = (read.plane.triangles.len() as u64).saturating_mul(cells);
    if elements > MOST_CELLS {
        return Err(Fault::new("the revolved mesh has too many cells")
            .at(revolve.span(), format!("more than {MOST_CELLS}"))
            .help("take fewer around, or a coarser meridian"));
    }
    let revolved = read.plane.revolve(angle, cells as usize);
    let origin = |&n: &u32| read.node_tags[n as usize];
    let node_tags: Vec<u64> = revolved.node_origins.iter().map(origin).collect();
    let element_tags: Vec<u64> = (1..=revolved.raw.tets.len() as u64).collect();
    let mesh = Mesh::new(revolved.raw).map_err(|e| {
        let message = explain_mesh_error(&e, &node_tags, &element_tags);
        damaged(&format!("{}: {message}", path.display()), file.span()).caused_by(e)
    })?;
    Ok((mesh, Vec::new()))
}

fn length_unit(unit: &Text) -> Result<f64, Fault> {
    quantity::parse(&format!("1 {}", unit.get_ref()), Dimension::Length).map_err(|error| {
        Fault::new(format!("`{}` is not a unit of length", unit.get_ref()))
            .at(unit.span(), "should be m, cm or mm")
            .help("unit = \"mm\" if the mesh was drawn in millimetres")
            .caused_by(error)
    })
}

/// The mesh file cannot be read: where it is named, and what its reader advises.
fn unreadable(error: MeshFileError, file: &Text, path: &Path) -> Fault {
    let fault = match &error {
        MeshFileError::Missing { advice, .. } => {
            let help = match path.with_extension("geo").is_file() {
                true => advice.clone(),
                false => format!("paths are relative to the scene's folder; {advice}"),
            };
            Fault::new(format!("there is no mesh file `{}`", file.get_ref()))
                .at(file.span(), "no such file")
                .help(help)
        }
        other => damaged(&other.to_string(), file.span()),
    };
    let fault = match (&fault.help, &error) {
        (None, MeshFileError::At { .. } | MeshFileError::Whole { .. }) => fault.help(
            "Gmsh writes no such file: it is cut short, or was changed; copy it again, or mesh the \
             geometry again",
        ),
        _ => fault,
    };
    fault.caused_by(error)
}

/// Messages on meshes say what is wrong and, after a semicolon, what to do.
fn damaged(message: &str, place: std::ops::Range<usize>) -> Fault {
    match message.split_once("; ") {
        Some((problem, remedy)) => Fault::new(problem).at(place, "this mesh").help(remedy),
        None => Fault::new(message).at(place, "this mesh"),
    }
}
