//! The particles and the mesh as a page's script reads them.

use super::ReportError;
use super::budget::{BITS, Cost, Share, Wishes, evenly, share};
use super::fields::{About, STATES, is_of_kinds};
use super::mesh::MeshPictures;
use super::packing::{Coding, planes, text};
use super::source::Source;
use super::spacing::spacings;
use super::survey::{Survey, ids};
use crate::output::vtu_read::{Frame, read};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Bits of displacements, which also tell where particles are.
const DISPLACEMENT_BITS: u32 = BITS[0];
/// Particles from which a page's size is estimated.
const SAMPLE: usize = 20_000;
/// What an estimate may be wrong by.
const SAFETY: f64 = 0.95;

/// What is drawn, packed.
#[derive(Debug)]
pub struct Pictures {
    /// For the page's script, but for the blobs.
    pub about: Value,
    pub blobs: Blobs,
    pub share: Share,
}

/// Packed bytes as texts, by number.
#[derive(Debug, Default)]
pub struct Blobs {
    pub texts: Vec<String>,
}

impl Blobs {
    pub fn add(&mut self, text: String) -> usize {
        self.texts.push(text);
        self.texts.len() - 1
    }

    pub fn bytes(&self) -> usize {
        self.texts.iter().map(String::len).sum()
    }
}

/// The particles that are drawn, each at a place of its own in all frames.
struct Slots {
    ids: Vec<u32>,
    /// By number of the particle.
    of_id: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl Slots {
    fn new(ids: Vec<u32>) -> Slots {
        let mut of_id = vec![NONE; ids.last().map_or(0, |&last| last as usize + 1)];
        for (slot, &id) in ids.iter().enumerate() {
            of_id[id as usize] = slot as u32;
        }
        Slots { ids, of_id }
    }

    /// The place in a frame of the particle of each slot.
    fn places(&self, frame: &Frame) -> Vec<Option<usize>> {
        let mut places = vec![None; self.ids.len()];
        for (place, id) in ids(frame).into_iter().enumerate() {
            match self.of_id.get(id as usize) {
                Some(&slot) if slot != NONE => places[slot as usize] = Some(place),
                _ => {}
            }
        }
        places
    }
}

/// So many particles at most, evenly among those that lie beside each other, and those of `always` if
/// they are not too many.
fn choose(all: &BTreeSet<u32>, count: usize, always: &BTreeSet<u32>) -> Vec<u32> {
    if count >= all.len() {
        return all.iter().copied().collect();
    }
    let empty = BTreeSet::new();
    let always = if 2 * always.len() <= count {
        always
    } else {
        &empty
    };
    // Multiples of the golden ratio, less their whole part, fill 0 to 1 evenly and without a period,
    // so that not always the same of an element's particles are taken.
    let share = (count - always.len()) as f64 / all.len() as f64;
    let even = |n: usize| (n as f64 * 0.618_033_988_749_894_9).fract() < share;
    let mut room = count - always.len();
    let mut chosen = Vec::new();
    for (n, &id) in all.iter().enumerate() {
        let extreme = always.contains(&id);
        if extreme || (even(n) && room > 0) {
            chosen.push(id);
            room -= usize::from(!extreme);
        }
    }
    chosen
}

impl Pictures {
    /// Packs as much as there is room for, in bytes.
    pub fn of(
        source: &Source,
        survey: &Survey,
        wishes: Wishes,
        room: usize,
    ) -> Result<Pictures, ReportError> {
        let mut blobs = Blobs::default();
        let mut mesh = MeshPictures::of(source, &mut blobs)?;
        let room = SAFETY * room.saturating_sub(blobs.bytes()) as f64;
        let cost = Cost {
            particle: cost(source, survey)?,
            frame: 2000.0 + mesh.cost_of_a_frame(source)?,
        };
        let mut share = share(survey.ids.len(), survey.frames.len(), wishes, cost, room);
        let extremes = survey
            .frames
            .iter()
            .flat_map(|f| f.ranges.values().flatten());
        let extremes = extremes.flat_map(|r| r.at).collect();
        let slots = Slots::new(choose(&survey.ids, share.particles, &extremes));
        share.particles = slots.ids.len();

        let frames = evenly(share.frames, survey.frames.len());
        let mut packer = Packer::new(survey, &slots, share.bits);
        let before = blobs.bytes();
        let mut shown = Vec::new();
        for number in frames {
            let frame = read(&source.particles[number].1)?;
            let mut about = packer.pack(&frame, &mut blobs)?;
            about["number"] = json!(number);
            about["time"] = json!(survey.frames[number].time);
            about["particles"] = json!(survey.frames[number].particles);
            about["ranges"] = json!(survey.frames[number].ranges);
            about["mesh"] = json!(mesh.pack(source, number, &mut blobs)?);
            shown.push(about);
        }
        // The estimate was of a few frames only.
        let of_frames = (blobs.bytes() - before) as f64;
        let room = room / SAFETY;
        if of_frames > room && shown.len() > 2 {
            let count = (SAFETY * room / of_frames * shown.len() as f64) as usize;
            thin(&mut shown, count.max(2), &mut blobs);
        }
        share.frames = shown.len();
        let about = json!({
            "frames": shown,
            "fields": packer.fields(),
            "count": slots.ids.len(),
            "ids": blobs.add(text(&slots.ids.iter().flat_map(|id| id.to_le_bytes()).collect::<Vec<u8>>())),
            "origins": packer.origins(&mut blobs),
            "sizes": packer.sizes(&mut blobs),
            "low": survey.low,
            "high": survey.high,
            "overall": overall(survey),
            "bodies": source.outline.bodies,
            "states": STATES,
            "mesh": mesh.about,
            "bits": [DISPLACEMENT_BITS, share.bits],
        });
        Ok(Pictures {
            about,
            blobs,
            share,
        })
    }
}

/// Bytes of a particle in a frame, for each of [`BITS`], from five frames.
fn cost(source: &Source, survey: &Survey) -> Result<[f64; 3], ReportError> {
    let slots = Slots::new(choose(&survey.ids, SAMPLE, &BTreeSet::new()));
    let mut cost = [0.0; 3];
    let numbers = evenly(5, survey.frames.len());
    for &number in &numbers {
        let frame = read(&source.particles[number].1)?;
        for (cost, bits) in cost.iter_mut().zip(BITS) {
            let mut blobs = Blobs::default();
            Packer::new(survey, &slots, bits).pack(&frame, &mut blobs)?;
            *cost += blobs.bytes() as f64;
        }
    }
    let count = (numbers.len() * slots.ids.len()).max(1);
    Ok(cost.map(|bytes| bytes / count as f64))
}

/// Keeps so many of the frames, evenly.
fn thin(shown: &mut Vec<Value>, count: usize, blobs: &mut Blobs) {
    let kept = evenly(count, shown.len());
    let mut number = 0;
    shown.retain(|about| {
        number += 1;
        let stays = kept.contains(&(number - 1));
        if !stays {
            let all = about["fields"].as_array().into_iter().flatten();
            let all = all.chain([&about["present"], &about["mesh"]]);
            all.filter_map(Value::as_u64)
                .for_each(|blob| blobs.texts[blob as usize].clear());
        }
        stays
    });
}

/// The range of every part of every field over all frames.
fn overall(survey: &Survey) -> Value {
    let of_field = |(name, _): &(String, usize)| {
        let parts = survey
            .frames
            .iter()
            .filter_map(|f| f.ranges.get(name).map(Vec::len));
        let part = |part: usize| {
            let ranges = survey.frames.iter();
            let ranges = ranges.filter_map(|f| f.ranges.get(name)?.get(part));
            ranges.fold(
                [
                    f64::INFINITY,
                    f64::NEG_INFINITY,
                    f64::INFINITY,
                    f64::NEG_INFINITY,
                ],
                |a, r| {
                    [
                        a[0].min(r.least),
                        a[1].max(r.greatest),
                        a[2].min(r.inner[0]),
                        a[3].max(r.inner[1]),
                    ]
                },
            )
        };
        let parts = (0..parts.max().unwrap_or(0)).map(part);
        (name.clone(), json!(parts.collect::<Vec<_>>()))
    };
    Value::Object(survey.fields.iter().map(of_field).collect())
}

/// Packs frames one after the other.
struct Packer<'a> {
    survey: &'a Survey,
    slots: &'a Slots,
    codings: Vec<Option<Coding>>,
    /// Where displacements count from, by slot, again after each reset; no numbers where not known.
    origins: Vec<Vec<[f64; 3]>>,
    /// Distance to neighbours, m, by slot.
    sizes: Vec<Option<f64>>,
}

impl Packer<'_> {
    fn new<'a>(survey: &'a Survey, slots: &'a Slots, bits: u32) -> Packer<'a> {
        let coding = |(name, _): &(String, usize)| {
            let bits = match &name[..] {
                "displacement" => DISPLACEMENT_BITS,
                _ => bits,
            };
            (!is_of_kinds(name)).then(|| Coding::new(survey.scale(name), bits))
        };
        Packer {
            survey,
            slots,
            codings: survey.fields.iter().map(coding).collect(),
            origins: Vec::new(),
            sizes: vec![None; slots.ids.len()],
        }
    }

    fn pack(&mut self, frame: &Frame, blobs: &mut Blobs) -> Result<Value, ReportError> {
        let places = self.slots.places(frame);
        let mut numbers = Vec::new();
        for ((name, components), coding) in self.survey.fields.iter().zip(&self.codings) {
            let field = frame.field(name).filter(|f| f.components == *components);
            let value =
                |place: usize, c: usize| field.map_or(0.0, |f| f.values[components * place + c]);
            let code = |place: usize, c: usize| match coding {
                Some(coding) => coding.code(value(place, c)),
                None => value(place, c) as u16,
            };
            let of_component = |c: usize| places.iter().map(move |p| p.map_or(0, |p| code(p, c)));
            let codes: Vec<u16> = (0..*components).flat_map(of_component).collect();
            numbers.push(blobs.add(planes(&codes)));
        }
        let mask: Vec<u8> = places.iter().map(|p| u8::from(p.is_some())).collect();
        let all = mask.iter().all(|&m| m == 1);
        let origin = self.origin(frame, &places);
        self.measure(frame, &places);
        Ok(json!({
            "fields": numbers,
            "origin": origin,
            "present": if all { Value::Null } else { json!(blobs.add(text(&mask))) },
        }))
    }

    /// The number of the origins that this frame's displacements count from.
    fn origin(&mut self, frame: &Frame, places: &[Option<usize>]) -> usize {
        let zero = vec![0.0; 3 * frame.points.len()];
        let displacement = frame.field("displacement").map_or(&zero, |f| &f.values);
        let origin = |place: usize| -> [f64; 3] {
            std::array::from_fn(|d| frame.points[place][d] - displacement[3 * place + d])
        };
        let size = (0..3)
            .map(|d| self.survey.high[d] - self.survey.low[d])
            .fold(0.0, f64::max);
        let same = |a: &[f64; 3], b: &[f64; 3]| (0..3).all(|d| (a[d] - b[d]).abs() <= 1e-9 * size);
        let fits = |known: &[[f64; 3]]| {
            let pairs = known.iter().zip(places);
            let mut pairs = pairs.filter_map(|(known, place)| Some((known, (*place)?)));
            pairs.all(|(known, place)| known[0].is_nan() || same(known, &origin(place)))
        };
        if !self.origins.last().is_some_and(|known| fits(known)) {
            self.origins.push(vec![[f64::NAN; 3]; places.len()]);
        }
        let number = self.origins.len() - 1;
        for (known, place) in self.origins[number].iter_mut().zip(places) {
            if let (true, Some(place)) = (known[0].is_nan(), place) {
                *known = origin(*place);
            }
        }
        number
    }

    /// Sizes of the particles that come with this frame.
    fn measure(&mut self, frame: &Frame, places: &[Option<usize>]) {
        let new = |(size, place): (&Option<f64>, &Option<usize>)| size.is_none() && place.is_some();
        if !self.sizes.iter().zip(places).any(new) {
            return;
        }
        let there = places
            .iter()
            .enumerate()
            .filter_map(|(slot, place)| Some((slot, (*place)?)));
        let (slots, points): (Vec<usize>, Vec<[f64; 3]>) = there
            .map(|(slot, place)| (slot, frame.points[place]))
            .unzip();
        for (slot, spacing) in slots.into_iter().zip(spacings(&points)) {
            self.sizes[slot].get_or_insert(spacing);
        }
    }

    fn fields(&self) -> Value {
        let fields = self.survey.fields.iter().zip(&self.codings);
        let about = |((name, components), coding): (&(String, usize), &Option<Coding>)| {
            let about = About::of(name);
            json!({
                "name": name,
                "title": about.map_or(&name[..], |a| a.title),
                "unit": about.map_or("", |a| a.unit),
                "note": about.map_or("", |a| a.note),
                "components": components,
                "one": coding.map(|c| c.unit),
                "bits": coding.map(|c| c.bits),
            })
        };
        fields.map(about).collect()
    }

    /// As whole numbers from 0 to 65535 over the box of all of them.
    fn origins(&self, blobs: &mut Blobs) -> Value {
        let (low, size) = bounds(self.origins.iter().flatten());
        let pack = |origins: &Vec<[f64; 3]>| blobs.add(planes(&grid(origins, low, size)));
        let sets: Vec<usize> = self.origins.iter().map(pack).collect();
        json!({ "low": low, "size": size, "sets": sets })
    }

    fn sizes(&self, blobs: &mut Blobs) -> Value {
        let greatest = self.sizes.iter().flatten().fold(0.0, |a: f64, &b| a.max(b));
        let coding = Coding::new(greatest, 7);
        let codes: Vec<u16> = self
            .sizes
            .iter()
            .map(|s| coding.code(s.unwrap_or(0.0)))
            .collect();
        json!({ "one": coding.unit, "blob": blobs.add(planes(&codes)) })
    }
}

/// The lower corner of points' box, and its sides; no side is 0.
pub fn bounds<'a>(points: impl Iterator<Item = &'a [f64; 3]>) -> ([f64; 3], [f64; 3]) {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for point in points.filter(|p| p.iter().all(|x| x.is_finite())) {
        for d in 0..3 {
            low[d] = low[d].min(point[d]);
            high[d] = high[d].max(point[d]);
        }
    }
    if low[0] > high[0] {
        return ([0.0; 3], [1.0; 3]);
    }
    let size = std::array::from_fn(|d| {
        if high[d] > low[d] {
            high[d] - low[d]
        } else {
            1.0
        }
    });
    (low, size)
}

/// Points as parts of their box, all x, then all y, then all z.
pub fn grid(points: &[[f64; 3]], low: [f64; 3], size: [f64; 3]) -> Vec<u16> {
    let along = |d: usize| {
        points
            .iter()
            .map(move |p| ((p[d] - low[d]) / size[d] * 65535.0).round() as u16)
    };
    (0..3).flat_map(along).collect()
}
