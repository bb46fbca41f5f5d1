//! Range, ticks, power of ten and label of an axis.
//!
//! The drawing library only ever sees numbers of ordinary size at round steps: values are first
//! mapped to s = (v − offset)/10ⁿ, or to log₁₀ v on a logarithmic axis.

use super::{Axis, Scale};

/// An axis with everything decided.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Resolved {
    scale: Scale,
    offset: f64,
    exponent: i32,
    /// Range in mapped numbers.
    pub range: (f64, f64),
    /// Distance of ticks in mapped numbers.
    pub step: f64,
    /// Label with unit.
    pub label: String,
}

/// Beyond this, sizes are cut off: sums and steps stay clear of the ends of the number range.
const LARGEST: f64 = 1e300;
/// Below this, sizes are zero.
const SMALLEST: f64 = 1e-290;
/// A span below this fraction of the values is rounding noise.
const NOISE: f64 = 1e-13;

impl Resolved {
    /// Decides the axis for the given values, those that cannot be shown left out, with about
    /// `ticks` ticks.
    pub fn new(axis: &Axis, values: impl Iterator<Item = f64>, ticks: usize) -> Resolved {
        let shown = |v: &f64| v.is_finite() && (axis.scale == Scale::Linear || *v > SMALLEST);
        let (lo, hi) = match axis.range {
            Some((a, b)) if shown(&a) && shown(&b) && a != b => (a.min(b), a.max(b)),
            _ => values
                .filter(shown)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v))),
        };
        let (lo, hi) = if lo > hi { (1.0, 1.0) } else { (lo.max(-LARGEST), hi.min(LARGEST)) };
        match axis.scale {
            Scale::Linear => linear(axis, lo, hi, ticks),
            Scale::Logarithmic => logarithmic(axis, lo, hi, ticks),
        }
    }

    /// The number at which `v` is drawn, `None` where it cannot be.
    pub fn map(&self, v: f64) -> Option<f64> {
        let s = match self.scale {
            Scale::Linear => scaled(v.clamp(-LARGEST, LARGEST) - self.offset, self.exponent),
            Scale::Logarithmic if v > SMALLEST => v.log10(),
            Scale::Logarithmic => return None,
        };
        s.is_finite().then_some(s)
    }

    /// The text at the tick `s`.
    pub fn tick(&self, s: f64) -> String {
        match self.scale {
            Scale::Linear => number(s, decimals(self.step)),
            Scale::Logarithmic => format!("10{}", superscript(s.round() as i32)),
        }
    }

    /// The ticks in range.
    pub fn ticks(&self) -> Vec<f64> {
        let first = (self.range.0 / self.step - 1e-9).ceil();
        let last = (self.range.1 / self.step + 1e-9).floor();
        let count = (last - first).clamp(0.0, 100.0) as usize;
        (0..=count).map(|i| (first + i as f64) * self.step).collect()
    }
}

fn linear(axis: &Axis, lo: f64, hi: f64, ticks: usize) -> Resolved {
    let size = lo.abs().max(hi.abs());
    let size = if size < SMALLEST { 0.0 } else { size };
    let constant = hi - lo <= NOISE * size || size == 0.0;
    let middle = lo / 2.0 + hi / 2.0;
    // A small variation about a large value is shown as the difference from a round number.
    let offset = if !constant && (hi - lo) < 1e-3 * size {
        let digits = decade(hi - lo) + 1;
        unscaled(scaled(middle, digits).floor(), digits)
    } else {
        0.0
    };
    let (lo, hi) = if constant {
        let half = if size == 0.0 { 1.0 } else { 0.5 * size };
        (middle - half, middle + half)
    } else {
        (lo - offset, hi - offset)
    };
    let exponent = engineering(lo.abs().max(hi.abs()));
    let (lo, hi) = (scaled(lo, exponent), scaled(hi, exponent));
    let margin = if axis.tight && !constant || axis.range.is_some() { 0.0 } else { 0.06 * (hi - lo) };
    let (lo, hi) = (lo - margin, hi + margin);
    let step = round_step((hi - lo) / ticks.max(1) as f64);
    Resolved {
        scale: Scale::Linear,
        offset,
        exponent,
        range: (lo, hi),
        step,
        label: label(axis, offset, exponent),
    }
}

fn logarithmic(axis: &Axis, lo: f64, hi: f64, ticks: usize) -> Resolved {
    let (mut from, mut to) = ((lo.log10() + 1e-9).floor(), (hi.log10() - 1e-9).ceil());
    if to <= from {
        (from, to) = (from.min(to), from.min(to) + 1.0);
    }
    // Marks on the outermost decades stand clear of the frame.
    let margin = if axis.tight || axis.range.is_some() { 0.0 } else { 0.025 * (to - from) };
    let step = ((to - from) / (ticks.max(1) as f64 + 2.0)).ceil().max(1.0);
    Resolved {
        scale: Scale::Logarithmic,
        offset: 0.0,
        exponent: 0,
        range: (from - margin, to + margin),
        step,
        label: label(axis, 0.0, 0),
    }
}

/// `Quantity − offset [10ⁿ unit]`.
fn label(axis: &Axis, offset: f64, exponent: i32) -> String {
    let mut text = axis.quantity.clone();
    if offset != 0.0 {
        let sign = if offset < 0.0 { '+' } else { '−' };
        text.push_str(&format!(" {sign} {:?}", offset.abs()));
    }
    let factor = if exponent == 0 { String::new() } else { format!("10{}", superscript(exponent)) };
    let separator = if factor.is_empty() || axis.unit.is_empty() { "" } else { " " };
    if !(factor.is_empty() && axis.unit.is_empty()) {
        text.push_str(&format!(" [{factor}{separator}{}]", axis.unit));
    }
    text
}

/// Exponent of the power of ten, a multiple of three, to be split off numbers of this size: none for
/// sizes that read well as they are.
fn engineering(size: f64) -> i32 {
    if size == 0.0 || (0.02..20_000.0).contains(&size) { 0 } else { decade(size).div_euclid(3) * 3 }
}

fn decade(size: f64) -> i32 {
    size.log10().floor() as i32
}

fn power(exponent: i32) -> f64 {
    10f64.powi(exponent)
}

/// v/10ⁿ by exact powers of ten where these exist.
fn scaled(v: f64, exponent: i32) -> f64 {
    if exponent < 0 { v * power(-exponent) } else { v / power(exponent) }
}

/// s·10ⁿ, the nearest number to that decimal where s is whole.
fn unscaled(s: f64, exponent: i32) -> f64 {
    if exponent < 0 { s / power(-exponent) } else { s * power(exponent) }
}

/// The smallest number not below `least` that is 1, 2, 2.5 or 5 times a power of ten.
fn round_step(least: f64) -> f64 {
    let unit = power(decade(least));
    let factor = [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().find(|f| f * unit >= least * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * unit
}

/// Decimals by which the multiples of `step` differ.
fn decimals(step: f64) -> usize {
    (0..12)
        .find(|&n| {
            let s = step * power(n);
            (s - s.round()).abs() < 1e-6 * s.max(1.0) && s.round() >= 1.0
        })
        .unwrap_or(12) as usize
}

/// A number with a true minus sign, and no minus before zero.
fn number(s: f64, decimals: usize) -> String {
    let text = format!("{s:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.into(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

fn superscript(n: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    n.to_string().chars().map(|c| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis, values: &[f64]) -> (String, Vec<String>) {
        let r = Resolved::new(axis, values.iter().copied(), 5);
        for v in values {
            if let Some(s) = r.map(*v) {
                assert!(s >= r.range.0 && s <= r.range.1, "{v} is drawn outside of {:?}", r.range);
            }
        }
        let ticks = r.ticks();
        assert!((2..=9).contains(&ticks.len()), "{values:?}: {ticks:?} in {:?}", r.range);
        assert!(r.range.0.abs().max(r.range.1.abs()) < 1e6);
        (r.label.clone(), ticks.iter().map(|&s| r.tick(s)).collect())
    }

    #[test]
    fn ticks_are_round_and_split_off_powers_of_ten() {
        let w = Axis::new("Deflection w₂", "m");
        let (label, ticks) = texts(&w, &[-0.4, 0.004]);
        assert_eq!(
            (label.as_str(), ticks.join(" ").as_str()),
            ("Deflection w₂ [m]", "−0.4 −0.3 −0.2 −0.1 0.0")
        );
        let (label, ticks) = texts(&w, &[-4e-3, 4e-3]);
        assert_eq!(label, "Deflection w₂ [10⁻³ m]");
        assert_eq!(ticks.join(" "), "−4 −2 0 2 4");
        let (label, ticks) = texts(&Axis::time(), &[0.0, 20.0]);
        assert_eq!((label.as_str(), ticks.join(" ").as_str()), ("Time t [s]", "0 5 10 15 20"));
    }

    #[test]
    fn a_small_variation_is_shown_about_a_round_number() {
        let (label, ticks) = texts(&Axis::new("Energy", "J"), &[1234.56001, 1234.56009]);
        assert_eq!(label, "Energy − 1234.56 [10⁻⁶ J]");
        assert_eq!(ticks.join(" "), "20 40 60 80");
    }

    #[test]
    fn every_size_of_number_has_a_finite_axis() {
        let axis = Axis::new("y", "");
        for values in [
            &[0.0, 0.0][..],
            &[],
            &[f64::NAN, f64::INFINITY],
            &[4.0, 4.0],
            &[1.0, 1.0 + 1e-16],
            &[-1e300, 1e300],
            &[-f64::MAX, f64::MAX],
            &[0.0, 1e-300],
            &[5e-324],
            &[1e-200, 2e-200],
            &[1e15, 1e15 + 1.0],
        ] {
            let r = Resolved::new(&axis, values.iter().copied(), 5);
            let (lo, hi) = r.range;
            assert!(lo < hi && lo.abs() < 1e6 && hi.abs() < 1e6 && r.step > 0.0, "{values:?}: {r:?}");
            let n = r.ticks().len();
            assert!((2..=9).contains(&n), "{values:?}: {n} ticks, {r:?}");
        }
    }

    #[test]
    fn a_logarithmic_axis_spans_whole_decades() {
        let axis = Axis::logarithmic("Error", "m");
        let (label, ticks) = texts(&axis, &[3e-14, 2e-9, 0.0, -1.0]);
        assert_eq!(label, "Error [m]");
        assert_eq!(ticks, ["10⁻¹⁴", "10⁻¹³", "10⁻¹²", "10⁻¹¹", "10⁻¹⁰", "10⁻⁹", "10⁻⁸"]);
        assert_eq!(Resolved::new(&axis, [1.0].into_iter(), 5).map(-1.0), None);
        assert_eq!(texts(&axis, &[0.1, 0.1]).1.len(), 2);
    }
}
