//! Plane meshes of meridians.

use moldwarp::Mesh;
use moldwarp_io::mesh::{parse_gmsh, parse_plane_gmsh};
use std::path::Path;

/// A square of two triangles beside the axis, in x and z; a line on its outside, one on the axis, and a
/// triangle in no group.
const PLANE: &str = "\
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 7 \"outside\"
1 8 \"axis\"
2 1 \"soil\"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 2 0 0
3 2 0 1
4 0 0 1
5 3 0 0
$EndNodes
$Elements
5
1 1 2 7 1 2 3
2 1 2 8 1 1 4
3 2 2 1 1 1 2 3
4 2 2 1 1 1 3 4
5 2 2 0 1 2 5 3
$EndElements
";

fn refusal(text: &str) -> String {
    let read = parse_plane_gmsh(Path::new("mesh.msh"), text.as_bytes());
    read.expect_err("this file is to be refused").to_string()
}

/// Drawn in x and z or in x and y it is the same; revolved it is a third of a cylinder with facets.
#[test]
fn a_meridian_is_read_and_revolved() {
    let flat = PLANE.replace("2 2 0 0\n3 2 0 1\n4 0 0 1", "2 2 0 0\n3 2 1 0\n4 0 1 0");
    for text in [PLANE.to_owned(), flat] {
        let file = parse_plane_gmsh(Path::new("mesh.msh"), text.as_bytes()).unwrap();
        assert_eq!(
            file.plane.nodes,
            [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]
        );
        assert_eq!(file.node_tags, [1, 2, 3, 4]);
        assert_eq!(file.plane.areas, [("soil".to_owned(), vec![0, 1])]);
        assert_eq!(
            file.notes,
            ["1 node belongs to no triangle and was dropped"]
        );
        let angle = std::f64::consts::PI * 2.0 / 3.0;
        let mesh = Mesh::new(file.plane.revolve(angle, 4).raw).unwrap();
        let expected = 4.0 * 2.0 * (angle / 4.0).sin();
        assert!((mesh.total_volume() - expected).abs() < 1e-12);
        let faces = |name: &str| mesh.surfaces[mesh.surface(name).unwrap()].faces.len();
        assert_eq!(
            (faces("outside"), faces("axis"), faces("theta-max")),
            (8, 0, 2)
        );
    }
}

#[test]
fn what_is_no_meridian_is_refused() {
    let turned = PLANE.replace("2 2 0 0\n3", "2 2 0.5 0\n3");
    assert!(refusal(&turned).contains("node 2 lies in neither of the planes"));
    let behind = PLANE.replace("4 0 0 1", "4 -1 0 1");
    assert!(refusal(&behind).contains("node 4 has a negative radius"));
    let no_group = PLANE.replace("2 2 1 1", "2 2 0 1");
    let message = refusal(&no_group);
    assert!(
        message.contains("no triangles in a physical group"),
        "{message}"
    );
    assert!(
        message.contains("gmsh -2 mesh.geo -o mesh.msh"),
        "{message}"
    );
    let twice = PLANE
        .replace("3\n1 7", "4\n2 2 \"rock\"\n1 7")
        .replace("5 2 2 0 1 2 5 3", "5 2 2 2 1 1 2 3");
    let message = refusal(&twice);
    assert!(message.contains("`soil` and `rock`"), "{message}");
    assert!(refusal(super::V22).contains("leave `revolve` out"));
    // And the other way round.
    let solid = parse_gmsh(Path::new("mesh.msh"), PLANE.as_bytes()).unwrap_err();
    assert!(solid.to_string().contains("`revolve`"));
}
