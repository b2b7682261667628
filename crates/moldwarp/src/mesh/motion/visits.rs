//! How many particles elements of the moving zone will hold where others were seeded. Those of the
//! blend are larger and go less far.

use super::Driven;
use crate::Vec3;
use crate::mesh::Mesh;

/// Places on the way that are looked at.
const STOPS: usize = 24;

/// The element that will hold fewest particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visit {
    /// Particles that it is expected to hold: its volume times their number by volume where it will be.
    pub particles: f64,
    /// How far the mesh has then moved, m.
    pub after: f64,
    /// Where the element will be, m.
    pub position: Vec3,
    /// As far as the motion was looked at, m.
    pub travel: f64,
}

impl Driven {
    /// Half the way from the moving zone to the end of the mesh, m: how far one may want to go.
    pub fn room(&self, mesh: &Mesh) -> f64 {
        let along = |n: usize| mesh.nodes[n].dot(self.direction);
        let end = (0..mesh.nodes.len()).map(along);
        let front = (0..mesh.nodes.len()).filter(|&n| self.zone[n]).map(along);
        let greatest = |a: f64, b: f64| a.max(b);
        0.5 * (end.fold(f64::NEG_INFINITY, greatest) - front.fold(f64::NEG_INFINITY, greatest))
    }

    /// Looks `travel` metres ahead at elements of the moving zone that are not the driver's; `inside` gives the number of
    /// particles that an element holds now. What the driver pushes out of its way does not count.
    pub fn fewest(
        &self,
        mesh: &Mesh,
        travel: f64,
        driver: impl Fn(u32) -> bool,
        inside: impl Fn(u32) -> usize,
    ) -> Option<Visit> {
        let mut fewest: Option<Visit> = None;
        for stop in 1..=STOPS {
            let after = travel * stop as f64 / STOPS as f64;
            for (e, tet) in mesh.tets.iter().enumerate() {
                let visits = tet.iter().all(|&n| self.zone[n as usize]) && !driver(e as u32);
                if !visits {
                    continue;
                }
                let (volume, position) =
                    (mesh.volumes[e], mesh.centroid(e) + self.direction * after);
                let Some(there) = mesh.walk(e as u32, position).filter(|&t| !driver(t)) else {
                    continue;
                };
                let particles = inside(there) as f64 * volume / mesh.volumes[there as usize];
                if inside(there) > 0 && fewest.is_none_or(|f| particles < f.particles) {
                    fewest = Some(Visit {
                        particles,
                        after,
                        position,
                        travel,
                    });
                }
            }
        }
        fewest
    }
}
