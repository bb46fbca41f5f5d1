//! The figures of trajectories: which columns, in which panels, under which words.

use super::{Axis, Figure, Line, Panel, Series};
use crate::{Comparison, Results, Trajectory};
use flexion::system::Channel;

/// Columns that have a panel of their own, with the words for it.
const SINGLE: [(&str, &str); 9] = [
    ("tip.deflection", "Tip deflection w₂"),
    ("tip.axial", "Axial displacement"),
    ("hub.speed", "Hub speed"),
    ("hub.torque", "Hub torque τ"),
    ("hub.angle", "Hub angle θ"),
    ("energy.kinetic", "Kinetic energy"),
    ("energy.strain", "Strain energy"),
    ("energy.gravity", "Energy of gravity"),
    ("energy.total", "Total energy"),
];

/// Energies, in the order of the legend; small ones get a panel of their own.
const ENERGIES: [(&str, &str); 3] =
    [("energy.kinetic", "kinetic"), ("energy.strain", "strain"), ("energy.gravity", "gravity")];

/// Energies below this fraction of the largest cannot be read in the same panel.
const READABLE: f64 = 0.05;

/// From this number on, panels stand in two columns.
const PANELS: usize = 4;

/// The figure of one run: tip deflection, tip axial displacement, hub speed and energies against time,
/// as far as they were recorded; the first columns there are when none of them was.
pub fn trajectory_figure(trajectory: &Trajectory, title: Option<&str>) -> Figure {
    let names: Vec<&str> = SINGLE.iter().map(|(name, _)| *name).take(3).collect();
    let mut panels: Vec<Panel> = names.iter().filter_map(|name| panel(&[(None, trajectory)], name)).collect();
    panels.extend(energies(trajectory));
    // Two columns are filled up, and a figure without any of these shows what there is.
    let shown = |name: &str| names.contains(&name) || ENERGIES.iter().any(|(n, _)| *n == name);
    let known = SINGLE.iter().map(|(name, _)| *name).filter(|name| trajectory.index(name).is_some());
    let others = trajectory.channels().iter().map(|c| c.name.as_str());
    let mut fillers: Vec<&str> = Vec::new();
    for name in known.chain(others) {
        if !shown(name) && !fillers.contains(&name) {
            fillers.push(name);
        }
    }
    for name in fillers {
        if panels.len() < 2 || (panels.len() > PANELS && panels.len() % 2 == 1) {
            panels.extend(panel(&[(None, trajectory)], name));
        }
    }
    figure(panels, title)
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
        // The first run has no difference: colours and dashes are those of the others.
        for (series, number) in apart.series.iter_mut().zip(1..) {
            (series.color, series.line, series.name) = (Some(number), Line::Solid, None);
        }
        if !panels.is_empty() {
            values.series.iter_mut().for_each(|series| series.name = None);
        }
        panels.extend([values, apart]);
    }
    Figure { title: title.map(String::from), panels, columns: 2, share_x: true }
}

fn figure(panels: Vec<Panel>, title: Option<&str>) -> Figure {
    let columns = if panels.len() < PANELS { 1 } else { 2 };
    Figure { title: title.map(String::from), panels, columns, share_x: true }
}

fn panel(runs: &[(Option<&str>, &Trajectory)], name: &str) -> Option<Panel> {
    let mut y = None;
    let mut series = Vec::new();
    for (number, (run, trajectory)) in runs.iter().enumerate() {
        if let Some(i) = trajectory.index(name) {
            y.get_or_insert_with(|| axis(&trajectory.channels()[i]));
            // A later run that covers an earlier one lets it be seen through its gaps.
            let line = [Line::Solid, Line::Dashed, Line::Dotted][number % 3];
            series.push(Series { color: Some(number), line, ..Series::line(*run, points(trajectory, i)) });
        }
    }
    Some(Panel { x: Axis::time(), y: y?, series, words: Vec::new() })
}

fn energies(trajectory: &Trajectory) -> Vec<Panel> {
    let size = |i: usize| {
        let e = trajectory.extremes(i);
        e.min.abs().max(e.max.abs())
    };
    let found: Vec<(usize, &str, f64, usize)> = ENERGIES
        .iter()
        .enumerate()
        .filter_map(|(color, (name, word))| trajectory.index(name).map(|i| (i, *word, size(i), color)))
        .collect();
    let largest = found.iter().fold(0.0, |m: f64, f| m.max(f.2));
    let (large, small): (Vec<_>, Vec<_>) = found.into_iter().partition(|f| f.2 >= READABLE * largest);
    [large, small]
        .into_iter()
        .filter(|group| !group.is_empty())
        .map(|group| {
            let alone = group.len() == 1;
            let quantity =
                if alone { capitalised(&format!("{} energy", group[0].1)) } else { "Energy".into() };
            let series = group
                .iter()
                .map(|&(i, word, _, color)| Series {
                    color: Some(color),
                    ..Series::line((!alone).then_some(word), points(trajectory, i))
                })
                .collect();
            Panel { x: Axis::time(), y: Axis::new(quantity, "J"), series, words: Vec::new() }
        })
        .collect()
}

fn axis(channel: &Channel) -> Axis {
    let known = SINGLE.iter().find(|(name, _)| *name == channel.name);
    let quantity = known.map_or_else(|| capitalised(&channel.name.replace(['.', '_'], " ")), |k| k.1.into());
    Axis::new(quantity, channel.unit.replace('*', "·"))
}

fn points(trajectory: &Trajectory, index: usize) -> Vec<(f64, f64)> {
    trajectory.times().iter().copied().zip(trajectory.values(index)).collect()
}

fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |c| c.to_uppercase().chain(chars).collect())
}
