//! Fixities, rollers and prescribed velocities, gathered per node.

use super::Function;
use crate::mesh::{Mesh, NONE};
use crate::plan::{Boundary, BoundaryKind};
use crate::{Mat3, Vec3};

/// Roller faces of a node whose normals differ by less than this count as one smooth surface.
const SMOOTH_COSINE: f64 = 0.866_025_403_784_438_6; // 30°
/// Components of a unit normal below this are round-off of the nodes' coordinates.
const ROUND_OFF: f64 = 1e-12;

/// A direction in which a node's velocity is given.
#[derive(Clone, Debug)]
struct Held {
    direction: Vec3,
    /// Speed along it, m/s, by boundary whose function scales it.
    speed: Vec<(f64, usize)>,
}

/// What holds one node.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// Mesh node.
    pub node: u32,
    /// Projects a vector into the directions that are left free.
    pub free: Mat3,
    held: Vec<Held>,
    /// Whether any direction has a speed. (Most have none, and what is held lies elsewhere in memory.)
    moves: bool,
}

crate::saved!(Held { direction, speed });
crate::saved!(Constraint {
    node,
    free,
    held,
    moves
});
crate::saved!(Constraints {
    all,
    of_node,
    functions,
    values,
    previous,
    first,
});

impl Constraint {
    fn velocity(&self, functions: &[f64]) -> Vec3 {
        if !self.moves {
            return Vec3::ZERO;
        }
        let speed = |held: &Held| {
            held.speed
                .iter()
                .map(|&(v, f)| v * functions[f])
                .sum::<f64>()
        };
        self.held
            .iter()
            .map(|held| held.direction * speed(held))
            .sum()
    }
}

/// All constrained nodes of a mesh.
#[derive(Clone, Debug, Default)]
pub struct Constraints {
    pub all: Vec<Constraint>,
    /// Index into `all` for each mesh node, or [`NONE`].
    of_node: Vec<u32>,
    /// Functions of the prescribed velocities.
    functions: Vec<Function>,
    /// Their values at the time that was set last, and the one before.
    values: Vec<f64>,
    previous: Vec<f64>,
    /// Whether nothing was prescribed before.
    first: bool,
}

impl Constraints {
    /// Gathers the boundaries of each node. Single directions are held first, then rollers in the
    /// order of the scene; what a direction shares with those before it is left out.
    pub fn new(mesh: &Mesh, boundaries: &[&Boundary]) -> Constraints {
        // Speed and function of each direction that is given.
        type Components = [Option<(f64, usize)>; 3];
        let mut axes: Vec<(u32, Components)> = Vec::new();
        let mut functions = vec![Function::Constant];
        for boundary in boundaries {
            let components = match &boundary.kind {
                BoundaryKind::Fixed { directions } => directions.map(|d| d.then_some((0.0, 0))),
                BoundaryKind::Prescribed { velocity, function } => {
                    functions.push(function.clone());
                    velocity.map(|v| v.map(|v| (v, functions.len() - 1)))
                }
                BoundaryKind::Roller | BoundaryKind::Absorbing { .. } | BoundaryKind::Outflow => {
                    continue;
                }
            };
            axes.extend(
                surface_nodes(mesh, &boundary.surfaces)
                    .into_iter()
                    .map(|n| (n, components)),
            );
        }
        let mut constraints = Constraints {
            of_node: vec![NONE; mesh.nodes.len()],
            values: vec![1.0; functions.len()],
            previous: vec![1.0; functions.len()],
            first: true,
            functions,
            all: Vec::new(),
        };
        for (node, components) in axes {
            for (d, component) in components.iter().enumerate() {
                if let &Some((speed, function)) = component {
                    constraints.hold(node, Vec3::AXES[d], speed, function);
                }
            }
        }
        for (node, normals) in roller_normals(mesh, boundaries) {
            normals
                .into_iter()
                .for_each(|n| constraints.hold(node, n, 0.0, 0));
        }
        constraints
    }

    /// Sets the time, s, at which prescribed velocities are asked for from now on. `first`: what
    /// was prescribed before does not count, bodies have just been given their velocities.
    pub fn set_time(&mut self, time: f64, first: bool) {
        std::mem::swap(&mut self.values, &mut self.previous);
        for (value, function) in self.values.iter_mut().zip(&self.functions) {
            *value = function.value(time);
        }
        self.first = first;
    }

    /// Acceleration in the held directions over a kick of length `h`: the change of what is
    /// prescribed. A node's mapped velocity is not forced to the prescribed one: it is the mean of
    /// particles away from the wall, and to take it from them in every step would drain a share of
    /// their energy that grows as the step falls.
    #[inline]
    pub fn acceleration(&self, constraint: &Constraint, velocity: Vec3, h: f64) -> Vec3 {
        if self.first {
            let held = velocity - constraint.free * velocity;
            return (self.prescribed(constraint) - held) / h;
        }
        if !constraint.moves {
            return Vec3::ZERO;
        }
        (self.prescribed(constraint) - constraint.velocity(&self.previous)) / h
    }

    /// The constraint of a mesh node.
    #[inline]
    pub fn of(&self, node: u32) -> Option<&Constraint> {
        self.all.get(self.of_node[node as usize] as usize)
    }

    /// The part of a node's velocity that is prescribed, m/s.
    #[inline]
    pub fn prescribed(&self, constraint: &Constraint) -> Vec3 {
        constraint.velocity(&self.values)
    }

    fn hold(&mut self, node: u32, direction: Vec3, speed: f64, function: usize) {
        if self.of_node[node as usize] == NONE {
            self.of_node[node as usize] = self.all.len() as u32;
            self.all.push(Constraint {
                node,
                free: Mat3::IDENTITY,
                held: Vec::new(),
                moves: false,
            });
        }
        let constraint = &mut self.all[self.of_node[node as usize] as usize];
        let rest = constraint.free * direction;
        let length = rest.length();
        if length < 1e-6 {
            return;
        }
        // Along the rest's unit vector r = (d − Σ (d·e) e) / l the speed is (v − Σ (d·e) v_e) / l.
        let mut speeds = vec![(speed / length, function)];
        for held in &constraint.held {
            let share = direction.dot(held.direction) / length;
            speeds.extend(held.speed.iter().map(|&(v, f)| (-share * v, f)));
        }
        speeds.retain(|&(v, _)| v != 0.0);
        constraint.moves |= !speeds.is_empty();
        let unit = rest / length;
        constraint.held.push(Held {
            direction: unit,
            speed: speeds,
        });
        // From the held directions alone, not by subtraction: what is held is held exactly.
        constraint.free = match constraint.held[..] {
            [_] => Mat3::IDENTITY - outer(unit),
            [ref first, _] => outer(first.direction.cross(unit).normalize()),
            _ => Mat3::ZERO,
        };
    }
}

/// n nᵀ.
fn outer(n: Vec3) -> Mat3 {
    Mat3::from_cols(n * n.x, n * n.y, n * n.z)
}

/// The nodes of surfaces, ascending.
pub fn surface_nodes(mesh: &Mesh, surfaces: &[usize]) -> Vec<u32> {
    let faces = surfaces.iter().flat_map(|&s| &mesh.surfaces[s].faces);
    let mut nodes: Vec<u32> = faces.flat_map(|&f| mesh.face_nodes(f)).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// For each node on a roller, the unit normals to hold: faces whose normals differ by less than
/// 30° are one smooth surface with their area-weighted mean normal.
///
/// Normals of the mesh's outside count with their sign: the two sides of a thin wedge, whose normals
/// are nearly opposite, are two surfaces, and their common edge moves along itself only. Faces
/// inside the mesh are listed from either side, so that their normals have no sign.
fn roller_normals(mesh: &Mesh, boundaries: &[&Boundary]) -> Vec<(u32, Vec<Vec3>)> {
    let rollers = boundaries
        .iter()
        .filter(|b| matches!(b.kind, BoundaryKind::Roller));
    // Node, whether the face is inside the mesh, area.
    let mut areas: Vec<(u32, bool, Vec3)> = rollers
        .flat_map(|b| &b.surfaces)
        .flat_map(|&s| &mesh.surfaces[s].faces)
        .flat_map(|&f| {
            let (inside, area) = (mesh.across(f).is_some(), mesh.face_area(f));
            mesh.face_nodes(f).map(|n| (n, inside, area))
        })
        .collect();
    areas.sort_by_key(|a| (a.0, a.1));
    areas
        .chunk_by(|a, b| a.0 == b.0)
        .map(|faces| {
            let mut sums: Vec<Vec3> = Vec::new();
            for &(_, inside, area) in faces {
                let sign = |sum: Vec3| if inside { sum.dot(area).signum() } else { 1.0 };
                let alike = |sum: &&mut Vec3| {
                    let cosine = sum.normalize().dot(area.normalize());
                    sign(**sum) * cosine > SMOOTH_COSINE
                };
                match sums.iter_mut().find(alike) {
                    Some(sum) => *sum += area * sign(*sum),
                    None => sums.push(area),
                }
            }
            (faces[0].0, sums.into_iter().map(unit).collect())
        })
        .collect()
}

/// The direction of a sum of areas. A component that is round-off is none, so that a wall along an
/// axis lets nothing through.
fn unit(area: Vec3) -> Vec3 {
    let n = area.normalize();
    Vec3::select(n.abs().cmplt(Vec3::splat(ROUND_OFF)), Vec3::ZERO, n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{CylinderSector, Split, box_mesh};

    fn boundary(mesh: &Mesh, names: &[&str], kind: BoundaryKind) -> Boundary {
        let surfaces = names.iter().map(|n| mesh.surface(n).unwrap()).collect();
        Boundary {
            name: names[0].to_owned(),
            surfaces,
            kind,
        }
    }

    #[test]
    fn rollers_leave_faces_edges_and_corners_their_freedom() {
        let mesh = box_mesh(Vec3::ONE, [2, 2, 2]).unwrap();
        let rollers = boundary(&mesh, &["x-min", "y-min", "z-min"], BoundaryKind::Roller);
        let constraints = Constraints::new(&mesh, &[&rollers]);
        let free = |x: Vec3| {
            let node = mesh
                .nodes
                .iter()
                .position(|n| (*n - x).length() < 1e-12)
                .unwrap();
            constraints.of(node as u32).map(|c| c.free * Vec3::ONE)
        };
        assert_eq!(free(Vec3::ZERO), Some(Vec3::ZERO));
        assert_eq!(free(Vec3::new(0.5, 0.0, 0.0)), Some(Vec3::X));
        assert_eq!(
            free(Vec3::new(0.5, 0.5, 0.0)),
            Some(Vec3::new(1.0, 1.0, 0.0))
        );
        assert_eq!(free(Vec3::splat(0.5)), None);
    }

    #[test]
    fn prescribed_velocities_meet_rollers_at_edges() {
        let mesh = box_mesh(Vec3::ONE, [1, 1, 1]).unwrap();
        let velocity = [None, None, Some(-2.0)];
        let function = Function::Ramp { duration: 4.0 };
        let plate = boundary(
            &mesh,
            &["z-max"],
            BoundaryKind::Prescribed { velocity, function },
        );
        let side = boundary(&mesh, &["x-min"], BoundaryKind::Roller);
        let mut constraints = Constraints::new(&mesh, &[&side, &plate]);
        constraints.set_time(1.0, true);
        let node = mesh
            .nodes
            .iter()
            .position(|x| x.x == 0.0 && x.z == 1.0)
            .unwrap() as u32;
        let edge = constraints.of(node).unwrap();
        assert_eq!(constraints.prescribed(edge), Vec3::new(0.0, 0.0, -0.5));
        assert_eq!(edge.free * Vec3::ONE, Vec3::Y);
    }

    fn sector(degrees: f64) -> Mesh {
        let sector = CylinderSector {
            outer: vec![[2.0, 0.0], [2.0, 1.0]],
            inner: None,
            angle: degrees.to_radians(),
            radial: 2,
            around: 2,
            vertical: vec![2],
            radial_grading: 1.0,
            vertical_grading: vec![1.0],
            split: Split::Symmetric,
        };
        sector.mesh().unwrap()
    }

    /// However thin a sector is, its axis moves along itself only, exactly; its planes are held along
    /// their normals, whatever the order of the rollers.
    #[test]
    fn the_axis_of_a_sector_is_free_along_itself_only() {
        for degrees in [10.0, 20.0, 90.0] {
            let mesh = sector(degrees);
            for names in [["theta-min", "theta-max"], ["theta-max", "theta-min"]] {
                let rollers = boundary(&mesh, &names, BoundaryKind::Roller);
                let constraints = Constraints::new(&mesh, &[&rollers]);
                let (sin, cos) = degrees.to_radians().sin_cos();
                for (node, x) in mesh.nodes.iter().enumerate() {
                    let free = constraints.of(node as u32).map(|c| c.free * Vec3::ONE);
                    if x.x == 0.0 && x.y == 0.0 {
                        assert_eq!(free, Some(Vec3::Z), "{degrees} {x}");
                    } else if x.y == 0.0 {
                        assert_eq!(free, Some(Vec3::new(1.0, 0.0, 1.0)), "{degrees} {x}");
                    } else if (x.x * sin - x.y * cos).abs() < 1e-9 {
                        let along = Vec3::new(cos, sin, 0.0);
                        let expected = along * (cos + sin) + Vec3::Z;
                        assert!((free.unwrap() - expected).length() < 1e-12);
                    } else {
                        assert_eq!(free, None);
                    }
                }
            }
        }
    }

    /// The rim of a thin sector with a roller outside, too, is held in all but its height.
    #[test]
    fn the_rim_of_a_sector_moves_up_and_down_only() {
        let mesh = sector(20.0);
        let names = ["theta-min", "theta-max", "r-max"];
        let rollers = boundary(&mesh, &names, BoundaryKind::Roller);
        let constraints = Constraints::new(&mesh, &[&rollers]);
        for (node, x) in mesh.nodes.iter().enumerate() {
            let plane = x.y == 0.0 || (x.y - x.x * 20f64.to_radians().tan()).abs() < 1e-9;
            if plane && x.truncate().length() > 1.999 {
                let free = constraints.of(node as u32).unwrap().free;
                assert!((free * Vec3::ONE - Vec3::Z).length() < 1e-12, "{x}");
            }
        }
    }

    /// Faces inside the mesh may be listed from either side, here from both: one surface all the same.
    #[test]
    fn faces_inside_have_no_sign() {
        let mut mesh = box_mesh(Vec3::ONE, [2, 2, 2]).unwrap();
        let middle = |n: &u32| mesh.nodes[*n as usize].x == 0.5;
        let mut faces = Vec::new();
        for element in 0..mesh.tets.len() as u32 {
            for local in 0..4 {
                let face = crate::mesh::Face { element, local };
                if mesh.face_nodes(face).iter().all(middle) && mesh.across(face).is_some() {
                    faces.push(face);
                }
            }
        }
        mesh.surfaces[0].faces = faces;
        let wall = boundary(&mesh, &["x-min"], BoundaryKind::Roller);
        let constraints = Constraints::new(&mesh, &[&wall]);
        assert_eq!(constraints.all.len(), 9);
        assert!(constraints.all.iter().all(|c| c.held.len() == 1));
    }
}
