//! What is switched on, and how strongly, at an instant of the run.

use crate::plan::{Item, Level, Plan, Ramp, Stage};

/// A factor that may be on its way from one value to another.
#[derive(Clone, Copy, Debug)]
struct Factor {
    on: bool,
    from: f64,
    to: f64,
    /// Start of the way, s since the run's start, and how long it takes.
    start: f64,
    over: f64,
}

crate::saved!(Factor {
    on,
    from,
    to,
    start,
    over
});
crate::saved!(Switches {
    boundaries,
    loads,
    gravity
});

impl Factor {
    fn value(&self, time: f64) -> f64 {
        if !self.on {
            return 0.0;
        }
        let since = time - self.start;
        if since >= self.over {
            self.to
        } else {
            self.from + (self.to - self.from) * (since / self.over).max(0.0)
        }
    }

    fn ramp(&mut self, ramp: &Ramp, time: f64) {
        let now = Factor { on: true, ..*self }.value(time);
        *self = Factor {
            on: self.on,
            from: ramp.from.unwrap_or(now),
            to: ramp.to,
            start: time,
            over: ramp.over,
        };
    }
}

/// The state of boundaries, loads and gravity.
#[derive(Clone, Debug)]
pub(crate) struct Switches {
    /// Whether each boundary is on.
    pub boundaries: Vec<bool>,
    loads: Vec<Factor>,
    gravity: Factor,
}

impl Switches {
    /// As before the first stage.
    pub fn new(plan: &Plan) -> Switches {
        let factor = |on| Factor {
            on,
            from: 1.0,
            to: 1.0,
            start: 0.0,
            over: 0.0,
        };
        let boundary = |b| plan.on_at_the_start(Item::Boundary(b));
        let load = |l| factor(plan.on_at_the_start(Item::Load(l)));
        Switches {
            boundaries: (0..plan.boundaries.len()).map(boundary).collect(),
            loads: (0..plan.loads.len()).map(load).collect(),
            gravity: factor(true),
        }
    }

    /// What a stage that begins at `time` changes. Says whether boundaries are among it.
    pub fn begin(&mut self, stage: &Stage, time: f64) -> bool {
        let mut boundaries = false;
        let switched = stage.off.iter().map(|i| (i, false));
        for (item, on) in switched.chain(stage.on.iter().map(|i| (i, true))) {
            match *item {
                Item::Boundary(b) => {
                    boundaries |= self.boundaries[b] != on;
                    self.boundaries[b] = on;
                }
                Item::Load(l) => self.loads[l].on = on,
            }
        }
        for (level, ramp) in &stage.levels {
            match *level {
                Level::Gravity => self.gravity.ramp(ramp, time),
                Level::Load(l) => self.loads[l].ramp(ramp, time),
            }
        }
        boundaries
    }

    /// Factor of a load, 0 if it is off.
    pub fn load(&self, load: usize, time: f64) -> f64 {
        self.loads[load].value(time)
    }

    /// Factor of gravity.
    pub fn gravity(&self, time: f64) -> f64 {
        self.gravity.value(time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_goes_on_from_where_it_is() {
        let mut factor = Factor {
            on: true,
            from: 1.0,
            to: 1.0,
            start: 0.0,
            over: 0.0,
        };
        let ramp = |from, to, over| Ramp { from, to, over };
        factor.ramp(&ramp(None, 0.0, 4.0), 10.0);
        assert_eq!(
            [10.0, 11.0, 14.0, 99.0].map(|t| factor.value(t)),
            [1.0, 0.75, 0.0, 0.0]
        );
        factor.ramp(&ramp(None, 2.0, 1.0), 12.0);
        assert_eq!(
            [12.0, 12.5, 13.0].map(|t| factor.value(t)),
            [0.5, 1.25, 2.0]
        );
        factor.ramp(&ramp(Some(0.0), 1.0, 0.0), 20.0);
        assert_eq!(factor.value(20.0), 1.0);
        factor.on = false;
        assert_eq!(factor.value(20.0), 0.0);
    }
}
