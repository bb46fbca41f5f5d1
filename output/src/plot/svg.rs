//! A drawing as SVG.

use super::sketch::{Point, Shape};
use super::style;
use std::fmt::Write as _;

/// The text of an SVG file of the given size [px], the shapes one over the other.
pub(super) fn svg<'a>(size: (f64, f64), shapes: impl Iterator<Item = &'a Shape>) -> String {
    let (w, h) = (number(size.0), number(size.1));
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
         font-family=\"{}\" font-size=\"{}\">\n<rect width=\"{w}\" height=\"{h}\" fill=\"#FFFFFF\"/>\n",
        style::FONTS,
        style::FONT,
    );
    for shape in shapes {
        let _ = match shape {
            Shape::Line { points, ink, width, dash } => {
                let lengths: Vec<String> = dash.iter().map(|length| number(*length)).collect();
                let dash = match lengths.as_slice() {
                    [] => String::new(),
                    lengths => format!(" stroke-dasharray=\"{}\"", lengths.join(" ")),
                };
                writeln!(
                    out,
                    "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"{dash}/>",
                    list(points),
                    color(*ink)
                )
            }
            Shape::Area { points, ink } => {
                writeln!(out, "<polygon points=\"{}\" fill=\"{}\"/>", list(points), color(*ink))
            }
            Shape::Text { at, text, anchor, upright, ink } => {
                let (x, y) = (number(at.0), number(at.1));
                let turn =
                    if *upright { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
                let anchor = match anchor {
                    0.0 => "start",
                    1.0 => "end",
                    _ => "middle",
                };
                let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
                let ink = color(*ink);
                writeln!(
                    out,
                    "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" fill=\"{ink}\"{turn}>{text}</text>"
                )
            }
        };
    }
    out.push_str("</svg>\n");
    out
}

fn color(ink: usize) -> String {
    let [r, g, b] = style::color(ink);
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// To a hundredth of a pixel.
fn number(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn list(points: &[Point]) -> String {
    let mut out = String::with_capacity(12 * points.len());
    for (i, (x, y)) in points.iter().enumerate() {
        let blank = if i == 0 { "" } else { " " };
        let _ = write!(out, "{blank}{x:.2},{y:.2}");
    }
    out
}
