//! The cases: which files there are, and what the readers say of them.

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme};
use moldwarp_io::check::check;
use moldwarp_io::run::RunError;
use moldwarp_io::scene::{Scene, SceneError, load, parse};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A file and what is said of it.
pub struct Case {
    /// The folder it is in.
    pub kind: &'static str,
    /// Its name.
    pub name: String,
    /// What a user sees.
    pub said: String,
    /// None if it can be computed.
    pub error: Option<RunError>,
}

/// The corpus. Paths in messages are as if a user stood in this folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/bad")
}

/// All cases, read once.
pub fn all() -> &'static [Case] {
    static CASES: OnceLock<Vec<Case>> = OnceLock::new();
    CASES.get_or_init(|| {
        std::env::set_current_dir(root()).unwrap();
        let scenes = names("scenes").into_iter().map(scene);
        let meshes = names("meshes").into_iter().map(|n| mesh("meshes", n, ""));
        let revolve = "revolve = { angle = \"20 deg\" }";
        let meridians = names("meridians").into_iter();
        let meridians = meridians.map(|n| mesh("meridians", n, revolve));
        let mut all: Vec<Case> = scenes.chain(meshes).chain(meridians).collect();
        all.push(scene("there-is-no-such.toml".to_owned()));
        all
    })
}

/// What is in a folder, but the snapshots and what the cases name.
fn names(folder: &str) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.filter(|n| n != "snapshots" && n != "data").collect();
    names.sort();
    names
}

/// A scene, with the `--set` of its first lines, `# --set PATH=VALUE`.
fn scene(name: String) -> Case {
    let path = Path::new("scenes").join(&name);
    let text = fs::read(&path).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let sets = text.lines().map_while(|l| l.strip_prefix("# --set "));
    let sets: Vec<String> = sets.map(str::to_owned).collect();
    case("scenes", name, load(&path, &sets))
}

/// A mesh file in a scene that takes any mesh.
fn mesh(kind: &'static str, name: String, revolve: &str) -> Case {
    let text = format!(
        r#"version = 1
gravity = [0, 0, 0]
[mesh]
file = "{name}"
{revolve}
[materials.soil]
model = "linear-elastic"
young_modulus = "100 kPa"
poisson_ratio = 0.3
density = "2 t/m3"
[bodies.all]
region = {{ kind = "half-space", point = [0, 0, "1000 m"], normal = [0, 0, 1] }}
material = "soil"
[[stages]]
name = "rest"
steps = 1
"#
    );
    let file = Path::new(kind).join("scene.toml");
    case(kind, name, parse(&file, &text))
}

fn case(kind: &'static str, name: String, read: Result<Scene, SceneError>) -> Case {
    let checked = read.map_err(RunError::from).and_then(check);
    let (said, error) = match checked {
        Ok(forecast) => {
            let notes: String = forecast
                .notes
                .iter()
                .map(|n| format!("\nnote: {n}"))
                .collect();
            let stopped = forecast.stopped.map(|s| format!("\nstopped: {s}"));
            let whole = format!("it can be computed{notes}{}", stopped.unwrap_or_default());
            (whole, None)
        }
        Err(error) => (rendered(&error), Some(error)),
    };
    Case {
        kind,
        name,
        said,
        error,
    }
}

/// Without colour, in a terminal of 90 columns.
fn rendered(error: &dyn Diagnostic) -> String {
    let mut text = String::new();
    GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor())
        .with_width(90)
        .render_report(&mut text, error)
        .unwrap();
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    with_short_numbers(&lines.join("\n"))
}

/// Decimals behind the fourth are left out: their last may differ from one processor to another.
fn with_short_numbers(text: &str) -> String {
    let mut short = String::new();
    let mut decimals = None;
    for c in text.chars() {
        decimals = match (c, decimals) {
            ('.', _) => Some(0),
            ('0'..='9', Some(n)) => Some(n + 1),
            _ => None,
        };
        if decimals.is_none_or(|n| n <= 4) {
            short.push(c);
        }
    }
    short
}
