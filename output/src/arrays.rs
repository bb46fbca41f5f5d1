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

/// Least range of a curve in single precision, over its largest value: of a smaller one the steps of that precision would be seen.
const SEEN: f64 = 1e-3;

/// Values of a curve, in single precision where that is seen nowhere.
pub(super) fn curve(values: &[f64]) -> Value {
    let finite = || values.iter().copied().filter(|x| x.is_finite());
    let range = finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min);
    let largest = finite().fold(0.0_f64, |most, x| most.max(x.abs()));
    if range > 0.0 && range < SEEN * largest { double(values) } else { single(values) }
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

#[cfg(test)]
mod tests {
    use super::{curve, double, single};

    #[test]
    fn a_curve_that_hardly_varies_keeps_its_digits() {
        let small = [4.0, 4.0 + 1e-7];
        assert_eq!(curve(&small), double(&small));
        for values in [[4.0, 5.0], [4.0, 4.0], [0.0, 1e-7], [f64::NAN, 4.0]] {
            assert_eq!(curve(&values), single(&values));
        }
    }
}
