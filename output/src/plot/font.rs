//! The font of the figures: widths and outlines of text.
//!
//! DejaVu Sans, cut down to Latin, Greek, indices and signs; its licence is `dejavu_sans.txt`.

use ttf_parser::{Face, OutlineBuilder};

/// A place [px], y downwards.
pub(super) type Point = (f64, f64);

static DATA: &[u8] = include_bytes!("dejavu_sans.ttf");

/// Straight pieces for each curved one of an outline.
const PIECES: u8 = 5;
/// Width of a character that the font does not have [em].
const UNKNOWN: f64 = 0.6;

/// The font, read once for a figure: reading looks at its tables only.
pub(super) struct Font {
    face: Option<Face<'static>>,
}

impl Font {
    pub(super) fn new() -> Font {
        Font { face: Face::parse(DATA, 0).ok() }
    }

    /// Width of a text of the given size [px].
    pub(super) fn width(&self, text: &str, size: f64) -> f64 {
        text.chars().map(|c| self.advance(c)).sum::<f64>() * size
    }

    fn advance(&self, c: char) -> f64 {
        let advance = |face: &Face<'_>| {
            let advance = face.glyph_hor_advance(face.glyph_index(c)?)?;
            Some(f64::from(advance) / f64::from(face.units_per_em()))
        };
        self.face.as_ref().and_then(advance).unwrap_or(UNKNOWN)
    }

    /// Closed outlines of a text that begins at the origin, y downwards [px]; each character of its own.
    pub(super) fn outlines(&self, text: &str, size: f64) -> Vec<Vec<Vec<Point>>> {
        let mut right = 0.0;
        let mut out = Vec::new();
        for c in text.chars() {
            if let Some(face) = &self.face {
                let scale = size / f64::from(face.units_per_em());
                let mut outline = Outline { contours: Vec::new(), right, scale };
                if face.glyph_index(c).and_then(|glyph| face.outline_glyph(glyph, &mut outline)).is_some() {
                    out.push(outline.contours);
                }
            }
            right += self.advance(c) * size;
        }
        out
    }
}

/// The contours of a character, as they are read.
struct Outline {
    contours: Vec<Vec<Point>>,
    right: f64,
    scale: f64,
}

impl Outline {
    fn place(&self, x: f32, y: f32) -> Point {
        (self.right + self.scale * f64::from(x), -self.scale * f64::from(y))
    }

    fn add(&mut self, point: Point) {
        if let Some(contour) = self.contours.last_mut() {
            contour.push(point);
        }
    }

    /// A piece whose point at u ∈ [0, 1] is Σ weightᵢ(u) pointᵢ.
    fn bend<const N: usize>(&mut self, points: [Point; N], weights: impl Fn(f64) -> [f64; N]) {
        for i in 1..=PIECES {
            let w = weights(f64::from(i) / f64::from(PIECES));
            let sum = |of: fn(&Point) -> f64| points.iter().zip(w).map(|(p, w)| w * of(p)).sum();
            self.add((sum(|p| p.0), sum(|p| p.1)));
        }
    }

    fn last(&self) -> Point {
        self.contours.last().and_then(|contour| contour.last()).copied().unwrap_or_default()
    }
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.contours.push(vec![self.place(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.add(self.place(x, y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let points = [self.last(), self.place(x1, y1), self.place(x, y)];
        self.bend(points, |u| [(1.0 - u) * (1.0 - u), 2.0 * u * (1.0 - u), u * u]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let points = [self.last(), self.place(x1, y1), self.place(x2, y2), self.place(x, y)];
        self.bend(points, |u| {
            let v = 1.0 - u;
            [v * v * v, 3.0 * u * v * v, 3.0 * u * u * v, u * u * u]
        });
    }

    fn close(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sign_of_the_figures_is_in_the_font() {
        let font = Font::new();
        let face = font.face.as_ref().unwrap();
        let signs = "ABCxyz0189()[]{}.,:;+−=–—…·×°/%ΩωθτλΔρεκ₀₁₂₃⁰¹²³⁴⁵⁶⁷⁸⁹⁻äöüßé√∞≤≥";
        for c in signs.chars() {
            assert!(face.glyph_index(c).is_some(), "{c}");
        }
        // Advance widths of DejaVu Sans: 1303 of 2048 for digits, 1716 for the minus sign.
        assert!((font.width("0−", 2048.0) - 3019.0).abs() < 1.0, "{}", font.width("0−", 2048.0));
    }

    #[test]
    fn an_outline_lies_within_the_width_of_its_text() {
        let font = Font::new();
        let outlines = font.outlines("Tip w₂", 11.0);
        assert_eq!(outlines.len(), 5, "the blank has none");
        for (x, y) in outlines.iter().flatten().flatten() {
            assert!(
                (-1.0..=font.width("Tip w₂", 11.0) + 1.0).contains(x) && (-9.0..3.0).contains(y),
                "{x} {y}"
            );
        }
    }
}
