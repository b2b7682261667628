//! What is read, and that all variants of the format say the same.

use super::{V22, V41, parse, write};
use moldwarp::Vec3;
use moldwarp::mesh::Mesh;
use moldwarp_io::mesh::{MeshFile, explain_mesh_error, read_gmsh};
use std::path::{Path, PathBuf};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

#[test]
fn a_literal_is_read_in_every_variant() {
    let files = [
        V22.as_bytes().to_vec(),
        V41.as_bytes().to_vec(),
        V22.replace('\n', "\r\n").into_bytes(),
        V41.replace('\n', "\r\n").into_bytes(),
        write::v22(false),
        write::v22(true),
        write::v41(false),
        write::v41(true),
    ];
    for (i, bytes) in files.iter().enumerate() {
        let file = parse(bytes).unwrap_or_else(|e| panic!("variant {i}: {e}"));
        assert_eq!(file.node_tags, [40, 10, 30, 20]);
        assert_eq!(file.raw.nodes, [Vec3::Z, Vec3::ZERO, Vec3::Y, Vec3::X]);
        assert_eq!(file.element_tags, [8]);
        assert_eq!(file.raw.tets, [[1, 3, 2, 0]]);
        assert_eq!(file.raw.volume_groups, [("soil".to_owned(), vec![0])]);
        let base = ("the base".to_owned(), vec![[1, 2, 3]]);
        assert_eq!(file.raw.surface_groups, [base]);
        let note = "1 node belongs to no tetrahedron and was dropped";
        assert_eq!(file.notes, [note]);
        assert_eq!(Mesh::new(file.raw).unwrap().volumes, [1.0 / 6.0]);
    }
}

#[test]
fn files_of_gmsh_are_the_same_mesh_in_all_four_variants() {
    let read = |name| read_gmsh(&data(name)).unwrap();
    let first = read("blocks-22-ascii.msh");
    for name in [
        "blocks-22-binary.msh",
        "blocks-41-ascii.msh",
        "blocks-41-binary.msh",
    ] {
        let other = read(name);
        // Gmsh writes 16 digits in ASCII, one short of exact.
        assert_eq!(other.raw.nodes.len(), first.raw.nodes.len(), "{name}");
        for (a, b) in other.raw.nodes.iter().zip(&first.raw.nodes) {
            assert!((*a - *b).length() < 1e-15, "{name}: {a} is not {b}");
        }
        assert_eq!(other.raw.tets, first.raw.tets, "{name}");
        assert_eq!(other.raw.volume_groups, first.raw.volume_groups, "{name}");
        assert_eq!(turned(&other), turned(&first), "{name}");
        assert_eq!(other.node_tags, first.node_tags, "{name}");
        assert_eq!(other.notes, first.notes, "{name}");
    }
    let names: Vec<&str> = first
        .raw
        .surface_groups
        .iter()
        .map(|(name, _)| &name[..])
        .collect();
    assert_eq!(names, ["x-min", "between", "also x-min", "9"]);
    let mesh = Mesh::new(first.raw).unwrap();
    assert!((mesh.total_volume() - 1.5).abs() < 1e-12);
    for (name, volume) in [("soft clay", 1.0), ("Kies ø", 0.5)] {
        let group = &mesh.volume_groups[mesh.volume_group(name).unwrap()];
        let sum: f64 = group
            .elements
            .iter()
            .map(|&e| mesh.volumes[e as usize])
            .sum();
        assert!((sum - volume).abs() < 1e-12, "{name}");
    }
    for surface in &mesh.surfaces {
        let area: f64 = surface
            .faces
            .iter()
            .map(|&f| mesh.face_area(f).length())
            .sum();
        assert!((area - 1.0).abs() < 1e-12, "{}", surface.name);
    }
}

/// Surface groups with the nodes of each triangle in ascending order: MSH 2.2 writes those of a
/// surface turned round the other way.
fn turned(file: &MeshFile) -> Vec<(String, Vec<[u32; 3]>)> {
    let mut groups = file.raw.surface_groups.clone();
    for triangle in groups.iter_mut().flat_map(|(_, triangles)| triangles) {
        triangle.sort_unstable();
    }
    groups
}

#[test]
fn the_absorbing_column_is_a_good_mesh() {
    let path = "../../examples/absorbing-column/column.msh";
    let file = read_gmsh(&Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap();
    assert!(file.notes.is_empty());
    let mesh = Mesh::new(file.raw).unwrap();
    assert!((mesh.total_volume() - 0.01).abs() < 1e-14);
    assert!(mesh.quality().smallest_altitude > 0.3 * 0.05);
    assert_eq!(mesh.volume_group("soil"), Some(0));
    let sides = [
        ("x-min", Vec3::new(-0.1, 0.0, 0.0)),
        ("x-max", Vec3::new(0.1, 0.0, 0.0)),
        ("y-min", Vec3::new(0.0, -0.1, 0.0)),
        ("y-max", Vec3::new(0.0, 0.1, 0.0)),
        ("bottom", Vec3::new(0.0, 0.0, -0.01)),
        ("top", Vec3::new(0.0, 0.0, 0.01)),
    ];
    for (name, area) in sides {
        let surface = &mesh.surfaces[mesh.surface(name).unwrap()];
        let sum: Vec3 = surface.faces.iter().map(|&f| mesh.face_area(f)).sum();
        assert!((sum - area).length() < 1e-14, "{name}: {sum}");
    }
}

#[test]
fn groups_without_a_name_are_called_by_their_tag_and_empty_ones_noted() {
    let text = V22
        .replace("3 1 \"soil\"", "3 2 \"clay\"")
        .replace("2 5 \"the base\"", "2 6 \"top\"")
        .replace("99 7 7 7\n", "")
        .replace("$Nodes\n5", "$Nodes\n4");
    let file = parse(text).unwrap();
    assert_eq!(file.raw.volume_groups[0].0, "1");
    assert_eq!(file.raw.surface_groups[0].0, "5");
    assert_eq!(
        file.notes,
        [
            "physical surface `top` has no triangle in the file",
            "physical volume `clay` has no tetrahedron in the file"
        ]
    );
}

#[test]
fn groups_lost_by_gmsh_are_noted() {
    let text = V22
        .replace("2 2 5 1", "2 2 0 1")
        .replace("4 2 1 1", "4 2 0 1");
    assert_eq!(
        parse(text).unwrap().notes[1],
        "no element is in one of the file's physical groups; MSH 2.2 loses them under \
         Mesh.SaveAll, MSH 4.1 does not"
    );
}

#[test]
fn elements_without_a_group_are_part_of_the_mesh() {
    for text in [
        V22.replace("8 4 2 1 1", "8 4 2 0 1"),
        V22.replace("8 4 2 1 1", "8 4 0"),
        V41.replace("1 0 0 0 1 1 1 1 1 1 -1", "1 0 0 0 1 1 1 0 1 -1"),
        V41.replace("\n3 1 4 1\n", "\n3 77 4 1\n"),
    ] {
        let file = parse(text).unwrap();
        assert_eq!(file.raw.tets.len(), 1);
        assert!(file.raw.volume_groups.is_empty());
    }
}

#[test]
fn a_triangle_may_be_in_several_groups_and_counts_once_in_each() {
    let text = V22
        .replace("$Elements\n4", "$Elements\n6")
        .replace("8 4 2", "4 2 2 6 1 10 20 30\n5 2 2 5 1 20 10 30\n8 4 2");
    let file = parse(text).unwrap();
    let groups: Vec<_> = file.raw.surface_groups.into_iter().collect();
    assert_eq!(groups[0], ("the base".to_owned(), vec![[1, 2, 3]]));
    assert_eq!(groups[1], ("6".to_owned(), vec![[1, 3, 2]]));
    let file = parse(V41.replace("0 1 -5 0", "0 2 -5 6 0")).unwrap();
    assert_eq!(file.raw.surface_groups.len(), 2);
}

#[test]
fn sections_of_other_kinds_are_passed_over() {
    let comments = "$Comments\nmade by hand, $5\n$EndComments\n";
    let data = "$NodeData\n1\n\"T\"\n0\n3\n0\n1\n0\n$EndNodeData\n";
    let file = parse(format!("{comments}{V22}{data}{comments}")).unwrap();
    assert_eq!(file.raw.tets.len(), 1);
}

#[test]
fn a_fault_of_the_mesh_is_told_in_the_files_tags() {
    let text = V22.replace("3 2 2 5 1 10 30 20", "3 2 2 5 1 10 30 99");
    let MeshFile {
        raw,
        node_tags,
        element_tags,
        ..
    } = parse(text).unwrap();
    let error = Mesh::new(raw).unwrap_err();
    assert_eq!(
        explain_mesh_error(&error, &node_tags, &element_tags),
        "surface `the base` has a triangle of nodes 10, 30, 99 that is no face of a tetrahedron; \
         Gmsh saves only volumes that are in a Physical Volume, so check that the one behind this \
         surface is"
    );
}
