//! Particles that have come to another element than the one under which they lie in memory.
//!
//! To bring all particles into the order of their elements costs half a step, and in flow some cross
//! in each step. So they stay where they are for some steps. In the meantime a step works on copies of them,
//! *guests*, behind all other particles, in tiles of their own, whose lanes add to the sums of the cells that
//! the guests are in; where they come from lies a particle without mass and volume, which adds exactly
//! nothing. Those that cross in a step are a batch, which comes behind the guests that are there, so that nothing else has to
//! be moved or summed up again; a guest that crosses leaves a particle without mass, too. Guests stay over the end of a step;
//! whoever looks at particles sees every one at home with all that it has ([`Simulation::settle`]).
//!
//! Only where one body moves in a mesh that stays; else particles are put in order in each step.

use crate::particles::{Column, Order, Particles};
use crate::simulation::Simulation;
use crate::step::Active;
use crate::step::leavers::Leaver;

/// One particle in so many may be a guest, and one tile for so many of the others may be of guests.
const FEW: usize = 10;
const FEW_TILES: usize = 4;
/// There is room for one of so many guests to come in one step.
const FEW_LEAVERS: usize = 4;

/// The guests, in the order of their places behind the other particles.
#[derive(Clone, Debug, Default)]
pub struct Guests {
    /// The place that each has come from: its home, or where it was a guest before.
    from: Vec<u32>,
    /// The elements that they have come to.
    elements: Vec<u32>,
    /// How many there were at the end of each batch.
    ends: Vec<u32>,
    /// Whether they are behind the others now.
    present: bool,
    /// Those that have left their elements in this drift, as they come.
    pub leavers: Vec<Leaver>,
    /// Element, place and number of those of a batch, for sorting.
    found: Vec<(u32, u32, u32)>,
    /// Numbers of those of the last batch, by their new places.
    numbers: Vec<u32>,
    /// Cells that those of a batch are in, and their numbers.
    cells: Vec<(u32, u32)>,
    /// Element and home of guests that are at home, but not in the element under which they lie there.
    away: Vec<(u32, u32)>,
}

/// What a simulation needs to know of guests that are at home, to go on: `from`, `elements` and `ends` of [`Guests`], and
/// the elements under which those lie that have left their homes.
pub type Known = [Vec<u32>; 4];

impl Guests {
    /// How many particles are there twice now.
    pub fn twice(&self) -> usize {
        if self.present { self.from.len() } else { 0 }
    }

    /// Where the particle at a place lies between steps.
    pub fn home(&self, mut place: usize, particles: &Particles) -> usize {
        let first = particles.len() - self.twice();
        while place >= first {
            place = self.from[place - first] as usize;
        }
        place
    }

    /// Where the particle is now that has its home at this place.
    pub fn whereabouts(&self, home: usize, particles: &Particles) -> usize {
        let first = particles.len() - self.twice();
        let (mut place, mut next) = (home, 0);
        while self.present && particles.mass[place] == 0.0 {
            let mut later = self.from[next..].iter();
            let step = later.position(|&p| p as usize == place);
            next += step.expect("who is not there has gone on") + 1;
            place = first + next - 1;
        }
        place
    }

    /// Those in an element that lie under another one, by their homes.
    pub fn inside(&self, e: u32) -> impl Iterator<Item = usize> {
        let first = self.away.partition_point(|guest| guest.0 < e);
        let own = self.away[first..]
            .iter()
            .take_while(move |guest| guest.0 == e);
        own.map(|guest| guest.1 as usize)
    }

    /// What there is to know of guests that are at home.
    pub fn known(&self, order: &Order) -> Known {
        let homes = self.homes(order.count());
        [
            self.from.clone(),
            self.elements.clone(),
            self.ends.clone(),
            homes.map(|p| order.filed[p]).collect(),
        ]
    }

    /// Homes that have been left, of so many particles.
    fn homes(&self, particles: usize) -> impl Iterator<Item = usize> {
        homes(&self.from, particles)
    }

    /// Has guests again as they were known, of these particles, which are at home and in order. False if that cannot be.
    pub(crate) fn expect(
        &mut self,
        [from, elements, ends, _]: &Known,
        active: &mut Active,
        particles: &Particles,
        filed: &[u32],
    ) -> bool {
        let mut first = 0;
        for &end in ends {
            let batch = first..end as usize;
            let (Some(from), Some(elements)) = (from.get(batch.clone()), elements.get(batch))
            else {
                return false;
            };
            if from.iter().any(|&p| p as usize >= particles.len() + first) {
                return false;
            }
            self.found.clear();
            let both = elements.iter().zip(from);
            self.found.extend(both.map(|(&e, &p)| (e, p, 0)));
            self.found.sort_unstable();
            if !self.lay_out(active, particles.len()) {
                return false;
            }
            first = end as usize;
        }
        self.know_who_is_away(particles, filed);
        (&self.from, &self.elements) == (from, elements)
    }

    /// All particles are in the elements under which they lie.
    pub fn clear(&mut self) {
        debug_assert!(!self.present);
        self.from.clear();
        self.elements.clear();
        self.ends.clear();
        self.away.clear();
    }

    /// Room for as many as there may be, so that no step allocates.
    pub fn make_room(&mut self, particles: &mut Particles, order: &mut Order) {
        let most = particles.len() / FEW;
        for numbers in [&mut self.from, &mut self.elements, &mut self.ends] {
            numbers.reserve(most);
        }
        for pairs in [&mut self.cells, &mut self.away] {
            pairs.reserve(most + 1);
        }
        self.found.reserve(most + 1);
        self.numbers.reserve(most + 1);
        self.leavers.reserve_exact(most / FEW_LEAVERS);
        let Particles {
            id, body, element, ..
        } = particles;
        id.reserve_exact(most);
        body.reserve_exact(most);
        element.reserve_exact(most);
        order.filed.reserve_exact(most);
        particles.for_working_columns(|column| column.reserve_exact(most));
    }

    /// Most tiles that they can take, if the others have so many.
    pub fn most_tiles(particles: usize, own: usize) -> usize {
        // The last batch may have a tile for every four.
        own / FEW_TILES + particles / (4 * FEW) + 2
    }

    /// Whether there may be too many guests of so many particles, if twice as many come as last time.
    fn may_be_too_many(&self, particles: usize) -> bool {
        let last = match self.ends[..] {
            [] => 0,
            [last] => last,
            [.., before, last] => last - before,
        };
        self.from.len() + 2 * last as usize > particles / FEW
    }

    /// Sorts out where those are that have left their elements. False if there would be too many guests.
    fn find(&mut self, particles: &Particles) -> bool {
        let own = particles.len() - self.twice();
        if self.from.len() + self.leavers.len() > own / FEW {
            return false;
        }
        self.found.clear();
        let leavers = self.leavers.iter().zip(0..);
        let places = leavers.map(|(leaver, number)| (leaver.element, leaver.place, number));
        self.found.extend(places);
        // By element, and in each in the order of their places.
        self.found.sort_unstable();
        true
    }

    /// Lays out those that have been found as a batch. False if one is where there is no cell; `particles` are not counted
    /// twice.
    fn lay_out(&mut self, active: &mut Active, particles: usize) -> bool {
        let Guests {
            from,
            elements,
            ends,
            found,
            numbers,
            cells,
            ..
        } = self;
        cells.clear();
        for group in found.chunk_by(|a, b| a.0 == b.0) {
            let Some(cell) = active.cell(group[0].0 as usize, 0) else {
                return false;
            };
            cells.push((cell as u32, group.len() as u32));
        }
        let count = from.len() + found.len();
        from.resize(count, 0);
        elements.resize(count, 0);
        ends.push(count as u32);
        let first = from.len() - found.len();
        numbers.clear();
        numbers.resize(found.len(), 0);
        active.invite(cells, |rank, place| {
            let guest = place as usize - particles;
            (elements[guest], from[guest], numbers[guest - first]) = found[rank as usize];
        });
        true
    }

    /// All come from their homes.
    fn arrive(&mut self, particles: &mut Particles, filed: &mut Column<u32>) {
        self.present = true;
        let mut first = 0;
        for &end in &self.ends {
            let batch = first..end as usize;
            first = batch.end;
            let (from, elements) = (&self.from[batch.clone()], &self.elements[batch]);
            particles.for_working_columns(|column| copy(column, from));
            settle_down(from, elements, particles, filed);
            for &p in from {
                particles.element[p as usize] = filed[p as usize];
            }
        }
    }

    /// The last batch comes, of those that have just left their elements.
    fn come(&mut self, particles: &mut Particles, filed: &mut Column<u32>) {
        self.present = true;
        let Guests {
            from,
            elements,
            leavers,
            numbers,
            ..
        } = self;
        let batch = from.len() - numbers.len()..from.len();
        for (k, column) in particles.working_columns_mut().enumerate() {
            let new = numbers.iter().map(|&n| leavers[n as usize].numbers[k]);
            new.for_each(|number| column.push(number));
        }
        settle_down(&from[batch.clone()], &elements[batch], particles, filed);
        leavers.clear();
    }

    fn leave(&mut self, particles: &mut Particles, filed: &mut Column<u32>) {
        if !self.begin_to_leave(particles, filed) {
            return;
        }
        let from = &self.from[..];
        particles.for_working_columns(|column| put_back(column, from));
        self.know_who_is_away(particles, filed);
    }

    /// Guests are at home but for their working columns: these are at the places of guests until particles are moved.
    /// Returns whether there were any.
    pub fn begin_to_leave(&mut self, particles: &mut Particles, filed: &mut Column<u32>) -> bool {
        for leaver in self.leavers.drain(..) {
            particles.element[leaver.place as usize] = leaver.element;
        }
        if !self.present {
            return false;
        }
        self.present = false;
        let from = &self.from[..];
        let Particles {
            id, body, element, ..
        } = particles;
        put_back(id, from);
        put_back(body, from);
        put_back(element, from);
        filed.truncate(element.len());
        true
    }

    /// Home and place of each guest, of so many particles; of several places of one the last one counts.
    pub fn places(&self, particles: usize) -> impl Iterator<Item = (usize, usize)> {
        let home = move |mut place: usize| {
            while place >= particles {
                place = self.from[place - particles] as usize;
            }
            place
        };
        let from = self.from.iter().map(|&p| p as usize);
        from.zip(particles..)
            .map(move |(p, place)| (home(p), place))
    }

    fn know_who_is_away(&mut self, particles: &Particles, filed: &[u32]) {
        let mut away = std::mem::take(&mut self.away);
        away.clear();
        let homes = self.homes(particles.len());
        let all = homes.map(|p| (particles.element[p], p as u32));
        away.extend(all.filter(|&(e, p)| e != filed[p as usize]));
        away.sort_unstable();
        self.away = away;
    }
}

/// Those of the places that guests have come from that are homes of so many particles.
pub(crate) fn homes(from: &[u32], particles: usize) -> impl Iterator<Item = usize> {
    let all = from.iter().map(|&p| p as usize);
    all.filter(move |&p| p < particles)
}

/// Those that have come from these places with the numbers that a step changes are there in these elements, and not where
/// they have come from.
fn settle_down(from: &[u32], elements: &[u32], particles: &mut Particles, filed: &mut Column<u32>) {
    copy(&mut particles.id, from);
    copy(&mut particles.body, from);
    particles.element.extend_from_slice(elements);
    filed.extend_from_slice(elements);
    for &p in from {
        (particles.mass[p as usize], particles.volume[p as usize]) = (0.0, 0.0);
    }
}

fn copy<T: Copy + Default>(values: &mut Column<T>, from: &[u32]) {
    let first = values.len();
    values.resize(first + from.len(), T::default());
    let (known, new) = values.split_at_mut(first);
    // None of a batch comes from another one's place.
    for (value, &p) in new.iter_mut().zip(from) {
        *value = known[p as usize];
    }
}

/// The last ones first: one that has come from a guest's place goes there, and then on with that one.
fn put_back<T: Copy + Default>(values: &mut Column<T>, from: &[u32]) {
    for &p in from.iter().rev() {
        values[p as usize] = values.pop().expect("one for each");
    }
}

impl Simulation {
    /// Whether particles may stay where they are when they cross.
    pub(crate) fn may_have_guests(&self) -> bool {
        self.fields.count() == 1 && !self.driven.moves() && !self.follower.moves()
    }

    /// Guests come, if they are not there.
    pub(super) fn guests_arrive(&mut self) {
        if !self.guests.present && !self.guests.from.is_empty() {
            (self.guests).arrive(&mut self.particles, &mut self.order.filed);
        }
    }

    /// Has guests again as they were known; they are at home. False if that cannot be.
    pub(crate) fn expect(&mut self, known: &Known) -> bool {
        let Simulation {
            particles,
            order,
            active,
            cells,
            guests,
            ..
        } = self;
        let tiles = active.tiles.len();
        if !guests.expect(known, active, particles, &order.filed) {
            return false;
        }
        if !known[0].is_empty() {
            cells.add_guests(active, tiles);
        }
        true
    }

    pub(super) fn guests_leave(&mut self) {
        (self.guests).leave(&mut self.particles, &mut self.order.filed);
    }

    /// Whether particles should be put in order, as the next guests may be too many. So it is done at a time when it costs
    /// least, and not when these have come.
    pub(super) fn guests_are_many(&self) -> bool {
        let (tiles, own) = (self.active.tiles.len(), self.active.own_tiles());
        let particles = self.particles.len() - self.guests.twice();
        tiles - own > own / FEW_TILES || self.guests.may_be_too_many(particles)
    }

    /// Makes those that have crossed guests. False if there would be too many, or one is where there is no cell.
    pub(super) fn regroup(&mut self) -> bool {
        let Simulation {
            particles,
            order,
            active,
            cells,
            guests,
            ..
        } = self;
        let tiles = active.tiles.len();
        if !guests.find(particles) {
            return false;
        }
        if !guests.lay_out(active, particles.len() - guests.twice()) {
            return false;
        }
        guests.come(particles, &mut order.filed);
        cells.add_guests(active, tiles);
        true
    }
}
