//! The mesh's surface as a page's script reads it.

use super::ReportError;
use super::packing::{Coding, planes, text};
use super::pictures::{Blobs, bounds, grid};
use super::source::Source;
use super::surface::Surface;
use crate::output::vtu_read::{Frame, read};
use serde_json::{Value, json};
use std::path::Path;

/// More are not drawn.
const MOST_TRIANGLES: usize = 300_000;

/// The surface at the first frame, and how it has moved since.
#[derive(Debug, Default)]
pub struct MeshPictures {
    /// For the page's script; null without a mesh.
    pub about: Value,
    surface: Surface,
    /// Of all nodes, m.
    start: Vec<[f64; 3]>,
    coding: Option<Coding>,
}

impl MeshPictures {
    pub fn of(source: &Source, blobs: &mut Blobs) -> Result<MeshPictures, ReportError> {
        let (Some((_, first)), Some((_, last))) = (source.mesh.first(), source.mesh.last()) else {
            return Ok(MeshPictures::default());
        };
        let frame = read(first)?;
        let surface = Surface::of(&frame.cell_nodes);
        let inside = |n: &u32| (*n as usize) < frame.points.len();
        if !surface.nodes.iter().all(inside) {
            return Err(broken(first));
        }
        let edge = median_edge(&frame);
        if surface.triangles.len() > MOST_TRIANGLES {
            return Ok(MeshPictures {
                about: json!({ "left_out": surface.triangles.len(), "edge": edge }),
                ..MeshPictures::default()
            });
        }
        let points: Vec<[f64; 3]> = surface
            .nodes
            .iter()
            .map(|&n| frame.points[n as usize])
            .collect();
        let (low, size) = bounds(points.iter());
        // A mesh follows what moves, and so is farthest away at the end; if it has come back, it has
        // moved less far than it is large.
        let mut mesh = MeshPictures {
            surface,
            start: frame.points,
            ..MeshPictures::default()
        };
        let way = mesh.moved(&read(last)?, last)?;
        let farthest = way.iter().flatten().fold(0.0, |a: f64, &b| a.max(b.abs()));
        let largest = size.iter().fold(0.0, |a: f64, &b| a.max(b));
        let coding = Coding::new(
            if farthest > 1e-9 * largest {
                2.0 * farthest
            } else {
                largest
            },
            10,
        );
        let triangles = mesh.surface.triangles.as_flattened().iter();
        let triangles: Vec<u8> = triangles.flat_map(|n| n.to_le_bytes()).collect();
        mesh.coding = Some(coding);
        mesh.about = json!({
            "low": low,
            "size": size,
            "count": points.len(),
            "nodes": blobs.add(planes(&grid(&points, low, size))),
            "triangles": blobs.add(text(&triangles)),
            "one": coding.unit,
            "edge": edge,
        });
        Ok(mesh)
    }

    /// Packs how far the surface has moved until a frame, and returns the blob's number; none if it has
    /// not moved.
    pub fn pack(
        &mut self,
        source: &Source,
        number: usize,
        blobs: &mut Blobs,
    ) -> Result<Option<usize>, ReportError> {
        let (Some(coding), Some((_, path))) = (self.coding, source.mesh.get(number)) else {
            return Ok(None);
        };
        let way = self.moved(&read(path)?, path)?;
        let codes: Vec<u16> = (0..3)
            .flat_map(|d| way.iter().map(move |w| coding.code(w[d])))
            .collect();
        let moved = codes.iter().any(|code| code & 0x7fff != 0);
        Ok(moved.then(|| blobs.add(planes(&codes))))
    }

    /// Bytes of the surface in a frame, from the last one.
    pub fn cost_of_a_frame(&mut self, source: &Source) -> Result<f64, ReportError> {
        let mut blobs = Blobs::default();
        self.pack(source, source.mesh.len().saturating_sub(1), &mut blobs)?;
        Ok(blobs.bytes() as f64)
    }

    /// Of the surface's nodes since the first frame, m.
    fn moved(&self, frame: &Frame, path: &Path) -> Result<Vec<[f64; 3]>, ReportError> {
        if frame.points.len() != self.start.len() {
            return Err(broken(path));
        }
        let way = |&n: &u32| {
            let (now, start) = (frame.points[n as usize], self.start[n as usize]);
            std::array::from_fn(|d| now[d] - start[d])
        };
        Ok(self.surface.nodes.iter().map(way).collect())
    }
}

fn broken(path: &Path) -> ReportError {
    ReportError::Broken {
        path: path.to_owned(),
        problem: "its elements do not fit its nodes".to_owned(),
    }
}

/// The least, the median and the greatest length of the elements' edges, m.
fn median_edge(frame: &Frame) -> [f64; 3] {
    let length = |a: i64, b: i64| {
        let point = |n: i64| frame.points.get(n as usize).copied().unwrap_or_default();
        let (a, b) = (point(a), point(b));
        (0..3).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>().sqrt()
    };
    let tets = frame.cell_nodes.as_chunks::<4>().0.iter();
    let edges = tets.flat_map(|&[a, b, c, d]| [(a, b), (a, c), (a, d), (b, c), (b, d), (c, d)]);
    let mut all: Vec<f64> = edges.map(|(a, b)| length(a, b)).collect();
    if all.is_empty() {
        return [0.0; 3];
    }
    all.sort_by(f64::total_cmp);
    [all[0], all[all.len() / 2], all[all.len() - 1]]
}
