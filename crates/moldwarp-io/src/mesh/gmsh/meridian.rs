//! What has been read, put together to the plane mesh of a meridian.

use super::super::{GmshProblem, PlaneFile};
use super::assembly::Assembly;
use moldwarp::mesh::PlaneMesh;
use std::collections::HashMap;

type Checked<T> = std::result::Result<T, GmshProblem>;

impl Assembly {
    /// The plane mesh of a meridian; `command` is what makes one in two dimensions.
    pub(super) fn finish_plane(mut self, command: String) -> Checked<PlaneFile> {
        if !self.tets.is_empty() {
            return Err(GmshProblem::NotPlane);
        }
        if self.triangles.is_empty() {
            return Err(GmshProblem::NoTriangles { command });
        }
        self.check_names(2, "surface", self.triangles.keys())?;
        self.check_names(1, "curve", self.lines.keys())?;
        let mut notes = Vec::new();
        self.drop_unused_nodes(&mut notes);
        let nodes = self.in_the_plane()?;
        self.check_triangles(&nodes)?;
        let (mut triangles, mut areas) = (Vec::new(), Vec::new());
        let mut seen: HashMap<[u32; 3], u64> = HashMap::new();
        for (&group, own) in &self.triangles {
            let first = triangles.len() as u32;
            for &triangle in &own.list {
                let mut key = triangle;
                key.sort_unstable();
                if let Some(other) = seen.insert(key, group) {
                    let [first, second] = [other, group].map(|g| self.group_name(2, g));
                    return Err(GmshProblem::TwoAreas { first, second });
                }
                triangles.push(triangle);
            }
            let own = (first..triangles.len() as u32).collect();
            areas.push((self.group_name(2, group), own));
        }
        let lines = self.lines.iter();
        let lines = lines.map(|(&g, lines)| (self.group_name(1, g), lines.clone()));
        Ok(PlaneFile {
            plane: PlaneMesh {
                nodes,
                triangles,
                areas,
                lines: lines.collect(),
            },
            node_tags: self.node_tags,
            notes,
        })
    }

    /// Radius and height of the nodes: x and z in the plane y = 0, or x and y in the plane z = 0.
    fn in_the_plane(&self) -> Checked<Vec<[f64; 2]>> {
        let size = self.nodes.iter().map(|x| x.abs().max_element());
        let tolerance = 1e-9 * size.fold(0.0, f64::max);
        let flat = |d: usize| self.nodes.iter().position(|x| x[d].abs() > tolerance);
        let height = match (flat(1), flat(2)) {
            (None, _) => 2,
            (_, None) => 1,
            (Some(n), _) => return Err(GmshProblem::OutOfPlane(self.node_tags[n])),
        };
        if let Some(n) = self.nodes.iter().position(|x| x.x < -tolerance) {
            return Err(GmshProblem::NegativeRadius(self.node_tags[n]));
        }
        Ok(self.nodes.iter().map(|x| [x.x, x[height]]).collect())
    }

    /// Triangles must have an area, and those that share an edge lie on either side of it; lines must
    /// be edges of triangles, if they are not on the axis, where they come to nothing.
    fn check_triangles(&self, nodes: &[[f64; 2]]) -> Checked<()> {
        let tags = |corners: &[u32]| {
            corners
                .iter()
                .map(|&n| self.node_tags[n as usize])
                .collect()
        };
        // Twice the area, positive if the corners are counted anticlockwise.
        let area = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|n| nodes[n as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let length = |[a, b]: [u32; 2]| {
            let [a, b] = [a, b].map(|n| nodes[n as usize]);
            (b[0] - a[0]).hypot(b[1] - a[1])
        };
        // How each edge is passed through by the triangles on its sides: once up, once down.
        let mut edges: HashMap<[u32; 2], [Option<[u32; 3]>; 2]> = HashMap::new();
        for &triangle in self.triangles.values().flat_map(|t| &t.list) {
            let [a, b, c] = triangle;
            let longest = [[a, b], [b, c], [c, a]].map(length);
            let longest = longest.into_iter().fold(0.0, f64::max);
            let twice = area(triangle);
            if twice.abs() <= 1e-12 * longest * longest {
                return Err(GmshProblem::FlatTriangle {
                    nodes: tags(&triangle),
                });
            }
            let [b, c] = if twice > 0.0 { [b, c] } else { [c, b] };
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let key = [from.min(to), from.max(to)];
                let sides = edges.entry(key).or_default();
                let side = &mut sides[usize::from(from < to)];
                if let Some(other) = side.replace(triangle).filter(|o| !same(o, &triangle)) {
                    return Err(GmshProblem::TrianglesOverlap {
                        first: tags(&other),
                        second: tags(&triangle),
                    });
                }
            }
        }
        for (&group, lines) in &self.lines {
            let on_the_axis = |n: &u32| nodes[*n as usize][0] == 0.0;
            let known = |&[a, b]: &[u32; 2]| edges.contains_key(&[a.min(b), a.max(b)]);
            let mut lines = lines.iter().filter(|l| !l.iter().all(on_the_axis));
            if let Some(line) = lines.find(|l| !known(l)) {
                return Err(GmshProblem::NoEdge {
                    curve: self.group_name(1, group),
                    nodes: tags(line),
                });
            }
        }
        Ok(())
    }
}

/// A triangle in two areas is another fault, which is told as such.
fn same(a: &[u32; 3], b: &[u32; 3]) -> bool {
    a.iter().all(|n| b.contains(n))
}
