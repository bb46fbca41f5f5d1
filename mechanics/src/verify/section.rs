//! A section: positive energies, and resultants that are smooth between its breaks.

use super::Defect;
use crate::quadrature::Gauss;
use crate::section::{Resultants, Section, SectionError};

/// Relative difference between the integral over a piece and over its halves, or between both sides of a break, from
/// which on the resultants are not taken for smooth.
const SMOOTH: f64 = 1e-6;
/// Gauss points of a piece: they integrate polynomials of degree 31 exactly.
const POINTS: usize = 16;
/// Distance of the sides of a break from it, over the length.
const ASIDE: f64 = 1e-9;

/// Checks a section on a beam of `length` \[m\]; the result is empty if it passes. A section whose breaks are not in
/// order is not checked further.
pub fn section(section: &dyn Section, length: f64) -> Vec<Defect> {
    let mut checker = Checker { section, length, defects: Vec::new() };
    checker.breaks();
    if checker.defects.is_empty() {
        let mut ends = vec![0.0];
        ends.extend(section.breaks().iter().filter(|x| **x > 0.0 && **x < length));
        ends.push(length);
        for (number, piece) in ends.windows(2).enumerate() {
            checker.piece(piece[0], piece[1], number + 2 == ends.len());
        }
    }
    checker.defects
}

struct Checker<'a> {
    section: &'a dyn Section,
    length: f64,
    defects: Vec<Defect>,
}

impl Checker<'_> {
    fn report(&mut self, check: &'static str, place: String, found: f64, expected: f64) {
        self.defects.push(Defect { check, place, found, expected });
    }

    fn breaks(&mut self) {
        let mut least = 0.0;
        for &x in self.section.breaks() {
            if !(x >= least && x <= self.length) {
                let bound = if x < least { least } else { self.length };
                self.report("breaks", "a break, which must ascend from 0 to L,".into(), x, bound);
            }
            least = x;
        }
        for &x in self.section.jumps() {
            if !self.section.breaks().contains(&x) {
                self.report("jumps", "a jump, which is no break,".into(), x, f64::NAN);
            }
        }
    }

    /// The piece from `a` to `b`, and the jump at `b` unless it is the tip.
    fn piece(&mut self, a: f64, b: f64, last: bool) {
        let (section, gauss, before) = (self.section, Gauss::new(POINTS), self.defects.len());
        for (x, _) in gauss.on(a, b) {
            self.energies(x);
            if let Some((lower, upper)) = section.fibres(x).filter(|(lower, upper)| !(lower < upper)) {
                self.report("fibres", format!("the upper fibre at x = {x} m"), upper, lower);
            }
            // One station is enough.
            if self.defects.len() > before {
                return;
            }
        }
        let middle = 0.5 * (a + b);
        for (quantity, of) in QUANTITIES {
            let value = |x: f64| of(&section.resultants(x));
            let whole = gauss.integrate(a, b, value);
            let halves = gauss.integrate(a, middle, value) + gauss.integrate(middle, b, value);
            let size = gauss.integrate(a, b, |x| value(x).abs());
            if !((whole - halves).abs() <= SMOOTH * size) {
                let place =
                    format!("the integral of {quantity} from {a} m to {b} m, which has a break inside,");
                self.report("breaks", place, whole, halves);
            }
            if last || section.jumps().contains(&b) {
                continue;
            }
            let aside = (ASIDE * self.length).min(1e-3 * (b - a));
            let (left, right) = (value(b - aside), value(b + aside));
            if !((right - left).abs() <= SMOOTH * left.abs().max(right.abs())) {
                let place = format!("{quantity} behind x = {b} m, which is none of the jumps,");
                self.report("jumps", place, right, left);
            }
        }
    }

    fn energies(&mut self, x: f64) {
        let at = |quantity| format!("the {quantity} at x = {x} m");
        match self.section.resultants(x).validate() {
            Ok(()) => {}
            Err(SectionError::Quantity { quantity, value, .. }) => {
                self.report("positive energies", at(quantity), value, 0.0);
            }
            Err(SectionError::Indefinite { quantity, value, bound, .. }) => {
                self.report("positive energies", at(quantity), value, bound);
            }
            Err(SectionError::Invalid(reason)) => {
                self.report("positive energies", at(&reason), f64::NAN, 0.0);
            }
        }
    }
}

/// A resultant of those of a station.
type Quantity = fn(&Resultants) -> f64;

const QUANTITIES: [(&str, Quantity); 6] = [
    ("ρA", |r| r.mass),
    ("ρS", |r| r.first_moment),
    ("ρI", |r| r.rotary_inertia),
    ("EA", |r| r.axial_stiffness),
    ("ES", |r| r.coupling_stiffness),
    ("EI", |r| r.bending_stiffness),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::section::{Piecewise, Segment, Shape, Tapered, Uniform};

    /// Unit resultants times a function of the station.
    #[derive(Debug)]
    struct Varying(fn(f64) -> f64, Vec<f64>, Vec<f64>);

    impl Section for Varying {
        fn resultants(&self, x: f64) -> Resultants {
            let size = (self.0)(x);
            Resultants { mass: size, axial_stiffness: size, bending_stiffness: size, ..Resultants::default() }
        }

        fn breaks(&self) -> &[f64] {
            &self.1
        }

        fn jumps(&self) -> &[f64] {
            &self.2
        }
    }

    fn found(size: fn(f64) -> f64, breaks: &[f64], jumps: &[f64]) -> Vec<&'static str> {
        let mut checks: Vec<_> = section(&Varying(size, breaks.to_vec(), jumps.to_vec()), 2.0)
            .into_iter()
            .map(|defect| defect.check)
            .collect();
        checks.dedup();
        checks
    }

    #[test]
    fn own_sections_pass() {
        let (big, small) = (Shape::Circle { radius: 0.1 }, Shape::Circle { radius: 0.04 });
        let uniform = |shape| Uniform::from_material(7e10, 2700.0, shape).unwrap();
        assert_eq!(section(&Tapered::new(7e10, 2700.0, 2.0, big, small).unwrap(), 2.0), []);
        let segments = [(0.7, big), (2.0, small)].map(|(end, s)| Segment { end, section: uniform(s) });
        let stepped = Piecewise::new(2.0, segments.to_vec()).unwrap();
        assert_eq!(section(&stepped, 2.0), []);
    }

    #[test]
    fn each_defect_is_found() {
        let step = |x: f64| if x < 0.9 { 1.0 } else { 2.0 };
        let kink = |x: f64| 1.0 + (x - 0.9).abs();
        assert!(found(step, &[0.9], &[0.9]).is_empty());
        assert!(found(kink, &[0.9], &[]).is_empty());
        assert_eq!(found(step, &[0.9], &[]), ["jumps"]);
        assert_eq!(found(step, &[], &[]), ["breaks"]);
        assert_eq!(found(kink, &[], &[]), ["breaks"]);
        assert_eq!(found(|_| 1.0, &[0.9, 0.5], &[]), ["breaks"]);
        assert_eq!(found(|_| 1.0, &[2.5], &[]), ["breaks"]);
        assert_eq!(found(|_| 1.0, &[], &[0.9]), ["jumps"]);
        assert_eq!(found(|x| 1.0 - x, &[], &[]), ["positive energies"]);
        assert_eq!(found(|_| f64::NAN, &[], &[]), ["positive energies"]);
    }
}
