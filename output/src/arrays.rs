//! Named arrays of numbers: for an archive of NumPy, or for a page.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Map, Value, json};
use std::io;

/// The numbers of an array, of which the last index runs fastest.
#[derive(Clone, Copy, Debug)]
pub enum Numbers<'a> {
    /// In single precision.
    Single(&'a [f32]),
    /// In double precision.
    Double(&'a [f64]),
}

/// Where named arrays go.
pub trait Arrays {
    /// Takes an array.
    ///
    /// # Errors
    /// What goes wrong in writing it.
    fn put(&mut self, name: &str, shape: &[u64], numbers: Numbers<'_>) -> io::Result<()>;
}

/// For a page: shape and values of each.
impl Arrays for Map<String, Value> {
    fn put(&mut self, name: &str, shape: &[u64], numbers: Numbers<'_>) -> io::Result<()> {
        let values = match numbers {
            Numbers::Single(values) => encoded("f4", values.iter().map(|x| x.to_le_bytes())),
            Numbers::Double(values) => encoded("f8", values.iter().map(|x| x.to_le_bytes())),
        };
        self.insert(name.to_owned(), json!({ "shape": shape, "values": values }));
        Ok(())
    }
}

/// Puts a list.
pub(super) fn list(to: &mut dyn Arrays, name: &str, values: impl Iterator<Item = f64>) -> io::Result<()> {
    let values: Vec<f64> = values.collect();
    to.put(name, &[values.len() as u64], Numbers::Double(&values))
}

/// Values in single precision.
pub(super) fn single(values: &[f64]) -> Value {
    encoded("f4", values.iter().map(|x| (*x as f32).to_le_bytes()))
}

/// Values in double precision.
pub(super) fn double(values: &[f64]) -> Value {
    encoded("f8", values.iter().map(|x| x.to_le_bytes()))
}

/// Bytes of numbers, little end first, in base64 behind the kind of number.
fn encoded<const N: usize>(kind: &str, numbers: impl Iterator<Item = [u8; N]>) -> Value {
    let bytes: Vec<u8> = numbers.flatten().collect();
    format!("{kind}:{}", STANDARD.encode(bytes)).into()
}
