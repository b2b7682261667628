//! Figures as HTML: what is read, and the exact value beside it for whoever wants to compute with it.

use crate::text::number;

/// A text that may stand anywhere in HTML, also within quotes.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
        .replace('\'', "&#39;")
}

/// JSON that may stand in a script element: nothing in it can end the element or begin a comment.
pub fn in_script(json: &str) -> String {
    json.replace('<', "\\u003c")
        .replace('>', "\\u003e")
        .replace('&', "\\u0026")
}

/// A value with its unit, in thousands or thousandths of it where that reads better. The exact value,
/// in the unit given, is in the attribute `value`.
pub fn figure(x: f64, unit: &str) -> String {
    let (scale, prefix) = prefix(x, unit);
    let (shown, unit) = (number(x / scale), format!("{prefix}{}", raised(unit)));
    let unit = if unit.is_empty() {
        unit
    } else {
        format!("\u{a0}{unit}")
    };
    format!(
        "<data value=\"{x:?}\" data-scale=\"{scale:?}\">{}</data>{unit}",
        powers(&shown)
    )
}

/// A number of things.
pub fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(c);
    }
    format!("<data value=\"{n}\">{text}</data>")
}

/// A part of a whole in percent.
pub fn percent(share: f64) -> String {
    format!(
        "<data value=\"{share:?}\" data-scale=\"0.01\">{}</data>\u{a0}%",
        powers(&number(100.0 * share))
    )
}

/// A place, m.
pub fn place(point: [f64; 3]) -> String {
    format!("({})\u{a0}m", point.map(|x| powers(&three(x))).join(", "))
}

/// Three digits are enough for a place.
fn three(x: f64) -> String {
    let x: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    if x.abs() < 1e-9 {
        "0".to_owned()
    } else {
        number(x)
    }
}

fn prefix(x: f64, unit: &str) -> (f64, &'static str) {
    match (unit, x.abs()) {
        ("Pa" | "N" | "J", x) if x >= 1e9 => (1e9, "G"),
        ("Pa" | "N" | "J", x) if x >= 1e6 => (1e6, "M"),
        ("Pa" | "N" | "J", x) if x >= 1e3 => (1e3, "k"),
        ("m" | "s" | "J" | "N", x) if x > 0.0 && x < 0.1 => (1e-3, "m"),
        _ => (1.0, ""),
    }
}

/// `m3` as m³, `m/s2` as m/s².
pub fn raised(unit: &str) -> String {
    unit.replace('3', "³").replace('2', "²")
}

/// Exponents as people write them, and minus signs as long as plus signs.
fn powers(number: &str) -> String {
    let number = match number.split_once('e') {
        Some((digits, power)) => format!("{digits}·10<sup>{power}</sup>"),
        None => number.to_owned(),
    };
    number.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_read_well_and_keep_their_value() {
        let shown = |x, unit| {
            let html = figure(x, unit);
            let (_, text) = html.split_once('>').unwrap();
            text.replace("</data>", "")
        };
        assert_eq!(shown(12345.0, "Pa"), "12.35\u{a0}kPa");
        assert_eq!(shown(-0.0068, "m"), "\u{2212}6.8\u{a0}mm");
        assert_eq!(shown(2.0, "m3"), "2\u{a0}m³");
        assert_eq!(shown(3e-12, ""), "3.000·10<sup>\u{2212}12</sup>");
        assert_eq!(shown(0.0, "m"), "0\u{a0}m");
        assert!(figure(0.1 + 0.2, "s").contains("value=\"0.30000000000000004\""));
        assert!(percent(0.0486).contains("data-scale=\"0.01\">4.86<"));
        assert!(count(1_234_567).ends_with(">1,234,567</data>"));
        assert_eq!(place([1.23456, -2e-17, 30.0]), "(1.23, 0, 30)\u{a0}m");
    }

    #[test]
    fn nothing_gets_out_of_a_text() {
        let text = "</script><img onerror=\"alert('x')\">&";
        assert!(!escape(text).contains(['<', '>', '"', '\'']));
        let json = in_script(&serde_json::to_string(text).unwrap());
        assert!(!json.contains(['<', '>', '&']));
        assert_eq!(serde_json::from_str::<String>(&json).unwrap(), text);
    }
}
