//! A body that takes the mesh along, so that its fine part stays where the body goes (Jassim et al.
//! Section 4).
//!
//! Nodes of the driver's elements move with the driver's own material: its boundary stays on faces,
//! and its particles keep their barycentric coordinates. All other nodes go by the driver's mean
//! motion along one direction n where it touches its zone, times a weight w: 1 in the moving zone, 0
//! where the mesh is held in that direction. Between,
//!
//!   div (K ∇w) = 0,   K = V_e^(−2/3) (I + (κ − 1) n nᵀ),   κ = 10:
//!
//! small elements are stiff, so that large ones take up the motion, and the mesh is sheared along the
//! motion's sides rather than compressed before it, as shear thins elements least. (Were w
//! harmonic, the mesh at the lower edge of a narrow zone would be flattened when that has moved by about
//! its own size.) The layer of elements between the driver and the rest of its zone takes up the difference
//! of their motions.

use super::{FREE_COSINE, harmonic};
use crate::mesh::Mesh;
use crate::{Mat3, Vec3};
use rayon::prelude::*;

/// κ, how much stiffer the mesh is along the motion.
const STIFFER: f64 = 10.0;
/// An element whose shortest altitude falls below this share of what it was is degenerate.
const LEAST_ALTITUDE: f64 = 0.02;

/// Parts of the mesh by volume group.
#[derive(Clone, Copy, Debug)]
pub struct Zones<'a> {
    /// Whether each element is the driver's.
    pub driver: &'a [bool],
    /// Goes rigidly with the driver.
    pub moving: &'a [usize],
    /// Is compressed and stretched.
    pub blend: &'a [usize],
}

/// Why a mesh cannot move with a body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MotionError {
    #[error(
        "the driver `{driver}` does not fill whole elements: element {element} (counted from 0) is \
         filled in part"
    )]
    NotOnFaces { driver: String, element: u32 },
    #[error("volume `{group}` is in no zone of the mesh motion")]
    NotCovered { group: String },
    #[error(
        "element {element} (counted from 0) belongs to no volume, so it is in no zone of the mesh motion"
    )]
    NoGroup { element: u32 },
    #[error(
        "the moving zone `{zone}` touches boundary `{boundary}`, which holds the mesh in the direction \
         of its motion, first at {position} m"
    )]
    Held {
        zone: String,
        boundary: String,
        position: Vec3,
    },
}

/// Moves mesh nodes with a body.
#[derive(Clone, Debug, Default)]
pub struct Driven {
    /// Nodes of the driver's elements, and whether each belongs to the moving volumes, too: the mean
    /// motion is that of these, or of all if there are none.
    own: Vec<(u32, bool)>,
    /// Other nodes and how far they move where the driver moves by a metre, m/m.
    carried: Vec<(u32, Vec3)>,
    pub(super) direction: Vec3,
    /// Whether each node belongs to the driver or its zone; nothing if the mesh has no driver.
    pub(super) zone: Vec<bool>,
    /// Shortest altitude of each element when the motion began, m.
    altitudes: Vec<f64>,
}

crate::saved!(Driven {
    own,
    carried,
    direction,
    zone,
    altitudes,
});

impl Driven {
    /// `free` projects a vector into the directions that a node's fixities, rollers and prescribed
    /// velocities leave; nodes that `stays` is true of are held altogether. `holder` names the boundary
    /// that does so.
    pub fn new(
        mesh: &Mesh,
        zones: Zones,
        direction: Vec3,
        free: impl Fn(u32) -> Mat3,
        stays: impl Fn(u32) -> bool,
        holder: impl Fn(u32) -> String,
    ) -> Result<Driven, MotionError> {
        check_covered(mesh, zones)?;
        let mut is_own = vec![false; mesh.nodes.len()];
        let own = (0..mesh.tets.len()).filter(|&e| zones.driver[e]);
        for n in own.flat_map(|e| mesh.tets[e]) {
            is_own[n as usize] = true;
        }
        let held = |n: u32| stays(n) || (free(n) * direction).length() < FREE_COSINE;
        let mut weights: Vec<Option<f64>> = (0..mesh.nodes.len() as u32)
            .map(|n| held(n).then_some(0.0))
            .collect();
        let mut leads = vec![false; mesh.nodes.len()];
        for group in zones.moving.iter().map(|&g| &mesh.volume_groups[g]) {
            for &n in group.elements.iter().flat_map(|&e| &mesh.tets[e as usize]) {
                if held(n) && !is_own[n as usize] {
                    return Err(MotionError::Held {
                        zone: group.name.clone(),
                        boundary: holder(n),
                        position: mesh.nodes[n as usize],
                    });
                }
                weights[n as usize] = Some(1.0);
                leads[n as usize] = true;
            }
        }
        let all = || (0..mesh.nodes.len()).zip(is_own.iter().copied());
        let own = all().filter(|n| n.1).map(|n| (n.0 as u32, leads[n.0]));
        let mut own: Vec<(u32, bool)> = own.collect();
        if !own.iter().any(|n| n.1) {
            own.iter_mut().for_each(|n| n.1 = true);
        }
        own.iter().for_each(|n| weights[n.0 as usize] = Some(1.0));
        let zone = weights.iter().map(|w| *w == Some(1.0)).collect();
        let weights = harmonic(mesh, &weights, |e, slope| {
            let along = direction * (slope.dot(direction) * (STIFFER - 1.0));
            (slope + along) * mesh.volumes[e].cbrt()
        });
        let others = all().filter(|n| !n.1 && weights[n.0] > 0.0);
        let carried = others.map(|(n, _)| (n as u32, free(n as u32) * direction * weights[n]));
        Ok(Driven {
            carried: carried.collect(),
            own,
            direction,
            zone,
            altitudes: (0..mesh.tets.len()).map(|e| mesh.altitude(e)).collect(),
        })
    }

    /// Whether any node ever moves.
    pub fn moves(&self) -> bool {
        !self.own.is_empty()
    }

    /// Whether a node goes rigidly with the driver or is its own.
    pub fn in_zone(&self, node: u32) -> bool {
        self.zone.get(node as usize) == Some(&true)
    }

    /// Moves nodes; `driver` gives mass, kg, and displacement, m, of the driver at one of its nodes.
    pub fn shift(&self, nodes: &mut [Vec3], driver: impl Fn(u32) -> (f64, Vec3)) {
        let (mut mass, mut moved) = (0.0, 0.0);
        for &(n, leads) in &self.own {
            let (m, u) = driver(n);
            nodes[n as usize] += u;
            if leads {
                mass += m;
                moved += m * u.dot(self.direction);
            }
        }
        if mass > 0.0 {
            let mean = moved / mass;
            for &(n, motion) in &self.carried {
                nodes[n as usize] += motion * mean;
            }
        }
    }

    /// The first element that has become degenerate, if any has.
    pub fn degenerate(&self, mesh: &Mesh) -> Option<u32> {
        let before = self.altitudes.par_iter().enumerate().with_min_len(1024);
        let found = before.position_first(|(e, before)| mesh.altitude(e) < LEAST_ALTITUDE * before);
        found.map(|e| e as u32)
    }
}

fn check_covered(mesh: &Mesh, zones: Zones) -> Result<(), MotionError> {
    let mut covered = zones.driver.to_vec();
    for &group in zones.moving.iter().chain(zones.blend) {
        for &e in &mesh.volume_groups[group].elements {
            covered[e as usize] = true;
        }
    }
    let Some(element) = covered.iter().position(|c| !c) else {
        return Ok(());
    };
    let element = element as u32;
    let mut groups = mesh.volume_groups.iter();
    Err(match groups.find(|g| g.elements.contains(&element)) {
        Some(group) => MotionError::NotCovered {
            group: group.name.clone(),
        },
        None => MotionError::NoGroup { element },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{VolumeGroup, box_mesh};

    /// A box of three floors; the upper half of the uppermost drives.
    fn floors() -> (Mesh, Vec<bool>) {
        let mut mesh = box_mesh(Vec3::new(1.0, 1.0, 3.0), [1, 1, 6]).unwrap();
        let floor = |e: usize| mesh.centroid(e).z.floor() as usize;
        let names = ["low", "middle", "high"];
        let groups = names.iter().enumerate().map(|(k, name)| VolumeGroup {
            name: (*name).into(),
            elements: (0..mesh.tets.len())
                .filter(|&e| floor(e) == k)
                .map(|e| e as u32)
                .collect(),
        });
        let groups = groups.collect();
        let driver = (0..mesh.tets.len()).map(|e| mesh.centroid(e).z > 2.5);
        let driver = driver.collect();
        mesh.volume_groups = groups;
        (mesh, driver)
    }

    fn held_below(mesh: &Mesh, z: f64) -> impl Fn(u32) -> Mat3 {
        let held: Vec<bool> = mesh.nodes.iter().map(|x| x.z <= z).collect();
        move |n| match held[n as usize] {
            true => Mat3::from_diagonal(Vec3::new(1.0, 1.0, 0.0)),
            false => Mat3::IDENTITY,
        }
    }

    /// The driver shears and falls by 0.3 m in the mean; its zone falls by 0.3 m, the lowest floor is
    /// compressed linearly.
    #[test]
    fn a_zone_goes_with_its_driver_and_the_rest_is_compressed() {
        let (mut mesh, driver) = floors();
        let zones = Zones {
            driver: &driver,
            moving: &[1, 2],
            blend: &[0],
        };
        let free = held_below(&mesh, 0.0);
        let driven = Driven::new(&mesh, zones, -Vec3::Z, free, |_| false, |_| String::new());
        let driven = driven.unwrap();
        let before = mesh.nodes.clone();
        let own = |n: u32| {
            let x = before[n as usize];
            (1.0, Vec3::new(0.1 * (x.z - 2.5), 0.0, -0.3))
        };
        driven.shift(&mut mesh.nodes, own);
        mesh.update_geometry();
        for (n, x) in before.iter().enumerate() {
            let moved = mesh.nodes[n] - *x;
            let expected = match x.z {
                z if z >= 2.5 => own(n as u32).1,
                z if z >= 1.0 => Vec3::new(0.0, 0.0, -0.3),
                z => Vec3::new(0.0, 0.0, -0.3 * z),
            };
            assert!((moved - expected).length() < 1e-8, "{x} {moved}");
            assert_eq!(driven.in_zone(n as u32), x.z >= 1.0);
        }
        assert_eq!((mesh.turned_over(), driven.degenerate(&mesh)), (None, None));
        for _ in 0..23 {
            driven.shift(&mut mesh.nodes, |_| (1.0, Vec3::new(0.0, 0.0, -0.03)));
        }
        mesh.update_geometry();
        let flat = driven.degenerate(&mesh).unwrap() as usize;
        assert!(mesh.volume_groups[0].elements.contains(&(flat as u32)));
        assert_eq!(mesh.turned_over(), None);
    }

    /// A driver that becomes longer: its zone goes with the end that touches it, and with the mean of
    /// all of it where its own volume is among the moving ones.
    #[test]
    fn the_zone_goes_with_the_part_of_the_driver_that_touches_it() {
        let (mut mesh, driver) = floors();
        let zone_moves = |mesh: &Mesh| {
            let zones = Zones {
                driver: &driver,
                moving: &[1, 2],
                blend: &[0],
            };
            let free = held_below(mesh, 0.0);
            let driven = Driven::new(mesh, zones, -Vec3::Z, free, |_| false, |_| String::new());
            let mut nodes = mesh.nodes.clone();
            let own = |n: u32| {
                (
                    1.0,
                    Vec3::Z * (0.2 * (mesh.nodes[n as usize].z - 2.5) - 0.3),
                )
            };
            driven.unwrap().shift(&mut nodes, own);
            let n = mesh.nodes.iter().position(|x| x.z == 1.5).unwrap();
            nodes[n].z - mesh.nodes[n].z
        };
        assert!((zone_moves(&mesh) + 0.25).abs() < 1e-12);
        mesh.volume_groups[2]
            .elements
            .retain(|&e| !driver[e as usize]);
        assert!((zone_moves(&mesh) + 0.3).abs() < 1e-12);
    }

    #[test]
    fn zones_cover_the_mesh_and_move_freely() {
        let (mesh, driver) = floors();
        let new = |moving: &[usize], blend: &[usize], held: f64| {
            let zones = Zones {
                driver: &driver,
                moving,
                blend,
            };
            let free = held_below(&mesh, held);
            Driven::new(&mesh, zones, -Vec3::Z, free, |_| false, |_| "floor".into()).map(|_| ())
        };
        let group = "low".to_owned();
        assert_eq!(
            new(&[1, 2], &[], 0.0),
            Err(MotionError::NotCovered { group })
        );
        // What is left of the upper floor beside the driver has to be named.
        assert!(new(&[1], &[0], 0.0).is_err());
        assert!(new(&[2], &[0, 1], 0.0).is_ok());
        let held = new(&[1, 2], &[0], 1.0);
        assert!(matches!(held, Err(MotionError::Held { zone, boundary, .. })
            if zone == "middle" && boundary == "floor"));
    }
}
