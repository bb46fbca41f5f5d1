//! Values as they are shown.

/// A value with its error, e.g. `-0.400335 ± 2e-6`: the error rounded up to one digit, the value to the place of it, and to
/// ten digits at most.
pub fn with_error(value: f64, error: f64) -> String {
    with_error_of(value, error, 1)
}

/// The same with an error of so many digits: `-0.4003350 ± 1.4e-6`.
pub fn with_error_of(value: f64, error: f64, digits: i32) -> String {
    if !(value.is_finite() && error.is_finite()) {
        return format!("{value:.6e} ± {error:.0e}");
    }
    let place = |x: f64| libm::log10(x.abs()).floor() as i32;
    let size = place(value.abs().max(error).max(f64::MIN_POSITIVE));
    let mut first = if error > 0.0 { place(error) } else { size - 9 };
    let most = 10f64.powi(digits - 1);
    let mut rounded = (most * error / 10f64.powi(first) - 1e-9).ceil();
    if rounded >= 10.0 * most {
        (rounded, first) = (most, first + 1);
    }
    let last = first - (digits - 1);
    let last_shown = last.max(size - 9);
    let number = if value == 0.0 {
        "0".to_owned()
    } else if (-4..7).contains(&size) {
        format!("{value:.*}", (-last_shown).max(0) as usize)
    } else {
        format!("{value:.*e}", (size - last_shown).max(0) as usize)
    };
    if error > 0.0 {
        let (decimals, leading) = ((digits - 1).max(0), rounded / most);
        if (-1..4).contains(&first) {
            let decimals = (decimals - first).max(0) as usize;
            return format!("{number} ± {:.decimals$}", leading * 10f64.powi(first));
        }
        format!("{number} ± {leading:.*}e{first}", decimals as usize)
    } else {
        number
    }
}

#[cfg(test)]
mod tests {
    use super::{with_error, with_error_of};

    #[test]
    fn a_value_ends_at_the_place_of_its_error() {
        for (value, error, text) in [
            (-0.400_335_003, 1.35e-6, "-0.400335 ± 2e-6"),
            (-0.400_335_003, 9.6e-4, "-0.400 ± 1e-3"),
            (123.456, 0.5, "123.5 ± 0.5"),
            (123.456, 40.0, "123 ± 40"),
            (1.5e9, 2e6, "1.500e9 ± 2e6"),
            (-2.4e-6, 3e-9, "-2.400e-6 ± 3e-9"),
            (4.0, 0.0, "4.000000000"),
            (0.0, 2e-7, "0 ± 2e-7"),
            (3.2e-5, 1e-3, "0.000 ± 1e-3"),
        ] {
            assert_eq!(with_error(value, error), text);
        }
        for (value, error, text) in [
            (-0.400_335_003, 1.35e-6, "-0.4003350 ± 1.4e-6"),
            (123.456, 9.96, "123 ± 10"),
            (5.1, 13.2, "5 ± 14"),
            (3.1, 4.75, "3.1 ± 4.8"),
            (0.25, 3e-14, "0.2500000000 ± 3.0e-14"),
        ] {
            assert_eq!(with_error_of(value, error, 2), text);
        }
    }
}
