use super::*;
use std::f64::consts::{FRAC_PI_2, TAU};

#[test]
fn decimal_units_give_exactly_the_written_number() {
    for (text, measure, value) in [
        ("70 GPa", &MODULUS, 70e9),
        ("70GPa", &MODULUS, 70e9),
        ("210e9 Pa", &MODULUS, 210e9),
        ("10 m", &LENGTH, 10.0),
        ("0.1 mm", &LENGTH, 0.1e-3),
        ("4 cm^2", &AREA, 4e-4),
        ("4 cm²", &AREA, 4e-4),
        ("400 mm2", &AREA, 4e-4),
        ("20 cm^4", &SECOND_MOMENT, 20e-8),
        ("2.7 g/cm^3", &DENSITY, 2700.0),
        ("2.7 g cm^-3", &DENSITY, 2700.0),
        ("1.2 kg/m", &MASS_PER_LENGTH, 1.2),
        ("5 N*m^2", &BENDING_STIFFNESS, 5.0),
        ("5 N m²", &BENDING_STIFFNESS, 5.0),
        ("5 N·m²", &BENDING_STIFFNESS, 5.0),
        ("5 kN m²", &BENDING_STIFFNESS, 5000.0),
        ("-3 µm", &LENGTH, -3e-6),
        ("4 rad/s", &ANGULAR_SPEED, 4.0),
        ("1 min", &TIME, 60.0),
        ("5 ms", &TIME, 5e-3),
        (" 1.5e-3 kg m / (m) ", &FIRST_MASS_MOMENT, 1.5e-3),
        ("3 t", &FIRST_MASS_MOMENT, 3000.0),
        ("7", &LENGTH, 7.0),
        ("1e-400 m", &LENGTH, 0.0),
    ] {
        assert_eq!(parse(text, measure), Ok(value), "{text}");
    }
}

#[test]
fn other_units_agree_with_their_definitions() {
    for (text, measure, value) in [
        ("3000 rpm", &ANGULAR_SPEED, 100.0 * PI),
        ("1 rev/s", &ANGULAR_SPEED, TAU),
        ("90 deg/s", &ANGULAR_SPEED, FRAC_PI_2),
        ("90 deg", &ANGLE, FRAC_PI_2),
        ("90°", &ANGLE, FRAC_PI_2),
        ("12 in", &LENGTH, 0.3048),
        ("5 ft", &LENGTH, 1.524),
        ("2 h", &TIME, 7200.0),
        ("1 lb/ft", &MASS_PER_LENGTH, 1.4881639435695537),
        ("30e6 psi", &MODULUS, 2.0684271879505084e11),
    ] {
        let read = parse(text, measure).unwrap();
        assert!((read - value).abs() <= 1e-15 * value.abs() * 4.0, "{text}: {read} for {value}");
    }
}

#[test]
fn a_wrong_unit_is_named_where_it_stands() {
    for (text, measure, span, message) in [
        ("10 s", &LENGTH, 3..4, "`s` is a unit of time, not of length"),
        ("4 Hz", &ANGULAR_SPEED, 2..4, "`Hz` counts cycles"),
        ("4 1/s", &ANGULAR_SPEED, 2..5, "`1/s` counts cycles"),
        ("4 furlong", &LENGTH, 2..9, "unknown unit `furlong`"),
        ("4 kg/qq", &MASS_PER_LENGTH, 5..7, "unknown unit `qq`"),
        ("long", &LENGTH, 0..4, "expected a number"),
        ("", &LENGTH, 0..0, "an empty text"),
        ("   ", &LENGTH, 3..3, "an empty text"),
        ("1,5 m", &LENGTH, 1..2, "decimal comma"),
        ("nan m", &LENGTH, 0..5, "expected a number"),
        ("inf", &LENGTH, 0..3, "expected a number"),
        ("1e999 m", &LENGTH, 0..7, "too large"),
        ("5 m^99", &LENGTH, 3..6, "a power is"),
        ("5 m^", &LENGTH, 3..4, "a power is"),
        ("5 m/", &LENGTH, 4..4, "expected a unit"),
        ("5 (m", &LENGTH, 2..4, "not closed"),
        ("5 m)", &LENGTH, 3..4, "expected a unit"),
        ("70 GP", &MODULUS, 3..5, "unknown unit `GP`; did you mean `GPa`?"),
        ("5 fft", &LENGTH, 2..5, "unknown unit `fft`; did you mean `ft`?"),
        ("5 MM", &LENGTH, 2..4, "did you mean `Mm`?"),
        ("5 kilogram", &LENGTH, 2..10, "unknown unit `kilogram`"),
        ("5 m^9^9", &LENGTH, 5..6, "expected a unit"),
    ] {
        let error = parse(text, measure).unwrap_err();
        assert!(error.message.contains(message), "{text}: {}", error.message);
        assert_eq!(error.span, span, "{text}: {}", error.message);
    }
}

#[test]
fn no_text_makes_the_parser_panic() {
    let pieces =
        ["1", "e", "-", ".", " ", "m", "^", "²", "⁻", "/", "*", "(", ")", "°", "µ", "9", "\u{301}", "N"];
    let mut state = 1_u64;
    for _ in 0..20_000 {
        let mut text = String::new();
        for _ in 0..9 {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            text.push_str(pieces[(state >> 33) as usize % pieces.len()]);
        }
        if let Err(error) = parse(&text, &LENGTH) {
            assert!(text.get(error.span).is_some(), "{text}");
        }
    }
}

#[test]
fn a_unit_of_another_kind_than_a_column_is_refused_with_its_unit() {
    let said = |text: &str, unit: &str| parse_in(text, unit).unwrap_err().message;
    assert_eq!(said("1 kg", "m"), "`kg` is a unit of mass, not of what is measured in `m`");
    assert_eq!(said("1 kg", ""), "`kg` is a unit of mass, not of what is measured in `1`");
}
