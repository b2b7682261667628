//! What is to be computed: checked, in SI units, every name resolved to a number.

mod contact;
mod mesh_motion;
mod stage;

pub use contact::{Contact, ContactSurface};
pub use mesh_motion::MeshMotion;
pub use stage::{Equilibrium, Item, Level, Ramp, Stage, Until};

use crate::Vec3;
use crate::boundary::Function;
use crate::material::Material;
use crate::mesh::Mesh;
use crate::particles::{InitialStress, Particles};
use crate::symmetry::Symmetry;

/// Everything that decides a simulation's result. Output is not part of it.
#[derive(Clone, Debug)]
pub struct Plan {
    pub title: String,
    /// m/s².
    pub gravity: Vec3,
    pub mesh: Mesh,
    /// How the mesh moves with a body, if it does.
    pub mesh_motion: Option<MeshMotion>,
    /// What the mesh is of the whole body, if it is a part of it.
    pub symmetry: Option<Symmetry>,
    pub materials: Vec<NamedMaterial>,
    pub bodies: Vec<Body>,
    pub boundaries: Vec<Boundary>,
    pub loads: Vec<Load>,
    pub contacts: Vec<Contact>,
    pub probes: Vec<Probe>,
    /// Stress before the first stage, if the ground has any.
    pub initial_stress: Option<InitialStress>,
    /// Particles as an earlier run left them, of all bodies that are not seeded; none if all are.
    /// Ids, elements, velocities and displacements do not count. A simulation takes them out.
    pub inherited: Particles,
    pub numerics: Numerics,
    pub stages: Vec<Stage>,
}

#[derive(Clone, Debug)]
pub struct NamedMaterial {
    pub name: String,
    /// Initial mass density, kg/m³.
    pub density: f64,
    pub model: Material,
}

/// A region of the mesh filled with particles of one material.
#[derive(Clone, Debug)]
pub struct Body {
    pub name: String,
    pub place: Place,
    /// Index into [`Plan::materials`].
    pub material: usize,
    pub seeding: Seeding,
}

/// Where a body's particles are at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// In all elements of volume groups (indices into [`Mesh::volume_groups`]).
    Volumes(Vec<usize>),
    /// At the seeding points of any element that lie in this region.
    Region(Region),
}

/// A simple solid, closed (its surface belongs to it). Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    Box {
        min: Vec3,
        max: Vec3,
    },
    Sphere {
        centre: Vec3,
        radius: f64,
    },
    /// Between the planes through both ends of the axis.
    Cylinder {
        start: Vec3,
        end: Vec3,
        radius: f64,
    },
    /// From its apex, where its radius is 0, to the plane through its end.
    Cone {
        apex: Vec3,
        end: Vec3,
        radius: f64,
    },
    /// The side of the plane that the normal points away from.
    HalfSpace {
        point: Vec3,
        normal: Vec3,
    },
}

impl Region {
    pub fn contains(&self, x: Vec3) -> bool {
        match *self {
            Region::Box { min, max } => x.cmpge(min).all() && x.cmple(max).all(),
            Region::Sphere { centre, radius } => (x - centre).length() <= radius,
            Region::Cylinder { start, end, radius } => {
                let axis = end - start;
                let along = (x - start).dot(axis) / axis.length_squared();
                (0.0..=1.0).contains(&along) && (x - start - along * axis).length() <= radius
            }
            Region::Cone { apex, end, radius } => {
                let axis = end - apex;
                let along = (x - apex).dot(axis) / axis.length_squared();
                let across = (x - apex - along * axis).length();
                (0.0..=1.0).contains(&along) && across <= radius * along
            }
            Region::HalfSpace { point, normal } => (x - point).dot(normal) <= 0.0,
        }
    }
}

/// Particles seeded in each element, all with the same share of its volume.
#[derive(Clone, Debug, PartialEq)]
pub enum Seeding {
    One,
    Four,
    Ten,
    /// As many as it takes, at least four.
    Spacing(Spacing),
}

/// Distance between particles, graded in space: a function of the distance from a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Spacing {
    /// Ends of the line, m; the same if it is a point.
    pub start: Vec3,
    pub end: Vec3,
    /// Distance from the line and spacing, m, distances increasing; linear between, constant beyond.
    pub points: Vec<[f64; 2]>,
}

impl Spacing {
    /// At a point, m.
    pub fn at(&self, x: Vec3) -> f64 {
        let axis = self.end - self.start;
        let along = ((x - self.start).dot(axis) / axis.length_squared().max(f64::MIN_POSITIVE))
            .clamp(0.0, 1.0);
        let distance = (x - self.start - along * axis).length();
        let next = self.points.partition_point(|p| p[0] <= distance);
        match (next.checked_sub(1), self.points.get(next)) {
            (Some(i), Some(b)) => {
                let a = self.points[i];
                a[1] + (b[1] - a[1]) * (distance - a[0]) / (b[0] - a[0])
            }
            (Some(i), None) => self.points[i][1],
            (None, first) => first.map_or(f64::INFINITY, |p| p[1]),
        }
    }
}

#[derive(Clone, Debug)]
pub struct Boundary {
    pub name: String,
    /// Indices into [`Mesh::surfaces`].
    pub surfaces: Vec<usize>,
    pub kind: BoundaryKind,
}

#[derive(Clone, Debug)]
pub enum BoundaryKind {
    /// No motion in the directions (x, y, z) that are true.
    Fixed { directions: [bool; 3] },
    /// No motion normal to the surface.
    Roller,
    /// Given velocity, m/s, times a function of time; `None` leaves a direction free.
    Prescribed {
        velocity: [Option<f64>; 3],
        function: Function,
    },
    /// Dashpot, and spring if a virtual thickness is given (Jassim et al. Eq. 17–20).
    Absorbing {
        /// α_n, α_s.
        alpha: [f64; 2],
        /// δ_n, δ_s, m.
        virtual_thickness: Option<[f64; 2]>,
    },
    /// Material leaves the mesh here.
    Outflow,
}

/// A load on a surface, carried by the particles of one body next to it.
#[derive(Clone, Debug)]
pub struct Load {
    pub name: String,
    /// Indices into [`Mesh::surfaces`].
    pub surfaces: Vec<usize>,
    /// Index into [`Plan::bodies`].
    pub body: usize,
    pub kind: LoadKind,
    pub function: Function,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadKind {
    /// Force per area of the surface at the start, Pa.
    Traction(Vec3),
    /// Against the body, along the surface's normal at the start, Pa.
    Pressure(f64),
    /// The same, growing with depth: `value` Pa at the elevation `level` (m, against gravity), and
    /// `gradient` Pa more for each metre below.
    LinearPressure {
        value: f64,
        gradient: f64,
        level: f64,
    },
    /// What the ground's initial stress needs to hold it.
    InitialStress,
    /// The whole surface's force, N, spread evenly over its area; with a symmetry that of the whole
    /// body.
    Force(Vec3),
}

#[derive(Clone, Debug)]
pub struct Probe {
    pub name: String,
    pub target: Target,
    pub quantities: Vec<Quantity>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Index into [`Mesh::surfaces`].
    Surface(usize),
    /// Follows the particle nearest to this point at the start.
    Point(Vec3),
    /// Index into [`Plan::bodies`].
    Body(usize),
    /// Index into [`Mesh::volume_groups`]: what is in its elements.
    Volume(usize),
}

/// What a probe records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Since the start.
    Displacement,
    /// Of a mid-step.
    Velocity,
    /// Its rate of change.
    Acceleration,
    /// At that time.
    Position,
    /// Cauchy stress, tension positive.
    Stress,
    /// Force of the boundaries on the material; of surfaces with a boundary only.
    Reaction,
    /// Displacement along gravity.
    Penetration,
    /// Force of an aligned contact on its first side, of the faces of a surface of that body.
    Contact,
    /// Volume of the material in a part of the mesh, or of a body, without what has opened in
    /// tension.
    Volume,
}

impl Quantity {
    /// Every quantity with its name in a scene.
    pub const ALL: [(&'static str, Quantity); 9] = [
        ("displacement", Quantity::Displacement),
        ("velocity", Quantity::Velocity),
        ("acceleration", Quantity::Acceleration),
        ("position", Quantity::Position),
        ("stress", Quantity::Stress),
        ("reaction", Quantity::Reaction),
        ("penetration", Quantity::Penetration),
        ("contact", Quantity::Contact),
        ("volume", Quantity::Volume),
    ];

    /// The quantity's name.
    pub fn name(self) -> &'static str {
        Quantity::ALL
            .iter()
            .find(|q| q.1 == self)
            .expect("every quantity is listed")
            .0
    }

    /// The names of its components; one without a name if it is a number.
    pub fn components(self) -> &'static [&'static str] {
        match self {
            Quantity::Volume | Quantity::Penetration => &[""],
            Quantity::Stress => &["xx", "yy", "zz", "xy", "yz", "zx"],
            _ => &["x", "y", "z"],
        }
    }

    /// The columns that a probe of this name records of it.
    pub fn columns(self, probe: &str) -> impl Iterator<Item = String> {
        let components = self.components().iter();
        components.map(move |component| match *component {
            "" => format!("{probe}.{}", self.name()),
            _ => format!("{probe}.{}.{component}", self.name()),
        })
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Displacement | Quantity::Position | Quantity::Penetration => "m",
            Quantity::Velocity => "m/s",
            Quantity::Acceleration => "m/s2",
            Quantity::Stress => "Pa",
            Quantity::Reaction | Quantity::Contact => "N",
            Quantity::Volume => "m3",
        }
    }
}

/// How the internal force is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integration {
    /// Mean stress times element volume in filled elements, particles elsewhere.
    Mixed,
    /// Particles everywhere.
    Particle,
}

/// How velocities go between nodes and particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassMatrix {
    /// Averages and the accelerations that particles receive, both corrected for what averaging
    /// takes from short waves.
    Corrected,
    /// Without correction, with the lumped matrix (Jassim et al. Eq. 6).
    Lumped,
}

/// Nodal mixed discretisation of the volumetric strain, against locking.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoothing {
    /// Each element has its own volumetric strain.
    Off,
    /// Strains are smoothed, forces come from the stresses as they are (Jassim et al. Eq. 15–16).
    Strain,
    /// Strains are smoothed, and mean stresses with the transposed operator: forces do the work
    /// that the material takes up. Not for frictional soil, see `step/smoothing.rs`.
    Conjugate,
}

#[derive(Clone, Debug)]
pub struct Numerics {
    pub integration: Integration,
    pub mass: MassMatrix,
    pub smoothing: Smoothing,
    /// Share of the critical step that is taken.
    pub courant: f64,
    /// Rate at which particle velocities relax to the mesh's, 1/s.
    pub pic_rate: f64,
    /// Stiffness-proportional viscosity: stress C : ε̇ times this time, s.
    pub viscosity: f64,
    /// Local (Cundall) damping factor.
    pub damping: f64,
    /// Forces the step, s.
    pub time_step: Option<f64>,
    /// Upper bound of the step, s.
    pub max_time_step: Option<f64>,
}

impl Default for Numerics {
    fn default() -> Numerics {
        Numerics {
            integration: Integration::Mixed,
            mass: MassMatrix::Corrected,
            smoothing: Smoothing::Strain,
            courant: 0.5,
            pic_rate: 0.0,
            viscosity: 0.0,
            damping: 0.0,
            time_step: None,
            max_time_step: None,
        }
    }
}
