//! Line plots as SVG.

use plotters::prelude::*;

/// A line or a set of points.
#[derive(Clone, Debug)]
pub struct Curve {
    pub label: String,
    pub points: Vec<(f64, f64)>,
    pub dashed: bool,
}

/// Curves over common axes.
#[derive(Clone, Debug)]
pub struct Plot {
    pub title: String,
    pub x: String,
    pub y: String,
    pub curves: Vec<Curve>,
}

/// Colours that differ in lightness too (Okabe and Ito).
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];

impl Plot {
    pub fn new(title: &str, x: &str, y: &str) -> Plot {
        Plot {
            title: title.to_owned(),
            x: x.to_owned(),
            y: y.to_owned(),
            curves: Vec::new(),
        }
    }

    pub fn line(&mut self, label: impl Into<String>, points: Vec<(f64, f64)>) {
        self.curves.push(Curve {
            label: label.into(),
            points,
            dashed: false,
        });
    }

    pub fn dashed(&mut self, label: impl Into<String>, points: Vec<(f64, f64)>) {
        self.curves.push(Curve {
            label: label.into(),
            points,
            dashed: true,
        });
    }

    fn ranges(&self) -> [(f64, f64); 2] {
        let all = || self.curves.iter().flat_map(|c| &c.points);
        let range = |values: &mut dyn Iterator<Item = f64>| {
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
            let margin = 0.04 * (high - low).max(1e-12 * high.abs().max(1e-300));
            (low - margin, high + margin)
        };
        [
            range(&mut all().map(|p| p.0)),
            range(&mut all().map(|p| p.1)),
        ]
    }

    /// The plot as the text of an SVG file.
    pub fn svg(&self) -> String {
        let mut text = String::new();
        self.draw(&mut text)
            .expect("a string takes what is drawn to it");
        text
    }

    fn draw(&self, text: &mut String) -> Result<(), Box<dyn std::error::Error>> {
        let [(x0, x1), (y0, y1)] = self.ranges();
        // Room for the legend.
        let y1 = y1 + 0.06 * self.curves.len() as f64 * (y1 - y0);
        let root = SVGBackend::with_string(text, (860, 480)).into_drawing_area();
        root.fill(&WHITE).map_err(|e| e.to_string())?;
        let mut chart = ChartBuilder::on(&root)
            .caption(&self.title, ("sans-serif", 18))
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(76)
            .build_cartesian_2d(x0..x1, y0..y1)
            .map_err(|e| e.to_string())?;
        chart
            .configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .light_line_style(TRANSPARENT)
            .label_style(("sans-serif", 14))
            .axis_desc_style(("sans-serif", 15))
            .draw()
            .map_err(|e| e.to_string())?;
        for (i, curve) in self.curves.iter().enumerate() {
            let style = COLOURS[i % COLOURS.len()].stroke_width(2);
            let points = curve.points.iter().copied();
            let drawn = if curve.dashed {
                chart.draw_series(DashedLineSeries::new(points, 7, 4, style))
            } else {
                chart.draw_series(LineSeries::new(points, style))
            };
            drawn
                .map_err(|e| e.to_string())?
                .label(&curve.label)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 22, y)], style));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 14))
            .draw()
            .map_err(|e| e.to_string())?;
        root.present().map_err(|e| e.to_string())?;
        Ok(())
    }
}
