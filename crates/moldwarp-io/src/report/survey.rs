//! What there is: extremes of all fields in all frames, of all particles, whether they are drawn or not.

use super::ReportError;
use super::fields::{Part, shown};
use super::source::Source;
use crate::output::vtu_read::{Field, Frame, read};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Of so many particles at most the percentiles of a frame are found.
const SAMPLE: usize = 5000;

/// The frames in figures.
#[derive(Debug, Default)]
pub struct Survey {
    pub frames: Vec<FrameFigures>,
    /// All particles that are in any of the frames, by number.
    pub ids: BTreeSet<u32>,
    /// Fields that are shown with their numbers of components, as the first frame with particles has
    /// them.
    pub fields: Vec<(String, usize)>,
    /// Corners of the box of all positions of particles, m.
    pub low: [f64; 3],
    pub high: [f64; 3],
}

/// A frame in figures.
#[derive(Debug, Default)]
pub struct FrameFigures {
    /// s.
    pub time: f64,
    pub particles: usize,
    /// How many of each body.
    pub of_bodies: BTreeMap<usize, usize>,
    /// By field, a range for each of its parts.
    pub ranges: BTreeMap<String, Vec<Range>>,
    /// How many particles yield, and how many have ever yielded; none if no material can.
    pub yielding: Option<[usize; 2]>,
    /// Corners of the box of the particles with a plastic strain of 1 % or more.
    pub sheared: Option<[[f64; 3]; 2]>,
}

/// Where a number lies.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Range {
    pub least: f64,
    pub greatest: f64,
    /// Bounds of all but the outermost hundredth on each side, from a sample.
    pub inner: [f64; 2],
    /// Particles that have the least and the greatest value.
    pub at: [u32; 2],
    /// Where the greatest one is, m.
    pub place: [f64; 3],
    /// Its body.
    pub body: usize,
}

/// The plastic strain from which a particle counts as sheared.
pub const SHEARED: f64 = 0.01;

impl Survey {
    /// Reads all frames of the particles.
    pub fn of(source: &Source) -> Result<Survey, ReportError> {
        let mut survey = Survey {
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
            ..Survey::default()
        };
        for (time, path) in &source.particles {
            let frame = read(path)?;
            check(&frame, path)?;
            survey.add(*time, &frame);
        }
        Ok(survey)
    }

    fn add(&mut self, time: f64, frame: &Frame) {
        let ids = ids(frame);
        for point in &frame.points {
            for d in 0..3 {
                self.low[d] = self.low[d].min(point[d]);
                self.high[d] = self.high[d].max(point[d]);
            }
        }
        let fields = shown(frame);
        if self.fields.is_empty() && !ids.is_empty() {
            self.fields = fields
                .iter()
                .map(|f| (f.name.clone(), f.components))
                .collect();
        }
        let ranges = fields
            .into_iter()
            .map(|f| (f.name.clone(), ranges(f, &ids, frame)));
        self.frames.push(FrameFigures {
            time,
            particles: ids.len(),
            of_bodies: of_bodies(frame),
            ranges: ranges.filter(|r| !r.1.is_empty()).collect(),
            yielding: yielding(frame),
            sheared: sheared(frame),
        });
        self.ids.extend(ids);
    }

    /// The frame with the greatest value of a part of a field, with its range.
    pub fn greatest(&self, field: &str, part: usize) -> Option<(usize, Range)> {
        let ranges = self.frames.iter().enumerate();
        let ranges = ranges.filter_map(|(i, f)| Some((i, *f.ranges.get(field)?.get(part)?)));
        ranges.reduce(|best, next| match next.1.greatest > best.1.greatest {
            true => next,
            false => best,
        })
    }

    /// The greatest absolute value of any component of a field.
    pub fn scale(&self, field: &str) -> f64 {
        let ranges = self.frames.iter().filter_map(|f| f.ranges.get(field));
        let sizes = ranges
            .flatten()
            .map(|r| r.greatest.abs().max(r.least.abs()));
        sizes.fold(0.0, f64::max)
    }
}

/// The particles' numbers.
pub fn ids(frame: &Frame) -> Vec<u32> {
    let field = frame.field("id");
    field.map_or_else(Vec::new, |f| f.values.iter().map(|&v| v as u32).collect())
}

/// Whether a frame has what every frame of particles has, in the right number.
fn check(frame: &Frame, path: &std::path::Path) -> Result<(), ReportError> {
    let count = frame.points.len();
    let fits = |f: &Field| f.values.len() == count * f.components;
    let has = |name: &str| frame.field(name).is_some();
    let sound = frame.fields.iter().all(fits) && has("id") && has("displacement");
    match sound {
        true => Ok(()),
        false => Err(ReportError::Broken {
            path: path.to_owned(),
            problem: "its fields do not fit its particles".to_owned(),
        }),
    }
}

fn ranges(field: &Field, ids: &[u32], frame: &Frame) -> Vec<Range> {
    let parts = Part::all(field.components).into_iter();
    parts
        .filter_map(|part| range(field, part, ids, frame))
        .collect()
}

/// What is no number is passed over.
fn range(field: &Field, part: Part, ids: &[u32], frame: &Frame) -> Option<Range> {
    let value = |p: usize| part.value(&field.values[field.components * p..][..field.components]);
    let mut ends: Option<[(f64, usize); 2]> = None;
    for p in 0..ids.len() {
        let v = value(p);
        if v.is_finite() {
            let [low, high] = ends.get_or_insert([(v, p); 2]);
            if v < low.0 {
                *low = (v, p);
            }
            if v > high.0 {
                *high = (v, p);
            }
        }
    }
    let [low, high] = ends?;
    let stride = ids.len().div_ceil(SAMPLE).max(1);
    let mut sample: Vec<f64> = (0..ids.len()).step_by(stride).map(value).collect();
    sample.retain(|v| v.is_finite());
    sample.sort_by(f64::total_cmp);
    let of_sample = |share: f64| {
        let last = sample.len().saturating_sub(1);
        sample.get((share * last as f64).round() as usize).copied()
    };
    let body = frame.field("body").map_or(0, |f| f.values[high.1] as usize);
    Some(Range {
        least: low.0,
        greatest: high.0,
        inner: [
            of_sample(0.01).unwrap_or(low.0),
            of_sample(0.99).unwrap_or(high.0),
        ],
        at: [ids[low.1], ids[high.1]],
        place: frame.points[high.1],
        body,
    })
}

fn of_bodies(frame: &Frame) -> BTreeMap<usize, usize> {
    let mut counts = BTreeMap::new();
    let bodies = frame.field("body").into_iter().flat_map(|f| &f.values);
    bodies.for_each(|&body| *counts.entry(body as usize).or_default() += 1);
    counts
}

fn yielding(frame: &Frame) -> Option<[usize; 2]> {
    let above = |field: &Field| field.values.iter().filter(|&&v| v > 0.0).count();
    let now = above(frame.field("yielding")?);
    let ever = above(frame.field("plastic_strain")?);
    Some([now, ever])
}

fn sheared(frame: &Frame) -> Option<[[f64; 3]; 2]> {
    let strain = &frame.field("plastic_strain")?.values;
    let mut corners: Option<[[f64; 3]; 2]> = None;
    for (point, &strain) in frame.points.iter().zip(strain) {
        if strain >= SHEARED {
            let [low, high] = corners.get_or_insert([*point; 2]);
            for d in 0..3 {
                low[d] = low[d].min(point[d]);
                high[d] = high[d].max(point[d]);
            }
        }
    }
    corners
}
