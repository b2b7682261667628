//! Meshes made without a file.

use super::{Mesh, MeshError, RawMesh};
use crate::Vec3;

/// The three axes in each of their six orders: one Kuhn tetrahedron of a cube each.
pub(super) const KUHN_ORDERS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [0, 2, 1],
    [1, 0, 2],
    [1, 2, 0],
    [2, 0, 1],
    [2, 1, 0],
];

/// A box from the origin to `size` (m) of `cells` bricks, each cut into six tetrahedra along
/// its diagonal (Kuhn's subdivision).
///
/// Groups: volume `box`; surfaces `x-min`, `x-max`, `y-min`, `y-max`, `z-min`, `z-max`.
pub fn box_mesh(size: Vec3, cells: [usize; 3]) -> Result<Mesh, MeshError> {
    let id = |c: [usize; 3]| ((c[2] * (cells[1] + 1) + c[1]) * (cells[0] + 1) + c[0]) as u32;
    let mut raw = RawMesh::default();
    for k in 0..=cells[2] {
        for j in 0..=cells[1] {
            for i in 0..=cells[0] {
                let at = |d: usize, n: usize| size[d] * n as f64 / cells[d] as f64;
                raw.nodes.push(Vec3::new(at(0, i), at(1, j), at(2, k)));
            }
        }
    }
    let names = ["x-min", "x-max", "y-min", "y-max", "z-min", "z-max"];
    let mut sides: [Vec<[u32; 3]>; 6] = Default::default();
    for k in 0..cells[2] {
        for j in 0..cells[1] {
            for i in 0..cells[0] {
                for order in KUHN_ORDERS {
                    let mut corner = [i, j, k];
                    let mut tet = [id(corner); 4];
                    for (q, &axis) in order.iter().enumerate() {
                        corner[axis] += 1;
                        tet[q + 1] = id(corner);
                    }
                    // An odd order of the axes runs round the other way.
                    if (order[1] + 3 - order[0]) % 3 == 2 {
                        tet.swap(2, 3);
                    }
                    collect_sides(&tet, order, [i, j, k], cells, &mut sides);
                    raw.tets.push(tet);
                }
            }
        }
    }
    raw.volume_groups = vec![("box".to_owned(), (0..raw.tets.len() as u32).collect())];
    raw.surface_groups = names
        .iter()
        .zip(sides)
        .map(|(n, s)| (n.to_string(), s))
        .collect();
    Mesh::new(raw)
}

/// A Kuhn tetrahedron's nodes lie on a path from the cell's low corner to its high corner, one
/// step along each axis: the three nodes before the last step are low in that step's axis, the
/// three after the first step are high in that one's.
fn collect_sides(
    tet: &[u32; 4],
    order: [usize; 3],
    cell: [usize; 3],
    cells: [usize; 3],
    sides: &mut [Vec<[u32; 3]>; 6],
) {
    let path = |q: usize| {
        if (order[1] + 3 - order[0]) % 3 == 2 && q >= 2 {
            tet[5 - q]
        } else {
            tet[q]
        }
    };
    let (first, last) = (order[0], order[2]);
    if cell[last] == 0 {
        sides[2 * last].push([path(0), path(1), path(2)]);
    }
    if cell[first] + 1 == cells[first] {
        sides[2 * first + 1].push([path(1), path(2), path(3)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_filled_and_its_sides_are_whole() {
        let size = Vec3::new(2.0, 0.5, 1.0);
        let mesh = box_mesh(size, [4, 1, 3]).unwrap();
        assert_eq!(mesh.tets.len(), 4 * 3 * 6);
        assert!((mesh.total_volume() - 1.0).abs() < 1e-14);
        let areas = [0.5, 0.5, 2.0, 2.0, 1.0, 1.0];
        for (s, surface) in mesh.surfaces.iter().enumerate() {
            let sum: Vec3 = surface.faces.iter().map(|&f| mesh.face_area(f)).sum();
            let mut normal = Vec3::ZERO;
            normal[s / 2] = if s % 2 == 0 { -areas[s] } else { areas[s] };
            assert!((sum - normal).length() < 1e-14, "{}: {sum}", surface.name);
        }
        assert_eq!(
            mesh.boundary_faces().count(),
            mesh.surfaces.iter().map(|s| s.faces.len()).sum::<usize>()
        );
    }
}
