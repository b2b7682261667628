//! What a computed part is of the whole body: a sector of a body of revolution, or one of two halves.
//!
//! The simulation knows the part alone; its rollers on the planes of symmetry stand for the rest. A
//! force of the whole body that the user gives is cut down to the part's share, and what is
//! reported of the part is scaled up by the same share. The share is the part's volume over the whole
//! one's. That of a body of revolution is, by Pappus, V = 2π ∫ r dA over a section, which is the
//! faces on a meridian plane: so it is right for any mesh, and for chords in place of arcs, too.

use crate::Vec3;
use crate::mesh::Mesh;
use std::f64::consts::{PI, TAU};

/// How far nodes of a plane of symmetry may be off it, over the size of the mesh.
const OFF: f64 = 1e-6;

/// The part that is computed, and its share of the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Symmetry {
    pub kind: SymmetryKind,
    /// 0, 1 or 2 for x, y or z through the origin: the axis of revolution, or the normal of the
    /// plane between the halves.
    pub axis: usize,
    /// Volume of the part over that of the whole body.
    pub share: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SymmetryKind {
    /// From θ = 0 to θ = `angle`, rad; θ counts from y to z about x, from z to x about y and from x
    /// to y about z.
    Sector { angle: f64 },
    /// On one side of a plane.
    Half,
}

/// Why a mesh is not the part that it is said to be.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum SymmetryError {
    #[error("the angle of a sector must be greater than 0 and at most 180 deg")]
    Angle,
    #[error("the mesh has no faces on the meridian plane at {degrees} deg about {axis}")]
    NoMeridian { degrees: f64, axis: char },
    #[error(
        "the mesh is no sector of a body of revolution about {axis}: it has {ratio:.3} times the \
         volume of a round one"
    )]
    NotRound { axis: char, ratio: f64 },
    #[error("the mesh has no faces on the plane {axis} = 0")]
    NoPlane { axis: char },
    #[error("the mesh lies on both sides of the plane {axis} = 0")]
    BothSides { axis: char },
}

impl Symmetry {
    /// A sector of a body of revolution about an axis through the origin.
    pub fn sector(mesh: &Mesh, axis: usize, angle: f64) -> Result<Symmetry, SymmetryError> {
        if !(angle > 0.0 && angle <= PI * (1.0 + OFF)) {
            return Err(SymmetryError::Angle);
        }
        let mut moment = 0.0;
        for theta in [0.0, angle] {
            let here = meridian(mesh, axis, theta);
            if here == 0.0 {
                return Err(SymmetryError::NoMeridian {
                    degrees: (theta.to_degrees() * 1e6).round() / 1e6,
                    axis: name(axis),
                });
            }
            moment += 0.5 * here;
        }
        let share = mesh.total_volume() / (TAU * moment);
        // Chords of cells less than 90° wide leave more than 2/π of the volume; inner ones may add.
        let ratio = share * TAU / angle;
        if !(0.6..1.1).contains(&ratio) {
            return Err(SymmetryError::NotRound {
                axis: name(axis),
                ratio,
            });
        }
        Ok(Symmetry {
            kind: SymmetryKind::Sector { angle },
            axis,
            share,
        })
    }

    /// One of two halves that are mirror images in the plane through the origin normal to `axis`.
    pub fn half(mesh: &Mesh, axis: usize) -> Result<Symmetry, SymmetryError> {
        let [low, high] = mesh.bounds();
        let off = OFF * (high - low).max_element();
        let on = |n: u32| mesh.nodes[n as usize][axis].abs() <= off;
        if low[axis] < -off && high[axis] > off {
            return Err(SymmetryError::BothSides { axis: name(axis) });
        }
        if !mesh
            .boundary_faces()
            .any(|f| mesh.face_nodes(f).into_iter().all(on))
        {
            return Err(SymmetryError::NoPlane { axis: name(axis) });
        }
        Ok(Symmetry {
            kind: SymmetryKind::Half,
            axis,
            share: 0.5,
        })
    }

    /// A mass, a volume or an energy of the whole body, from that of the part.
    pub fn whole(&self, part: f64) -> f64 {
        part / self.share
    }

    /// The force on the whole body, from that on the part. What the symmetry turns or mirrors into
    /// its opposite is zero: across the axis of a body of revolution, normal to the plane of halves.
    pub fn whole_force(&self, part: Vec3) -> Vec3 {
        let mut force = Vec3::ZERO;
        for d in (0..3).filter(|&d| self.keeps(d)) {
            force[d] = self.whole(part[d]);
        }
        force
    }

    /// Whether a vector that acts on the whole body is symmetric.
    pub fn allows(&self, v: Vec3) -> bool {
        (0..3).all(|d| v[d] == 0.0 || self.keeps(d))
    }

    /// Whether the symmetry leaves vectors along this coordinate as they are.
    fn keeps(&self, d: usize) -> bool {
        match self.kind {
            SymmetryKind::Sector { .. } => d == self.axis,
            SymmetryKind::Half => d != self.axis,
        }
    }
}

fn name(axis: usize) -> char {
    ['x', 'y', 'z'][axis]
}

/// ∫ r dA over the faces outside that lie on the half-plane at θ, m³.
fn meridian(mesh: &Mesh, axis: usize, theta: f64) -> f64 {
    let [first, second] = [1, 2].map(|d| Vec3::AXES[(axis + d) % 3]);
    let (sin, cos) = (libm::sin(theta), libm::cos(theta));
    let (along, across) = (first * cos + second * sin, second * cos - first * sin);
    let radius = |x: &Vec3| x.dot(first).hypot(x.dot(second));
    let off = OFF * mesh.nodes.iter().map(radius).fold(0.0, f64::max);
    let on = |&x: &Vec3| x.dot(across).abs() <= off && x.dot(along) >= -off;
    mesh.boundary_faces()
        .map(|f| (f, mesh.face_nodes(f).map(|n| mesh.nodes[n as usize])))
        .filter(|(_, corners)| corners.iter().all(on))
        .map(|(f, [a, b, c])| mesh.face_area(f).length() * (a + b + c).dot(along) / 3.0)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{CylinderSector, RawMesh, Split, box_mesh};

    fn cone(degrees: f64, split: Split) -> Mesh {
        let sector = CylinderSector {
            outer: vec![[0.5, 0.0], [0.3, 1.0]],
            inner: Some(vec![[0.2, 0.0], [0.1, 1.0]]),
            angle: degrees.to_radians(),
            radial: 3,
            around: 2,
            vertical: vec![2],
            radial_grading: 2.0,
            vertical_grading: vec![1.0],
            split,
        };
        sector.mesh().unwrap()
    }

    /// All corners are at radii of the cone, so that horizontal sections of the part are n sin(α/n)
    /// over 2π of the whole one's.
    #[test]
    fn the_share_of_a_sector_is_that_of_its_chords() {
        for split in [Split::Six, Split::Symmetric] {
            for degrees in [20.0f64, 170.0] {
                let mesh = cone(degrees, split);
                let angle = degrees.to_radians();
                let symmetry = Symmetry::sector(&mesh, 2, angle).unwrap();
                let share = 2.0 * (0.5 * angle).sin() / TAU;
                assert!((symmetry.share / share - 1.0).abs() < 1e-14);
                let whole = PI / 3.0 * (0.25 + 0.15 + 0.09 - 0.04 - 0.02 - 0.01);
                assert!((symmetry.whole(mesh.total_volume()) / whole - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn other_axes_are_the_same_turned() {
        let mesh = cone(20.0, Split::Six);
        let angle = 20f64.to_radians();
        let upright = Symmetry::sector(&mesh, 2, angle).unwrap();
        for axis in [0, 1] {
            // z becomes the axis, x the direction that follows it, and so on.
            let turn = |x: &Vec3| {
                let mut y = Vec3::ZERO;
                (0..3).for_each(|d| y[(axis + 1 + d) % 3] = x[d]);
                y
            };
            let turned = Mesh::new(RawMesh {
                nodes: mesh.nodes.iter().map(turn).collect(),
                tets: mesh.tets.clone(),
                ..RawMesh::default()
            });
            let symmetry = Symmetry::sector(&turned.unwrap(), axis, angle).unwrap();
            assert!((symmetry.share / upright.share - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn forces_across_a_symmetry_cancel() {
        let part = Vec3::new(1.0, 2.0, 3.0);
        let mesh = cone(20.0, Split::Six);
        let sector = Symmetry::sector(&mesh, 2, 20f64.to_radians()).unwrap();
        let along = 3.0 / sector.share;
        assert_eq!(sector.whole_force(part), Vec3::new(0.0, 0.0, along));
        assert!(sector.allows(Vec3::Z) && !sector.allows(part));
        let half = Symmetry::half(&box_mesh(Vec3::ONE, [1, 1, 1]).unwrap(), 1).unwrap();
        assert_eq!(half.whole_force(part), Vec3::new(2.0, 0.0, 6.0));
        assert!(half.allows(Vec3::new(1.0, 0.0, 1.0)) && !half.allows(Vec3::Y));
    }

    #[test]
    fn what_is_no_part_is_refused() {
        let mesh = cone(20.0, Split::Six);
        let at = |degrees: f64, axis| Symmetry::sector(&mesh, axis, f64::to_radians(degrees));
        assert_eq!(at(0.0, 2), Err(SymmetryError::Angle));
        assert_eq!(at(181.0, 2), Err(SymmetryError::Angle));
        let (degrees, axis) = (20.001, 'z');
        let none = SymmetryError::NoMeridian { degrees, axis };
        assert_eq!(at(20.001, 2), Err(none));
        assert!(at(20.0 + 1e-6, 2).is_ok());
        assert!(at(20.0, 0).is_err());
        let cube = box_mesh(Vec3::ONE, [1, 1, 1]).unwrap();
        let quarter = Symmetry::sector(&cube, 2, 0.5 * PI);
        assert!(matches!(
            quarter,
            Err(SymmetryError::NotRound { axis: 'z', .. })
        ));
        let mut both = cube.clone();
        both.nodes.iter_mut().for_each(|x| x.x -= 0.5);
        let sides = SymmetryError::BothSides { axis: 'x' };
        assert_eq!(Symmetry::half(&both, 0), Err(sides));
        both.nodes.iter_mut().for_each(|x| x.x += 1.0);
        let none = SymmetryError::NoPlane { axis: 'x' };
        assert_eq!(Symmetry::half(&both, 0), Err(none));
    }
}
