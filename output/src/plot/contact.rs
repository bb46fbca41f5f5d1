//! The figure of a run with contacts: gaps, forces, energies, and the first burst of impacts.

use super::panels::{column, energies, figure_of, panel, points};
use super::{Axis, Figure, Line, Marker, Panel, Series, Words};
use crate::columns::shown_columns;
use crate::{Drawn, Entry, Events, Scene, Trajectory};

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

/// The figure of a run with contacts against time: the first columns, gaps, forces, energies, and the first burst. Without events, as of a method that steps over them, it has no
/// enlarged panels.
pub fn contact_figure(
    scene: &Scene,
    trajectory: &Trajectory,
    events: &Events,
    title: Option<&str>,
) -> Figure {
    let mut panels: Vec<Panel> = Vec::new();
    let contacts = contact_panels(scene, trajectory, events);
    let beside = shown_columns(trajectory, false).into_iter().filter_map(|i| column(trajectory, i));
    panels.extend(beside.take(1 + (contacts.len() + 1) % 2));
    panels.extend(contacts);
    figure_of(panels, title)
}

/// Its panels.
pub(super) fn contact_panels(scene: &Scene, trajectory: &Trajectory, events: &Events) -> Vec<Panel> {
    let whole = (f64::NEG_INFINITY, f64::INFINITY);
    let mut colors = Vec::new();
    let shown = drawn(trajectory, events, whole, &mut colors);
    let mut panels = Vec::new();
    panels.push(of_contacts((trajectory, events), &shown, "gap", Axis::new("Gap g", "m"), None));
    let force = of_contacts((trajectory, events), &shown, "force", Axis::new("Normal force λ", "N"), None);
    panels.extend(Some(force).filter(|panel| largest(panel) > 0.0));
    panels.extend(scene.obstacles().filter_map(|obstacle| in_contact(obstacle, trajectory, events)));
    panels.extend(energies(trajectory).into_iter().take(1));
    let negligible = ROUNDING * panels.last().map_or(0.0, largest);
    let loss = panel(&[(None, trajectory)], "energy.contact_loss");
    panels.extend(loss.into_iter().filter(|panel| largest(panel) > negligible));
    panels.retain(|panel| !panel.series.is_empty());
    let by_force = !events.impacts().any(|entry| entry.work() > negligible);
    if let Some(window) = burst(trajectory, events, by_force) {
        let shown = drawn(trajectory, events, window, &mut colors);
        panels.extend(enlarged(trajectory, events, &shown, window, negligible));
    }
    panels
}

/// A contact that is drawn.
struct Shown {
    number: usize,
    /// Its name in the legend, where there are several.
    name: Option<String>,
    color: usize,
}

/// Largest size of a panel's values.
fn largest(panel: &Panel) -> f64 {
    panel.series.iter().flat_map(|series| &series.points).fold(0.0, |m, (_, y)| m.max(y.abs()))
}

/// The contacts that are drawn: of those that touch or press from one time to another those with the largest forces and impulses;
/// the first where none does. A contact has one colour in all panels, by its place in `colors`.
fn drawn(
    trajectory: &Trajectory,
    events: &Events,
    (from, to): (f64, f64),
    colors: &mut Vec<usize>,
) -> Vec<Shown> {
    let all = (0..).take_while(|i| !events.name(*i).is_empty());
    let inside = |t: f64| (from..=to).contains(&t);
    let largest = |i: usize| {
        let force = trajectory.index(&format!("{}.force", events.name(i)));
        let rows = force.map(|force| trajectory.times().iter().zip(trajectory.values(force)));
        let rows = rows.into_iter().flatten().filter(|(t, _)| inside(**t));
        let force = rows.fold(0.0_f64, |largest, (_, force)| largest.max(force.abs()));
        let touches = events.list.iter().filter(|entry| entry.contact == i && inside(entry.time));
        let impulse = touches.map(|entry| entry.impulse.unwrap_or(0.0)).fold(f64::NEG_INFINITY, f64::max);
        (force > 0.0 || impulse >= 0.0).then_some((i, force, impulse))
    };
    let mut pressing: Vec<(usize, f64, f64)> = all.clone().filter_map(largest).collect();
    pressing.sort_by(|a, b| b.1.total_cmp(&a.1).then(b.2.total_cmp(&a.2)));
    let mut numbers: Vec<usize> = pressing.into_iter().take(DRAWN).map(|(i, ..)| i).collect();
    if numbers.is_empty() {
        numbers.extend(all.take(DRAWN));
    }
    numbers.retain(|i| trajectory.index(&format!("{}.gap", events.name(*i))).is_some());
    numbers.sort_unstable();
    let mut shown = |number: usize| {
        let color = colors.iter().position(|i| *i == number).unwrap_or_else(|| {
            colors.push(number);
            colors.len() - 1
        });
        let several = !events.name(1).is_empty();
        Shown { number, name: several.then(|| events.name(number).to_owned()), color }
    };
    numbers.into_iter().map(&mut shown).collect()
}

/// A quantity of the contacts, in all of the run or in a part of it.
fn of_contacts(
    (trajectory, events): (&Trajectory, &Events),
    shown: &[Shown],
    quantity: &str,
    y: Axis,
    window: Option<(f64, f64)>,
) -> Panel {
    let curve = |Shown { number, name, color }: &Shown| {
        let column = format!("{}.{quantity}", events.name(*number));
        let mut points = points(trajectory, trajectory.index(&column)?);
        if let Some((from, to)) = window {
            // One record beyond either end, for the curve to reach the frame.
            points.truncate(points.partition_point(|(t, _)| *t <= to) + 1);
            points.drain(..points.partition_point(|(t, _)| *t < from).saturating_sub(1));
        }
        let name = name.as_deref();
        Some(Series::line(name, points).numbered(*color))
    };
    let series = shown.iter().filter_map(curve).collect();
    let x = Axis { range: window, ..Axis::time() };
    Panel { x, y, series, ..Panel::default() }
}

/// Which of the points along a beam are in contact with an obstacle, against time: a line at the station of each while it presses,
/// half an interval of recording longer on both sides.
fn in_contact(obstacle: &Drawn, trajectory: &Trajectory, events: &Events) -> Option<Panel> {
    let times = trajectory.times();
    let half = 0.5 * (times.last()? - times.first()?) / times.len() as f64;
    let mut points = Vec::new();
    for (number, station) in (1..).zip(&obstacle.points) {
        let name = format!("{}.{number}", obstacle.name);
        let forces = trajectory.values(trajectory.index(&format!("{name}.force"))?);
        let records = times.iter().zip(forces).filter(|(_, force)| *force != 0.0).map(|(t, _)| *t);
        let impacts = events.impacts().filter(|entry| events.name(entry.contact) == name);
        let mut instants: Vec<f64> = records.chain(impacts.map(|entry| entry.time)).collect();
        instants.sort_by(f64::total_cmp);
        let mut last = f64::NEG_INFINITY;
        for t in instants {
            if t - half > last {
                points.extend([(f64::NAN, *station), (t - half, *station)]);
            }
            last = t + half;
            points.push((last, *station));
        }
    }
    let tip = obstacle.points.iter().copied().fold(0.0, f64::max);
    let y = Axis { range: Some((-0.05 * tip, 1.05 * tip)), ..Axis::new("Station in contact", "m") };
    let x = Axis { range: Some((*times.first()?, *times.last()?)), ..Axis::time() };
    let heading = Words { text: obstacle.name.clone(), outside: true, ..Words::default() };
    let series = vec![Series::line(None, points)];
    (!series[0].points.is_empty()).then_some(Panel { x, y, series, words: vec![heading], ..Panel::default() })
}

/// Beginning and end of the first burst of events, and of the forces of contacts where these make it (`by_force`), with a margin.
fn burst(trajectory: &Trajectory, events: &Events, by_force: bool) -> Option<(f64, f64)> {
    let (start, end) = (*trajectory.times().first()?, *trajectory.times().last()?);
    let duration = end - start;
    let first = events.impacts().next()?.time;
    let mut times: Vec<f64> = events.list.iter().map(|entry| entry.time).collect();
    let pressing = events.names().filter(|_| by_force);
    for force in pressing.filter_map(|name| trajectory.index(&format!("{name}.force"))) {
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
    shown: &[Shown],
    (from, to): (f64, f64),
    negligible: f64,
) -> Vec<Panel> {
    let inside = |entry: &&Entry| (from..=to).contains(&entry.time);
    let mut gap =
        of_contacts((trajectory, events), shown, "gap", Axis::new("Gap, first burst", "m"), Some((from, to)));
    // Records are too few for a burst: at an impact the gap is zero.
    for (series, Shown { number, .. }) in gap.series.iter_mut().zip(shown) {
        let touched = events.list.iter().filter(inside).filter(|entry| entry.contact == *number);
        series.points.extend(touched.map(|entry| (entry.time, 0.0)));
        series.points.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    let impulses = |Shown { number, name, color }: &Shown| {
        let strikes = |entry: &&Entry| entry.contact == *number && entry.work() > negligible;
        let points = events.list.iter().filter(inside).filter(strikes);
        Series {
            name: name.clone(),
            points: points.filter_map(|entry| Some((entry.time, entry.impulse?))).collect(),
            line: Line::None,
            marker: Some(Marker::Circle),
            color: Some(*color),
            band: Vec::new(),
        }
    };
    let series: Vec<Series> = shown.iter().map(impulses).collect();
    let second = if series.iter().all(|series| series.points.is_empty()) {
        of_contacts(
            (trajectory, events),
            shown,
            "force",
            Axis::new("Force, first burst", "N"),
            Some((from, to)),
        )
    } else {
        let x = Axis { range: Some((from, to)), ..Axis::time() };
        let y = Axis::logarithmic("Impulses, first burst", "N·s");
        Panel { x, y, series, ..Panel::default() }
    };
    vec![gap, second]
}
