//! Filling bodies with particles of equal volume in each element.

use super::Particles;
use crate::Vec3;
use crate::mesh::Mesh;
use crate::plan::{Body, NamedMaterial, Place, Seeding};

/// Distance from centroid to corner at which the four-point rule, exact for quadratics, sits:
/// barycentric coordinates (1+3s)/4 and (1−s)/4 thrice, s = 1/√5.
const FOUR: f64 = 0.447_213_595_499_957_9;
/// The ten nodes of a quadratic tetrahedron drawn towards the centroid by 1/√3: with equal
/// weights they integrate quadratics exactly.
const TEN: f64 = 0.577_350_269_189_625_8;

impl Seeding {
    /// Barycentric coordinates of the particles of an element. Their mean is the centroid, so
    /// that linear fields are integrated exactly.
    pub fn points(self) -> Vec<[f64; 4]> {
        let drawn = |corner: [f64; 4], share: f64| corner.map(|n| 0.25 + (n - 0.25) * share);
        let corner = |i: usize| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 });
        let middle =
            |i: usize, k: usize| std::array::from_fn(|j| if i == j || k == j { 0.5 } else { 0.0 });
        match self {
            Seeding::One => vec![[0.25; 4]],
            Seeding::Four => (0..4).map(|i| drawn(corner(i), FOUR)).collect(),
            Seeding::Ten => {
                let corners = (0..4).map(|i| drawn(corner(i), TEN));
                let edges = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
                corners
                    .chain(edges.iter().map(|&(i, k)| drawn(middle(i, k), TEN)))
                    .collect()
            }
        }
    }
}

/// Why bodies could not be filled.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum SeedingError {
    #[error("body `{body}` has no particles: its region holds no seeding point of any element")]
    Empty { body: String },
    #[error("bodies `{first}` and `{second}` overlap in element {element}")]
    Overlap {
        first: String,
        second: String,
        element: u32,
    },
}

/// A particle to be. Its place is one in its element, wherever the mesh has moved by the time that it
/// is made.
#[derive(Clone, Copy, Debug)]
pub struct Seed {
    pub id: u32,
    pub body: u16,
    pub element: u32,
    /// Number of the point of the body's [`Seeding::points`].
    point: u8,
}

/// The seeds of all bodies that are to have any in the mesh at the start, ordered by element. So every particle has its id
/// before there is any, whenever its body comes.
pub fn seeds(
    mesh: &Mesh,
    bodies: &[Body],
    wanted: impl Fn(usize) -> bool,
) -> Result<Vec<Seed>, SeedingError> {
    let mut found = Vec::new();
    for (b, body) in bodies.iter().enumerate().filter(|b| wanted(b.0)) {
        let before = found.len();
        fill(mesh, body, b as u16, &mut found);
        if found.len() == before {
            return Err(SeedingError::Empty {
                body: body.name.clone(),
            });
        }
    }
    found.sort_by_key(|s| (s.element, s.body));
    for (id, seed) in found.iter_mut().enumerate() {
        seed.id = id as u32;
    }
    Ok(found)
}

/// Particles at rest and free of stress at seeds, in their order.
pub fn particles(
    seeds: &[Seed],
    mesh: &Mesh,
    bodies: &[Body],
    materials: &[NamedMaterial],
) -> Particles {
    let rules: Vec<_> = bodies.iter().map(|b| b.seeding.points()).collect();
    let mut particles = Particles::default();
    for seed in seeds {
        let (body, rule) = (usize::from(seed.body), &rules[usize::from(seed.body)]);
        let element = seed.element as usize;
        let volume = mesh.volumes[element] / rule.len() as f64;
        let position = point(&rule[usize::from(seed.point)], &mesh.corners(element));
        particles.id.push(seed.id);
        particles.body.push(seed.body);
        particles.element.push(seed.element);
        particles.position.push(position);
        particles.velocity.push(Vec3::ZERO);
        particles.displacement.push(Vec3::ZERO);
        particles.stress.push([0.0; 6]);
        particles.state.push(Default::default());
        particles.volume.push(volume);
        particles.initial_volume.push(volume);
        let density = materials[bodies[body].material].density;
        particles.mass.push(density * volume);
    }
    particles
}

fn point(n: &[f64; 4], corners: &[Vec3; 4]) -> Vec3 {
    (0..4).map(|i| n[i] * corners[i]).sum()
}

fn fill(mesh: &Mesh, body: &Body, number: u16, found: &mut Vec<Seed>) {
    let rule = body.seeding.points();
    let mut seed_element = |element: u32, wanted: &dyn Fn(Vec3) -> bool| {
        let corners = mesh.corners(element as usize);
        let inside = rule.iter().enumerate();
        let inside = inside.filter(|(_, n)| wanted(point(n, &corners)));
        found.extend(inside.map(|(point, _)| Seed {
            id: 0,
            body: number,
            element,
            point: point as u8,
        }));
    };
    match &body.place {
        Place::VolumeGroup(group) => {
            let elements = &mesh.volume_groups[*group].elements;
            elements.iter().for_each(|&e| seed_element(e, &|_| true));
        }
        Place::Region(region) => {
            (0..mesh.tets.len() as u32).for_each(|e| seed_element(e, &|x| region.contains(x)));
        }
    }
}

/// Two bodies overlap where both have a particle at the same point, or more volume than the element
/// has. `particles` are ordered by element.
pub fn check_overlap(
    particles: &Particles,
    bodies: &[Body],
    mesh: &Mesh,
) -> Result<(), SeedingError> {
    let mut end = 0;
    for same in particles.element.chunk_by(|a, b| a == b) {
        let range = end..end + same.len();
        end = range.end;
        let (body, position) = (
            &particles.body[range.clone()],
            &particles.position[range.clone()],
        );
        let Some(other) = body.iter().find(|&&b| b != body[0]) else {
            continue;
        };
        let volume: f64 = particles.volume[range].iter().sum();
        let twice = |i: usize| position[..i].contains(&position[i]);
        if volume > mesh.volumes[same[0] as usize] * (1.0 + 1e-9) || (0..same.len()).any(twice) {
            return Err(SeedingError::Overlap {
                first: bodies[usize::from(body[0])].name.clone(),
                second: bodies[usize::from(*other)].name.clone(),
                element: same[0],
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ λ_a λ_b over a tetrahedron of volume 1 is 1/10 for a = b and 1/20 otherwise.
    #[test]
    fn four_and_ten_points_integrate_quadratics() {
        for rule in [Seeding::Four, Seeding::Ten] {
            let points = rule.points();
            let mean = |f: &dyn Fn(&[f64; 4]) -> f64| {
                points.iter().map(f).sum::<f64>() / points.len() as f64
            };
            assert!((mean(&|n| n[1]) - 0.25).abs() < 1e-15);
            assert!((mean(&|n| n[2] * n[2]) - 0.1).abs() < 1e-15);
            assert!((mean(&|n| n[0] * n[3]) - 0.05).abs() < 1e-15);
        }
        assert_eq!(Seeding::One.points(), [[0.25; 4]]);
    }
}
