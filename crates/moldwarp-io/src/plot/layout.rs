//! Where everything goes on the page.

use super::curve::thinned;
use super::scale::Scale;
use super::shapes::{Anchor, Page, Shape};
use super::style::{BLACK, FAINT, INK, Stroke};
use super::{CENTIMETRE, Curve, Plot, PlotError, font};

/// Least width and height of the plot itself, cm.
const LEAST: f64 = 1.8;
/// Length of ticks, points.
const TICK: f64 = 3.0;
/// How near a point may be to a line to be left out, points: a hundredth of a millimetre.
const TOLERANCE: f64 = 0.03;
/// Sizes of texts, over that of labels.
const TITLE: f64 = 1.15;
const CAPTION: f64 = 0.65;
/// A label that is too long is drawn smaller, down to this share.
const LEAST_LABEL: f64 = 0.6;

/// Places a plot.
///
/// # Errors
///
/// If there is nothing to be drawn or no room for it.
pub(super) fn page(plot: &Plot) -> Result<Page, PlotError> {
    let layout = Layout::of(plot)?;
    let mut shapes = Vec::new();
    layout.axes(&mut shapes);
    layout.curves(&mut shapes);
    layout.legend(&mut shapes);
    layout.texts(&mut shapes)?;
    let labels = plot.curves.iter().map(|c| c.label.as_str());
    let labels: Vec<&str> = labels.filter(|l| !l.is_empty()).collect();
    let texts = [&plot.title, &plot.y, &plot.x, &plot.caption];
    let texts = texts
        .into_iter()
        .map(String::as_str)
        .filter(|t| !t.is_empty());
    let all: Vec<&str> = texts.chain(labels).collect();
    Ok(Page {
        width: layout.width,
        height: layout.height,
        frame: layout.frame,
        shapes,
        description: all.join("; "),
    })
}

struct Layout<'a> {
    plot: &'a Plot,
    width: f64,
    height: f64,
    /// Left, top, right, bottom.
    frame: [f64; 4],
    x: Scale,
    y: Scale,
    x_ticks: Vec<(f64, String)>,
    y_ticks: Vec<(f64, String)>,
    /// Numbers of the curves in each row of the legend.
    rows: Vec<Vec<usize>>,
}

impl<'a> Layout<'a> {
    fn of(plot: &'a Plot) -> Result<Layout<'a>, PlotError> {
        let size = plot.look.font_size;
        let [width, height] = plot.look.size.map(|length| length * CENTIMETRE);
        let (x, y) = scales(plot)?;
        let pad = 0.6 * size;
        let bottom = height - pad - caption_height(plot) - 1.3 * size - 1.5 * size - TICK;
        let mut layout = Layout {
            plot,
            width,
            height,
            frame: [0.0, pad, width - pad, bottom],
            x,
            y,
            x_ticks: Vec::new(),
            y_ticks: Vec::new(),
            rows: Vec::new(),
        };
        // Ticks, margins and the legend depend on each other; the second time they agree.
        for _ in 0..2 {
            layout.y_ticks = y.ticks(room(layout.inner()[1], 2.6 * size));
            let widest = layout.y_ticks.iter().map(|t| font::width(&t.1, size));
            let left = pad + 1.7 * size + widest.fold(0.0, f64::max) + 0.4 * size + TICK;
            layout.frame[0] = left;
            layout.x_ticks = layout.fitting_x_ticks();
            let last = layout.x_ticks.last();
            let beyond = last.map_or(0.0, |(v, text)| {
                let at = layout.frame[0] + x.share(*v) * layout.inner()[0];
                at + 0.5 * font::width(text, size) - layout.frame[2]
            });
            layout.frame[2] -= beyond.max(0.0);
            layout.rows = layout.legend_rows();
            layout.frame[1] = pad + title_height(plot) + 1.35 * size * layout.rows.len() as f64;
            if !layout.rows.is_empty() {
                layout.frame[1] += 0.4 * size;
            }
            layout.check_room()?;
        }
        Ok(layout)
    }

    /// Width and height of the frame.
    fn inner(&self) -> [f64; 2] {
        [self.frame[2] - self.frame[0], self.frame[3] - self.frame[1]]
    }

    fn check_room(&self) -> Result<(), PlotError> {
        let [w, h] = self.inner().map(|length| length / CENTIMETRE);
        if w >= LEAST && h >= LEAST {
            return Ok(());
        }
        let [width, height] = self.plot.look.size;
        Err(PlotError::NoRoom(format!(
            "labels and legend leave {:.1} × {:.1} cm of {width} × {height} cm for the plot",
            w.max(0.0),
            h.max(0.0)
        )))
    }

    /// As many as stand beside each other without touching.
    fn fitting_x_ticks(&self) -> Vec<(f64, String)> {
        let size = self.plot.look.font_size;
        let mut most = room(self.inner()[0], 3.0 * size);
        loop {
            let ticks = self.x.ticks(most);
            let all: f64 = ticks.iter().map(|t| font::width(&t.1, size) + size).sum();
            if all <= self.inner()[0] || most <= 2 {
                return ticks;
            }
            most -= 1;
        }
    }

    /// Width of a curve's sample in the legend, and with its label.
    fn entry(&self, curve: usize) -> (f64, f64) {
        let size = self.plot.look.font_size;
        let label = font::width(&self.plot.curves[curve].label, size);
        (2.6 * size, 3.1 * size + label)
    }

    /// Curves with labels from left to right, in as many rows as they need.
    fn legend_rows(&self) -> Vec<Vec<usize>> {
        let gap = 1.4 * self.plot.look.font_size;
        let mut rows: Vec<Vec<usize>> = Vec::new();
        let mut used = f64::INFINITY;
        for number in 0..self.plot.curves.len() {
            if self.plot.curves[number].label.is_empty() {
                continue;
            }
            let wide = self.entry(number).1;
            if used + gap + wide > self.inner()[0] {
                rows.push(Vec::new());
                used = -gap;
            }
            used += gap + wide;
            rows.last_mut().into_iter().for_each(|row| row.push(number));
        }
        rows
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, right, bottom] = self.frame;
        [
            left + self.x.share(x) * (right - left),
            bottom - self.y.share(y) * (bottom - top),
        ]
    }

    fn axes(&self, shapes: &mut Vec<Shape>) {
        let [left, top, right, bottom] = self.frame;
        let size = self.plot.look.font_size;
        let (mut faint, mut ticks) = (Vec::new(), Vec::new());
        let mut labels = Vec::new();
        for (value, label) in &self.x_ticks {
            let x = left + self.x.share(*value) * (right - left);
            faint.push(vec![[x, bottom], [x, top]]);
            ticks.push(vec![[x, bottom], [x, bottom + TICK]]);
            labels.push((label, [x, bottom + TICK + 1.15 * size], Anchor::Middle));
        }
        for (value, label) in &self.y_ticks {
            let y = bottom - self.y.share(*value) * (bottom - top);
            faint.push(vec![[left, y], [right, y]]);
            ticks.push(vec![[left - TICK, y], [left, y]]);
            let at = [left - TICK - 0.4 * size, y + 0.36 * size];
            labels.push((label, at, Anchor::End));
        }
        ticks.push(vec![
            [left, top],
            [right, top],
            [right, bottom],
            [left, bottom],
            [left, top],
        ]);
        for (lines, stroke) in [
            (faint, Stroke::whole(FAINT, 0.5)),
            (ticks, Stroke::whole(INK, 0.6)),
        ] {
            shapes.push(Shape::Lines {
                lines,
                stroke,
                clipped: false,
            });
        }
        shapes.extend(labels.into_iter().map(|(text, at, anchor)| Shape::Text {
            text: text.clone(),
            at,
            size,
            anchor,
            upright: false,
            colour: BLACK,
        }));
    }

    fn curves(&self, shapes: &mut Vec<Shape>) {
        for curve in &self.plot.curves {
            let placed: Vec<[f64; 2]> = curve
                .points
                .iter()
                .map(|p| self.place([p.0, p.1]))
                .collect();
            shapes.push(Shape::Lines {
                lines: thinned(&placed, TOLERANCE),
                stroke: Stroke::of(curve),
                clipped: true,
            });
        }
    }

    fn legend(&self, shapes: &mut Vec<Shape>) {
        let size = self.plot.look.font_size;
        let top = 0.6 * size + title_height(self.plot);
        for (row, numbers) in self.rows.iter().enumerate() {
            let base = top + 1.35 * size * (row as f64 + 0.75);
            let mut x = self.frame[0];
            for &number in numbers {
                let (sample, whole) = self.entry(number);
                let y = base - 0.32 * size;
                shapes.push(Shape::Lines {
                    lines: vec![vec![[x, y], [x + sample, y]]],
                    stroke: Stroke::of(&self.plot.curves[number]),
                    clipped: false,
                });
                shapes.push(Shape::Text {
                    text: self.plot.curves[number].label.clone(),
                    at: [x + sample + 0.5 * size, base],
                    size,
                    anchor: Anchor::Start,
                    upright: false,
                    colour: BLACK,
                });
                x += whole + 1.4 * size;
            }
        }
    }

    fn texts(&self, shapes: &mut Vec<Shape>) -> Result<(), PlotError> {
        let [left, top, right, bottom] = self.frame;
        let size = self.plot.look.font_size;
        let (across, down) = (0.5 * (left + right), 0.5 * (top + bottom));
        let under = bottom + TICK + 1.5 * size + 1.05 * size;
        let foot = self.height - 0.5 * size;
        let wide = self.width - size;
        let texts = [
            (
                &self.plot.title,
                [across, 0.6 * size + size],
                size * TITLE,
                2.0 * (self.width - across),
            ),
            (
                &self.plot.x,
                [across, under],
                size,
                2.0 * (self.width - across),
            ),
            (
                &self.plot.y,
                [1.5 * size, down],
                size,
                self.height.min(2.0 * down),
            ),
            (&self.plot.caption, [0.6 * size, foot], size * CAPTION, wide),
        ];
        for (which, (text, at, size, room)) in texts.into_iter().enumerate() {
            if text.is_empty() {
                continue;
            }
            let share = (room / font::width(text, size)).min(1.0);
            if share < LEAST_LABEL {
                return Err(PlotError::NoRoom(format!("there is no room for `{text}`")));
            }
            shapes.push(Shape::Text {
                text: text.clone(),
                at,
                size: size * share,
                anchor: if which == 3 {
                    Anchor::Start
                } else {
                    Anchor::Middle
                },
                upright: which == 2,
                colour: if which == 3 { INK } else { BLACK },
            });
        }
        Ok(())
    }
}

/// How many things of this length fit; at least two.
fn room(length: f64, each: f64) -> usize {
    ((length / each) as usize).clamp(2, 10)
}

fn title_height(plot: &Plot) -> f64 {
    match plot.title.is_empty() {
        true => 0.0,
        false => 1.7 * plot.look.font_size,
    }
}

fn caption_height(plot: &Plot) -> f64 {
    match plot.caption.is_empty() {
        true => 0.0,
        false => 1.1 * plot.look.font_size,
    }
}

fn scales(plot: &Plot) -> Result<(Scale, Scale), PlotError> {
    let points = || plot.curves.iter().flat_map(|c| &c.points);
    // Time goes from edge to edge; a curve that turns round needs room to do so.
    let turns = |c: &Curve| c.points.windows(2).any(|w| w[1].0 < w[0].0);
    let room = plot.curves.iter().any(turns);
    let x =
        Scale::of(points().map(|p| p.0), plot.x_range, false, room).ok_or(PlotError::Empty(""))?;
    // What lies beside the axis does not stretch the other one.
    let within = |p: &&(f64, f64)| (x.low..=x.high).contains(&p.0);
    let values = points().filter(within).map(|p| p.1);
    let y = Scale::of(values, plot.y_range, plot.log_y, true);
    y.map(|y| (x, y)).ok_or(PlotError::Empty(match plot.log_y {
        true => " above zero, as a logarithmic axis needs",
        false => " in this range",
    }))
}
