//! Two bodies at a node: impulses that keep them apart and rub them.
//!
//! With the velocities v_a, v_b that the bodies would have at the node, masses m_a, m_b and the unit
//! normal n from a to b, the bodies approach at r = (v_a − v_b) · n. They may close the gap that is
//! between them, r ≤ gap/Δt. What is beyond is stopped (Jassim et al. Eq. 10–14 in impulses):
//!
//!   J_n = m (r − gap/Δt) ≥ 0,   m = m_a m_b / (m_a + m_b),
//!   |J_t| = min(m |Δv_t|, μ J_n + c_a A h),
//!
//! on b, and against it on a. J_t is 0 where J_n is and the gap is open; surfaces that still touch adhere
//! though nothing presses them together: what slides quivers, and would lose its adhesion each time that
//! it is not pressed for an instant. The reduced mass m is small where one of the bodies hardly supports the
//! node, so the impulses are bounded there though accelerations F/m are not. Where faces of the
//! structure meet at an edge or corner, each has its own normal, and all are satisfied.

use crate::{Mat3, Vec3};

/// Most normals of a node.
pub const NORMALS: usize = 3;
/// Sweeps over the normals and pairs of a node where there are several.
const SWEEPS: usize = 20;

/// What bodies do to each other at a node in a kick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum State {
    #[default]
    Open,
    Sliding,
    Sticking,
}

/// A pair of bodies at a node.
#[derive(Clone, Copy, Debug, Default)]
pub struct Meeting {
    /// Compact numbers of the node in the fields of both; that of a is less.
    pub slots: [u32; 2],
    /// Index into the plan's contacts; none if the bodies stick together.
    pub contact: Option<u32>,
    /// From a to b; as many as `count`.
    pub normals: [Vec3; NORMALS],
    pub count: usize,
    /// Velocity with which each gap may be closed, m/s.
    pub allowed: [f64; NORMALS],
    /// Part of the bodies' common surface, m².
    pub area: f64,
    /// Whether the gap is so small that adhesion works though nothing presses the bodies together.
    pub touching: bool,
    pub state: State,
    /// Impulses on b in the kick, N s.
    normal: [f64; NORMALS],
    tangential: Vec3,
    /// Forces on b, N.
    pub normal_force: Vec3,
    pub friction: Vec3,
}

crate::saved!(Meeting {
    slots,
    contact,
    normals,
    count,
    allowed,
    area,
    touching,
    state,
    normal,
    tangential,
    normal_force,
    friction,
});

/// Friction and adhesion of a pair.
#[derive(Clone, Copy, Debug)]
pub struct Strength {
    /// Coefficient of friction.
    pub friction: f64,
    /// Most that adhesion can give in the kick, N s.
    pub adhesion: f64,
}

/// A body at a node: 1 over its mass there, 1/kg, and its velocity at the end of the kick, m/s. Of a
/// rigid body both are those of the whole body.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mass {
    pub inverse: f64,
    pub velocity: Vec3,
}

impl Meeting {
    /// A pair of which nothing else is known.
    pub fn new(slots: [u32; 2], contact: Option<u32>) -> Meeting {
        Meeting {
            slots,
            contact,
            ..Meeting::default()
        }
    }

    /// Corrects both velocities. Impulses are those of the whole kick so far. Says by how much they
    /// have changed.
    fn sweep(
        &mut self,
        a: &mut Mass,
        b: &mut Mass,
        free: &Mat3,
        strength: Option<Strength>,
    ) -> f64 {
        let mass = 1.0 / (a.inverse + b.inverse);
        let mut changed = 0.0;
        let mut give = |impulse: Vec3| {
            a.velocity -= impulse * a.inverse;
            b.velocity += impulse * b.inverse;
            changed += impulse.length();
            a.velocity - b.velocity
        };
        let mut relative = give(Vec3::ZERO);
        let Some(strength) = strength else {
            let impulse = *free * relative * mass;
            self.tangential += impulse;
            self.state = State::Sticking;
            give(impulse);
            return changed;
        };
        for k in 0..self.count {
            let n = self.normals[k];
            let wanted = self.normal[k] + mass * (relative.dot(n) - self.allowed[k]);
            let change = wanted.max(0.0) - self.normal[k];
            self.normal[k] += change;
            relative = give(n * change);
        }
        let pressed: f64 = self.normal.iter().sum();
        let adheres = self.touching && strength.adhesion > 0.0;
        if pressed == 0.0 && !adheres {
            self.state = State::Open;
            let undo = -self.tangential;
            self.tangential = Vec3::ZERO;
            give(undo);
            return changed;
        }
        let along = self.tangent(*free * relative);
        let limit = strength.friction * pressed + strength.adhesion;
        let wanted = self.tangential + along * mass;
        let size = wanted.length();
        let kept = if size > limit {
            self.state = State::Sliding;
            wanted * (limit / size)
        } else {
            self.state = State::Sticking;
            wanted
        };
        let change = kept - self.tangential;
        self.tangential = kept;
        give(change);
        changed
    }

    /// The part of a vector along all faces.
    fn tangent(&self, v: Vec3) -> Vec3 {
        let mut rest = v;
        let mut directions: [Vec3; NORMALS] = [Vec3::ZERO; NORMALS];
        for k in 0..self.count {
            let mut n = self.normals[k];
            for d in &directions[..k] {
                n -= *d * d.dot(n);
            }
            let n = n.normalize_or_zero();
            directions[k] = n;
            rest -= n * n.dot(rest);
        }
        rest
    }

    /// No impulses yet.
    pub fn begin(&mut self) {
        (self.normal, self.tangential) = ([0.0; NORMALS], Vec3::ZERO);
        self.state = State::Open;
    }

    /// Forces of the impulses of a kick of length `h`.
    pub fn settle(&mut self, h: f64) {
        let normals = self.normals.iter().zip(self.normal);
        self.normal_force = normals.map(|(n, j)| *n * j).sum::<Vec3>() / h;
        self.friction = self.tangential / h;
    }

    /// Corrects the velocities that move the nodes, in the state of the kick: what has stuck moves
    /// together, what slides does so along the normals and never against the friction of the kick, what is
    /// open is left alone, and what adheres without pressure is free along the normals. What was pressed together in the kick does not part in the drift that follows either: were only approach stopped,
    /// forces would do work on every accidental departure and take none back, and bodies that rest on
    /// each other would shake more and more. Friction, likewise, would drive what slides back in the drift.
    fn move_together(&self, a: &mut Mass, b: &mut Mass, free: &Mat3) {
        if self.state == State::Open {
            return;
        }
        let share = a.inverse / (a.inverse + b.inverse);
        let mut give = |change: Vec3| {
            a.velocity -= change * share;
            b.velocity += change * (1.0 - share);
            a.velocity - b.velocity
        };
        let mut relative = give(Vec3::ZERO);
        if self.contact.is_none() {
            give(*free * relative);
            return;
        }
        for k in (0..self.count).filter(|&k| self.normal[k] > 0.0) {
            let approach = relative.dot(self.normals[k]);
            let beyond = approach - approach.clamp(0.0, self.allowed[k]);
            relative = give(self.normals[k] * beyond);
        }
        let along = self.tangent(*free * relative);
        if self.state == State::Sticking {
            give(along);
        } else if let Some(t) = self.tangential.try_normalize() {
            give(t * along.dot(t).min(0.0));
        }
    }
}

/// Solves all meetings at a grid node; impulses go on from what they are. `masses` are those of the
/// fields by number, `fields` gives the two of a meeting. Returns by how much impulses have changed, and
/// how much they are, N s.
pub fn solve(
    meetings: &mut [Meeting],
    fields: impl Fn(&Meeting) -> [usize; 2],
    masses: &mut [Mass],
    free: &Mat3,
    strength: impl Fn(&Meeting) -> Option<Strength>,
) -> [f64; 2] {
    let sweeps = match meetings {
        [one] if one.count <= 1 => 1,
        _ => SWEEPS,
    };
    let (mut first, mut total) = (None, 0.0);
    for _ in 0..sweeps {
        let mut changed = 0.0;
        total = 0.0;
        for meeting in meetings.iter_mut() {
            let [i, k] = fields(meeting);
            let (mut a, mut b) = (masses[i], masses[k]);
            changed += meeting.sweep(&mut a, &mut b, free, strength(meeting));
            total += meeting.normal.iter().sum::<f64>() + meeting.tangential.length();
            (masses[i], masses[k]) = (a, b);
        }
        first.get_or_insert(changed);
        if changed <= 1e-14 * total {
            break;
        }
    }
    [first.unwrap_or(0.0), total]
}

/// The same for velocities that move the nodes.
pub fn move_together(
    meetings: &[Meeting],
    fields: impl Fn(&Meeting) -> [usize; 2],
    masses: &mut [Mass],
    free: &Mat3,
) {
    let sweeps = match meetings {
        [one] if one.count <= 1 => 1,
        _ => SWEEPS,
    };
    for _ in 0..sweeps {
        for meeting in meetings {
            let [i, k] = fields(meeting);
            let (mut a, mut b) = (masses[i], masses[k]);
            meeting.move_together(&mut a, &mut b, free);
            (masses[i], masses[k]) = (a, b);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2 kg and 3 kg, the second at rest.
    fn two(v: Vec3) -> [Mass; 2] {
        let mass = |mass: f64, velocity| Mass {
            inverse: 1.0 / mass,
            velocity,
        };
        [mass(2.0, v), mass(3.0, Vec3::ZERO)]
    }

    fn pair(friction: f64, v: Vec3) -> (Meeting, [Mass; 2]) {
        let adhesion = 0.0;
        adhering(Strength { friction, adhesion }, false, v)
    }

    fn adhering(strength: Strength, touching: bool, v: Vec3) -> (Meeting, [Mass; 2]) {
        let mut meeting = Meeting {
            contact: Some(0),
            count: 1,
            touching,
            ..Meeting::default()
        };
        meeting.normals[0] = Vec3::Z;
        let mut masses = two(v);
        let mut one = [meeting];
        solve(
            &mut one,
            |_| [0, 1],
            &mut masses,
            &Mat3::IDENTITY,
            |_| Some(strength),
        );
        one[0].settle(0.1);
        (one[0], masses)
    }

    /// m = 1.2 kg: J_n = 1.2 r, friction at most μ J_n, momentum as before.
    #[test]
    fn two_masses_meet() {
        let v = Vec3::new(1.0, 0.0, 0.5);
        let (meeting, [a, b]) = pair(0.5, v);
        assert_eq!(meeting.state, State::Sliding);
        assert!((meeting.normal_force - Vec3::Z * 6.0).length() < 1e-12);
        assert!((meeting.friction - Vec3::X * 3.0).length() < 1e-12);
        let momentum = 2.0 * a.velocity + 3.0 * b.velocity;
        assert!((momentum - 2.0 * v).length() < 1e-15);
        let (meeting, [a, b]) = pair(10.0, v);
        assert_eq!(meeting.state, State::Sticking);
        assert!((a.velocity - b.velocity).length() < 1e-15);
        let (meeting, [a, _]) = pair(0.5, Vec3::new(1.0, 0.0, -0.1));
        assert_eq!(
            (meeting.state, a.velocity),
            (State::Open, Vec3::new(1.0, 0.0, -0.1))
        );
    }

    /// Bodies that part adhere while they touch: 0.6 N s at most along the surface, nothing along the
    /// normal, and the remap leaves them free to part. Apart they do not, and neither do they without
    /// adhesion.
    #[test]
    fn what_touches_adheres_without_pressure() {
        let v = Vec3::new(1.0, 0.0, -0.1);
        let strength = |adhesion| Strength {
            friction: 0.5,
            adhesion,
        };
        let (meeting, [a, b]) = adhering(strength(0.6), true, v);
        assert_eq!(meeting.state, State::Sliding);
        assert_eq!(meeting.normal_force, Vec3::ZERO);
        assert!((meeting.friction - Vec3::X * 6.0).length() < 1e-12);
        assert!((2.0 * a.velocity + 3.0 * b.velocity - 2.0 * v).length() < 1e-15);
        let (meeting, [a, b]) = adhering(strength(10.0), true, v);
        assert_eq!(meeting.state, State::Sticking);
        assert!((a.velocity - b.velocity + Vec3::Z * 0.1).length() < 1e-15);
        let mut masses = two(v);
        move_together(&[meeting], |_| [0, 1], &mut masses, &Mat3::IDENTITY);
        assert!((masses[0].velocity - masses[1].velocity + Vec3::Z * 0.1).length() < 1e-15);
        for (adhesion, touching) in [(10.0, false), (0.0, true)] {
            let (meeting, [a, b]) = adhering(strength(adhesion), touching, v);
            assert_eq!((meeting.state, meeting.friction), (State::Open, Vec3::ZERO));
            assert_eq!((a.velocity, b.velocity), (v, Vec3::ZERO));
        }
    }

    /// What slid in the kick may go on in the drift, but not back: friction would drive it.
    #[test]
    fn what_slides_does_not_slide_back_in_the_drift() {
        let (meeting, _) = pair(0.5, Vec3::new(1.0, 0.0, 0.5));
        assert_eq!(meeting.state, State::Sliding);
        for (drift, expected) in [(0.3, 0.3), (-0.3, 0.0)] {
            let mut masses = two(Vec3::new(drift, 0.1, 0.0));
            let momentum = |m: &[Mass; 2]| 2.0 * m[0].velocity + 3.0 * m[1].velocity;
            let before = momentum(&masses);
            move_together(&[meeting], |_| [0, 1], &mut masses, &Mat3::IDENTITY);
            let relative = masses[0].velocity - masses[1].velocity;
            assert!((relative - Vec3::new(expected, 0.1, 0.0)).length() < 1e-15);
            assert!((momentum(&masses) - before).length() < 1e-15);
        }
    }

    /// In a corner both faces are satisfied, and what slides goes along the edge.
    #[test]
    fn a_corner_holds_both_ways() {
        let mut meeting = Meeting {
            contact: Some(0),
            count: 2,
            ..Meeting::default()
        };
        meeting.normals[0] = Vec3::Z;
        meeting.normals[1] = Vec3::new(0.6, 0.0, 0.8);
        let mut masses = two(Vec3::new(1.0, 2.0, 1.0));
        let strength = Strength {
            friction: 0.0,
            adhesion: 0.0,
        };
        let mut one = [meeting];
        solve(
            &mut one,
            |_| [0, 1],
            &mut masses,
            &Mat3::IDENTITY,
            |_| Some(strength),
        );
        one[0].settle(0.1);
        let relative = masses[0].velocity - masses[1].velocity;
        assert!(relative.dot(Vec3::Z) < 1e-9 && relative.dot(meeting.normals[1]) < 1e-9);
        assert!((relative.y - 2.0).abs() < 1e-15);
    }
}
