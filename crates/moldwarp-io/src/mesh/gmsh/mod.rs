//! Gmsh's MSH format.
//!
//! A file is a row of sections, `$Name` … `$EndName`. The bytes are read by [`cursor`], which
//! knows ASCII from binary, the sections by [`v22`] and [`v41`], which know the two layouts, and
//! what they find is put together by [`assembly`], to the plane mesh of a meridian by [`meridian`].

mod assembly;
mod cursor;
mod element_type;
mod fields;
mod meridian;
mod v22;
mod v41;

use super::{GmshProblem, MeshFile, MeshFileError, PlaneFile};
use assembly::Assembly;
use cursor::Cursor;
use std::path::Path;

type Result<T> = std::result::Result<T, MeshFileError>;

#[derive(Clone, Copy, PartialEq)]
enum Version {
    V22,
    V41,
}

/// Reads the bytes of the file `path`.
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<MeshFile> {
    read(path, bytes)?
        .finish(mesh_command(path))
        .map_err(|problem| whole(path, problem))
}

/// Reads the bytes of the file `path`, a plane mesh.
pub(super) fn parse_plane(path: &Path, bytes: &[u8]) -> Result<PlaneFile> {
    read(path, bytes)?
        .finish_plane(plane_command(path))
        .map_err(|problem| whole(path, problem))
}

fn read(path: &Path, bytes: &[u8]) -> Result<Assembly> {
    let mut cursor = Cursor::new(path, bytes);
    let version = header(&mut cursor)?;
    let mut assembly = Assembly::default();
    assembly.no_entities = version == Version::V41;
    let mut groups = v41::EntityGroups::default();
    let (mut has_nodes, mut has_elements) = (false, false);
    while let Some(section) = cursor.section()? {
        match (section, version) {
            ("PhysicalNames", _) => physical_names(&mut cursor, &mut assembly)?,
            ("Entities", Version::V41) if has_elements => {
                return Err(cursor.wrong(GmshProblem::EntitiesLast));
            }
            ("Entities", Version::V41) => {
                assembly.no_entities = false;
                groups = v41::entities(&mut cursor)?;
            }
            ("PartitionedEntities", Version::V41) => {
                let command = mesh_command(path);
                return Err(cursor.wrong(GmshProblem::Partitioned { command }));
            }
            ("Nodes", _) => {
                has_nodes = true;
                match version {
                    Version::V22 => v22::nodes(&mut cursor, &mut assembly)?,
                    Version::V41 => v41::nodes(&mut cursor, &mut assembly)?,
                }
            }
            ("ParametricNodes", Version::V22) => {
                let command = convert_command(path);
                return Err(cursor.wrong(GmshProblem::ParametricNodes { command }));
            }
            ("Elements", _) if !has_nodes => {
                return Err(cursor.wrong(GmshProblem::ElementsFirst));
            }
            ("Elements", _) => {
                has_elements = true;
                match version {
                    Version::V22 => v22::elements(&mut cursor, &mut assembly)?,
                    Version::V41 => v41::elements(&mut cursor, &mut assembly, &groups)?,
                }
            }
            _ => {
                cursor.skip_section(section)?;
                continue;
            }
        }
        cursor.end_section(section)?;
    }
    let missing = [(has_nodes, "Nodes"), (has_elements, "Elements")];
    if let Some(&(_, name)) = missing.iter().find(|(found, _)| !found) {
        let command = mesh_command(path);
        return Err(whole(path, GmshProblem::NoSection { name, command }));
    }
    Ok(assembly)
}

fn whole(path: &Path, problem: GmshProblem) -> MeshFileError {
    MeshFileError::Whole {
        file: path.to_owned(),
        problem,
    }
}

/// `$MeshFormat`: version, 0 for ASCII or 1 for binary, bytes of a number; in a binary file then
/// the integer 1, which shows the order of the bytes.
fn header(cursor: &mut Cursor) -> Result<Version> {
    while cursor.begins_with(b"$Comments") {
        cursor.section()?;
        cursor.skip_section("Comments")?;
    }
    if cursor.begins_with(b"$NOD") || cursor.begins_with(b"$PARA") {
        return Err(unreadable_version(cursor, "1.0"));
    }
    if !cursor.begins_with(b"$MeshFormat") {
        let file = cursor.file;
        let extension = file.extension().unwrap_or_default();
        let advice = match extension.to_string_lossy().to_lowercase().as_str() {
            "geo" => format!("; mesh it with `{}`", mesh_command(file)),
            "msh" | "toml" => {
                "; mesh the geometry again, or name the mesh that Gmsh wrote".to_owned()
            }
            _ => format!(
                "; of the formats that Gmsh reads it makes this one: `{}`",
                convert_command(file)
            ),
        };
        let found = cursor.peek();
        return Err(cursor.wrong(GmshProblem::NotGmsh { found, advice }));
    }
    cursor.section()?;
    let version = match cursor.text("the version of the format")? {
        "2.2" => Version::V22,
        "4.1" => Version::V41,
        other => return Err(unreadable_version(cursor, other)),
    };
    let binary = cursor.text("0 for ASCII or 1 for binary")?;
    let size = cursor.text("8, the size of a number")?;
    if size != "8" {
        return Err(cursor.unexpected("8, the size of a number", size));
    }
    cursor.end_text_line()?;
    match binary {
        "0" => {}
        "1" => cursor.set_binary()?,
        other => return Err(cursor.unexpected("0 for ASCII or 1 for binary", other)),
    }
    cursor.end_section("MeshFormat")?;
    Ok(version)
}

fn unreadable_version(cursor: &Cursor, version: &str) -> MeshFileError {
    cursor.wrong(GmshProblem::Version {
        version: cursor::excerpt(version.as_bytes()),
        command: convert_command(cursor.file),
    })
}

/// `$PhysicalNames`, text even in a binary file: their number, then `dimension tag "name"` each.
fn physical_names(cursor: &mut Cursor, assembly: &mut Assembly) -> Result<()> {
    let count = cursor.text_count("physical names", 6)?;
    for _ in 0..count {
        cursor.begin_text_line();
        let dimension = cursor.text_integer("the dimension of a physical group")?;
        if !(0..=3).contains(&dimension) {
            return Err(cursor.unexpected("a dimension from 0 to 3", &dimension.to_string()));
        }
        let tag = cursor.text_integer("the tag of a physical group")?;
        let name = cursor.quoted("the name of a physical group in double quotes, as UTF-8")?;
        assembly.name_group(cursor, (dimension, tag.unsigned_abs()), name)?;
    }
    Ok(())
}

/// The command that makes the mesh `path` from the geometry of the same name.
pub(super) fn mesh_command(path: &Path) -> String {
    command(path, "-3")
}

/// The same for a plane mesh.
pub(super) fn plane_command(path: &Path) -> String {
    command(path, "-2")
}

/// The same for a mesh that came out of higher order.
fn first_order_command(path: &Path) -> String {
    command(path, "-3 -order 1")
}

fn command(path: &Path, options: &str) -> String {
    let [geometry, mesh] = ["geo", "msh"].map(|extension| quoted(&path.with_extension(extension)));
    format!("gmsh {options} {geometry} -o {mesh}")
}

/// The command that writes the mesh `path` anew in a format that can be read.
fn convert_command(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let target = path.with_file_name(format!("{stem}-41.msh"));
    let [from, to] = [path, &target].map(quoted);
    format!("gmsh {from} -save -format msh41 -o {to}")
}

/// A path as a shell takes it.
fn quoted(path: &Path) -> String {
    let path = path.to_string_lossy();
    let plain = |c: char| c.is_alphanumeric() || "/._-+,:@%\\".contains(c);
    if path.chars().all(plain) {
        path.into_owned()
    } else {
        format!("'{}'", path.replace('\'', r"'\''"))
    }
}
