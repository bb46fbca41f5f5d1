//! A system in space in three views, at several times.

use super::panels::{energies, panel};
use super::style::{PANEL_HEIGHT, PANEL_WIDTH};
use super::{Axis, Figure, Line, Marker, Panel, Series, Words};
use crate::{Scene, Trajectory};
use flexion::system::Role;

/// Most times that are drawn.
const TIMES: usize = 9;
/// Panels of columns beside the three views.
const BESIDE: usize = 3;
/// Colours of the first time, of those between, and of the last.
const COLORS: [usize; 3] = [6, 7, 0];
/// Space around what is drawn, over its size.
const MARGIN: f64 = 0.06;
/// The same around parts with their names, and the distance of a name from its joint over the height of the view.
const AROUND_NAMES: f64 = 0.2;
const APART: f64 = 0.1;
/// The coordinates of the views.
const VIEWS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];
const NAMES: [&str; 3] = ["x", "y", "z"];

/// The figure of a run in space: three views at several times, and the first columns against time.
pub fn spatial_figure(scene: &Scene, trajectory: &Trajectory, title: Option<&str>) -> Figure {
    let mut panels = views(scene, PANEL_HEIGHT[2], MARGIN);
    let column = |i: usize| panel(&[(None, trajectory)], &trajectory.channels()[i].name);
    // A coordinate that does not change says nothing.
    let moves = |i: &usize| {
        let extremes = trajectory.extremes(*i);
        extremes.max - extremes.min > 1e-9 * extremes.largest()
    };
    let energies = energies(trajectory);
    let of = |role| trajectory.with_role(role).filter(moves);
    let columns = of(Role::Secondary).chain(of(Role::Primary)).filter_map(column);
    panels.extend(columns.take(BESIDE - energies.len().min(1)));
    panels.extend(energies.into_iter().take(1));
    Figure { title: title.map(String::from), panels, columns: 2, share_x: false }
}

/// Three views of a system at one time, with the names of its parts and of its joints, which stand at the given points \[m\].
pub fn assembly_figure(scene: &Scene, joints: &[(&str, [f64; 3])], title: Option<&str>) -> Figure {
    let mut panels = views(scene, PANEL_HEIGHT[1], AROUND_NAMES);
    for (panel, [i, j]) in panels.iter_mut().zip(VIEWS) {
        for (name, lines) in scene.lines(0) {
            let points: Vec<(f64, f64)> = lines.iter().flatten().map(|p| (p[i], p[j])).collect();
            let (lowest, highest) = points
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| (lo.min(p.0), hi.max(p.0)));
            let top = points.iter().map(|p| p.1).fold(f64::NEG_INFINITY, f64::max);
            let across = [0.5, 0.25, 0.75].map(|part| (lowest + part * (highest - lowest), top));
            panel.words.push(Words { points: across.to_vec(), text: name.to_owned(), ..Words::default() });
        }
        for (name, point) in joints {
            let at = (point[i], point[j]);
            let mark = Series {
                marker: Some(Marker::Circle),
                line: Line::None,
                color: Some(1),
                ..Series::line(None, vec![at])
            };
            panel.series.push(mark);
            let apart = panel.y.range.map_or(0.0, |(lo, hi)| APART * (hi - lo));
            let around = [(0.0, 1.0), (0.0, -2.0), (0.0, 2.0), (0.0, -3.0), (2.0, 1.0), (-2.0, -2.0)];
            let points = around.map(|(x, y)| (at.0 + apart * x, at.1 + apart * y)).to_vec();
            panel.words.push(Words { points, text: (*name).to_owned(), ..Words::default() });
        }
    }
    Figure { title: title.map(String::from), panels, columns: 2, share_x: false }
}

/// The views, all with one scale and one unit along both axes.
fn views(scene: &Scene, height: f64, margin: f64) -> Vec<Panel> {
    let count = scene.times().len();
    let taken = TIMES.min(count);
    let mut numbers: Vec<usize> = (0..taken).map(|k| k * (count - 1) / (taken - 1).max(1)).collect();
    numbers.dedup();
    let shots: Vec<(usize, Vec<Vec<[f64; 3]>>)> = numbers
        .iter()
        .map(|n| (*n, scene.lines(*n).into_iter().flat_map(|(_, lines)| lines).collect()))
        .collect();
    let mut bounds = [(f64::INFINITY, f64::NEG_INFINITY); 3];
    for point in shots.iter().flat_map(|(_, lines)| lines.iter().flatten()) {
        for (bound, x) in bounds.iter_mut().zip(point).filter(|(_, x)| x.is_finite()) {
            *bound = (bound.0.min(*x), bound.1.max(*x));
        }
    }
    let bounds = bounds.map(|(lo, hi)| if lo > hi { (0.0, 0.0) } else { (lo, hi) });
    // Half of what a panel shows along its vertical axis.
    let wide = PANEL_WIDTH[1] / height;
    let size = |(lo, hi): (f64, f64)| 0.5 * (hi - lo) * (1.0 + 2.0 * margin);
    let needed = VIEWS.map(|[i, j]| (size(bounds[i]) / wide).max(size(bounds[j])));
    let half = needed.into_iter().fold(0.0, f64::max);
    let half = if half > 0.0 { half } else { 1.0 };
    let axis = |i: usize, half: f64| {
        let middle = 0.5 * (bounds[i].0 + bounds[i].1);
        Axis { range: Some((middle - half, middle + half)), ..Axis::new(NAMES[i], "m") }
    };
    let view = |(number, [i, j]): (usize, [usize; 2])| {
        let mut series = Vec::new();
        // The first and the last lie over those between.
        let ends = [0, shots.len().saturating_sub(1)];
        let between = (0..shots.len()).filter(|k| !ends.contains(k));
        for k in between.chain(ends.into_iter().take(shots.len())) {
            let (time, lines) = &shots[k];
            let which = if k + 1 == shots.len() { 2 } else { usize::from(k > 0) };
            let legend = number == 0 && which != 1;
            let name = legend.then(|| format!("t = {} s", rounded(scene.times()[*time])));
            for (first, line) in lines.iter().enumerate() {
                let points = line.iter().map(|p| (p[i], p[j])).collect();
                let name = name.as_deref().filter(|_| first == 0 && shots.len() > 1);
                series.push(Series { color: Some(COLORS[which]), ..Series::line(name, points) });
            }
        }
        if let Some((time, _)) = shots.last() {
            let line = |points: Vec<[f64; 3]>| points.iter().map(|p| (p[i], p[j])).collect();
            let drawn = |points| Series {
                line: Line::Dashed,
                color: Some(COLORS[1]),
                ..Series::line(None, line(points))
            };
            series.extend(scene.outlines(*time).into_iter().map(drawn));
        }
        Panel { x: axis(i, half * wide), y: axis(j, half), series, words: Vec::new() }
    };
    VIEWS.into_iter().enumerate().map(view).collect()
}

/// A time with four digits.
fn rounded(t: f64) -> f64 {
    (t * 1e4).round() / 1e4
}
