//! From a [`Figure`] to SVG and PNG.

use std::sync::Arc;

use kuva::backend::{raster::RasterBackend, svg::SvgBackend};
use kuva::plot::legend::{LegendEntry, LegendShape};
use kuva::plot::scatter::MarkerShape;
use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::annotations::TextAnnotation;
use kuva::render::figure::{Figure as Grid, LabelConfig, LabelStyle};
use kuva::render::layout::{Layout, TickAlign, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::{Primitive, Scene};
use kuva::render::theme::Theme;

use super::axis::Resolved;
use super::coverage::Coverage;
use super::dash::dashes;
use super::decimate::decimate;
use super::placed::Placed;
use super::{Figure, Line, Marker, Panel, Series, style};
use crate::OutputError;

/// A figure with every line in its place.
#[derive(Debug)]
pub struct Drawing {
    scene: Scene,
}

impl Drawing {
    /// The drawing as SVG text; fonts are named, with a generic fallback.
    pub fn svg(&self) -> String {
        SvgBackend::new().render_scene(&self.scene)
    }

    /// The drawing as the bytes of a PNG, three pixels for each unit of the SVG.
    ///
    /// # Errors
    /// [`OutputError::Draw`] with the reason of the drawing library.
    pub fn png(&self) -> Result<Vec<u8>, OutputError> {
        let backend = RasterBackend::new().with_scale(style::PNG_SCALE);
        backend.render_scene(&self.scene).map_err(|reason| OutputError::Draw { reason })
    }
}

/// Names the clip regions by their place: the library counts them over the whole process, and the
/// same figure must give the same bytes.
fn number_clips(scene: &mut Scene) {
    let Scene { elements, defs, .. } = scene;
    let ids = elements.iter_mut().filter_map(|e| match e {
        Primitive::ClipStart { id, .. } => Some(id),
        _ => None,
    });
    for (i, id) in ids.enumerate() {
        let name = format!("frame-{i}");
        for def in defs.iter_mut() {
            *def = def.replace(&format!("\"{id}\""), &format!("\"{name}\""));
        }
        *id = name;
    }
}

impl Figure {
    /// Decides ranges, ticks and places, and draws. Never fails: what cannot be shown (values that
    /// are not finite, or not positive on a logarithmic axis) is left out.
    pub fn draw(&self) -> Drawing {
        let columns = self.columns.clamp(1, self.panels.len().max(1));
        let rows = self.panels.len().div_ceil(columns).max(1);
        let placed = self.place(columns);
        let width = style::PANEL_WIDTH[usize::from(columns > 1)];
        let height = style::PANEL_HEIGHT[(rows - 1).min(2)];
        let margins = Margins::new(&placed, columns);
        let letters: Vec<String> = (0..placed.len()).map(|i| format!("({})", letter(i))).collect();
        // All panels of a row end at the same height, labelled or not.
        let bottoms: Vec<f64> =
            placed.chunks(columns).map(|row| margins.bottom(row.iter().any(|p| p.x_labelled))).collect();
        let mut grid = Grid::new(rows, columns)
            .with_spacing(style::SPACING)
            .with_padding(style::PADDING)
            .with_plots(placed.iter().map(|p| plots(p, (width, height))).collect())
            .with_layouts(
                placed
                    .iter()
                    .enumerate()
                    .map(|(i, p)| layout(p, &margins, i % columns, bottoms[i / columns], (width, height)))
                    .collect(),
            );
        for (column, left) in margins.left.iter().enumerate() {
            grid = grid.with_col_width(column, left + width + margins.right);
        }
        for (row, bottom) in bottoms.iter().enumerate() {
            grid = grid.with_row_height(row, margins.top + height + bottom);
        }
        if placed.len() > 1 {
            let config = LabelConfig { style: LabelStyle::Lowercase, size: style::LABEL_SIZE, bold: true };
            grid = grid.with_labels_custom(letters.iter().map(String::as_str).collect(), config);
        }
        if let Some(title) = &self.title {
            grid = grid.with_title(title.clone()).with_title_size(style::TITLE_SIZE);
        }
        let mut scene = grid.render();
        number_clips(&mut scene);
        Drawing { scene }
    }

    fn place(&self, columns: usize) -> Vec<Placed<'_>> {
        let place = |(i, panel)| {
            let own = std::slice::from_ref(panel);
            let shown = if self.share_x { &self.panels[..] } else { own };
            Placed {
                panel,
                x: Resolved::new(&panel.x, points(shown).map(|p| p.0), 5),
                y: Resolved::new(&panel.y, points(own).map(|p| p.1), 5),
                x_labelled: !self.share_x || i + columns >= self.panels.len(),
            }
        };
        self.panels.iter().enumerate().map(place).collect()
    }
}

fn points(panels: &[Panel]) -> impl Iterator<Item = &(f64, f64)> {
    panels.iter().flat_map(|panel| &panel.series).flat_map(|series| &series.points)
}

/// Space around the frames [px], the same for all panels of a column so that frames align.
struct Margins {
    left: Vec<f64>,
    right: f64,
    top: f64,
}

impl Margins {
    fn new(placed: &[Placed<'_>], columns: usize) -> Margins {
        let widest = |axis: &Resolved| {
            axis.ticks().iter().map(|&s| style::tick_width(&axis.tick(s))).fold(0.0, f64::max)
        };
        let left = |column: usize| {
            let ticks = placed.iter().skip(column).step_by(columns).map(|p| widest(&p.y)).fold(0.0, f64::max);
            ticks + f64::from(style::LABEL_SIZE) * 1.2 + 24.0
        };
        let overhang = placed.iter().map(|p| widest(&p.x) / 2.0).fold(8.0, f64::max);
        let top = if placed.len() > 1 { 22.0 } else { 10.0 };
        Margins { left: (0..columns).map(left).collect(), right: overhang + 2.0, top }
    }

    fn bottom(&self, labelled: bool) -> f64 {
        if labelled { f64::from(style::TICK_SIZE + style::LABEL_SIZE) + 19.0 } else { 6.0 }
    }
}

fn layout(p: &Placed<'_>, margins: &Margins, column: usize, bottom: f64, size: (f64, f64)) -> Layout {
    let tick = |axis: &Resolved| {
        let axis = axis.clone();
        TickFormat::Custom(Arc::new(move |s| axis.tick(s)))
    };
    let theme = Theme {
        axis_color: style::INK.into(),
        tick_color: style::INK.into(),
        text_color: style::INK.into(),
        grid_color: style::GRID.into(),
        legend_border: style::GRID.into(),
        ..Theme::light()
    };
    let mut layout = Layout::new(p.x.range, p.y.range)
        .with_x_axis_min(p.x.range.0)
        .with_x_axis_max(p.x.range.1)
        .with_y_axis_min(p.y.range.0)
        .with_y_axis_max(p.y.range.1)
        .with_x_tick_step(p.x.step)
        .with_y_tick_step(p.y.step)
        .with_x_tick_format(tick(&p.x))
        .with_y_tick_format(tick(&p.y))
        .with_y_label(p.y.label.clone())
        .with_theme(theme)
        .with_font_family(style::FONTS)
        .with_label_size(style::label_size(&p.y.label, size.1))
        .with_tick_size(style::TICK_SIZE)
        .with_body_size(style::LEGEND_SIZE)
        .with_axis_line_width(style::FRAME_WIDTH)
        .with_tick_width(style::FRAME_WIDTH)
        .with_tick_length(4.0)
        .with_tick_align(TickAlign::Inside)
        .with_grid_line_width(style::GRID_WIDTH)
        .with_box_axes()
        .with_force_margins(margins.left.get(column).copied().unwrap_or(60.0), margins.right)
        .with_force_margins_y(margins.top, bottom);
    if p.x_labelled {
        layout = layout.with_x_label(p.x.label.clone());
    } else {
        layout.suppress_x_ticks = true;
    }
    let mut coverage = Coverage::new(p, size);
    for (x, y, words) in coverage.place_words() {
        let text = TextAnnotation::new(words, x, y).with_color(style::INK).with_font_size(style::LEGEND_SIZE);
        layout = layout.with_annotation(text);
    }
    let entries = legend(p.panel);
    if !entries.is_empty() {
        let names: Vec<&str> = entries.iter().map(|entry| entry.label.as_str()).collect();
        let position = coverage.place_legend(&names);
        layout = layout.with_legend_entries(entries).with_legend_position(position).with_legend_box(true);
    }
    layout
}

/// The curves and marks of a panel whose frame has the given size [px].
fn plots(p: &Placed<'_>, size: (f64, f64)) -> Vec<Plot> {
    let span = |(lo, hi): (f64, f64)| hi - lo;
    let scale = (size.0 / span(p.x.range), size.1 / span(p.y.range));
    let mut plots = Vec::new();
    for (i, series) in p.panel.series.iter().enumerate() {
        let color = style::color(series.color.unwrap_or(i));
        for piece in p.pieces(series) {
            // A curve with marks shows each of its points; any other is thinned to two points a pixel.
            let columns = if series.marker.is_some() { piece.len() } else { 2 * size.0 as usize };
            let thin = decimate(&piece, p.x.range, columns);
            let strokes = match style::dash(series.line) {
                Some((on, off)) => dashes(&thin, scale, on, off),
                None if series.line == Line::None => Vec::new(),
                None => vec![thin],
            };
            for stroke in strokes {
                let line = LinePlot::new().with_data(stroke).with_color(color);
                plots.push(line.with_stroke_width(style::LINE_WIDTH).into());
            }
            if let Some(marker) = series.marker {
                let marks = ScatterPlot::new()
                    .with_data(piece)
                    .with_color(color)
                    .with_size(style::MARKER_SIZE)
                    .with_marker(shape(marker));
                plots.push(marks.into());
            }
        }
    }
    if plots.is_empty() {
        // A panel without a curve still shows its axes.
        plots.push(LinePlot::new().with_data(Vec::<(f64, f64)>::new()).into());
    }
    plots
}

fn legend(panel: &Panel) -> Vec<LegendEntry> {
    let entry = |(i, s): (usize, &Series)| {
        let shape = match s.marker {
            Some(m) => LegendShape::Marker(shape(m)),
            None => LegendShape::Line,
        };
        let color = style::color(s.color.unwrap_or(i)).to_string();
        let dasharray = style::dash(s.line).map(|(on, off)| format!("{on} {off}"));
        s.name.clone().map(|label| LegendEntry { label, color, shape, dasharray })
    };
    panel.series.iter().enumerate().filter_map(entry).collect()
}

fn shape(marker: Marker) -> MarkerShape {
    match marker {
        Marker::Circle => MarkerShape::Circle,
        Marker::Square => MarkerShape::Square,
        Marker::Triangle => MarkerShape::Triangle,
        Marker::Diamond => MarkerShape::Diamond,
        Marker::Cross => MarkerShape::Cross,
    }
}

/// a, b, … z, then a again.
fn letter(i: usize) -> char {
    char::from(b'a' + (i % 26) as u8)
}
