//! A page of HTML that plays the motion or the modes of vibration of a folder of results.
//!
//! The page is built from the sources in `lab/`, and needs no server and no network: the results stand in it as JSON, with
//! arrays in base64.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

use serde_json::{Map, Value};

use super::arrays::{Arrays, Numbers};
use super::artifact::Artifact;
use super::staging::current;
use super::view::{view_modes, view_run};
use super::{Results, ResultsError, archive};

/// The page without results.
const PAGE: &str = include_str!("page.html");
/// Where the results go.
const PLACE: &str = "\"the results\"";

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
    let scene = arrays(path, Artifact::Scene)?;
    let summary = read_json(path, Artifact::Summary).unwrap_or_default();
    let title = summary["case"]["title"].as_str().unwrap_or_default();
    view_run((title, &results.name), results.caution.as_deref(), &results.trajectory, scene, columns, &|_| {
        None
    })
}

/// Modes of vibration: the equilibrium and the shapes.
fn modes(path: &Path) -> Result<Value, ResultsError> {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let name = absolute.file_name().unwrap_or_default().to_string_lossy();
    let table = read_json(path, Artifact::ModesJson)?;
    Ok(view_modes(&name, table, arrays(path, Artifact::ModesScene)?, arrays(path, Artifact::ModesNpz)?))
}

fn read_json(path: &Path, artifact: Artifact) -> Result<Value, ResultsError> {
    let file = current(path, artifact);
    let read = std::fs::read(&file).map_err(|error| error.to_string());
    let value = read.and_then(|bytes| serde_json::from_slice(&bytes).map_err(|error| error.to_string()));
    value.map_err(|reason| ResultsError::Unreadable { path: file, reason })
}

/// The arrays of an archive of results, by name: shape and values.
fn arrays(path: &Path, artifact: Artifact) -> Result<Map<String, Value>, ResultsError> {
    let path = current(path, artifact);
    let unreadable = |reason: String| ResultsError::Unreadable { path: path.clone(), reason };
    let file = File::open(&path).map_err(|error| unreadable(error.to_string()))?;
    let mut all = Map::new();
    let read = archive::arrays(BufReader::new(file), |name, array| {
        let shape = array.shape().to_vec();
        match array.try_data::<f32>() {
            Ok(values) => all.put(name, &shape, Numbers::Single(&values.collect::<io::Result<Vec<_>>>()?)),
            Err(array) => all.put(name, &shape, Numbers::Double(&array.into_vec::<f64>()?)),
        }
    });
    read.map_err(unreadable)?;
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

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
    fn text_of_a_case_cannot_end_the_script() {
        let text = json!({ "title": "</script><b>" }).to_string().replace('<', "\\u003c");
        assert!(!text.contains('<'));
        let back: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(back["title"], "</script><b>");
    }
}
