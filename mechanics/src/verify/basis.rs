//! A basis, against its own derivatives and a finer quadrature.

use super::{ALLOWED, Defect};
use crate::basis::{Basis, Field, conformance};

/// Error of the quadrature that is allowed: the rounding of functions that are not evaluated to the last digit.
const QUADRATURE: f64 = 1e-12;

/// Checks a basis of the given field; the result is empty if it passes. A basis whose cells or supports are not in
/// order is not checked further.
pub fn basis(basis: &dyn Basis, field: Field) -> Vec<Defect> {
    let mut defects = Vec::new();
    let mut report = |check, place, found, expected| defects.push(Defect { check, place, found, expected });
    conformance::all(basis, field, (ALLOWED, QUADRATURE), &mut report);
    defects
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::{Conditioning, Hermite, Role, Support};

    /// Which part of Hermite's functions is wrong.
    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Wrong {
        Nothing,
        Slope,
        Clamp,
        Continuity,
        Points,
        Anchor,
        Length,
    }

    #[derive(Debug)]
    struct Altered(Hermite, Wrong);

    impl Basis for Altered {
        fn len(&self) -> usize {
            self.0.len() + usize::from(self.1 == Wrong::Length)
        }

        fn cells(&self) -> &[f64] {
            self.0.cells()
        }

        fn points_per_cell(&self) -> usize {
            self.0.points_per_cell() - usize::from(self.1 == Wrong::Points)
        }

        fn support(&self, cell: usize) -> Support {
            self.0.support(cell)
        }

        fn eval(&self, cell: usize, x: f64, derivative: usize, out: &mut [f64]) -> Support {
            let support = self.0.eval(cell, x, derivative, out);
            match self.1 {
                Wrong::Slope if derivative == 1 => out[0] *= 1.001,
                Wrong::Clamp if cell == 0 && derivative == 0 => out[1] += 0.001,
                Wrong::Continuity if cell == 1 => out[3] *= 1.5,
                _ => {}
            }
            support
        }

        fn anchor(&self, i: usize) -> f64 {
            if self.1 == Wrong::Anchor { -self.0.anchor(i) } else { self.0.anchor(i) }
        }

        fn role(&self, i: usize) -> Role {
            self.0.role(i)
        }

        fn conditioning(&self) -> Conditioning {
            self.0.conditioning()
        }
    }

    #[test]
    fn each_defect_is_found() {
        for (wrong, check) in [
            (Wrong::Nothing, None),
            (Wrong::Slope, Some("derivatives")),
            (Wrong::Clamp, Some("clamp")),
            (Wrong::Continuity, Some("continuity")),
            (Wrong::Points, Some("quadrature")),
            (Wrong::Anchor, Some("anchors")),
            (Wrong::Length, Some("supports")),
        ] {
            let altered = Altered(Hermite::new(2.0, 3, Field::Transverse).unwrap(), wrong);
            let defects = basis(&altered, Field::Transverse);
            assert_eq!(defects.is_empty(), check.is_none(), "{wrong:?}: {defects:?}");
            assert!(check.is_none_or(|check| defects.iter().any(|d| d.check == check)), "{wrong:?}");
        }
    }
}
