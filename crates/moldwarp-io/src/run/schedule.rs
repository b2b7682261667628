//! When output is due.

/// Output times 0, Δ, 2Δ, …; each is served by the first step at or after it, so that output
/// never shortens a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Schedule {
    /// Δ, s; infinite if only the start and the end are wanted.
    interval: f64,
    /// Number of the next output time.
    next: u64,
}

moldwarp::saved!(Schedule { interval, next });

impl Schedule {
    /// One output every `interval` s from 0 on.
    pub fn every(interval: f64) -> Schedule {
        Schedule { interval, next: 0 }
    }

    /// Whether output is due at `time`, s. Several times that one step has passed are served at
    /// once.
    pub fn due(&mut self, time: f64) -> bool {
        // A time that is a sum of steps may miss a multiple of Δ by round-off.
        let reached = ((time / self.interval) * (1.0 + 1e-12) + 1e-9).floor() as u64;
        let due = reached >= self.next;
        if due {
            self.next = reached.saturating_add(1);
        }
        due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_step_at_or_after_each_time_serves_it() {
        let mut schedule = Schedule::every(0.3);
        let mut time = 0.0;
        let mut served = Vec::new();
        for step in 0..=20 {
            if schedule.due(time) {
                served.push(step);
            }
            time += 0.1;
        }
        assert_eq!(served, [0, 3, 6, 9, 12, 15, 18]);
    }

    #[test]
    fn a_step_over_several_times_serves_them_once() {
        let mut schedule = Schedule::every(0.1);
        let due = [0.0, 0.35, 0.36, 0.4, 0.7].map(|t| schedule.due(t));
        assert_eq!(due, [true, true, false, true, true]);
        let mut only_start = Schedule::every(f64::INFINITY);
        assert_eq!(
            [0.0, 1.0, 1e9].map(|t| only_start.due(t)),
            [true, false, false]
        );
    }
}
