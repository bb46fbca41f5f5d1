//! A drawing as a PDF of one page (ISO 32000-1), its text as outlines: no font has to be there, or embedded.

use super::font::Font;
use super::sketch::{Point, Shape};
use super::style;
use flate2::{Compression, write::ZlibEncoder};
use std::fmt::Write as _;
use std::io::{self, Write as _};

/// Points (1/72 inch) for each pixel (1/96 inch).
const POINTS: f64 = 0.75;

/// The bytes of a PDF file of the given size [px], the shapes one over the other.
///
/// # Errors
/// None in practice: it is written to memory.
pub(super) fn pdf<'a>(
    (width, height): (f64, f64),
    shapes: impl Iterator<Item = &'a Shape>,
) -> io::Result<Vec<u8>> {
    let mut content = ZlibEncoder::new(Vec::new(), Compression::default());
    content.write_all(page(height, shapes).as_bytes())?;
    let content = content.finish()?;
    let dictionary = format!("<< /Length {} /Filter /FlateDecode >>\nstream\n", content.len());
    let media = format!("[0 0 {:.2} {:.2}]", POINTS * width, POINTS * height);
    let objects: [Vec<u8>; 4] = [
        b"<< /Type /Catalog /Pages 2 0 R >>".to_vec(),
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>".to_vec(),
        format!("<< /Type /Page /Parent 2 0 R /MediaBox {media} /Resources << >> /Contents 4 0 R >>").into(),
        [dictionary.as_bytes(), content.as_slice(), b"\nendstream"].concat(),
    ];
    let mut out = b"%PDF-1.4\n%\xE2\xE3\xCF\xD3\n".to_vec();
    let mut places = Vec::new();
    for (number, object) in (1..).zip(&objects) {
        places.push(out.len());
        writeln!(out, "{number} 0 obj")?;
        out.write_all(object)?;
        out.write_all(b"\nendobj\n")?;
    }
    let table = out.len();
    let count = objects.len() + 1;
    write!(out, "xref\n0 {count}\n0000000000 65535 f \n")?;
    places.iter().try_for_each(|place| writeln!(out, "{place:010} 00000 n "))?;
    write!(out, "trailer\n<< /Size {count} /Root 1 0 R >>\nstartxref\n{table}\n%%EOF\n")?;
    Ok(out)
}

/// The operators that draw the shapes, y downwards.
fn page<'a>(height: f64, shapes: impl Iterator<Item = &'a Shape>) -> String {
    let font = Font::new();
    let mut out = format!("{POINTS} 0 0 -{POINTS} 0 {:.2} cm 1 j\n", POINTS * height);
    for shape in shapes {
        let _ = match shape {
            Shape::Line { points, ink, width, dash } => {
                // Numbers of an array are parted by spaces.
                let dash = dash.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
                let _ = writeln!(out, "{} RG {width} w [{dash}] 0 d", color(*ink));
                path(&mut out, points);
                writeln!(out, "S")
            }
            Shape::Area { points, ink } => {
                let _ = writeln!(out, "{} rg", color(*ink));
                path(&mut out, points);
                writeln!(out, "h f")
            }
            Shape::Text { ink, .. } => {
                let _ = writeln!(out, "{} rg", color(*ink));
                for contour in shape.outlines(&font).iter().flatten() {
                    path(&mut out, contour);
                    let _ = writeln!(out, "h");
                }
                writeln!(out, "f")
            }
        };
    }
    out
}

fn path(out: &mut String, points: &[Point]) {
    for (i, (x, y)) in points.iter().enumerate() {
        let _ = write!(out, "{x:.2} {y:.2} {} ", if i == 0 { 'm' } else { 'l' });
    }
}

fn color(ink: usize) -> String {
    let [r, g, b] = style::color(ink).map(|c| f64::from(c) / 255.0);
    format!("{r:.3} {g:.3} {b:.3}")
}
