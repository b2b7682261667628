//! What an engineer asks first, answered from the data as far as they go.

use super::figures::{count, escape, figure, percent, place};
use super::source::Source;
use super::survey::{SHEARED, Survey};
use crate::run::{NUMERICAL, RESIDUAL};
use serde_json::{Value, json};

/// A body is at rest when its kinetic energy is below this part of its peak.
const AT_REST: f64 = 0.01;

/// A rest that is shorter than this part of the run may be none.
const SHORT: f64 = 0.05;

/// A question with its answer, as HTML.
#[derive(Debug)]
pub struct Answer {
    pub id: &'static str,
    pub question: &'static str,
    /// One figure or a few words.
    pub short: String,
    /// Sentences, each a line.
    pub more: Vec<String>,
    /// What a button shows: its caption, and what the page's script is told.
    pub show: Option<(&'static str, Value)>,
}

/// `edges` are the least, the median and the greatest length of the elements' edges, m.
pub fn answers(source: &Source, survey: &Survey, edges: Option<[f64; 3]>) -> Vec<Answer> {
    vec![
        how_far(source, survey),
        when_at_rest(source),
        where_yielded(source, survey),
        greatest_force(source),
        trust(source, survey, edges),
    ]
}

fn how_far(source: &Source, survey: &Survey) -> Answer {
    let mut more = Vec::new();
    let mut answer = Answer {
        id: "far",
        question: "How far did it go?",
        short: "not recorded".to_owned(),
        more: Vec::new(),
        show: None,
    };
    if let Some((frame, range)) = survey.greatest("displacement", 0) {
        answer.short = figure(range.greatest, "m");
        let time = survey.frames[frame].time;
        more.push(format!(
            "Greatest displacement of a particle in any frame: of {}, at t = {}, at {}.",
            body(source, range.body),
            figure(time, "s"),
            place(range.place)
        ));
        let last = survey.frames.iter().rev().find(|f| f.particles > 0);
        if let Some(last) = last
            && let Some(range) = last.ranges.get("displacement").and_then(|r| r.first())
        {
            more.push(format!(
                "In the last frame, t = {}: {}.",
                figure(last.time, "s"),
                figure(range.greatest, "m")
            ));
        }
        answer.show = Some((
            "Show it",
            json!({ "field": "displacement", "part": 0, "frame": frame, "id": range.at[1] }),
        ));
    }
    for (name, last) in ways(source).into_iter().take(6) {
        if answer.show.is_none() && more.is_empty() {
            answer.short = figure(last, "m");
        }
        let (name, last) = (escape(&name), figure(last, "m"));
        more.push(format!("<code>{name}</code> at the end: {last}."));
    }
    answer.more = more;
    answer
}

/// The last displacements of probes, as lengths, and penetrations.
fn ways(source: &Source) -> Vec<(String, f64)> {
    let last = |name: &str| source.history.column(name)?.last().copied();
    let names = source.history.names.iter();
    let way = |name: &String| {
        if name.ends_with(".penetration") {
            return Some((name.clone(), last(name)?));
        }
        let name = name
            .strip_suffix(".x")
            .filter(|n| n.ends_with(".displacement"))?;
        let parts = ["x", "y", "z"].map(|c| last(&format!("{name}.{c}")));
        let squares = parts
            .into_iter()
            .try_fold(0.0, |sum, c| Some(sum + c? * c?))?;
        Some((name.to_owned(), f64::sqrt(squares)))
    };
    names.filter_map(way).collect()
}

fn body(source: &Source, number: usize) -> String {
    let name = source.outline.bodies.get(number);
    name.map_or(format!("body {number}"), |name| {
        format!("<b>{}</b>", escape(name))
    })
}

/// When a history fell below a part of its peak for good, or where it stands at the end.
#[derive(Debug, PartialEq)]
enum Rest {
    Nothing,
    Since { time: f64, peak_at: f64 },
    Moving { share: f64, peak_at: f64 },
}

fn rest(times: &[f64], energy: &[f64]) -> Rest {
    let pairs = times.iter().copied().zip(energy.iter().copied());
    let peak = pairs
        .filter(|p| p.1.is_finite())
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let Some((peak_at, peak)) = peak.filter(|p| p.1 > 0.0) else {
        return Rest::Nothing;
    };
    // What is no number is no rest.
    let moving = |e: &f64| e.is_nan() || *e >= AT_REST * peak;
    match energy
        .iter()
        .rposition(moving)
        .map(|last| times.get(last + 1))
    {
        Some(Some(&time)) => Rest::Since { time, peak_at },
        _ => Rest::Moving {
            share: energy.last().map_or(f64::NAN, |last| last / peak),
            peak_at,
        },
    }
}

fn when_at_rest(source: &Source) -> Answer {
    let column = |name: &str| source.history.column(name);
    let mut answer = Answer {
        id: "rest",
        question: "When did it stop?",
        short: "not recorded".to_owned(),
        more: vec!["There is no history with rows of the kinetic energy.".to_owned()],
        show: None,
    };
    let (Some(times), Some(energy)) = (column("time"), column("energy.kinetic_grid")) else {
        return answer;
    };
    let judged =
        "Judged by the kinetic energy of the mesh's nodes, in the rows of the history.".to_owned();
    let at = |time| figure(time, "s");
    answer.show = Some(("Show the curve", json!({ "plot": "energy" })));
    (answer.short, answer.more) = match rest(times, energy) {
        Rest::Nothing => ("nothing moved".to_owned(), vec![judged]),
        Rest::Since { time, peak_at } => {
            let mut more = vec![format!(
                "From then on the kinetic energy is below {} % of its peak, which was at t = {}.",
                100.0 * AT_REST,
                at(peak_at)
            )];
            let end = times.last().copied().unwrap_or(time);
            if end - time < SHORT * end {
                more.push(format!(
                    "The run ends soon after, at t = {}: whether it stays so, only a longer one tells.",
                    at(end)
                ));
            }
            more.push(judged);
            (at(time), more)
        }
        Rest::Moving { share, peak_at } => (
            "it did not".to_owned(),
            vec![
                format!(
                    "At the end, t = {}, the kinetic energy is {} of its peak, which was at t = {}; at rest \
                     would be below {} %.",
                    at(times.last().copied().unwrap_or(f64::NAN)),
                    percent(share),
                    at(peak_at),
                    100.0 * AT_REST
                ),
                judged,
            ],
        ),
    };
    answer
}

fn where_yielded(source: &Source, survey: &Survey) -> Answer {
    let mut answer = Answer {
        id: "yield",
        question: "Where did it yield?",
        short: "nowhere".to_owned(),
        more: Vec::new(),
        show: None,
    };
    let last = survey.frames.iter().rposition(|f| f.particles > 0);
    let Some(last) = last else {
        answer.short = "not recorded".to_owned();
        answer.more = vec!["There are no frames.".to_owned()];
        return answer;
    };
    let frame = &survey.frames[last];
    let Some([now, ever]) = frame.yielding else {
        answer.more = vec!["No material of the scene can yield.".to_owned()];
        return answer;
    };
    let share = |n: usize| percent(n as f64 / frame.particles as f64);
    let first = survey
        .frames
        .iter()
        .find(|f| f.yielding.is_some_and(|y| y[0] > 0));
    if ever > 0 || first.is_some() {
        answer.short = format!("{} of the particles", share(ever));
        answer.more.push(format!(
            "In the last frame, t = {}, so many have plastic strain, by number; {} are yielding then.",
            figure(frame.time, "s"),
            share(now)
        ));
    }
    if let Some(first) = first {
        let time = figure(first.time, "s");
        answer
            .more
            .push(format!("The first frame with yielding is at t = {time}."));
    }
    if let Some([low, high]) = frame.sheared {
        answer.more.push(format!(
            "Plastic strains of {} % and more lie between {} and {}.",
            100.0 * SHEARED,
            place(low),
            place(high)
        ));
    }
    if let Some((number, range)) = survey
        .greatest("plastic_strain", 0)
        .filter(|g| g.1.greatest > 0.0)
    {
        answer.more.push(format!(
            "Greatest plastic strain: {}, of {}, at t = {}, at {}.",
            figure(range.greatest, ""),
            body(source, range.body),
            figure(survey.frames[number].time, "s"),
            place(range.place)
        ));
    }
    answer.show = Some((
        "Show plastic strain",
        json!({ "field": "plastic_strain", "part": 0, "frame": last }),
    ));
    answer
}

/// A force over time.
#[derive(Debug, PartialEq)]
struct Force {
    /// Of a contact, normal and tangential, or of a probe.
    name: String,
    /// Whose curves show it.
    plot: String,
    greatest: f64,
    time: f64,
    at_end: f64,
}

fn forces(source: &Source) -> Vec<Force> {
    let history = &source.history;
    let column = |name: String| history.column(&name);
    let Some(times) = history.column("time") else {
        return Vec::new();
    };
    let vector = |name: &str| -> Option<Vec<[f64; 3]>> {
        let [x, y, z] = ["x", "y", "z"].map(|c| column(format!("{name}.{c}")));
        let (x, y, z) = (x?, y?, z?);
        Some((0..times.len()).map(|i| [x[i], y[i], z[i]]).collect())
    };
    let force = |name: String, plot: String, vectors: &[[f64; 3]]| {
        let size = |v: &[f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let all = vectors.iter().map(size).zip(times.iter().copied());
        let all = all.filter(|f| f.0.is_finite());
        let (greatest, time) = all.reduce(|a, b| if b.0 > a.0 { b } else { a })?;
        Some(Force {
            name,
            plot,
            greatest,
            time,
            at_end: size(vectors.last()?),
        })
    };
    let names = history.names.iter().filter(|n| source.unit(n) == "N");
    let names = names.filter_map(|n| n.strip_suffix(".x"));
    let of_name = |name: &str| match name.strip_suffix(".normal") {
        // Normal and tangential forces of a contact together are what one side feels.
        Some(contact) => {
            let both = vector(name)?
                .into_iter()
                .zip(vector(&format!("{contact}.tangential"))?);
            let both = both.map(|(n, t)| [n[0] + t[0], n[1] + t[1], n[2] + t[2]]);
            let both: Vec<[f64; 3]> = both.collect();
            force(contact.to_owned(), name.to_owned(), &both)
        }
        None if name.ends_with(".tangential") => None,
        None => force(name.to_owned(), name.to_owned(), &vector(name)?),
    };
    let mut forces: Vec<Force> = names.filter_map(of_name).collect();
    forces.sort_by(|a, b| b.greatest.total_cmp(&a.greatest));
    forces
}

fn greatest_force(source: &Source) -> Answer {
    let forces = forces(source);
    let Some(first) = forces.first() else {
        return Answer {
            id: "force",
            question: "What was the greatest force?",
            short: "not recorded".to_owned(),
            more: vec![
                "The history has no forces. They are recorded by contacts, and by probes on surfaces with \
                 the quantity <code>reaction</code> or <code>contact</code>."
                    .to_owned(),
            ],
            show: None,
        };
    };
    let line = |f: &Force| {
        format!(
            "<code>{}</code>: {} at t = {}; {} at the end.",
            escape(&f.name),
            figure(f.greatest, "N"),
            figure(f.time, "s"),
            figure(f.at_end, "N")
        )
    };
    let mut more: Vec<String> = forces.iter().take(5).map(line).collect();
    more.push(
        "Lengths of the vectors in the rows of the history; peaks between rows are not seen."
            .to_owned(),
    );
    Answer {
        id: "force",
        question: "What was the greatest force?",
        short: figure(first.greatest, "N"),
        more,
        show: Some(("Show the curve", json!({ "plot": first.plot }))),
    }
}

/// How much a run deserves belief.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Grade {
    /// Nothing speaks against it.
    Good,
    /// It is not over.
    Unfinished,
    /// It ended early, or there are warnings.
    Doubt,
    /// Its results are not to be used.
    Bad,
}

/// The run's figures that tell it.
#[derive(Debug)]
pub struct Verdict {
    pub grade: Grade,
    /// How the run ended.
    pub ended: String,
    /// Whether it can be believed.
    pub trust: String,
}

/// A number of the summary.
pub fn of_summary(source: &Source, key: &str) -> Option<f64> {
    source.summary.as_ref()?.get(key)?.as_f64()
}

/// Residual and numerical terms over the energy turned over.
pub fn shares(source: &Source) -> Option<[f64; 2]> {
    let energy = source.summary.as_ref()?.get("energy")?;
    let term = |kind: &str| energy[kind].as_f64().map(f64::abs);
    let numerical = ["transfer", "smoothing", "integration", "advection"].map(term);
    let numerical = numerical.into_iter().try_fold(0.0, |sum, t| Some(sum + t?));
    let turned_over = of_summary(source, "energy_turned_over")?;
    // Nothing of nothing is nothing.
    let share = |part: f64| if part == 0.0 { 0.0 } else { part / turned_over };
    // null stands for what was no number.
    Some([
        term("residual").map_or(f64::NAN, share),
        numerical.map_or(f64::NAN, share),
    ])
}

pub fn verdict(source: &Source) -> Verdict {
    let Some(summary) = &source.summary else {
        return Verdict {
            grade: Grade::Unfinished,
            ended: "The run is not over: it is at work, or was interrupted.".to_owned(),
            trust: "The figures are those up to its last row and frame; the ledger is judged at the end. \
                    <code>moldwarp resume</code> goes on with a run that was interrupted."
                .to_owned(),
        };
    };
    let exit = summary["exit"].as_str().unwrap_or_default();
    let time = figure(of_summary(source, "time").unwrap_or(f64::NAN), "s");
    let warnings = summary["warnings"].as_array().map_or(0, Vec::len);
    let lost = of_summary(source, "lost_particles").unwrap_or(0.0);
    let [residual, numerical] = shares(source).unwrap_or([f64::NAN; 2]);
    let closes = residual <= RESIDUAL;
    let done = exit == "done";
    let ended = match done {
        true => format!("The run was completed, up to t = {time}."),
        false if !source.is_over() => {
            format!("The simulation is not over: this is how it stands at t = {time}.")
        }
        false => format!("The run was stopped at t = {time}: {}.", escape(exit)),
    };
    let (grade, trust) = if lost > 0.0 || !closes {
        (
            Grade::Bad,
            "Do not use its results: see the warnings.".to_owned(),
        )
    } else if warnings > 0 || numerical.is_nan() || numerical > NUMERICAL {
        (
            Grade::Doubt,
            "Its results are to be doubted: see the warnings.".to_owned(),
        )
    } else if done {
        let trust = "Nothing that moldwarp checks speaks against its results: the ledger closes, numerical \
                     terms are within their limit, no particle is lost. Whether the mesh is fine enough, only a \
                     finer one tells.";
        (Grade::Good, trust.to_owned())
    } else if !source.is_over() {
        let trust = "Nothing that moldwarp checks speaks against its results so far.";
        (Grade::Unfinished, trust.to_owned())
    } else {
        (
            Grade::Doubt,
            "What was computed up to then is kept.".to_owned(),
        )
    };
    Verdict {
        grade,
        ended,
        trust,
    }
}

fn trust(source: &Source, survey: &Survey, edges: Option<[f64; 3]>) -> Answer {
    let verdict = verdict(source);
    let mut more = Vec::new();
    if let Some([residual, numerical]) = shares(source) {
        more.push(format!(
            "What the energy ledger leaves unexplained: {} of the energy turned over ({} to be round-off: at \
             most {}).",
            percent(residual),
            if residual <= RESIDUAL { "small enough" } else { "<b>too large</b>" },
            percent(RESIDUAL)
        ));
        more.push(format!(
            "Numerical terms: {} of it ({} the limit of {}).",
            percent(numerical),
            if numerical <= NUMERICAL {
                "within"
            } else {
                "<b>over</b>"
            },
            percent(NUMERICAL)
        ));
        let lost = of_summary(source, "lost_particles").unwrap_or(0.0);
        let foreign = of_summary(source, "foreign_particles").unwrap_or(0.0);
        let outflow = of_summary(source, "outflow_particles").unwrap_or(0.0);
        more.push(format!(
            "Particles lost: {}; on the wrong side of a contact: {}; gone through outflow surfaces: {}.",
            count(lost as u64),
            count(foreign as u64),
            count(outflow as u64)
        ));
    }
    more.extend(resolution(source, survey, edges));
    Answer {
        id: "trust",
        question: "Can I trust it?",
        short: match verdict.grade {
            Grade::Good => "no objection",
            Grade::Unfinished => "not over yet",
            Grade::Doubt => "with doubts",
            Grade::Bad => "no",
        }
        .to_owned(),
        more,
        show: None,
    }
}

/// How fine the run is.
fn resolution(source: &Source, survey: &Survey, edges: Option<[f64; 3]>) -> Option<String> {
    let particles = of_summary(source, "particles");
    let particles = particles.or(survey.frames.last().map(|f| f.particles as f64))?;
    let mut text = format!("Resolution: {} particles", count(particles as u64));
    let counts = survey.frames.last().map(|f| &f.of_bodies);
    if let Some(counts) = counts.filter(|c| c.len() > 1) {
        let one = |(body, n): (&usize, &usize)| {
            format!("{} {}", self::body(source, *body), count(*n as u64))
        };
        text += &format!(
            " ({})",
            counts.iter().map(one).collect::<Vec<_>>().join(", ")
        );
    }
    if let Some(elements) = of_summary(source, "elements") {
        text += &format!(", {} elements", count(elements as u64));
    }
    if let Some([least, median, greatest]) = edges {
        text += &format!(
            " with edges of {} to {}, half of them below {}",
            figure(least, "m"),
            figure(greatest, "m"),
            figure(median, "m")
        );
    }
    Some(text + ".")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rest_is_when_the_energy_stays_small() {
        let times = [0.0, 1.0, 2.0, 3.0, 4.0];
        let rest = |energy: [f64; 5]| rest(&times, &energy);
        assert_eq!(
            rest([0.0, 100.0, 0.5, 2.0, 0.9]),
            Rest::Since {
                time: 4.0,
                peak_at: 1.0
            }
        );
        assert_eq!(
            rest([0.0, 100.0, 0.5, 0.2, 1.0]),
            Rest::Moving {
                share: 0.01,
                peak_at: 1.0
            }
        );
        assert_eq!(rest([0.0; 5]), Rest::Nothing);
        assert!(matches!(
            rest([1.0, 100.0, 0.5, 0.2, f64::NAN]),
            Rest::Moving { .. }
        ));
    }
}
