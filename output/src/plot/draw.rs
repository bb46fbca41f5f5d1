//! From a [`Figure`] to a [`Drawing`], and from that to SVG, PNG and PDF.

use super::axis::Resolved;
use super::font::Font;
use super::layout::{Layout, layout, lines, mark, text_at};
use super::placed::Placed;
use super::sketch::{Point, Shape};
use super::{Axis, Figure, Line, Panel, pdf, raster, style, svg};
use crate::OutputError;

/// A figure with every line in its place.
#[derive(Debug)]
pub struct Drawing {
    pub(super) size: (f64, f64),
    /// Paper, frames and lines at the ticks.
    pub(super) back: Vec<Shape>,
    /// Curves and marks.
    pub(super) curves: Vec<Shape>,
    /// Texts and legends.
    pub(super) front: Vec<Shape>,
}

impl Drawing {
    pub(super) fn shapes(&self) -> impl Iterator<Item = &Shape> {
        self.back.iter().chain(&self.curves).chain(&self.front)
    }

    /// The drawing as SVG text; fonts are named, with a generic fallback.
    pub fn svg(&self) -> String {
        svg::svg(self.size, self.shapes())
    }

    /// The drawing as the bytes of a PNG, 288 pixels to the inch.
    ///
    /// # Errors
    /// [`OutputError::Draw`] with the reason of the encoder.
    pub fn png(&self) -> Result<Vec<u8>, OutputError> {
        let draw = |reason: png::EncodingError| OutputError::Draw { reason: reason.to_string() };
        raster::png(self.size, self.shapes()).map_err(draw)
    }

    /// The drawing as the bytes of a PDF of one page, text as outlines.
    ///
    /// # Errors
    /// [`OutputError::Draw`] with the reason of the encoder.
    pub fn pdf(&self) -> Result<Vec<u8>, OutputError> {
        let draw = |reason: std::io::Error| OutputError::Draw { reason: reason.to_string() };
        pdf::pdf(self.size, self.shapes()).map_err(draw)
    }
}

impl Figure {
    /// Decides ranges, ticks and places, and draws. Never fails: what cannot be shown (values that
    /// are not finite, or not positive on a logarithmic axis) is left out.
    pub fn draw(&self) -> Drawing {
        let columns = self.columns.clamp(1, self.panels.len().max(1));
        self.drawing(columns, style::PANEL_WIDTH[usize::from(columns > 1)])
    }

    /// Draws as [`draw`](Figure::draw), with the same text, in a width in mm: panels stand in one column where there is not room
    /// for more. A width that has not room for one is exceeded.
    pub fn draw_in(&self, width: f64) -> Drawing {
        let width = width * style::PIXELS_A_MILLIMETRE;
        let mut columns = self.columns.clamp(1, self.panels.len().max(1));
        loop {
            let mut frame = style::PANEL_WIDTH[usize::from(columns > 1)];
            // What stands beside a frame may change with its width.
            for _ in 0..3 {
                frame += (width - self.drawing(columns, frame).size.0) / columns as f64;
                frame = frame.max(style::NARROWEST);
            }
            if columns == 1 || frame > style::NARROWEST {
                return self.drawing(columns, frame);
            }
            columns -= 1;
        }
    }

    /// The drawing with so many panels in a row, whose frames have the given width [px].
    fn drawing(&self, columns: usize, frame: f64) -> Drawing {
        let font = Font::new();
        let placed = self.place(columns, frame);
        let laid: Vec<Layout> = placed
            .iter()
            .enumerate()
            .map(|(i, p)| {
                let letter = if placed.len() > 1 { format!("({})", letter(i)) } else { String::new() };
                layout(p, &letter, &font)
            })
            .collect();
        let margins = Margins::new(&placed, &laid, columns, &font);
        let width = margins.width(&placed);
        let mut drawing =
            Drawing { size: (width, 0.0), back: Vec::new(), curves: Vec::new(), front: Vec::new() };
        let mut top = style::PADDING;
        for title in self.title.iter().flat_map(|title| lines(title, width - 2.0 * style::PADDING, &font)) {
            drawing.front.push(text_at((0.5 * width, top + style::ASCENT), &title, 0.5, style::INK));
            top += style::LINE;
        }
        top += if self.title.is_some() { 4.0 } else { 0.0 };
        for (row, panels) in placed.chunks(columns).enumerate() {
            top += margins.above[row];
            let mut left = style::PADDING;
            for (column, p) in panels.iter().enumerate() {
                left += margins.left[column];
                drawing.panel(p, (left, top), &font);
                let shapes = laid[row * columns + column].shapes.iter().cloned();
                drawing.front.extend(shapes.map(|shape| moved(shape, (left, top))));
                left += p.size.0 + margins.right[column] + style::SPACING;
            }
            top += panels.first().map_or(0.0, |p| p.size.1) + margins.below[row];
        }
        drawing.size.1 = top + style::PADDING;
        drawing
    }

    fn place(&self, columns: usize, width: f64) -> Vec<Placed<'_>> {
        let rows = self.panels.len().div_ceil(columns).max(1);
        // Many words beside a frame need its height.
        let beside = |panel: &Panel| panel.words.iter().filter(|words| words.outside).count();
        let words = self.panels.iter().map(beside).max().unwrap_or(0);
        let height = style::PANEL_HEIGHT[(rows - 1).min(2)].max(1.25 * style::LINE * words as f64);
        let size = (width, height);
        let place = |i: usize| {
            let panel = &self.panels[i];
            let own = std::slice::from_ref(panel);
            let shown = if self.share_x { &self.panels[..] } else { own };
            let [x, y] = axes(panel, size);
            let x = Resolved::new(&x, points(shown).map(|p| p.0), 5);
            // The range across is that of what is shown along.
            let shown =
                |p: &&(f64, f64)| panel.x.range.is_none_or(|(a, b)| (a.min(b)..=a.max(b)).contains(&p.0));
            let y = Resolved::new(&y, points(own).filter(shown).map(|p| p.1), 5);
            let x_labelled = !self.share_x || i + columns >= self.panels.len();
            Placed { panel, x, y, x_labelled, size }
        };
        (0..self.panels.len()).map(place).collect()
    }
}

/// The axes of a panel with a frame of this size, with one scale where it is to have that.
fn axes(panel: &Panel, (width, height): Point) -> [Axis; 2] {
    let (mut x, mut y) = (panel.x.clone(), panel.y.clone());
    if let (true, Some(along), Some(across)) = (panel.equal, x.range, y.range) {
        let scale = ((along.1 - along.0) / width).max((across.1 - across.0) / height);
        let grown = |(lo, hi): (f64, f64), size: f64| {
            let (middle, half) = (0.5 * (lo + hi), 0.5 * scale * size);
            Some((middle - half, middle + half))
        };
        (x.range, y.range) = (grown(along, width), grown(across, height));
    }
    [x, y]
}

fn points(panels: &[Panel]) -> impl Iterator<Item = &(f64, f64)> {
    panels.iter().flat_map(|panel| &panel.series).flat_map(|series| &series.points)
}

/// Space around the frames [px], the same for all panels of a row or column so that frames align.
struct Margins {
    left: Vec<f64>,
    right: Vec<f64>,
    above: Vec<f64>,
    below: Vec<f64>,
}

impl Margins {
    fn new(placed: &[Placed<'_>], laid: &[Layout], columns: usize, font: &Font) -> Margins {
        let widest = |axis: &Resolved| {
            let width = |s: &f64| font.width(&axis.tick(*s), style::FONT);
            axis.ticks().iter().map(width).fold(0.0, f64::max)
        };
        let left = |p: &Placed<'_>| {
            let label = lines(&p.y.label, p.size.1, font).len() as f64;
            widest(&p.y) + 4.0 + label * style::LINE + 4.0
        };
        let below = |p: &Placed<'_>| {
            let label = lines(&p.x.label, p.size.0, font).len() as f64;
            if p.x_labelled { 7.0 + style::LINE + label * style::LINE } else { 4.0 }
        };
        let right = |(p, laid): (&Placed<'_>, &Layout)| laid.right.max(0.5 * widest(&p.x)).max(2.0);
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let both = || placed.iter().zip(laid);
        Margins {
            left: (0..columns)
                .map(|i| largest(&mut placed.iter().skip(i).step_by(columns).map(left)))
                .collect(),
            right: (0..columns).map(|i| largest(&mut both().skip(i).step_by(columns).map(right))).collect(),
            above: laid
                .chunks(columns)
                .map(|row| largest(&mut row.iter().map(|laid| laid.above.max(style::SPACING / 2.0))))
                .collect(),
            below: placed.chunks(columns).map(|row| largest(&mut row.iter().map(below))).collect(),
        }
    }

    fn width(&self, placed: &[Placed<'_>]) -> f64 {
        let frame = placed.first().map_or(0.0, |p| p.size.0);
        let columns = self.left.iter().zip(&self.right).map(|(left, right)| left + frame + right);
        2.0 * style::PADDING + columns.sum::<f64>() + style::SPACING * (self.left.len() as f64 - 1.0)
    }
}

impl Drawing {
    /// Draws axes, curves and marks of a panel whose frame begins at a place.
    fn panel(&mut self, p: &Placed<'_>, (left, top): Point, font: &Font) {
        let (right, bottom) = (left + p.size.0, top + p.size.1);
        let part = |s: f64, (lo, hi): (f64, f64)| (s - lo) / (hi - lo);
        let frame = |from, to| Shape::line(from, to, style::INK, style::FRAME_WIDTH);
        let grid = |from, to| Shape::line(from, to, style::GRID, style::GRID_WIDTH);
        let middle = 0.5 * (style::ASCENT - style::DESCENT);
        let mut ticks = Vec::new();
        for s in p.x.ticks() {
            let x = left + p.size.0 * part(s, p.x.range);
            self.back.push(grid((x, top), (x, bottom)));
            ticks.push(frame((x, bottom), (x, bottom - style::TICK)));
            if p.x_labelled {
                // Below a number beside the lowest tick.
                let at = (x, bottom + 6.0 + style::ASCENT);
                self.front.push(text_at(at, &p.x.tick(s), 0.5, style::INK));
            }
        }
        let mut widest: f64 = 0.0;
        for s in p.y.ticks() {
            let y = bottom - p.size.1 * part(s, p.y.range);
            self.back.push(grid((left, y), (right, y)));
            ticks.push(frame((left, y), (left + style::TICK, y)));
            let text = p.y.tick(s);
            widest = widest.max(font.width(&text, style::FONT));
            self.front.push(text_at((left - 4.0, y + middle), &text, 1.0, style::INK));
        }
        self.back.append(&mut ticks);
        let corners = vec![(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
        self.back.push(Shape::Line {
            points: corners,
            ink: style::INK,
            width: style::FRAME_WIDTH,
            dash: &[],
        });
        if p.x_labelled {
            for (i, line) in lines(&p.x.label, p.size.0, font).iter().enumerate() {
                let y = bottom + 7.0 + style::ASCENT + style::LINE * (i + 1) as f64;
                self.front.push(text_at((left + 0.5 * p.size.0, y), line, 0.5, style::INK));
            }
        }
        let label = lines(&p.y.label, p.size.1, font);
        for (i, line) in label.iter().rev().enumerate() {
            let x = left - 8.0 - widest - style::DESCENT - style::LINE * i as f64;
            let at = (x, top + 0.5 * p.size.1);
            let text = line.clone();
            self.front.push(Shape::Text { at, text, anchor: 0.5, upright: true, ink: style::INK });
        }
        for (number, series) in p.panel.series.iter().enumerate() {
            let ink = style::TINT + series.ink(number);
            let moved = |(x, y): Point| (left + x, top + y);
            let areas = p.bands(series).into_iter();
            self.curves.extend(
                areas.map(|points| Shape::Area { points: points.into_iter().map(moved).collect(), ink }),
            );
        }
        for (number, series) in p.panel.series.iter().enumerate() {
            let (ink, dash) = (series.ink(number), style::dash(series.line));
            let place = |(x, y): Point| (left + x, top + y);
            let strokes = if series.line == Line::None { Vec::new() } else { p.strokes(series) };
            for stroke in strokes {
                let points = stroke.into_iter().map(place).collect();
                self.curves.push(Shape::Line { points, ink, width: style::LINE_WIDTH, dash });
            }
            if let Some(marker) = series.marker {
                let marks = p.marks(series).into_iter();
                self.curves.extend(marks.flat_map(|point| mark(marker, place(point), ink)));
            }
        }
    }
}

/// A shape moved by a distance.
fn moved(mut shape: Shape, by: Point) -> Shape {
    let points = match &mut shape {
        Shape::Line { points, .. } | Shape::Area { points, .. } => points.as_mut_slice(),
        Shape::Text { at, .. } => std::slice::from_mut(at),
    };
    points.iter_mut().for_each(|(x, y)| (*x, *y) = (*x + by.0, *y + by.1));
    shape
}

/// a, b, … z, then a again.
fn letter(i: usize) -> char {
    char::from(b'a' + (i % 26) as u8)
}
