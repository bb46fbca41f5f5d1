//! Figure of a path of equilibria.

use super::panels::axis;
use super::{Axis, Figure, Line, Marker, Panel, Series};
use crate::{LoadPath, LoadPoint};
use flexion::analysis::path::Critical;
use flexion::system::Role;

/// Most displacements that are drawn.
const MOST: usize = 4;

/// The load factor against the primary quantities, those that change: solid where the equilibria are stable, dashed where they
/// are not, with the critical states marked.
pub fn statics_figure(path: &LoadPath, title: Option<&str>) -> Figure {
    let shown = path.channels.iter().enumerate().filter(|(i, c)| c.role == Role::Primary && path.changes(*i));
    let panel = |(i, channel): (usize, &flexion::system::Channel)| Panel {
        x: axis(channel),
        y: Axis::new("Load factor", ""),
        series: series(path, i),
        ..Panel::default()
    };
    let mut panels: Vec<Panel> = shown.take(MOST).map(panel).collect();
    // One legend, and none where all is stable.
    let plain = panels.iter().flat_map(|panel| &panel.series).all(|s| s.line == Line::Solid);
    let unnamed = panels.iter_mut().skip(usize::from(!plain));
    unnamed.flat_map(|panel| &mut panel.series).for_each(|series| series.name = None);
    Figure { title: title.map(String::from), columns: panels.len().min(2), share_x: false, panels }
}

fn series(path: &LoadPath, i: usize) -> Vec<Series> {
    let at = |point: &LoadPoint| (point.values[i], point.factor);
    let is_stable = |point: &LoadPoint| point.stability.is_some_and(|found| found.is_stable());
    let mut named: Vec<bool> = Vec::new();
    let mut curves = Vec::new();
    let mut points = path.points.iter().peekable();
    while let Some(first) = points.peek().copied() {
        let stable = is_stable(first);
        let mut piece = Vec::new();
        while let Some(point) = points.next_if(|point| is_stable(point) == stable) {
            piece.push(at(point));
        }
        // Up to the first point of the next piece.
        piece.extend(points.peek().map(|point| at(point)));
        let name = (!named.contains(&stable)).then(|| if stable { "stable" } else { "unstable" }.to_owned());
        named.push(stable);
        let line = if stable { Line::Solid } else { Line::Dashed };
        curves.push(Series {
            name,
            points: piece,
            line,
            color: Some(usize::from(!stable)),
            marker: None,
            band: Vec::new(),
        });
    }
    for (kind, marker) in [
        (Critical::Limit, Marker::Circle),
        (Critical::Branching, Marker::Square),
        (Critical::Flutter, Marker::Diamond),
    ] {
        let points: Vec<(f64, f64)> =
            path.critical().filter(|(_, critical)| *critical == kind).map(|(point, _)| at(point)).collect();
        if !points.is_empty() {
            let name = Some(kind.name().to_owned());
            curves.push(Series {
                name,
                points,
                line: Line::None,
                marker: Some(marker),
                color: Some(2),
                band: Vec::new(),
            });
        }
    }
    curves
}
