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

/// Most particles along an edge of an element: 680 in it.
const MOST: usize = 15;
/// An element's longest edge over the number of particles along it is at most this many spacings: in
/// elements that are not slender the other condition decides.
const ALONG: f64 = 2.0;

/// Barycentric coordinates of the particles of an element, k along an edge. Their mean is the
/// centroid, so that linear fields are integrated exactly; but for a single one quadratics are, too.
pub fn pattern(k: usize) -> Vec<[f64; 4]> {
    let drawn = |corner: [f64; 4], share: f64| corner.map(|n| 0.25 + (n - 0.25) * share);
    let corner = |i: usize| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 });
    let middle =
        |i: usize, k: usize| std::array::from_fn(|j| if i == j || k == j { 0.5 } else { 0.0 });
    match k {
        0 | 1 => vec![[0.25; 4]],
        2 => (0..4).map(|i| drawn(corner(i), FOUR)).collect(),
        3 => {
            let corners = (0..4).map(|i| drawn(corner(i), TEN));
            let edges = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
            corners
                .chain(edges.iter().map(|&(i, k)| drawn(middle(i, k), TEN)))
                .collect()
        }
        _ => {
            let last = k - 1;
            let share = |n: usize| n as f64 / last as f64;
            let mut points = Vec::new();
            for a in 0..k {
                for b in 0..k - a {
                    for c in 0..k - a - b {
                        points.push([a, b, c, last - a - b - c].map(share));
                    }
                }
            }
            // ∫ (λ − 1/4)² is 3/80 of the volume.
            let spread = points.iter().map(|n| (n[0] - 0.25).powi(2)).sum::<f64>();
            let share = (3.0 / 80.0 * points.len() as f64 / spread).sqrt();
            points.into_iter().map(|n| drawn(n, share)).collect()
        }
    }
}

impl Seeding {
    /// Particles along an edge of element `e`; none if they would be too many.
    fn along_an_edge(&self, mesh: &Mesh, e: usize) -> Option<usize> {
        let spacing = match self {
            Seeding::One => return Some(1),
            Seeding::Four => return Some(2),
            Seeding::Ten => return Some(3),
            Seeding::Spacing(spacing) => spacing.at(mesh.centroid(e)),
        };
        let corners = mesh.corners(e);
        let edge = |i: usize, j: usize| (corners[i] - corners[j]).length();
        let edges = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
        let longest = edges
            .map(|(i, j)| edge(i, j))
            .into_iter()
            .fold(0.0, f64::max);
        let wanted = mesh.volumes[e] / spacing.powi(3);
        let enough = |k: &usize| {
            (k * (k + 1) * (k + 2) / 6) as f64 >= wanted && longest / *k as f64 <= ALONG * spacing
        };
        // Fewer than four would not know of a bent element's stresses.
        (2..=MOST).find(enough)
    }
}

/// Why bodies could not be filled.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum SeedingError {
    #[error("body `{body}` has no particles: its region holds no seeding point of any element")]
    Empty { body: String },
    #[error(
        "body `{body}` would need more than {most} particles in element {element} (counted from 0) for \
         its particle spacing"
    )]
    TooMany {
        body: String,
        element: u32,
        most: usize,
    },
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
    /// Particles along an edge, and the number of the point of this [`pattern`].
    along: u8,
    point: u16,
}

crate::saved!(Seed {
    id,
    body,
    element,
    along,
    point
});

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
        fill(mesh, body, b as u16, &mut found)?;
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
    seeds: impl Iterator<Item = Seed> + Clone,
    mesh: &Mesh,
    bodies: &[Body],
    materials: &[NamedMaterial],
) -> Particles {
    let patterns: Vec<_> = (0..=MOST).map(pattern).collect();
    let mut particles = Particles::with_capacity(seeds.clone().count());
    for seed in seeds {
        let (body, rule) = (usize::from(seed.body), &patterns[usize::from(seed.along)]);
        let element = seed.element as usize;
        let volume = mesh.volumes[element] / rule.len() as f64;
        let position = point(&rule[usize::from(seed.point)], &mesh.corners(element));
        particles.id.push(seed.id);
        particles.body.push(seed.body);
        particles.element.push(seed.element);
        particles.position.push(position);
        particles.velocity.push(Vec3::ZERO);
        particles.origin.push(position);
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

fn fill(mesh: &Mesh, body: &Body, number: u16, found: &mut Vec<Seed>) -> Result<(), SeedingError> {
    let patterns: Vec<_> = (0..=MOST).map(pattern).collect();
    let mut seed_element = |element: u32, wanted: &dyn Fn(Vec3) -> bool| {
        let corners = mesh.corners(element as usize);
        let along = match body.seeding.along_an_edge(mesh, element as usize) {
            Some(along) => along,
            None if corners.iter().any(|&x| wanted(x)) => {
                return Err(SeedingError::TooMany {
                    body: body.name.clone(),
                    element,
                    most: patterns[MOST].len(),
                });
            }
            None => return Ok(()),
        };
        let inside = patterns[along].iter().enumerate();
        let inside = inside.filter(|(_, n)| wanted(point(n, &corners)));
        found.extend(inside.map(|(point, _)| Seed {
            id: 0,
            body: number,
            element,
            along: along as u8,
            point: point as u16,
        }));
        Ok(())
    };
    match &body.place {
        Place::Volumes(groups) => {
            let groups = groups.iter().map(|&g| &mesh.volume_groups[g]);
            let mut elements = groups.flat_map(|g| g.elements.iter().copied());
            elements.try_for_each(|e| seed_element(e, &|_| true))
        }
        Place::Region(region) => {
            (0..mesh.tets.len() as u32).try_for_each(|e| seed_element(e, &|x| region.contains(x)))
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
        let body = &particles.body[range.clone()];
        let Some(other) = body.iter().find(|&&b| b != body[0]) else {
            continue;
        };
        let position: Vec<Vec3> = range.clone().map(|p| particles.position.at(p)).collect();
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
    use crate::plan::Spacing;

    /// ∫ λ_a λ_b over a tetrahedron of volume 1 is 1/10 for a = b and 1/20 otherwise.
    #[test]
    fn patterns_integrate_quadratics() {
        for k in 2..=MOST {
            let points = pattern(k);
            assert_eq!(points.len(), k * (k + 1) * (k + 2) / 6);
            let mean = |f: &dyn Fn(&[f64; 4]) -> f64| {
                points.iter().map(f).sum::<f64>() / points.len() as f64
            };
            assert!((mean(&|n| n[1]) - 0.25).abs() < 1e-14);
            assert!((mean(&|n| n[2] * n[2]) - 0.1).abs() < 1e-14);
            assert!((mean(&|n| n[0] * n[3]) - 0.05).abs() < 1e-14);
            assert!(points.iter().flatten().all(|&n| n > 0.0), "inside");
        }
        assert_eq!(pattern(1), [[0.25; 4]]);
    }

    /// Particles lie at most as far from each other as their spacing at that distance says.
    #[test]
    fn spacing_is_graded_by_the_distance_from_a_line() {
        let mesh = crate::mesh::box_mesh(Vec3::new(4.0, 1.0, 1.0), [4, 1, 1]).unwrap();
        let spacing = Spacing {
            start: Vec3::ZERO,
            end: Vec3::Z,
            points: vec![[0.5, 0.1], [3.5, 0.5]],
        };
        assert_eq!(spacing.at(Vec3::new(0.3, 0.0, 0.5)), 0.1);
        assert!((spacing.at(Vec3::new(2.0, 0.0, 0.5)) - 0.3).abs() < 1e-15);
        assert_eq!(spacing.at(Vec3::new(0.0, 9.0, 0.5)), 0.5);
        let seeding = Seeding::Spacing(spacing);
        for e in 0..mesh.tets.len() {
            let k = seeding.along_an_edge(&mesh, e).unwrap();
            let Seeding::Spacing(spacing) = &seeding else {
                unreachable!()
            };
            let wanted = spacing.at(mesh.centroid(e));
            let each = mesh.volumes[e] / pattern(k).len() as f64;
            assert!(each.cbrt() <= wanted);
            assert!(each.cbrt() > 0.4 * wanted || k == 2);
        }
        let far = Spacing {
            start: Vec3::ZERO,
            end: Vec3::ZERO,
            points: vec![[0.0, 0.01]],
        };
        assert_eq!(Seeding::Spacing(far).along_an_edge(&mesh, 0), None);
    }
}
