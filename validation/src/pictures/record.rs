//! `pictures.csv`: which scene made a picture, and at which commit.

use super::{Entry, Failure, file_and_sets};
use crate::made::commit;
use moldwarp_io::output::Hasher;
use moldwarp_io::output::csv::read_text;
use moldwarp_io::output::hash::scene_hash;
use moldwarp_io::scene;
use std::path::{Path, PathBuf};

const COLUMNS: [&str; 6] = [
    "picture",
    "scene",
    "kind",
    "fingerprint",
    "commit",
    "made by",
];

/// A row a picture and scene.
#[derive(Clone, Debug, Default)]
pub struct Record {
    pub rows: Vec<[String; COLUMNS.len()]>,
}

/// What tells whether a scene, as the list has it, is still the one that it was: `scene` and the fingerprint that
/// runs write into `summary.json`, or where its mesh is not in the repository `sources` and one of the texts
/// of the scene and of all geometries beside it.
///
/// # Errors
///
/// If the scene is wrong or there is none.
pub fn fingerprint(scene: &str) -> Result<(&'static str, String), Failure> {
    let (path, sets) = file_and_sets(scene);
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let folder = path.parent().unwrap_or(Path::new("."));
    let table: toml::Table = text.parse()?;
    let mesh = table
        .get("mesh")
        .and_then(|mesh| mesh.get("file"))
        .and_then(toml::Value::as_str);
    let set = sets.iter().find_map(|set| set.strip_prefix("mesh.file="));
    let mesh = set.or(mesh);
    // Fine meshes are made beside the scenes and not committed: whether one is there just now is no matter.
    if mesh.is_none_or(|mesh| committed(&folder.join(mesh))) {
        return Ok(("scene", scene_hash(&scene::load(&path, &sets)?.plan)));
    }
    let mut hasher = Hasher::new();
    hasher.text("scene", &text);
    sets.iter().for_each(|set| hasher.text("set", set));
    for geometry in geometries(folder)? {
        let name = geometry.file_name().unwrap_or_default().to_string_lossy();
        hasher.text(&name, &std::fs::read_to_string(&geometry)?);
    }
    Ok(("sources", hasher.finish()))
}

/// The names of meshes that .gitignore has are those of fine ones.
fn committed(mesh: &Path) -> bool {
    let name = mesh.file_name().unwrap_or_default();
    !["fine.msh", "medium.msh", "finest.msh", "blunt.msh"]
        .iter()
        .any(|fine| name == *fine)
}

fn geometries(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries: Result<Vec<_>, _> = std::fs::read_dir(folder)?.collect();
    let mut all: Vec<PathBuf> = entries?.into_iter().map(|entry| entry.path()).collect();
    all.retain(|path| path.extension().is_some_and(|e| e == "geo"));
    all.sort();
    Ok(all)
}

impl Record {
    fn path() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("pictures.csv")
    }

    /// Reads the record; an empty one if there is none.
    ///
    /// # Errors
    ///
    /// If it is no such table.
    pub fn read() -> Result<Record, Failure> {
        if !Record::path().exists() {
            return Ok(Record::default());
        }
        let table = read_text(&Record::path())?;
        if table.names != COLUMNS {
            return Err("pictures.csv has other columns".into());
        }
        let row = |row: Vec<String>| {
            row.try_into()
                .map_err(|_| "a row of pictures.csv is too short")
        };
        let rows: Result<_, _> = table.rows.into_iter().map(row).collect();
        Ok(Record { rows: rows? })
    }

    /// Notes that an entry's pictures were made now.
    ///
    /// # Errors
    ///
    /// If a scene of it is wrong.
    pub fn replace(&mut self, entry: &Entry) -> Result<(), Failure> {
        self.rows.retain(|row| !entry.files.contains(&row[0]));
        let commit = commit();
        for file in &entry.files {
            for scene in &entry.scenes {
                let (kind, fingerprint) = fingerprint(scene)?;
                let row = [file, scene, kind, &fingerprint, &commit, &entry.command()];
                self.rows.push(row.map(str::to_owned));
            }
        }
        self.rows.sort();
        Ok(())
    }

    /// # Errors
    ///
    /// If it cannot be written.
    pub fn write(&self) -> Result<(), Failure> {
        let cell = |text: &String| match text.contains([',', '"']) {
            true => format!("\"{}\"", text.replace('"', "\"\"")),
            false => text.clone(),
        };
        let mut text = COLUMNS.join(",") + "\n";
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(cell).collect();
            text += &(cells.join(",") + "\n");
        }
        Ok(std::fs::write(Record::path(), text)?)
    }
}
