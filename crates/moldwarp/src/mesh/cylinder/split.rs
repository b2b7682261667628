//! Cells of a sector cut into tetrahedra, and the triangles on its sides.
//!
//! At the axis two corners of a cell, one above the other, stand for four: a hexahedron becomes a
//! wedge. What is cut as if it were a hexahedron then has pieces with a node twice, which are none.

use super::lattice::{Lattice, Place};
use super::{RawMesh, Split};
use crate::Vec3;
use crate::mesh::{FACE_NODES, KUHN_ORDERS, tetrahedron_gradients};

/// All cells of the lattice as tetrahedra, with their groups.
pub(super) fn raw(mut lattice: Lattice, split: Split) -> RawMesh {
    let mut tets = Vec::new();
    for k in 0..lattice.cells[2] {
        for j in 0..lattice.cells[1] {
            for i in 0..lattice.cells[0] {
                match split {
                    Split::Six => six(&mut lattice, [i, j, k], &mut tets),
                    Split::Symmetric => symmetric(&mut lattice, [i, j, k], &mut tets),
                }
            }
        }
    }
    tets.iter_mut()
        .for_each(|tet| turn_right(tet, &lattice.nodes));
    RawMesh {
        volume_groups: vec![("cylinder".to_owned(), (0..tets.len() as u32).collect())],
        surface_groups: surfaces(&lattice, &tets),
        nodes: lattice.nodes,
        tets,
    }
}

/// Kuhn's tetrahedra, each along a path from one corner of the cell to the opposite one. The path
/// runs against θ in every second cell, so that the cells on both sides of a meridian are mirror
/// images and cut their common face alike.
fn six(lattice: &mut Lattice, cell: Place, tets: &mut Vec<[u32; 4]>) {
    let mirrored = cell[1] % 2 == 1;
    for order in KUHN_ORDERS {
        let mut step = [0; 3];
        let tet = std::array::from_fn(|q| {
            if q > 0 {
                step[order[q - 1]] = 1;
            }
            let around = if mirrored { 1 - step[1] } else { step[1] };
            let corner = [cell[0] + step[0], cell[1] + around, cell[2] + step[2]];
            lattice.node(corner.map(|c| 2 * c))
        });
        if (0..4).all(|q| !tet[..q].contains(&tet[q])) {
            tets.push(tet);
        }
    }
}

/// A tetrahedron from the middle of the cell to each triangle of its faces: to a face's edges from
/// the middle of the face if it has four corners, to the face itself if it has three.
fn symmetric(lattice: &mut Lattice, cell: Place, tets: &mut Vec<[u32; 4]>) {
    let middle = cell.map(|c| 2 * c + 1);
    for d in 0..3 {
        for side in [middle[d] - 1, middle[d] + 1] {
            let mut centre = middle;
            centre[d] = side;
            let round = [(-1, -1), (1, -1), (1, 1), (-1, 1)].map(|(u, v): (isize, isize)| {
                let mut corner = centre;
                corner[(d + 1) % 3] = corner[(d + 1) % 3].wrapping_add_signed(u);
                corner[(d + 2) % 3] = corner[(d + 2) % 3].wrapping_add_signed(v);
                lattice.node(corner)
            });
            let mut corners = round.to_vec();
            corners.dedup();
            if corners.first() == corners.last() {
                corners.pop();
            }
            match corners[..] {
                [a, b, c] => {
                    let middle = lattice.node(middle);
                    tets.push([middle, a, b, c]);
                }
                [_, _, _, _] => {
                    let (middle, centre) = (lattice.node(middle), lattice.node(centre));
                    tets.extend((0..4).map(|q| [middle, centre, round[q], round[(q + 1) % 4]]));
                }
                // The axis: a face without area.
                _ => {}
            }
        }
    }
}

/// Numbers a tetrahedron so that its volume is positive.
fn turn_right(tet: &mut [u32; 4], nodes: &[Vec3]) {
    if tetrahedron_gradients(tet.map(|n| nodes[n as usize])).1 < 0.0 {
        tet.swap(2, 3);
    }
}

/// A triangle is on a side if all its nodes are: three corners of one cell that lie on one side of
/// the body lie on one face of the cell, and none is made of axis nodes alone.
fn surfaces(lattice: &Lattice, tets: &[[u32; 4]]) -> Vec<(String, Vec<[u32; 3]>)> {
    let [ni, nj, nk] = lattice.cells.map(|n| 2 * n);
    let solid = lattice.solid;
    let axis = move |p: Place| solid && p[0] == 0;
    type Side<'a> = (&'a str, Box<dyn Fn(Place) -> bool>);
    let mut sides: Vec<Side> = vec![
        ("theta-min", Box::new(move |p| p[1] == 0 || axis(p))),
        ("theta-max", Box::new(move |p| p[1] == nj || axis(p))),
        ("r-max", Box::new(move |p| p[0] == ni)),
        ("z-min", Box::new(|p| p[2] == 0)),
        ("z-max", Box::new(move |p| p[2] == nk)),
    ];
    if !solid {
        sides.push(("r-min", Box::new(|p| p[0] == 0)));
    }
    let mut triangles = vec![Vec::new(); sides.len()];
    for tet in tets {
        for face in FACE_NODES.map(|local| local.map(|q| tet[q])) {
            let places = face.map(|n| lattice.places[n as usize]);
            for (side, triangles) in sides.iter().zip(&mut triangles) {
                if places.iter().all(|&p| side.1(p)) {
                    triangles.push(face);
                }
            }
        }
    }
    let names = sides.iter().map(|side| side.0.to_owned());
    names.zip(triangles).collect()
}
