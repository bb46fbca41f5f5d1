//! Where a panel has room: the places of words and of the legend.

use super::draw::Placed;
use super::{Words, style};
use kuva::plot::legend::LegendPosition;

/// Side of the cells in which the frame is looked at [px].
const CELL: f64 = 4.0;
/// Space between a point and the words above or beside it [px].
const RISE: f64 = 6.0;
/// Space between the legend and the frame, and around a legend that stands free [px].
const INSET: f64 = 8.0;
/// Height of an entry of the legend, and what its box takes beyond entries and words [px].
const ENTRY: (f64, f64) = (16.5, 15.0);
const KEY: f64 = 40.0;
/// Where the drawing library puts the point that places a legend, from the upper left corner of its box [px].
const CORNER: (f64, f64) = (5.0, 10.0);
/// Steps in which a free place is looked for [px].
const STEP: f64 = 10.0;
/// Most cells that one piece of a curve is followed through.
const FOLLOWED: usize = 2000;

/// A rectangle in the frame: left, top, right, bottom [px from the upper left corner].
type Rectangle = [f64; 4];

/// Words in their place: x and y of the point above which they stand, in mapped numbers.
pub(super) type PlacedWords<'a> = (f64, f64, &'a str);

/// What the curves of a panel cover, cell by cell.
#[derive(Debug)]
pub(super) struct Room {
    size: (f64, f64),
    columns: usize,
    rows: usize,
    covered: Vec<bool>,
}

impl Room {
    /// The room in a frame of the given size [px] beside its curves.
    pub(super) fn new(p: &Placed<'_>, size: (f64, f64)) -> Room {
        let (columns, rows) = ((size.0 / CELL).ceil() as usize, (size.1 / CELL).ceil() as usize);
        let mut room = Room { size, columns, rows, covered: vec![false; columns * rows] };
        for piece in p.panel.series.iter().flat_map(|series| p.pieces(series)) {
            let mut last = None;
            for point in piece {
                let here = room.pixel(p, point);
                room.follow(last.unwrap_or(here), here);
                last = Some(here);
            }
        }
        room
    }

    /// A point in mapped numbers as pixels from the upper left corner.
    fn pixel(&self, p: &Placed<'_>, (x, y): (f64, f64)) -> (f64, f64) {
        let part = |v: f64, (lo, hi): (f64, f64)| (v - lo) / (hi - lo);
        (self.size.0 * part(x, p.x.range), self.size.1 * (1.0 - part(y, p.y.range)))
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
    fn crowd(&self, rectangle: Rectangle) -> usize {
        self.cells(rectangle).filter(|&cell| self.covered[cell]).count()
    }

    /// Places words, each at the first of its points where it is clear of curves, or else at that where it covers least;
    /// words that would overlap others everywhere, or would leave the frame, are left out. Covers their places.
    pub(super) fn words<'a>(&mut self, p: &Placed<'a>) -> Vec<PlacedWords<'a>> {
        let mut taken: Vec<Rectangle> = Vec::new();
        let mut out = Vec::new();
        for words in &p.panel.words {
            let mut best: Option<(usize, Rectangle, PlacedWords<'a>)> = None;
            for &(x, y) in &words.points {
                let Some((x, y)) = p.x.map(x).zip(p.y.map(y)) else { continue };
                let Some((rectangle, x, y)) = self.rectangle(p, words, (x, y)) else { continue };
                if taken.iter().any(|other| overlap(other, &rectangle)) {
                    continue;
                }
                let crowd = self.crowd(rectangle);
                if best.as_ref().is_none_or(|best| crowd < best.0) {
                    best = Some((crowd, rectangle, (x, y, &words.text)));
                }
            }
            if let Some((_, rectangle, place)) = best {
                taken.push(rectangle);
                out.push(place);
            }
        }
        for cell in taken.into_iter().flat_map(|rectangle| self.cells(rectangle)).collect::<Vec<_>>() {
            self.covered[cell] = true;
        }
        out
    }

    /// The rectangle that words take at a point, and the point above which they are to be written: `None` where they
    /// would leave the frame.
    fn rectangle(&self, p: &Placed<'_>, words: &Words, point: (f64, f64)) -> Option<(Rectangle, f64, f64)> {
        let (width, height) = (style::word_width(&words.text), 0.8 * f64::from(style::LEGEND_SIZE));
        // The foot of the words, which stand above the point that is handed on.
        let (right, down) = if words.beside { (RISE + 0.5 * width, RISE + 0.5 * height) } else { (0.0, 0.0) };
        let place = self.moved(p, point, right, down);
        let (x, y) = self.pixel(p, place);
        let rectangle = [x - 0.5 * width, y - RISE - height, x + 0.5 * width, y - RISE];
        let [left, top, right, bottom] = rectangle;
        let inside = left >= 0.0 && top >= 0.0 && right <= self.size.0 && bottom <= self.size.1;
        inside.then_some((rectangle, place.0, place.1))
    }

    /// A point in mapped numbers, moved by pixels.
    fn moved(&self, p: &Placed<'_>, (x, y): (f64, f64), right: f64, down: f64) -> (f64, f64) {
        let unit = |(lo, hi): (f64, f64), pixels: f64| (hi - lo) / pixels;
        (x + right * unit(p.x.range, self.size.0), y - down * unit(p.y.range, self.size.1))
    }

    /// A place for a legend of these names: a corner that is free, or else any free place, or else the emptiest corner.
    pub(super) fn legend(&self, p: &Placed<'_>, names: &[&str]) -> LegendPosition {
        let width = KEY + names.iter().map(|name| style::word_width(name)).fold(0.0, f64::max);
        let height = ENTRY.1 + ENTRY.0 * names.len() as f64;
        let (right, bottom) = (self.size.0 - width - INSET, self.size.1 - height - INSET);
        let at = |left: f64, top: f64| [left, top, left + width, top + height];
        let corners = [
            (LegendPosition::InsideTopRight, at(right, INSET)),
            (LegendPosition::InsideBottomRight, at(right, bottom)),
            (LegendPosition::InsideTopLeft, at(INSET, INSET)),
            (LegendPosition::InsideBottomLeft, at(INSET, bottom)),
        ];
        let mut best = (usize::MAX, LegendPosition::InsideTopRight);
        for (position, rectangle) in corners {
            let crowd = self.crowd(rectangle);
            if crowd < best.0 {
                best = (crowd, position);
            }
        }
        if best.0 == 0 {
            return best.1;
        }
        let steps = |from: f64| (1..).map(move |i| from - STEP * f64::from(i)).take_while(|s| *s >= INSET);
        for left in steps(right) {
            for top in steps(bottom) {
                let [a, b, c, d] = at(left, top);
                if self.crowd([a - INSET, b - INSET, c + INSET, d + INSET]) == 0 {
                    // The library's point lies inside the box.
                    let corner = (p.x.range.0, p.y.range.1);
                    let (x, y) = self.moved(p, corner, left + CORNER.0, top + CORNER.1);
                    return LegendPosition::DataCoords(x, y);
                }
            }
        }
        best.1
    }
}

fn overlap(a: &Rectangle, b: &Rectangle) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}
