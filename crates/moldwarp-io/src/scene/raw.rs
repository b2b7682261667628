//! What the user wrote: the scene's keys and shapes, with places, before anything is checked.

use super::amount::{Amount, AmountOr, Named, OneOrMany, RawVector, Spanned};
use serde::Deserialize;
use serde::de::IgnoredAny;

pub(super) type Text = Spanned<String>;
pub(super) type Texts = Spanned<OneOrMany<String>>;
pub(super) type RawAmount = Spanned<Amount>;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawScene {
    /// Looked at before the rest is read.
    #[serde(rename = "version")]
    pub _version: IgnoredAny,
    pub title: Option<String>,
    pub gravity: RawVector,
    pub mesh: Spanned<RawMesh>,
    pub symmetry: Option<Spanned<RawSymmetry>>,
    pub materials: Named<RawMaterial>,
    pub bodies: Named<RawBody>,
    #[serde(default)]
    pub boundaries: Vec<Spanned<RawBoundary>>,
    #[serde(default)]
    pub loads: Vec<Spanned<RawLoad>>,
    #[serde(default)]
    pub probes: Named<RawProbe>,
    #[serde(default)]
    pub numerics: RawNumerics,
    #[serde(default)]
    pub stages: Vec<Spanned<RawStage>>,
    #[serde(default)]
    pub output: RawOutput,
    #[serde(default)]
    pub compare: Vec<RawCompare>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawMesh {
    pub file: Option<Text>,
    pub unit: Option<Text>,
    #[serde(rename = "box")]
    pub cuboid: Option<Spanned<RawBox>>,
    pub cylinder: Option<Spanned<RawCylinder>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawBox {
    pub size: RawVector,
    pub cells: Spanned<Vec<Spanned<i64>>>,
}

/// Rows of a profile: radius and height.
pub(super) type RawProfile = Spanned<Vec<RawVector>>;
/// Values for directions, the last one perhaps for each segment of a profile.
pub(super) type RawDirections<T> = Spanned<Vec<Spanned<OneOrMany<T>>>>;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawCylinder {
    pub profile: RawProfile,
    pub inner: Option<RawProfile>,
    pub angle: RawAmount,
    pub cells: RawDirections<i64>,
    pub grading: Option<RawDirections<Amount>>,
    pub split: Option<Text>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawSymmetry {
    pub kind: Text,
    pub axis: Text,
    pub angle: Option<RawAmount>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawMaterial {
    pub model: Text,
    pub young_modulus: Option<RawAmount>,
    pub poisson_ratio: Option<RawAmount>,
    pub cohesion: Option<RawAmount>,
    pub friction_angle: Option<RawAmount>,
    pub dilation_angle: Option<RawAmount>,
    pub tension_cutoff: Option<RawAmount>,
    pub unit_weight: Option<RawAmount>,
    pub density: Option<RawAmount>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawBody {
    pub volume: Option<Text>,
    pub region: Option<Spanned<RawRegion>>,
    pub material: Text,
    pub particles_per_element: Option<Spanned<i64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawRegion {
    pub kind: Option<Text>,
    pub min: Option<RawVector>,
    pub max: Option<RawVector>,
    pub start: Option<RawVector>,
    pub end: Option<RawVector>,
    pub centre: Option<RawVector>,
    pub radius: Option<RawAmount>,
    pub point: Option<RawVector>,
    pub normal: Option<RawVector>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawBoundary {
    pub name: Option<Text>,
    pub surface: Texts,
    pub kind: Text,
    pub directions: Option<Texts>,
    pub velocity: Option<RawVector>,
    pub function: Option<Spanned<RawFunction>>,
    pub alpha: Option<Spanned<OneOrMany<Amount>>>,
    pub virtual_thickness: Option<Spanned<OneOrMany<Amount>>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawLoad {
    pub name: Option<Text>,
    pub surface: Texts,
    pub body: Option<Text>,
    pub traction: Option<RawVector>,
    pub pressure: Option<RawAmount>,
    pub force: Option<RawVector>,
    pub function: Option<Spanned<RawFunction>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawFunction {
    pub kind: Text,
    pub duration: Option<RawAmount>,
    pub period: Option<RawAmount>,
    pub count: Option<Spanned<i64>>,
    pub points: Option<Spanned<Vec<RawVector>>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawProbe {
    pub surface: Option<Text>,
    pub point: Option<RawVector>,
    pub body: Option<Text>,
    pub quantities: Texts,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawNumerics {
    pub integration: Option<Text>,
    pub mass: Option<Text>,
    pub smoothing: Option<bool>,
    pub courant: Option<RawAmount>,
    pub pic_rate: Option<RawAmount>,
    pub viscosity: Option<Spanned<AmountOr<RawViscosity>>>,
    pub damping: Option<RawAmount>,
    pub time_step: Option<RawAmount>,
    pub max_time_step: Option<RawAmount>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawViscosity {
    pub fraction: RawAmount,
    pub period: RawAmount,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawStage {
    pub name: Text,
    pub duration: Option<RawAmount>,
    pub steps: Option<Spanned<i64>>,
    pub damping: Option<RawAmount>,
    #[serde(default)]
    pub initial_velocity: Named<RawVector>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawOutput {
    pub frames: Option<Spanned<i64>>,
    pub frame_interval: Option<RawAmount>,
    pub history: Option<Spanned<i64>>,
    pub history_interval: Option<RawAmount>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawCompare {
    pub column: Text,
    pub file: Text,
}
