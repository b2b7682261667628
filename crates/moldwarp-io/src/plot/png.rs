//! A page as PNG, and the writer of such files.

use super::PlotError;
use super::font;
use super::shapes::{Page, Shape};
use super::style::{Colour, Stroke};
use tiny_skia::{
    FillRule, LineCap, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, Rect, StrokeDash,
    Transform,
};

/// Pictures have at most so many dots on a side.
const MOST_DOTS: f64 = 20_000.0;

/// The bytes of a PNG file with so many dots per inch.
pub(super) fn bytes(page: &Page, dpi: f64) -> Result<Vec<u8>, PlotError> {
    let scale = dpi / 72.0;
    let [width, height] = [page.width, page.height].map(|length| (length * scale).round());
    let no_room = || {
        PlotError::NoRoom(format!(
            "a picture of {width} × {height} dots cannot be made"
        ))
    };
    if width.max(height) > MOST_DOTS {
        return Err(no_room());
    }
    let mut pixmap = Pixmap::new(width as u32, height as u32).ok_or_else(no_room)?;
    pixmap.fill(tiny_skia::Color::WHITE);
    let transform = Transform::from_scale(scale as f32, scale as f32);
    let mask = frame_mask(page, &pixmap, transform);
    for shape in &page.shapes {
        draw(shape, &mut pixmap, transform, mask.as_ref());
    }
    let colours: Vec<u8> = pixmap
        .data()
        .chunks_exact(4)
        .flat_map(|c| [c[0], c[1], c[2]])
        .collect();
    Ok(encode(
        [width as u32, height as u32],
        &colours,
        dpi,
        &page.description,
    ))
}

fn frame_mask(page: &Page, pixmap: &Pixmap, transform: Transform) -> Option<Mask> {
    let [left, top, right, bottom] = page.frame.map(|v| v as f32);
    let mut mask = Mask::new(pixmap.width(), pixmap.height())?;
    let frame = PathBuilder::from_rect(Rect::from_ltrb(left, top, right, bottom)?);
    mask.fill_path(&frame, FillRule::Winding, true, transform);
    Some(mask)
}

fn draw(shape: &Shape, pixmap: &mut Pixmap, transform: Transform, frame: Option<&Mask>) {
    match shape {
        Shape::Lines {
            lines,
            stroke,
            clipped,
        } => {
            if let Some(path) = lines_path(lines) {
                let mask = frame.filter(|_| *clipped);
                let paint = paint(stroke.colour);
                pixmap.stroke_path(&path, &paint, &pen(stroke), transform, mask);
            }
        }
        Shape::Text {
            text,
            at,
            size,
            anchor,
            upright,
            colour,
        } => {
            let mut path = PathBuilder::new();
            font::outline(text, *size, &mut path);
            let Some(path) = path.finish() else {
                return;
            };
            let before = anchor.share() * font::width(text, *size);
            let turn = if *upright { -90.0 } else { 0.0 };
            // Letters are drawn upwards.
            let place = transform
                .pre_translate(at[0] as f32, at[1] as f32)
                .pre_rotate(turn)
                .pre_translate(-before as f32, 0.0)
                .pre_scale(1.0, -1.0);
            pixmap.fill_path(&path, &paint(*colour), FillRule::Winding, place, None);
        }
    }
}

fn lines_path(lines: &[Vec<[f64; 2]>]) -> Option<Path> {
    let mut path = PathBuilder::new();
    for line in lines {
        for (i, [x, y]) in line.iter().enumerate() {
            let (x, y) = (*x as f32, *y as f32);
            match i {
                0 => path.move_to(x, y),
                _ => path.line_to(x, y),
            }
        }
    }
    path.finish()
}

fn paint([r, g, b]: Colour) -> Paint<'static> {
    let mut paint = Paint {
        anti_alias: true,
        ..Paint::default()
    };
    paint.set_color_rgba8(r, g, b, 255);
    paint
}

fn pen(stroke: &Stroke) -> tiny_skia::Stroke {
    let dash = stroke.dash.iter().map(|&d| d as f32).collect();
    tiny_skia::Stroke {
        width: stroke.width as f32,
        line_join: LineJoin::Round,
        line_cap: LineCap::Butt,
        dash: StrokeDash::new(dash, 0.0),
        ..tiny_skia::Stroke::default()
    }
}

/// A PNG of these colours, three bytes a dot, row by row, with its size in metres and a description.
fn encode([width, height]: [u32; 2], colours: &[u8], dpi: f64, description: &str) -> Vec<u8> {
    let per_metre = (dpi / 0.0254).round() as u32;
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    // Eight bits a colour, red green blue, not interlaced.
    let header = [
        &width.to_be_bytes()[..],
        &height.to_be_bytes(),
        &[8, 2, 0, 0, 0],
    ]
    .concat();
    chunk(&mut file, b"IHDR", &header);
    let size = [&per_metre.to_be_bytes()[..], &per_metre.to_be_bytes(), &[1]].concat();
    chunk(&mut file, b"pHYs", &size);
    // Keyword; not compressed, no language, no translation of the keyword; UTF-8.
    let text = [b"Description\0\0\0\0\0", description.as_bytes()].concat();
    chunk(&mut file, b"iTXt", &text);
    let data = miniz_oxide::deflate::compress_to_vec_zlib(&filtered(width as usize, colours), 6);
    chunk(&mut file, b"IDAT", &data);
    chunk(&mut file, b"IEND", &[]);
    file
}

/// Each row as its difference from the one above (filter 2), of which little is left.
fn filtered(width: usize, colours: &[u8]) -> Vec<u8> {
    let length = 3 * width;
    let mut rows = Vec::with_capacity(colours.len() + colours.len() / length);
    let mut above = vec![0; length];
    for row in colours.chunks_exact(length) {
        rows.push(2);
        rows.extend(
            row.iter()
                .zip(&above)
                .map(|(a, b): (&u8, &u8)| a.wrapping_sub(*b)),
        );
        above.copy_from_slice(row);
    }
    rows
}

fn chunk(file: &mut Vec<u8>, kind: &[u8; 4], data: &[u8]) {
    file.extend((data.len() as u32).to_be_bytes());
    let start = file.len();
    file.extend(kind);
    file.extend(data);
    let sum = crc32(&file[start..]);
    file.extend(sum.to_be_bytes());
}

/// The cyclic redundancy check of PNG, annex D of its specification.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |sum: u32, byte: &u8| {
        (0..8).fold(sum ^ u32::from(*byte), |c, _| match c & 1 {
            1 => 0xedb8_8320 ^ (c >> 1),
            _ => c >> 1,
        })
    };
    !bytes.iter().fold(u32::MAX, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_is_that_of_the_specification() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
        assert_eq!(crc32(b"IEND"), 0xae42_6082);
    }

    #[test]
    fn colours_come_back() {
        let colours: Vec<u8> = (0..2 * 3 * 3).map(|i| i * 13).collect();
        let file = encode([2, 3], &colours, 254.0, "µ");
        assert_eq!(file[..8], *b"\x89PNG\r\n\x1a\n");
        let at = file.windows(4).position(|w| w == b"IDAT").unwrap();
        let length = u32::from_be_bytes(file[at - 4..at].try_into().unwrap()) as usize;
        let data = &file[at + 4..at + 4 + length];
        let rows = miniz_oxide::inflate::decompress_to_vec_zlib(data).unwrap();
        let mut back: Vec<u8> = Vec::new();
        for row in rows.chunks(7) {
            let start = back.len().checked_sub(6);
            let above: Vec<u8> = start.map_or(vec![0; 6], |s| back[s..].to_vec());
            back.extend(row[1..].iter().zip(above).map(|(a, b)| a.wrapping_add(b)));
        }
        assert_eq!(back, colours);
        assert!(
            file.windows(4).any(|w| w == 10_000u32.to_be_bytes()),
            "dots per metre"
        );
    }
}
