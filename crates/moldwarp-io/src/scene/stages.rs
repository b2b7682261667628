//! Stages: what they change, and when they end.

use super::amount::{Amount, AmountOr, Spanned, each};
use super::error::Fault;
use super::presence::Presence;
use super::quantity::Dimension;
use super::raw::{RawEquilibrium, RawRamp, RawStage, Text, Texts};
use super::suggest;
use super::values::{
    amount, amount_at, choose, count, damping, exactly_one, find, placed, positive, required, span,
    vector,
};
use crate::text;
use moldwarp::plan::{
    Body, Boundary, Equilibrium, Item, Level, Load, NamedMaterial, Ramp, Stage, Until,
};
use std::ops::Range;

/// What stages can name.
pub(super) struct Named<'a> {
    pub bodies: &'a [Body],
    pub materials: &'a [NamedMaterial],
    pub boundaries: &'a [Boundary],
    pub loads: &'a [Load],
}

pub(super) fn stages(
    raw: &[Spanned<RawStage>],
    named: &Named,
    presence: &Presence,
) -> Result<Vec<Stage>, Fault> {
    if raw.is_empty() {
        return Err(
            Fault::new("the scene has no stages, so nothing would be computed")
                .help("add one at the end:\n[[stages]]\nname = \"loading\"\nduration = \"2 s\""),
        );
    }
    let mut stages: Vec<Stage> = Vec::new();
    let mut switched: Vec<(Item, bool)> = Vec::new();
    for (number, raw) in raw.iter().enumerate() {
        let presence = (number, presence);
        let stage = stage(raw.get_ref(), named, presence, &mut switched)?;
        if stages.iter().any(|s| s.name == stage.name) {
            return Err(
                Fault::new(format!("two stages are called `{}`", stage.name))
                    .at(raw.get_ref().name.span(), "the second of this name")
                    .help("give each its own name"),
            );
        }
        stages.push(stage);
    }
    Ok(stages)
}

/// `switched` is how earlier stages have left what they named.
fn stage(
    raw: &RawStage,
    named: &Named,
    (number, presence): (usize, &Presence),
    switched: &mut Vec<(Item, bool)>,
) -> Result<Stage, Fault> {
    let mut initial_velocities = Vec::new();
    for (body, velocity) in &raw.initial_velocity.0 {
        let names = named.bodies.iter().map(|b| b.name.as_str());
        let place = find(placed(body), "body", "bodies", names)?;
        presence.needed(number, place, body.span())?;
        initial_velocities.push((
            place,
            vector("initial_velocity", velocity, Dimension::Velocity)?,
        ));
    }
    let mut materials = Vec::new();
    for (body, material) in &raw.material.0 {
        let names = named.bodies.iter().map(|b| b.name.as_str());
        let place = find(placed(body), "body", "bodies", names)?;
        presence.needed(number, place, body.span())?;
        let names = named.materials.iter().map(|m| m.name.as_str());
        let other = find(placed(material), "material", "materials", names)?;
        let both = [named.bodies[place].material, other].map(|m| &named.materials[m]);
        if both.iter().any(|m| m.model.is_rigid()) {
            return Err(Fault::new(format!(
                "body `{}` cannot change between rigid and other materials",
                body.get_ref()
            ))
            .at(material.span(), "a rigid body is so from the start")
            .help("leave this out"));
        }
        let [before, after] = both.map(|m| m.density);
        if before != after {
            return Err(Fault::new(format!(
                "material `{}` has another density than body `{}`, whose mass stays",
                material.get_ref(),
                body.get_ref()
            ))
            .at(
                material.span(),
                format!(
                    "{} kg/m³, not {}",
                    text::number(after),
                    text::number(before)
                ),
            )
            .help("give both materials the same density or unit weight"));
        }
        materials.push((place, other));
    }
    let off = items(raw.off.as_ref(), false, named, switched)?;
    let on = items(raw.on.as_ref(), true, named, switched)?;
    if let Some(reset) = &raw.reset {
        for (place, word) in each(reset) {
            choose((place, word), "reset", &[("displacement", ())])?;
        }
    }
    Ok(Stage {
        name: raw.name.get_ref().clone(),
        until: until(raw)?,
        damping: raw.damping.as_ref().map(damping).transpose()?,
        initial_velocities,
        materials,
        remove: presence.removed_by(number),
        add: presence.added_by(number),
        on,
        off,
        levels: levels(raw, named)?,
        reset_displacement: raw.reset.is_some(),
    })
}

fn until(raw: &RawStage) -> Result<Until, Fault> {
    if let Some(word) = &raw.until {
        return until_equilibrium(word, raw);
    }
    exactly_one(
        (raw.name.span(), "a stage"),
        &[
            ("duration", span(&raw.duration)),
            ("steps", span(&raw.steps)),
        ],
    )?;
    if let Some(judged) = &raw.equilibrium {
        return Err(Fault::new("`equilibrium` is for stages that end in it")
            .at(judged.span(), "this stage ends otherwise")
            .help("add until = \"equilibrium\", or leave this out"));
    }
    match (&raw.duration, &raw.steps) {
        (Some(length), _) => Ok(Until::Duration(positive(
            "duration",
            length,
            Dimension::Time,
        )?)),
        (None, Some(steps)) => Ok(Until::Steps(count("steps", steps, 1)?)),
        (None, None) => Err(Fault::new("a stage needs an end")),
    }
}

fn until_equilibrium(word: &Text, raw: &RawStage) -> Result<Until, Fault> {
    choose(placed(word), "end of a stage", &[("equilibrium", ())])?;
    if let Some(steps) = &raw.steps {
        return Err(Fault::new("a stage until equilibrium is limited in time")
            .at(steps.span(), "not in steps")
            .help("give it a `duration` as its limit"));
    }
    let owner = (word.span(), "a stage until equilibrium");
    let limit = required(owner, "duration", &raw.duration, "\"10 s\"")?;
    Ok(Until::Equilibrium {
        limit: positive("duration", limit, Dimension::Time)?,
        judged: equilibrium(raw.equilibrium.as_ref().map(Spanned::get_ref))?,
    })
}

fn equilibrium(raw: Option<&RawEquilibrium>) -> Result<Equilibrium, Fault> {
    let mut judged = Equilibrium::default();
    let Some(raw) = raw else { return Ok(judged) };
    if let Some(most) = &raw.unbalanced {
        judged.unbalanced = positive("unbalanced", most, Dimension::Number)?;
    }
    if let Some(most) = &raw.kinetic {
        judged.kinetic = positive("kinetic", most, Dimension::Number)?;
    }
    if let Some(hold) = &raw.hold {
        judged.hold = Some(positive("hold", hold, Dimension::Time)?);
    }
    Ok(judged)
}

/// The boundary or load of a name; a name that both have is no name.
fn item((place, name): (Range<usize>, &str), named: &Named) -> Result<Item, Fault> {
    let boundary = named.boundaries.iter().position(|b| b.name == name);
    let load = named.loads.iter().position(|l| l.name == name);
    match (boundary, load) {
        (Some(b), None) => Ok(Item::Boundary(b)),
        (None, Some(l)) => Ok(Item::Load(l)),
        (Some(_), Some(_)) => Err(Fault::new(format!(
            "both a boundary and a load are called `{name}`"
        ))
        .at(place, "which of them?")
        .help("give one of them a `name` of its own")),
        (None, None) => {
            let boundaries = named.boundaries.iter().map(|b| b.name.as_str());
            let names = boundaries.chain(named.loads.iter().map(|l| l.name.as_str()));
            Err(Fault::new(format!("there is no boundary or load `{name}`"))
                .at(place, "no such boundary or load")
                .help(suggest::help(name, "boundaries and loads", names)))
        }
    }
}

/// Items to switch, none of which may be so already.
fn items(
    raw: Option<&Texts>,
    on: bool,
    named: &Named,
    switched: &mut Vec<(Item, bool)>,
) -> Result<Vec<Item>, Fault> {
    let mut found = Vec::new();
    for (place, name) in raw.map(each).unwrap_or_default() {
        let item = item((place.clone(), name), named)?;
        let before = switched.iter_mut().find(|s| s.0 == item);
        // Before it is first named a thing is on if it is switched off, and off if it is switched on.
        let was = before.as_ref().map_or(!on, |s| s.1);
        if was == on {
            let word = if on { "on" } else { "off" };
            return Err(Fault::new(format!("`{name}` is {word} already"))
                .at(place, format!("switched {word} before"))
                .help("leave it out here; it stays as the earlier stage has left it"));
        }
        match before {
            Some(state) => state.1 = on,
            None => switched.push((item, on)),
        }
        found.push(item);
    }
    Ok(found)
}

fn levels(raw: &RawStage, named: &Named) -> Result<Vec<(Level, Ramp)>, Fault> {
    let mut levels = Vec::new();
    for (name, value) in &raw.scale.0 {
        let level = match name.get_ref().as_str() {
            "gravity" => Level::Gravity,
            _ => {
                let names = named.loads.iter().map(|l| l.name.as_str());
                let names = names.chain(std::iter::once("gravity"));
                let place = find(placed(name), "load", "what has a factor", names)?;
                Level::Load(place)
            }
        };
        levels.push((level, ramp(name.span(), value)?));
    }
    Ok(levels)
}

fn ramp(place: Range<usize>, value: &AmountOr<RawRamp>) -> Result<Ramp, Fault> {
    let at_once = |value: &Amount| amount_at("scale", place.clone(), value, Dimension::Number);
    match value {
        AmountOr::Amount(value) => Ok(Ramp {
            from: None,
            to: at_once(value)?,
            over: 0.0,
        }),
        AmountOr::Table(ramp) => Ok(Ramp {
            from: (ramp.from.as_ref())
                .map(|from| amount("from", from, Dimension::Number))
                .transpose()?,
            to: amount("to", &ramp.to, Dimension::Number)?,
            over: positive("over", &ramp.over, Dimension::Time)?,
        }),
    }
}
