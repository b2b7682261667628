//! Reports of small runs, read back.

mod of_session;

use super::packing::tests::{unpacked, value};
use super::{ReportError, Wishes, Written, report};
use crate::output::{csv, vtu_read};
use crate::run::{RunOptions, run};
use crate::scene;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A block of Mohr-Coulomb soil that falls apart, and a load.
const BLOCK: &str = r#"version = 1
title = "A block </script><img src=x onerror=alert(1)> & \"more\""
gravity = [0, 0, "-9.81 m/s2"]
[mesh]
box = { size = ["2 m", "1 m", "2 m"], cells = [4, 2, 4] }
[materials.soil] # </script><script>alert(2)</script>
model = "mohr-coulomb"
young_modulus = "1 MPa"
poisson_ratio = 0.3
cohesion = "0.5 kPa"
friction_angle = "25 deg"
unit_weight = "18 kN/m3"
[bodies.block]
region = { min = [0, 0, 0], max = ["1 m", "1 m", "1 m"] }
material = "soil"
[[boundaries]]
surface = ["x-min", "x-max", "y-min", "y-max"]
kind = "roller"
[[boundaries]]
name = "base"
surface = "z-min"
kind = "fixed"
[probes.base]
surface = "z-min"
quantities = ["reaction"]
[probes.top]
point = ["1 m", "0.5 m", "1 m"]
quantities = ["displacement"]
[[stages]]
name = "fall"
duration = "0.2 s"
[[stages]]
name = "again <b>"
duration = "0.1 s"
reset = ["displacement"]
[output]
frames = 6
history = 40
"#;

/// A run in a folder of its own.
struct Bench {
    dir: tempfile::TempDir,
}

impl Bench {
    fn run(sets: &[&str]) -> Bench {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("scene.toml");
        std::fs::write(&path, BLOCK).unwrap();
        let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
        let scene = scene::load(&path, &sets).unwrap_or_else(|e| panic!("{e:?}"));
        let bench = Bench { dir };
        let options = RunOptions {
            out: Some(bench.out()),
            threads: 1,
            ..RunOptions::default()
        };
        run(scene, &options, &mut ()).unwrap();
        bench
    }

    fn out(&self) -> PathBuf {
        self.dir.path().join("out")
    }

    fn report(&self, wishes: Wishes) -> Page {
        Page::of(report(&self.out(), None, wishes).unwrap_or_else(|e| panic!("{e}")))
    }

    fn wrong(&self) -> String {
        let error = report(&self.out(), None, Wishes::default()).unwrap_err();
        error
            .to_string()
            .replace(&self.dir.path().display().to_string(), "DIR")
    }
}

struct Page {
    html: String,
    left_out: Vec<String>,
}

impl Page {
    fn of(written: Written) -> Page {
        let html = std::fs::read_to_string(&written.path).unwrap();
        assert_eq!(html.len(), written.bytes);
        Page {
            html,
            left_out: written.left_out,
        }
    }

    /// What stands in a script element.
    fn data(&self, id: &str) -> &str {
        let (_, rest) = self.html.split_once(&format!(" id=\"{id}\">")).expect(id);
        rest.split_once("</script>").unwrap().0
    }

    fn about(&self) -> Value {
        serde_json::from_str(self.data("about")).unwrap()
    }

    fn blob(&self, number: &Value) -> Vec<u8> {
        unpacked(self.data(&format!("blob-{number}")))
    }

    /// The numbers of a blob of two planes, component by component.
    fn codes(&self, number: &Value) -> Vec<u16> {
        let bytes = self.blob(number);
        let (high, low) = bytes.split_at(bytes.len() / 2);
        high.iter()
            .zip(low)
            .map(|(h, l)| u16::from_be_bytes([*h, *l]))
            .collect()
    }

    /// Rows of a table: their key, and the exact values in them with what is shown of each.
    fn rows(&self, table: &str) -> Vec<(String, Vec<(f64, f64)>)> {
        let (_, rest) = self
            .html
            .split_once(&format!("<table id=\"table-{table}\">"))
            .expect(table);
        let rows = rest
            .split_once("</table>")
            .unwrap()
            .0
            .split("<tr data-key=\"")
            .skip(1);
        let row = |row: &str| {
            let values = row.split("<data value=\"").skip(1).map(figure);
            (row.split('"').next().unwrap().to_owned(), values.collect())
        };
        rows.map(row).collect()
    }
}

/// The value of a figure, and what people read.
fn figure(html: &str) -> (f64, f64) {
    let attribute = |name: &str| {
        html.split_once(name)?
            .1
            .split('"')
            .next()?
            .parse::<f64>()
            .ok()
    };
    let exact = html.split('"').next().unwrap().parse().unwrap();
    let (tag, rest) = html.split_once('>').unwrap();
    let scale = tag
        .contains("data-scale")
        .then(|| attribute("data-scale=\"").unwrap());
    let text = rest.split("</data>").next().unwrap();
    let text = text
        .replace("·10<sup>", "e")
        .replace("</sup>", "")
        .replace('\u{2212}', "-")
        .replace(',', "");
    (exact, text.parse::<f64>().unwrap() * scale.unwrap_or(1.0))
}

/// Figures are shown with four digits.
fn rounded_well((exact, shown): (f64, f64)) -> bool {
    (exact - shown).abs() <= 5.001e-4 * exact.abs()
}

#[test]
fn the_figures_are_those_of_the_summary_and_the_history() {
    let bench = Bench::run(&[]);
    let page = bench.report(Wishes::default());
    assert!(page.left_out.is_empty());

    let text = std::fs::read_to_string(bench.out().join("summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&text).unwrap();
    let inside: Value = serde_json::from_str(page.data("summary")).unwrap();
    assert_eq!(inside, summary);
    let mut seen = 0;
    for (key, values) in page.rows("summary") {
        let path = key.replace('.', "/");
        let Some(expected) = summary.pointer(&format!("/{path}")).unwrap().as_f64() else {
            continue;
        };
        assert_eq!(values[0].0, expected, "{key}");
        assert!(rounded_well(values[0]), "{key}: {values:?}");
        seen += 1;
    }
    assert!(seen >= 18, "{seen} figures");
    let energies = page.rows("energies");
    assert_eq!(energies.len(), summary["energy"].as_object().unwrap().len());
    for (kind, values) in energies {
        assert_eq!(
            values[0].0,
            summary["energy"][&kind].as_f64().unwrap(),
            "{kind}"
        );
        let share = values[0].0 / summary["energy_turned_over"].as_f64().unwrap();
        assert_eq!(values[1].0, share, "{kind}");
        assert!(values.into_iter().all(rounded_well), "{kind}");
    }

    let path = bench.out().join("history.csv");
    let history = std::fs::read_to_string(&path).unwrap();
    assert_eq!(unpacked(page.data("history")), history.as_bytes());
    let table = csv::read(&path).unwrap();
    let rows = page.rows("history");
    assert_eq!(rows.len(), table.names.len() - 4);
    for (name, values) in rows {
        let column = table.column(&name).unwrap();
        let of = |f: fn(f64, f64) -> f64| column.iter().copied().reduce(f).unwrap();
        assert_eq!(values[0].0, *column.last().unwrap(), "{name}");
        assert_eq!(
            (values[1].0, values[3].0),
            (of(f64::min), of(f64::max)),
            "{name}"
        );
        assert!(values.into_iter().all(rounded_well), "{name}");
    }
}

#[test]
fn the_answers_are_those_of_the_data() {
    let bench = Bench::run(&[]);
    let page = bench.report(Wishes::default());
    let answer = |id: &str| -> Vec<f64> {
        let (_, rest) = page
            .html
            .split_once(&format!("<article id=\"answer-{id}\">"))
            .expect(id);
        let article = rest.split_once("</article>").unwrap().0;
        let figures = article.split("<data value=\"").skip(1).map(figure);
        figures.map(|f| f.0).collect()
    };
    let frames = (0..).map_while(|k| {
        vtu_read::read(&bench.out().join(format!("frames/particles_{k:05}.vtu"))).ok()
    });
    let mut greatest = (0.0, 0.0);
    for frame in frames {
        let displacement = frame
            .field("displacement")
            .unwrap()
            .values
            .as_chunks::<3>()
            .0;
        for u in displacement {
            let size = u.iter().map(|c| c * c).sum::<f64>().sqrt();
            if size > greatest.0 {
                greatest = (size, frame.time);
            }
        }
    }
    assert_eq!(answer("far")[..2], [greatest.0, greatest.1]);

    let history = csv::read(&bench.out().join("history.csv")).unwrap();
    let column = |c: &str| history.column(&format!("base.reaction.{c}")).unwrap();
    let force = |i: usize| {
        ["x", "y", "z"]
            .map(|c| column(c)[i].powi(2))
            .iter()
            .sum::<f64>()
            .sqrt()
    };
    let greatest = (0..column("x").len()).map(force).fold(0.0, f64::max);
    assert_eq!(answer("force")[0], greatest);
    assert!(page.html.contains("<b>block</b>"));
}

#[test]
fn particles_come_back() {
    let bench = Bench::run(&[]);
    let page = bench.report(Wishes::default());
    let pictures = &page.about()["pictures"];
    let frames = pictures["frames"].as_array().unwrap();
    assert!(
        pictures["origins"]["sets"].as_array().unwrap().len() >= 2,
        "displacements are reset"
    );
    let ids: Vec<u32> = (page
        .blob(&pictures["ids"])
        .as_chunks()
        .0
        .iter()
        .map(|&b| u32::from_le_bytes(b)))
    .collect();
    for shown in frames {
        let path = bench.out().join(format!(
            "frames/particles_{:05}.vtu",
            shown["number"].as_u64().unwrap()
        ));
        let frame = vtu_read::read(&path).unwrap();
        let origin =
            page.codes(&pictures["origins"]["sets"][shown["origin"].as_u64().unwrap() as usize]);
        let place = |id: u32| {
            frame
                .field("id")
                .unwrap()
                .values
                .iter()
                .position(|&v| v as u32 == id)
                .unwrap()
        };
        let count = ids.len();
        for (f, field) in pictures["fields"].as_array().unwrap().iter().enumerate() {
            let codes = page.codes(&shown["fields"][f]);
            let name = field["name"].as_str().unwrap();
            let exact = frame.field(name).unwrap();
            let (one, n) = (field["one"].as_f64(), exact.components);
            assert_eq!(codes.len(), n * count);
            for (slot, &id) in ids.iter().enumerate().step_by(7) {
                for c in 0..n {
                    let (code, exact) = (codes[c * count + slot], exact.values[n * place(id) + c]);
                    let Some(one) = one else {
                        assert_eq!(f64::from(code), exact);
                        continue;
                    };
                    let back = value(code) * one;
                    let error = exact.abs() * (-11f64).exp2() + one * (-25f64).exp2();
                    assert!(
                        (back - exact).abs() <= error * 1.001,
                        "{name}: {exact} {back}"
                    );
                    if name == "displacement" {
                        let [low, size] =
                            ["low", "size"].map(|k| pictures["origins"][k][c].as_f64().unwrap());
                        let position =
                            low + size * f64::from(origin[c * count + slot]) / 65535.0 + back;
                        let error = size / 131_000.0 + error * 1.001;
                        assert!((position - frame.points[place(id)][c]).abs() <= error);
                    }
                }
            }
        }
    }
    let mesh = &pictures["mesh"];
    // The surface of 4 × 2 × 4 cells with two triangles on each face.
    assert_eq!(
        page.blob(&mesh["triangles"]).len(),
        12 * 2 * 2 * (4 * 2 + 4 * 4 + 4 * 2)
    );
    assert!(
        frames.iter().all(|f| f["mesh"].is_null()),
        "it has not moved"
    );
}

#[test]
fn nothing_of_a_scene_becomes_a_part_of_the_page() {
    let page = Bench::run(&["output.frames=1"]).report(Wishes::default());
    for tag in ["<img", "<script>alert", "<b>\"", "again <b>"] {
        assert!(!page.html.contains(tag), "{tag}");
    }
    assert!(page.html.contains("A block &lt;/script&gt;&lt;img"));
    // Each script element that begins ends once.
    assert_eq!(
        page.html.matches("<script").count(),
        page.html.matches("</script>").count()
    );
    for reference in ["http://", "https://", "src=", "url(", "@import"] {
        let own = page
            .html
            .replace("src=x onerror", "")
            .replace("https://github.com/leeoniya/uPlot", "");
        let script = own.rfind("<script nonce").unwrap();
        assert!(!own[..script].contains(reference), "{reference}");
    }
    assert!(page.html.contains("default-src 'none'"));
}

#[test]
fn what_is_left_out_is_said() {
    let bench = Bench::run(&[]);
    let wishes = Wishes {
        particles: Some(60),
        frames: Some(3),
    };
    let page = bench.report(wishes);
    let pictures = &page.about()["pictures"];
    let count = pictures["count"].as_u64().unwrap();
    let all = csv_particles(&bench.out());
    assert!(count >= 50 && count < all, "{count} of {all}");
    assert_eq!(pictures["frames"].as_array().unwrap().len(), 3);
    let said = [
        format!("The 3D view draws {count} of {all} particles"),
        "The 3D view has 3 of 7 frames".to_owned(),
    ];
    for sentence in said {
        assert!(
            page.left_out.iter().any(|l| l.starts_with(&sentence)),
            "{:?}",
            page.left_out
        );
        assert!(page.html.contains(&sentence));
    }
    // Ranges are of all frames and particles all the same.
    let whole = bench.report(Wishes::default());
    assert_eq!(whole.about()["pictures"]["overall"], pictures["overall"]);
}

fn csv_particles(out: &Path) -> u64 {
    let text = std::fs::read_to_string(out.join("summary.json")).unwrap();
    serde_json::from_str::<Value>(&text).unwrap()["particles"]
        .as_u64()
        .unwrap()
}

#[test]
fn runs_without_frames_or_with_one_have_a_report() {
    let none = Bench::run(&["output.frames=0"]).report(Wishes::default());
    assert!(none.html.contains("has written no frames") && none.html.contains("output.frames=50"));
    assert!(none.about()["pictures"].is_null());
    let bench = Bench::run(&["output.frames=1"]);
    let out = bench.out();
    // As a run leaves it that was killed: no summary, and a row that is not complete.
    std::fs::remove_file(out.join("summary.json")).unwrap();
    let history = std::fs::read_to_string(out.join("history.csv")).unwrap();
    std::fs::write(out.join("history.csv"), format!("{history}0.3,1,0.")).unwrap();
    let page = bench.report(Wishes::default());
    assert_eq!(unpacked(page.data("history")), history.as_bytes());
    assert!(page.html.contains("class=\"verdict unfinished\""));
    assert_eq!(page.about()["units"]["base.reaction.x"], "N");
    std::fs::remove_file(out.join("history.csv")).unwrap();
    let page = bench.report(Wishes::default());
    assert!(page.html.contains("There is no history."));
}

#[test]
fn damaged_folders_are_refused() {
    let bench = Bench::run(&["output.frames=2"]);
    let out = bench.out();
    let keep = |name: &str| (out.join(name), std::fs::read(out.join(name)).unwrap());
    for name in [
        "frames/particles_00001.vtu",
        "frames/mesh_00000.vtu",
        "summary.json",
        "history.csv",
        "particles.pvd",
        "scene.toml",
    ] {
        let (path, bytes) = keep(name);
        let half = match name {
            "history.csv" => "time,stage\n0,zero\n".into(),
            "particles.pvd" => b"<DataSet nothing/>".to_vec(),
            _ => bytes[..bytes.len() / 2].to_vec(),
        };
        std::fs::write(&path, half).unwrap();
        let said = bench.wrong();
        let file = name.rsplit('/').next().unwrap();
        assert!(
            said.contains(file) || name == "scene.toml",
            "{name}: {said}"
        );
        assert!(!out.join("report.html").exists());
        std::fs::write(&path, bytes).unwrap();
    }
    let (path, bytes) = keep("frames/particles_00001.vtu");
    std::fs::remove_file(&path).unwrap();
    assert!(
        bench
            .wrong()
            .starts_with("cannot read DIR/out/frames/particles_00001.vtu")
    );
    std::fs::write(&path, bytes).unwrap();

    std::fs::write(out.join("report.html"), "mine").unwrap();
    assert_eq!(
        bench.wrong(),
        "DIR/out/report.html is there already, and is no report"
    );
    std::fs::remove_file(out.join("report.html")).unwrap();
    bench.report(Wishes::default());
    bench.report(Wishes::default());

    let wrong = |path: &Path| report(path, None, Wishes::default()).unwrap_err();
    assert!(matches!(
        wrong(&out.join("nothing")),
        ReportError::Missing(_)
    ));
    assert!(matches!(wrong(&out.join("frames")), ReportError::NoRun(_)));
    let to_a_folder = report(&out, Some(&out), Wishes::default()).unwrap_err();
    assert!(matches!(to_a_folder, ReportError::Folder(_)));
}

/// FNV-1a of 64 bits, as `viewer/build.mjs` has it.
fn fingerprint(bytes: impl Iterator<Item = u8>) -> String {
    let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
    });
    format!("{hash:016x}")
}

#[test]
fn the_viewer_is_built_from_its_sources() {
    let viewer = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../viewer");
    let own = std::fs::read_dir(viewer.join("src")).unwrap();
    let own = own.map(|entry| format!("src/{}", entry.unwrap().file_name().to_str().unwrap()));
    let fixed = [
        "build.mjs",
        "package.json",
        "package-lock.json",
        "tsconfig.json",
    ];
    let mut names: Vec<String> = own.chain(fixed.map(str::to_owned)).collect();
    names.sort();
    let source = |name: &String| {
        let text = std::fs::read_to_string(viewer.join(name)).unwrap();
        format!("{name}\n{}", text.replace('\r', ""))
    };
    let sources: Vec<String> = names.iter().map(source).collect();
    let script = include_str!("viewer.js").replace("\r\n", "\n");
    let (notice, body) = script
        .split_once("\n*/\n")
        .expect("it begins with a notice");
    let said = |key: &str| {
        let line = notice.lines().find_map(|l| l.strip_prefix(key));
        line.map(str::trim).unwrap_or_default().to_owned()
    };
    let again = "build it anew: cd viewer && npm ci && npm run build";
    assert_eq!(
        said("sources "),
        fingerprint(sources.join("\n").bytes()),
        "viewer.js is stale; {again}"
    );
    assert_eq!(
        said("bundle "),
        fingerprint(body.bytes()),
        "viewer.js was changed by hand; {again}"
    );
    // Licences ask for their notices to be kept.
    assert!(notice.contains("The MIT License") && notice.contains("Leon Sorokin"));
}
