//! Runs that begin with the ground as an earlier run left it.

mod common;

use common::{Bench, COLUMN};
use moldwarp_io::output::vtu_read::{self, Frame};
use std::path::Path;

/// The loading, and then rest.
const TWO_STAGES: &str = "duration = \"0.05 s\"\n\n[[stages]]\nname = \"at rest / 2\"\n\
                          reset = [\"displacement\"]\nsteps = 3";

/// A bench with a run in `out/first`: stages `loading` and `at rest / 2`.
fn bench() -> Bench {
    let bench = Bench::with(&COLUMN.replace("duration = \"0.2 s\"", TWO_STAGES));
    bench.done(&["run", "column", "--out", "out/first"]);
    bench
}

fn frame(bench: &Bench, name: &str) -> Frame {
    vtu_read::read(&bench.path(name)).unwrap()
}

/// What a command says that is refused; nothing may have been written.
fn refused(bench: &Bench, title: &str, args: &[&str]) -> String {
    let before = bench.files();
    let said = bench.fails(2, args);
    assert_eq!(bench.files(), before, "{title}: files were written");
    assert!(!said.contains(bench.path("").to_str().unwrap()), "{said}");
    let lines: Vec<&str> = said.trim_end().lines().map(str::trim_end).collect();
    format!("## {title}\n{}\n", lines.join("\n"))
}

/// Values of a field by particle, particles by id.
fn by_id(frame: &Frame, name: &str) -> Vec<u64> {
    let field = frame.field(name).unwrap();
    let ids = &frame.field("id").unwrap().values;
    let mut order: Vec<usize> = (0..ids.len()).collect();
    order.sort_by(|&a, &b| ids[a].total_cmp(&ids[b]));
    let n = field.components;
    let values = order
        .iter()
        .flat_map(|&p| &field.values[n * p..n * (p + 1)]);
    values.map(|v| v.to_bits()).collect()
}

/// The first frame of the second run is the end of the first one's stage, bit for bit; velocities and
/// displacements are 0. So is the stage's file beside a frame of that time.
#[test]
fn a_run_begins_as_the_stage_ended() {
    let bench = bench();
    let left = frame(&bench, "out/first/stages/00_loading.vtu");
    assert_eq!(left.texts("stage").unwrap(), ["loading"]);
    assert_eq!(left.texts("bodies").unwrap(), ["layer"]);
    // The next stage resets displacements; the file is from before.
    let displacement = &left.field("displacement").unwrap().values;
    assert!(displacement.iter().any(|&u| u != 0.0));
    assert!(bench.path("out/first/stages/01_at-rest-2.vtu").exists());

    let args = [
        "run",
        "column",
        "--from",
        "out/first@loading",
        "--out",
        "out/second",
    ];
    let output = bench.moldwarp(&args);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    let note = "at the start `layer` as at the end of out/first@loading";
    assert!(said.contains(note), "{said}");
    assert!(bench.read("out/second/run.log").contains(note));
    assert_eq!(bench.summary("out/second")["from"], "out/first@loading");
    assert_eq!(bench.summary("out/first")["from"], serde_json::Value::Null);
    let hash = |out: &str| bench.summary(out)["scene_hash"].clone();
    assert_ne!(hash("out/first"), hash("out/second"));

    let begun = frame(&bench, "out/second/frames/particles_00000.vtu");
    let positions = |frame: &Frame| {
        let ids = &frame.field("id").unwrap().values;
        let mut x: Vec<_> = ids.iter().zip(&frame.points).collect();
        x.sort_by(|a, b| a.0.total_cmp(b.0));
        x.into_iter()
            .map(|x| x.1.map(f64::to_bits))
            .collect::<Vec<_>>()
    };
    assert_eq!(positions(&begun), positions(&left));
    for name in ["stress", "density", "body"] {
        assert_eq!(by_id(&begun, name), by_id(&left, name), "{name}");
    }
    assert!(by_id(&begun, "displacement").iter().all(|&u| u == 0));
}

/// Soil that yields under its load: the plastic strain goes along, by its name.
#[test]
fn state_variables_survive() {
    let soil = "model = \"mohr-coulomb\"\ncohesion = \"0.2 kPa\"\nfriction_angle = \"10 deg\"";
    let scene = COLUMN.replace("model = \"linear-elastic\"", soil);
    let scene = scene.replace("\"0.2 s\"", "\"0.05 s\"");
    let bench = Bench::with(&scene);
    bench.done(&["run", "column", "--out", "out/first"]);
    let left = frame(&bench, "out/first/stages/00_loading.vtu");
    let variables = left.texts("state_variables").unwrap()[0].clone();
    let yielded = &left.field("plastic_strain").unwrap().values;
    assert!(yielded.iter().any(|&e| e > 0.0), "it has to yield");

    bench.done(&[
        "run",
        "column",
        "--from",
        "out/first@loading",
        "--out",
        "out/second",
    ]);
    let begun = frame(&bench, "out/second/frames/particles_00000.vtu");
    for name in variables.split(',') {
        assert_eq!(by_id(&begun, name), by_id(&left, name), "{name}");
    }

    // From a material without such variables they begin at 0, and it is said.
    bench.write("elastic/scene.toml", COLUMN);
    bench.done(&["run", "elastic", "--out", "out/elastic"]);
    let output = bench.moldwarp(&["check", "column", "--from", "out/elastic@loading"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.contains("`layer` begins with plastic_strain 0"),
        "{said}"
    );
}

#[test]
fn bodies_go_by_their_names() {
    let bench = bench();
    let two = COLUMN.replace(
        "[bodies.layer]\nvolume = \"box\"",
        "[bodies.layer]\nregion = { min = [0, 0, 0], max = [0.1, 0.1, 0.3] }",
    );
    let upper = "[bodies.upper]\nregion = { min = [0, 0, 0.3], max = [0.1, 0.1, 0.5] }\n\
                 material = \"soil\"\n\n[[boundaries]]\nname = \"sides\"";
    let two = two.replace("[[boundaries]]\nname = \"sides\"", upper);
    let two = two.replace("body = \"layer\"", "body = \"upper\"");
    bench.write("two/scene.toml", &two);
    bench.done(&["run", "two", "--out", "out/two"]);
    // The upper body is not in the scene: it has been dug out.
    let dug = two.replace(upper, "[[boundaries]]\nname = \"sides\"");
    let (before, after) = dug.split_once("[[loads]]").unwrap();
    let after = after.split_once("[probes").unwrap().1;
    bench.write("dug/scene.toml", &format!("{before}[probes{after}"));
    let output = bench.moldwarp(&["check", "dug", "--from", "out/two@loading"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.contains("body `upper` of the earlier run is left out"),
        "{said}"
    );
    assert!(
        said.contains("body        `layer` of `soil`: 72 particles"),
        "{said}"
    );
}

#[test]
fn a_stopped_run_has_the_stages_it_completed_and_a_replaced_one_no_others() {
    let bench = bench();
    let launched = format!("{TWO_STAGES}\ninitial_velocity.layer = [0, 0, 9]");
    let launched = launched.replace("steps = 3", "duration = \"1 s\"");
    bench.write(
        "column/scene.toml",
        &COLUMN.replace("duration = \"0.2 s\"", &launched),
    );
    bench.fails(3, &["run", "column", "--out", "out/first"]);
    let stages = std::fs::read_dir(bench.path("out/first/stages")).unwrap();
    let names: Vec<_> = stages.map(|e| e.unwrap().file_name()).collect();
    assert_eq!(names, ["00_loading.vtu"]);
    insta::assert_snapshot!(refused(
        &bench,
        "a stage that was not completed",
        &["run", "column", "--from", "out/first@at rest / 2"]
    ));
}

#[test]
fn messages() {
    let bench = bench();
    bench.write("thesis/chapter.tex", "words");
    let from = |title: &str, from: &str, more: &[&str]| {
        let args = [&["run", "column", "--from", from], more].concat();
        refused(&bench, title, &args)
    };
    let first = "out/first@loading";
    let mut lines = vec![
        from("no stage is named", "out/first", &[]),
        from("neither is a run", "column", &[]),
        from("no folder", "out/frist@loading", &[]),
        from("no run", "thesis@loading", &[]),
        from("misspelt stage", "out/first@laoding", &[]),
        from("its own folder", first, &["--out", "out/first"]),
    ];
    bench.write("other/scene.toml", &COLUMN.replace("layer", "ground"));
    lines.push(refused(
        &bench,
        "no body of the name",
        &["run", "other", "--from", first],
    ));
    let k0 = COLUMN
        .replace("material = \"soil\"", "material = \"soil\"\nk0 = 0.5")
        .replace("[mesh]", "[initial_stress]\nkind = \"k0\"\n\n[mesh]");
    bench.write("k0/scene.toml", &k0);
    lines.push(refused(
        &bench,
        "an initial stress",
        &["run", "k0", "--from", first],
    ));
    let fill = "[bodies.fill]\nregion = { min = [0, 0, 0.2], max = [0.1, 0.1, 0.5] }\n\
                material = \"soil\"\n\n[[loads]]";
    bench.write("fill/scene.toml", &COLUMN.replace("[[loads]]", fill));
    lines.push(refused(
        &bench,
        "a body in its place",
        &["run", "fill", "--from", first],
    ));
    insta::assert_snapshot!(lines.join("\n"));

    // With numbers in them.
    let unit_weight = "materials.soil.unit_weight=\"19 kN/m3\"";
    let density = from("another density", first, &["--set", unit_weight]);
    assert!(density.contains("mass is inherited"), "{density}");
    let size = "mesh.box.size=[\"0.1 m\", \"0.1 m\", \"0.4 m\"]";
    let outside = from("a mesh that is too small", first, &["--set", size]);
    assert!(
        outside.contains("24 particles of body `layer`"),
        "{outside}"
    );
    assert!(
        outside.contains("the mesh has to hold the ground"),
        "{outside}"
    );
}

#[test]
fn a_sweep_begins_there_and_is_not_written_over_it() {
    let bench = bench();
    let vary = [
        "sweep",
        "column",
        "--vary",
        "numerics.courant=0.3,0.4",
        "--from",
    ];
    let sweep = |from: &'static str| [&vary[..], &[from]].concat();
    bench.done(&sweep("out/first@loading"));
    let run = "out/column-sweep/courant-0.3";
    assert_eq!(bench.summary(run)["from"], "out/first@loading");
    assert!(
        Path::new(&bench.path(run))
            .join("stages/00_loading.vtu")
            .exists()
    );
    insta::assert_snapshot!(refused(
        &bench,
        "a run of the sweep that would be replaced",
        &sweep("out/column-sweep/courant-0.3@loading")
    ));
}
