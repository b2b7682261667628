//! Particles that have come to another element than the one under which they lie in memory.
//!
//! To bring all particles into the order of their elements costs a quarter of a step, and in flow some cross
//! in each step. So they stay where they are for some steps. In the meantime a step works on copies of them,
//! *guests*, behind all other particles, in tiles of their own, whose lanes add to the sums of the cells that
//! the guests are in; where they come from lies a particle without mass and volume, which adds exactly
//! nothing. They may stay over the end of a step; whoever looks at particles sees every one at home with all that it has
//! ([`Simulation::settle`]).
//!
//! Only where one body moves in a mesh that stays; else particles are put in order in each step.

use crate::lanes::LANES;
use crate::particles::Particles;
use crate::simulation::Simulation;

/// One particle in so many may be a guest.
const FEW: usize = 24;

/// The guests.
#[derive(Clone, Debug, Default)]
pub struct Guests {
    /// Where each of them lies between steps.
    homes: Vec<u32>,
    /// Element and home of each, for sorting.
    found: Vec<(u32, u32)>,
    /// Cells, by lanes, that they are in, and their numbers.
    cells: Vec<(u32, u32)>,
    /// Whether they are behind the others now.
    present: bool,
}

impl Guests {
    /// Where the particle at a place lies between steps.
    pub fn home(&self, place: usize, particles: &Particles) -> usize {
        let first = particles.len() - self.count();
        match self.present && place >= first {
            true => self.homes[place - first] as usize,
            false => place,
        }
    }

    fn count(&self) -> usize {
        self.homes.len()
    }

    /// How many particles are there twice now.
    pub fn twice(&self) -> usize {
        if self.present { self.count() } else { 0 }
    }

    /// Homes of guests, and the elements under which they lie there.
    pub fn filed<'a>(&'a self, filed: &'a [u32]) -> impl Iterator<Item = (u32, u32)> + 'a {
        self.homes.iter().map(|&p| (p, filed[p as usize]))
    }

    /// Those in an element, by their homes.
    pub fn inside(&self, e: u32) -> impl Iterator<Item = usize> {
        let first = self.found.partition_point(|guest| guest.0 < e);
        let own = self.found[first..]
            .iter()
            .take_while(move |guest| guest.0 == e);
        own.map(|guest| guest.1 as usize)
    }

    /// Those at these places are guests.
    pub fn expect(&mut self, homes: Vec<u32>) {
        self.homes = homes;
    }

    /// All particles are in the elements under which they lie.
    pub fn clear(&mut self) {
        debug_assert!(!self.present);
        self.homes.clear();
        self.found.clear();
    }

    /// Room for as many as there may be, so that no step allocates.
    pub fn make_room(&mut self, particles: &mut Particles) {
        let most = particles.len() / FEW;
        self.homes.reserve(most);
        self.found.reserve(particles.len().min(2 * most));
        self.cells.reserve(most);
        let Particles {
            id, body, element, ..
        } = particles;
        id.reserve_exact(most);
        body.reserve_exact(most);
        element.reserve_exact(most);
        particles.for_working_columns(|column| column.reserve_exact(most));
    }

    /// Most tiles that they can take.
    pub fn most_tiles(particles: usize) -> usize {
        (particles / FEW).div_ceil(LANES) + 1
    }

    fn arrive(&mut self, particles: &mut Particles) {
        if self.homes.is_empty() || self.present {
            return;
        }
        self.present = true;
        let Particles {
            id, body, element, ..
        } = particles;
        copy(id, &self.homes);
        copy(body, &self.homes);
        copy(element, &self.homes);
        particles.for_working_columns(|column| copy(column, &self.homes));
        for &p in &self.homes {
            (particles.mass[p as usize], particles.volume[p as usize]) = (0.0, 0.0);
        }
    }

    fn leave(&mut self, particles: &mut Particles) {
        if !self.present {
            return;
        }
        self.present = false;
        let Particles {
            id, body, element, ..
        } = particles;
        put_back(id, &self.homes);
        put_back(body, &self.homes);
        put_back(element, &self.homes);
        particles.for_working_columns(|column| put_back(column, &self.homes));
    }
}

fn copy<T: Copy>(values: &mut Vec<T>, homes: &[u32]) {
    for &p in homes {
        values.push(values[p as usize]);
    }
}

fn put_back<T: Copy>(values: &mut Vec<T>, homes: &[u32]) {
    let count = values.len() - homes.len();
    for (k, &p) in homes.iter().enumerate() {
        values[p as usize] = values[count + k];
    }
    values.truncate(count);
}

impl Simulation {
    /// Whether particles may stay where they are when they cross.
    pub(crate) fn may_have_guests(&self) -> bool {
        self.fields.count() == 1 && !self.driven.moves() && !self.follower.moves()
    }

    /// Guests come, if they are not there.
    pub(super) fn guests_arrive(&mut self) {
        self.guests.arrive(&mut self.particles);
    }

    pub(super) fn guests_leave(&mut self) {
        self.guests.leave(&mut self.particles);
    }

    /// Finds guests and their cells anew, after particles have crossed. False if there would be too many, or
    /// one is where there is no cell.
    pub(crate) fn regroup(&mut self) -> bool {
        let Simulation {
            particles,
            order,
            active,
            cells,
            guests,
            ..
        } = self;
        let places = particles.element.iter().zip(&order.filed).zip(0..);
        let moved = places.filter(|((now, filed), _)| now != filed);
        guests.found.clear();
        guests.found.extend(moved.map(|((&e, _), p)| (e, p)));
        // Those that have come back stay guests: the sums of the others need not be made anew.
        let filed = |p: u32| order.filed[p as usize];
        let back = |&p: &u32| (particles.element[p as usize] == filed(p)).then_some((filed(p), p));
        guests.found.extend(guests.homes.iter().filter_map(back));
        if guests.found.len() * FEW > particles.len() {
            return false;
        }
        // By element, and in each in the order of their homes.
        guests.found.sort_unstable();
        guests.cells.clear();
        for group in guests.found.chunk_by(|a, b| a.0 == b.0) {
            let Some(cell) = active.cell(group[0].0 as usize, 0) else {
                return false;
            };
            guests.cells.push((cell as u32, group.len() as u32));
        }
        guests.homes.clear();
        guests.homes.resize(guests.found.len(), 0);
        let first = particles.len() as u32;
        let (found, homes) = (&guests.found, &mut guests.homes);
        active.invite(&guests.cells, |rank, place| {
            homes[(place - first) as usize] = found[rank as usize].1;
        });
        cells.renew_guests(active);
        true
    }

    /// Adds the sums of guests to those of the cells that they are in, and keeps what only nodes need.
    pub(super) fn count_guests(&mut self) {
        let (active, cells) = (&self.active, &mut self.cells);
        for guest in active.guest_lanes() {
            if active.elements[guest] == crate::mesh::NONE {
                continue;
            }
            let own = active.cell(active.elements[guest] as usize, 0);
            let own = own.expect("guests are in cells");
            cells.add_sums(guest, own);
        }
    }
}
