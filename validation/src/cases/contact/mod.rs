//! Bodies that touch, slide and part.

pub mod drop;
pub mod penetration;
pub mod sliding_block;
pub mod spheres;
pub mod stack;
pub mod unstructured;

use moldwarp::plan::{Body, Contact, ContactSurface, Place, Region, Seeding};
use moldwarp::{Simulation, Vec3};

/// A body of the first material.
pub(in crate::cases) fn body(name: &str, region: Region) -> Body {
    Body {
        name: name.to_owned(),
        place: Place::Region(region),
        material: 0,
        seeding: Seeding::Four,
    }
}

/// A contact without adhesion between two bodies, with the gap check.
pub(in crate::cases) fn contact(
    bodies: [usize; 2],
    friction: f64,
    surface: ContactSurface,
) -> Contact {
    Contact {
        name: format!("{}-{}", bodies[0], bodies[1]),
        bodies: bodies.map(|b| vec![b]),
        friction,
        adhesion: 0.0,
        surface,
        gap_check: true,
    }
}

/// Mean of a particle's vector over a body, by mass.
fn mean(s: &Simulation, body: u16, of: impl Fn(usize) -> Vec3) -> Vec3 {
    let p = s.particles();
    let (mut sum, mut mass) = (Vec3::ZERO, 0.0);
    for i in (0..p.len()).filter(|&i| p.body[i] == body) {
        sum += p.mass[i] * of(i);
        mass += p.mass[i];
    }
    sum / mass
}
