//! Small motions for control, and the stiffness of a place.

use super::watch::interruptible;
use super::{faults, value};
use flexion::analysis::linearization::Table;
use flexion_case::{LinearRequest, Reading};
use numpy::{PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyMapping;
use std::sync::Arc;

type Matrix<'py> = Bound<'py, PyArray2<f64>>;

fn matrix<'py>(py: Python<'py>, table: &Table) -> Matrix<'py> {
    let array = PyArray2::zeros(py, [table.rows, table.columns], false);
    let mut written = array.readwrite();
    for i in 0..table.rows {
        for j in 0..table.columns {
            if let Some(entry) = written.get_mut([i, j]) {
                *entry = table.get(i, j);
            }
        }
    }
    written.make_nonwriteable();
    array
}

/// Names of the coordinates; M, D, G, K, B, J, Z; P, V, A; units and values of the outputs; warnings.
pub type Linearized<'py> =
    (Vec<String>, [Matrix<'py>; 7], [Matrix<'py>; 3], Vec<String>, Vec<f64>, Vec<String>);

/// The equations of small motions of a case. Of each input there is its name and a load, or none.
pub fn linearize<'py>(
    py: Python<'py>,
    reading: &Arc<Reading>,
    speed: f64,
    free_hub: bool,
    inputs: Vec<(String, Option<Bound<'py, PyMapping>>)>,
    outputs: Vec<String>,
) -> PyResult<Linearized<'py>> {
    let text = |(name, load): (String, Option<Bound<'py, PyMapping>>)| {
        let load = load.map(|load| value::table(&load, &name, 0)).transpose()?;
        PyResult::Ok((name, load.map(|load| toml::Value::Table(load).to_string())))
    };
    let inputs = inputs.into_iter().map(text).collect::<PyResult<Vec<_>>>()?;
    let request = LinearRequest { speed, free_hub, inputs, outputs };
    let shared = Arc::clone(reading);
    let found = interruptible(py, move || shared.linearize(&request))?;
    let found = found.map_err(|error| faults::vibration(py, &error))?;
    let (of, by) = (&found.motions, &found.outputs.by);
    let names = of.coordinates.iter().map(|(_, name)| name.clone()).collect();
    let all = [&of.mass, &of.damping, &of.gyroscopic, &of.stiffness, &found.input, &of.jacobian, &of.basis];
    let arrays = all.map(|table| matrix(py, table));
    let outputs = by.each_ref().map(|table| matrix(py, table));
    Ok((names, arrays, outputs, found.units, found.at, found.warnings))
}

/// Names of the components, the stiffness, warnings.
pub type Held<'py> = (Vec<&'static str>, Matrix<'py>, Vec<String>);

/// The stiffness of a place.
pub fn stiffness_at<'py>(py: Python<'py>, reading: &Arc<Reading>, place: &str) -> PyResult<Held<'py>> {
    let (shared, place) = (Arc::clone(reading), place.to_owned());
    let found = interruptible(py, move || shared.stiffness_at(&place))?;
    let found = found.map_err(|error| faults::vibration(py, &error))?;
    Ok((found.components.to_vec(), matrix(py, &found.matrix), found.warnings))
}
