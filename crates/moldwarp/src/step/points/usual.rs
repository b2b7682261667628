//! The usual slot: of one body, of a material that kernels know, and not at the very end of the arrays. All that the pass does
//! with it is one kernel, so that a particle's numbers go through registers from the arrays and back. Anything else is done
//! in parts (`points.rs`), with the same bits.
//!
//! Arguments that are written are references of their own: in a tuple or a struct they might be the same to the compiler,
//! and its loops would stay scalar. What is done with stresses comes first, and is stored before positions are loaded:
//! there are not enough registers for both.

use super::Own;
use crate::lanes::{
    AHEAD, Held, LANES, Lane, VoigtLanes, any, either, for_each_simd, get, load_one, only, set,
};
use crate::material::{Advanced, Material, STATE_SIZE, SUMMED};
use crate::step::CellSums;
use crate::step::motion::{Motion, go_along, stays};
use crate::step::shapes::Shapes;
use crate::step::strain::Deformation;
use crate::step::stress::{Booked, Points};
use crate::step::sums::{Carried, add_to_closed, add_to_stresses};
use crate::step::to_particles::{Kick, Pending};
use crate::{Mat3, Vec3, tensor};

/// What has been done with a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Done {
    /// Nothing: it is not a usual one.
    Nothing,
    /// Nothing: some have opened.
    NothingAsOpen,
    /// All but Σ σ_p V_p and Σ V_p, and what has to be known for them is at hand: some may have left.
    AllButSums,
    All,
}

for_each_simd! {
    /// Advances a slot, given by where it starts and how many particles it has, and adds to `sum`, if there is one. If not
    /// `OPEN`, nothing in it has opened; if it is still, its state variables that are not only added to are zero, and it stays
    /// so unless it is said to be stirred.
    pub(super) fn advance<const OPEN: bool>(
        arrays: &mut Own,
        mass: &[f64],
        slot: (usize, usize),
        held: &Held,
        is_still: bool,
        model: &Material,
        shapes: &Shapes,
        deformation: &Deformation,
        kick: &mut Kick,
        pending: Option<Pending>,
        gravity: Vec3,
        points: &mut Points,
        motion: &mut Motion,
        booked: &mut Booked,
        stirred: &mut bool,
        carried: &mut Carried,
        has_opened: &mut bool,
        sum: Option<&mut CellSums>,
    ) -> Done {
        let (start, count) = slot;
        let Own { stressed: (stresses, states, volumes), position, velocity } = arrays;
        let there = stresses.has_all(start) & states.has_all(start) & volumes.has_all(start);
        let there = there & position.has_all(start) & velocity.has_all(start);
        if !there | (mass.len() < LANES) {
            return Done::Nothing;
        }

        let mut volume = only(held, &volumes.one(0, start));
        // Those that are only added to need not be there before they change.
        let mut state = [Lane::of(0.0); STATE_SIZE];
        if !is_still {
            for k in SUMMED..STATE_SIZE {
                state[k] = states.one(k, start);
            }
        }
        if let (false, Some(k)) = (OPEN, model.opening())
            && any(&*only(&volume, &state[k]))
        {
            return Done::NothingAsOpen;
        }
        position.prefetch(start + AHEAD);
        velocity.prefetch(start + AHEAD);
        let mut stress = stresses.all(start);
        let advanced =
            turn_and_strain::<OPEN>(model, deformation, &mut stress, &mut state, &mut volume, booked);
        let Some(advanced) = advanced else {
            return Done::Nothing;
        };
        stresses.prefetch(start + AHEAD);
        stresses.put::<S>(&stress, start, count);
        volumes.put::<S>(&[volume], start, count);
        if advanced.changed {
            *stirred = true;
            for k in 0..SUMMED {
                let old = states.one(k, start);
                for l in 0..LANES {
                    state[k][l] += old[l];
                }
            }
            states.put::<S>(&state, start, count);
            states.prefetch_some(0..SUMMED, start + AHEAD);
        }
        if !is_still {
            states.prefetch_some(SUMMED..STATE_SIZE, start + AHEAD);
        }
        volumes.prefetch(start + AHEAD);

        let (mut x, mut v) = (position.all(start), velocity.all(start));
        let mut own = Lane::of(0.0);
        load_one(&mut own, mass, 0);
        let mass = only(held, &own);
        for k in 0..3 {
            (x[k], v[k]) = (only(&mass, &x[k]), only(&mass, &v[k]));
        }
        if let Some(pending) = pending {
            for l in 0..LANES {
                let arm = shapes.arm(l, Vec3::from_array(get(&x, l)));
                let new = kick.receive(l, arm, Vec3::from_array(get(&v, l)), pending);
                set(&mut v, l, new.to_array());
            }
        }
        velocity.put::<S>(&v, start, count);
        carried.velocity = v;
        let mut left = Lane::of(0.0);
        for l in 0..LANES {
            kick.count(l, mass[l], Vec3::from_array(get(&v, l)));
            let (new, way, n) = go_along(shapes, deformation, l, Vec3::from_array(get(&x, l)));
            motion.count(l, mass[l] * gravity.dot(way));
            set(&mut x, l, new.to_array());
            set(&mut carried.shapes, l, n);
            left[l] = either(stays(n, mass[l]), 0.0, 1.0);
        }
        position.put::<S>(&x, start, count);
        carried.mass = mass;
        let some_left = any(&*left);

        if let (Some(sum), false) = (sum, some_left) {
            if advanced.open && !*has_opened {
                *has_opened = true;
                (sum.solid, sum.closed) = (sum.volume, sum.volume);
            }
            add_to_stresses(&stress, &volume, sum);
            if *has_opened {
                let (mut solid, mut closed) = (Lane::of(1.0), Lane::of(1.0));
                if advanced.open {
                    model.find_closed(&stress, &state, &mut solid, &mut closed);
                }
                add_to_closed([&solid, &closed], &volume, sum);
            }
            return Done::All;
        }
        motion.come_to(x, left, some_left);
        points.come_to(stress, state, volume, advanced.open);
        Done::AllButSums
    }
}

/// New stresses, state variables and volumes, and the work on them. None where this is no way to find them: then nothing is
/// booked.
#[inline(always)]
fn turn_and_strain<const OPEN: bool>(
    model: &Material,
    deformation: &Deformation,
    stress: &mut VoigtLanes,
    state: &mut [Lane; STATE_SIZE],
    volume: &mut Lane,
    booked: &mut Booked,
) -> Option<Advanced> {
    let (mut before, mut dissipated) = ([Lane::of(0.0); 6], Lane::of(0.0));
    let (mut strain, mut left_out, mut growth) = (before, dissipated, dissipated);
    for l in 0..LANES {
        let old = get(stress, l);
        if OPEN {
            let separated = model.is_separated(&old, &get(state, l));
            let own = deformation.of_particle(l, separated);
            set(&mut strain, l, own.0);
            (left_out[l], growth[l]) = (own.1, own.2);
        }
        let turn = Mat3::from_cols_array(&get(&deformation.turn, l));
        set(&mut before, l, tensor::rotate(&old, &turn));
    }
    let (strain, left_out, growth) = match OPEN {
        true => (&strain, &left_out, &growth),
        false => (
            &deformation.strain,
            &deformation.left_out,
            &deformation.growth,
        ),
    };
    let advanced = model.advance::<OPEN>(&before, strain, volume, stress, state, &mut dissipated);
    let advanced = advanced.filter(|advanced| !advanced.odd)?;
    let mut middle = Lane::of(0.0);
    for l in 0..LANES {
        let both = [&before, &*stress].map(|stress| get(stress, l));
        middle[l] = booked.add(l, both, &get(strain, l), left_out[l], volume[l], growth[l]);
        volume[l] *= growth[l];
    }
    if advanced.plastic {
        for l in 0..LANES {
            booked.add_plastic(l, dissipated[l] * middle[l]);
        }
    }
    Some(advanced)
}
