//! Files that are refused, and what their users are told.

use super::{V22, V41, refusal, without_folder, write};
use moldwarp_io::mesh::read_gmsh;
use std::fs;

/// Message of [`V22`] with `from` replaced by `to`.
fn v22(from: &str, to: &str) -> String {
    assert!(V22.contains(from), "`{from}` is not in the literal");
    refusal(V22.replacen(from, to, 1))
}

/// Message of [`V41`] with `from` replaced by `to`.
fn v41(from: &str, to: &str) -> String {
    assert!(V41.contains(from), "`{from}` is not in the literal");
    refusal(V41.replacen(from, to, 1))
}

#[test]
fn a_missing_file_is_made_from_its_geometry_or_sought_among_others() {
    let folder = tempfile::tempdir().unwrap();
    let message = |name: &str| {
        let error = read_gmsh(&folder.path().join(name)).unwrap_err();
        without_folder(&error.to_string(), folder.path())
    };
    assert_eq!(
        message("column.msh"),
        "column.msh does not exist: neither is there a .geo of the same name to mesh, nor any \
         .msh file beside it"
    );
    assert_eq!(
        message("sub/column.msh"),
        "sub/column.msh does not exist: there is no folder sub"
    );
    for name in ["colum.msh", "slope.msh", "other.txt"] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    assert_eq!(
        message("column.msh"),
        "column.msh does not exist: there is no .geo of the same name to mesh either; the folder \
         has `colum.msh`, `slope.msh`"
    );
    fs::write(folder.path().join("column.geo"), "// A column\n").unwrap();
    assert_eq!(
        message("column.msh"),
        "column.msh does not exist: make it with `gmsh -3 column.geo -o column.msh`"
    );
    fs::write(folder.path().join("a column's.geo"), "").unwrap();
    assert_eq!(
        message("a column's.msh"),
        r"a column's.msh does not exist: make it with `gmsh -3 'a column'\''s.geo' -o 'a column'\''s.msh'`"
    );
    assert_eq!(
        message("column.geo"),
        "column.geo, line 1: a Gmsh mesh begins with `$MeshFormat`, this with \
         `// A column`; mesh it with `gmsh -3 column.geo -o column.msh`"
    );
    fs::create_dir(folder.path().join("dir.msh")).unwrap();
    assert_eq!(
        message("dir.msh"),
        "dir.msh cannot be read: it is not a regular file"
    );
}

#[test]
fn other_versions_are_converted_by_gmsh() {
    let command = "2.2 and 4.1 can be read: `gmsh mesh.msh -save -format msh41 -o mesh-41.msh`";
    assert_eq!(
        refusal("$NOD\n1\n1 0 0 0\n$ENDNOD\n"),
        format!("mesh.msh, line 1: MSH format `1.0`; {command}")
    );
    assert_eq!(
        v41("4.1 0 8", "4 0 8"),
        format!("mesh.msh, line 2: MSH format `4`; {command}")
    );
}

#[test]
fn a_wrong_header_is_refused() {
    assert_eq!(
        refusal("solid cube\nfacet"),
        "mesh.msh, line 1: a Gmsh mesh begins with `$MeshFormat`, this with \
         `solid cube`; mesh the geometry again, or name the mesh that Gmsh wrote"
    );
    assert_eq!(
        v22("2.2 0 8", "2.2 0 4"),
        "mesh.msh, line 2: expected 8, the size of a number, found `4`"
    );
    assert_eq!(
        v22("2.2 0 8", "2.2 2 8"),
        "mesh.msh, line 2: expected 0 for ASCII or 1 for binary, found `2`"
    );
    let mut bytes = write::v41(false);
    bytes[20] = 7;
    assert_eq!(
        refusal(bytes),
        "mesh.msh, byte 20: expected the integer 1, which shows the order of bytes, found `the \
         bytes [07, 00, 00, 00]`"
    );
}

#[test]
fn elements_of_other_kinds_are_refused_with_the_remedy() {
    assert_eq!(
        v22("8 4 2 1 1 10 20 30 40", "8 11 2 1 1 1 2 3 4 5 6 7 8 9 10"),
        "mesh.msh, line 22: tetrahedra of higher order (Gmsh's element type 11), but moldwarp \
         computes with 4-node tetrahedra; take Mesh.ElementOrder and SetOrder out of the .geo and \
         mesh it again: `gmsh -3 -order 1 mesh.geo -o mesh.msh`"
    );
    assert!(v41("2 1 2 1\n", "2 1 9 1\n").contains("line 34: triangles of higher order"));
    assert_eq!(
        v41("3 1 4 1\n", "3 1 5 1\n"),
        "mesh.msh, line 36: hexahedra (Gmsh's element type 5), but moldwarp computes with \
         tetrahedra only; take Recombine out of the .geo, set Mesh.RecombineAll = 0, \
         Mesh.Recombine3DAll = 0 and Mesh.SubdivisionAlgorithm = 0, and mesh it again: `gmsh -3 \
         mesh.geo -o mesh.msh`"
    );
    for (kind, shape) in [(3, "quadrangles"), (6, "prisms"), (7, "pyramids")] {
        let message = v22("8 4 2", &format!("8 {kind} 2"));
        assert!(
            message.contains(&format!("line 22: {shape} (")),
            "{message}"
        );
    }
    assert_eq!(
        v22("8 4 2", "8 999 2"),
        "mesh.msh, line 22: Gmsh's element type 999 is not known; 3-node triangles (2) and 4-node \
         tetrahedra (4) are"
    );
}

#[test]
fn a_mesh_needs_tetrahedra_and_no_partitions() {
    assert_eq!(
        v22("8 4 2 1 1 10 20 30 40", "8 2 2 5 1 10 20 30"),
        "mesh.msh: the file has no tetrahedra; mesh the geometry in 3D: `gmsh -3 mesh.geo -o \
         mesh.msh`; or `revolve` it if it is the plane mesh of a meridian"
    );
    assert_eq!(
        v41(
            "$Nodes",
            "$PartitionedEntities\n$EndPartitionedEntities\n$Nodes"
        ),
        "mesh.msh, line 15: the mesh is partitioned; mesh it again without `-part`: `gmsh -3 \
         mesh.geo -o mesh.msh`"
    );
    assert_eq!(
        v22("$Nodes", "$ParametricNodes"),
        "mesh.msh, line 9: nodes with parameters in MSH 2.2 cannot be read; convert them: `gmsh \
         mesh.msh -save -format msh41 -o mesh-41.msh`"
    );
    let (start, elements) = V22.split_at(V22.find("$Elements").unwrap());
    assert_eq!(
        refusal(start),
        "mesh.msh: the file has no section `$Elements`; it is cut short or was saved before it was meshed: `gmsh -3 mesh.geo -o mesh.msh`"
    );
    let header = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    assert_eq!(
        refusal(header),
        "mesh.msh: the file has no section `$Nodes`; it is cut short or was saved before it was meshed: `gmsh -3 mesh.geo -o mesh.msh`"
    );
    assert_eq!(
        refusal(format!("{header}{elements}")),
        "mesh.msh, line 4: `$Elements` comes before `$Nodes`; Gmsh writes the nodes first"
    );
}

#[test]
fn a_tetrahedron_belongs_to_one_volume() {
    let names = "2\n3 1 \"soil\"\n2 5";
    let three = "3\n3 2 \"clay\"\n3 1 \"soil\"\n2 5";
    let expected = "element 8 is in two volume groups, `soil` and `clay`; take its volume out of \
                    one of the two Physical Volumes";
    for tag in [8, 9] {
        let text = V22
            .replace(names, three)
            .replace("$Elements\n4", "$Elements\n5")
            .replace(
                "20 30 40\n",
                &format!("20 30 40\n{tag} 4 2 2 1 20 10 40 30\n"),
            );
        assert_eq!(refusal(text), format!("mesh.msh: {expected}"));
    }
    let text = V41
        .replace(names, three)
        .replace("1 1 1 1 1 1 -1", "1 1 1 2 2 1 1 -1");
    assert_eq!(refusal(text), format!("mesh.msh, line 38: {expected}"));
}

#[test]
fn elements_and_names_are_there_once() {
    let again = |line: &str| {
        let text = V22.replace("$Elements\n4", "$Elements\n5");
        refusal(text.replace("20 30 40\n", &format!("20 30 40\n{line}\n")))
    };
    assert_eq!(
        again("9 4 2 1 1 20 10 40 30"),
        "mesh.msh: elements 8 and 9 have the same four nodes; if two volumes of the geometry \
         coincide, remove one"
    );
    assert_eq!(
        again("8 4 2 1 1 20 10 40 99"),
        "mesh.msh: two tetrahedra have the tag 8"
    );
    let text = V22
        .replace("2\n3 1 \"soil\"", "3\n3 2 \"soil\"\n3 1 \"soil\"")
        .replace("$Elements\n4", "$Elements\n5")
        .replace("20 30 40\n", "20 30 40\n9 4 2 2 1 10 20 30 99\n");
    assert_eq!(
        refusal(text),
        "mesh.msh: the physical volumes 1 and 2 are both called `soil`; rename one"
    );
}

#[test]
fn wrong_nodes_are_named_with_their_line() {
    assert_eq!(
        v22("30 0 1 0", "10 0 1 0"),
        "mesh.msh, line 14: two nodes have the tag 10"
    );
    assert_eq!(
        v22("30 0 1 0", "-30 0 1 0"),
        "mesh.msh, line 14: expected the tag of a node, 1 or more, found `-30`"
    );
    assert_eq!(
        v41("\n99\n", "\n0\n"),
        "mesh.msh, line 22: expected the tag of a node, 1 or more, found `0`"
    );
    for number in ["nan", "-inf"] {
        assert_eq!(
            v22("30 0 1 0", &format!("30 0 {number} 0")).to_lowercase(),
            format!("mesh.msh, line 14: expected a coordinate, a finite number, found `{number}`")
        );
    }
    assert_eq!(
        v22("30 0 1 0", "30 0 1"),
        "mesh.msh, line 14: expected a coordinate, found the end of the line"
    );
    assert_eq!(
        v22("30 0 1 0", "30 0 1 0 5"),
        "mesh.msh, line 14: expected the end of the line, found `5`"
    );
    assert_eq!(
        v22("30 0 1 0", "30 0 1,5 0"),
        "mesh.msh, line 14: expected a coordinate, found `1,5`"
    );
    assert_eq!(
        v22("1 1 10 20 30 40", "1 1 10 20 31 40"),
        "mesh.msh, line 22: element 8 names node 31, which the file does not have"
    );
}

#[test]
fn wrong_counts_are_found() {
    assert_eq!(
        v22("$Nodes\n5", "$Nodes\n4"),
        "mesh.msh, line 15: expected `$EndNodes`, found `20 1 0 0`"
    );
    assert_eq!(
        v22("$Nodes\n5", "$Nodes\n6"),
        "mesh.msh, line 16: expected the tag of a node, found `$EndNodes`"
    );
    assert_eq!(
        v22("$Nodes\n5", "$Nodes\n-5"),
        "mesh.msh, line 10: expected the number of nodes, found `-5`"
    );
    assert_eq!(
        v41("2 5 10 99", "2 6 10 99"),
        "mesh.msh, line 28: expected 1 more nodes, as the section's first line says, found its \
         last block at an end"
    );
    assert_eq!(
        v41("2 5 10 99", "2 4 10 99"),
        "mesh.msh, line 20: expected 3 nodes or fewer, which the section has left, found `4`"
    );
}

#[test]
fn names_of_groups_stand_in_quotes_and_in_utf8() {
    assert_eq!(
        v22("3 1 \"soil\"", "3 1 soil"),
        "mesh.msh, line 6: expected the name of a physical group in double quotes, as UTF-8, \
         found `soil`"
    );
    assert_eq!(
        v22("3 1 \"soil\"", "4 1 \"soil\""),
        "mesh.msh, line 6: expected a dimension from 0 to 3, found `4`"
    );
    let mut bytes = V22.as_bytes().to_vec();
    let at = bytes.windows(4).position(|w| w == b"soil").unwrap();
    bytes[at] = 0xf8;
    assert_eq!(
        refusal(bytes),
        "mesh.msh, line 6: expected the name of a physical group in double quotes, as UTF-8, \
         found `\"\u{fffd}oil\"`"
    );
}

#[test]
fn sections_end_as_they_begin() {
    assert_eq!(
        v22("$Nodes\n5", "$Novel\n5"),
        "mesh.msh, line 9: expected `$EndNovel` somewhere after `$Novel`, found none"
    );
    assert_eq!(
        v22("$EndPhysicalNames", "$EndPhysicalNames\nstray"),
        "mesh.msh, line 9: expected a section, `$Name`, found `stray`"
    );
}

#[test]
fn binary_faults_are_placed_by_their_byte() {
    let whole = write::v22(false);
    assert_eq!(
        refusal(&whole[..whole.len() - 140]),
        "mesh.msh, byte 271: the file claims 4 elements, but only 10 bytes follow; it may be cut \
         short: copy it again or mesh it again"
    );
    let at = whole.windows(10).position(|w| w == b"$Elements\n").unwrap() + 12;
    assert_eq!(
        refusal(&whole[..at + 34]),
        format!(
            "mesh.msh, byte {}: expected the length of a run of elements in 4 bytes, found the \
             end of the file after 2",
            at + 32
        )
    );
    let mut bytes = whole.clone();
    bytes[at] = 5;
    assert!(refusal(bytes).starts_with(&format!("mesh.msh, byte {at}: hexahedra (")));
    let mut bytes = whole;
    bytes[at + 4] = 9;
    assert_eq!(
        refusal(bytes),
        format!(
            "mesh.msh, byte {}: expected the length of a run of elements, 4 at most, found `9`",
            at + 4
        )
    );
}
