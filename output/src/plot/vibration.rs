//! Figures of modes and of Campbell diagrams.

use super::{Axis, Figure, Line, Marker, Panel, Series, Words};
use crate::{Frequencies, Units};
use flexion::analysis::campbell::{Branch, Campbell, Crossing, Instability, Point};
use flexion::analysis::modes::{Mode, Modes};
use num_complex::Complex64;

/// Most modes that are drawn.
const MOST: usize = 12;

/// Part of the largest displacement from which on a curve is told from zero.
const SEEN: f64 = 5e-3;

/// Points of a curve, where it has fewer.
const FINE: usize = 200;

/// Colours of the curves of a Campbell diagram; black and grey are those of marks and of the lines of whole revolutions.
const BRANCHES: usize = 6;
const BLACK: usize = 6;
const GREY: usize = 7;

/// The shapes of modes: a panel each with the displacements of the stations along the axes of the sections, which have names, and where
/// a mode has torsion one beside it with the rotation about the first, at the phase at which the largest is real.
pub fn modes_figure(
    modes: &Modes,
    (stations, axes): (&[f64], [&str; 3]),
    unit: &Frequencies,
    title: Option<&str>,
) -> Figure {
    let torsion = modes.modes.iter().take(MOST).any(|mode| mode.shares.torsion > SEEN);
    let panels = |(number, mode): (usize, &Mode)| {
        let frequency = unit.short(mode.frequency());
        let moves = mode.shares.dominant();
        let text = match moves {
            "other" => format!("Mode {}: {frequency}", number + 1),
            moves => format!("Mode {}: {frequency}, {moves}", number + 1),
        };
        let heading = Words { text, outside: true, ..Words::default() };
        let range = |measured: bool| if measured { Some((-1.1, 1.1)) } else { None };
        let panel = |components: std::ops::Range<usize>, quantity: &str, unit: &str, measured: bool| Panel {
            x: Axis { tight: true, ..Axis::new("Station x", "m") },
            y: Axis { range: range(measured), ..Axis::new(quantity, unit) },
            series: shape(mode, stations, axes, components),
            words: vec![heading.clone()],
            ..Panel::default()
        };
        let twists = moves == "torsion";
        let mut panels = vec![panel(0..3, "Displacement", "m", !twists)];
        if torsion {
            panels.push(panel(3..4, "Rotation", "rad", twists));
        }
        panels
    };
    let mut panels: Vec<Panel> = modes.modes.iter().take(MOST).enumerate().flat_map(panels).collect();
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

/// Curves of components that are not small against the largest of them.
fn shape(mode: &Mode, stations: &[f64], names: [&str; 3], components: std::ops::Range<usize>) -> Vec<Series> {
    let all = mode.shape.movement.iter().flat_map(|u| &u[components.clone()]);
    let peak = all.fold(Complex64::ZERO, |best, u| if u.norm() > best.norm() { *u } else { best });
    let phase = if peak == Complex64::ZERO { Complex64::ONE } else { peak.conj() / peak.norm() };
    let curve = |axis: usize| {
        let along = stations.iter().zip(&mode.shape.movement);
        let points = along.map(|(x, u)| (*x, (u[axis] * phase).re)).collect();
        Series::line(Some(names.get(axis).copied().unwrap_or("torsion")), points).numbered(axis)
    };
    let moves = |series: &Series| series.points.iter().any(|p| p.1.abs() > SEEN * peak.norm());
    components.map(curve).filter(moves).collect()
}

/// Frequencies against the speed, with the lines of whole revolutions, their crossings and the instabilities marked.
pub fn campbell_figure(campbell: &Campbell, revolutions: u32, units: &Units, title: Option<&str>) -> Figure {
    let place = |speed: f64, frequency: f64| (speed * units.speed.factor, frequency * units.frequency.factor);
    let (mut series, mut words) = (Vec::new(), Vec::new());
    let (first, last) = (campbell.speeds.first().copied(), campbell.speeds.last().copied());
    let (first, last) = (first.unwrap_or(0.0), last.unwrap_or(0.0));
    let all = campbell.branches.iter().flat_map(|branch| &branch.points);
    let highest = all.map(|p| p.mode.frequency()).fold(0.0, f64::max);
    let top = if highest > 0.0 { 1.05 * highest } else { 1.0 / units.frequency.factor };
    let furthest = campbell.instabilities.iter().fold(last, |furthest, instability| match instability {
        Instability::Lost { speed, .. } => speed.max(furthest),
        Instability::Divergence { .. } | Instability::Flutter { .. } => furthest,
    });
    let begin = if revolutions > 0 { 0.0 } else { first };
    for (number, branch) in campbell.branches.iter().enumerate() {
        let points: Vec<(f64, f64)> =
            curve(branch).map(|(speed, frequency)| place(speed, frequency)).collect();
        // Beyond the end of its curve, or along it where it ends before the frame.
        if let Some((first, end)) = branch.points.first().zip(branch.points.last()) {
            let text = format!("{} {}", number + 1, first.mode.shares.dominant());
            let outside = end.speed >= last && furthest <= last;
            let points = points.iter().rev().copied().collect();
            words.push(Words { points, text, outside, color: Some(number % BRANCHES), ..Words::default() });
        }
        let line = [Line::Solid, Line::Dashed][(number / BRANCHES) % 2];
        series.push(Series { color: Some(number % BRANCHES), line, ..Series::line(None, points) });
    }
    for k in 1..=revolutions {
        let end = furthest.min(top / f64::from(k));
        let points = vec![place(0.0, 0.0), place(end, f64::from(k) * end)];
        let text = format!("{k}Ω");
        words.push(Words {
            points: vec![points[1]],
            text,
            outside: true,
            color: Some(GREY),
            ..Words::default()
        });
        series.push(Series { points, line: Line::Dotted, color: Some(GREY), ..Series::default() });
    }
    let at = |c: &Crossing| place(c.speed, f64::from(c.revolutions) * c.speed);
    if !campbell.crossings.is_empty() {
        series.push(Series {
            name: Some("crossings".to_owned()),
            points: campbell.crossings.iter().map(at).collect(),
            line: Line::None,
            marker: Some(Marker::Ring),
            color: Some(BLACK),
            band: Vec::new(),
        });
    }
    if !campbell.criticals.is_empty() {
        series.push(Series {
            name: Some("critical speeds".to_owned()),
            points: campbell.criticals.iter().map(|c| place(c.speed, 0.0)).collect(),
            line: Line::None,
            marker: Some(Marker::Circle),
            color: Some(BLACK),
            band: Vec::new(),
        });
    }
    series.extend(instabilities(campbell, top, &place));
    let ranges = [(begin, 0.0), (furthest, top)].map(|(speed, frequency)| place(speed, frequency));
    let [(left, low), (right, high)] = ranges;
    let axis = |quantity: &str, unit: &Frequencies, range| Axis {
        tight: true,
        range: Some(range),
        ..Axis::new(quantity, unit.name)
    };
    // A frequency in Hz is f = ω/2π.
    let symbol = if units.frequency == Frequencies::RADIANS { "Frequency ω" } else { "Frequency f" };
    let panel = Panel {
        x: axis("Speed Ω", &units.speed, (left, right)),
        y: axis(symbol, &units.frequency, (low, high)),
        series,
        words,
        ..Panel::default()
    };
    Figure { title: title.map(String::from), panels: vec![panel], columns: 1, share_x: false }
}

/// Speeds and frequencies of a branch; between its points ω² is linear in Ω².
fn curve(branch: &Branch) -> impl Iterator<Item = (f64, f64)> {
    let points = &branch.points;
    let pieces = (FINE / points.len().max(1)).max(1);
    let between = move |(a, b): (&Point, &Point)| {
        let [first, last] = [a, b].map(|p| (p.speed * p.speed, p.mode.frequency() * p.mode.frequency()));
        let (from, width) = (a.speed, (b.speed - a.speed) / pieces as f64);
        (1..=pieces).map(move |i| {
            let speed = from + i as f64 * width;
            let part = (speed * speed - first.0) / (last.0 - first.0);
            (speed, (first.1 + part * (last.1 - first.1)).max(0.0).sqrt())
        })
    };
    let first = points.first().map(|p| (p.speed, p.mode.frequency()));
    first.into_iter().chain(points.iter().zip(points.iter().skip(1)).flat_map(between))
}

/// Lines, up to `top`, at the ends of the ranges in which motions diverge and where steady rotation ends, and marks at the ends of those
/// in which a damping is negative.
fn instabilities(campbell: &Campbell, top: f64, place: &dyn Fn(f64, f64) -> (f64, f64)) -> Vec<Series> {
    let (mut series, mut flutter): (Vec<Series>, Vec<_>) = (Vec::new(), Vec::new());
    for instability in &campbell.instabilities {
        let (name, speeds) = match instability {
            Instability::Divergence { speed, until } => {
                ("divergence begins or ends", vec![*speed, until.unwrap_or(*speed)])
            }
            Instability::Lost { speed, .. } => ("end of steady rotation", vec![*speed]),
            Instability::Flutter { branch, to, until, .. } => {
                let points = campbell.branches.get(*branch).map_or(&[][..], |b| &b.points);
                let last = points.iter().rfind(|p| until.is_none_or(|until| p.speed < until));
                let at = points.iter().find(|p| p.speed == *to).into_iter().chain(last);
                flutter.extend(at.map(|p| place(p.speed, p.mode.frequency())));
                continue;
            }
        };
        for speed in speeds {
            let named = series.iter().any(|series| series.name.as_deref() == Some(name));
            series.push(Series {
                name: (!named).then(|| name.to_owned()),
                points: vec![place(speed, 0.0), place(speed, top)],
                line: Line::Dashed,
                color: Some(BLACK),
                ..Series::default()
            });
        }
    }
    if !flutter.is_empty() {
        series.push(Series {
            name: Some("negative damping begins, ends".to_owned()),
            points: flutter,
            line: Line::None,
            marker: Some(Marker::Triangle),
            color: Some(BLACK),
            band: Vec::new(),
        });
    }
    series
}
