//! The figure of one or several runs, of the columns that are asked for.

use super::{Figure, compare_figure, trajectory_figure};
use crate::{ResultsError, Trajectory, select};
use flexion::system::Role;

/// Most columns of several runs when none are asked for.
const USUAL: usize = 4;
/// Most panels of a figure.
const MOST: usize = 24;

/// Runs by their names, one panel for each column whose name matches one of the `patterns`; without a pattern the figure of a run, or
/// the first principal columns of several.
///
/// # Errors
/// [`ResultsError`]: a pattern that matches nothing, too many columns.
pub fn runs_figure(
    runs: &[(&str, &Trajectory)],
    patterns: &[String],
    title: Option<&str>,
) -> Result<Figure, ResultsError> {
    if let ([(_, one)], true) = (runs, patterns.is_empty()) {
        return Ok(trajectory_figure(one, title));
    }
    // The columns of all runs, each once, those of the first run first.
    let mut names: Vec<&str> = Vec::new();
    let mut usual: Vec<&str> = Vec::new();
    for channel in runs.iter().flat_map(|(_, trajectory)| trajectory.channels()) {
        if !names.contains(&channel.name.as_str()) {
            names.push(&channel.name);
            usual.extend((channel.role == Role::Primary).then_some(channel.name.as_str()));
        }
    }
    let of = if runs.len() == 1 { "these results" } else { "any of these results" };
    let columns: Vec<&str> = if patterns.is_empty() {
        let columns = if usual.is_empty() { names } else { usual };
        columns.into_iter().take(USUAL).collect()
    } else {
        select(&names, patterns, of)?
    };
    if columns.len() > MOST {
        return Err(ResultsError::Columns { count: columns.len(), most: MOST });
    }
    let mut figure = compare_figure(runs, &columns, title);
    if runs.len() == 1 {
        // One needs no legend.
        figure.panels.iter_mut().flat_map(|panel| &mut panel.series).for_each(|series| series.name = None);
    }
    Ok(figure)
}
