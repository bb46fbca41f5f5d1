//! A drawing as pixels.
//!
//! A pixel is an entry of a palette: white, or a colour in one of a number of tints. A file of them is a third of one with
//! red, green and blue, and so is the time to fill and to compress it. Where two colours meet in a pixel, the one that covers
//! more of it is kept.

use super::dash::dashes;
use super::font::Font;
use super::sketch::{Point, Shape};
use super::style;
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter, PixelDimensions, Unit};

/// Tints of a colour between white and itself.
const TINTS: u8 = 24;
/// Rows into which one of pixels is divided to find how much of a pixel an area covers.
const ROWS: usize = 4;
/// Pixels of the drawing in a metre: 96 to the inch.
const METRE: f64 = 96.0 / 0.0254;

/// The bytes of a PNG file of a drawing of the given size [px].
///
/// # Errors
/// Those of the encoder.
pub(super) fn png<'a>(
    size: (f64, f64),
    shapes: impl Iterator<Item = &'a Shape>,
) -> Result<Vec<u8>, EncodingError> {
    let pixels = |length: f64| (length * style::PNG_SCALE).ceil().max(1.0) as usize;
    let (width, height) = (pixels(size.0), pixels(size.1));
    let mut raster =
        Raster { width, height, pixels: vec![0; width * height], covered: vec![0; width * height] };
    let font = Font::new();
    for shape in shapes {
        match shape {
            Shape::Line { points, ink, width, dash: [] } => {
                raster.line(&scaled(points), width * style::PNG_SCALE, *ink);
            }
            Shape::Line { points, ink, width, dash } => {
                for dash in dashes(points, dash) {
                    raster.line(&scaled(&dash), width * style::PNG_SCALE, *ink);
                }
            }
            Shape::Area { points, ink } => raster.fill(&[scaled(points)], *ink),
            Shape::Text { ink, .. } => {
                for character in shape.outlines(&font) {
                    let contours: Vec<Vec<Point>> = character.iter().map(|c| scaled(c)).collect();
                    raster.fill(&contours, *ink);
                }
            }
        }
    }
    let mut out = Vec::new();
    let mut encoder = Encoder::new(&mut out, width as u32, height as u32);
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_palette(palette());
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::NoFilter);
    let density = (METRE * style::PNG_SCALE).round() as u32;
    encoder.set_pixel_dims(Some(PixelDimensions { xppu: density, yppu: density, unit: Unit::Meter }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&raster.pixels)?;
    writer.finish()?;
    Ok(out)
}

/// The place of an ink in the palette: those of text and grid first, for small numbers take fewer bits.
fn place(ink: usize) -> u8 {
    ((ink + style::WHITE - style::INK) % style::WHITE) as u8
}

/// White and the tints of all colours but white.
fn palette() -> Vec<u8> {
    let mut out = vec![255; 3];
    let mut inks: Vec<usize> = (0..style::WHITE).collect();
    inks.sort_by_key(|ink| place(*ink));
    for color in inks.into_iter().map(|ink| style::INKS[ink]) {
        for tint in 1..=TINTS {
            let part = f64::from(tint) / f64::from(TINTS);
            out.extend(color.map(|c| (255.0 - part * (255.0 - f64::from(c))).round() as u8));
        }
    }
    out
}

fn scaled(points: &[Point]) -> Vec<Point> {
    points.iter().map(|(x, y)| (x * style::PNG_SCALE, y * style::PNG_SCALE)).collect()
}

struct Raster {
    width: usize,
    height: usize,
    /// 0 for white, else 1 + ink · [`TINTS`] + (tint − 1), with the inks in the order of [`place`].
    pixels: Vec<u8>,
    /// How much of a pixel the line that is being drawn covers, 0 … 255; all zero in between.
    covered: Vec<u8>,
}

impl Raster {
    /// Whole pixels of [from, to) that are in the drawing.
    fn range(from: f64, to: f64, count: usize) -> std::ops::Range<usize> {
        (from.floor().max(0.0) as usize)..(to.ceil().max(0.0) as usize).min(count)
    }

    fn blend(pixel: &mut u8, ink: usize, part: f64) {
        let (ink, part) =
            if ink < style::TINT { (ink, part) } else { (ink - style::TINT, style::TINTED * part) };
        let tint = (part * f64::from(TINTS)).round().min(f64::from(TINTS)) as u8;
        if tint == 0 {
            return;
        }
        let new = |tint: u8| 1 + place(ink) * TINTS + (tint - 1);
        let (old_place, old) = match pixel.checked_sub(1) {
            None => (place(ink), 0),
            Some(index) => (index / TINTS, index % TINTS + 1),
        };
        if ink == style::WHITE {
            *pixel = if 2 * tint >= TINTS { 0 } else { *pixel };
        } else if old_place == place(ink) {
            *pixel = new(tint.max(old));
        } else if tint >= old.min(TINTS / 2) {
            *pixel = new(tint);
        }
    }

    /// A line with round ends: a pixel is covered by its distance from the nearest piece.
    fn line(&mut self, points: &[Point], width: f64, ink: usize) {
        let reach = 0.5 * width + 0.5;
        let (mut top, mut bottom) = (self.height, 0);
        let (mut left, mut right) = (self.width, 0);
        for (a, b) in points.iter().zip(points.iter().skip(1)) {
            let (dx, dy) = (b.0 - a.0, b.1 - a.1);
            let square = dx * dx + dy * dy;
            for row in Self::range(a.1.min(b.1) - reach, a.1.max(b.1) + reach, self.height) {
                (top, bottom) = (top.min(row), bottom.max(row + 1));
                let y = row as f64 + 0.5;
                // The part of the piece within reach of this row.
                let at = |y: f64| ((y - a.1) / dy).clamp(0.0, 1.0);
                let (u, v) = if dy.abs() < 1e-9 {
                    (0.0, 1.0)
                } else {
                    (at(y - reach * dy.signum()), at(y + reach * dy.signum()))
                };
                let (from, to) = (a.0 + u * dx, a.0 + v * dx);
                let columns = Self::range(from.min(to) - reach, from.max(to) + reach, self.width);
                (left, right) = (left.min(columns.start), right.max(columns.end));
                for column in columns {
                    let x = column as f64 + 0.5;
                    let along = ((x - a.0) * dx + (y - a.1) * dy) / square.max(f64::MIN_POSITIVE);
                    let along = along.clamp(0.0, 1.0);
                    let (rx, ry) = (x - a.0 - along * dx, y - a.1 - along * dy);
                    let part = (reach - (rx * rx + ry * ry).sqrt()).clamp(0.0, 1.0);
                    let covered = &mut self.covered[row * self.width + column];
                    *covered = (*covered).max((255.0 * part) as u8);
                }
            }
        }
        for row in top..bottom {
            let columns = row * self.width + left..row * self.width + right.max(left);
            for (pixel, covered) in self.pixels[columns.clone()].iter_mut().zip(&mut self.covered[columns]) {
                if *covered > 0 {
                    Self::blend(pixel, ink, f64::from(*covered) / 255.0);
                    *covered = 0;
                }
            }
        }
    }

    /// The area within contours that are wound about a point in total.
    fn fill(&mut self, contours: &[Vec<Point>], ink: usize) {
        let all = || contours.iter().flatten();
        let bounds = |of: fn(&Point) -> f64| {
            all().map(of).fold((f64::MAX, f64::MIN), |(lo, hi), x| (lo.min(x), hi.max(x)))
        };
        let ((left, right), (top, bottom)) = (bounds(|p| p.0), bounds(|p| p.1));
        let columns = Self::range(left, right, self.width);
        let rows = Self::range(top, bottom, self.height);
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        // Where the contours cross the middle of each part of a row, and in which direction.
        let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); ROWS * rows.len()];
        let first = (ROWS * rows.start) as f64 + 0.5;
        for contour in contours {
            for (a, b) in contour.iter().zip(contour.iter().cycle().skip(1)) {
                let (low, high) = if a.1 < b.1 { (a, b) } else { (b, a) };
                let number = |y: f64| (y * ROWS as f64 - first).ceil().max(0.0) as usize;
                for part in number(low.1)..number(high.1).min(crossings.len()) {
                    let y = (part as f64 + first) / ROWS as f64;
                    let x = low.0 + (high.0 - low.0) * (y - low.1) / (high.1 - low.1);
                    crossings[part].push((x, if a.1 < b.1 { 1 } else { -1 }));
                }
            }
        }
        let mut sums = vec![0.0; columns.len()];
        for (row, parts) in rows.zip(crossings.chunks_mut(ROWS)) {
            sums.fill(0.0);
            for part in parts {
                part.sort_by(|a, b| a.0.total_cmp(&b.0));
                let mut winding = 0;
                for (from, to) in part.iter().zip(part.iter().skip(1)) {
                    winding += from.1;
                    if winding != 0 {
                        for column in Self::range(from.0, to.0, columns.end) {
                            let x = column as f64;
                            let within = to.0.min(x + 1.0) - from.0.max(x);
                            if let Some(sum) = column.checked_sub(columns.start).and_then(|i| sums.get_mut(i))
                            {
                                *sum += within / ROWS as f64;
                            }
                        }
                    }
                }
            }
            let start = row * self.width + columns.start;
            for (pixel, part) in self.pixels[start..].iter_mut().zip(&sums) {
                Self::blend(pixel, ink, *part);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn raster(width: usize, height: usize) -> Raster {
        Raster { width, height, pixels: vec![0; width * height], covered: vec![0; width * height] }
    }

    /// Parts of the pixels covered, summed: an area.
    fn area(raster: &Raster) -> f64 {
        let tint = |pixel: &u8| pixel.checked_sub(1).map_or(0, |i| i % TINTS + 1);
        raster.pixels.iter().map(|pixel| f64::from(tint(pixel)) / f64::from(TINTS)).sum()
    }

    #[test]
    fn an_area_covers_what_its_size_says_and_a_hole_nothing() {
        let square = |a: f64, b: f64| vec![(a, a), (b, a), (b, b), (a, b)];
        let mut filled = raster(40, 40);
        filled.fill(&[square(3.25, 33.25)], 0);
        assert!((area(&filled) - 900.0).abs() < 5.0, "{}", area(&filled));
        let mut holed = raster(40, 40);
        holed.fill(&[square(3.0, 33.0), square(10.0, 20.0).into_iter().rev().collect()], 0);
        assert!((area(&holed) - 800.0).abs() < 1e-9, "{}", area(&holed));
        holed.fill(&[square(0.0, 40.0)], style::WHITE);
        assert_eq!(area(&holed), 0.0);
    }

    #[test]
    fn a_line_covers_its_length_times_its_width_in_every_direction() {
        for (dx, dy) in [(60.0, 0.0), (0.0, 60.0), (48.0, 36.0), (-36.0, 48.0), (-1.0, 60.0)] {
            let mut drawn = raster(160, 160);
            drawn.line(&[(80.2, 80.4), (80.2 + dx, 80.4 + dy)], 4.0, 1);
            let exact = 4.0 * f64::hypot(dx, dy) + std::f64::consts::PI * 4.0;
            assert!((area(&drawn) / exact - 1.0).abs() < 0.03, "{dx} {dy}: {} {exact}", area(&drawn));
        }
    }

    #[test]
    fn what_lies_outside_is_left_out() {
        let mut drawn = raster(10, 10);
        drawn.line(&[(-50.0, 5.0), (50.0, 5.0)], 2.0, 0);
        drawn.fill(&[vec![(-5.0, -5.0), (20.0, -5.0), (20.0, 2.0), (-5.0, 2.0)]], 1);
        assert!((area(&drawn) - 40.0).abs() < 1.0, "{}", area(&drawn));
    }
}
