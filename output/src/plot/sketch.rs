//! What a drawing consists of, before it is written in one format or another.

use super::font::Font;
pub(super) use super::font::Point;
use super::style;

/// A rectangle: left, top, right, bottom [px].
pub(super) type Rectangle = [f64; 4];

/// A part of a drawing; colours are numbers of [`style::INKS`](super::style::INKS).
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    /// A line through points, drawn and left out for the lengths `dash` [px] in turn.
    Line { points: Vec<Point>, ink: usize, width: f64, dash: &'static [f64] },
    /// A closed area.
    Area { points: Vec<Point>, ink: usize },
    /// A text with its base line at a place.
    Text {
        at: Point,
        text: String,
        /// The part of its width that lies before `at`.
        anchor: f64,
        /// Whether it is read from below.
        upright: bool,
        ink: usize,
    },
}

impl Shape {
    /// A straight line.
    pub(super) fn line(from: Point, to: Point, ink: usize, width: f64) -> Shape {
        Shape::Line { points: vec![from, to], ink, width, dash: &[] }
    }

    /// A filled rectangle.
    pub(super) fn rectangle([left, top, right, bottom]: Rectangle, ink: usize) -> Shape {
        Shape::Area { points: vec![(left, top), (right, top), (right, bottom), (left, bottom)], ink }
    }
}

impl Shape {
    /// The outlines of a text in its place, character by character; nothing for what is no text.
    pub(super) fn outlines(&self, font: &Font) -> Vec<Vec<Vec<Point>>> {
        let Shape::Text { at, text, anchor, upright, .. } = self else { return Vec::new() };
        let before = anchor * font.width(text, style::FONT);
        let mut characters = font.outlines(text, style::FONT);
        for (x, y) in characters.iter_mut().flatten().flatten() {
            let (along, across) = (*x - before, *y);
            (*x, *y) = if *upright { (at.0 + across, at.1 - along) } else { (at.0 + along, at.1 + across) };
        }
        characters
    }
}
