//! Colours, sizes and lines of every figure, in one place.

use super::Line;

/// All colours that a figure may have: first the Okabe–Ito palette, distinguishable with every kind of colour vision,
/// strongest on white first (Okabe & Ito 2008, "Color Universal Design"; Wong 2011, doi:10.1038/nmeth.1618).
pub(super) const INKS: [[u8; 3]; 11] = [
    [0x00, 0x72, 0xB2],
    [0xD5, 0x5E, 0x00],
    [0x00, 0x9E, 0x73],
    [0xCC, 0x79, 0xA7],
    [0xE6, 0x9F, 0x00],
    [0x56, 0xB4, 0xE9],
    [0x00, 0x00, 0x00],
    [0x8C, 0x8C, 0x8C],
    [0x22, 0x22, 0x22],
    [0xE4, 0xE4, 0xE4],
    [0xFF, 0xFF, 0xFF],
];
/// A colour on white paper.
pub(super) fn color(ink: usize) -> [u8; 3] {
    let part = if ink < TINT { 1.0 } else { TINTED };
    INKS[ink % TINT].map(|c| (255.0 - part * (255.0 - f64::from(c))).round() as u8)
}

/// The coordinates of the three views of a system in space.
pub(super) const VIEWS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];

/// Number of colours of curves.
pub(super) const COLORS: usize = 8;
/// Axes and text.
pub(super) const INK: usize = 8;
/// Lines at the ticks.
pub(super) const GRID: usize = 9;
/// Paper.
pub(super) const WHITE: usize = 10;
/// A colour with this added is a tint of it, of which this part covers the paper: that of a band about a curve.
pub(super) const TINT: usize = 16;
pub(super) const TINTED: f64 = 0.25;

/// Fonts of the SVG; the first is that of the other formats.
pub(super) const FONTS: &str = "DejaVu Sans, Helvetica, Arial, sans-serif";
/// The one size of text [px]: 8 pt.
pub(super) const FONT: f64 = 10.7;
/// Height of a line of text, and what of it is above and below the base line [px].
pub(super) const LINE: f64 = 14.0;
pub(super) const ASCENT: f64 = 0.76 * FONT;
pub(super) const DESCENT: f64 = 0.24 * FONT;

/// Width of the frame of a panel [px] when it stands alone in its row, and beside others: figures of one panel fit a
/// column and a half of a journal, those of two a page.
pub(super) const PANEL_WIDTH: [f64; 2] = [330.0, 250.0];
/// Height of the frame of a panel [px] when there is one, two to a column, and more.
pub(super) const PANEL_HEIGHT: [f64; 3] = [235.0, 165.0, 125.0];
/// Width of a frame below which panels stand in fewer columns [px].
pub(super) const NARROWEST: f64 = 120.0;
/// Pixels of the drawing: 96 to the inch.
pub(super) const PIXELS_A_MILLIMETRE: f64 = 96.0 / 25.4;
/// Pixels of the PNG for each of the drawing: 288 to the inch.
pub(super) const PNG_SCALE: f64 = 3.0;

pub(super) const LINE_WIDTH: f64 = 1.3;
pub(super) const FRAME_WIDTH: f64 = 0.8;
pub(super) const GRID_WIDTH: f64 = 0.6;
/// Half the size of a mark [px].
pub(super) const MARK: f64 = 3.0;
/// Length of a tick [px].
pub(super) const TICK: f64 = 3.5;

/// Space between panels, and around the figure [px].
pub(super) const SPACING: f64 = 12.0;
pub(super) const PADDING: f64 = 6.0;

/// Lengths drawn and left out in turn [px]; none for a line that is not broken.
pub(super) fn dash(line: Line) -> &'static [f64] {
    match line {
        Line::Dashed => &[6.0, 3.0],
        Line::Dotted => &[1.3, 2.2],
        Line::DashDotted => &[8.0, 2.5, 1.5, 2.5],
        Line::LongDashed => &[13.0, 3.0],
        Line::DashDotDotted => &[8.0, 2.0, 1.3, 2.0, 1.3, 2.0],
        Line::Solid | Line::None => &[],
    }
}
