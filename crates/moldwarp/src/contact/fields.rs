//! Velocity fields: bodies that may slide on each other have a field each at the nodes they share.

use crate::plan::Contact;

/// Which bodies move with one velocity where they meet.
#[derive(Clone, Debug)]
pub struct Fields {
    of_body: Vec<u8>,
    count: usize,
}

crate::saved!(Fields { of_body, count });

impl Default for Fields {
    /// One field for all.
    fn default() -> Fields {
        Fields {
            of_body: Vec::new(),
            count: 1,
        }
    }
}

impl Fields {
    /// Whether they are fields of so many bodies.
    pub(crate) fn fit(&self, bodies: usize) -> bool {
        let known = |field: &u8| usize::from(*field) < self.count;
        self.of_body.len() == bodies
            && self.of_body.iter().all(known)
            && (1..=bodies.max(1)).contains(&self.count)
    }

    /// Bodies that no contact names share the first field, those that one side of a contact lists
    /// together share theirs, every other body has its own, and so has a body that is rigid.
    pub fn new(bodies: usize, contacts: &[Contact], rigid: impl Fn(usize) -> bool) -> Fields {
        const NO_FIELD: usize = usize::MAX;
        let mut root: Vec<usize> = (0..bodies).collect();
        let mut named: Vec<bool> = (0..bodies).map(rigid).collect();
        for side in contacts.iter().flat_map(|c| &c.bodies) {
            for &body in side {
                named[body] = true;
                let (old, new) = (root[body], root[side[0]]);
                root.iter_mut()
                    .filter(|r| **r == old)
                    .for_each(|r| *r = new);
            }
        }
        let others = named.iter().any(|n| !n);
        let mut field_of_root = vec![NO_FIELD; bodies];
        let mut count = usize::from(others);
        let mut of_body = vec![0; bodies];
        for body in (0..bodies).filter(|&b| named[b]) {
            let field = &mut field_of_root[root[body]];
            if *field == NO_FIELD {
                *field = count;
                count += 1;
            }
            of_body[body] = *field as u8;
        }
        Fields {
            of_body,
            count: count.max(1),
        }
    }

    /// Number of fields.
    #[inline]
    pub fn count(&self) -> usize {
        self.count
    }

    /// The field of a body.
    #[inline]
    pub fn of(&self, body: u16) -> usize {
        if self.count == 1 {
            0
        } else {
            usize::from(self.of_body[usize::from(body)])
        }
    }
}
