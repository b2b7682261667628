//! Stage 7: particles move with the nodes, x_p += Σ N_i Δu_i (Jassim et al. Eq. 9), and are looked for where they
//! have come to (`points.rs` goes through them).

use super::shapes::Shapes;
use super::strain::Deformation;
use super::sums::Carried;
use crate::Mat3;
use crate::Vec3;
use crate::boundary::Outflow;
use crate::contact::{Contacts, Fields};
use crate::lanes::{
    Columns, Held, LANES, Lane, any, either, for_each_simd, get, load, load_one, only, set, sum,
};
use crate::mesh::{Mesh, NONE};
use crate::parallel::{First, Sum};

/// Cells and particles side by side.
pub(super) struct Motion {
    pub position: [Lane; 3],
    /// Work of gravity, J.
    work: Lane,
    /// 1 where a particle has left its element as it was.
    left: Lane,
    /// Whether any has.
    some_left: bool,
}

impl Default for Motion {
    fn default() -> Motion {
        let vector = [Lane::of(0.0); 3];
        Motion {
            position: vector,
            work: Lane::of(0.0),
            left: Lane::of(0.0),
            some_left: false,
        }
    }
}

#[inline(always)]
fn is_inside(n: [f64; 4]) -> bool {
    (n[0] >= 0.0) & (n[1] >= 0.0) & (n[2] >= 0.0) & (n[3] >= 0.0)
}

/// Whether a particle with these N_i is still in its element. Where a guest comes from lies one without mass.
#[inline(always)]
pub(super) fn stays(n: [f64; 4], mass: f64) -> bool {
    is_inside(n) | (mass == 0.0)
}

/// Where a particle comes to from here, its way there, and its N_i there.
#[inline(always)]
pub(super) fn go_along(
    shapes: &Shapes,
    deformation: &Deformation,
    l: usize,
    x: Vec3,
) -> (Vec3, Vec3, [f64; 4]) {
    // Σ N_i Δu_i is Δu of node 0 and, from there on, ∇Δu times the way.
    let gradient = Mat3::from_cols_array(&get(&deformation.gradient, l));
    let way = Vec3::from_array(get(&deformation.origin, l)) + gradient * shapes.arm(l, x);
    let x = x + way;
    (x, way, shapes.at(l, x))
}

for_each_simd! {
    /// Finds out which particles have left their elements, as these are now.
    pub(super) fn look(
        motion: &mut Motion,
        shapes: &Shapes,
        position: &[&[f64]; 3],
        start: usize,
    ) {
        load(&mut motion.position, position, start);
        for l in 0..LANES {
            let x = Vec3::from_array(get(&motion.position, l));
            motion.left[l] = either(is_inside(shapes.at(l, x)), 0.0, 1.0);
        }
        motion.look_who_left();
    }
}

impl Motion {
    /// Fetches particles.
    #[inline(always)]
    pub fn fetch(
        &mut self,
        position: &Columns<3>,
        carried: &mut Carried,
        mass: &[f64],
        start: usize,
        held: &Held,
    ) {
        let (mut own, mut x) = (Lane::of(0.0), [Lane::of(0.0); 3]);
        load_one(&mut own, mass, 0);
        position.load(&mut x, start);
        carried.mass = only(held, &own);
        // What guests leave behind must not go farther and farther from its cell.
        for k in 0..3 {
            self.position[k] = only(&carried.mass, &x[k]);
        }
    }

    /// Moves a particle.
    #[inline(always)]
    pub fn go_along(
        &mut self,
        shapes: &Shapes,
        deformation: &Deformation,
        gravity: Vec3,
        carried: &mut Carried,
        l: usize,
    ) {
        let x = Vec3::from_array(get(&self.position, l));
        let (x, way, n) = go_along(shapes, deformation, l, x);
        self.count(l, carried.mass[l] * gravity.dot(way));
        set(&mut self.position, l, x.to_array());
        set(&mut carried.shapes, l, n);
        self.left[l] = either(stays(n, carried.mass[l]), 0.0, 1.0);
    }

    /// Counts the work of gravity on a particle, J.
    #[inline(always)]
    pub fn count(&mut self, l: usize, work: f64) {
        self.work[l] += work;
    }

    /// These are where particles have come to, and 1 where one has left its element.
    #[inline(always)]
    pub fn come_to(&mut self, position: [Lane; 3], left: Lane, some_left: bool) {
        (self.position, self.left, self.some_left) = (position, left, some_left);
    }

    #[inline(always)]
    pub fn look_who_left(&mut self) {
        self.some_left = any(&*self.left);
    }

    /// Lanes, of the first so many, whose particles have left their elements.
    #[inline]
    pub fn who_left(&self, lanes: usize) -> impl Iterator<Item = usize> {
        let lanes = if self.some_left { lanes } else { 0 };
        (0..lanes).filter(|&l| self.left[l] != 0.0)
    }

    /// Where a particle is, m.
    #[inline]
    pub fn at(&self, l: usize) -> Vec3 {
        Vec3::from_array(get(&self.position, l))
    }

    /// Work of gravity on all particles, J.
    pub fn work(&self) -> f64 {
        sum(&self.work)
    }
}

/// Particles that have come to another element, by their places; the first of each kind.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Crossing {
    /// Out of the mesh.
    pub outside: First,
    /// Into another element.
    pub crossed: First,
    /// Across a face that they must not pass: they are still in the old element.
    pub passed: First,
    /// Out of the mesh, through an outflow surface: they are in no element.
    pub gone: First,
}

impl Crossing {
    /// Whether none has done anything but cross.
    pub fn is_plain(&self) -> bool {
        let others = [self.outside, self.passed, self.gone];
        others.iter().all(|first| first.get().is_none())
    }
}

impl Sum for Crossing {
    fn plus(self, other: Crossing) -> Crossing {
        Crossing {
            outside: self.outside.plus(other.outside),
            crossed: self.crossed.plus(other.crossed),
            passed: self.passed.plus(other.passed),
            gone: self.gone.plus(other.gone),
        }
    }
}

/// What it takes to find a particle's element.
pub(super) struct Search<'a> {
    pub mesh: &'a Mesh,
    pub fields: &'a Fields,
    pub contacts: &'a Contacts,
    pub outflow: &'a Outflow,
    pub body: &'a [u16],
}

impl Search<'_> {
    /// Whether a particle is of a rigid body, which goes as a whole or stays.
    fn is_rigid(&self, p: usize) -> bool {
        let field = self.fields.of(self.body[p]);
        let rigid = self.contacts.rigid_of_field.get(field);
        rigid.is_some_and(Option::is_some)
    }

    /// Walks particle `p` to its element from the one where it was, which has these N_i at `x`. False if it still is there.
    pub fn walk(
        &self,
        p: usize,
        n: [f64; 4],
        x: Vec3,
        element: &mut u32,
        crossing: &mut Crossing,
    ) -> bool {
        match self.mesh.walk_on(*element, n, x) {
            Ok(found) if found == *element => return false,
            Ok(found) => {
                let field = self.fields.of(self.body[p]);
                if self.contacts.blocks(field, *element, found) {
                    crossing.passed.note(p);
                } else {
                    *element = found;
                    crossing.crossed.note(p);
                }
            }
            Err(Some(face)) if self.outflow.lets_out(face) && !self.is_rigid(p) => {
                *element = NONE;
                crossing.gone.note(p);
            }
            Err(_) => crossing.outside.note(p),
        }
        true
    }
}
