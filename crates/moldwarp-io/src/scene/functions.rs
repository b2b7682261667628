//! Functions of time.

use super::amount::{RawVector, Spanned};
use super::error::Fault;
use super::quantity::Dimension;
use super::raw::RawFunction;
use super::values::{amount, choose, count, foreign, placed, positive, required, span};
use moldwarp::boundary::Function;

/// Kinds of functions; what the reference says of each stands here.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// 1.
    Constant,
    /// From 0 at the start to 1 after `duration`, then 1.
    Ramp,
    /// Straight lines between the points, constant outside.
    Table,
    /// `count` pulses sin(πt/duration), one each `period`, 0 between.
    HalfSine,
}

/// The function; constant if there is none.
pub(super) fn function(raw: Option<&Spanned<RawFunction>>) -> Result<Function, Fault> {
    let Some(raw) = raw else {
        return Ok(Function::Constant);
    };
    let place = raw.span();
    let raw = raw.get_ref();
    let kind = choose(
        placed(&raw.kind),
        "kind of function",
        &[
            ("constant", Kind::Constant),
            ("ramp", Kind::Ramp),
            ("table", Kind::Table),
            ("half-sine", Kind::HalfSine),
        ],
    )?;
    refuse_others(kind, raw)?;
    let duration = || {
        let owner = (place.clone(), "this function");
        let duration = required(owner, "duration", &raw.duration, "\"1 s\"")?;
        positive("duration", duration, Dimension::Time)
    };
    match kind {
        Kind::Constant => Ok(Function::Constant),
        Kind::Ramp => Ok(Function::Ramp {
            duration: duration()?,
        }),
        Kind::HalfSine => half_sine(raw, duration()?),
        Kind::Table => {
            let owner = (place.clone(), "a table");
            let example = "[[\"0 s\", 0], [\"1 s\", 1]]";
            table(required(owner, "points", &raw.points, example)?)
        }
    }
}

fn refuse_others(kind: Kind, raw: &RawFunction) -> Result<(), Fault> {
    let keys = [
        (
            "duration",
            span(&raw.duration),
            &[Kind::Ramp, Kind::HalfSine][..],
        ),
        ("period", span(&raw.period), &[Kind::HalfSine]),
        ("count", span(&raw.count), &[Kind::HalfSine]),
        ("points", span(&raw.points), &[Kind::Table]),
    ];
    let others = keys.into_iter().filter(|k| !k.2.contains(&kind));
    let others: Vec<_> = others.map(|(key, span, _)| (key, span)).collect();
    foreign(&raw.kind, &others)
}

/// One pulse unless `count` says more; then their period is needed.
fn half_sine(raw: &RawFunction, duration: f64) -> Result<Function, Fault> {
    let pulses = match &raw.count {
        None => 1,
        Some(n) => u32::try_from(count("count", n, 1)?)
            .map_err(|_| Fault::new("`count` is too large").at(n.span(), "too many pulses"))?,
    };
    let period = match &raw.period {
        Some(period) => {
            let value = positive("period", period, Dimension::Time)?;
            if value < duration {
                return Err(Fault::new("`period` must not be less than `duration`")
                    .at(
                        period.span(),
                        "the next pulse would begin before this one ends",
                    )
                    .help("the period is the time from one pulse's begin to the next one's"));
            }
            value
        }
        None if pulses == 1 => duration,
        None => {
            return Err(Fault::new("several pulses need a `period`")
                .at(raw.kind.span(), "`period` is missing")
                .help("for example period = \"1 s\", from one pulse's begin to the next one's"));
        }
    };
    Ok(Function::HalfSine {
        duration,
        period,
        count: pulses,
    })
}

fn table(raw: &Spanned<Vec<RawVector>>) -> Result<Function, Fault> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for raw in raw.get_ref() {
        let [time, value] = raw.get_ref().as_slice() else {
            return Err(Fault::new("a point of a table is a time and a value")
                .at(raw.span(), format!("has {} entries", raw.get_ref().len()))
                .help("write points = [[\"0 s\", 0], [\"1 s\", 1]]"));
        };
        let t = amount("time", time, Dimension::Time)?;
        if points.last().is_some_and(|last| t <= last.0) {
            return Err(Fault::new("the times of a table must increase")
                .at(time.span(), "not later than the point before")
                .help("a jump is two points a short time apart"));
        }
        points.push((t, amount("value", value, Dimension::Number)?));
    }
    if points.is_empty() {
        return Err(Fault::new("a table needs at least one point").at(raw.span(), "has none"));
    }
    Ok(Function::Table { points })
}
