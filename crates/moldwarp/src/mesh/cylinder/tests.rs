use super::lattice::progression;
use super::*;
use crate::Vec3;
use std::collections::{HashMap, HashSet};

fn sector(degrees: f64, cells: [usize; 3], split: Split) -> CylinderSector {
    CylinderSector {
        outer: vec![[0.5, 0.0], [0.5, 1.0]],
        inner: None,
        angle: degrees.to_radians(),
        radial: cells[0],
        around: cells[1],
        vertical: vec![cells[2]],
        radial_grading: 1.0,
        vertical_grading: vec![1.0],
        split,
    }
}

/// A bottle with a waist, hollow or solid, with graded cells.
fn bottle(hollow: bool, split: Split) -> CylinderSector {
    CylinderSector {
        outer: vec![[1.0, -1.0], [0.6, 0.0], [0.8, 0.5]],
        inner: hollow.then(|| vec![[0.2, -1.0], [0.3, 0.0], [0.1, 0.5]]),
        vertical: vec![4, 3],
        radial_grading: 3.0,
        vertical_grading: vec![0.5, 2.0],
        ..sector(50.0, [3, 2, 0], split)
    }
}

const SPLITS: [Split; 2] = [Split::Six, Split::Symmetric];

/// ∫ (R² − r²) dz of frustums with the radii a and b at their ends: (a² + ab + b²)/3 a height.
fn profile_integral(sector: &CylinderSector, power: impl Fn(f64, f64) -> f64) -> f64 {
    let of = |points: &[[f64; 2]]| -> f64 {
        let segment = |p: &[[f64; 2]]| (p[1][1] - p[0][1]) * power(p[0][0], p[1][0]);
        points.windows(2).map(segment).sum()
    };
    of(&sector.outer) - sector.inner.as_deref().map_or(0.0, of)
}

#[test]
fn volume_and_sides_are_those_of_the_faceted_body() {
    for split in SPLITS {
        for hollow in [false, true] {
            let sector = bottle(hollow, split);
            let mesh = sector.mesh().unwrap();
            let (n, width) = (sector.around as f64, sector.angle / sector.around as f64);
            // Each horizontal section is n times ½ sin(α/n) (R² − r²).
            let slice = 0.5 * n * width.sin();
            let volume = slice * profile_integral(&sector, |a, b| (a * a + a * b + b * b) / 3.0);
            assert!((mesh.total_volume() / volume - 1.0).abs() < 1e-14);

            // The sides are the whole boundary, once, and the vector areas of plane sides are known.
            let sides: Vec<_> = mesh.surfaces.iter().flat_map(|s| &s.faces).collect();
            let distinct: HashSet<_> = sides.iter().map(|f| (f.element, f.local)).collect();
            assert_eq!(distinct.len(), sides.len());
            assert_eq!(mesh.boundary_faces().count(), sides.len());
            let area = |name: &str| -> Vec3 {
                let surface = &mesh.surfaces[mesh.surface(name).unwrap()];
                surface.faces.iter().map(|&f| mesh.face_area(f)).sum()
            };
            let meridian = profile_integral(&sector, |a, b| 0.5 * (a + b));
            let (sin, cos) = sector.angle.sin_cos();
            let expected = [
                ("theta-min", Vec3::new(0.0, -meridian, 0.0)),
                ("theta-max", Vec3::new(-sin, cos, 0.0) * meridian),
                (
                    "z-min",
                    Vec3::new(0.0, 0.0, -slice * (1.0 - 0.04 * f64::from(hollow))),
                ),
                (
                    "z-max",
                    Vec3::new(0.0, 0.0, slice * (0.64 - 0.01 * f64::from(hollow))),
                ),
            ];
            for (name, expected) in expected {
                assert!((area(name) - expected).length() < 1e-14, "{name}");
            }
            let closed: Vec3 = mesh.boundary_faces().map(|f| mesh.face_area(f)).sum();
            assert!(closed.length() < 1e-14);
            assert_eq!(mesh.surface("r-min").is_some(), hollow);
            // Each outer facet is a trapezium as wide as a chord.
            let side: f64 = mesh.surfaces[mesh.surface("r-max").unwrap()]
                .faces
                .iter()
                .map(|&f| mesh.face_area(f).length())
                .sum();
            let half = (0.5 * width).cos();
            let slant = |p: &[[f64; 2]]| ((p[1][0] - p[0][0]) * half).hypot(p[1][1] - p[0][1]);
            let chord = |p: &[[f64; 2]]| (p[0][0] + p[1][0]) * (0.5 * width).sin();
            let around: f64 = sector
                .outer
                .windows(2)
                .map(|p| n * chord(p) * slant(p))
                .sum();
            assert!((side / around - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn numbers_of_tetrahedra_are_those_of_the_split() {
    for (split, wedge, brick) in [(Split::Six, 3, 6), (Split::Symmetric, 14, 24)] {
        let mesh = sector(20.0, [3, 2, 4], split).mesh().unwrap();
        assert_eq!(mesh.tets.len(), 4 * 2 * (wedge + 2 * brick));
    }
}

#[test]
fn the_axis_and_the_first_plane_are_exact() {
    for split in SPLITS {
        let mesh = sector(20.0, [3, 2, 4], split).mesh().unwrap();
        let axis = mesh.nodes.iter().filter(|x| x.x == 0.0 && x.y == 0.0);
        assert_eq!(axis.count(), 5);
        let first = &mesh.surfaces[mesh.surface("theta-min").unwrap()];
        let mut nodes = first.faces.iter().flat_map(|&f| mesh.face_nodes(f));
        assert!(nodes.all(|n| mesh.nodes[n as usize].y == 0.0));
        let square = sector(90.0, [2, 2, 1], split).mesh().unwrap();
        let last = &square.surfaces[square.surface("theta-max").unwrap()];
        let mut nodes = last.faces.iter().flat_map(|&f| square.face_nodes(f));
        assert!(nodes.all(|n| square.nodes[n as usize].x == 0.0));
    }
}

#[test]
fn cells_grow_by_their_grading() {
    let ends = progression(4, 8.0);
    let sizes: Vec<f64> = ends.windows(2).map(|e| e[1] - e[0]).collect();
    assert!((sizes[3] / sizes[0] - 8.0).abs() < 1e-13);
    assert!(sizes.windows(2).all(|s| (s[1] / s[0] - 2.0).abs() < 1e-13));
    assert_eq!((ends[0], ends[4]), (0.0, 1.0));
    let mesh = bottle(false, Split::Six).mesh().unwrap();
    let mut heights: Vec<f64> = mesh.nodes.iter().map(|x| x.z).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    assert_eq!(
        (heights.len(), heights[0], heights[4], heights[7]),
        (8, -1.0, 0.0, 0.5)
    );
    let size = |i: usize| heights[i + 1] - heights[i];
    assert!((size(3) / size(0) - 0.5).abs() < 1e-13);
    assert!((size(6) / size(4) - 2.0).abs() < 1e-13);
}

/// The tetrahedra by their sorted nodes, each node by where `map` takes it; those that it takes out
/// of the mesh are left out.
fn mapped(mesh: &Mesh, map: impl Fn(Vec3) -> Vec3) -> Vec<[u32; 4]> {
    let key = |x: Vec3| (x * 1e6).round().as_i64vec3();
    let found: HashMap<_, u32> = mesh.nodes.iter().map(|&x| key(x)).zip(0..).collect();
    assert_eq!(found.len(), mesh.nodes.len());
    let images: Vec<Option<u32>> = mesh
        .nodes
        .iter()
        .map(|&x| found.get(&key(map(x))).copied())
        .collect();
    let image = |tet: &[u32; 4]| {
        let nodes: Option<Vec<u32>> = tet.iter().map(|&n| images[n as usize]).collect();
        let mut nodes: [u32; 4] = nodes?.try_into().ok()?;
        nodes.sort_unstable();
        Some(nodes)
    };
    let mut tets: Vec<_> = mesh.tets.iter().filter_map(image).collect();
    tets.sort_unstable();
    tets
}

fn turned(by: f64) -> impl Fn(Vec3) -> Vec3 {
    let (sin, cos) = by.sin_cos();
    move |x| Vec3::new(cos * x.x - sin * x.y, sin * x.x + cos * x.y, x.z)
}

fn mirrored(about: f64) -> impl Fn(Vec3) -> Vec3 {
    let turn = turned(2.0 * about);
    move |x| turn(Vec3::new(x.x, -x.y, x.z))
}

#[test]
fn the_middle_plane_is_one_of_symmetry() {
    for split in SPLITS {
        for hollow in [false, true] {
            let sector = bottle(hollow, split);
            let mesh = sector.mesh().unwrap();
            let image = mapped(&mesh, mirrored(0.5 * sector.angle));
            assert_eq!(image, mapped(&mesh, |x| x));
        }
    }
    // With an odd number of cells only the symmetric split has it.
    for (split, equal) in [(Split::Six, false), (Split::Symmetric, true)] {
        let mesh = sector(60.0, [2, 3, 2], split).mesh().unwrap();
        let image = mapped(&mesh, mirrored(30f64.to_radians()));
        assert_eq!(image == mapped(&mesh, |x| x), equal);
    }
}

#[test]
fn symmetric_cells_around_are_alike() {
    let mesh = sector(60.0, [2, 3, 2], Split::Symmetric).mesh().unwrap();
    let all: HashSet<_> = mapped(&mesh, |x| x).into_iter().collect();
    let image = mapped(&mesh, turned(20f64.to_radians()));
    assert_eq!(image.len(), all.len() * 2 / 3);
    assert!(image.iter().all(|tet| all.contains(tet)));
}

#[test]
fn wrong_sectors_are_named() {
    let refused = |change: &dyn Fn(&mut CylinderSector)| {
        let mut sector = bottle(true, Split::Six);
        change(&mut sector);
        sector.mesh().unwrap_err()
    };
    use CylinderError::*;
    assert_eq!(refused(&|s| s.outer.truncate(1)), OnePoint);
    assert_eq!(refused(&|s| s.outer[2][1] = 0.0), Height { point: 2 });
    assert_eq!(refused(&|s| s.outer[1][1] = f64::NAN), Height { point: 1 });
    assert_eq!(refused(&|s| s.outer[1][0] = 0.0), Radius { point: 1 });
    let inner = |change: &dyn Fn(&mut Vec<[f64; 2]>)| {
        refused(&|s| change(s.inner.as_mut().expect("the bottle is hollow")))
    };
    assert_eq!(inner(&|i| i.truncate(2)), InnerCount { inner: 2, outer: 3 });
    assert_eq!(inner(&|i| i[1][1] = 0.1), InnerHeight { point: 1 });
    assert_eq!(inner(&|i| i[2][0] = 0.8), InnerRadius { point: 2 });
    assert_eq!(inner(&|i| i[2][0] = 0.0), InnerMixed { point: 2 });
    assert_eq!(refused(&|s| s.angle = 0.0), Angle);
    assert_eq!(refused(&|s| s.angle = 3.2), Angle);
    assert_eq!(refused(&|s| s.angle = PI), Wide);
    assert_eq!(refused(&|s| s.around = 0), Cells { direction: 1 });
    assert_eq!(refused(&|s| s.vertical[1] = 0), Cells { direction: 2 });
    let three = Segments {
        segments: 2,
        given: 3,
    };
    assert_eq!(refused(&|s| s.vertical.push(1)), three);
    assert_eq!(refused(&|s| s.vertical_grading.push(1.0)), three);
    assert_eq!(
        refused(&|s| s.radial_grading = -1.0),
        Grading { direction: 0 }
    );
    assert_eq!(
        refused(&|s| s.vertical_grading[1] = 0.0),
        Grading { direction: 1 }
    );
    let half = CylinderSector {
        angle: PI,
        around: 3,
        ..bottle(true, Split::Six)
    };
    assert!(half.mesh().is_ok());
}
