//! The figure of a run with contacts: gaps, forces, energies, and the first burst of impacts.

use super::panels::{energies, figure_of, panel, points};
use super::{Axis, Figure, Line, Marker, Panel, Series};
use crate::{Entry, Events, Trajectory};

/// Contacts that are drawn.
const DRAWN: usize = 4;
/// A pause between events that ends a burst, over the duration.
const PAUSE: f64 = 0.02;
/// Shortest time that the enlarged panels show, over the duration.
const SHORTEST: f64 = 0.01;
/// Margin on both sides of a burst, over its length.
const MARGIN: f64 = 0.15;

/// Part of the largest energy below which a loss, or the work of an impulse, is rounding: that of a point without mass.
const ROUNDING: f64 = 1e-9;

/// The figure of a run with contacts against time. Without events, as of a method that steps over them, it has no
/// enlarged panels.
pub fn contact_figure(trajectory: &Trajectory, events: &Events, title: Option<&str>) -> Figure {
    let shown = drawn(trajectory, events);
    let mut panels = Vec::new();
    panels.push(of_contacts(trajectory, &shown, "gap", Axis::new("Gap g", "m"), None));
    panels.push(of_contacts(trajectory, &shown, "force", Axis::new("Normal force λ", "N"), None));
    panels.extend(energies(trajectory).into_iter().take(1));
    let negligible = ROUNDING * panels.last().map_or(0.0, largest);
    let loss = panel(&[(None, trajectory)], "energy.contact_loss");
    panels.extend(loss.into_iter().filter(|panel| largest(panel) > negligible));
    panels.retain(|panel| !panel.series.is_empty());
    let by_force = !events.impacts().any(|entry| entry.work() > negligible);
    let forces: &[(usize, String)] = if by_force { &shown } else { &[] };
    if let Some(window) = burst(trajectory, events, forces) {
        panels.extend(enlarged(trajectory, events, &shown, window, negligible));
    }
    figure_of(panels, title)
}

/// Largest size of a panel's values.
fn largest(panel: &Panel) -> f64 {
    panel.series.iter().flat_map(|series| &series.points).fold(0.0, |m, (_, y)| m.max(y.abs()))
}

/// Numbers and names of the contacts that are drawn: those that touched first, or, where none did, those that press from the
/// start.
fn drawn(trajectory: &Trajectory, events: &Events) -> Vec<(usize, String)> {
    let mut numbers: Vec<usize> = Vec::new();
    let all = (0..).take_while(|i| !events.name(*i).is_empty());
    let presses = |i: &usize| {
        let force = trajectory.index(&format!("{}.force", events.name(*i)));
        force.is_some_and(|force| trajectory.values(force).any(|force| force != 0.0))
    };
    let pressing = all.clone().filter(presses);
    for i in events.list.iter().map(|entry| entry.contact).chain(pressing) {
        if numbers.len() < DRAWN && !numbers.contains(&i) {
            numbers.push(i);
        }
    }
    if numbers.is_empty() {
        numbers.extend(all.take(DRAWN));
    }
    numbers.sort_unstable();
    let named = numbers.into_iter().map(|i| (i, events.name(i).to_owned()));
    named.filter(|(_, name)| trajectory.index(&format!("{name}.gap")).is_some()).collect()
}

/// A quantity of the contacts, in all of the run or in a part of it.
fn of_contacts(
    trajectory: &Trajectory,
    shown: &[(usize, String)],
    quantity: &str,
    y: Axis,
    window: Option<(f64, f64)>,
) -> Panel {
    let curve = |(color, (_, name)): (usize, &(usize, String))| {
        let mut points = points(trajectory, trajectory.index(&format!("{name}.{quantity}"))?);
        if let Some((from, to)) = window {
            points.retain(|(t, _)| (from..=to).contains(t));
        }
        let name = (shown.len() > 1).then_some(name.as_str());
        Some(Series::line(name, points).numbered(color))
    };
    let series = shown.iter().enumerate().filter_map(curve).collect();
    let x = Axis { range: window, ..Axis::time() };
    Panel { x, y, series, words: Vec::new() }
}

/// Beginning and end of the first burst of events, and of the forces of contacts where these make it, with a margin.
fn burst(trajectory: &Trajectory, events: &Events, forces: &[(usize, String)]) -> Option<(f64, f64)> {
    let (start, end) = (*trajectory.times().first()?, *trajectory.times().last()?);
    let duration = end - start;
    let first = events.impacts().next()?.time;
    let mut times: Vec<f64> = events.list.iter().map(|entry| entry.time).collect();
    for force in forces.iter().filter_map(|(_, name)| trajectory.index(&format!("{name}.force"))) {
        let rows = trajectory.times().iter().zip(trajectory.values(force));
        times.extend(rows.filter(|(_, force)| *force != 0.0).map(|(t, _)| *t));
    }
    times.sort_by(f64::total_cmp);
    let mut last = first;
    for time in times.into_iter().filter(|time| *time >= first) {
        if time - last > PAUSE * duration {
            break;
        }
        last = time;
    }
    let missing = (SHORTEST * duration - (last - first)).max(0.0);
    let margin = MARGIN * (last - first) + 0.5 * missing;
    Some(((first - margin).max(start), (last + margin).min(end)))
}

/// Gap and impulses, or forces where no impulse does more work than is negligible, of a part of the run.
fn enlarged(
    trajectory: &Trajectory,
    events: &Events,
    shown: &[(usize, String)],
    (from, to): (f64, f64),
    negligible: f64,
) -> Vec<Panel> {
    let inside = |entry: &&Entry| (from..=to).contains(&entry.time);
    let mut gap = of_contacts(trajectory, shown, "gap", Axis::new("Gap, first burst", "m"), Some((from, to)));
    // Records are too few for a burst: at an impact the gap is zero.
    for (series, (number, _)) in gap.series.iter_mut().zip(shown) {
        let touched = events.list.iter().filter(inside).filter(|entry| entry.contact == *number);
        series.points.extend(touched.map(|entry| (entry.time, 0.0)));
        series.points.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    let impulses = |(color, (number, name)): (usize, &(usize, String))| {
        let strikes = |entry: &&Entry| entry.contact == *number && entry.work() > negligible;
        let points = events.list.iter().filter(inside).filter(strikes);
        Series {
            name: (shown.len() > 1).then(|| name.clone()),
            points: points.filter_map(|entry| Some((entry.time, entry.impulse?))).collect(),
            line: Line::None,
            marker: Some(Marker::Circle),
            color: Some(color),
        }
    };
    let series: Vec<Series> = shown.iter().enumerate().map(impulses).collect();
    let second = if series.iter().all(|series| series.points.is_empty()) {
        of_contacts(trajectory, shown, "force", Axis::new("Force, first burst", "N"), Some((from, to)))
    } else {
        let x = Axis { range: Some((from, to)), ..Axis::time() };
        let y = Axis::logarithmic("Impulses, first burst", "N·s");
        Panel { x, y, series, words: Vec::new() }
    };
    vec![gap, second]
}
