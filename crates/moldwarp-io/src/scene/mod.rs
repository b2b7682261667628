//! From scene.toml to a checked plan.
//!
//! Two steps: `raw` is what the user wrote, each value with its place in the text; the other
//! files check one part of it each and turn it into the solver's [`Plan`] in SI units. After
//! that nothing can be a slip of the user.

mod amount;
mod bodies;
mod boundaries;
mod contacts;
mod cylinder;
mod document;
mod earlier;
mod error;
mod functions;
mod given;
mod initial_stress;
mod kept;
mod loads;
mod materials;
mod mesh;
mod mesh_motion;
mod numerics;
mod origin;
mod outline;
mod output;
mod overrides;
mod presence;
mod probes;
mod quantity;
mod raw;
mod stages;
pub(crate) mod suggest;
mod surfaces;
mod symmetry;
mod syntax;
#[cfg(test)]
mod tests;
mod units;
mod values;

pub use earlier::{Earlier, inherit};
pub(crate) use error::Fault;
pub use error::SceneError;
pub use given::Given;
pub(crate) use kept::{Kept, check_end, kept};
pub(crate) use origin::Origin;
pub(crate) use outline::{Outline, Part};
pub use output::{Compare, Every, OutputSettings};
pub(crate) use overrides::{keys, no_path, value};
pub use quantity::{Dimension, QuantityError, parse as parse_quantity};

#[cfg(test)]
pub(crate) use quantity::dimensions;

use moldwarp::{Mesh, Particles, Plan};
use presence::Presence;
use raw::RawScene;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A scene, read and checked.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What is computed, in SI units.
    pub plan: Plan,
    /// When results are written.
    pub output: OutputSettings,
    /// What the results are compared with.
    pub compare: Vec<Compare>,
    /// A short name: that of the scene's folder, with the file's if it is not scene.toml.
    pub case: String,
    /// Where the scene is; its paths are relative to this.
    pub folder: PathBuf,
    /// The TOML as run, with everything that was set.
    pub text: String,
    /// What the user should know though it is no error.
    pub notes: Vec<String>,
    /// The mesh file's tags of the elements, in their order; none if the mesh was generated or kept.
    pub element_tags: Vec<u64>,
    /// The earlier run from which bodies have their particles, if there is one.
    pub earlier: Option<Earlier>,
    /// How far ahead of a moving mesh [`check`](crate::check::check) looks, m, if it is said.
    pub travel: Option<f64>,
    /// Wall time that reading took, mesh included.
    pub reading: Duration,
    /// For messages that come up later.
    pub(crate) origin: Origin,
}

/// Reads a scene from a file, or from scene.toml in a folder.
///
/// `sets` are changes `PATH=VALUE` to the text, for example `numerics.courant=0.4`; VALUE is
/// TOML, else a text. Items of lists are given by number (from 0) or `name`.
///
/// # Errors
///
/// Whatever would keep the plan from being computed as written: an unreadable file, unknown
/// keys and names, wrong units, values out of range, keys that exclude each other, a mesh that
/// does not fit.
pub fn load(path: &Path, sets: &[String]) -> Result<Scene, SceneError> {
    load_varied(path, sets, &[])
}

/// The same with one value of each `--vary PATH=…` of a sweep, `PATH=VALUE`, on top.
///
/// # Errors
///
/// As for [`load`]; messages name `--vary`.
pub fn load_varied(path: &Path, sets: &[String], varied: &[String]) -> Result<Scene, SceneError> {
    let file = match path.is_dir() {
        true => path.join("scene.toml"),
        false => path.to_owned(),
    };
    let mut name = file.display().to_string();
    if file.is_file() && file.extension().is_some_and(|e| e == "msh" || e == "geo") {
        return Err(not_a_scene(&file));
    }
    let original = regular_bytes(&file).map_err(|e| unreadable(&name, path, &e))?;
    let original = String::from_utf8(original).map_err(|e| no_text(&name, &e))?;
    let (text, overrides) = overrides::apply(&original, sets, varied)
        .map_err(|fault| fault.in_file(&name, &original))?;
    name += match (sets.is_empty(), varied.is_empty()) {
        (true, true) => "",
        (false, true) => " with --set",
        (true, false) => " with --vary",
        (false, false) => " with --set and --vary",
    };
    read(&file, name, &text, overrides, &Given::default())
}

/// Reads a scene from memory; `file` is its name, and paths are relative to its folder.
///
/// # Errors
///
/// As for [`load`].
pub fn parse(file: &Path, text: &str) -> Result<Scene, SceneError> {
    parse_with(file, text, &[], &Given::default())
}

/// The same, with changes `sets` as for [`load`], of a text to which a program gives something.
///
/// # Errors
///
/// As for [`load`].
pub fn parse_with(
    file: &Path,
    text: &str,
    sets: &[String],
    given: &Given,
) -> Result<Scene, SceneError> {
    let mut name = file.display().to_string();
    let (text, overrides) =
        overrides::apply(text, sets, &[]).map_err(|fault| fault.in_file(&name, text))?;
    if !sets.is_empty() {
        name += " with --set";
    }
    read(file, name, &text, overrides, given)
}

fn read(
    file: &Path,
    name: String,
    text: &str,
    overrides: Vec<overrides::Override>,
    given: &Given,
) -> Result<Scene, SceneError> {
    let start = Instant::now();
    let folder = match file.parent() {
        Some(parent) if parent != Path::new("") => parent.to_owned(),
        _ => PathBuf::from("."),
    };
    let read =
        syntax::parse(text).and_then(|raw| check(&raw, case(file), folder, text, (given, None)));
    match read {
        Ok(mut scene) => {
            scene.origin.name = name;
            scene.origin.overrides = overrides;
            scene.reading = start.elapsed();
            Ok(scene)
        }
        Err(fault) => Err(overrides::blame(fault, text, &overrides).in_file(&name, text)),
    }
}

/// A regular file; a pipe or a device may have no end.
fn regular_bytes(file: &Path) -> std::io::Result<Vec<u8>> {
    match std::fs::metadata(file)?.is_file() {
        true => std::fs::read(file),
        false => Err(std::io::Error::other("it is not a regular file")),
    }
}

fn no_text(name: &str, error: &std::string::FromUtf8Error) -> SceneError {
    let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
    let line = 1 + good.iter().filter(|&&b| b == b'\n').count();
    Fault::new(format!(
        "the scene `{name}` is not in UTF-8, first in line {line}"
    ))
    .help(format!("save it as UTF-8 in an editor; {WHAT_A_SCENE_IS}"))
    .without_file()
}

const WHAT_A_SCENE_IS: &str = "a scene is a TOML file, or a folder that holds scene.toml";

fn not_a_scene(file: &Path) -> SceneError {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let what = match file.extension() {
        Some(e) if e == "geo" => "Gmsh geometry",
        _ => "Gmsh mesh",
    };
    let mesh = Path::new(&*name).with_extension("msh");
    Fault::new(format!("`{}` is a {what}, not a scene", file.display()))
        .help(format!(
            "a scene names its mesh, as with `file = \"{}\"` under `[mesh]`; {}",
            mesh.display(),
            syntax::BEGIN
        ))
        .without_file()
}

fn unreadable(name: &str, path: &Path, error: &std::io::Error) -> SceneError {
    let fault = match error.kind() {
        std::io::ErrorKind::NotFound if path.is_dir() => {
            Fault::new(format!("there is no scene in `{}`", path.display()))
                .help("a scene's folder holds a file scene.toml; name another file directly")
        }
        std::io::ErrorKind::NotFound => {
            Fault::new(format!("there is no scene `{name}`")).help(WHAT_A_SCENE_IS)
        }
        _ => {
            Fault::new(format!("the scene `{name}` cannot be read: {error}")).help(WHAT_A_SCENE_IS)
        }
    };
    fault.without_file()
}

/// `kept` is the mesh, if it is not to be read or made but has been before; then no other file is
/// looked for either.
fn check(
    raw: &RawScene,
    case: String,
    folder: PathBuf,
    text: &str,
    (given, kept): (&Given, Option<Mesh>),
) -> Result<Scene, Fault> {
    let mut notes = Vec::new();
    let files = kept.is_none().then_some(&*folder);
    let gravity = values::vector("gravity", &raw.gravity, Dimension::Acceleration)?;
    let numerics = numerics::numerics(&raw.numerics)?;
    let output = output::output(&raw.output)?;
    let materials = materials::materials(&raw.materials, given)?;
    let (mesh, element_tags) = match kept {
        Some(mesh) => (mesh, Vec::new()),
        None => mesh::mesh(&raw.mesh, (&folder, given), &mut notes)?,
    };
    let symmetry = symmetry::symmetry(raw, &mesh, gravity, &mut notes)?;
    let bodies = bodies::bodies(&raw.bodies, &mesh, &materials)?;
    let motion = raw.mesh_motion.as_ref();
    let mesh_motion = mesh_motion::mesh_motion(motion, &mesh, &bodies, gravity)?;
    let boundaries = boundaries::boundaries(&raw.boundaries, &mesh)?;
    let loads = loads::loads(&raw.loads, &mesh, symmetry.as_ref(), &bodies)?;
    let probes = probes::probes(
        &raw.probes,
        (&mesh, gravity),
        &bodies,
        &boundaries,
        &mut notes,
    )?;
    let named = stages::Named {
        bodies: &bodies,
        materials: &materials,
        boundaries: &boundaries,
        loads: &loads,
    };
    let presence = Presence::new(&raw.stages, &bodies)?;
    presence.check_volumes(&raw.bodies.0)?;
    presence.check_k0(&raw.bodies.0)?;
    let stages = stages::stages(&raw.stages, &named, &presence)?;
    presence.check_loads(&raw.loads, (&loads, &stages))?;
    let contacts = contacts::contacts(&raw.contacts, &bodies, (&materials, &stages))?;
    presence.check_contacts(&raw.contacts, &contacts)?;
    notes.extend(presence.notes());
    let raw_bodies = raw.bodies.0.iter().map(|b| &b.1);
    let initial_stress = initial_stress::initial_stress(raw.initial_stress.as_ref(), raw_bodies)?;
    let compare = output::compare(&raw.compare, (&probes, &contacts), files)?;
    for (m, material) in materials.iter().enumerate() {
        let later = stages.iter().flat_map(|s| &s.materials).any(|c| c.1 == m);
        if !later && !bodies.iter().any(|b| b.material == m) {
            notes.push(format!("no body is made of material `{}`", material.name));
        }
    }
    let surfaces = raw
        .contacts
        .iter()
        .zip(&contacts)
        .filter_map(|(raw, contact)| {
            let place = values::span(&raw.get_ref().surface)?;
            Some((contact.name.clone(), place))
        });
    let surfaces = surfaces.collect();
    Ok(Scene {
        reading: Duration::ZERO,
        plan: Plan {
            title: raw.title.clone().unwrap_or_else(|| case.clone()),
            gravity,
            mesh,
            symmetry,
            materials,
            bodies,
            boundaries,
            loads,
            contacts,
            probes,
            initial_stress,
            inherited: Particles::default(),
            mesh_motion,
            numerics,
            stages,
        },
        output,
        compare,
        case,
        folder,
        text: text.to_owned(),
        notes,
        element_tags,
        earlier: None,
        travel: mesh_motion::travel(motion)?,
        origin: Origin {
            time_step: values::span(&raw.numerics.time_step),
            initial_stress: values::span(&raw.initial_stress),
            mesh_motion: values::span(&raw.mesh_motion),
            bodies: (raw.bodies.0.iter())
                .map(|(name, _)| (name.get_ref().clone(), name.span()))
                .collect(),
            probes: (raw.probes.0.iter())
                .map(|(name, _)| (name.get_ref().clone(), name.span()))
                .collect(),
            surfaces,
            ..Origin::default()
        },
    })
}

/// `slope` for slope/scene.toml, `slope-steep` for slope/steep.toml.
fn case(file: &Path) -> String {
    let absolute = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    let real = absolute.canonicalize().unwrap_or(absolute);
    let folder = real.parent().and_then(Path::file_name);
    let folder = folder.map(|f| f.to_string_lossy().into_owned());
    let stem = file.file_stem().map(|s| s.to_string_lossy().into_owned());
    match (folder, stem.as_deref()) {
        (Some(folder), Some("scene") | None) => folder,
        (Some(folder), Some(stem)) => format!("{folder}-{stem}"),
        (None, stem) => stem.unwrap_or("scene").to_owned(),
    }
}
