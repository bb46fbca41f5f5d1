//! A page of HTML that plays the motion or the modes of vibration of a folder of results.
//!
//! The page is built from the sources in `lab/`, and needs no server and no network: the results stand in it as JSON, with
//! arrays in base64.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Map, Value, json};

use super::artifact::Artifact;
use super::plot::shown_columns;
use super::staging::current;
use super::{Results, ResultsError, VERSION, archive, select};

/// The page without results.
const PAGE: &str = include_str!("page.html");
/// Where the results go.
const PLACE: &str = "\"the results\"";
/// Most values of a curve: longer ones are thinned.
const MOST: usize = 4000;

/// The page for a folder of results; `columns` are patterns of those to be shown at first, empty for the usual ones.
///
/// # Errors
/// [`ResultsError`]: no results, nothing that moves, a file that cannot be read, no such column.
pub fn view_page(path: &Path, columns: &[String]) -> Result<String, ResultsError> {
    if !path.is_dir() {
        return Err(ResultsError::NoMotion { path: path.to_path_buf() });
    }
    let data = if current(path, Artifact::Scene).is_file() {
        motion(path, columns)?
    } else if current(path, Artifact::ModesScene).is_file() {
        modes(path)?
    } else {
        return Err(ResultsError::NoMotion { path: path.to_path_buf() });
    };
    // Within a script of the page no `<` may begin a tag.
    let text = data.to_string().replace('<', "\\u003c");
    Ok(PAGE.replacen(PLACE, &text, 1))
}

/// A run: its motion in space and its columns.
fn motion(path: &Path, columns: &[String]) -> Result<Value, ResultsError> {
    let results = Results::read(path)?;
    let trajectory = &results.trajectory;
    let names: Vec<&str> = trajectory.channels().iter().map(|c| c.name.as_str()).collect();
    let scene = arrays(path, Artifact::Scene)?;
    let shown = if columns.is_empty() {
        // Only a beam in the plane has a hub.
        let on_hub = scene.as_object().is_some_and(|arrays| arrays.keys().any(|name| name.ends_with(".hub")));
        shown_columns(trajectory, !on_hub).into_iter().map(|i| names[i]).collect()
    } else {
        select(&names, columns, "these results")?
    };
    let summary = read_json(path, Artifact::Summary).unwrap_or_default();
    let times = thinned(trajectory.times(), false);
    let list = trajectory.channels().iter().enumerate().map(|(i, c)| {
        let values: Vec<f64> = trajectory.values(i).collect();
        json!({
            "name": c.name, "unit": c.unit, "shown": shown.contains(&c.name.as_str()),
            "values": single(&thinned(&values, true)),
        })
    });
    Ok(json!({
        "title": summary["case"]["title"].as_str().unwrap_or_default(),
        "name": results.name,
        "version": VERSION,
        "caution": results.caution,
        "scene": scene,
        "curves": { "times": double(&times), "columns": list.collect::<Vec<_>>() },
    }))
}

/// Modes of vibration: the equilibrium and the shapes.
fn modes(path: &Path) -> Result<Value, ResultsError> {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let table = read_json(path, Artifact::ModesJson)?;
    Ok(json!({
        "title": table["title"].as_str().unwrap_or_default(),
        "name": absolute.file_name().unwrap_or_default().to_string_lossy(),
        "version": VERSION,
        "scene": arrays(path, Artifact::ModesScene)?,
        "modes": { "table": table, "shapes": arrays(path, Artifact::ModesNpz)? },
    }))
}

fn read_json(path: &Path, artifact: Artifact) -> Result<Value, ResultsError> {
    let file = current(path, artifact);
    let read = std::fs::read(&file).map_err(|error| error.to_string());
    let value = read.and_then(|bytes| serde_json::from_slice(&bytes).map_err(|error| error.to_string()));
    value.map_err(|reason| ResultsError::Unreadable { path: file, reason })
}

/// The arrays of an archive of results, by name: shape and values.
fn arrays(path: &Path, artifact: Artifact) -> Result<Value, ResultsError> {
    let path = current(path, artifact);
    let unreadable = |reason: String| ResultsError::Unreadable { path: path.clone(), reason };
    let file = File::open(&path).map_err(|error| unreadable(error.to_string()))?;
    let mut all = Map::new();
    let read = archive::arrays(BufReader::new(file), |name, array| {
        let shape = array.shape().to_vec();
        let values = match array.try_data::<f32>() {
            Ok(values) => {
                encoded("f4", values.collect::<io::Result<Vec<_>>>()?.iter().map(|x| x.to_le_bytes()))
            }
            Err(array) => double(&array.into_vec::<f64>()?),
        };
        all.insert(name.to_owned(), json!({ "shape": shape, "values": values }));
        Ok(())
    });
    read.map_err(unreadable)?;
    Ok(Value::Object(all))
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

/// Values in single precision.
fn single(values: &[f64]) -> Value {
    encoded("f4", values.iter().map(|x| (*x as f32).to_le_bytes()))
}

/// Values in double precision.
fn double(values: &[f64]) -> Value {
    encoded("f8", values.iter().map(|x| x.to_le_bytes()))
}

/// Bytes of numbers, little end first, in base64 behind the kind of number.
fn encoded<const N: usize>(kind: &str, numbers: impl Iterator<Item = [u8; N]>) -> Value {
    let bytes: Vec<u8> = numbers.flatten().collect();
    format!("{kind}:{}", STANDARD.encode(bytes)).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_whole_in_itself() {
        assert_eq!(PAGE.matches(PLACE).count(), 1);
        assert!(PAGE.contains("default-src 'none'"), "no request is allowed");
        for outside in ["<link", "<script src", "<img", "@import", "sourceMappingURL"] {
            assert!(!PAGE.contains(outside), "{outside}");
        }
        for licensed in ["three.js authors", "Leon Sorokin", "Permission is hereby granted"] {
            assert!(PAGE.contains(licensed), "{licensed}");
        }
    }

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

    #[test]
    fn text_of_a_case_cannot_end_the_script() {
        let text = json!({ "title": "</script><b>" }).to_string().replace('<', "\\u003c");
        assert!(!text.contains('<'));
        let back: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(back["title"], "</script><b>");
    }
}
