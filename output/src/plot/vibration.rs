//! Figures of modes and of Campbell diagrams.

use super::{Axis, Figure, Line, Marker, Panel, Series, Words};
use crate::Frequencies;
use flexion::analysis::campbell::{Campbell, Instability};
use flexion::analysis::modes::{Mode, Modes};
use num_complex::Complex64;

/// Most modes that are drawn.
const MOST: usize = 12;

/// Where along its curve a mode may be named, over the range of speeds: the first place that is clear is taken.
const NAMED: [f64; 9] = [0.12, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];

/// The shapes of modes: one panel each, the displacements of the stations along the axes of the sections at
/// the phase at which the largest is real.
pub fn modes_figure(modes: &Modes, stations: &[f64], unit: &Frequencies, title: Option<&str>) -> Figure {
    let panel = |(number, mode): (usize, &Mode)| Panel {
        x: Axis { tight: true, ..Axis::new("Station x", "m") },
        y: Axis::new(format!("Mode {}: {}", number + 1, unit.text(mode.frequency())), ""),
        series: shape(mode, stations),
        words: Vec::new(),
    };
    let mut panels: Vec<Panel> = modes.modes.iter().take(MOST).enumerate().map(panel).collect();
    // The name of a curve once.
    let mut named = Vec::new();
    for series in panels.iter_mut().flat_map(|panel| &mut panel.series) {
        if named.contains(&series.color) {
            series.name = None;
        }
        named.push(series.color);
    }
    Figure { title: title.map(String::from), columns: panels.len().min(2), share_x: true, panels }
}

fn shape(mode: &Mode, stations: &[f64]) -> Vec<Series> {
    let all = mode.shape.displacement.iter().flatten();
    let peak = all.fold(Complex64::ZERO, |best, u| if u.norm() > best.norm() { *u } else { best });
    let phase = if peak == Complex64::ZERO { Complex64::ONE } else { peak.conj() / peak.norm() };
    let names = ["axial", "chordwise", "flapwise"];
    let lines = [Line::Dashed, Line::Solid, Line::Dotted];
    let curve = |axis: usize| Series {
        points: stations
            .iter()
            .zip(&mode.shape.displacement)
            .map(|(x, u)| (*x, (u[axis] * phase).re))
            .collect(),
        name: Some(names[axis].to_owned()),
        line: lines[axis],
        color: Some(axis),
        ..Series::default()
    };
    let moves = |series: &Series| series.points.iter().any(|p| p.1.abs() > 1e-6);
    (0..3).map(curve).filter(moves).collect()
}

/// Frequencies against the speed, with the lines of whole revolutions, their crossings and the instabilities marked.
pub fn campbell_figure(
    campbell: &Campbell,
    revolutions: u32,
    unit: &Frequencies,
    title: Option<&str>,
) -> Figure {
    let (mut series, mut words) = (Vec::new(), Vec::new());
    let mut top: f64 = 0.0;
    let last = campbell.speeds.last().copied().unwrap_or(0.0) * unit.factor;
    for (number, branch) in campbell.branches.iter().enumerate() {
        let points: Vec<(f64, f64)> =
            branch.points.iter().map(|p| (p.speed * unit.factor, p.mode.frequency() * unit.factor)).collect();
        top = points.iter().map(|p| p.1).fold(top, f64::max);
        // Where the lines of whole revolutions are furthest, if that is free: near the vertical axis.
        let near = |x: f64| points.iter().min_by(|a, b| (a.0 - x).abs().total_cmp(&(b.0 - x).abs())).copied();
        if let Some(first) = branch.points.first() {
            let text = format!("{} {}", number + 1, first.mode.shares.dominant());
            let points = NAMED.iter().filter_map(|part| near(part * last)).collect();
            words.push(Words { points, text, beside: false });
        }
        series.push(Series { color: Some(number), ..Series::line(None, points) });
    }
    // A line at the end of the curves is clear of the frame, and words beside their ends fit into it.
    let marks = instabilities(campbell, top, unit);
    let first = campbell.speeds.first().copied().unwrap_or(0.0) * unit.factor;
    let begin = if revolutions > 0 { 0.0 } else { first };
    let furthest = marks.iter().flat_map(|s| &s.points).map(|p| p.0).fold(last, f64::max);
    for k in 1..=revolutions {
        let end = furthest.min(top / f64::from(k));
        let points = vec![(0.0, 0.0), (end, f64::from(k) * end)];
        let name = (k == 1).then(|| match revolutions {
            1 => "ω = Ω".to_owned(),
            _ => format!("ω = kΩ, k = 1 … {revolutions}"),
        });
        // At the end of the line: beside it, or below the upper edge of the frame.
        let beside = f64::from(k) * furthest <= top;
        words.push(Words { points: vec![(end, f64::from(k) * end)], text: format!("{k}Ω"), beside });
        series.push(Series { name, points, line: Line::Dotted, color: Some(7), ..Series::default() });
    }
    let crossings: Vec<(f64, f64)> = campbell
        .crossings
        .iter()
        .map(|c| (c.speed * unit.factor, f64::from(c.revolutions) * c.speed * unit.factor))
        .collect();
    if !crossings.is_empty() {
        series.push(Series {
            name: Some("crossings".to_owned()),
            points: crossings,
            line: Line::None,
            marker: Some(Marker::Circle),
            color: Some(1),
        });
    }
    let extension = if words.iter().any(|words| words.beside) { 1.06 } else { 1.04 };
    let range =
        (extension > 1.05 || furthest > last).then_some((begin, begin + extension * (furthest - begin)));
    series.extend(marks);
    let panel = Panel {
        x: Axis { tight: true, range, ..Axis::new("Speed Ω", unit.name) },
        y: Axis {
            range: Some((0.0, if top > 0.0 { 1.06 * top } else { 1.0 })),
            ..Axis::new("Frequency ω", unit.name)
        },
        series,
        words,
    };
    Figure { title: title.map(String::from), panels: vec![panel], columns: 1, share_x: false }
}

/// A line where steady rotation becomes unstable or ends, up to `top`, and marks where a damping becomes negative.
fn instabilities(campbell: &Campbell, top: f64, unit: &Frequencies) -> Vec<Series> {
    let (mut series, mut flutter) = (Vec::new(), Vec::new());
    for instability in &campbell.instabilities {
        let (speed, name) = match instability {
            Instability::Divergence { speed, .. } => (speed, "divergence"),
            Instability::Lost { speed, .. } => (speed, "end of steady rotation"),
            Instability::Flutter { branch, to, .. } => {
                let points = campbell.branches.get(*branch).map_or(&[][..], |b| &b.points);
                let at = points.iter().find(|p| p.speed == *to);
                flutter.extend(at.map(|p| (to * unit.factor, p.mode.frequency() * unit.factor)));
                continue;
            }
        };
        let speed = speed * unit.factor;
        series.push(Series {
            name: Some(name.to_owned()),
            points: vec![(speed, 0.0), (speed, 1.06 * top)],
            line: Line::Dashed,
            color: Some(6),
            ..Series::default()
        });
    }
    if !flutter.is_empty() {
        series.push(Series {
            name: Some("negative damping".to_owned()),
            points: flutter,
            line: Line::None,
            marker: Some(Marker::Triangle),
            color: Some(6),
        });
    }
    series
}
