//! What is fuzzed: one function a target, which must neither panic nor take much memory, whatever the
//! bytes.
//!
//! Another one is a constant here and in [`ALL`], and a file in `fuzz_targets/`.

use miette::Diagnostic;
use moldwarp::Mesh;
use moldwarp::mesh::RawMesh;
use moldwarp_io::mesh::{check_overlap, explain_mesh_error, parse_gmsh, parse_plane_gmsh};
use moldwarp_io::output::container::seal;
use moldwarp_io::run::{RunOptions, read_checkpoint, run, verify};
use moldwarp_io::scene::{Dimension, SceneError, parse, parse_quantity};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

/// A reader to be fuzzed.
pub struct Target {
    pub name: &'static str,
    /// Reads the bytes; whether they are right.
    pub run: fn(&[u8]) -> bool,
    /// What to begin with.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Files are no longer than this, bytes.
    pub most: usize,
}

/// The reader of Gmsh's files, of solids and of meridians, and what becomes of the mesh.
pub const GMSH: Target = Target {
    name: "gmsh",
    run: gmsh,
    seeds: || [files("meshes"), files("meridians")].concat(),
    most: 20_000,
};

/// The reader of scenes, up to a simulation that could begin.
pub const SCENE: Target = Target {
    name: "scene",
    run: scene,
    seeds: || files("scenes"),
    most: 20_000,
};

/// The reader of numbers with units.
pub const QUANTITY: Target = Target {
    name: "quantity",
    run: quantity,
    seeds: quantities,
    most: 200,
};

/// The reader of checkpoints, up to a simulation that could go on. Their checksum is made right, so that
/// what comes after it is reached.
pub const CHECKPOINT: Target = Target {
    name: "checkpoint",
    run: checkpoint,
    seeds: checkpoints,
    most: 400_000,
};

pub const ALL: [&Target; 4] = [&GMSH, &SCENE, &QUANTITY, &CHECKPOINT];

/// The repository, in which the crate that includes this file is somewhere.
fn corpus() -> PathBuf {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let mut corpora = crates.map(|folder| folder.join("tests/bad"));
    let found = corpora.find(|corpus| corpus.join("scenes").is_dir());
    found.expect("this is built in the repository")
}

fn files(folder: &str) -> Vec<Vec<u8>> {
    let entries = fs::read_dir(corpus().join(folder)).expect("the corpus can be read");
    let mut paths: Vec<PathBuf> = entries.flatten().map(|e| e.path()).collect();
    // The order in which a system lists files is its own.
    paths.sort();
    let files = paths.iter().filter(|p| p.is_file());
    files.filter_map(|p| fs::read(p).ok()).collect()
}

fn gmsh(bytes: &[u8]) -> bool {
    let file = Path::new("fuzzed.msh");
    let solid = match parse_gmsh(file, bytes) {
        Ok(read) => whole(read.raw, &read.node_tags, &read.element_tags),
        Err(error) => !told(&error.to_string()),
    };
    let plane = match parse_plane_gmsh(file, bytes) {
        Ok(read) => {
            let revolved = read.plane.revolve(0.5, 2);
            let origins = revolved.node_origins.iter();
            let tags: Vec<u64> = origins.map(|&n| read.node_tags[n as usize]).collect();
            let elements: Vec<u64> = (1..=revolved.raw.tets.len() as u64).collect();
            whole(revolved.raw, &tags, &elements)
        }
        Err(error) => !told(&error.to_string()),
    };
    solid || plane
}

/// Whether it is a mesh to compute with; if not, why must be told in the file's tags.
fn whole(raw: RawMesh, node_tags: &[u64], element_tags: &[u64]) -> bool {
    match Mesh::new(raw) {
        Ok(mesh) => {
            let mut volumes = mesh.volumes.iter();
            assert!(volumes.all(|v| *v > 0.0 && v.is_finite()), "no volume");
            check_overlap(&mesh, element_tags).is_ok()
        }
        Err(error) => !told(&explain_mesh_error(&error, node_tags, element_tags)),
    }
}

/// Something was said, and not more than anyone would read.
fn told(message: &str) -> bool {
    assert!(!message.is_empty() && message.len() < 100_000, "{message}");
    true
}

/// Most elements of a scene that is set up.
const MOST_ELEMENTS: usize = 50;

fn scene(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return false;
    };
    if !is_small(text) {
        return false;
    }
    // Meshes and tables are found beside the scenes of the corpus.
    match parse(&corpus().join("scenes/fuzzed.toml"), text) {
        Ok(scene) if scene.plan.mesh.tets.len() > MOST_ELEMENTS => true,
        Ok(scene) => match verify(scene) {
            Ok(columns) => !columns.is_empty(),
            Err(error) => !told(&error.to_string()),
        },
        Err(error) => !shown(&error, text),
    }
}

/// A message whose places lie in the text.
fn shown(error: &SceneError, text: &str) -> bool {
    for label in error.labels().into_iter().flatten() {
        let end = label.offset() + label.len();
        assert!(
            text.get(label.offset()..end).is_some(),
            "{error}: {label:?} is no place in the text"
        );
    }
    told(&error.to_string())
}

/// Whether the scene's generated mesh is small: a box of millions of cells is right, but no case for
/// fuzzing.
fn is_small(text: &str) -> bool {
    fn product(value: &toml::Value) -> f64 {
        match value {
            toml::Value::Integer(n) => (*n as f64).abs().max(1.0),
            toml::Value::Array(list) => list.iter().map(product).product(),
            toml::Value::Table(table) => table.values().map(product).product(),
            _ => 1.0,
        }
    }
    let Ok(scene) = toml::from_str::<toml::Table>(text) else {
        return true;
    };
    scene.get("mesh").is_none_or(|mesh| product(mesh) < 1000.0)
}

/// What stands in quotes in the scenes of the corpus.
fn quantities() -> Vec<Vec<u8>> {
    let scenes = files("scenes");
    let texts = scenes.iter().filter_map(|f| std::str::from_utf8(f).ok());
    let quoted = texts.flat_map(|text| text.split('"').skip(1).step_by(2));
    let mut all: Vec<Vec<u8>> = quoted.map(|q| q.as_bytes().to_vec()).collect();
    let others = ["−1e−3 MPa", "kN·m^-3", "1/s", "5 mm²", "+.5 m", "1 kg·m/s²"];
    all.extend(others.map(|q| q.as_bytes().to_vec()));
    all.sort();
    all.dedup();
    all
}

fn quantity(bytes: &[u8]) -> bool {
    use Dimension::*;
    let Ok(text) = std::str::from_utf8(bytes) else {
        return false;
    };
    let all = [
        Number,
        Length,
        Time,
        Mass,
        Force,
        Stress,
        UnitWeight,
        Density,
        Velocity,
        Acceleration,
        Rate,
        Angle,
    ];
    let fits = all
        .into_iter()
        .filter(|&dimension| match parse_quantity(text, dimension) {
            Ok(value) => {
                assert!(value.is_finite(), "{text:?} is {value}");
                true
            }
            Err(error) => !(told(&error.to_string()) && told(&error.help())),
        });
    let fits = fits.count();
    assert!(fits <= 1, "{text:?} fits several dimensions");
    fits == 1
}

/// A small column with a probe and a load on an absorbing boundary.
const COLUMN: &str = r#"
version = 1
gravity = [0, 0, -10]
[mesh]
box = { size = [0.1, 0.1, 0.2], cells = [1, 1, 2] }
[materials.soil]
model = "mohr-coulomb"
young_modulus = "100 kPa"
poisson_ratio = 0.2
cohesion = "1 kPa"
friction_angle = "30 deg"
unit_weight = "18 kN/m3"
[bodies.layer]
volume = "box"
material = "soil"
[[boundaries]]
surface = "z-min"
kind = "absorbing"
[[loads]]
surface = "z-max"
body = "layer"
pressure = "1 kPa"
[probes.bottom]
surface = "z-min"
quantities = ["displacement"]
[[stages]]
name = "all"
steps = 10
[output]
frames = 0
"#;

/// Those of a run that is asked to stop at once.
fn checkpoints() -> Vec<Vec<u8>> {
    let out = std::env::temp_dir().join(format!("moldwarp-fuzz-{}", std::process::id()));
    let scene = parse(Path::new("column.toml"), COLUMN).expect("the scene is right");
    let options = RunOptions {
        out: Some(out.clone()),
        force: true,
        ..RunOptions::default()
    };
    options.interrupt.signal().store(15, Ordering::Relaxed);
    run(scene, &options, &mut ()).expect("the run can be made");
    let entries = fs::read_dir(out.join("checkpoints")).expect("the run leaves checkpoints");
    let mut paths: Vec<PathBuf> = entries.flatten().map(|e| e.path()).collect();
    paths.sort();
    let all = paths
        .iter()
        .filter_map(|path| fs::read(path).ok())
        .collect();
    let _ = fs::remove_dir_all(&out);
    all
}

fn checkpoint(bytes: &[u8]) -> bool {
    let mut bytes = bytes.to_vec();
    seal(&mut bytes);
    match read_checkpoint(bytes) {
        Ok(_) => true,
        Err(error) => !told(&error.to_string()),
    }
}
