//! Stages: what changes when, and when they end.

use super::Plan;
use crate::Vec3;

/// A part of the run. What it does not change stays as it was.
#[derive(Clone, Debug)]
pub struct Stage {
    pub name: String,
    pub until: Until,
    /// Local damping in this stage, if it differs from [`super::Numerics::damping`].
    pub damping: Option<f64>,
    /// Velocities given to whole bodies when the stage begins, m/s.
    pub initial_velocities: Vec<(usize, Vec3)>,
    /// Bodies that are of another material from the stage's beginning: indices into [`Plan::bodies`]
    /// and [`Plan::materials`]. Mass, stress and state stay.
    pub materials: Vec<(usize, usize)>,
    /// Bodies that are taken away when the stage begins: indices into [`Plan::bodies`].
    pub remove: Vec<usize>,
    /// Bodies that come when the stage begins, at rest and free of stress. What a stage adds without
    /// an earlier one having removed it is not there at the start.
    pub add: Vec<usize>,
    /// Switched on when the stage begins. What a stage switches on without an earlier one having
    /// switched it off is off from the start.
    pub on: Vec<Item>,
    /// Switched off when the stage begins.
    pub off: Vec<Item>,
    /// Factors that change.
    pub levels: Vec<(Level, Ramp)>,
    /// Displacements count from the stage's beginning.
    pub reset_displacement: bool,
}

/// What can be switched. Indices into the plan's lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    Boundary(usize),
    Load(usize),
}

/// What has a factor, 1 at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    Gravity,
    /// Index into [`Plan::loads`].
    Load(usize),
}

/// A factor that goes from its present value, or `from`, to `to` in the first `over` s of the
/// stage, at once if that is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramp {
    pub from: Option<f64>,
    pub to: f64,
    pub over: f64,
}

/// When a stage ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Until {
    /// After this time, s.
    Duration(f64),
    /// After so many steps.
    Steps(u64),
    /// When the model is at rest; it stops the run if that takes longer than `limit` s.
    Equilibrium { limit: f64, judged: Equilibrium },
}

/// What counts as rest, see `measure/equilibrium.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// Most that the out-of-balance ratio may be.
    pub unbalanced: f64,
    /// Most that the grid's kinetic energy may be, as a share of the reference.
    pub kinetic: f64,
    /// How long both must hold, s; the time a wave takes through the model if not given.
    pub hold: Option<f64>,
}

impl Default for Equilibrium {
    fn default() -> Equilibrium {
        Equilibrium {
            unbalanced: 0.01,
            kinetic: 1e-4,
            hold: None,
        }
    }
}

impl Stage {
    /// A stage that changes nothing.
    pub fn new(name: impl Into<String>, until: Until) -> Stage {
        Stage {
            name: name.into(),
            until,
            damping: None,
            initial_velocities: Vec::new(),
            materials: Vec::new(),
            remove: Vec::new(),
            add: Vec::new(),
            on: Vec::new(),
            off: Vec::new(),
            levels: Vec::new(),
            reset_displacement: false,
        }
    }
}

impl Plan {
    /// Whether a body is there before the first stage begins.
    pub fn there_at_the_start(&self, body: usize) -> bool {
        let mut stages = self.stages.iter();
        let first = stages.find(|s| s.add.contains(&body) || s.remove.contains(&body));
        first.is_none_or(|s| !s.add.contains(&body))
    }

    /// Whether an item is on before the first stage begins.
    pub fn on_at_the_start(&self, item: Item) -> bool {
        let first = self
            .stages
            .iter()
            .find(|s| s.on.contains(&item) || s.off.contains(&item));
        first.is_none_or(|s| !s.on.contains(&item))
    }
}
