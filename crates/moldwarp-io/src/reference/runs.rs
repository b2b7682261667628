//! Whether the page on the output names what a run writes: everything, and nothing else.

use super::PAGES;
use super::examples::{Folder, scenes};
use super::markdown::first_column;
use crate::output::{csv, vtu_read};
use crate::run::{RunOptions, run};
use moldwarp::plan::Quantity;
use std::path::Path;

/// The page's first scene, with everything in it that makes a run write more.
const EVERYTHING: &str = r#"
stages = [{ name = "few steps", steps = 2 }]
compare = [{ column = "bottom.displacement.z", file = "exact.csv" }]
[materials.soil]
model = "mohr-coulomb"
young_modulus = "100 kPa"
poisson_ratio = 0.25
cohesion = "1 kPa"
friction_angle = "30 deg"
unit_weight = "18 kN/m3"
[probes.bottom]
surface = "z-min"
quantities = ["displacement", "velocity", "acceleration", "position", "stress", "reaction"]
[probes.inside]
volume = "box"
quantities = ["volume"]
"#;

fn run_everything(folder: &Folder) {
    let (mut scene, _) = scenes().swap_remove(0);
    scene.extend(toml::from_str::<toml::Table>(EVERYTHING).unwrap());
    let options = RunOptions {
        out: Some(folder.out()),
        threads: 1,
        ..RunOptions::default()
    };
    run(folder.read(&scene).unwrap(), &options, &mut ()).unwrap();
}

fn sorted(mut names: Vec<String>) -> Vec<String> {
    names.sort();
    names
}

#[test]
fn a_runs_files_and_what_is_in_them_are_in_the_reference() {
    let folder = Folder::new();
    run_everything(&folder);
    let out = folder.out();
    let page = PAGES[1].text();
    let said = |heading: &str| sorted(first_column(&page, heading));

    assert_eq!(said("# The output"), sorted(files(&out)));
    assert_eq!(said("## Frames"), sorted(fields(&out)));
    assert_eq!(said("## Summary"), sorted(summary_keys(&out)));

    let mut columns = csv::read(&out.join("history.csv")).unwrap().names;
    let energies = columns
        .extract_if(.., |c| c.starts_with("energy."))
        .collect();
    assert_eq!(said("### Energies"), sorted(energies));
    let of_probes: Vec<String> = columns.extract_if(.., |c| c.contains('.')).collect();
    assert_eq!(first_column(&page, "## History"), columns);
    every_quantity_is_described(&of_probes);
}

/// What stands in the folder; of the frames the first ones.
fn files(out: &Path) -> Vec<String> {
    let names = |path: &Path| -> Vec<String> {
        let entries = std::fs::read_dir(path).unwrap();
        let names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
        names.collect()
    };
    let mut files = names(out);
    files.retain(|name| !["frames", "stages", "checkpoints"].contains(&&name[..]));
    // Not of a run that is over.
    assert_eq!(names(&out.join("checkpoints")), [""; 0]);
    files.extend([0, 1].map(|k| format!("checkpoints/{k}.checkpoint")));
    let stages = names(&out.join("stages")).into_iter();
    files.extend(stages.map(|name| format!("stages/{}", name.replace("few-steps", "STAGE"))));
    let frames = names(&out.join("frames")).into_iter();
    let first = frames.filter(|name| name.ends_with("_00000.vtu"));
    files.extend(first.map(|name| format!("frames/{name}")));
    files
}

/// Arrays of the particles' and of the mesh's frames.
fn fields(out: &Path) -> Vec<String> {
    let frame = |kind: &str| vtu_read::read(&out.join(format!("frames/{kind}_00000.vtu"))).unwrap();
    let fields = ["particles", "mesh"]
        .map(|kind| frame(kind).fields)
        .concat();
    fields.into_iter().map(|f| f.name).collect()
}

fn summary_keys(out: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(out.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    let keys = |value: &serde_json::Value| -> Vec<String> {
        value.as_object().unwrap().keys().cloned().collect()
    };
    let compared = keys(&summary["compare"][0]).into_iter();
    let projected = keys(&summary["projections"]).into_iter();
    let mut all = keys(&summary);
    all.extend(projected.map(|key| format!("projections.{key}")));
    all.extend(compared.map(|key| format!("compare[].{key}")));
    all
}

fn every_quantity_is_described(columns: &[String]) {
    let page = PAGES[0].text();
    let described = first_column(&page, "## Probes").into_iter();
    let described: Vec<String> = described
        .filter_map(|name| Some(name.strip_prefix('"')?.strip_suffix('"')?.to_owned()))
        .collect();
    assert_eq!(described, Quantity::ALL.map(|q| q.0));
    // The force of a contact needs a surface inside the mesh, penetration gravity: this scene has none.
    let left_out = ["contact", "penetration"];
    for name in described
        .into_iter()
        .filter(|name| !left_out.contains(&&name[..]))
    {
        let records = |c: &String| c.split('.').nth(1) == Some(&name);
        assert!(columns.iter().any(records), "{name}");
    }
}
