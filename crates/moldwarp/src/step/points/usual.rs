//! The usual slot: full arrays, one body, nothing open. All that the pass does with it is one kernel, so that a particle's
//! numbers go through registers from the arrays and back. Anything else is done in parts (`points.rs`), with the same bits.
//!
//! Arguments that are written are references of their own: in a tuple or a struct they might be the same to the compiler,
//! and its loops would stay scalar. What is done with stresses comes first, and is stored before positions are loaded: there are not enough registers for both.

use super::Own;
use crate::lanes::{
    AHEAD, Held, LANES, Lane, any, either, for_each_simd, get, load_one, only, set,
};
use crate::material::Material;
use crate::step::CellSums;
use crate::step::motion::{Motion, go_along, stays};
use crate::step::shapes::Shapes;
use crate::step::strain::Deformation;
use crate::step::stress::{Booked, Points};
use crate::step::sums::{Carried, add_to_stresses};
use crate::step::to_particles::{Kick, Pending};
use crate::{Mat3, Vec3, tensor};

/// What has been done with a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Done {
    /// Nothing: it is not a usual one.
    Nothing,
    /// All but Σ σ_p V_p and Σ V_p, and what has to be known for them is at hand: some may have left or opened.
    AllButSums,
    All,
}

for_each_simd! {
    /// Advances a slot, given by where it starts and how many particles it has, and adds to `sum`, if there is one.
    pub(super) fn advance(
        arrays: &mut Own,
        mass: &[f64],
        slot: (usize, usize),
        held: &Held,
        model: &Material,
        shapes: &Shapes,
        deformation: &Deformation,
        kick: &mut Kick,
        pending: Option<Pending>,
        gravity: Vec3,
        points: &mut Points,
        motion: &mut Motion,
        booked: &mut Booked,
        carried: &mut Carried,
        sum: Option<&mut CellSums>,
    ) -> Done {
        let (start, count) = slot;
        let Own { stressed: (stresses, states, volumes), position, velocity } = arrays;
        let there = stresses.has_all(start) & states.has_all(start) & volumes.has_all(start);
        let there = there & position.has_all(start) & velocity.has_all(start);
        if !there | (mass.len() < LANES) {
            return Done::Nothing;
        }

        let (mut state, [volume]) = (states.all(start), volumes.all(start));
        let mut volume = only(held, &volume);
        if let Some(k) = model.opening()
            && any(&*only(&volume, &state[k])) {
                return Done::Nothing;
            }
        let mut before = stresses.all(start);
        position.prefetch(start + AHEAD);
        velocity.prefetch(start + AHEAD);
        for l in 0..LANES {
            let turn = Mat3::from_cols_array(&get(&deformation.turn, l));
            let turned = tensor::rotate(&get(&before, l), &turn);
            set(&mut before, l, turned);
        }
        let (mut stress, mut dissipated) = ([Lane::of(0.0); 6], Lane::of(0.0));
        let strain = &deformation.strain;
        let advanced = model.advance(&before, strain, &volume, &mut stress, &mut state, &mut dissipated);
        let Some(advanced) = advanced else {
            return Done::Nothing;
        };
        if advanced.odd {
            return Done::Nothing;
        }
        stresses.prefetch(start + AHEAD);
        let mut middle = Lane::of(0.0);
        for l in 0..LANES {
            let both = [&before, &stress].map(|stress| get(stress, l));
            let (growth, left_out) = (deformation.growth[l], deformation.left_out[l]);
            middle[l] = booked.add(l, both, &get(strain, l), left_out, volume[l], growth);
            volume[l] *= growth;
        }
        if advanced.plastic {
            for l in 0..LANES {
                booked.add_plastic(l, dissipated[l] * middle[l]);
            }
        }
        stresses.put::<S>(&stress, start, count);
        volumes.put::<S>(&[volume], start, count);
        if advanced.changed {
            states.put::<S>(&state, start, count);
        }
        states.prefetch(start + AHEAD);
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

        if let (Some(sum), false) = (sum, some_left | advanced.open) {
            add_to_stresses(&stress, &volume, sum);
            return Done::All;
        }
        motion.come_to(x, left, some_left);
        points.come_to(stress, state, volume, advanced.open);
        Done::AllButSums
    }
}
