//! Absorbing boundaries follow the material.
//!
//! The nodes of an absorbing surface move along its normal with the material, so that no particle
//! is left outside when the boundary yields. The interior is stretched to suit: every other node
//! follows the nearest node of the surface, times a weight that is harmonic in the mesh, 1 on the
//! surface and 0 where another boundary holds the normal direction. Where nothing holds it the
//! weight is 1 everywhere and the mesh goes along as a whole.

use super::{FREE_COSINE, harmonic};
use crate::mesh::{Face, Mesh};
use crate::{Mat3, Vec3};
use rayon::prelude::*;

/// A node and the surface node it follows.
#[derive(Clone, Copy, Debug)]
struct Follow {
    node: u32,
    source: u32,
    /// Weight times the direction in which the node moves.
    motion: Vec3,
    /// Unit normal at the source, whose component of motion is followed.
    normal: Vec3,
}

/// Moves mesh nodes with absorbing surfaces.
#[derive(Clone, Debug, Default)]
pub struct Follower {
    follows: Vec<Follow>,
}

crate::saved!(Follow {
    node,
    source,
    motion,
    normal
});
crate::saved!(Follower { follows });

impl Follower {
    /// `surfaces` are the absorbing ones; `free` projects a vector into the directions that a
    /// node's fixities, rollers and prescribed velocities leave. Nodes that are `driven` by a body do
    /// not follow.
    pub fn new(
        mesh: &Mesh,
        surfaces: &[&[Face]],
        free: impl Fn(u32) -> Mat3 + Sync,
        driven: impl Fn(u32) -> bool + Sync,
    ) -> Follower {
        let normals: Vec<Vec<(u32, Vec3)>> =
            surfaces.iter().map(|f| node_normals(mesh, f)).collect();
        let mut follows = Vec::new();
        for (s, own) in normals.iter().enumerate() {
            let mean = own.iter().map(|n| n.1).sum::<Vec3>().normalize_or_zero();
            let mut weights: Vec<Option<f64>> = (0..mesh.nodes.len() as u32)
                .into_par_iter()
                .map(|n| ((free(n) * mean).length() < FREE_COSINE || driven(n)).then_some(0.0))
                .collect();
            for (_, other) in normals.iter().enumerate().filter(|&(o, _)| o != s) {
                let along = other.iter().filter(|n| n.1.dot(mean).abs() > 0.05);
                along.for_each(|&(node, _)| weights[node as usize] = Some(0.0));
            }
            own.iter()
                .for_each(|&(node, _)| weights[node as usize] = Some(1.0));
            let weights = harmonic(mesh, &weights, |e, slope| slope * mesh.volumes[e]);
            let followers: Vec<Follow> = (0..mesh.nodes.len())
                .into_par_iter()
                .filter(|&n| weights[n] > 0.0)
                .filter_map(|n| {
                    let (source, normal) = nearest(mesh, own, n as u32);
                    let direction = free(n as u32) * normal;
                    // A surface node that is held against its normal stays.
                    (direction.length() >= FREE_COSINE).then_some(Follow {
                        node: n as u32,
                        source,
                        motion: direction * weights[n],
                        normal,
                    })
                })
                .collect();
            follows.extend(followers);
        }
        Follower { follows }
    }

    /// Whether any node ever moves.
    pub fn moves(&self) -> bool {
        !self.follows.is_empty()
    }

    /// Moves nodes; `moved` is the displacement of the material at a node, m.
    pub fn shift(&self, nodes: &mut [Vec3], moved: impl Fn(u32) -> Vec3) {
        for follow in &self.follows {
            nodes[follow.node as usize] += follow.motion * moved(follow.source).dot(follow.normal);
        }
    }
}

/// Unit normals at the nodes of a surface, weighted by area.
fn node_normals(mesh: &Mesh, faces: &[Face]) -> Vec<(u32, Vec3)> {
    let mut areas: Vec<(u32, Vec3)> = faces
        .iter()
        .flat_map(|&f| mesh.face_nodes(f).map(|n| (n, mesh.face_area(f))))
        .collect();
    areas.sort_by_key(|a| a.0);
    areas
        .chunk_by(|a, b| a.0 == b.0)
        .map(|same| {
            (
                same[0].0,
                same.iter().map(|a| a.1).sum::<Vec3>().normalize_or_zero(),
            )
        })
        .collect()
}

fn nearest(mesh: &Mesh, surface: &[(u32, Vec3)], node: u32) -> (u32, Vec3) {
    let x = mesh.nodes[node as usize];
    let distance = |n: &(u32, Vec3)| (mesh.nodes[n.0 as usize] - x).length_squared();
    *surface
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .expect("a surface has nodes")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::box_mesh;

    #[test]
    fn the_interior_is_stretched_linearly_between_a_moving_and_a_held_face() {
        let mut mesh = box_mesh(Vec3::new(1.0, 1.0, 2.0), [3, 3, 6]).unwrap();
        let before = mesh.nodes.clone();
        let bottom = mesh.surfaces[4].faces.clone();
        let top_held = |n: u32| {
            if before[n as usize].z > 1.999 {
                Mat3::ZERO
            } else {
                Mat3::IDENTITY
            }
        };
        let follower = Follower::new(&mesh, &[&bottom], top_held, |_| false);
        follower.shift(&mut mesh.nodes, |_| Vec3::new(0.3, 0.0, -0.1));
        mesh.update_geometry();
        assert_eq!(mesh.turned_over(), None);
        for (x, old) in mesh.nodes.iter().zip(&before) {
            let expected = *old - Vec3::Z * 0.1 * (1.0 - old.z / 2.0);
            assert!((*x - expected).length() < 1e-8, "{x} {expected}");
        }
        assert!((mesh.total_volume() - 2.1).abs() < 1e-8);
        // Pushed past the held top, elements turn over, and that is noticed.
        follower.shift(&mut mesh.nodes, |_| Vec3::Z * 2.5);
        mesh.update_geometry();
        assert!(mesh.turned_over().is_some());
    }

    #[test]
    fn a_mesh_that_nothing_holds_goes_along() {
        let mut mesh = box_mesh(Vec3::ONE, [2, 2, 2]).unwrap();
        let bottom = mesh.surfaces[4].faces.clone();
        let follower = Follower::new(&mesh, &[&bottom], |_| Mat3::IDENTITY, |_| false);
        follower.shift(&mut mesh.nodes, |_| Vec3::new(0.0, 0.0, 0.25));
        assert_eq!(
            mesh.bounds(),
            [Vec3::new(0.0, 0.0, 0.25), Vec3::new(1.0, 1.0, 1.25)]
        );
    }
}
