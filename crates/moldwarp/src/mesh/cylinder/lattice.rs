//! The nodes of a sector, by their places on a lattice.
//!
//! A place counts half cells: [radial, around, vertical], so that corners of cells have even numbers
//! and the middle of a cell or of a face has odd ones. Nodes are made when they are asked for.

use super::CylinderSector;
use crate::Vec3;
use crate::mesh::NONE;

/// A place in half cells from the inside, from θ = 0 and from the bottom.
pub(super) type Place = [usize; 3];

pub(super) struct Lattice {
    /// Number of cells in each direction.
    pub cells: [usize; 3],
    /// Whether the innermost places are the axis, whatever θ is.
    pub solid: bool,
    /// Share of the way from the inside to the outside.
    shares: Vec<f64>,
    /// cos θ and sin θ.
    directions: Vec<[f64; 2]>,
    levels: Vec<Level>,
    /// Node of each place, or [`NONE`].
    numbers: Vec<u32>,
    pub nodes: Vec<Vec3>,
    /// Place of each node.
    pub places: Vec<Place>,
}

/// What the profile is at one height, m.
struct Level {
    inner: f64,
    outer: f64,
    z: f64,
}

impl Lattice {
    pub fn new(sector: &CylinderSector) -> Lattice {
        let levels = levels(sector);
        let cells = [sector.radial, sector.around, levels.len() - 1];
        let directions = (0..=cells[1]).map(|j| {
            let theta = sector.angle * j as f64 / cells[1] as f64;
            // At right angles the planes are to lie on the axes exactly.
            [libm::cos(theta), libm::sin(theta)].map(|x| if x.abs() < 1e-15 { 0.0 } else { x })
        });
        Lattice {
            solid: levels[0].inner == 0.0,
            shares: progression(cells[0], sector.radial_grading),
            directions: directions.collect(),
            levels,
            numbers: vec![NONE; cells.iter().map(|n| 2 * n + 1).product()],
            nodes: Vec::new(),
            places: Vec::new(),
            cells,
        }
    }

    /// The node at a place, which is made if it is not there yet.
    pub fn node(&mut self, place: Place) -> u32 {
        let place = self.on_axis(place);
        let [ni, nj, _] = self.cells.map(|n| 2 * n + 1);
        let index = (place[2] * nj + place[1]) * ni + place[0];
        if self.numbers[index] == NONE {
            self.numbers[index] = self.nodes.len() as u32;
            self.nodes.push(self.position(place));
            self.places.push(place);
        }
        self.numbers[index]
    }

    /// Places on the axis are one for all θ.
    fn on_axis(&self, place: Place) -> Place {
        match place {
            [0, _, k] if self.solid => [0, 0, k],
            other => other,
        }
    }

    /// A corner's own position, else the mean of the corners of the face or cell around.
    fn position(&self, place: Place) -> Vec3 {
        let mut corners = vec![place];
        for d in 0..3 {
            if place[d] % 2 == 1 {
                let ends = |mut c: Place, n| {
                    c[d] = n;
                    c
                };
                let both = |&c: &Place| [ends(c, c[d] - 1), ends(c, c[d] + 1)];
                corners = corners.iter().flat_map(both).collect();
            }
        }
        corners.iter_mut().for_each(|c| *c = self.on_axis(*c));
        corners.sort_unstable();
        corners.dedup();
        let sum: Vec3 = corners.iter().map(|&c| self.corner(c)).sum();
        sum / corners.len() as f64
    }

    fn corner(&self, place: Place) -> Vec3 {
        let [i, j, k] = place.map(|n| n / 2);
        let (level, share) = (&self.levels[k], self.shares[i]);
        let r = level.inner * (1.0 - share) + level.outer * share;
        let [cos, sin] = self.directions[j];
        Vec3::new(r * cos, r * sin, level.z)
    }
}

fn levels(sector: &CylinderSector) -> Vec<Level> {
    let inner = |point: usize| sector.inner.as_ref().map_or(0.0, |inner| inner[point][0]);
    let level = |s: usize, share: f64| {
        let between = |a: f64, b: f64| a * (1.0 - share) + b * share;
        let [low, high] = [sector.outer[s], sector.outer[s + 1]];
        Level {
            inner: between(inner(s), inner(s + 1)),
            outer: between(low[0], high[0]),
            z: between(low[1], high[1]),
        }
    };
    let mut levels = vec![level(0, 0.0)];
    for s in 0..sector.segments() {
        let cells = sector.vertical[s.min(sector.vertical.len() - 1)];
        let grading = sector.vertical_grading[s.min(sector.vertical_grading.len() - 1)];
        let shares = progression(cells, grading);
        levels.extend(shares[1..].iter().map(|&share| level(s, share)));
    }
    levels
}

/// The ends of `cells` sizes in geometric progression over a length of 1, the last `grading` times
/// the first: 0, …, 1.
pub(super) fn progression(cells: usize, grading: f64) -> Vec<f64> {
    if grading == 1.0 || cells == 1 {
        return (0..=cells).map(|i| i as f64 / cells as f64).collect();
    }
    let size = |i: usize| libm::pow(grading, i as f64 / (cells - 1) as f64);
    let mut ends = vec![0.0];
    for i in 0..cells {
        ends.push(ends[i] + size(i));
    }
    let whole = ends[cells];
    ends.iter().map(|end| end / whole).collect()
}
