//! Where the words and the legend of a panel stand: clear of its curves, or else outside of its frame.

use super::font::Font;
use super::placed::Placed;
use super::room::{Room, spread};
use super::sketch::{Point, Rectangle, Shape};
use super::{Line, Marker, Series, style};

/// Space around words, and around a legend, in the frame [px].
const CLEAR: f64 = 3.0;
const CLEAR_LEGEND: f64 = 5.0;
/// Between a point and the words beside it [px].
const BESIDE: f64 = 5.0;
/// Length of the line from the frame to words outside of it [px].
const LEADER: f64 = 14.0;
/// Directions of lines to words in the frame, and their greatest length over that length.
const TURNS: u32 = 16;
const FURTHEST: u32 = 8;
/// The same above the frame.
const RISE: f64 = 9.0;
/// Length of a line in a legend, and the space behind it and behind the name [px].
const KEY: f64 = 27.0;
const GAP: f64 = 5.0;
const BETWEEN: f64 = 12.0;
/// Size of the circle of a direction over that of a mark.
const DIRECTION: f64 = 1.5;
/// Steps in which a free place is sought [px].
const STEP: f64 = 4.0;

/// Words and legend of a panel, and the room that they take outside of its frame.
#[derive(Default)]
pub(super) struct Layout {
    /// Shapes from the upper left corner of the frame [px].
    pub(super) shapes: Vec<Shape>,
    /// Room above and to the right of the frame [px].
    pub(super) above: f64,
    pub(super) right: f64,
}

/// Lays out a panel; `letter` is its letter, above the frame.
pub(super) fn layout(p: &Placed<'_>, letter: &str, font: &Font) -> Layout {
    let mut room = Room::new(p.size);
    for series in &p.panel.series {
        if series.line != Line::None {
            p.strokes(series).iter().for_each(|stroke| room.take_line(stroke));
        }
        if series.marker.is_some() {
            let (m, marks) = (style::MARK, p.marks(series));
            marks.iter().for_each(|(x, y)| room.take([x - m, y - m, x + m, y + m]));
        }
    }
    let mut layout = Layout::default();
    layout.words_outside(p, font);
    layout.words_inside(p, font, &mut room);
    let headings = p.panel.words.iter().filter(|words| words.points.is_empty());
    let heading: Vec<&str> =
        std::iter::once(letter).chain(headings.map(|words| words.text.as_str())).collect();
    layout.legend(p, font, &room, heading.join(" ").trim());
    layout
}

impl Layout {
    /// Words beside the right edge of the frame, or above it, each with a line to its place.
    fn words_outside(&mut self, p: &Placed<'_>, font: &Font) {
        let (mut right, mut above) = (Vec::new(), Vec::new());
        for words in p.panel.words.iter().filter(|words| words.outside) {
            let Some((x, y)) = words.points.first().and_then(|point| p.pixel(*point)) else { continue };
            let ink = words.color.map_or(style::INK, |color| color % style::COLORS);
            if y > 0.5 {
                right.push((y.min(p.size.1), words.text.as_str(), ink));
            } else {
                above.push((x.clamp(0.0, p.size.0), words.text.as_str(), ink));
            }
        }
        let sorted = |list: &mut Vec<(f64, &str, usize)>, most: f64| {
            list.truncate(most as usize);
            list.sort_by(|a, b| a.0.total_cmp(&b.0));
            list.iter().map(|(place, ..)| *place).collect::<Vec<f64>>()
        };
        let wanted = sorted(&mut right, p.size.1 / style::LINE);
        let places = spread(&wanted, &vec![style::LINE; wanted.len()], 0.0, p.size.1);
        for ((y, text, ink), place) in right.into_iter().zip(places) {
            let (from, to) = ((p.size.0 + 1.0, y), (p.size.0 + LEADER, place));
            self.shapes.push(Shape::line(from, to, ink, style::FRAME_WIDTH));
            let at = (to.0 + 2.0, place + 0.5 * (style::ASCENT - style::DESCENT));
            self.shapes.push(text_at(at, text, 0.0, style::INK));
            self.right = self.right.max(LEADER + 2.0 + font.width(text, style::FONT));
        }
        let wanted = sorted(&mut above, f64::INFINITY);
        let widths: Vec<f64> =
            above.iter().map(|(_, text, _)| font.width(text, style::FONT) + CLEAR).collect();
        let places = spread(&wanted, &widths, 0.0, p.size.0);
        for ((x, text, ink), place) in above.into_iter().zip(places) {
            let to = (place, -RISE);
            self.shapes.push(Shape::line((x, -1.0), to, ink, style::FRAME_WIDTH));
            let at = (to.0, to.1 - 1.0 - style::DESCENT);
            self.shapes.push(text_at(at, text, 0.5, style::INK));
            self.above = RISE + style::LINE;
        }
    }

    /// Words at the first of their points beside which there is room; where there is none, at the end of a line to the first point,
    /// or else left out.
    fn words_inside(&mut self, p: &Placed<'_>, font: &Font, room: &mut Room) {
        let rise = 0.5 * (style::ASCENT - style::DESCENT);
        // What words and their lines take: other lines may cross curves, but not these.
        let mut written = Room::new(p.size);
        for words in p.panel.words.iter().filter(|words| !words.outside) {
            let width = font.width(&words.text, style::FONT);
            let around = |(x, y): Point, beside: f64| {
                let (up, down) = (y - beside - style::DESCENT, y + beside + style::ASCENT);
                let left = x - 0.5 * width;
                [(left, up), (left, down), (x + beside, y + rise), (x - beside - width, y + rise)]
            };
            let rectangle = |(x, y): Point| [x, y - style::ASCENT, x + width, y + style::DESCENT];
            let free = |room: &Room, at: Point| room.is_free(rectangle(at), CLEAR);
            let points = words.points.iter().filter_map(|point| p.pixel(*point));
            let marked = BESIDE + style::MARK;
            let place = points.clone().flat_map(|point| around(point, BESIDE)).find(|at| free(room, *at));
            let beside_mark =
                || points.clone().flat_map(|point| around(point, marked)).find(|at| free(room, *at));
            let place = place.or_else(beside_mark);
            if let Some(at) = place {
                [&mut *room, &mut written].into_iter().for_each(|room| room.take(rectangle(at)));
                self.shapes.push(text_at(at, &words.text, 0.0, style::INK));
                continue;
            }
            let Some((x, y)) = points.clone().next().filter(|_| words.leader) else { continue };
            // The place of the words, and the line to it, which begins clear of a mark.
            let away = |(turn, radius): (u32, u32)| {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(turn) / f64::from(TURNS)).sin_cos();
                let at = |radius: f64| (x + radius * cos, y - radius * sin);
                let end = at(f64::from(radius) * LEADER);
                let words = (end.0 - 0.5 * width * (1.0 - cos), end.1 + rise);
                let [left, top, right, bottom] = rectangle(words);
                (words, [at(marked), (end.0.clamp(left, right), end.1.clamp(top, bottom))])
            };
            let all =
                || (2..=FURTHEST).flat_map(|radius| (0..TURNS).map(move |turn| (turn, radius))).map(away);
            let clear = |of: &Room| all().find(|(at, line)| free(room, *at) && of.is_clear(line));
            if let Some((at, line)) = clear(room).or_else(|| clear(&written)) {
                self.shapes.push(Shape::line((x, y), line[1], style::INK, style::GRID_WIDTH));
                self.shapes.push(text_at(at, &words.text, 0.0, style::INK));
                for room in [&mut *room, &mut written] {
                    room.take_line(&line);
                    room.take(rectangle(at));
                }
            }
        }
    }

    /// The legend: in the free place nearest to a corner, or else above the frame behind the heading.
    fn legend(&mut self, p: &Placed<'_>, font: &Font, room: &Room, heading: &str) {
        let base = -self.above - 4.0 - style::DESCENT;
        let mut lines = f64::from(u8::from(!heading.is_empty()));
        let heading_width = font.width(heading, style::FONT);
        let widest = p.size.0 - KEY - GAP;
        let series = p.panel.series.iter().enumerate();
        let entries: Vec<(usize, &Series, String, f64)> = series
            .filter_map(|(number, series)| {
                let name = shortened(series.name.as_deref()?, widest, font);
                let width = KEY + GAP + font.width(&name, style::FONT);
                Some((number, series, name, width))
            })
            .collect();
        let size = (entries.iter().map(|e| e.3).fold(0.0, f64::max), style::LINE * entries.len() as f64);
        let mut places: Vec<Point> = Vec::new();
        if let Some(corner) = free_place(p.size, size, room).filter(|_| !entries.is_empty()) {
            let [x, y] = [corner.0, corner.1];
            self.shapes.push(Shape::rectangle(inflated([x, y, x + size.0, y + size.1], 2.0), style::WHITE));
            let row = |i: usize| {
                (x, y + style::LINE * i as f64 + 0.5 * (style::LINE + style::ASCENT - style::DESCENT))
            };
            places.extend((0..entries.len()).map(row));
        } else if !entries.is_empty() {
            let begin = if heading.is_empty() { 0.0 } else { heading_width + BETWEEN };
            // Row by row, the last just above the frame.
            let (mut rows, mut x) = (0, begin);
            for (_, _, _, width) in &entries {
                if x > begin && x + width > p.size.0 {
                    (rows, x) = (rows + 1, 0.0);
                }
                places.push((x, f64::from(rows)));
                x += width + BETWEEN;
                self.right = self.right.max(x - BETWEEN - p.size.0);
            }
            lines = f64::from(rows) + 1.0;
            places.iter_mut().for_each(|(_, y)| *y = base - style::LINE * (f64::from(rows) - *y));
        }
        for ((number, series, name, _), at) in entries.iter().zip(places) {
            self.entry(*number, series, name, at);
        }
        if !heading.is_empty() {
            let at = (0.0, base - style::LINE * (lines - 1.0));
            self.shapes.push(text_at(at, heading, 0.0, style::INK));
        }
        self.above += lines * style::LINE + if lines > 0.0 { 4.0 } else { 0.0 };
    }

    fn entry(&mut self, number: usize, series: &Series, name: &str, (x, y): Point) {
        let ink = series.ink(number);
        let level = y - 0.5 * (style::ASCENT - style::DESCENT) - 0.5;
        if series.line != Line::None {
            let (points, dash) = (vec![(x, level), (x + KEY, level)], style::dash(series.line));
            self.shapes.push(Shape::Line { points, ink, width: style::LINE_WIDTH, dash });
        }
        if let Some(marker) = series.marker {
            self.shapes.extend(mark(marker, (x + 0.5 * KEY, level), ink));
        }
        self.shapes.push(text_at((x + KEY + GAP, y), name, 0.0, style::INK));
    }
}

/// The upper left corner of a free place of the given size, nearest to a corner of the frame.
fn free_place(frame: (f64, f64), size: (f64, f64), room: &Room) -> Option<Point> {
    let (right, bottom) = (frame.0 - size.0 - CLEAR_LEGEND, frame.1 - size.1 - CLEAR_LEGEND);
    let steps = |to: f64| {
        let count = ((to - CLEAR_LEGEND) / STEP).floor();
        (0..=count.max(-1.0) as i64).map(move |i| to - STEP * i as f64)
    };
    let distance = |(x, y): &Point| {
        (right - x).min(x - CLEAR_LEGEND).powi(2) + (bottom - y).min(y - CLEAR_LEGEND).powi(2)
    };
    let mut all: Vec<Point> = steps(right).flat_map(|x| steps(bottom).rev().map(move |y| (x, y))).collect();
    all.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    all.into_iter().find(|&(x, y)| room.is_free([x, y, x + size.0, y + size.1], CLEAR_LEGEND))
}

fn inflated([left, top, right, bottom]: Rectangle, by: f64) -> Rectangle {
    [left - by, top - by, right + by, bottom + by]
}

/// A text, its beginning left out where it is wider than `width`.
fn shortened(text: &str, width: f64, font: &Font) -> String {
    let fits = |text: &str| font.width(text, style::FONT) <= width;
    if fits(text) {
        return text.to_owned();
    }
    let ends = text.char_indices().map(|(i, _)| format!("…{}", &text[i..]));
    ends.skip(1).find(|end| fits(end)).unwrap_or_default()
}

pub(super) fn text_at(at: Point, text: &str, anchor: f64, ink: usize) -> Shape {
    Shape::Text { at, text: text.to_owned(), anchor, upright: false, ink }
}

/// A text in lines none of which is longer than `length`, if blanks outside of brackets allow it.
pub(super) fn lines(text: &str, length: f64, font: &Font) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match out.last_mut() {
            Some(line)
                if line.rfind('[') > line.rfind(']')
                    || font.width(&format!("{line} {word}"), style::FONT) <= length =>
            {
                line.push(' ');
                line.push_str(word);
            }
            _ => out.push(word.to_owned()),
        }
    }
    out
}

/// An open circle.
fn ring(mut corners: Vec<Point>, ink: usize) -> Vec<Shape> {
    let filled = Shape::Area { points: corners.clone(), ink: style::WHITE };
    corners.extend(corners.first().copied());
    vec![filled, Shape::Line { points: corners, ink, width: style::FRAME_WIDTH, dash: &[] }]
}

/// A mark at a place.
pub(super) fn mark(marker: Marker, (x, y): Point, ink: usize) -> Vec<Shape> {
    let m = style::MARK;
    let corners = |count: u32, turn: f64, radius: f64| -> Vec<Point> {
        let angle = |i: u32| std::f64::consts::TAU * (f64::from(i) + turn) / f64::from(count);
        (0..count).map(|i| angle(i).sin_cos()).map(|(s, c)| (x + radius * s, y - radius * c)).collect()
    };
    let area = |points, ink| vec![Shape::Area { points, ink }];
    match marker {
        Marker::Circle => area(corners(16, 0.0, m), ink),
        Marker::Square => area(corners(4, 0.5, 1.25 * m), ink),
        Marker::Triangle => area(corners(3, 0.0, 1.3 * m), ink),
        Marker::Diamond => area(corners(4, 0.0, 1.3 * m), ink),
        Marker::Ring => ring(corners(16, 0.0, m), ink),
        Marker::Toward => {
            [ring(corners(24, 0.0, DIRECTION * m), ink), area(corners(12, 0.0, 0.5 * m), ink)].concat()
        }
        Marker::Away => {
            let cross = corners(4, 0.5, DIRECTION * m);
            let lines =
                [(0, 2), (1, 3)].map(|(i, j)| Shape::line(cross[i], cross[j], ink, style::FRAME_WIDTH));
            [ring(corners(24, 0.0, DIRECTION * m), ink), lines.to_vec()].concat()
        }
        Marker::Cross => vec![
            Shape::line((x - m, y - m), (x + m, y + m), ink, style::LINE_WIDTH),
            Shape::line((x - m, y + m), (x + m, y - m), ink, style::LINE_WIDTH),
        ],
    }
}
