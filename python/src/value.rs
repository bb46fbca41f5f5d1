//! Values of Python as those of a case: TOML in between, for a case is a text.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyMapping, PySequence, PyString};
use toml::{Table, Value};

/// Levels of tables within tables.
const DEEPEST: usize = 64;

/// A table of a mapping.
pub fn table(mapping: &Bound<'_, PyMapping>, path: &str, depth: usize) -> PyResult<Table> {
    let mut table = Table::new();
    for item in mapping.items()?.iter() {
        let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
        let key: String = key.extract().map_err(|_| {
            let place = if path.is_empty() { "the case".to_owned() } else { format!("`{path}`") };
            PyTypeError::new_err(format!("the keys of {place} are texts, and {key} is none"))
        })?;
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let value = self::value(&value, &path, depth + 1)?;
        table.insert(key, value);
    }
    Ok(table)
}

/// A value at a dotted path: a text, a boolean, a number, a list or a table; also those of NumPy.
pub fn value(given: &Bound<'_, PyAny>, path: &str, depth: usize) -> PyResult<Value> {
    if depth > DEEPEST {
        return Err(PyValueError::new_err(format!("{path}: tables deeper than {DEEPEST} levels")));
    }
    if let Ok(text) = given.cast::<PyString>() {
        return Ok(Value::String(text.to_str()?.to_owned()));
    }
    if let Ok(value) = given.cast::<PyBool>() {
        return Ok(Value::Boolean(value.is_true()));
    }
    if given.is_instance_of::<PyInt>() {
        let number = given.extract().map_err(|_| {
            PyValueError::new_err(format!("{path}: {given} is too large for an integer: write {given}.0"))
        })?;
        return Ok(Value::Integer(number));
    }
    if given.is_instance_of::<PyFloat>() {
        let x = given.extract()?;
        // A value of a result has its unit.
        let unit = if given.is_exact_instance_of::<PyFloat>() { None } else { given.getattr("unit").ok() };
        let unit = unit.and_then(|unit| unit.extract::<String>().ok()).filter(|unit| !unit.is_empty());
        let plain = number(x, path)?;
        return Ok(unit.map_or(plain, |unit| Value::String(format!("{x:e} {unit}"))));
    }
    if let Ok(mapping) = given.cast::<PyDict>() {
        return Ok(Value::Table(table(mapping.as_mapping(), path, depth)?));
    }
    if let Ok(mapping) = given.cast::<PyMapping>() {
        return Ok(Value::Table(table(mapping, path, depth)?));
    }
    // Arrays and scalars of NumPy, by the values of Python that they stand for.
    if let Ok(plain) = given.call_method0("tolist") {
        if !plain.get_type().is(given.get_type()) {
            return value(&plain, path, depth + 1);
        }
        // A real number of more digits than those of Python have is rounded to one.
        if plain.hasattr("is_integer")? {
            return number(plain.extract()?, path);
        }
    }
    if let Ok(list) = given.cast::<PySequence>()
        && !given.hasattr("decode")?
    {
        let count = list.len()?;
        let entries = (0..count).map(|i| value(&list.get_item(i)?, &format!("{path}[{i}]"), depth + 1));
        return Ok(Value::Array(entries.collect::<PyResult<_>>()?));
    }
    if let Ok(path_like) = given.call_method0("__fspath__") {
        return value(&path_like, path, depth + 1);
    }
    let kind = given.get_type().name()?;
    Err(PyTypeError::new_err(format!(
        "{path}: a value of the type {kind} is none of a case, which are texts, numbers, booleans, lists and tables"
    )))
}

fn number(x: f64, path: &str) -> PyResult<Value> {
    if x.is_finite() {
        return Ok(Value::Float(x));
    }
    Err(PyValueError::new_err(format!("{path}: {x} is no finite number")))
}
