//! Results as a page plays them: JSON, with arrays in base64.

use super::arrays::{curve, double, single};
use super::columns::shown_columns;
use super::{ResultsError, Trajectory, VERSION, select};
use serde_json::{Map, Value, json};

/// Most values of a curve: longer ones are thinned.
const MOST: usize = 4000;

/// A run: its title and name, what its reader should be warned of, its columns and the arrays of its scene; `columns` are patterns of those
/// to be shown at first, empty for the usual ones; `error` gives that of a column at every record, where it is known.
///
/// # Errors
/// [`ResultsError`]: no such column.
pub fn view_run(
    (title, name): (&str, &str),
    caution: Option<&str>,
    trajectory: &Trajectory,
    scene: Map<String, Value>,
    columns: &[String],
    error: &dyn Fn(usize) -> Option<Vec<f64>>,
) -> Result<Value, ResultsError> {
    let names: Vec<&str> = trajectory.channels().iter().map(|c| c.name.as_str()).collect();
    let shown = if columns.is_empty() {
        // Only a beam in the plane has a hub.
        let on_hub = scene.keys().any(|name| name.ends_with(".hub"));
        shown_columns(trajectory, !on_hub).into_iter().map(|i| names[i]).collect()
    } else {
        select(&names, columns, "these results")?
    };
    let times = thinned(trajectory.times(), false);
    let list = trajectory.channels().iter().enumerate().map(|(i, c)| {
        let values: Vec<f64> = trajectory.values(i).collect();
        let mut column = json!({
            "name": c.name, "unit": c.unit, "shown": shown.contains(&c.name.as_str()),
            "values": curve(&thinned(&values, true)),
        });
        if let Some(error) = error(i) {
            column["error"] = single(&thinned(&error, true));
        }
        column
    });
    Ok(json!({
        "title": title,
        "name": name,
        "version": VERSION,
        "caution": caution,
        "scene": scene,
        "curves": { "times": double(&times), "columns": list.collect::<Vec<_>>() },
    }))
}

/// Modes of vibration: their table, and the arrays of the equilibrium and of the shapes.
pub fn view_modes(name: &str, table: Value, scene: Map<String, Value>, shapes: Map<String, Value>) -> Value {
    json!({
        "title": table["title"].as_str().unwrap_or_default(),
        "name": name,
        "version": VERSION,
        "scene": scene,
        "modes": { "table": table, "shapes": shapes },
    })
}

/// At most [`MOST`] values: of longer lists two for each of equal groups, the smallest and the largest in their order, or
/// else the first and the last.
fn thinned(values: &[f64], extremes: bool) -> Vec<f64> {
    if values.len() <= MOST {
        return values.to_vec();
    }
    let two = |group: &[f64]| {
        let last = group.len() - 1;
        if !extremes {
            return [group[0], group[last]];
        }
        let by = |a: &usize, b: &usize| group[*a].total_cmp(&group[*b]);
        let (low, high) = ((0..=last).min_by(by).unwrap_or(0), (0..=last).max_by(by).unwrap_or(last));
        [group[low.min(high)], group[low.max(high)]]
    };
    values.chunks(values.len().div_ceil(MOST / 2)).flat_map(two).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_curve_keeps_its_extremes_and_ends() {
        let mut long: Vec<f64> = (0..100_003).map(|i| f64::from(i) * 1e-9).collect();
        (long[77], long[78]) = (3.0, -2.0);
        let thin = thinned(&long, true);
        assert!(thin.len() <= MOST, "{}", thin.len());
        assert_eq!(thin[2..4], [3.0, -2.0]);
        let times = thinned(&long, false);
        assert_eq!((times.len(), times[0], times[times.len() - 1]), (thin.len(), long[0], long[100_002]));
        assert_eq!(thinned(&long[..MOST], true), long[..MOST]);
    }
}
