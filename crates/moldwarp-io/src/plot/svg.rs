//! A page as SVG, with its texts as texts.

use super::CENTIMETRE;
use super::font::FAMILIES;
use super::shapes::{Anchor, Page, Shape};
use super::style::{Colour, Stroke};
use crate::output::vtu::escape;
use std::fmt::Write;

/// The text of an SVG file of the page's size.
pub(super) fn text(page: &Page) -> String {
    let mut out = String::new();
    // A string takes whatever is written to it.
    let _ = write(page, &mut out);
    out
}

fn write(page: &Page, out: &mut String) -> std::fmt::Result {
    let [width, height] = [page.width, page.height];
    let [left, top, right, bottom] = page.frame;
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}cm\" height=\"{}cm\" \
         viewBox=\"0 0 {} {}\" font-family=\"{FAMILIES}\">",
        figure(width / CENTIMETRE),
        figure(height / CENTIMETRE),
        figure(width),
        figure(height)
    )?;
    writeln!(out, "<desc>{}</desc>", escape(&page.description))?;
    writeln!(
        out,
        "<clipPath id=\"frame\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>",
        figure(left),
        figure(top),
        figure(right - left),
        figure(bottom - top)
    )?;
    writeln!(out, "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>")?;
    for shape in &page.shapes {
        match shape {
            Shape::Lines {
                lines,
                stroke,
                clipped,
            } => write_lines(out, lines, stroke, *clipped)?,
            text => write_text(out, text)?,
        }
    }
    writeln!(out, "</svg>")
}

fn write_lines(
    out: &mut String,
    lines: &[Vec<[f64; 2]>],
    stroke: &Stroke,
    clipped: bool,
) -> std::fmt::Result {
    out.push_str("<path d=\"");
    for line in lines {
        for (i, [x, y]) in line.iter().enumerate() {
            let letter = ["M", "L", " "][i.min(2)];
            write!(out, "{letter}{} {}", figure(*x), figure(*y))?;
        }
    }
    write!(
        out,
        "\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"",
        hex(stroke.colour),
        figure(stroke.width)
    )?;
    if !stroke.dash.is_empty() {
        let dash: Vec<String> = stroke.dash.iter().map(|&d| figure(d)).collect();
        write!(out, " stroke-dasharray=\"{}\"", dash.join(" "))?;
    }
    if clipped {
        out.push_str(" clip-path=\"url(#frame)\"");
    }
    writeln!(out, "/>")
}

fn write_text(out: &mut String, shape: &Shape) -> std::fmt::Result {
    let Shape::Text {
        text,
        at: [x, y],
        size,
        anchor,
        upright,
        colour,
    } = shape
    else {
        return Ok(());
    };
    let [x, y] = [figure(*x), figure(*y)];
    let anchor = match anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let place = match upright {
        true => format!("transform=\"translate({x} {y}) rotate(-90)\""),
        false => format!("x=\"{x}\" y=\"{y}\""),
    };
    writeln!(
        out,
        "<text {place} font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{}\">{}</text>",
        figure(*size),
        hex(*colour),
        escape(text)
    )
}

fn hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Two decimals are a few thousandths of a millimetre.
fn figure(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
