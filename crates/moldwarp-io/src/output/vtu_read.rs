//! Reads back the frames that [`super::vtu`] writes. It is not a reader of other VTU files: those
//! may be encoded, compressed or split, ours are not.

use super::FileError;
use std::path::{Path, PathBuf};

/// A frame: points, their cells and fields. Integers are given as the nearest f64.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// s.
    pub time: f64,
    /// m.
    pub points: Vec<[f64; 3]>,
    /// The nodes of all cells, one after the other.
    pub cell_nodes: Vec<i64>,
    pub fields: Vec<Field>,
    /// Texts for the whole, by name.
    pub texts: Vec<(String, Vec<String>)>,
}

/// Values at the points, `components` for each.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    pub name: String,
    pub components: usize,
    pub values: Vec<f64>,
}

impl Frame {
    /// The field of this name.
    pub fn field(&self, name: &str) -> Option<&Field> {
        self.fields.iter().find(|f| f.name == name)
    }

    /// The texts of this name.
    pub fn texts(&self, name: &str) -> Option<&[String]> {
        let found = self.texts.iter().find(|t| t.0 == name)?;
        Some(&found.1)
    }
}

/// Why a frame could not be read.
#[derive(Debug, thiserror::Error)]
pub enum VtuError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{} is no frame of moldwarp: {problem}", .path.display())]
    Format {
        path: PathBuf,
        problem: &'static str,
    },
}

/// Reads a frame.
pub fn read(path: &Path) -> Result<Frame, VtuError> {
    let bytes = std::fs::read(path).map_err(FileError::at("read", path))?;
    parse(&bytes).map_err(|problem| VtuError::Format {
        path: path.to_owned(),
        problem,
    })
}

fn parse(bytes: &[u8]) -> Result<Frame, &'static str> {
    const MARK: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
    let start = bytes
        .windows(MARK.len())
        .position(|w| w == MARK)
        .ok_or("it has no appended raw data")?;
    let header = std::str::from_utf8(&bytes[..start]).map_err(|_| "its header is not text")?;
    let data = &bytes[start + MARK.len()..];
    let mut frame = Frame::default();
    let mut inside = "";
    for line in header.lines() {
        match line {
            "<PointData>" | "<Points>" | "<Cells>" | "<FieldData>" => inside = line,
            _ => {}
        }
        if let Some(tag) = line.strip_prefix("<Array type=\"String\" ") {
            frame.texts.push(texts(tag)?);
        }
        let Some(tag) = line.strip_prefix("<DataArray ") else {
            continue;
        };
        let field = array(tag, data)?;
        match (inside, field.name.as_str()) {
            ("<FieldData>", "TimeValue") => {
                frame.time = *field.values.first().ok_or("its time is missing")?;
            }
            ("<Points>", _) => frame.points = field.values.as_chunks().0.to_vec(),
            ("<Cells>", "connectivity") => {
                frame.cell_nodes = field.values.iter().map(|&v| v as i64).collect();
            }
            ("<PointData>", _) => frame.fields.push(field),
            _ => {}
        }
    }
    Ok(frame)
}

fn texts(tag: &str) -> Result<(String, Vec<String>), &'static str> {
    const BROKEN: &str = "its texts are not readable";
    let name = attribute(tag, "Name").ok_or(BROKEN)?.to_owned();
    let (_, rest) = tag.split_once('>').ok_or(BROKEN)?;
    let codes = rest.strip_suffix("</Array>").ok_or(BROKEN)?;
    let bytes: Result<Vec<u8>, _> = codes.split_whitespace().map(str::parse).collect();
    let bytes = bytes.map_err(|_| BROKEN)?;
    let texts = bytes.split_inclusive(|&b| b == 0).map(|text| {
        let text = text.strip_suffix(&[0]).ok_or(BROKEN)?;
        String::from_utf8(text.to_vec()).map_err(|_| BROKEN)
    });
    Ok((name, texts.collect::<Result<_, _>>()?))
}

fn array(tag: &str, data: &[u8]) -> Result<Field, &'static str> {
    let offset: usize = attribute(tag, "offset")
        .and_then(|o| o.parse().ok())
        .ok_or("an array has no offset")?;
    let (length, rest) = data
        .get(offset..)
        .and_then(|d| d.split_first_chunk())
        .ok_or("it is cut off")?;
    let values = rest
        .get(..u64::from_le_bytes(*length) as usize)
        .ok_or("it is cut off")?;
    Ok(Field {
        name: attribute(tag, "Name")
            .ok_or("an array has no name")?
            .to_owned(),
        components: attribute(tag, "NumberOfComponents")
            .and_then(|n| n.parse().ok())
            .unwrap_or(1),
        values: numbers(attribute(tag, "type").unwrap_or_default(), values)?,
    })
}

fn numbers(kind: &str, bytes: &[u8]) -> Result<Vec<f64>, &'static str> {
    fn all<const N: usize>(bytes: &[u8], value: impl Fn([u8; N]) -> f64) -> Vec<f64> {
        bytes.as_chunks().0.iter().map(|&b| value(b)).collect()
    }
    Ok(match kind {
        "Float64" => all(bytes, f64::from_le_bytes),
        "UInt64" => all(bytes, |b| u64::from_le_bytes(b) as f64),
        "Int64" => all(bytes, |b| i64::from_le_bytes(b) as f64),
        "UInt32" => all(bytes, |b| u32::from_le_bytes(b).into()),
        "UInt16" => all(bytes, |b| u16::from_le_bytes(b).into()),
        "UInt8" => all(bytes, |[b]| b.into()),
        _ => return Err("an array has an unknown type"),
    })
}

fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    // The space keeps `Name` from being found in `ComponentName0`.
    let padded = tag.find(&format!(" {name}=\"")).map(|i| i + 1);
    let at = padded.or_else(|| tag.starts_with(&format!("{name}=\"")).then_some(0))?;
    tag[at + name.len() + 2..].split('"').next()
}
