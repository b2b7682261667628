//! `moldwarp plot`: histories as PNG and SVG.

mod common;

use common::{Bench, COLUMN};

fn bench() -> Bench {
    let bench = Bench::with(COLUMN);
    bench.done(&["run", "column"]);
    bench
}

/// The line of a curve as points on the page, of the `number`-th one.
fn curve(svg: &str, number: usize) -> Vec<[f64; 2]> {
    let lines = svg.lines().filter(|l| l.contains("clip-path"));
    let line = lines
        .clone()
        .nth(number)
        .unwrap_or_else(|| panic!("{} curves", lines.count()));
    let path = line.split('"').nth(1).unwrap().replace(['M', 'L'], " ");
    let numbers: Vec<f64> = path
        .split_whitespace()
        .map(|n| n.parse().unwrap())
        .collect();
    numbers.chunks(2).map(|p| [p[0], p[1]]).collect()
}

#[test]
fn the_curve_is_that_of_the_history() {
    let bench = bench();
    let what = ["--what", "bottom.displacement.z"];
    let said = bench.done(&[&["plot", "out/column"], &what[..], &["--output", "z.svg"]].concat());
    assert_eq!(said, "plot: z.svg\n");
    let svg = bench.read("z.svg");
    for text in ["time (s)", "displacement z of bottom (mm)"] {
        assert!(svg.contains(&format!(">{text}</text>")), "{text}");
    }
    // Its last point is as far down between first and deepest value as the history says.
    let history = bench.read("out/column/history.csv");
    let at = history
        .lines()
        .next()
        .unwrap()
        .split(',')
        .position(|c| c == what[1])
        .unwrap();
    let values: Vec<f64> = history
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(at).unwrap().parse().unwrap())
        .collect();
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let points = curve(&svg, 0);
    let low = points
        .iter()
        .map(|p| p[1])
        .fold(f64::NEG_INFINITY, f64::max);
    let high = points.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    let [first, last] = [values[0], values[values.len() - 1]];
    for (value, point) in [(first, points[0]), (last, points[points.len() - 1])] {
        let share = (value - least) / (greatest - least);
        let drawn = (low - point[1]) / (low - high);
        assert!((share - drawn).abs() < 1e-3, "{share} {drawn}");
    }
}

#[test]
fn runs_sweeps_and_references_share_a_plot() {
    let bench = bench();
    bench.done(&["sweep", "column", "--vary", "numerics.courant=0.3,0.5"]);
    bench.write("exact.csv", "time,value\n0,0\n0.05,-0.002\n");
    let what = [
        "--what",
        "bottom.displacement.z",
        "--output",
        "all.svg",
        "--output",
        "all.png",
    ];
    let more = [
        "--reference",
        "theory=exact.csv",
        "--scene-hash",
        "--title",
        "All",
    ];
    let outs = ["plot", "out/column", "out/column-sweep"];
    bench.done(&[&outs[..], &what, &more].concat());
    let svg = bench.read("all.svg");
    assert_eq!(svg.matches("clip-path=\"url(#frame)\"").count(), 4);
    for text in ["column", "courant = 0.3", "courant = 0.5", "theory", "All"] {
        assert!(svg.contains(&format!(">{text}</text>")), "{text}");
    }
    let hash = bench.summary("out/column")["scene_hash"].as_str().unwrap()[..12].to_owned();
    assert!(svg.contains(&hash), "{hash}");
    let png = std::fs::read(bench.path("all.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG") && png.len() < 300_000);

    bench.done(&[
        "plot",
        "out/column",
        "--what",
        "energy",
        "--log-y",
        "--size",
        "16x9",
    ]);
    assert!(bench.path("plot.png").exists());
    let loops = [
        "--what",
        "bottom.displacement.z",
        "--against",
        "energy.kinetic",
    ];
    bench.done(
        &[
            &["plot", "out/column"],
            &loops[..],
            &["--x-range", "0", "1 mJ"],
        ]
        .concat(),
    );
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let bench = bench();
    bench.write("text.csv", "time,value\n0,about 3\n");
    let before = bench.files();
    let message = |args: &[&str]| {
        let said = bench.fails(2, &[&["plot"], args].concat());
        let lines: Vec<&str> = said.trim_end().lines().map(str::trim_end).collect();
        lines.join("\n")
    };
    let z = "bottom.displacement.z";
    let lines = [
        message(&["out/column", "--what", "botom.displacement.z"]),
        message(&["out/column", "--what", "pressure"]),
        message(&["out/column", "--what", "bottom,energy"]),
        message(&["out/column", "--what", z, "--against", "tiem"]),
        message(&["out/column", "--what", z, "--output", "plot.pdf"]),
        message(&["out/colum", "--what", z]),
        message(&["column", "--what", z]),
        message(&["out/column", "--what", z, "--y-unit", "kPa"]),
        message(&["out/column", "--what", z, "--y-range", "0", "-1 mm"]),
        message(&["out/column", "--what", z, "--size", "1x1"]),
        message(&["out/column", "--what", z, "--size", "big"]),
        message(&["out/column", "--what", z, "--label", "a", "--label", "b"]),
        message(&["out/column", "--what", z, "--reference", "text.csv"]),
        message(&["out/column", "--what", z, "--reference", "nothing.csv"]),
    ];
    insta::assert_snapshot!(lines.join("\n"));
    assert_eq!(bench.files(), before);
    let said = bench.fails(
        4,
        &[
            "plot",
            "out/column",
            "--what",
            z,
            "--output",
            "no/where.png",
        ],
    );
    assert!(said.contains("cannot write no/where.png"), "{said}");
}
