use super::*;
use crate::output::csv::Table;
use crate::results::History;

fn history(columns: &[(&str, &str, &[f64])]) -> History {
    History {
        table: Table {
            names: columns.iter().map(|c| c.0.to_owned()).collect(),
            columns: columns.iter().map(|c| c.2.to_vec()).collect(),
        },
        units: columns.iter().map(|c| c.1.to_owned()).collect(),
    }
}

fn run(label: &str) -> ShownRun {
    let columns: [(&str, &str, &[f64]); 5] = [
        ("time", "s", &[0.0, 0.5, 1.0]),
        ("tip.displacement.z", "m", &[0.0, -0.002, -0.0051]),
        ("tip.displacement.x", "m", &[0.0, 0.001, f64::NAN]),
        ("energy.kinetic", "J", &[0.0, 20.0, 100.0]),
        ("energy.kinetic_grid", "J", &[0.0, 19.0, 90.0]),
    ];
    ShownRun {
        label: label.to_owned(),
        history: history(&columns),
    }
}

fn shown(runs: &[&str], what: &str) -> Shown {
    Shown {
        runs: runs.iter().map(|label| run(label)).collect(),
        what: vec![what.to_owned()],
        against: "time".to_owned(),
        ..Shown::default()
    }
}

#[test]
fn axes_have_names_and_units_and_curves_their_labels() {
    let one = histories(&shown(&["a"], "tip.displacement.z")).unwrap();
    assert_eq!(
        (&one.x[..], &one.y[..]),
        ("time (s)", "displacement z of tip (mm)")
    );
    assert_eq!(one.curves[0].points[1], (0.5, -2.0));
    assert_eq!(one.curves[0].label, "");
    let several = histories(&shown(&["a"], "tip")).unwrap();
    assert_eq!(several.y, "displacement of tip (mm)");
    assert_eq!(
        [&several.curves[0].label, &several.curves[1].label],
        ["z", "x"]
    );
    let energies = histories(&shown(&["a", "b"], "energy")).unwrap();
    assert_eq!(energies.y, "energy (J)");
    let labels: Vec<&str> = energies.curves.iter().map(|c| &c.label[..]).collect();
    assert_eq!(
        labels,
        [
            "a: kinetic",
            "a: kinetic grid",
            "b: kinetic",
            "b: kinetic grid"
        ]
    );
    let styles: Vec<usize> = energies.curves.iter().map(|c| c.style).collect();
    assert_eq!(styles, [0, 1, 2, 3]);
}

#[test]
fn what_does_not_go_together_is_said() {
    let message = |what: &str, against: &str, unit: Option<&str>| {
        let shown = Shown {
            against: against.to_owned(),
            y_unit: unit.map(str::to_owned),
            ..shown(&["a"], what)
        };
        let error = histories(&shown).unwrap_err();
        let help = miette::Diagnostic::help(&error).map(|h| h.to_string());
        format!("{error}\n{}", help.unwrap_or_default())
    };
    insta::assert_snapshot!(
        [
            message("tip.displacement.z,energy", "time", None),
            message("tip.displacment.z", "time", None),
            message("energy", "tip", None),
            message("energy", "time", Some("kN")),
        ]
        .join("\n\n")
    );
}

fn plot() -> Plot {
    let mut plot = Plot::new("Title", "time (s)", "Δz (mm)");
    plot.line("a < b & \"c\"", vec![(0.0, 0.0), (1.0, 1.0), (2.0, -1.0)]);
    plot.line("b", vec![(0.0, 0.5), (2.0, 0.5)]);
    plot.dashed("exact", vec![(0.0, 0.25), (2.0, 0.25)]);
    plot
}

#[test]
fn an_svg_has_all_curves_and_texts() {
    let svg = plot().svg().unwrap();
    assert!(svg.contains("width=\"12cm\" height=\"8cm\""));
    assert_eq!(svg.matches("clip-path=\"url(#frame)\"").count(), 3);
    for text in [
        "Title",
        "time (s)",
        "Δz (mm)",
        "a &lt; b &amp; &quot;c&quot;",
        "exact",
    ] {
        assert!(svg.contains(&format!(">{text}</text>")), "{text}\n{svg}");
    }
    // Curves and their samples in the legend.
    assert_eq!(svg.matches("stroke=\"#0072b2\"").count(), 2);
    assert!(!svg.contains("NaN"));
}

#[test]
fn a_png_has_the_size_and_the_colours() {
    let look = Look {
        dpi: 100.0,
        ..Look::default()
    };
    let png = Plot { look, ..plot() }.png().unwrap();
    let size = [&png[16..20], &png[20..24]].map(|b| u32::from_be_bytes(b.try_into().unwrap()));
    // 12 and 8 cm of 100 dots an inch.
    assert_eq!(size, [472, 315]);
    let at = png.windows(4).position(|w| w == b"IDAT").unwrap();
    let length = u32::from_be_bytes(png[at - 4..at].try_into().unwrap()) as usize;
    let rows = miniz_oxide::inflate::decompress_to_vec_zlib(&png[at + 4..at + 4 + length]).unwrap();
    let mut row = vec![0u8; 3 * 472];
    let mut blue = 0;
    for line in rows.chunks(1 + 3 * 472) {
        for (value, change) in row.iter_mut().zip(&line[1..]) {
            *value = value.wrapping_add(*change);
        }
        blue += row.chunks(3).filter(|dot| *dot == [0, 114, 178]).count();
    }
    assert!(blue > 300, "{blue} dots of the first curve");
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let empty = Plot::new("", "x", "y");
    assert!(matches!(empty.svg(), Err(PlotError::Empty(_))));
    let mut below = plot();
    below.log_y = true;
    below.curves.truncate(1);
    below.curves[0].points = vec![(0.0, -1.0), (1.0, 0.0)];
    assert!(matches!(below.svg(), Err(PlotError::Empty(_))));
    let mut small = plot();
    small.look.size = [3.0, 2.0];
    let said = small.svg().unwrap_err().to_string();
    assert!(said.contains("leave"), "{said}");
    let mut huge = plot();
    huge.look.dpi = 1e5;
    assert!(matches!(huge.png(), Err(PlotError::NoRoom(_))));
    assert!(matches!(
        Format::of(Path::new("a.pdf")),
        Err(PlotError::Ending(_))
    ));
    assert_eq!(Format::of(Path::new("a.PNG")).unwrap(), Format::Png);
}
