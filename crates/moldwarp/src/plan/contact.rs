//! Contacts: bodies that touch, slide and part.

/// Two sides that meet with friction. Bodies that share no contact stick together where they meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    pub name: String,
    /// Indices into [`super::Plan::bodies`] of the two sides. Bodies of a side hang together.
    pub bodies: [Vec<usize>; 2],
    /// Coefficient of friction.
    pub friction: f64,
    /// Adhesion, Pa.
    pub adhesion: f64,
    pub surface: ContactSurface,
    /// Whether bodies may approach as long as there is a gap between them; otherwise they may not
    /// from the moment that they share nodes.
    pub gap_check: bool,
}

/// Where two sides meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactSurface {
    /// On faces of elements, the boundary of the first side at the start.
    Aligned,
    /// Anywhere inside elements.
    Free,
}
