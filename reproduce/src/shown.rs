//! Numbers as they are shown to people.

use crate::term::Number;
use flexion_results::with_error_of;

/// Digits of an error: one, rounded up, may say that values overlap which a rule tells apart.
const DIGITS: i32 = 2;
/// Part of a value up to which its error is rounding.
const ROUNDING: f64 = 1e-10;

/// A number with its error and unit: `-0.4003350 ± 1.4e-6 m`, or in per cent what is a part of something.
pub fn shown(number: &Number) -> String {
    let (factor, unit) = if number.part { (100.0, "%") } else { (1.0, number.unit.as_str()) };
    let value = factor * number.value;
    // A part is a difference of values of that of which it is one.
    let size = if number.part { number.value.abs().max(1.0) } else { number.value.abs() };
    let text = match number.error {
        _ if number.varies => two_digits(value),
        // Rounding is no error to be stated.
        Some(error) if error > ROUNDING * size => with_error_of(value, factor * error, DIGITS),
        Some(_) => plain(value),
        None => format!("{} ± ?", plain(value)),
    };
    format!("{text} {}", unit_shown(unit)).trim_end().to_owned()
}

/// A number with two digits.
fn two_digits(value: f64) -> String {
    let decimals = 1.0 - value.abs().max(f64::MIN_POSITIVE).log10().floor();
    format!("{value:.*}", decimals.clamp(0.0, 9.0) as usize)
}

/// A number without an error: a count in full, any other with six digits.
pub fn plain(value: f64) -> String {
    if value == value.trunc() && value.abs() < 1e9 {
        return format!("{value:.0}");
    }
    let size = value.abs().log10().floor();
    if (-4.0..6.0).contains(&size) {
        let text = format!("{value:.*}", (5.0 - size).max(0.0) as usize);
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{value:.5e}")
    }
}

/// A unit as it is printed.
pub fn unit_shown(unit: &str) -> String {
    unit.replace('*', "·").replace("^2", "²").replace("^3", "³")
}
