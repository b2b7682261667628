//! Frames for ParaView: VTK's XML unstructured grids with appended raw binary data.
//!
//! The header names every array with its offset into one block at the file's end, where each
//! array stands as its length in bytes (UInt64) and its values, little endian. Nothing is
//! encoded or compressed: a frame is written as fast as the disk takes it. Values that are computed
//! are so as they are written, and never all in memory.

use super::{FileError, write_whole};
use moldwarp::Vec3;
use moldwarp::tensor::Voigt;
use std::io::{self, Write};
use std::path::Path;

/// VTK's number of a single point.
const VERTEX: u8 = 1;
/// VTK's number of a four-node tetrahedron.
const TETRA: u8 = 10;

/// Names of a symmetric tensor's components: our order, which is VTK's too.
const TENSOR: [&str; 6] = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];

/// Values that are computed when they are written.
#[derive(Clone, Copy)]
pub struct Each<'a, T> {
    pub count: usize,
    /// The value at a place.
    pub value: &'a dyn Fn(usize) -> T,
}

impl<T> std::fmt::Debug for Each<'_, T> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{} values", self.count)
    }
}

impl<'a, T> Each<'a, T> {
    pub fn new(count: usize, value: &'a dyn Fn(usize) -> T) -> Each<'a, T> {
        Each { count, value }
    }

    fn iter(&self) -> impl Iterator<Item = T> {
        (0..self.count).map(self.value)
    }
}

/// Values of an array, one entry a point (or cell).
#[derive(Clone, Copy, Debug)]
pub enum Data<'a> {
    F64(&'a [f64]),
    U64(&'a [u64]),
    U32(&'a [u32]),
    U16(&'a [u16]),
    U8(&'a [u8]),
    Vectors(&'a [Vec3]),
    EachF64(Each<'a, f64>),
    EachVector(Each<'a, Vec3>),
    /// Symmetric tensors xx, yy, zz, xy, yz, zx.
    EachTensor(Each<'a, Voigt>),
    /// Cells' nodes, written as Int64.
    Tets(&'a [[u32; 4]]),
    /// first, first + step, … as Int64: what an offset array or a list of vertices is.
    Steps {
        first: i64,
        step: i64,
        count: usize,
    },
    /// The same byte over and over: the cells' type.
    Same {
        value: u8,
        count: usize,
    },
}

/// A named array.
#[derive(Clone, Copy, Debug)]
pub struct Array<'a> {
    pub name: &'a str,
    pub data: Data<'a>,
    /// Unit, and sign convention where one is needed; kept as VTK's units label. May be empty.
    pub description: &'a str,
}

impl<'a> Array<'a> {
    pub fn new(name: &'a str, data: Data<'a>, description: &'a str) -> Array<'a> {
        Array {
            name,
            data,
            description,
        }
    }
}

/// Names that belong to a whole file, in its field data.
#[derive(Clone, Copy, Debug)]
pub struct Texts<'a> {
    pub name: &'a str,
    pub values: &'a [String],
}

impl Texts<'_> {
    /// As VTK has texts: the codes of their bytes, each text ended by 0.
    fn tag(&self) -> String {
        let bytes = self.values.iter().flat_map(|v| v.bytes().chain([0]));
        format!(
            "<Array type=\"String\" Name=\"{}\" NumberOfTuples=\"{}\" format=\"ascii\">{}</Array>\n",
            escape(self.name),
            self.values.len(),
            bytes
                .map(|b| format!("{b} "))
                .collect::<String>()
                .trim_end()
        )
    }
}

impl Data<'_> {
    fn type_name(&self) -> &'static str {
        match self {
            Data::F64(_)
            | Data::Vectors(_)
            | Data::EachF64(_)
            | Data::EachVector(_)
            | Data::EachTensor(_) => "Float64",
            Data::U64(_) => "UInt64",
            Data::U32(_) => "UInt32",
            Data::U16(_) => "UInt16",
            Data::U8(_) | Data::Same { .. } => "UInt8",
            Data::Tets(_) | Data::Steps { .. } => "Int64",
        }
    }

    fn components(&self) -> usize {
        match self {
            Data::Vectors(_) | Data::EachVector(_) => 3,
            Data::EachTensor(_) => 6,
            _ => 1,
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Data::F64(v) => 8 * v.len(),
            Data::U64(v) => 8 * v.len(),
            Data::U32(v) => 4 * v.len(),
            Data::U16(v) => 2 * v.len(),
            Data::U8(v) => v.len(),
            Data::Vectors(v) => 24 * v.len(),
            Data::EachF64(v) => 8 * v.count,
            Data::EachVector(v) => 24 * v.count,
            Data::EachTensor(v) => 48 * v.count,
            Data::Tets(v) => 32 * v.len(),
            Data::Steps { count, .. } => 8 * count,
            Data::Same { count, .. } => *count,
        }
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let vector = |piece: &mut Vec<u8>, x: Vec3| floats(piece, &x.to_array());
        match *self {
            Data::F64(v) => put(out, v.iter(), |piece, x| floats(piece, &[*x])),
            Data::U64(v) => put(out, v.iter(), |piece, x| piece.extend(x.to_le_bytes())),
            Data::U32(v) => put(out, v.iter(), |piece, x| piece.extend(x.to_le_bytes())),
            Data::U16(v) => put(out, v.iter(), |piece, x| piece.extend(x.to_le_bytes())),
            Data::U8(v) => out.write_all(v),
            Data::Vectors(v) => put(out, v.iter().copied(), vector),
            Data::EachF64(v) => put(out, v.iter(), |piece, x| floats(piece, &[x])),
            Data::EachVector(v) => put(out, v.iter(), vector),
            Data::EachTensor(v) => put(out, v.iter(), |piece, x| floats(piece, &x)),
            Data::Tets(v) => put(out, v.iter(), |piece, tet| {
                let nodes = tet.map(|n| i64::from(n).to_le_bytes());
                piece.extend_from_slice(nodes.as_flattened());
            }),
            Data::Steps { first, step, count } => put(out, 0..count as i64, |piece, i| {
                piece.extend((first + i * step).to_le_bytes());
            }),
            Data::Same { value, count } => put(out, 0..count, |piece, _| piece.push(value)),
        }
    }
}

/// Bytes that are put together before they are written.
const PIECE: usize = 1 << 16;

/// Writes values piece by piece; `add` appends one.
fn put<T>(
    out: &mut impl Write,
    values: impl Iterator<Item = T>,
    add: impl Fn(&mut Vec<u8>, T),
) -> io::Result<()> {
    let mut piece = Vec::with_capacity(PIECE + 64);
    for value in values {
        add(&mut piece, value);
        if piece.len() >= PIECE {
            out.write_all(&piece)?;
            piece.clear();
        }
    }
    out.write_all(&piece)
}

fn floats<const N: usize>(piece: &mut Vec<u8>, numbers: &[f64; N]) {
    piece.extend_from_slice(numbers.map(f64::to_le_bytes).as_flattened());
}

/// Writes points, each a cell of its own, with fields, and texts for the whole.
///
/// `positions` in m, `time` in s; every field has as many entries as there are points.
pub fn write_points(
    path: &Path,
    time: f64,
    positions: Each<Vec3>,
    fields: &[Array],
    texts: &[Texts],
) -> Result<(), FileError> {
    let count = positions.count;
    let steps = |first| Data::Steps {
        first,
        step: 1,
        count,
    };
    let cells = [
        Array::new("connectivity", steps(0), ""),
        Array::new("offsets", steps(1), ""),
        Array::new(
            "types",
            Data::Same {
                value: VERTEX,
                count,
            },
            "",
        ),
    ];
    let positions = Data::EachVector(positions);
    write(path, (time, texts), positions, fields, &cells)
}

/// Writes a tetrahedral mesh with fields on its nodes.
///
/// `nodes` in m, `time` in s; every field has as many entries as there are nodes.
pub fn write_mesh(
    path: &Path,
    time: f64,
    nodes: &[Vec3],
    tets: &[[u32; 4]],
    fields: &[Array],
) -> Result<(), FileError> {
    let count = tets.len();
    let offsets = Data::Steps {
        first: 4,
        step: 4,
        count,
    };
    let cells = [
        Array::new("connectivity", Data::Tets(tets), ""),
        Array::new("offsets", offsets, ""),
        Array::new(
            "types",
            Data::Same {
                value: TETRA,
                count,
            },
            "",
        ),
    ];
    write(path, (time, &[]), Data::Vectors(nodes), fields, &cells)
}

fn write(
    path: &Path,
    (time, texts): (f64, &[Texts]),
    points: Data,
    fields: &[Array],
    cells: &[Array; 3],
) -> Result<(), FileError> {
    let time = [time];
    let time = Array::new("TimeValue", Data::F64(&time), "s");
    let points = Array::new("Points", points, "m");
    let arrays: Vec<&Array> = [&time, &points]
        .into_iter()
        .chain(cells)
        .chain(fields)
        .collect();
    let mut header = Header::default();
    let time = header.array(&time, " NumberOfTuples=\"1\"");
    let texts: String = texts.iter().map(Texts::tag).collect();
    let nodes = header.array(&points, "");
    let cell_tags: String = cells.iter().map(|a| header.array(a, "")).collect();
    let field_tags: String = fields.iter().map(|a| header.array(a, "")).collect();
    let (point_count, cell_count) = (points.data.bytes() / 24, cells[2].data.bytes());
    write_whole(path, |out| {
        write!(
            out,
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             <UnstructuredGrid>\n<FieldData>\n{time}{texts}</FieldData>\n\
             <Piece NumberOfPoints=\"{point_count}\" NumberOfCells=\"{cell_count}\">\n\
             <PointData>\n{field_tags}</PointData>\n<Points>\n{nodes}</Points>\n\
             <Cells>\n{cell_tags}</Cells>\n</Piece>\n</UnstructuredGrid>\n\
             <AppendedData encoding=\"raw\">\n_"
        )?;
        for array in &arrays {
            out.write_all(&(array.data.bytes() as u64).to_le_bytes())?;
            array.data.write(out)?;
        }
        write!(out, "\n</AppendedData>\n</VTKFile>\n")
    })
}

/// Gives each array its offset, in the order in which they are asked for.
#[derive(Default)]
struct Header {
    offset: usize,
}

impl Header {
    fn array(&mut self, array: &Array, more: &str) -> String {
        let Array {
            name,
            data,
            description,
        } = array;
        let components: String = match data.components() {
            1 => String::new(),
            6 => TENSOR
                .iter()
                .enumerate()
                .map(|(i, c)| format!(" ComponentName{i}=\"{c}\""))
                .fold(" NumberOfComponents=\"6\"".into(), |all, c| all + &c),
            n => format!(" NumberOfComponents=\"{n}\""),
        };
        let label = if description.is_empty() {
            "/>\n".to_owned()
        } else {
            format!(
                "><InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{}</InformationKey></DataArray>\n",
                escape(description)
            )
        };
        let tag = format!(
            "<DataArray type=\"{}\" Name=\"{}\"{components}{more} format=\"appended\" offset=\"{}\"{label}",
            data.type_name(),
            escape(name),
            self.offset
        );
        self.offset += 8 + data.bytes();
        tag
    }
}

/// Text as XML has it.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::vtu_read::read;

    #[test]
    fn particles_are_read_back() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("p.vtu");
        let x = [Vec3::new(0.1, -2.0, 1e-300), Vec3::ONE];
        let stress = [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [-0.5; 6]];
        let (position, tensor) = (|i: usize| x[i], |i: usize| stress[i]);
        let fields = [
            Array::new("id", Data::U32(&[7, 9]), ""),
            Array::new("seed", Data::U64(&[1 << 40, 2]), ""),
            Array::new("body", Data::U16(&[0, 300]), ""),
            Array::new("filled", Data::U8(&[1, 0]), ""),
            Array::new(
                "mean_pressure",
                Data::F64(&[5.0, -0.25]),
                "Pa, < 0 & \"pulled\"",
            ),
            Array::new("stress", Data::EachTensor(Each::new(2, &tensor)), "Pa"),
            Array::new("mass", Data::EachF64(Each::new(2, &|i| i as f64)), "kg"),
        ];
        let names = [
            "stage 1".to_owned(),
            "Böschung <1>".to_owned(),
            String::new(),
        ];
        let texts = Texts {
            name: "names",
            values: &names,
        };
        write_points(&path, 0.125, Each::new(2, &position), &fields, &[texts]).unwrap();

        let frame = read(&path).unwrap();
        assert_eq!(frame.time, 0.125);
        assert_eq!(frame.texts("names").unwrap(), names);
        assert!(frame.texts("stages").is_none());
        assert_eq!(frame.points, x.map(|x| x.to_array()));
        assert_eq!(frame.cell_nodes, [0, 1]);
        assert_eq!(frame.field("id").unwrap().values, [7.0, 9.0]);
        assert_eq!(frame.field("seed").unwrap().values, [2f64.powi(40), 2.0]);
        assert_eq!(frame.field("body").unwrap().values, [0.0, 300.0]);
        assert_eq!(frame.field("filled").unwrap().values, [1.0, 0.0]);
        assert_eq!(frame.field("mean_pressure").unwrap().values, [5.0, -0.25]);
        let read_stress = frame.field("stress").unwrap();
        assert_eq!(read_stress.components, 6);
        assert_eq!(read_stress.values, stress.as_flattened());
        assert_eq!(frame.field("mass").unwrap().values, [0.0, 1.0]);
        assert!(frame.field("strain").is_none());
    }

    #[test]
    fn a_mesh_is_read_back() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.vtu");
        let mesh = moldwarp::mesh::box_mesh(Vec3::ONE, [1, 2, 1]).unwrap();
        let mass: Vec<f64> = mesh.nodes.iter().map(|x| x.y).collect();
        let fields = [
            Array::new("mass", Data::F64(&mass), "kg"),
            Array::new("velocity", Data::Vectors(&mesh.nodes), "m/s"),
        ];
        write_mesh(&path, 3.0, &mesh.nodes, &mesh.tets, &fields).unwrap();

        let frame = read(&path).unwrap();
        assert_eq!(frame.points.len(), mesh.nodes.len());
        let nodes: Vec<i64> = mesh.tets.iter().flatten().map(|&n| i64::from(n)).collect();
        assert_eq!(frame.cell_nodes, nodes);
        assert_eq!(frame.field("mass").unwrap().values, mass);
        assert_eq!(frame.field("velocity").unwrap().components, 3);
    }

    #[test]
    fn no_points_at_all_is_still_a_frame() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("none.vtu");
        write_points(
            &path,
            0.0,
            Each::new(0, &|_| Vec3::ZERO),
            &[Array::new("v", Data::Vectors(&[]), "m/s")],
            &[],
        )
        .unwrap();
        let frame = read(&path).unwrap();
        assert!(frame.points.is_empty());
        assert_eq!(frame.field("v").unwrap().components, 3);
    }
}
