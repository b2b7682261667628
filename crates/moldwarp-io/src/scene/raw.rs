//! What the user wrote: the scene's keys and shapes, with places, before anything is checked.
//!
//! The comments of the keys are what the book's page on the scene says of them: the meaning, then
//! `for:` (the kinds or models that have the key, if not all do), `type:` and `default:` (not where
//! serde needs the key, `–` where others can stand for it). A key that holds a table of its own has
//! no comment if its keys are to stand beside it in one list. See `crate::reference`.

use super::amount::{Amount, AmountOr, Named, OneOrMany, RawVector, Spanned, Switch};
use serde::Deserialize;
use serde::de::IgnoredAny;

pub(super) type Text = Spanned<String>;
pub(super) type Texts = Spanned<OneOrMany<String>>;
pub(super) type RawAmount = Spanned<Amount>;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawScene {
    /// Version of the scene format.
    /// type: 1
    #[serde(rename = "version")]
    pub _version: IgnoredAny,
    /// For people.
    /// type: text
    /// default: name of the case
    pub title: Option<String>,
    /// Of all bodies, for the whole run.
    /// type: acceleration × 3
    pub gravity: RawVector,
    /// [Mesh](#mesh).
    /// type: table
    pub mesh: Spanned<RawMesh>,
    /// [Motion](#mesh-motion) of the mesh with a body; without this table it stays, but for absorbing
    /// boundaries that it follows.
    /// type: table
    /// default: –
    pub mesh_motion: Option<Spanned<RawMeshMotion>>,
    /// [Symmetry](#symmetry) of which the mesh is a part.
    /// type: table
    /// default: none
    pub symmetry: Option<Spanned<RawSymmetry>>,
    /// [Stress](#initial-stress) before the first stage; none without this table.
    /// type: table
    /// default: –
    pub initial_stress: Option<Spanned<RawInitialStress>>,
    /// [Materials](#materials).
    /// type: tables
    pub materials: Named<RawMaterial>,
    /// [Bodies](#bodies), at least one.
    /// type: tables
    pub bodies: Named<RawBody>,
    /// [Boundaries](#boundaries).
    /// type: list of tables
    /// default: none
    #[serde(default)]
    pub boundaries: Vec<Spanned<RawBoundary>>,
    /// [Loads](#loads).
    /// type: list of tables
    /// default: none
    #[serde(default)]
    pub loads: Vec<Spanned<RawLoad>>,
    /// [Contacts](#contacts); bodies without one stick together where they meet.
    /// type: list of tables
    /// default: none
    #[serde(default)]
    pub contacts: Vec<Spanned<RawContact>>,
    /// [Probes](#probes).
    /// type: tables
    /// default: none
    #[serde(default)]
    pub probes: Named<RawProbe>,
    /// [Numerics](#numerics).
    /// type: table
    /// default: all defaults
    #[serde(default)]
    pub numerics: RawNumerics,
    /// [Stages](#stages), at least one.
    /// type: list of tables
    /// default: required
    #[serde(default)]
    pub stages: Vec<Spanned<RawStage>>,
    /// [Output](#output).
    /// type: table
    /// default: all defaults
    #[serde(default)]
    pub output: RawOutput,
    /// [Compare](#compare).
    /// type: list of tables
    /// default: none
    #[serde(default)]
    pub compare: Vec<RawCompare>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawMesh {
    /// A Gmsh mesh, MSH 2.2 or 4.1, ASCII or binary.
    /// type: path
    /// default: –
    pub file: Option<Text>,
    /// Unit in which the file was drawn; with `file` only.
    /// type: text: m, cm or mm
    /// default: m
    pub unit: Option<Text>,
    /// Revolves the file's plane mesh of triangles about the axis z; see [meridians](#meridians).
    /// type: `{ angle, cells }`
    /// default: –
    pub revolve: Option<Spanned<RawRevolve>>,
    #[serde(rename = "box")]
    pub cuboid: Option<Spanned<RawBox>>,
    pub cylinder: Option<Spanned<RawCylinder>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawRevolve {
    /// Of the sector; less than 90° for each cell around.
    /// type: angle, 0 < α ≤ 180°
    pub angle: RawAmount,
    /// Layers of elements around.
    /// type: whole number ≥ 1
    /// default: 1
    pub cells: Option<Spanned<i64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawBox {
    /// A box from the origin.
    /// type: length × 3; each > 0
    pub size: RawVector,
    /// Bricks along x, y, z, at most 4,000,000 in all; each becomes six (Kuhn) tetrahedra.
    /// type: 3 whole numbers ≥ 1
    pub cells: Spanned<Vec<Spanned<i64>>>,
}

/// Rows of a profile: radius and height.
pub(super) type RawProfile = Spanned<Vec<RawVector>>;
/// Values for directions, the last one perhaps for each segment of a profile.
pub(super) type RawDirections<T> = Spanned<Vec<Spanned<OneOrMany<T>>>>;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawCylinder {
    /// The outside as points [radius > 0, height] from the bottom up, two or more; straight
    /// between them.
    /// type: list of length × 2
    pub profile: RawProfile,
    /// The inside, radius ≥ 0, with a point at each height of the profile; all radii positive or
    /// all 0.
    /// type: list of length × 2
    /// default: solid
    pub inner: Option<RawProfile>,
    /// Less than 90° for each cell around; whole rings are not offered.
    /// type: angle, 0 < α ≤ 180°
    pub angle: RawAmount,
    /// [radial, around, vertical]; `vertical` is a list with a number for each segment of the
    /// profile, or one that each has. At most 4,000,000 cells, 1,000,000 if `symmetric`.
    /// type: 3 whole numbers ≥ 1
    pub cells: RawDirections<i64>,
    /// [radial, vertical]: size of the last cell (outermost, uppermost) over the first, in geometric
    /// progression; `vertical` a list or one number as for `cells`.
    /// type: number × 2
    /// default: [1, 1]
    pub grading: Option<RawDirections<Amount>>,
    /// How cells become tetrahedra.
    /// type: `"six"`, `"symmetric"`
    /// default: "six"
    pub split: Option<Text>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawSymmetry {
    /// A sector of a body of revolution, or one of two halves that are mirror images.
    /// type: `"sector"`, `"half"`
    pub kind: Text,
    /// Through the origin: the axis of revolution of a sector, the *normal* of the plane between
    /// halves.
    /// type: `"x"`, `"y"`, `"z"`
    pub axis: Text,
    /// Of a sector, which needs it, from θ = 0 to α; θ counts about z from x to y, about x from y to
    /// z, about y from z to x.
    /// type: angle, 0 < α ≤ 180°
    /// default: –
    pub angle: Option<RawAmount>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawMaterial {
    /// The law of stress and strain.
    /// type: words of materials::Model
    pub model: Text,
    /// Young's modulus E.
    /// for: linear-elastic, mohr-coulomb, external
    /// type: stress > 0
    /// default: required
    pub young_modulus: Option<RawAmount>,
    /// Poisson's ratio ν.
    /// for: linear-elastic, mohr-coulomb, external
    /// type: number, −1 < ν < 0.5
    /// default: required
    pub poisson_ratio: Option<RawAmount>,
    /// Cohesion c; greater than 0 if φ is 0.
    /// for: mohr-coulomb
    /// type: stress ≥ 0
    /// default: required
    pub cohesion: Option<RawAmount>,
    /// Angle of friction φ.
    /// for: mohr-coulomb
    /// type: angle, 0 ≤ φ < 90°
    /// default: required
    pub friction_angle: Option<RawAmount>,
    /// Angle of dilation ψ.
    /// for: mohr-coulomb
    /// type: angle, 0 ≤ ψ ≤ φ
    /// default: 0
    pub dilation_angle: Option<RawAmount>,
    /// Greatest tension T in any direction.
    /// for: mohr-coulomb
    /// type: stress, 0 ≤ T ≤ c cot φ
    /// default: c cot φ; required for φ = 0
    pub tension_cutoff: Option<RawAmount>,
    /// Weight by volume at the start; divided by 9.81 m/s², whatever gravity is.
    /// type: unit weight > 0
    /// default: –
    pub unit_weight: Option<RawAmount>,
    /// Mass by volume at the start.
    /// type: density > 0
    /// default: –
    pub density: Option<RawAmount>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawBody {
    /// All elements of volumes of the mesh; no two bodies the same at the same time.
    /// type: name or list of names
    /// default: –
    pub volume: Option<Texts>,
    /// The seeding points of any element that lie in a solid, see [regions](#regions).
    /// type: table
    /// default: –
    pub region: Option<Spanned<RawRegion>>,
    /// A name under `materials`.
    /// type: name
    pub material: Text,
    /// Particles to begin with, all with the same share of the element's volume.
    /// type: 1, 4 or 10
    /// default: 4
    pub particles_per_element: Option<Spanned<i64>>,
    /// Distance between particles, instead of their number in each element: where fine elements of a
    /// [moving mesh](#mesh-motion) will come by. A length, or a table that
    /// [grades](#particle-spacing) it. At least four particles are in each element.
    /// type: length > 0, or `{ start, end, points }`
    /// default: –
    pub particle_spacing: Option<Spanned<AmountOr<RawSpacing>>>,
    /// Horizontal over vertical [initial stress](#initial-stress); without it the body has none. Not
    /// for a body that a stage adds.
    /// type: number > 0
    /// default: –
    pub k0: Option<RawAmount>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawSpacing {
    /// One end of the line that distances are taken from.
    /// type: length × 3
    pub start: RawVector,
    /// Its other end.
    /// type: length × 3
    pub end: RawVector,
    /// Distance from the line and spacing; linear between points, constant beyond the first and the
    /// last.
    /// type: list of length × 2; distances increasing
    pub points: Spanned<Vec<RawVector>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawMeshMotion {
    /// The body that takes the mesh along; it fills whole elements.
    /// type: name
    pub driver: Text,
    /// Volumes of the mesh that go rigidly with the driver; its own need not be among them.
    /// type: name or list of names
    pub moving: Texts,
    /// Volumes that are compressed and stretched between the moving ones and where the mesh is held.
    /// Every element is the driver's, moving or of the blend.
    /// type: name or list of names
    /// default: none
    pub blend: Option<Texts>,
    /// Along which the mesh moves.
    /// type: number × 3, not 0
    /// default: that of gravity
    pub direction: Option<RawVector>,
    /// How far `moldwarp check` looks for elements that will hold too few particles.
    /// type: length > 0
    /// default: half the way ahead of the moving volumes
    pub travel: Option<RawAmount>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawRegion {
    /// Which solid.
    /// type: words of bodies::Kind
    /// default: "box"
    pub kind: Option<Text>,
    /// The corner with the least coordinates.
    /// for: box
    /// type: length × 3
    /// default: required
    pub min: Option<RawVector>,
    /// The corner with the greatest, each greater than that of `min`.
    /// for: box
    /// type: length × 3
    /// default: required
    pub max: Option<RawVector>,
    /// One end of the axis; the apex of a cone.
    /// for: cylinder, cone
    /// type: length × 3
    /// default: required
    pub start: Option<RawVector>,
    /// Its other end.
    /// for: cylinder, cone
    /// type: length × 3
    /// default: required
    pub end: Option<RawVector>,
    /// Of the sphere.
    /// for: sphere
    /// type: length × 3
    /// default: required
    pub centre: Option<RawVector>,
    /// Of the sphere, of the cylinder round its axis, of the cone at its end.
    /// for: sphere, cylinder, cone
    /// type: length > 0
    /// default: required
    pub radius: Option<RawAmount>,
    /// Any point of the plane.
    /// for: half-space
    /// type: length × 3
    /// default: required
    pub point: Option<RawVector>,
    /// Of any length; points out of the body.
    /// for: half-space
    /// type: number × 3; not all 0
    /// default: required
    pub normal: Option<RawVector>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawBoundary {
    /// For `--set`; no two the same.
    /// type: text
    /// default: surfaces' names joined by `+`
    pub name: Option<Text>,
    /// Surfaces of the mesh.
    /// type: name or list of names
    pub surface: Texts,
    /// See below.
    /// type: words of boundaries::Kind
    pub kind: Text,
    /// The directions that are held.
    /// for: fixed
    /// type: one or a list of "x", "y", "z"
    /// default: all three
    pub directions: Option<Texts>,
    /// Of the surface; `"free"` leaves the direction free; not all three.
    /// for: prescribed
    /// type: velocity × 3, or `"free"` per component
    /// default: required
    pub velocity: Option<RawVector>,
    /// Factor of the velocity over time, see [functions](#functions-of-time).
    /// for: prescribed
    /// type: table
    /// default: constant
    pub function: Option<Spanned<RawFunction>>,
    /// The dashpot's α (Eq. 17 of the paper).
    /// for: absorbing
    /// type: number > 0, or [normal, shear]
    /// default: 1
    pub alpha: Option<Spanned<OneOrMany<Amount>>>,
    /// The spring's δ (Eq. 20).
    /// for: absorbing
    /// type: length > 0, or [normal, shear]
    /// default: none: dashpot alone
    pub virtual_thickness: Option<Spanned<OneOrMany<Amount>>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawLoad {
    /// For `--set`; no two the same.
    /// type: text
    /// default: surfaces' names joined by `+`
    pub name: Option<Text>,
    /// Surfaces of the mesh; each triangle must touch the body.
    /// type: name or list of names
    pub surface: Texts,
    /// Whose particles carry the load.
    /// type: name
    /// default: the only body
    pub body: Option<Text>,
    /// Force per area of the surface at the start.
    /// type: stress × 3
    /// default: –
    pub traction: Option<RawVector>,
    /// Against the body, along the normal at the start; negative pulls. A table grows with
    /// [depth](#pressure-with-depth).
    /// type: stress, or table
    /// default: –
    pub pressure: Option<Spanned<AmountOr<RawLinear>>>,
    /// Of the whole surface, spread evenly over its area.
    /// type: force × 3
    /// default: –
    pub force: Option<RawVector>,
    /// What holds the body's [initial stress](#initial-stress) at the surface: a face that it
    /// supports does not move.
    /// type: true
    /// default: –
    pub initial_stress: Option<Spanned<bool>>,
    /// Factor over time, see [functions](#functions-of-time).
    /// type: table
    /// default: constant
    pub function: Option<Spanned<RawFunction>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawContact {
    /// Part of its columns' names in the history, and for `--set`: no dot, comma, quote or line
    /// break; no two the same.
    /// type: text
    /// default: names of the bodies, as in `anchor-clay+sand`
    pub name: Option<Text>,
    /// The two sides: each a body, or a list of bodies that hang together.
    /// type: list of 2, each a name or a list of names
    pub bodies: Spanned<Vec<Texts>>,
    /// Coefficient of friction μ.
    /// type: number ≥ 0
    /// default: 0
    pub friction: Option<RawAmount>,
    /// What may be held along the surface without any pressure; nothing is held along the normal.
    /// type: stress ≥ 0
    /// default: 0
    pub adhesion: Option<RawAmount>,
    /// Where the sides meet.
    /// type: words of plan/contact::ContactSurface
    /// default: "free"
    pub surface: Option<Text>,
    /// Whether the sides may approach as long as there is a gap between them; if not, they may not
    /// from the moment that they share nodes.
    /// type: true or false
    /// default: true, but false where a body is of a plastic material in some stage
    pub gap_check: Option<Spanned<bool>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawLinear {
    /// Pressure at the level.
    /// type: stress
    pub value: RawAmount,
    /// More for each length below the level; less above it.
    /// type: unit weight
    pub gradient: RawAmount,
    /// Elevation of the value, against gravity from the origin.
    /// type: length
    pub level: RawAmount,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawFunction {
    /// See below.
    /// type: words of functions::Kind
    pub kind: Text,
    /// Of the ramp, or of one pulse.
    /// for: ramp, half-sine
    /// type: time > 0
    /// default: required
    pub duration: Option<RawAmount>,
    /// From one pulse's begin to the next one's.
    /// for: half-sine
    /// type: time ≥ `duration`
    /// default: required if `count` > 1
    pub period: Option<RawAmount>,
    /// Number of pulses.
    /// for: half-sine
    /// type: whole number ≥ 1
    /// default: 1
    pub count: Option<Spanned<i64>>,
    /// At least one; times increasing.
    /// for: table
    /// type: list of [time, number]
    /// default: required
    pub points: Option<Spanned<Vec<RawVector>>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawProbe {
    /// A surface of the mesh.
    /// type: name
    /// default: –
    pub surface: Option<Text>,
    /// A point: follows the particle nearest to it at the start; inside the mesh's bounding box.
    /// type: length × 3
    /// default: –
    pub point: Option<RawVector>,
    /// A body: mass-weighted mean of its particles.
    /// type: name
    /// default: –
    pub body: Option<Text>,
    /// A volume of the mesh: what is in its elements; for `volume` only.
    /// type: name
    /// default: –
    pub volume: Option<Text>,
    /// What is recorded, each once; see below.
    /// type: one or a list of words of plan::Quantity
    pub quantities: Texts,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawNumerics {
    /// How the [internal force](../theory/method.md#1-particles-to-nodes) is integrated.
    /// type: words of plan::Integration
    /// default: "mixed"
    pub integration: Option<Text>,
    /// How velocities go between nodes and particles: with the accelerations that particles
    /// receive and the averages that move the nodes both corrected for what averaging takes from
    /// short waves, or `"lumped"`, without correction, as in the paper (steps are then longer where
    /// elements are partly empty). See [the correction for
    /// averaging](../theory/method.md#the-correction-for-averaging).
    /// type: words of plan::MassMatrix
    /// default: "corrected"
    pub mass: Option<Text>,
    /// [Nodal mixed discretisation](../theory/method.md#5-strain); `"conjugate"`, for comparison,
    /// smooths mean stresses too.
    /// type: true, false, `"conjugate"`
    /// default: true
    pub smoothing: Option<Spanned<Switch>>,
    /// Share of the critical step.
    /// type: number, 0 < C ≤ 1
    /// default: 0.5
    pub courant: Option<RawAmount>,
    /// Rate at which particle velocities relax to the mesh's.
    /// type: rate ≥ 0
    /// default: 0
    pub pic_rate: Option<RawAmount>,
    /// Stiffness-proportional viscosity: the time β, or the fraction of critical for a mode of
    /// that period, β = fraction · period/π.
    /// type: time ≥ 0, or `{ fraction, period }`
    /// default: 0
    pub viscosity: Option<Spanned<AmountOr<RawViscosity>>>,
    /// Local (Cundall) damping.
    /// type: number, 0 ≤ α < 1
    /// default: 0
    pub damping: Option<RawAmount>,
    /// Forces a step; refused above the stable one.
    /// type: time > 0
    /// default: –
    pub time_step: Option<RawAmount>,
    /// Upper bound; not together with `time_step`.
    /// type: time > 0
    /// default: –
    pub max_time_step: Option<RawAmount>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawViscosity {
    /// Of critical damping.
    /// type: number ≥ 0
    pub fraction: RawAmount,
    /// Of the mode that is damped by this fraction.
    /// type: time > 0
    pub period: RawAmount,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawStage {
    /// For `--set` and the log; no two the same.
    /// type: text
    pub name: Text,
    /// `"equilibrium"`: it ends when the model is at rest, and stops the run (exit code 5) if that
    /// takes longer than `duration`.
    /// type: `"equilibrium"`
    /// default: –
    pub until: Option<Text>,
    /// Its length in time; the last step is cut to end there.
    /// type: time > 0
    /// default: –
    pub duration: Option<RawAmount>,
    /// Its length in steps.
    /// type: whole number ≥ 1
    /// default: –
    pub steps: Option<Spanned<i64>>,
    pub equilibrium: Option<Spanned<RawEquilibrium>>,
    /// Another material for the body of this name from the stage's beginning, of the same density.
    /// Stresses stay, and are returned to the new strength in the first step.
    /// type: name
    /// default: none
    #[serde(default)]
    pub material: Named<Text>,
    /// Bodies that come when the stage begins, at rest and free of stress, in the mesh as it then is.
    /// What no earlier stage has removed is not there until then.
    /// type: name or list of names
    /// default: none
    pub add: Option<Texts>,
    /// Bodies that are taken away when the stage begins. Their loads must be `off` by then.
    /// type: name or list of names
    /// default: none
    pub remove: Option<Texts>,
    /// Boundaries and loads, by name, that are switched on when the stage begins. What no earlier
    /// stage has switched off is off until then.
    /// type: name or list of names
    /// default: none
    pub on: Option<Texts>,
    /// Boundaries and loads, by name, that are switched off (released) when the stage begins.
    /// type: name or list of names
    /// default: none
    pub off: Option<Texts>,
    /// Factors of loads, by name, and of `gravity`; all are 1 at the start and stay as a stage
    /// leaves them. A number changes at once, a [ramp](#ramps) by and by.
    /// type: names, each with a number or a table
    /// default: none
    #[serde(default)]
    pub scale: Named<AmountOr<RawRamp>>,
    /// `"displacement"`: displacements of particles and surfaces count from the stage's beginning.
    /// type: list of `"displacement"`
    /// default: none
    pub reset: Option<Texts>,
    /// Local damping in this stage.
    /// type: number, 0 ≤ α < 1
    /// default: that of `numerics`
    pub damping: Option<RawAmount>,
    /// Given to the whole body of this name when the stage begins.
    /// type: velocity × 3
    /// default: none
    #[serde(default)]
    pub initial_velocity: Named<RawVector>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawRamp {
    /// Factor at the stage's beginning.
    /// type: number
    /// default: what it is by then
    pub from: Option<RawAmount>,
    /// Factor at the end of the ramp, and from then on.
    /// type: number
    pub to: RawAmount,
    /// How long the ramp takes.
    /// type: time > 0
    pub over: RawAmount,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawEquilibrium {
    /// Most that the out-of-balance ratio may be.
    /// type: number > 0
    /// default: 0.01
    pub unbalanced: Option<RawAmount>,
    /// Most that the grid's kinetic energy may be of its reference.
    /// type: number > 0
    /// default: 1e-4
    pub kinetic: Option<RawAmount>,
    /// How long both must hold.
    /// type: time > 0
    /// default: time of a P-wave through the model
    pub hold: Option<RawAmount>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawInitialStress {
    /// How it is found.
    /// type: `"k0"`
    pub kind: Text,
    /// Pressure on the ground's surface. A load must bring it, too.
    /// type: stress ≥ 0
    /// default: 0
    pub surcharge: Option<RawAmount>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawOutput {
    /// Frames for ParaView: n gives n + 1 frames from t = 0 to the end; 0 none at all.
    /// type: whole number ≥ 0
    /// default: 50
    pub frames: Option<Spanned<i64>>,
    /// Time between frames, instead of `frames`.
    /// type: time > 0
    /// default: –
    pub frame_interval: Option<RawAmount>,
    /// Rows of `history.csv`: n gives n + 1 rows.
    /// type: whole number ≥ 1
    /// default: 1000
    pub history: Option<Spanned<i64>>,
    /// Time between rows, instead of `history`.
    /// type: time > 0
    /// default: –
    pub history_interval: Option<RawAmount>,
    /// Wall time between [checkpoints](output.md#checkpoints). There is one before the first step and
    /// at the end of each stage but the last, whatever this is; on a slow disk others come so seldom that they
    /// take 2 % of the time.
    /// type: time > 0
    /// default: 5 min
    pub checkpoint_interval: Option<RawAmount>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawCompare {
    /// Of the history: `<probe>.<quantity>.<component>`, `contact.<name>.<what>` or `energy.<kind>`.
    /// type: text
    pub column: Text,
    /// What is expected: CSV with a header row; the first two columns are time (s) and value (SI), times not
    /// decreasing.
    /// type: path
    pub file: Text,
}
