//! Contacts: which bodies slide on each other and part.

use super::amount::{Spanned, each};
use super::error::Fault;
use super::quantity::Dimension;
use super::raw::{RawContact, Text, Texts};
use super::surfaces::unique;
use super::values::{choose, find, fits_a_column, not_negative, placed};
use moldwarp::contact::{ContactError, Fields};
use moldwarp::plan::{Body, Contact, ContactSurface, NamedMaterial, Stage};
use std::ops::Range;

/// A body and where its name stands.
type Placed = (usize, Range<usize>);

pub(super) fn contacts(
    raw: &[Spanned<RawContact>],
    bodies: &[Body],
    (materials, stages): (&[NamedMaterial], &[Stage]),
) -> Result<Vec<Contact>, Fault> {
    check_names(raw)?;
    let rigid = |b: usize| materials[bodies[b].material].model.is_rigid();
    // A stage may make a body plastic.
    let flows = |b: usize| {
        let later = stages.iter().flat_map(|s| &s.materials);
        let later = later.filter(|c| c.0 == b).map(|c| c.1);
        let mut all = later.chain([bodies[b].material]);
        all.any(|m| materials[m].model.is_plastic())
    };
    let mut contacts: Vec<Contact> = Vec::new();
    for item in raw {
        let raw_contact = item.get_ref();
        let sides = sides(&raw_contact.bodies, bodies)?;
        check_rigid(&sides, bodies, rigid)?;
        let sides = sides.map(|side| side.into_iter().map(|b| b.0).collect::<Vec<_>>());
        let friction = raw_contact.friction.as_ref();
        let adhesion = raw_contact.adhesion.as_ref();
        let number = |value: Option<_>, key, dimension| {
            value.map_or(Ok(0.0), |v| not_negative(key, v, dimension))
        };
        let name = match &raw_contact.name {
            Some(name) => name.get_ref().clone(),
            None => default_name(&sides, bodies, (raw, &contacts), &raw_contact.bodies)?,
        };
        contacts.push(Contact {
            name,
            friction: number(friction, "friction", Dimension::Number)?,
            adhesion: number(adhesion, "adhesion", Dimension::Stress)?,
            surface: surface(raw_contact.surface.as_ref())?,
            gap_check: match &raw_contact.gap_check {
                Some(given) => *given.get_ref(),
                // In flowing soil the nearest particle changes as soil passes, and a gap check
                // would switch the contact on and off.
                None => !sides.iter().flatten().any(|&b| flows(b)),
            },
            bodies: sides,
        });
    }
    let fields = Fields::new(bodies.len(), &contacts, rigid);
    check_fields(raw, &contacts, &fields)?;
    Ok(contacts)
}

fn surface(raw: Option<&Text>) -> Result<ContactSurface, Fault> {
    let words = [
        ("aligned", ContactSurface::Aligned),
        ("free", ContactSurface::Free),
    ];
    raw.map_or(Ok(ContactSurface::Free), |word| {
        choose(placed(word), "kind of surface", &words)
    })
}

fn given_names(raw: &[Spanned<RawContact>]) -> impl Iterator<Item = &Text> + Clone {
    raw.iter().filter_map(|c| c.get_ref().name.as_ref())
}

fn check_names(raw: &[Spanned<RawContact>]) -> Result<(), Fault> {
    for (i, name) in given_names(raw).enumerate() {
        fits_a_column("contact", name)?;
        let mut earlier = given_names(raw).take(i);
        if let Some(first) = earlier.find(|n| n.get_ref() == name.get_ref()) {
            return Err(
                Fault::new(format!("two contacts are called `{}`", name.get_ref()))
                    .at(first.span(), "first")
                    .at(name.span(), "second")
                    .help("give each its own name"),
            );
        }
    }
    Ok(())
}

/// `anchor-clay+sand`, with a number if that is taken.
fn default_name(
    sides: &[Vec<usize>; 2],
    bodies: &[Body],
    (raw, earlier): (&[Spanned<RawContact>], &[Contact]),
    place: &Spanned<Vec<Texts>>,
) -> Result<String, Fault> {
    let side = |side: &Vec<usize>| {
        let names: Vec<&str> = side.iter().map(|&b| &*bodies[b].name).collect();
        names.join("+")
    };
    let name = sides.each_ref().map(side).join("-");
    let earlier = earlier.iter().map(|c| c.name.as_str());
    let given = given_names(raw).map(|n| n.get_ref().as_str());
    let name = unique(name, given.chain(earlier));
    match fits_a_column("contact", &Spanned::new(place.span(), name.clone())) {
        Ok(()) => Ok(name),
        Err(fault) => Err(fault.help("give the contact a `name` of letters, digits, `-` and `_`")),
    }
}

/// Both sides: no body twice.
fn sides(raw: &Spanned<Vec<Texts>>, bodies: &[Body]) -> Result<[Vec<Placed>; 2], Fault> {
    let [first, second] = &raw.get_ref()[..] else {
        let count = match raw.get_ref().len() {
            1 => "one side".to_owned(),
            n => format!("{n} sides"),
        };
        return Err(Fault::new("a contact has two sides")
            .at(raw.span(), count)
            .help(
                "for example bodies = [\"a\", \"b\"]; bodies that hang together are a list of their \
                 own: bodies = [\"a\", [\"b\", \"c\"]]",
            ));
    };
    let [first, second] = [side(first, bodies)?, side(second, bodies)?];
    for (body, place) in &second {
        if let Some(other) = first.iter().find(|o| o.0 == *body) {
            return Err(Fault::new(format!(
                "body `{}` is in contact with itself",
                bodies[*body].name
            ))
            .at(other.1.clone(), "on the first side")
            .at(place.clone(), "and on the second")
            .help("leave it out on one side: contact is between different bodies"));
        }
    }
    Ok([first, second])
}

fn side(raw: &Texts, bodies: &[Body]) -> Result<Vec<Placed>, Fault> {
    let mut found: Vec<Placed> = Vec::new();
    for (place, name) in each(raw) {
        let names = bodies.iter().map(|b| b.name.as_str());
        let body = find((place.clone(), name), "body", "bodies", names)?;
        if let Some(first) = found.iter().find(|b| b.0 == body) {
            return Err(Fault::new(format!("body `{name}` is listed twice"))
                .at(first.1.clone(), "here")
                .at(place, "and here")
                .help("leave one of them out"));
        }
        found.push((body, place));
    }
    if found.is_empty() {
        return Err(Fault::new("a side of a contact needs a body")
            .at(raw.span(), "an empty list")
            .help("name a body, or bodies that hang together"));
    }
    Ok(found)
}

/// A rigid body has a velocity of its own.
fn check_rigid(
    sides: &[Vec<Placed>; 2],
    bodies: &[Body],
    rigid: impl Fn(usize) -> bool,
) -> Result<(), Fault> {
    let mut several = sides.iter().filter(|side| side.len() > 1).flatten();
    match several.find(|body| rigid(body.0)) {
        None => Ok(()),
        Some((body, place)) => Err(Fault::new(format!(
            "the rigid body `{}` cannot hang together with others",
            bodies[*body].name
        ))
        .at(place.clone(), "has a velocity of its own")
        .help("give it a contact of its own with the other side")),
    }
}

/// Bodies that hang together have one velocity field, in all contacts; two fields have one contact.
fn check_fields(
    raw: &[Spanned<RawContact>],
    contacts: &[Contact],
    fields: &Fields,
) -> Result<(), Fault> {
    let field = |b: usize| fields.of(b as u16);
    let place = |k: usize| raw[k].get_ref().bodies.span();
    let pair = |contact: &Contact| contact.bodies.each_ref().map(|side| field(side[0]));
    for (k, contact) in contacts.iter().enumerate() {
        let name = &contact.name;
        let [a, b] = pair(contact);
        if a == b {
            let fault = Fault::new(format!("the two sides of contact `{name}` hang together"))
                .at(place(k), "these bodies")
                .help(
                    "bodies of a side hang together in all contacts: list them apart there, or \
                     remove this contact",
                );
            let joins = |c: &Contact| {
                let own = |side: &&Vec<usize>| side.len() > 1 && field(side[0]) == a;
                c.bodies.iter().any(|side| own(&side))
            };
            let others = (0..contacts.len()).filter(|&o| o != k && joins(&contacts[o]));
            return Err(others.fold(fault, |fault, o| {
                let joined = format!("contact `{}` has a side that joins them", contacts[o].name);
                fault.at(place(o), joined)
            }));
        }
        let same = |o: &usize| {
            let other = pair(&contacts[*o]);
            other == [a, b] || other == [b, a]
        };
        if let Some(other) = (0..k).find(same) {
            return Err(Fault::new(format!(
                "contacts `{}` and `{name}` are between the same bodies",
                contacts[other].name
            ))
            .at(place(other), "first")
            .at(place(k), "second")
            .help(
                "keep one of them: two bodies have one friction, and so have those that hang \
                 together",
            ));
        }
    }
    Ok(())
}

/// What the solver found when it set up contacts, if it has a place in the scene: that of the
/// contact's `surface` (by the contact's name).
pub(super) fn explain(error: &ContactError, surfaces: &[(String, Range<usize>)]) -> Option<Fault> {
    let ContactError::NotOnFaces { contact, .. } = error else {
        return None;
    };
    let text = error.to_string();
    let (problem, label) = text.split_once(": ").unwrap_or((&text, "aligned"));
    let fault = Fault::new(problem).help(
        "surface = \"free\" lets bodies meet inside elements; or give the body a `volume` of the \
         mesh, which fills its elements",
    );
    let places = surfaces.iter().filter(|s| s.0 == *contact);
    Some(places.fold(fault, |fault, s| fault.at(s.1.clone(), label)))
}
