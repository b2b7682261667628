//! Which bodies are there in which stage, and what must not be asked of those that are not.

use super::amount::{Spanned, each};
use super::error::Fault;
use super::raw::{RawBody, RawContact, RawLoad, RawStage, Text, Texts};
use super::values::find;
use moldwarp::plan::{Body, Contact, ContactSurface, Item, Load, Place, Stage};
use std::ops::Range;

/// A body and where its name stands.
type Placed = (usize, Range<usize>);

/// What stages add and remove.
pub(super) struct Presence<'a> {
    bodies: &'a [Body],
    stages: Vec<&'a RawStage>,
    remove: Vec<Vec<Placed>>,
    add: Vec<Vec<Placed>>,
    /// Which bodies are there at the start, and then in each stage.
    there: Vec<Vec<bool>>,
}

/// The volumes of the mesh that a body fills, as listed.
fn groups(body: &Body) -> &[usize] {
    match &body.place {
        Place::Volumes(groups) => groups,
        Place::Region(_) => &[],
    }
}

impl<'a> Presence<'a> {
    pub fn new(raw: &'a [Spanned<RawStage>], bodies: &'a [Body]) -> Result<Presence<'a>, Fault> {
        let named = |raw: Option<&Texts>| -> Result<Vec<Placed>, Fault> {
            let names = raw.map(each).unwrap_or_default().into_iter();
            let all = || bodies.iter().map(|b| b.name.as_str());
            let number = |(place, name): (Range<usize>, &String)| {
                Ok((find((place.clone(), name), "body", "bodies", all())?, place))
            };
            names.map(number).collect()
        };
        let mut presence = Presence {
            bodies,
            stages: raw.iter().map(Spanned::get_ref).collect(),
            remove: Vec::new(),
            add: Vec::new(),
            there: Vec::new(),
        };
        for raw in raw {
            presence.remove.push(named(raw.get_ref().remove.as_ref())?);
            presence.add.push(named(raw.get_ref().add.as_ref())?);
        }
        // A body that is added before it is ever removed is not there at the start.
        let names = |list: &[Placed], b: usize| list.iter().any(|p| p.0 == b);
        let at_the_start = |b| {
            let mut changes = presence.add.iter().zip(&presence.remove);
            let first = changes.find(|c| names(c.0, b) || names(c.1, b));
            first.is_none_or(|c| !names(c.0, b))
        };
        presence.there = vec![(0..bodies.len()).map(at_the_start).collect()];
        for stage in 0..raw.len() {
            let there = presence.after(stage)?;
            presence.there.push(there);
        }
        Ok(presence)
    }

    /// Which bodies are there when the stage has made its changes.
    fn after(&self, stage: usize) -> Result<Vec<bool>, Fault> {
        let name = |body: usize| &self.bodies[body].name;
        let mut there = self.there[stage].clone();
        for (body, place) in &self.remove[stage] {
            if let Some(add) = self.add[stage].iter().find(|a| a.0 == *body) {
                return Err(Fault::new(format!(
                    "stage `{}` both adds and removes `{}`",
                    self.name(stage),
                    name(*body)
                ))
                .at(add.1.clone(), "added")
                .at(place.clone(), "removed")
                .help(
                    "a body that is to begin anew goes in one stage and comes back in a later one",
                ));
            }
            if !std::mem::replace(&mut there[*body], false) {
                return Err(Fault::new(format!("`{}` is not there", name(*body)))
                    .at(
                        place.clone(),
                        self.earlier(stage, *body, &self.remove, "removes"),
                    )
                    .help("leave it out here"));
            }
        }
        for (body, place) in &self.add[stage] {
            if std::mem::replace(&mut there[*body], true) {
                return Err(Fault::new(format!("`{}` is there already", name(*body)))
                    .at(place.clone(), self.earlier(stage, *body, &self.add, "adds"))
                    .help("leave it out here, or remove it in a stage between"));
            }
        }
        if !there.contains(&true) {
            let place = self.stages[stage].name.span();
            return Err(Fault::new("a stage without bodies has nothing to compute")
                .at(place, "no body is there in this stage")
                .help("leave a body, or end the run with the stage before"));
        }
        Ok(there)
    }

    /// Which stage has changed a body before; this one if the body is listed twice.
    fn earlier(&self, stage: usize, body: usize, lists: &[Vec<Placed>], does: &str) -> String {
        let mut before = (0..stage).rev();
        let by = before.find(|&s| lists[s].iter().any(|p| p.0 == body));
        format!("stage `{}` {does} it", self.name(by.unwrap_or(stage)))
    }

    fn name(&self, stage: usize) -> &str {
        self.stages[stage].name.get_ref()
    }

    fn adds(&self, stage: usize, body: usize) -> bool {
        self.add[stage].iter().any(|p| p.0 == body)
    }

    /// The stage up to this one that has removed a body, and where.
    fn removed(&self, stage: usize, body: usize) -> Option<(usize, Range<usize>)> {
        (0..=stage).rev().find_map(|s| {
            let place = self.remove[s].iter().find(|p| p.0 == body)?;
            Some((s, place.1.clone()))
        })
    }

    /// The stage that brings a body that is not there in `stage`.
    fn comes(&self, stage: usize, body: usize) -> Option<&str> {
        let mut later = stage..self.stages.len();
        later.find(|&s| self.adds(s, body)).map(|s| self.name(s))
    }

    fn why_not(&self, stage: usize, body: usize) -> String {
        match (self.removed(stage, body), self.comes(stage, body)) {
            (Some((by, _)), _) => format!("stage `{}` removes it", self.name(by)),
            (None, Some(by)) => format!("stage `{by}` adds it"),
            (None, None) => String::new(),
        }
    }

    pub fn removed_by(&self, stage: usize) -> Vec<usize> {
        self.remove[stage].iter().map(|p| p.0).collect()
    }

    pub fn added_by(&self, stage: usize) -> Vec<usize> {
        self.add[stage].iter().map(|p| p.0).collect()
    }

    /// Refuses to give something to a body that is not there in the stage.
    pub fn needed(&self, stage: usize, body: usize, place: Range<usize>) -> Result<(), Fault> {
        if self.there[stage + 1][body] {
            return Ok(());
        }
        let name = &self.bodies[body].name;
        Err(Fault::new(format!(
            "body `{name}` is not there in stage `{}`",
            self.name(stage)
        ))
        .at(place, self.why_not(stage, body))
        .help(format!(
            "leave this out, or give it in a stage in which `{name}` is there"
        )))
    }

    /// No two bodies fill the same volume at the same time.
    pub fn check_volumes(&self, raw: &[(Text, RawBody)]) -> Result<(), Fault> {
        for (stage, there) in self.there.iter().enumerate() {
            for (b, (_, raw)) in raw.iter().enumerate().filter(|b| there[b.0]) {
                let Some(volume) = &raw.volume else { continue };
                let (own, named) = (groups(&self.bodies[b]), each(volume));
                let twice = (0..b).filter(|&o| there[o]).find_map(|o| {
                    let other = groups(&self.bodies[o]);
                    let same = own.iter().position(|g| other.contains(g))?;
                    Some((&self.bodies[o].name, same))
                });
                let Some((other, same)) = twice else {
                    continue;
                };
                let (place, name) = named[same].clone();
                let fault = Fault::new(format!("two bodies fill the volume `{name}`"))
                    .at(place, format!("already filled by `{other}`"));
                return Err(match stage {
                    0 => fault.help("a place can hold one body only"),
                    _ => fault.help(format!(
                        "both are there in stage `{}`, and a place can hold one body only: `remove` \
                         one of them",
                        self.name(stage - 1)
                    )),
                });
            }
        }
        Ok(())
    }

    /// Bodies that come later have no initial stress.
    pub fn check_k0(&self, raw: &[(Text, RawBody)]) -> Result<(), Fault> {
        for (b, (name, raw)) in raw.iter().enumerate().filter(|b| !self.there[0][b.0]) {
            if let Some(k0) = &raw.k0 {
                let by = self.comes(0, b).unwrap_or_default();
                return Err(
                    Fault::new(format!("`{}` is not there at the start", name.get_ref()))
                        .at(
                            k0.span(),
                            format!("is added by stage `{by}`; K0 stress is given at the start"),
                        )
                        .help("leave `k0` out: a body that is added comes free of stress"),
                );
            }
        }
        Ok(())
    }

    /// Loads must be off where their body is not there.
    pub fn check_loads(
        &self,
        raw: &[Spanned<RawLoad>],
        (loads, stages): (&[Load], &[Stage]),
    ) -> Result<(), Fault> {
        for (number, load) in loads.iter().enumerate() {
            let item = Item::Load(number);
            let mut on = !stages
                .iter()
                .find(|s| s.on.contains(&item) || s.off.contains(&item))
                .is_some_and(|s| s.on.contains(&item));
            for (s, stage) in stages.iter().enumerate() {
                on = (on || stage.on.contains(&item)) && !stage.off.contains(&item);
                if on && !self.there[s + 1][load.body] {
                    return Err(self.bare(s, stage, load, &raw[number]));
                }
            }
        }
        Ok(())
    }

    /// A load that is on in a stage in which its body is not there.
    fn bare(&self, s: usize, stage: &Stage, load: &Load, raw: &Spanned<RawLoad>) -> Fault {
        let (name, body) = (&load.name, &self.bodies[load.body].name);
        let switch = self.stages[s].on.as_ref().map(each).unwrap_or_default();
        let fault = Fault::new(format!(
            "load `{name}` is on in stage `{}`, in which its body `{body}` is not there",
            stage.name
        ));
        let come = self.comes(s, load.body);
        let on = come.map(|by| format!("on = [\"{name}\"] in stage `{by}`, which adds `{body}`"));
        if let Some((place, _)) = switch.into_iter().find(|w| w.1 == name) {
            let help = on.unwrap_or_else(|| format!("leave it off, or keep `{body}`"));
            return fault.at(place, self.why_not(s, load.body)).help(help);
        }
        match self.removed(s, load.body) {
            Some((by, place)) => fault
                .at(place, format!("`{body}` is removed"))
                .help(format!(
                    "off = [\"{name}\"] in stage `{}`, which removes `{body}`",
                    self.name(by)
                )),
            None => fault
                .at(raw.get_ref().surface.span(), "on from the start")
                .help(on.unwrap_or_default()),
        }
    }

    /// Contacts are there in all stages: their bodies must not go. Those that come later have no faces
    /// at the start, from which an aligned contact has its normals.
    pub fn check_contacts(
        &self,
        raw: &[Spanned<RawContact>],
        contacts: &[Contact],
    ) -> Result<(), Fault> {
        for (raw, contact) in raw.iter().zip(contacts) {
            let raw = raw.get_ref();
            let sides = raw.bodies.get_ref().iter().zip(&contact.bodies);
            for (side, (texts, numbers)) in sides.enumerate() {
                for ((named, name), &body) in each(texts).into_iter().zip(numbers) {
                    if let Some((by, place)) = self.removed(self.stages.len() - 1, body) {
                        return Err(Fault::new(format!(
                            "body `{name}` is removed while contact `{}` names it",
                            contact.name
                        ))
                        .at(named, "in contact through all stages")
                        .at(place, format!("stage `{}` removes it", self.name(by)))
                        .help(format!("keep `{name}`, or leave it out of the contact")));
                    }
                    let aligned = side == 0 && contact.surface == ContactSurface::Aligned;
                    if aligned && !self.there[0][body] {
                        let by = self.comes(0, body).unwrap_or_default();
                        return Err(Fault::new(format!(
                            "contact `{}` is aligned, but `{name}` is not there at the start",
                            contact.name
                        ))
                        .at(named, format!("stage `{by}` adds it"))
                        .help(
                            "surface = \"free\": an aligned contact has its normals from the faces \
                             that its first side has at the start",
                        ));
                    }
                }
            }
        }
        Ok(())
    }

    /// What the user should know of bodies that come later.
    pub fn notes(&self) -> impl Iterator<Item = String> + '_ {
        let later = (0..self.bodies.len()).filter(|&b| !self.there[0][b]);
        later.map(|b| {
            let by = self.comes(0, b).unwrap_or_default();
            format!(
                "body `{}` comes later: stage `{by}` adds it",
                self.bodies[b].name
            )
        })
    }
}
