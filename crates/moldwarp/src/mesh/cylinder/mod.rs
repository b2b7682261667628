//! A sector of a body of revolution about the z axis: its profile, and what can be wrong with it.
//!
//! The sector lies between the meridian planes θ = 0 (y = 0, x > 0) and θ = `angle`. Circles become
//! polygons with a corner on every meridian of cells, so that all faces of cells are flat and the
//! volume of a ring of n cells over the angle α is n sin(α/n)/α of the round one.

mod lattice;
mod split;
#[cfg(test)]
mod tests;

use super::{Mesh, MeshError, RawMesh};
use lattice::Lattice;
use std::f64::consts::{FRAC_PI_2, PI};

/// A sector of a solid or hollow body of revolution about the z axis.
///
/// Between two points of the profile radii run along straight lines. Along each direction the sizes
/// of the cells are a geometric progression.
#[derive(Clone, Debug, PartialEq)]
pub struct CylinderSector {
    /// Radius and height, m, of the outside from the bottom up.
    pub outer: Vec<[f64; 2]>,
    /// The same of the inside, at the same heights; all radii positive, or all 0. Without it, or
    /// with zeros, the body is solid.
    pub inner: Option<Vec<[f64; 2]>>,
    /// rad, at most π.
    pub angle: f64,
    /// Cells from the inside (the axis) to the outside.
    pub radial: usize,
    /// Cells over the angle.
    pub around: usize,
    /// Cells over the height of each segment of the profile, or one number that all have.
    pub vertical: Vec<usize>,
    /// Size of the outermost cell over that of the innermost.
    pub radial_grading: f64,
    /// Size of the uppermost cell over that of the lowest in each segment, or one for all.
    pub vertical_grading: Vec<f64>,
    pub split: Split,
}

/// How cells become tetrahedra.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Split {
    /// Six to a hexahedron (Kuhn's subdivision), three to a wedge at the axis. Cells that are
    /// neighbours around are mirror images of each other: with an even number of them the mesh is
    /// symmetric about its middle plane.
    #[default]
    Six,
    /// With a node in the middle of each cell and of each of its faces with four corners: 24 to a
    /// hexahedron, 14 to a wedge at the axis. All cells around are cut alike, and each is symmetric
    /// about its own middle plane, so that nothing prefers a sense of rotation: what is axisymmetric
    /// does not depend on θ.
    Symmetric,
}

impl Split {
    /// Most tetrahedra that a cell becomes.
    pub fn most_tets(self) -> u64 {
        match self {
            Split::Six => 6,
            Split::Symmetric => 24,
        }
    }
}

/// What can be wrong with a sector. Points and segments are counted from 0, from the bottom up.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum CylinderError {
    #[error("a profile needs two points or more; give its lowest, its highest and each corner")]
    OnePoint,
    #[error("the heights of a profile must increase; list its points from the bottom up")]
    Height { point: usize },
    #[error(
        "an outer radius must be greater than zero; cut the tip of a cone off at a small radius"
    )]
    Radius { point: usize },
    #[error(
        "the inner profile has {inner} points, the outer one {outer}; give each outer point one \
         inside at the same height"
    )]
    InnerCount { inner: usize, outer: usize },
    #[error(
        "an inner point is not as high as the outer one; give each outer point one inside at the \
         same height"
    )]
    InnerHeight { point: usize },
    #[error(
        "an inner radius must not be negative and must be less than the outer one; without an \
         inner profile the body is solid"
    )]
    InnerRadius { point: usize },
    #[error(
        "the inner radius is zero at some heights only; let it be positive everywhere, or leave \
         the inner profile out for a solid body"
    )]
    InnerMixed { point: usize },
    #[error(
        "the angle of a sector must be greater than 0 and at most 180 deg; a full ring is not \
         offered: compute half of it, or a thin sector"
    )]
    Angle,
    #[error("a cell must span less than 90 deg; take more cells around")]
    Wide,
    #[error("there must be one cell at least in each direction; none has no volume")]
    Cells { direction: usize },
    #[error(
        "the profile has {segments} segments, but there are {given} values for them; give one for \
         each segment from the bottom up, or one that all share"
    )]
    Segments { segments: usize, given: usize },
    #[error(
        "the grading is the size of the last cell over that of the first and must be greater than \
         zero; 1 makes all alike"
    )]
    Grading { direction: usize },
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

impl CylinderSector {
    /// The mesh.
    ///
    /// Groups: volume `cylinder`; surfaces `theta-min`, `theta-max`, `r-max`, `z-min`, `z-max`, and
    /// `r-min` if there is an inside. The axis of a solid body is a line of nodes, not of faces, so
    /// there is no surface for it; with rollers on both meridian planes its nodes are free along z
    /// only. These nodes lie on x = y = 0 exactly, those of `theta-min` on y = 0.
    pub fn mesh(&self) -> Result<Mesh, CylinderError> {
        self.check()?;
        let lattice = Lattice::new(self);
        Ok(Mesh::new(split::raw(lattice, self.split))?)
    }

    /// Segments of the profile.
    pub fn segments(&self) -> usize {
        self.outer.len().saturating_sub(1)
    }

    fn check(&self) -> Result<(), CylinderError> {
        self.check_profiles()?;
        if !(self.angle > 0.0 && self.angle <= PI * (1.0 + 1e-12)) {
            return Err(CylinderError::Angle);
        }
        let counts = [self.radial, self.around];
        if let Some(direction) = counts.iter().position(|&n| n == 0) {
            return Err(CylinderError::Cells { direction });
        }
        if self.vertical.contains(&0) {
            return Err(CylinderError::Cells { direction: 2 });
        }
        if self.angle >= FRAC_PI_2 * self.around as f64 * (1.0 - 1e-12) {
            return Err(CylinderError::Wide);
        }
        let segments = self.segments();
        for given in [self.vertical.len(), self.vertical_grading.len()] {
            if given != 1 && given != segments {
                return Err(CylinderError::Segments { segments, given });
            }
        }
        let positive = |g: f64| g > 0.0 && g.is_finite();
        if !positive(self.radial_grading) {
            return Err(CylinderError::Grading { direction: 0 });
        }
        if !self.vertical_grading.iter().all(|&g| positive(g)) {
            return Err(CylinderError::Grading { direction: 1 });
        }
        Ok(())
    }

    fn check_profiles(&self) -> Result<(), CylinderError> {
        let outer = &self.outer;
        if outer.len() < 2 {
            return Err(CylinderError::OnePoint);
        }
        // What is no number rises above nothing and is greater than nothing.
        let rises = |point: usize| outer[point][1] > outer[point - 1][1];
        if let Some(point) = (1..outer.len()).find(|&point| !rises(point)) {
            return Err(CylinderError::Height { point });
        }
        let round = |point: usize| outer[point][0] > 0.0;
        if let Some(point) = (0..outer.len()).find(|&point| !round(point)) {
            return Err(CylinderError::Radius { point });
        }
        let Some(inner) = &self.inner else {
            return Ok(());
        };
        if inner.len() != outer.len() {
            return Err(CylinderError::InnerCount {
                inner: inner.len(),
                outer: outer.len(),
            });
        }
        for (point, (inside, outside)) in inner.iter().zip(outer).enumerate() {
            if inside[1] != outside[1] {
                return Err(CylinderError::InnerHeight { point });
            }
            if !(inside[0] >= 0.0 && inside[0] < outside[0]) {
                return Err(CylinderError::InnerRadius { point });
            }
        }
        let zero = inner[0][0] == 0.0;
        match inner.iter().position(|p| (p[0] == 0.0) != zero) {
            Some(point) => Err(CylinderError::InnerMixed { point }),
            None => Ok(()),
        }
    }
}
