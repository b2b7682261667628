//! Where the time of the step goes.

use std::time::{Duration, Instant};

/// A part of the step, or what is done between steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub enum Part {
    Remap,
    Strain,
    Points,
    Mesh,
    Locate,
    Order,
    ToNodes,
    Forces,
    TimeStep,
    Nodes,
    Receive,
    ToParticles,
    Output,
    Between,
}

impl Part {
    /// All parts in the order in which a step goes through them, as people call them.
    pub const ALL: [(Part, &'static str); 14] = [
        (Part::Remap, "4 remap"),
        (Part::Strain, "5 strain"),
        (Part::Points, "6 stress, 7 move, 1 sums"),
        (Part::Mesh, "8 mesh"),
        (Part::Locate, "8 elements of particles"),
        (Part::Order, "8 order of particles"),
        (Part::ToNodes, "1 particles to nodes"),
        (Part::Forces, "1 stresses of elements"),
        (Part::TimeStep, "  time step"),
        (Part::Nodes, "2 nodes, contact"),
        (Part::Receive, "2 correction of the mass"),
        (Part::ToParticles, "3 nodes to particles"),
        (Part::Output, "output: frames, checkpoints …"),
        (Part::Between, "between steps"),
    ];
}

/// Time spent in each part so far.
#[derive(Clone, Debug)]
pub struct Profile {
    last: Instant,
    spent: [Duration; Part::ALL.len()],
}

impl Default for Profile {
    fn default() -> Profile {
        Profile {
            last: Instant::now(),
            spent: [Duration::ZERO; Part::ALL.len()],
        }
    }
}

impl Profile {
    /// The time since the last call was spent in this part.
    pub(crate) fn lap(&mut self, part: Part) {
        let now = Instant::now();
        self.spent[part as usize] += now - self.last;
        self.last = now;
    }

    /// Names of the parts and the time spent in each.
    pub fn spent(&self) -> impl Iterator<Item = (&'static str, Duration)> + '_ {
        Part::ALL
            .iter()
            .map(|&(part, name)| (name, self.spent[part as usize]))
    }
}
