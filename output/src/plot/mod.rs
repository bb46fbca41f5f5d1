//! Figures: panels of curves over linear or logarithmic axes, as SVG, PNG and PDF.
//!
//! A [`Figure`] says what to show; [`Figure::draw`] decides ranges, ticks and places. The figure of
//! a run is [`trajectory_figure`]; anything else (a comparison of runs, a Campbell diagram, a
//! convergence plot) is a [`Figure`] built from its own [`Panel`]s. The same figure gives the same bytes.

mod axis;
mod blades;
mod contact;
mod dash;
mod decimate;
mod draw;
mod font;
mod layout;
mod panels;
mod pdf;
mod placed;
mod raster;
mod room;
mod runs;
mod sketch;
mod statics;
mod style;
mod svg;
#[cfg(test)]
mod tests;
mod vibration;
mod views;

pub use self::blades::{Blade, Turning};
pub use self::contact::contact_figure;
pub use self::draw::Drawing;
pub use self::panels::{compare_figure, difference_figure, trajectory_figure};
pub use self::runs::runs_figure;
pub use self::statics::statics_figure;
pub use self::vibration::{campbell_figure, modes_figure};
pub use self::views::{assembly_figure, spatial_figure};

/// A grid of panels, filled row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// Title above the panels.
    pub title: Option<String>,
    /// The panels; they are lettered (a), (b), … when there is more than one.
    pub panels: Vec<Panel>,
    /// Panels in a row; 0 counts as 1.
    pub columns: usize,
    /// Whether the panels have one horizontal axis in common: one range for all, and numbers and
    /// label only below the lowest panel of each column.
    pub share_x: bool,
}

/// One pair of axes with its curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The curves, drawn in this order; those with a name are listed in a legend.
    pub series: Vec<Series>,
    /// Words written at points of the panel, those that would overlap left out.
    pub words: Vec<Words>,
    /// Whether the axes have one scale: the given range that is too short for the frame grows on both sides.
    pub equal: bool,
}

/// Words in a panel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Words {
    /// Points (x, y) in the units of the axes, at the first of which they stand that is clear of curves.
    pub points: Vec<(f64, f64)>,
    /// The words.
    pub text: String,
    /// Whether they stand outside of the frame, with a line to the first point: above the frame for a point on its upper
    /// edge, to its right for any other; without points they are the heading of the panel.
    pub outside: bool,
    /// Whether they may stand away from their points where no room is beside them, with a line to the first.
    pub leader: bool,
    /// Colour of that line: that of the curve with this number in the palette.
    pub color: Option<usize>,
}

/// What an axis shows and how.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// Quantity and symbol, e.g. `Tip deflection w₂`.
    pub quantity: String,
    /// Unit, e.g. `m`; empty for a pure number. A power of ten is put before it where that is readable.
    pub unit: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// Range to show; `None` for that of the data with a margin.
    pub range: Option<(f64, f64)>,
    /// Whether the range of the data is shown without a margin, as for time.
    pub tight: bool,
}

impl Axis {
    /// A linear axis that fits its data with a margin.
    pub fn new(quantity: impl Into<String>, unit: impl Into<String>) -> Axis {
        Axis { quantity: quantity.into(), unit: unit.into(), ..Axis::default() }
    }

    /// The time axis: `Time t [s]`, without margins.
    pub fn time() -> Axis {
        Axis { tight: true, ..Axis::new("Time t", "s") }
    }

    /// A logarithmic axis over whole decades; values that are not positive are left out.
    pub fn logarithmic(quantity: impl Into<String>, unit: impl Into<String>) -> Axis {
        Axis { scale: Scale::Logarithmic, ..Axis::new(quantity, unit) }
    }
}

/// How values are laid along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// In proportion.
    #[default]
    Linear,
    /// In proportion to their logarithm.
    Logarithmic,
}

/// One curve: points in order, those that are not finite left out (and the curve broken there).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Name in the legend; `None` keeps it out.
    pub name: Option<String>,
    /// Points (x, y) in the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// Line through the points.
    pub line: Line,
    /// Mark at each point; a curve with marks is not thinned out.
    pub marker: Option<Marker>,
    /// Which colour of the palette; `None` for the position of the series in its panel.
    pub color: Option<usize>,
    /// Half the height of a band about each point, in the unit of the vertical axis, as of an error; none where it is empty.
    pub band: Vec<f64>,
}

impl Series {
    /// A solid line.
    pub fn line(name: Option<&str>, points: Vec<(f64, f64)>) -> Series {
        // A single point would leave no line.
        let marker = (points.len() == 1).then_some(Marker::Circle);
        Series { name: name.map(String::from), points, marker, ..Series::default() }
    }

    /// The line that goes with a colour of this number: with it, curves can be told apart in grey.
    pub fn numbered(self, number: usize) -> Series {
        use Line::{DashDotDotted, DashDotted, Dashed, Dotted, LongDashed, Solid};
        const LINES: [Line; 6] = [Solid, Dashed, DashDotted, LongDashed, Dotted, DashDotDotted];
        Series { color: Some(number), line: LINES[number % LINES.len()], ..self }
    }

    /// The number of its colour when it is curve `number` of its panel.
    pub(self) fn ink(&self, number: usize) -> usize {
        self.color.unwrap_or(number) % style::COLORS
    }
}

/// Line through the points of a series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Line {
    /// ———
    #[default]
    Solid,
    /// – – –
    Dashed,
    /// · · ·
    Dotted,
    /// – · –
    DashDotted,
    /// —— ——
    LongDashed,
    /// – · · –
    DashDotDotted,
    /// Marks only.
    None,
}

/// Mark at the points of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// Filled circle.
    Circle,
    /// Open circle.
    Ring,
    /// Filled square.
    Square,
    /// Filled triangle.
    Triangle,
    /// Filled diamond.
    Diamond,
    /// Diagonal cross.
    Cross,
    /// Circle with a point: a direction towards the viewer.
    Toward,
    /// Circle with a cross: a direction away from the viewer.
    Away,
}
