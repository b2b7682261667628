//! Contacts: bodies that touch, slide and part.

/// Two sides that meet with friction. Bodies that share no contact stick together where they meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    pub name: String,
    /// Indices into [`super::Plan::bodies`] of the two sides. Bodies of a side hang together.
    pub bodies: [Vec<usize>; 2],
    /// Coefficient of friction.
    pub friction: f64,
    /// What is held along touching surfaces without any pressure, Pa; nothing is held along the normal.
    pub adhesion: f64,
    pub surface: ContactSurface,
    /// Whether bodies may approach as long as there is a gap between them; otherwise they may not
    /// from the moment that they share nodes.
    pub gap_check: bool,
}

impl Contact {
    /// What is recorded of a contact: name, unit and meaning.
    pub const COLUMNS: [(&'static str, &'static str, &'static str); 9] = {
        const NORMAL: &str = "Force along the normals on the first side.";
        const TANGENTIAL: &str = "Force of friction and adhesion on the first side.";
        [
            ("normal.x", "N", NORMAL),
            ("normal.y", "N", NORMAL),
            ("normal.z", "N", NORMAL),
            ("tangential.x", "N", TANGENTIAL),
            ("tangential.y", "N", TANGENTIAL),
            ("tangential.z", "N", TANGENTIAL),
            (
                "sticking",
                "",
                "Number of nodes that hold both sides together.",
            ),
            (
                "sliding",
                "",
                "Number of nodes at which friction and adhesion are overcome.",
            ),
            (
                "open",
                "",
                "Number of nodes that both sides share without touching.",
            ),
        ]
    };

    /// Names of the columns of the history, with units.
    pub fn columns(&self) -> impl Iterator<Item = (String, &'static str)> + '_ {
        let name = &self.name;
        let column = move |(what, unit, _)| (format!("contact.{name}.{what}"), unit);
        Contact::COLUMNS.into_iter().map(column)
    }
}

/// Where two sides meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactSurface {
    /// On faces of elements, the boundary of the first side at the start.
    Aligned,
    /// Anywhere inside elements.
    Free,
}
