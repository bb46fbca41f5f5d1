//! Colours, sizes and fonts of every figure, in one place.

use super::Line;

/// Okabe–Ito palette, distinguishable with every kind of colour vision and in print, strongest
/// on white first (Okabe & Ito 2008, "Color Universal Design"; Wong 2011, doi:10.1038/nmeth.1618).
pub(super) const PALETTE: [&str; 8] =
    ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8C8C8C"];

/// Colour number `i`, beginning again after the last.
pub(super) fn color(i: usize) -> &'static str {
    PALETTE[i % PALETTE.len()]
}

/// Fonts of the SVG; the PNG has the first of them built in.
pub(super) const FONTS: &str = "DejaVu Sans, Helvetica, Arial, sans-serif";

/// Width of the frame of a panel [px] when it stands alone in its row, and beside others.
pub(super) const PANEL_WIDTH: [f64; 2] = [560.0, 350.0];
/// Height of the frame of a panel [px] when there is one, two to a column, and more.
pub(super) const PANEL_HEIGHT: [f64; 3] = [340.0, 210.0, 180.0];
/// Pixels of the PNG for each unit of the SVG.
pub(super) const PNG_SCALE: f32 = 3.0;

pub(super) const TITLE_SIZE: u32 = 15;
pub(super) const LABEL_SIZE: u32 = 13;
pub(super) const TICK_SIZE: u32 = 11;
pub(super) const LEGEND_SIZE: u32 = 11;
pub(super) const LINE_WIDTH: f64 = 1.5;
pub(super) const FRAME_WIDTH: f64 = 0.9;
pub(super) const GRID_WIDTH: f64 = 0.7;
pub(super) const GRID: &str = "#e4e4e4";
pub(super) const INK: &str = "#222222";
pub(super) const MARKER_SIZE: f64 = 3.6;

/// Space between panels, and around the figure [px].
pub(super) const SPACING: f64 = 14.0;
pub(super) const PADDING: f64 = 8.0;

/// Lengths drawn and left out [px]; `None` for a line that is not broken.
pub(super) fn dash(line: Line) -> Option<(f64, f64)> {
    match line {
        Line::Dashed => Some((7.0, 4.0)),
        Line::Dotted => Some((1.5, 3.5)),
        Line::Solid | Line::None => None,
    }
}

/// Width of a number set in the tick font [px] (advance widths of DejaVu Sans, in em).
pub(super) fn tick_width(text: &str) -> f64 {
    let em: f64 = text
        .chars()
        .map(|c| match c {
            '.' | ',' => 0.32,
            '−' => 0.838,
            '⁰'..='⁹' | '¹' | '²' | '³' | '⁻' => 0.42,
            _ => 0.636,
        })
        .sum();
    em * f64::from(TICK_SIZE)
}

/// Width of words set in the font of legends [px]: an upper estimate.
pub(super) fn word_width(text: &str) -> f64 {
    0.6 * f64::from(LEGEND_SIZE) * text.chars().count() as f64
}

/// Size of a label [px] that has to fit along `length` [px]: smaller for a long one, never below
/// what can be read.
pub(super) fn label_size(text: &str, length: f64) -> u32 {
    const MEAN_WIDTH: f64 = 0.54; // of DejaVu Sans, in em
    let fitting = (length + SPACING) / (MEAN_WIDTH * text.chars().count().max(1) as f64);
    (fitting as u32).clamp(8, LABEL_SIZE)
}
