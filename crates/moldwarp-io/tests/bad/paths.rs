//! Paths in a scene are relative to its folder, wherever the command is called.

use crate::cases;
use moldwarp_io::scene::load;
use std::path::Path;

#[test]
fn paths_are_relative_to_the_scenes_folder() {
    cases::all(); // sets the current folder, in which neither file is
    let scene = load(Path::new("scenes/right-reference.toml"), &[]).unwrap();
    assert_eq!(scene.folder, Path::new("scenes"));
    assert_eq!(scene.compare[0].file, Path::new("scenes/data/right.csv"));
    assert!(!Path::new("data/right.csv").exists());
    assert_eq!(scene.plan.mesh.tets.len(), 1, "that of scenes/data/one.msh");
}
