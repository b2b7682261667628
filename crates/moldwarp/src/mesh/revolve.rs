//! A sector of a body of revolution from a plane mesh of its meridian.
//!
//! Triangles in the half plane r ≥ 0 become prisms about the axis z, from θ = 0 (the plane of x and
//! z) to the angle, and each prism three tetrahedra. A quadrangle between two nodes of the meridian is
//! cut from the lower end of the one with the lower number to the upper end of the other: so
//! neighbours cut it alike, and no prism is cut in a way that cannot be filled. On the axis prisms
//! shrink to pyramids and tetrahedra.

use super::RawMesh;
use crate::Vec3;

/// Nodes closer to the axis than this share of the greatest radius are on it.
const ON_THE_AXIS: f64 = 1e-9;

/// A mesh of triangles in the half plane of a meridian.
#[derive(Clone, Debug, Default)]
pub struct PlaneMesh {
    /// Radius and height, m.
    pub nodes: Vec<[f64; 2]>,
    /// Three nodes each, in any order.
    pub triangles: Vec<[u32; 3]>,
    /// Name and triangles of what will be volumes.
    pub areas: Vec<(String, Vec<u32>)>,
    /// Name and lines, two nodes each, of what will be surfaces. Lines on the axis will be none.
    pub lines: Vec<(String, Vec<[u32; 2]>)>,
}

/// A plane mesh, revolved.
#[derive(Clone, Debug, Default)]
pub struct Revolved {
    /// Its first surfaces are `theta-min` and `theta-max`.
    pub raw: RawMesh,
    /// The plane mesh's node of each node.
    pub node_origins: Vec<u32>,
    /// The plane mesh's triangle of each tetrahedron.
    pub tet_origins: Vec<u32>,
}

impl PlaneMesh {
    /// Revolves by `angle` (radians, less than π/2 for each layer) in `layers` layers.
    pub fn revolve(&self, angle: f64, layers: usize) -> Revolved {
        let farthest = self.nodes.iter().map(|n| n[0]).fold(0.0, f64::max);
        let on_axis = |n: usize| self.nodes[n][0] <= ON_THE_AXIS * farthest;
        let mut revolved = Revolved::default();
        // Numbers of the nodes by layer; those on the axis are the same in all.
        let mut numbers: Vec<Vec<u32>> = Vec::new();
        for layer in 0..=layers {
            let theta = angle * layer as f64 / layers as f64;
            let (sine, cosine) = match layer {
                0 => (0.0, 1.0),
                _ => (libm::sin(theta), libm::cos(theta)),
            };
            let mut own = Vec::with_capacity(self.nodes.len());
            for (n, &[r, z]) in self.nodes.iter().enumerate() {
                if on_axis(n) && layer > 0 {
                    own.push(numbers[0][n]);
                    continue;
                }
                own.push(revolved.raw.nodes.len() as u32);
                let r = if on_axis(n) { 0.0 } else { r };
                revolved.raw.nodes.push(Vec3::new(r * cosine, r * sine, z));
                revolved.node_origins.push(n as u32);
            }
            numbers.push(own);
        }
        let mut tets_of = Vec::with_capacity(self.triangles.len());
        for (number, triangle) in self.triangles.iter().enumerate() {
            let first = revolved.raw.tets.len() as u32;
            for pair in numbers.windows(2) {
                for tet in prism(*triangle, &pair[0], &pair[1]) {
                    revolved.raw.tets.push(oriented(tet, &revolved.raw.nodes));
                    revolved.tet_origins.push(number as u32);
                }
            }
            tets_of.push(first..revolved.raw.tets.len() as u32);
        }
        let volume = |(name, triangles): &(String, Vec<u32>)| {
            let tets = triangles.iter().flat_map(|&t| tets_of[t as usize].clone());
            (name.clone(), tets.collect())
        };
        revolved.raw.volume_groups = self.areas.iter().map(volume).collect();
        for (name, layer) in [("theta-min", 0), ("theta-max", layers)] {
            let own = |t: &[u32; 3]| t.map(|n| numbers[layer][n as usize]);
            let triangles = self.triangles.iter().map(own).collect();
            revolved
                .raw
                .surface_groups
                .push((name.to_owned(), triangles));
        }
        for (name, lines) in &self.lines {
            let mut triangles = Vec::new();
            for (line, pair) in lines
                .iter()
                .flat_map(|l| numbers.windows(2).map(move |p| (l, p)))
            {
                triangles.extend(quadrangle(*line, &pair[0], &pair[1]));
            }
            revolved.raw.surface_groups.push((name.clone(), triangles));
        }
        revolved
    }
}

/// The tetrahedra of a prism, without those that have shrunk to nothing on the axis.
fn prism(mut triangle: [u32; 3], low: &[u32], high: &[u32]) -> impl Iterator<Item = [u32; 4]> {
    triangle.sort_unstable();
    let [a, b, c] = triangle.map(|n| n as usize);
    let all = [
        [low[a], low[b], low[c], high[c]],
        [low[a], low[b], high[b], high[c]],
        [low[a], high[a], high[b], high[c]],
    ];
    all.into_iter().filter(|tet| distinct(tet))
}

/// The triangles of a quadrangle, cut as prisms cut it.
fn quadrangle(mut line: [u32; 2], low: &[u32], high: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    line.sort_unstable();
    let [a, b] = line.map(|n| n as usize);
    let all = [[low[a], low[b], high[b]], [low[a], high[a], high[b]]];
    all.into_iter().filter(|triangle| distinct(triangle))
}

fn distinct(nodes: &[u32]) -> bool {
    (1..nodes.len()).all(|i| !nodes[..i].contains(&nodes[i]))
}

fn oriented(tet: [u32; 4], nodes: &[Vec3]) -> [u32; 4] {
    let [a, b, c, d] = tet.map(|n| nodes[n as usize]);
    let [i, j, k, l] = tet;
    if (b - a).cross(c - a).dot(d - a) < 0.0 {
        [j, i, k, l]
    } else {
        tet
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;

    /// A rectangle 0 ≤ r ≤ 2, 0 ≤ z ≤ 1 of 2 × 1 squares with diagonals both ways; the nodes are
    /// numbered without order. Layers of half the angle hold twice ½ sin(α/2) r² h.
    #[test]
    fn a_rectangle_becomes_a_sector_of_a_cylinder() {
        let nodes = vec![
            [2.0, 1.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [2.0, 0.0],
            [0.0, 1.0],
            [1.0, 0.0],
        ];
        let plane = PlaneMesh {
            nodes,
            triangles: vec![[1, 5, 2], [1, 2, 4], [5, 3, 2], [3, 0, 2]],
            areas: vec![("core".into(), vec![0, 1]), ("ring".into(), vec![2, 3])],
            lines: vec![
                ("top".into(), vec![[4, 2], [2, 0]]),
                ("r-max".into(), vec![[0, 3]]),
                ("axis".into(), vec![[1, 4]]),
            ],
        };
        let angle = 0.5;
        let revolved = plane.revolve(angle, 2);
        assert_eq!(revolved.raw.nodes.len(), 2 + 3 * 4);
        assert_eq!(revolved.raw.tets.len(), 2 * (3 + 6));
        let volume_of = |t: u32| revolved.tet_origins.iter().filter(|&&o| o == t).count();
        assert_eq!((0..4).map(volume_of).collect::<Vec<_>>(), [4, 2, 6, 6]);
        let mesh = Mesh::new(revolved.raw).unwrap();
        let expected = libm::sin(angle / 2.0) * 4.0;
        assert!((mesh.total_volume() - expected).abs() < 1e-14);
        let area = |name: &str| {
            let faces = &mesh.surfaces[mesh.surface(name).unwrap()].faces;
            faces
                .iter()
                .map(|&f| mesh.face_area(f).length())
                .sum::<f64>()
        };
        assert!((area("top") - expected).abs() < 1e-14);
        assert!((area("theta-max") - 2.0).abs() < 1e-14);
        assert!((area("r-max") - 2.0 * 4.0 * libm::sin(angle / 4.0)).abs() < 1e-14);
        assert_eq!(area("axis"), 0.0);
    }
}
