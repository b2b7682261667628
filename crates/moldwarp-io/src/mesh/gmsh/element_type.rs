//! Gmsh's element types: what is read, what is passed over and what is refused.

use super::super::GmshProblem;
use super::cursor::Cursor;
use super::{Result, first_order_command, mesh_command};

/// An element that a mesh file may have.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum ElementType {
    /// A point, or a line of higher order, of no use here.
    Ignored { nodes: usize },
    /// Two nodes.
    Line,
    /// Three nodes.
    Triangle,
    /// Four nodes.
    Tetrahedron,
}

impl ElementType {
    /// The type with Gmsh's number `kind`, which was read last.
    pub(super) fn new(cursor: &Cursor, kind: i64) -> Result<ElementType> {
        let ignored = |nodes| Ok(ElementType::Ignored { nodes });
        let higher = |shape| {
            let command = first_order_command(cursor.file);
            Err(cursor.wrong(GmshProblem::HigherOrder {
                shape,
                kind,
                command,
            }))
        };
        let other = |shape| {
            let command = mesh_command(cursor.file);
            Err(cursor.wrong(GmshProblem::NotTetrahedral {
                shape,
                kind,
                command,
            }))
        };
        match kind {
            2 => Ok(ElementType::Triangle),
            4 => Ok(ElementType::Tetrahedron),
            1 => Ok(ElementType::Line),
            8 => ignored(3),
            15 | 84 => ignored(1),
            26..=28 => ignored(kind as usize - 22),
            62..=66 => ignored(kind as usize - 55),
            9 | 20..=25 | 42..=46 | 52..=56 => higher("triangles"),
            11 | 29..=33 | 71..=75 | 79..=83 | 137 => higher("tetrahedra"),
            3 | 10 | 16 | 36..=41 | 47..=51 | 57..=61 => other("quadrangles"),
            5 | 12 | 17 | 92..=105 => other("hexahedra"),
            6 | 13 | 18 | 90 | 91 | 106..=117 => other("prisms"),
            7 | 14 | 19 | 118..=131 => other("pyramids"),
            34 => other("polygons"),
            35 => other("polyhedra"),
            _ => Err(cursor.wrong(GmshProblem::UnknownElement(kind))),
        }
    }

    pub(super) fn nodes(self) -> usize {
        match self {
            ElementType::Ignored { nodes } => nodes,
            ElementType::Line => 2,
            ElementType::Triangle => 3,
            ElementType::Tetrahedron => 4,
        }
    }
}
