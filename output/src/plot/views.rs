//! A system in space in three views, at several times.

use super::blades::{self, Blade, Marks, Turning};
use super::contact::contact_panels;
use super::panels::{column, energies};
use super::style::{PANEL_HEIGHT, PANEL_WIDTH, VIEWS};
use super::{Axis, Figure, Line, Marker, Panel, Series, Words};
use crate::columns::{moving, shown_columns};
use crate::{Events, Scene, Trajectory};
use flexion::linalg::Vec3;

/// Most times that are drawn.
const TIMES: usize = 9;
/// Colours of the first time, of those between, and of the last.
const COLORS: [usize; 3] = [6, 7, 0];
/// Space around what is drawn, over its size.
const MARGIN: f64 = 0.06;
/// The same around parts with their names.
const AROUND_NAMES: f64 = 0.2;
/// Part of its area that a plane shows from which on it is seen from the front; it is seen from its edge where it shows no more than
/// the rest.
const FRONT: f64 = 0.99;
/// How far a plane is drawn beyond its outline, over that.
const BEYOND: f64 = 10.0;
const NAMES: [&str; 3] = ["x", "y", "z"];

/// The figure of a run in space: three views at several times, and the [first columns](crate::shown_columns) against time; with contacts their
/// gaps, forces and first burst. Of a run of one time it is the views.
pub fn spatial_figure(
    scene: &Scene,
    trajectory: &Trajectory,
    events: &Events,
    title: Option<&str>,
) -> Figure {
    let mut panels = views(scene, &[], PANEL_HEIGHT[2], MARGIN);
    // What has one time is at rest.
    if trajectory.times().len() < 2 {
        return Figure { title: title.map(String::from), panels, columns: 2, share_x: false };
    }
    let column = |i: usize| column(trajectory, i);
    if events.is_empty() {
        panels.extend(shown_columns(trajectory, true).into_iter().filter_map(column));
        panels.extend(energies(trajectory).into_iter().take(1));
    } else {
        let contacts = contact_panels(scene, trajectory, events);
        let columns = 1 + (panels.len() + contacts.len() + 1) % 2;
        panels.extend(moving(trajectory).into_iter().filter_map(column).take(columns));
        panels.extend(contacts);
    }
    Figure { title: title.map(String::from), panels, columns: 2, share_x: false }
}

/// Three views of a system at one time, with the names of its parts and of its joints, which stand at the given points \[m\]; of blades
/// also their sections, their twist and their line, and what the system rotates about.
pub fn assembly_figure(
    scene: &Scene,
    joints: &[(&str, Vec3)],
    blades: &[Blade],
    turning: Option<Turning>,
    title: Option<&str>,
) -> Figure {
    let rows = |more: usize| (VIEWS.len() + more).div_ceil(2);
    let of_blades = blades::panels(blades, turning, rows);
    let marks = Marks::new(blades, turning);
    let points: Vec<Vec3> = joints.iter().map(|(_, point)| *point).chain(marks.points()).collect();
    let height = PANEL_HEIGHT[(rows(of_blades.len()) - 1).min(2)];
    let mut panels = views(scene, &points, height, AROUND_NAMES);
    marks.draw(&mut panels);
    for (panel, [i, j]) in panels.iter_mut().zip(VIEWS) {
        for (name, lines) in scene.lines(0) {
            let middle = |pair: &[Vec3]| (0.5 * (pair[0][i] + pair[1][i]), 0.5 * (pair[0][j] + pair[1][j]));
            let mut points: Vec<(f64, f64)> =
                lines.iter().flat_map(|line| line.windows(2).map(middle)).collect();
            let sum = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0, sum.1 + p.1));
            let centre = (sum.0 / points.len() as f64, sum.1 / points.len() as f64);
            let distance = |p: &(f64, f64)| (p.0 - centre.0).hypot(p.1 - centre.1);
            points.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
            panel.words.push(Words { points, text: name.to_owned(), leader: true, ..Words::default() });
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
            let (points, text) = (vec![at], (*name).to_owned());
            panel.words.push(Words { points, text, leader: true, ..Words::default() });
        }
    }
    panels.extend(of_blades);
    Figure { title: title.map(String::from), panels, columns: 2, share_x: false }
}

/// The views, all with one scale and one unit along both axes, which show these points \[m\] too.
fn views(scene: &Scene, also: &[Vec3], height: f64, margin: f64) -> Vec<Panel> {
    let count = scene.times().len();
    let taken = TIMES.min(count);
    let mut numbers: Vec<usize> = (0..taken).map(|k| k * (count - 1) / (taken - 1).max(1)).collect();
    numbers.dedup();
    let shots: Vec<(usize, Vec<Vec<Vec3>>)> = numbers
        .iter()
        .map(|n| (*n, scene.lines(*n).into_iter().flat_map(|(_, lines)| lines).collect()))
        .collect();
    let mut bounds = [(f64::INFINITY, f64::NEG_INFINITY); 3];
    for point in shots.iter().flat_map(|(_, lines)| lines.iter().flatten()).chain(also) {
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
    let outlines = shots.last().map_or(Vec::new(), |(time, _)| scene.outlines(*time));
    let view = |(number, [i, j]): (usize, [usize; 2])| {
        let mut series: Vec<Series> = outlines.iter().flat_map(|outline| seen(outline, [i, j])).collect();
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
        Panel { x: axis(i, half * wide), y: axis(j, half), series, equal: true, words: Vec::new() }
    };
    VIEWS.into_iter().enumerate().map(view).collect()
}

/// The outline of an obstacle in a view: of a plane a line where it is seen from its edge, nothing where it is seen from the front; of
/// a cylinder two circles and the edges between them.
fn seen(outline: &[Vec3], [i, j]: [usize; 2]) -> Vec<Series> {
    let points: Vec<(f64, f64)> = outline.iter().map(|p| (p[i], p[j])).collect();
    let apart = |a: (f64, f64), b: (f64, f64)| (b.0 - a.0).hypot(b.1 - a.1);
    let lines = if let [a, b, c, d, _] = points[..] {
        let area = 0.5 * ((c.0 - a.0) * (d.1 - b.1) - (c.1 - a.1) * (d.0 - b.0)).abs();
        let square = 0.5 * (0..3).map(|k| (outline[2][k] - outline[0][k]).powi(2)).sum::<f64>();
        match area / square {
            front if front > FRONT => Vec::new(),
            edge if edge < 1.0 - FRONT => {
                // It has no end.
                let (from, to) = if apart(a, c) > apart(b, d) { (a, c) } else { (b, d) };
                let further = |a: f64, b: f64| a + BEYOND * (a - b);
                vec![vec![
                    (further(from.0, to.0), further(from.1, to.1)),
                    (further(to.0, from.0), further(to.1, from.1)),
                ]]
            }
            _ => vec![points],
        }
    } else {
        let (one, other) = points.split_at(points.len() / 2);
        let (Some(first), Some(last)) = (one.first(), other.first()) else { return Vec::new() };
        let along = (last.0 - first.0, last.1 - first.1);
        let side = |p: &(f64, f64)| along.0 * p.1 - along.1 * p.0;
        let ends = |pair: &(&(f64, f64), &(f64, f64))| vec![*pair.0, *pair.1];
        let edges = || one.iter().zip(other);
        let by_side = |a: &(&(f64, f64), _), b: &(&(f64, f64), _)| side(a.0).total_cmp(&side(b.0));
        let edges = [edges().min_by(by_side), edges().max_by(by_side)];
        edges.iter().flatten().map(ends).chain([one.to_vec(), other.to_vec()]).collect()
    };
    let drawn = |points| Series { line: Line::Dashed, color: Some(COLORS[1]), ..Series::line(None, points) };
    lines.into_iter().map(drawn).collect()
}

/// A time with four digits.
fn rounded(t: f64) -> f64 {
    (t * 1e4).round() / 1e4
}
