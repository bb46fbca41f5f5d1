//! The figures of trajectories: which columns, in which panels, under which words.

use super::{Axis, Figure, Panel, Series};
use crate::columns::{NOISE, SHOWN, shown_columns};
use crate::{Comparison, Results, Trajectory};
use flexion::system::{Channel, Role};

/// Quantities of axes that are not the name of their column; nothing else depends on these names.
const QUANTITIES: [(&str, &str); 15] = [
    ("tip.deflection", "Tip deflection w₂"),
    ("tip.axial", "Axial displacement"),
    ("tip.across", "Tip displacement across"),
    ("hub.speed", "Hub speed"),
    ("hub.torque", "Hub torque τ"),
    ("hub.angle", "Hub angle θ"),
    ("energy.kinetic", "Kinetic energy"),
    ("energy.strain", "Strain energy"),
    ("energy.gravity", "Energy of gravity"),
    ("energy.total", "Total energy"),
    ("energy.drive", "Work of the drive"),
    ("energy.loads", "Work of the loads"),
    ("energy.dissipated", "Energy dissipated"),
    ("energy.balance", "Error of the energy balance"),
    ("energy.contact_loss", "Energy lost in contacts"),
];

/// Energies below this fraction of the largest cannot be read in the same panel.
const READABLE: f64 = 0.05;

/// From this number on, panels stand in two columns.
const PANELS: usize = 4;

/// The figure of one run against time: the first primary columns and the parts of the energy; the first columns
/// there are where there are none of these.
pub fn trajectory_figure(trajectory: &Trajectory, title: Option<&str>) -> Figure {
    let all = |role| trajectory.with_role(role);
    let panel = |i: usize| with_target(column(trajectory, i), trajectory, i);
    let mut panels: Vec<Panel> = shown_columns(trajectory, false).into_iter().filter_map(panel).collect();
    panels.extend(energies(trajectory));
    let others = [Role::Secondary, Role::Work, Role::Detail, Role::Imbalance, Role::Integration];
    for i in all(Role::Primary).skip(SHOWN).chain(others.into_iter().flat_map(all)) {
        if panels.len() < 2 || (panels.len() > PANELS && panels.len() % 2 == 1) {
            panels.extend(panel(i));
        }
    }
    figure(panels, title)
}

/// The angle of a controlled hub with what the controller wants.
fn with_target(panel: Option<Panel>, trajectory: &Trajectory, index: usize) -> Option<Panel> {
    let mut panel = panel?;
    let target = trajectory.index("hub.target").filter(|_| trajectory.channels()[index].name == "hub.angle");
    if let Some(target) = target {
        panel.series.iter_mut().for_each(|series| series.name = Some("angle".to_owned()));
        panel.series.push(Series::line(Some("target"), points(trajectory, target)).numbered(1));
    }
    Some(panel)
}

/// Several runs in one figure: one panel for each of the `columns`, one curve for each run in which
/// that column was recorded, the runs' names in the legend of the first panel.
pub fn compare_figure(runs: &[(&str, &Trajectory)], columns: &[&str], title: Option<&str>) -> Figure {
    let named: Vec<(Option<&str>, &Trajectory)> = runs.iter().map(|(n, t)| (Some(*n), *t)).collect();
    let mut panels: Vec<Panel> = columns.iter().filter_map(|name| panel(&named, name)).collect();
    for series in panels.iter_mut().skip(1).flat_map(|p| &mut p.series) {
        series.name = None;
    }
    figure(panels, title)
}

/// Runs and their differences from the first: for each of the `columns` a panel with all runs and, beside it, one
/// with the differences, in the colours of the runs.
pub fn difference_figure(
    runs: &[Results],
    comparisons: &[Comparison],
    columns: &[&str],
    title: Option<&str>,
) -> Figure {
    let named: Vec<(Option<&str>, &Trajectory)> =
        runs.iter().map(|run| (Some(run.name.as_str()), &run.trajectory)).collect();
    let differences: Vec<(Option<&str>, &Trajectory)> =
        comparisons.iter().map(|c| (Some(c.second.as_str()), &c.trajectory)).collect();
    let mut panels = Vec::new();
    for name in columns {
        let (Some(mut values), Some(mut apart)) = (panel(&named, name), panel(&differences, name)) else {
            continue;
        };
        apart.y.quantity = format!("Δ {}", apart.y.quantity);
        // The first run has no difference: colours and lines are those of the others.
        for (series, number) in apart.series.iter_mut().zip(1..) {
            *series = Series { name: None, ..std::mem::take(series).numbered(number) };
        }
        if !panels.is_empty() {
            values.series.iter_mut().for_each(|series| series.name = None);
        }
        panels.extend([values, apart]);
    }
    Figure { title: title.map(String::from), panels, columns: 2, share_x: true }
}

/// Panels in two columns, each with a time axis of its own.
pub(super) fn figure_of(panels: Vec<Panel>, title: Option<&str>) -> Figure {
    Figure { title: title.map(String::from), panels, columns: 2, share_x: false }
}

fn figure(panels: Vec<Panel>, title: Option<&str>) -> Figure {
    let columns = if panels.len() < PANELS { 1 } else { 2 };
    Figure { title: title.map(String::from), panels, columns, share_x: true }
}

pub(super) fn panel(runs: &[(Option<&str>, &Trajectory)], name: &str) -> Option<Panel> {
    let mut y = None;
    let mut series = Vec::new();
    for (number, (run, trajectory)) in runs.iter().enumerate() {
        if let Some(i) = trajectory.index(name) {
            y.get_or_insert_with(|| axis(&trajectory.channels()[i]));
            // A later run that covers an earlier one lets it be seen through its gaps.
            series.push(Series::line(*run, points(trajectory, i)).numbered(number));
        }
    }
    Some(Panel { x: Axis::time(), y: y?, series, ..Panel::default() })
}

/// A column of a run. One that varies by no more than the integration leaves of what is constant is level.
pub(super) fn column(trajectory: &Trajectory, index: usize) -> Option<Panel> {
    panel(&[(None, trajectory)], &trajectory.channels()[index].name).map(level)
}

/// A panel whose curves are all constant, but for what the integration leaves of that, shows them so.
fn level(mut panel: Panel) -> Panel {
    let values = panel.series.iter().flat_map(|series| &series.points).map(|(_, y)| *y);
    let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), y| (lo.min(y), hi.max(y)));
    let size = lo.abs().max(hi.abs());
    if hi > lo && hi - lo <= NOISE * size {
        let middle = lo.midpoint(hi);
        panel.y.range = Some((middle - 0.5 * size, middle + 0.5 * size));
    }
    panel
}

/// The parts of the energy: in one panel, or in two where some are small.
pub(super) fn energies(trajectory: &Trajectory) -> Vec<Panel> {
    let found: Vec<(usize, f64)> =
        trajectory.with_role(Role::Energy).map(|i| (i, trajectory.extremes(i).largest())).collect();
    let readable = READABLE * found.iter().fold(0.0, |m: f64, (_, size)| m.max(*size));
    let colored = found.into_iter().enumerate();
    let (large, small): (Vec<_>, Vec<_>) = colored.partition(|(_, (_, size))| *size >= readable);
    let panel = |group: Vec<(usize, (usize, f64))>| {
        let y = match group.as_slice() {
            [(_, (i, _))] => axis(&trajectory.channels()[*i]),
            _ => Axis::new("Energy", "J"),
        };
        let curve = |(color, (i, _)): &(usize, (usize, f64))| {
            let name = trajectory.channels()[*i].name.rsplit('.').next().filter(|_| group.len() > 1);
            Series::line(name, points(trajectory, *i)).numbered(if group.len() > 1 { *color } else { 0 })
        };
        level(Panel { x: Axis::time(), y, series: group.iter().map(curve).collect(), ..Panel::default() })
    };
    [large, small].into_iter().filter(|group| !group.is_empty()).map(panel).collect()
}

/// The axis of a column.
pub(super) fn axis(channel: &Channel) -> Axis {
    Axis::of_column(&channel.name, &channel.unit)
}

impl Axis {
    /// The axis of a column of this name with this unit: `Tip deflection w₂`, `m`.
    pub fn of_column(name: &str, unit: &str) -> Axis {
        let known = QUANTITIES.iter().find(|(known, _)| *known == name);
        let quantity = known.map_or_else(|| capitalised(&name.replace(['.', '_'], " ")), |k| k.1.into());
        Axis::new(quantity, unit.replace('*', "·").replace("^2", "²").replace("^3", "³"))
    }
}

pub(super) fn points(trajectory: &Trajectory, index: usize) -> Vec<(f64, f64)> {
    trajectory.times().iter().copied().zip(trajectory.values(index)).collect()
}

fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |c| c.to_uppercase().chain(chars).collect())
}
