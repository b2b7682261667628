//! The reader of Gmsh files, from literals and from files that Gmsh wrote.

mod damage;
mod plane;
mod read;
mod refuse;
mod write;

use moldwarp_io::mesh::{MeshFile, parse_gmsh};
use std::path::Path;

/// Reads `bytes` as a file `mesh.msh`; an error comes as its message.
fn parse(bytes: impl AsRef<[u8]>) -> Result<MeshFile, String> {
    parse_gmsh(Path::new("mesh.msh"), bytes.as_ref()).map_err(|e| e.to_string())
}

/// A message without the folder of its file.
fn without_folder(message: &str, folder: &Path) -> String {
    message.replace(&format!("{}/", folder.display()), "")
}

fn refusal(bytes: impl AsRef<[u8]>) -> String {
    parse(bytes).expect_err("this file is to be refused")
}

/// A tetrahedron in volume 1 `soil` with its base in surface 5, under tags with gaps and out of
/// order; node 99 is of no use.
const V22: &str = "\
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
3 1 \"soil\"
2 5 \"the base\"
$EndPhysicalNames
$Nodes
5
40 0 0 1
10 0 0 0
99 7 7 7
30 0 1 0
20 1 0 0
$EndNodes
$Elements
4
1 15 2 0 1 10
2 1 2 0 1 10 20
3 2 2 5 1 10 30 20
8 4 2 1 1 10 20 30 40
$EndElements
";

/// The same as [`V22`].
const V41: &str = "\
$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
3 1 \"soil\"
2 5 \"the base\"
$EndPhysicalNames
$Entities
1 0 1 1
1 0 0 0 0
1 0 0 0 1 1 0 1 -5 0
1 0 0 0 1 1 1 1 1 1 -1
$EndEntities
$Nodes
2 5 10 99
0 1 0 1
40
0 0 1
2 1 1 4
10
99
30
20
0 0 0 0 0
7 7 7 0 0
0 1 0 0 1
1 0 0 1 0
$EndNodes
$Elements
3 3 1 8
0 1 15 1
1 10
2 1 2 1
3 10 30 20
3 1 4 1
8 10 20 30 40
$EndElements
";
