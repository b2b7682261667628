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
mod initial_stress;
mod loads;
mod materials;
mod mesh;
mod mesh_motion;
mod numerics;
mod output;
mod overrides;
mod presence;
mod probes;
mod quantity;
mod raw;
mod stages;
mod suggest;
mod surfaces;
mod symmetry;
mod syntax;
#[cfg(test)]
mod tests;
mod units;
mod unsupported;
mod values;

pub use earlier::{Earlier, inherit};
pub(crate) use error::Fault;
pub use error::SceneError;
pub use output::{Compare, Every, OutputSettings};
pub(crate) use overrides::{keys, no_path, value};

#[cfg(test)]
pub(crate) use {quantity::dimensions, unsupported::later};

use moldwarp::particles::SeedingError;
use moldwarp::step::TimeStepError;
use moldwarp::{Particles, Plan, SetupError};
use presence::Presence;
use quantity::Dimension;
use raw::RawScene;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A scene, read and checked.
#[derive(Debug)]
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
    /// The mesh file's tags of the elements, in their order; none if the mesh was generated.
    pub element_tags: Vec<u64>,
    /// The earlier run from which bodies have their particles, if there is one.
    pub earlier: Option<Earlier>,
    /// How far ahead of a moving mesh [`check`](crate::check::check) looks, m, if it is said.
    pub travel: Option<f64>,
    /// For messages that come up later.
    pub(crate) origin: Origin,
}

/// Where a scene came from.
#[derive(Debug, Default)]
pub(crate) struct Origin {
    /// Its name in messages.
    name: String,
    overrides: Vec<overrides::Override>,
    time_step: Option<Range<usize>>,
    initial_stress: Option<Range<usize>>,
    mesh_motion: Option<Range<usize>>,
    /// Names of bodies and where they stand.
    bodies: Vec<(String, Range<usize>)>,
    /// The same of probes.
    probes: Vec<(String, Range<usize>)>,
    /// Names of contacts and where their `surface` stands.
    surfaces: Vec<(String, Range<usize>)>,
}

impl Origin {
    /// What the solver found when it set up the scene, shown in the scene's `text` where it has a
    /// place there.
    pub(crate) fn explain(&self, error: &SetupError, text: &str) -> SceneError {
        let fault = match (error, &self.time_step) {
            (SetupError::TimeStep(TimeStepError::AboveStable { .. }), Some(place)) => {
                above_stable(error, place)
            }
            (SetupError::InitialStress(error), _) => {
                initial_stress::explain(error, self.initial_stress.clone().unwrap_or_default())
            }
            (SetupError::Seeding(SeedingError::Overlap { first, second, .. }), _) => {
                self.overlap(first, second)
            }
            (SetupError::Motion(error), _) => mesh_motion::explain(error, self.mesh_motion.clone()),
            (SetupError::Inherited(error), _) => earlier::explain(error),
            (SetupError::Contact(error), _) => contacts::explain(error, &self.surfaces)
                .unwrap_or_else(|| Fault::new(error.to_string())),
            (SetupError::NoInitialStress { body, .. }, _) => {
                Fault::new(error.to_string()).help(format!(
                    "give `{body}` its `k0` and the scene [initial_stress], or the load a pressure"
                ))
            }
            (SetupError::ProbeOfChange { probe, .. } | SetupError::ProbeOfNothing { probe }, _) => {
                self.lost(error, probe)
            }
            (SetupError::NoContact { probe }, _) => {
                let fault = Fault::new(error.to_string()).help(
                    "name a surface of the first body of an aligned contact; the whole force is in the \
                     columns contact.<name>",
                );
                let places = self.probes.iter().filter(|p| p.0 == *probe);
                places.fold(fault, |fault, (_, place)| {
                    fault.at(place.clone(), "this probe")
                })
            }
            _ => Fault::new(error.to_string()),
        };
        overrides::blame(fault, text, &self.overrides).in_file(&self.name, text)
    }

    /// A probe without its particles.
    fn lost(&self, error: &SetupError, probe: &str) -> Fault {
        let text = error.to_string();
        let problem = text.split_once(": ").map_or(&*text, |parts| parts.0);
        let fault = Fault::new(problem).help(
            "put the probe where a body is in all stages, or on a surface with a boundary, whose nodes \
             stay",
        );
        let places = self.probes.iter().filter(|p| p.0 == probe);
        places.fold(fault, |fault, (_, place)| {
            fault.at(place.clone(), "has nothing to look at in some stage")
        })
    }

    fn overlap(&self, first: &str, second: &str) -> Fault {
        let fault = Fault::new(format!("bodies `{first}` and `{second}` overlap"))
            .help("a place can hold one body only: shrink or move the region of one of them");
        let places = self.bodies.iter().filter(|b| b.0 == first || b.0 == second);
        places.fold(fault, |fault, (_, place)| {
            fault.at(place.clone(), "shares elements with the other")
        })
    }
}

fn above_stable(error: &SetupError, place: &Range<usize>) -> Fault {
    let text = error.to_string();
    let problem = text.split_once(": ").map_or(&*text, |parts| parts.0);
    Fault::new(problem)
        .at(place.clone(), "above the stable step")
        .help(
            "leave `time_step` out, and the step follows the stable one; `max_time_step` only \
             bounds it; a forced step has to stay below the stable one, which shrinks as elements \
             are compressed",
        )
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
    let original = std::fs::read_to_string(&file).map_err(|e| unreadable(&name, path, &e))?;
    let (text, overrides) = overrides::apply(&original, sets, varied)
        .map_err(|fault| fault.in_file(&name, &original))?;
    name += match (sets.is_empty(), varied.is_empty()) {
        (true, true) => "",
        (false, true) => " with --set",
        (true, false) => " with --vary",
        (false, false) => " with --set and --vary",
    };
    let folder = match file.parent() {
        Some(parent) if parent != Path::new("") => parent.to_owned(),
        _ => PathBuf::from("."),
    };
    let read = syntax::parse(&text).and_then(|raw| check(&raw, &file, folder, &text));
    match read {
        Ok(mut scene) => {
            scene.origin.name = name;
            scene.origin.overrides = overrides;
            Ok(scene)
        }
        Err(fault) => Err(overrides::blame(fault, &text, &overrides).in_file(&name, &text)),
    }
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

fn check(raw: &RawScene, file: &Path, folder: PathBuf, text: &str) -> Result<Scene, Fault> {
    let mut notes = Vec::new();
    let case = case(file);
    let gravity = values::vector("gravity", &raw.gravity, Dimension::Acceleration)?;
    let numerics = numerics::numerics(&raw.numerics)?;
    let output = output::output(&raw.output)?;
    let materials = materials::materials(&raw.materials)?;
    let (mesh, element_tags) = mesh::mesh(&raw.mesh, &folder, &mut notes)?;
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
    let compare = output::compare(&raw.compare, (&probes, &contacts), &folder)?;
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
