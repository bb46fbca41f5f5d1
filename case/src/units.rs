//! Quantities as people write them, `"70 GPa"`, `"3000 rpm"`, `"4 cm^2"`, converted to SI numbers.
//!
//! A quantity is a decimal number and a unit. A unit is a product of named units with integer powers:
//! `kg/m^3`, `N*m^2`, `N m²`, `1/s`, `kg/(m*s)`. Angle is a dimension of its own, so that `rpm` and
//! `rad/s` are angular speeds and `Hz` is not. Decimal units shift the exponent of the number before
//! it is read, so that `"70 GPa"` is exactly the number `70e9`.

use flexion_results::nearest;
use std::borrow::Cow;
use std::ops::Range;

/// Exponents of length, mass, time and angle.
pub type Dimension = [i8; 4];

/// What a key measures: its dimension, SI unit and examples for messages.
#[derive(Debug, PartialEq, Eq)]
pub struct Measure {
    /// Name for people, e.g. `angular speed`.
    pub name: &'static str,
    /// SI unit, in which plain numbers are read.
    pub unit: Cow<'static, str>,
    /// Exponents of length, mass, time and angle.
    pub dimension: Dimension,
    /// Examples of accepted values, for messages.
    pub examples: &'static str,
}

macro_rules! measures {
    ($($ident:ident $name:literal $unit:literal $dimension:tt $examples:literal;)*) => {
        $(#[doc = concat!("The measure ", $name, " \\[", $unit, "\\].")]
        pub static $ident: Measure =
            Measure { name: $name, unit: Cow::Borrowed($unit), dimension: $dimension, examples: $examples };)*
    };
}

measures! {
    LENGTH "length" "m" [1, 0, 0, 0] "`10 m`, `250 mm`, `12 in`";
    STATION "station" "m" [1, 0, 0, 0] "`2 m`, `250 mm`";
    AREA "area" "m^2" [2, 0, 0, 0] "`4 cm^2`, `400 mm^2`";
    SECOND_MOMENT "second moment of area" "m^4" [4, 0, 0, 0] "`2e-7 m^4`, `20 cm^4`";
    MODULUS "modulus" "Pa" [-1, 1, -2, 0] "`70 GPa`, `210e9 Pa`";
    DENSITY "density" "kg/m^3" [-3, 1, 0, 0] "`3000 kg/m^3`, `2.7 g/cm^3`";
    MASS "mass" "kg" [0, 1, 0, 0] "`5 kg`, `300 g`";
    MASS_PER_LENGTH "mass per length" "kg/m" [-1, 1, 0, 0] "`1.2 kg/m`, `350 g/m`";
    FIRST_MASS_MOMENT "first mass moment per length" "kg" [0, 1, 0, 0] "`0.01 kg`";
    ROTARY_INERTIA "rotary inertia per length" "kg*m" [1, 1, 0, 0] "`6e-4 kg*m`";
    AXIAL_STIFFNESS "axial stiffness" "N" [1, 1, -2, 0] "`2.8e7 N`, `28 MN`";
    COUPLING_STIFFNESS "coupling stiffness" "N*m" [2, 1, -2, 0] "`150 N*m`";
    BENDING_STIFFNESS "bending stiffness" "N*m^2" [3, 1, -2, 0] "`1.4e4 N*m^2`, `14 kN m²`";
    INERTIA "moment of inertia" "kg*m^2" [2, 1, 0, 0] "`9.5 kg*m^2`";
    TIME "time" "s" [0, 0, 1, 0] "`20 s`, `5 ms`, `1 min`";
    ANGLE "angle" "rad" [0, 0, 0, 1] "`90 deg`, `1.5 rad`";
    TORQUE "torque" "N*m" [2, 1, -2, 0] "`20 N*m`, `1.5 kN*m`";
    ANGULAR_STIFFNESS "torque per angle" "N*m/rad" [2, 1, -2, -1] "`100 N*m/rad`";
    ANGULAR_DAMPING "torque per angular speed" "N*m*s/rad" [2, 1, -1, -1] "`5 N*m*s/rad`";
    FORCE "force" "N" [1, 1, -2, 0] "`10 N`, `2 kN`, `5 lbf`";
    FORCE_PER_LENGTH "force per length" "N/m" [0, 1, -2, 0] "`10 N/m`, `2 kN/m`";
    DAMPING "force per velocity" "N*s/m" [0, 1, -1, 0] "`5 N*s/m`";
    QUADRATIC_DRAG "force per length and square of velocity" "kg/m^2" [-2, 1, 0, 0] "`0.6 kg/m^2`";
    VISCOSITY "force per length and velocity" "N*s/m^2" [-1, 1, -1, 0] "`0.5 N*s/m^2`, `2 mPa*s`";
    ACCELERATION "acceleration" "m/s^2" [1, 0, -2, 0] "`9.81 m/s^2`";
    RATE "rate" "1/s" [0, 0, -1, 0] "`0.2 1/s`";
    FACTOR "factor" "1" [0, 0, 0, 0] "`1`, `0.5`";
    VELOCITY "velocity" "m/s" [1, 0, -1, 0] "`2 m/s`, `30 mm/s`";
    ANGULAR_SPEED "angular speed" "rad/s" [0, 0, -1, 1] "`4 rad/s`, `3000 rpm`, `90 deg/s`";
}

/// Why a text is no quantity of the expected measure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QuantityError {
    /// The offending bytes of the text.
    pub span: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// What to write instead.
    pub help: String,
}

/// A named unit: `mantissa` × 10^`exponent` SI units of `dimension`.
struct Unit {
    name: &'static str,
    mantissa: f64,
    exponent: i32,
    dimension: Dimension,
    prefixes: bool,
}

const fn unit(
    name: &'static str,
    mantissa: f64,
    exponent: i32,
    dimension: Dimension,
    prefixes: bool,
) -> Unit {
    Unit { name, mantissa, exponent, dimension, prefixes }
}

use std::f64::consts::PI;

const UNITS: &[Unit] = &[
    unit("m", 1.0, 0, [1, 0, 0, 0], true),
    unit("g", 1.0, -3, [0, 1, 0, 0], true),
    unit("s", 1.0, 0, [0, 0, 1, 0], true),
    unit("N", 1.0, 0, [1, 1, -2, 0], true),
    unit("Pa", 1.0, 0, [-1, 1, -2, 0], true),
    unit("J", 1.0, 0, [2, 1, -2, 0], true),
    unit("W", 1.0, 0, [2, 1, -3, 0], true),
    unit("rad", 1.0, 0, [0, 0, 0, 1], true),
    unit("Hz", 1.0, 0, [0, 0, -1, 0], true),
    unit("bar", 1.0, 5, [-1, 1, -2, 0], true),
    unit("t", 1.0, 3, [0, 1, 0, 0], false),
    unit("min", 6.0, 1, [0, 0, 1, 0], false),
    unit("h", 36.0, 2, [0, 0, 1, 0], false),
    unit("deg", PI / 180.0, 0, [0, 0, 0, 1], false),
    unit("°", PI / 180.0, 0, [0, 0, 0, 1], false),
    unit("rev", 2.0 * PI, 0, [0, 0, 0, 1], false),
    unit("rpm", PI / 30.0, 0, [0, 0, -1, 1], false),
    unit("in", 254.0, -4, [1, 0, 0, 0], false),
    unit("ft", 3048.0, -4, [1, 0, 0, 0], false),
    unit("yd", 9144.0, -4, [1, 0, 0, 0], false),
    unit("lb", 45359237.0, -8, [0, 1, 0, 0], false),
    unit("slug", 14.593902937206365, 0, [0, 1, 0, 0], false),
    unit("lbf", 4.4482216152605, 0, [1, 1, -2, 0], false),
    unit("psi", 6894.757293168361, 0, [-1, 1, -2, 0], false),
    unit("ksi", 6894757.293168361, 0, [-1, 1, -2, 0], false),
];

const PREFIXES: &[(&str, i32)] = &[
    ("da", 1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
    ("P", 15),
    ("d", -1),
    ("c", -2),
    ("m", -3),
    ("µ", -6),
    ("μ", -6),
    ("u", -6),
    ("n", -9),
    ("p", -12),
];

/// Reads `text` as a quantity of `measure`; a number without unit is in SI.
///
/// # Errors
/// When the number or the unit cannot be read, the unit is of another dimension, or the value is not
/// finite. The error points into `text`.
pub fn parse(text: &str, measure: &Measure) -> Result<f64, QuantityError> {
    let fail = |span: Range<usize>, message: String| QuantityError {
        span,
        message,
        help: format!("write {} in {} or a unit of it: {}", article(measure), measure.unit, measure.examples),
    };
    let start = text.len() - text.trim_start().len();
    let end = text.trim_end().len().max(start);
    let (mantissa, exponent, length) = number(&text[start..end]);
    if length == 0 {
        let what = if start == end { "an empty text is no" } else { "expected a number at the start of the" };
        return Err(fail(start..end, format!("{what} {}", measure.name)));
    }
    let (number_end, rest) = (start + length, &text[start + length..end]);
    if rest.starts_with(',') {
        let message = "a decimal comma is not read; write a point".to_owned();
        return Err(fail(number_end..number_end + 1, message));
    }
    let skip = rest.len() - rest.trim_start().len();
    let unit_start = number_end + skip;
    let mut scale = Scale::ONE;
    if unit_start < end {
        let mut parser = Parser { text: &text[unit_start..end], at: 0, wanted: measure.dimension };
        scale = parser
            .product(0)
            .map_err(|(span, message)| fail(unit_start + span.start..unit_start + span.end, message))?;
        if scale.dimension != measure.dimension {
            return Err(fail(unit_start..end, wrong_dimension(&scale, measure, &text[unit_start..end])));
        }
    }
    // The decimal exponent is shifted in the text of the number, so that decimal units are exact.
    let shifted = format!("{mantissa}e{}", exponent.saturating_add(i64::from(scale.exponent)));
    let value = shifted.parse::<f64>().unwrap_or(f64::NAN) * scale.mantissa;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(fail(start..end, format!("the {} is too large for a number", measure.name)))
    }
}

/// As [`parse`], of a quantity in the unit `unit`.
///
/// # Errors
/// As [`parse`], or when `unit` is none.
pub fn parse_in(text: &str, unit: &str) -> Result<f64, QuantityError> {
    let fail = |(span, message): (Range<usize>, String)| QuantityError { span, message, help: String::new() };
    let scale = if unit.is_empty() {
        Scale::ONE
    } else {
        Parser { text: unit, at: 0, wanted: [0; 4] }.product(0).map_err(fail)?
    };
    let measure = Measure {
        name: "quantity",
        unit: Cow::Owned(unit.to_owned()),
        dimension: scale.dimension,
        examples: "`0.1 mm`, `1e-3 rad`",
    };
    parse(text, &measure)
}

/// "a length", "an angular speed".
pub fn article(measure: &Measure) -> String {
    let vowel = measure.name.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {}", if vowel { "an" } else { "a" }, measure.name)
}

fn wrong_dimension(scale: &Scale, measure: &Measure, written: &str) -> String {
    if measure.dimension == ANGULAR_SPEED.dimension && scale.dimension == [0, 0, -1, 0] {
        return format!(
            "`{written}` counts cycles, not angle: 1 Hz may mean 1 or 2π rad/s, so write rad/s or rpm"
        );
    }
    let known = [
        &LENGTH,
        &AREA,
        &SECOND_MOMENT,
        &MODULUS,
        &DENSITY,
        &MASS_PER_LENGTH,
        &FIRST_MASS_MOMENT,
        &AXIAL_STIFFNESS,
        &COUPLING_STIFFNESS,
        &BENDING_STIFFNESS,
        &INERTIA,
        &TIME,
        &ANGLE,
        &ANGULAR_SPEED,
    ];
    // A force is meant where the measure is called an axial stiffness, and so on: name the plain quantity.
    let name = known.iter().find(|m| m.dimension == scale.dimension).map(|m| match m.unit.as_ref() {
        "N" => "force",
        "N*m" => "moment or energy",
        "Pa" => "stress",
        "kg" => "mass",
        _ => m.name,
    });
    // Of a column only the unit is known.
    let wanted = match measure.name {
        "quantity" => {
            format!("what is measured in `{}`", if measure.unit.is_empty() { "1" } else { &measure.unit })
        }
        name => name.to_owned(),
    };
    match name {
        Some(name) => format!("`{written}` is a unit of {name}, not of {wanted}"),
        None => format!("`{written}` is not a unit of {wanted}"),
    }
}

/// Splits a leading decimal number: its digits without exponent, its exponent, and its length in bytes
/// (0 when there is none).
fn number(text: &str) -> (String, i64, usize) {
    let bytes = text.as_bytes();
    let mut at = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let digits = |mut at: usize| {
        let start = at;
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at - start
    };
    let whole = digits(at);
    at += whole;
    let mut fraction = 0;
    if bytes.get(at) == Some(&b'.') {
        fraction = digits(at + 1);
        if whole + fraction > 0 {
            at += 1 + fraction;
        }
    }
    if whole + fraction == 0 {
        return (String::new(), 0, 0);
    }
    let mantissa = text[..at].to_owned();
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        let count = digits(at + 1 + sign);
        if count > 0 {
            let end = at + 1 + sign + count;
            // Beyond i64 the number is zero or not finite either way.
            let limit = if bytes[at + 1] == b'-' { -1_000_000_000 } else { 1_000_000_000 };
            let exponent =
                text[at + 1..end].parse::<i64>().unwrap_or(limit).clamp(-1_000_000_000, 1_000_000_000);
            return (mantissa, exponent, end);
        }
    }
    (mantissa, 0, at)
}

/// A unit in SI: `mantissa` × 10^`exponent`, with its dimension.
#[derive(Clone, Copy)]
struct Scale {
    mantissa: f64,
    exponent: i32,
    dimension: Dimension,
}

impl Scale {
    const ONE: Scale = Scale { mantissa: 1.0, exponent: 0, dimension: [0; 4] };

    fn times(self, other: Scale, power: i8) -> Option<Scale> {
        let mut dimension = self.dimension;
        for (own, other) in dimension.iter_mut().zip(other.dimension) {
            *own = own.checked_add(other.checked_mul(power)?)?;
        }
        let mantissa = self.mantissa * other.mantissa.powi(i32::from(power));
        let exponent = self.exponent.checked_add(other.exponent.checked_mul(i32::from(power))?)?;
        Some(Scale { mantissa, exponent, dimension })
    }
}

type Fault = (Range<usize>, String);

struct Parser<'t> {
    text: &'t str,
    at: usize,
    /// Dimension of the whole unit that is expected.
    wanted: Dimension,
}

impl Parser<'_> {
    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    /// factor ((`*` | `·` | `/` | space) factor)*, up to the end or a closing parenthesis.
    fn product(&mut self, depth: usize) -> Result<Scale, Fault> {
        let mut scale = Scale::ONE;
        let mut sign = 1;
        let mut first = true;
        loop {
            self.spaces();
            let operator = self.peek();
            match operator {
                None => break,
                Some(')') if depth > 0 => break,
                Some('*' | '·' | '⋅' | '/') if !first => {
                    self.at += operator.map_or(0, char::len_utf8);
                    sign = if operator == Some('/') { -1 } else { 1 };
                    self.spaces();
                }
                Some(_) if !first => sign = 1,
                Some(_) => {}
            }
            let start = self.at;
            let (factor, power) = self.factor(depth)?;
            scale = scale
                .times(factor, power * sign)
                .ok_or_else(|| (start..self.at, "the power is too large".to_owned()))?;
            first = false;
        }
        if first {
            return Err((self.at..self.text.len(), "expected a unit".to_owned()));
        }
        Ok(scale)
    }

    fn spaces(&mut self) {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
    }

    /// A unit name, `1` or a product in parentheses, with its power.
    fn factor(&mut self, depth: usize) -> Result<(Scale, i8), Fault> {
        let start = self.at;
        let scale = match self.peek() {
            Some('(') if depth < 8 => {
                self.at += 1;
                let scale = self.product(depth + 1)?;
                if self.peek() != Some(')') {
                    return Err((start..self.text.len(), "this parenthesis is not closed".to_owned()));
                }
                self.at += 1;
                scale
            }
            Some('1') => {
                self.at += 1;
                Scale::ONE
            }
            _ => {
                let rest = &self.text[self.at..];
                let length = rest.find(|c: char| !(c.is_alphabetic() || c == '°')).unwrap_or(rest.len());
                if length == 0 {
                    let end = self.peek().map_or(start, |c| start + c.len_utf8());
                    return Err((start..end, "expected a unit here".to_owned()));
                }
                self.at += length;
                let name = &rest[..length];
                named(name).ok_or_else(|| (start..self.at, unknown(name, self.wanted)))?
            }
        };
        Ok((scale, self.power()?))
    }

    /// `^2`, `²`, `^-1`, `⁻¹`, `2` or nothing, which is 1.
    fn power(&mut self) -> Result<i8, Fault> {
        let start = self.at;
        if self.peek() == Some('^') {
            self.at += 1;
        }
        let mut digits = String::new();
        while let Some(c) = self.peek() {
            let plain = match c {
                '0'..='9' => c,
                '-' if digits.is_empty() && self.at > start => c,
                '⁻' if digits.is_empty() => '-',
                '⁰' => '0',
                '¹' => '1',
                '²' => '2',
                '³' => '3',
                '⁴'..='⁹' => char::from_digit(c as u32 - '⁰' as u32, 10).unwrap_or('0'),
                _ => break,
            };
            digits.push(plain);
            self.at += c.len_utf8();
        }
        if self.at == start {
            return Ok(1);
        }
        match digits.parse::<i8>() {
            Ok(power) if (-9..=9).contains(&power) && power != 0 => Ok(power),
            _ => Err((start..self.at, "a power is an integer from 1 to 9, or negative".to_owned())),
        }
    }
}

/// That there is no unit of this name, and the one that was likely meant: one of the dimension that is wanted, if any is near.
fn unknown(name: &str, wanted: Dimension) -> String {
    let plain = UNITS.iter().map(|u| (u.name.to_owned(), u.dimension));
    let prefixed = UNITS
        .iter()
        .filter(|u| u.prefixes)
        .flat_map(|u| PREFIXES.iter().map(move |(prefix, _)| (format!("{prefix}{}", u.name), u.dimension)));
    let known: Vec<_> = plain.chain(prefixed).map(|(name, of)| (name.to_lowercase(), name, of)).collect();
    let written = name.to_lowercase();
    let among = |fits: fn(&Dimension, &Dimension) -> bool| {
        let fitting = || known.iter().filter(|(_, _, of)| fits(of, &wanted));
        // Most often only a letter is of the wrong size: `Gpa`, `KG`. A single letter is near to every other one.
        let same = fitting().find(|(lower, ..)| *lower == written);
        let near = || {
            let near = nearest(&written, fitting().map(|(lower, ..)| lower.as_str()))?;
            fitting().find(|(lower, ..)| lower == near).filter(|_| name.chars().nth(1).is_some())
        };
        same.or_else(near)
    };
    match among(|of, wanted| of == wanted).or_else(|| among(|_, _| true)) {
        Some((_, meant, _)) => format!("unknown unit `{name}`; did you mean `{meant}`?"),
        None => format!("unknown unit `{name}`"),
    }
}

/// The unit of this name, with or without a prefix; a name without prefix wins (`min` is a minute).
fn named(name: &str) -> Option<Scale> {
    let plain = |name: &str| UNITS.iter().find(|u| u.name == name);
    let scale = |u: &Unit, shift| Scale {
        mantissa: u.mantissa,
        exponent: u.exponent + shift,
        dimension: u.dimension,
    };
    if let Some(unit) = plain(name) {
        return Some(scale(unit, 0));
    }
    PREFIXES.iter().find_map(|(prefix, shift)| {
        plain(name.strip_prefix(prefix)?).filter(|u| u.prefixes).map(|u| scale(u, *shift))
    })
}

#[cfg(test)]
mod tests;
