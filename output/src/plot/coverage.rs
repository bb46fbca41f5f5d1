//! What the curves of a panel cover, and places for words and the legend clear of them.

use super::placed::Placed;
use super::style;
use kuva::plot::legend::LegendPosition;

/// Side of the cells into which the frame is divided [px].
const CELL: f64 = 4.0;
/// Space between a point and the words above or beside it [px].
const RISE: f64 = 6.0;
/// Space between the legend and the frame, and around a legend away from the corners [px].
const INSET: f64 = 8.0;
/// Height of an entry of the legend, and what its box takes beyond entries and words [px].
const ENTRY: (f64, f64) = (16.5, 15.0);
const KEY: f64 = 40.0;
/// Where the drawing library puts the point that places a legend, from the upper left corner of its box [px].
const CORNER: (f64, f64) = (5.0, 10.0);
/// Steps in which a free place is sought [px].
const STEP: f64 = 10.0;
/// Most cells that one piece of a curve is followed through.
const FOLLOWED: usize = 2000;

/// A rectangle in the frame: left, top, right, bottom [px from the upper left corner].
type Rectangle = [f64; 4];

/// What the curves of a panel cover, cell by cell.
pub(super) struct Coverage<'a> {
    panel: &'a Placed<'a>,
    size: (f64, f64),
    columns: usize,
    rows: usize,
    covered: Vec<bool>,
}

impl<'a> Coverage<'a> {
    /// The coverage of a frame of the given size [px] by its curves.
    pub(super) fn new(panel: &'a Placed<'a>, size: (f64, f64)) -> Coverage<'a> {
        let (columns, rows) = ((size.0 / CELL).ceil() as usize, (size.1 / CELL).ceil() as usize);
        let mut coverage = Coverage { panel, size, columns, rows, covered: vec![false; columns * rows] };
        for piece in panel.panel.series.iter().flat_map(|series| panel.pieces(series)) {
            let mut last = None;
            for point in piece {
                let here = coverage.pixel(point);
                coverage.follow(last.unwrap_or(here), here);
                last = Some(here);
            }
        }
        coverage
    }

    /// A point in mapped numbers as pixels from the upper left corner.
    fn pixel(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let part = |v: f64, (lo, hi): (f64, f64)| (v - lo) / (hi - lo);
        (self.size.0 * part(x, self.panel.x.range), self.size.1 * (1.0 - part(y, self.panel.y.range)))
    }

    /// A point in pixels from the upper left corner, in mapped numbers.
    fn point(&self, (right, down): (f64, f64)) -> (f64, f64) {
        let at = |part: f64, (lo, hi): (f64, f64)| lo + part * (hi - lo);
        (at(right / self.size.0, self.panel.x.range), at(1.0 - down / self.size.1, self.panel.y.range))
    }

    /// Covers the cells along a straight line.
    fn follow(&mut self, from: (f64, f64), to: (f64, f64)) {
        let length = (to.0 - from.0).abs().max((to.1 - from.1).abs());
        let pieces = ((length / CELL).ceil() as usize).clamp(1, FOLLOWED);
        for i in 0..=pieces {
            let part = i as f64 / pieces as f64;
            let (x, y) = (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1));
            let (column, row) = ((x / CELL).floor(), (y / CELL).floor());
            if column >= 0.0 && row >= 0.0 && column < self.columns as f64 && row < self.rows as f64 {
                self.covered[row as usize * self.columns + column as usize] = true;
            }
        }
    }

    fn cells(&self, [left, top, right, bottom]: Rectangle) -> impl Iterator<Item = usize> + use<> {
        let range = |lo: f64, hi: f64, count: usize| {
            ((lo / CELL).floor().max(0.0) as usize)..((hi / CELL).ceil().max(0.0) as usize).min(count)
        };
        let (columns, rows) = (range(left, right, self.columns), range(top, bottom, self.rows));
        let width = self.columns;
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// How many cells of a rectangle are covered.
    fn count(&self, rectangle: Rectangle) -> usize {
        self.cells(rectangle).filter(|&cell| self.covered[cell]).count()
    }

    /// Places for the words of the panel, as points in mapped numbers above which they stand: each at that of its points
    /// where it covers least. Words that would overlap others everywhere, or would leave the frame, are left out.
    pub(super) fn place_words(&mut self) -> Vec<(f64, f64, &'a str)> {
        let mut taken: Vec<Rectangle> = Vec::new();
        let mut out = Vec::new();
        for words in &self.panel.panel.words {
            let (width, height) = (style::word_width(&words.text), 0.8 * f64::from(style::LEGEND_SIZE));
            let beside = if words.beside { (RISE + 0.5 * width, RISE + 0.5 * height) } else { (0.0, 0.0) };
            let places = words.points.iter().filter_map(|&(x, y)| {
                let (x, y) = self.pixel((self.panel.x.map(x)?, self.panel.y.map(y)?));
                let (x, y) = (x + beside.0, y + beside.1);
                let rectangle = [x - 0.5 * width, y - RISE - height, x + 0.5 * width, y - RISE];
                let free = self.encloses(&rectangle) && !taken.iter().any(|other| overlap(other, &rectangle));
                free.then(|| (self.count(rectangle), rectangle, self.point((x, y))))
            });
            if let Some((_, rectangle, (x, y))) = places.min_by_key(|place| place.0) {
                taken.push(rectangle);
                out.push((x, y, words.text.as_str()));
            }
        }
        for cell in taken.into_iter().flat_map(|rectangle| self.cells(rectangle)).collect::<Vec<_>>() {
            self.covered[cell] = true;
        }
        out
    }

    fn encloses(&self, [left, top, right, bottom]: &Rectangle) -> bool {
        *left >= 0.0 && *top >= 0.0 && *right <= self.size.0 && *bottom <= self.size.1
    }

    /// A place for a legend of these names: a free corner, or else any free place, or else the corner least covered.
    pub(super) fn place_legend(&self, names: &[&str]) -> LegendPosition {
        let width = KEY + names.iter().map(|name| style::word_width(name)).fold(0.0, f64::max);
        let height = ENTRY.1 + ENTRY.0 * names.len() as f64;
        let (right, bottom) = (self.size.0 - width - INSET, self.size.1 - height - INSET);
        let count = |left: f64, top: f64, around: f64| {
            self.count([left - around, top - around, left + width + around, top + height + around])
        };
        let corners = [
            (count(right, INSET, 0.0), LegendPosition::InsideTopRight),
            (count(right, bottom, 0.0), LegendPosition::InsideBottomRight),
            (count(INSET, INSET, 0.0), LegendPosition::InsideTopLeft),
            (count(INSET, bottom, 0.0), LegendPosition::InsideBottomLeft),
        ];
        let best = corners.into_iter().min_by_key(|corner| corner.0);
        let (covered, corner) = best.unwrap_or((0, LegendPosition::InsideTopRight));
        let steps = |from: f64| (1..).map(move |i| from - STEP * f64::from(i)).take_while(|s| *s >= INSET);
        let mut places = steps(right).flat_map(|left| steps(bottom).map(move |top| (left, top)));
        match places.find(|&(left, top)| covered > 0 && count(left, top, INSET) == 0) {
            Some((left, top)) => {
                let (x, y) = self.point((left + CORNER.0, top + CORNER.1));
                LegendPosition::DataCoords(x, y)
            }
            None => corner,
        }
    }
}

fn overlap(a: &Rectangle, b: &Rectangle) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}
