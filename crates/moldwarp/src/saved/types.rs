//! What a state is made of, as far as its fields are open; the rest stands beside its structures.

use crate::boundary::{AbsorbingNode, Function, LoadPoint, Outflown};
use crate::contact::{Mass, Projections, Rigid, State, Tally};
use crate::lanes::{LANES, Lane};
use crate::measure::{Energies, Forces, Scale};
use crate::mesh::{Face, Surface, VolumeGroup};
use crate::particles::Particles;
use crate::saved;
use crate::saved_enum;
use crate::simulation::Clock;
use crate::step::{CellFill, CellForce, CellMedium, CellSums, Cells, Node, Reference};

saved!(Particles {
    id,
    body,
    element,
    position,
    velocity,
    origin,
    stress,
    state,
    volume,
    initial_volume,
    mass,
});

saved!(Node {
    mass,
    velocity,
    acceleration,
    is_acted_on,
    load,
    damping,
    absorbing,
    reaction,
    average,
    grid_velocity,
    moved,
    weighed,
    internal,
});

saved!(CellSums {
    mass,
    volume,
    solid,
    closed,
    stress,
});
saved!(CellMedium {
    moduli,
    wave_modulus,
    reference,
    shares,
});
saved!(CellFill { filled, density });
saved!(CellForce {
    stress,
    smoothed,
    viscous,
    weighed,
});

impl crate::saved::Saved for Lane {
    fn size(&self) -> usize {
        (**self).size()
    }

    fn save(&self, out: &mut crate::saved::Out) {
        (**self).save(out);
    }

    fn load(from: &mut crate::saved::Bytes) -> Result<Lane, crate::saved::Broken> {
        <[f64; LANES]>::load(from).map(Lane::from)
    }
}

/// The sums and stresses of the last kick; all else is written by each step before it is read.
impl crate::saved::Saved for Cells {
    fn size(&self) -> usize {
        let mass = self.mass.values.size();
        let (sums, medium) = (self.sums.size(), self.medium.size());
        mass + sums + medium + self.fills.size() + self.forces.size() + self.shortest.size()
    }

    fn save(&self, out: &mut crate::saved::Out) {
        let Cells {
            sums,
            medium,
            fills,
            forces,
            mass,
            portions: _,
            shortest,
            // Made anew.
            summed: _,
            worked: _,
            stirred: _,
        } = self;
        sums.save(out);
        medium.save(out);
        fills.save(out);
        forces.save(out);
        mass.values.save(out);
        shortest.save(out);
    }

    fn load(from: &mut crate::saved::Bytes) -> Result<Cells, crate::saved::Broken> {
        let mut cells = Cells {
            sums: Vec::load(from)?,
            medium: Vec::load(from)?,
            fills: Vec::load(from)?,
            forces: Vec::load(from)?,
            ..Cells::default()
        };
        cells.mass.values = Vec::load(from)?;
        cells.shortest = f64::load(from)?;
        Ok(cells)
    }
}

saved!(Reference {
    ground,
    k0,
    gravity
});
saved!(Clock {
    time,
    steps,
    stage,
    stage_time,
    stage_steps,
    dt,
    next,
    longest,
    new_constraints,
});

saved!(AbsorbingNode {
    node,
    dashpot,
    spring,
    displacement,
    rest,
});
saved!(Outflown { particles, mass });
saved!(LoadPoint {
    load,
    particle,
    offset,
    force,
});
saved_enum!(Function {
    0 => Constant,
    1 => Ramp { duration },
    2 => Table { points },
    3 => HalfSine { duration, period, count },
});

saved_enum!(State {
    0 => Open,
    1 => Sliding,
    2 => Sticking,
});
saved!(Tally {
    normal,
    tangential,
    sticking,
    sliding,
    open,
});
saved!(Projections {
    count,
    sum,
    greatest,
    work,
});
saved!(Rigid {
    field,
    mass,
    before,
    velocity,
    free,
});
saved!(Mass { inverse, velocity });

saved!(Energies {
    kinetic,
    kinetic_grid,
    elastic,
    gravity,
    load,
    prescribed,
    plastic,
    friction,
    contact,
    damping,
    absorbed,
    removed,
    transfer,
    smoothing,
    integration,
    advection,
    residual,
});
saved!(Forces {
    unbalanced,
    applied
});
saved!(Scale {
    kinetic,
    travel_time
});

saved!(Face { element, local });
saved!(VolumeGroup { name, elements });
saved!(Surface { name, faces });
