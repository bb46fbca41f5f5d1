//! Bézier curves: Bernstein polynomials over the whole beam, or piecewise with a C¹ (axial: C⁰) joint.
//!
//! ```text
//! Bᵢ(s) = n!/(i!(n−i)!) sⁱ (1 − s)ⁿ⁻ⁱ,   w = Σ bᵢ Bᵢ(s),   s = (x − x₀)/l
//! ```
//!
//! evaluated by de Casteljau's triangle, which neither overflows nor cancels. The coefficients are the
//! displacements \[m\] of control points at x₀ + i l/n. The clamp leaves out the first one (axial) or two
//! (transverse). Between two equal elements the common control point is no unknown of the transverse field:
//! it is the mean of its neighbours, which makes the curve C¹.
//!
//! One element is spectral: the error falls faster than any power of n until rounding. But the
//! functions become nearly linearly dependent: the eigenvalues of their mass matrix ∫BᵢBⱼ ds are
//! (n!)²/((n+k+1)!(n−k)!), k = 0 … n, whence its condition number
//!
//! ```text
//! κ₂ = (2n + 1)!/(n!(n + 1)!)
//! ```
//!
//! which the basis reports, and refuses when it reaches 2⁵² (n > 27).
//!
//! Sources: R. T. Farouki, *Comput. Aided Geom. Des.* 29 (2012) 379–419, doi:10.1016/j.cagd.2012.03.001; M. M.
//! Derriennic, *J. Approx. Theory* 31 (1981) 325–343, doi:10.1016/0021-9045(81)90101-5 (eigenvalues); for
//! rotating beams J. H. Fan & D. G. Zhang, *Acta Phys. Sin.* 63 (2014) 154501, doi:10.7498/aps.63.154501.

use super::b_spline::raise;
use super::{Basis, BasisError, Conditioning, Field, Role, Support, uniform_cells};

/// Highest degree: beyond, the mass matrix is singular to working precision.
const MOST_DEGREE: usize = 27;

/// Bézier curves on [0, L]. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct Bezier {
    cells: Vec<f64>,
    degree: usize,
    field: Field,
}

impl Bezier {
    /// Bézier curves of degree `degree` n on `elements` m equal elements of a beam of the given length \[m\]: mn
    /// functions for the axial field, m(n − 1) for the transverse one.
    ///
    /// # Errors
    /// [`BasisError::Invalid`] if the length is not positive and finite, if there is no element, or if the
    /// degree is not within 1 (transverse: 2) to 27.
    pub fn new(length: f64, elements: usize, degree: usize, field: Field) -> Result<Bezier, BasisError> {
        let cells = uniform_cells(length, elements)?;
        let (least, name) = match field {
            Field::Axial => (1, "axial"),
            Field::Transverse => (2, "transverse"),
        };
        if degree > MOST_DEGREE {
            return Err(BasisError::Invalid(format!(
                "the mass matrix of Bernstein polynomials of degree {degree} is singular to working precision (beyond degree {MOST_DEGREE}); lower the degree and take more elements"
            )));
        }
        if degree < least {
            return Err(BasisError::Invalid(format!(
                "degree {degree} of the {name} Bézier curves must be from {least} to {MOST_DEGREE}; 5 to 15 serve well"
            )));
        }
        Ok(Bezier { cells, degree, field })
    }

    /// Unknowns that each element adds.
    fn per_element(&self) -> usize {
        match self.field {
            Field::Axial => self.degree,
            Field::Transverse => self.degree - 1,
        }
    }

    /// Number of the control point among the n + 1 of its element, and the element, of function `i`.
    fn control_point(&self, i: usize) -> (usize, usize) {
        let per = self.per_element();
        let (element, inner) = (i / per, i % per + 1);
        match self.field {
            Field::Axial => (element, inner),
            // The clamped b₁ of the first element is skipped, so all numbers move by one; the last is the tip.
            Field::Transverse if inner < per => (element, inner + 1),
            Field::Transverse if element + 2 == self.cells.len() => (element, self.degree),
            Field::Transverse => (element + 1, 1),
        }
    }
}

impl Basis for Bezier {
    fn len(&self) -> usize {
        self.per_element() * (self.cells.len() - 1)
    }

    fn cells(&self) -> &[f64] {
        &self.cells
    }

    fn points_per_cell(&self) -> usize {
        self.degree + 1
    }

    /// Numbered before the clamp, element e has axial functions ne … n(e + 1). Of the transverse ones it has
    /// its own n − 1 inner control points, (n − 1)e + 1 …, and one of each neighbour (or an end of the beam).
    fn support(&self, cell: usize) -> Support {
        let (start, clamped) = match self.field {
            Field::Axial => (self.degree * cell, 1),
            Field::Transverse => ((self.degree - 1) * cell, 2),
        };
        start.saturating_sub(clamped)..start + self.degree + 1 - clamped
    }

    fn eval(&self, cell: usize, x: f64, derivative: usize, out: &mut [f64]) -> Support {
        let n = self.degree;
        let (start, end) = (self.cells[cell], self.cells[cell + 1]);
        let mut all = [0.0; MOST_DEGREE + 1];
        raise(n, derivative, x, |_, _| (start, end), &mut all);
        if self.field == Field::Transverse {
            // b₀ = ½(b₋₁ + b₁): half of B₀ goes to either neighbour; and likewise at the other end.
            if cell > 0 {
                all[0] *= 0.5;
                all[1] += all[0];
            }
            if cell + 2 < self.cells.len() {
                all[n] *= 0.5;
                all[n - 1] += all[n];
            }
        }
        let support = self.support(cell);
        out[..support.len()].copy_from_slice(&all[n + 1 - support.len()..=n]);
        support
    }

    fn anchor(&self, i: usize) -> f64 {
        let (element, inner) = self.control_point(i);
        let (start, end) = (self.cells[element], self.cells[element + 1]);
        start + (end - start) * (inner as f64 / self.degree as f64)
    }

    fn role(&self, _i: usize) -> Role {
        Role::Control
    }

    fn conditioning(&self) -> Conditioning {
        // (2n + 1)!/(n!(n + 1)!)
        let n = self.degree;
        let number = (1..=n).fold(1.0, |product, k| product * ((n + 1 + k) as f64 / k as f64));
        Conditioning { number, of: "mass matrix of the Bernstein polynomials" }
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks;
    use super::*;

    #[test]
    fn it_is_a_basis_of_its_field() {
        for field in [Field::Axial, Field::Transverse] {
            for degree in if field == Field::Axial { 1..=9 } else { 2..=9 } {
                for elements in [1, 2, 3, 5] {
                    checks::all(&Bezier::new(3.7, elements, degree, field).unwrap(), field);
                }
            }
            // The difference itself is off by (2e-3 n)⁴/30, 1e-7 for n = 20.
            let high = Bezier::new(3.7, 1, 20, field).unwrap();
            checks::derivatives_equal_finite_differences(&high, 5e-7);
            checks::quadrature_is_exact(&high, field, 1e-13);
        }
    }

    #[test]
    fn bernstein_polynomials_sum_to_one_and_are_those_of_the_binomials() {
        for n in [1, 2, 5, 12, 27] {
            for s in [0.0_f64, 0.1, 0.5, 0.93, 1.0] {
                let mut all = vec![0.0; n + 1];
                raise(n, 0, s, |_, _| (0.0, 1.0), &mut all);
                assert!((all.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                let mut binomial = 1.0;
                for (i, found) in all.iter().enumerate() {
                    let exact = binomial * s.powi(i as i32) * (1.0 - s).powi((n - i) as i32);
                    assert!((found - exact).abs() <= 1e-14 * exact, "n {n} i {i} s {s}: {found} for {exact}");
                    binomial *= (n - i) as f64 / (i + 1) as f64;
                }
            }
        }
    }

    #[test]
    fn control_points_on_a_line_or_a_parabola_make_that_curve() {
        for (elements, degree) in [(1, 1), (1, 6), (4, 3)] {
            let basis = Bezier::new(2.0, elements, degree, Field::Axial).unwrap();
            let line: Vec<f64> = (0..basis.len()).map(|i| 3.0 * basis.anchor(i)).collect();
            checks::reproduces(&basis, &line, [&|x: f64| 3.0 * x, &|_| 3.0]);
        }
        // x² on [x₀, x₀ + l]: bᵢ = x₀² + 2x₀ l i/n + l² i(i−1)/(n(n−1)).
        for (elements, degree) in [(1, 2), (1, 6), (4, 3), (3, 5)] {
            let basis = Bezier::new(2.0, elements, degree, Field::Transverse).unwrap();
            let (l, n) = (2.0 / elements as f64, degree as f64);
            let parabola: Vec<f64> = (0..basis.len())
                .map(|i| {
                    let (element, inner) = basis.control_point(i);
                    let (x0, i) = (basis.cells[element], inner as f64);
                    x0 * x0 + 2.0 * x0 * l * i / n + l * l * i * (i - 1.0) / (n * (n - 1.0))
                })
                .collect();
            checks::reproduces(&basis, &parabola, [&|x: f64| x * x, &|x| 2.0 * x, &|_| 2.0]);
        }
    }

    #[test]
    fn the_condition_number_is_that_of_the_mass_matrix() {
        // Eigenvectors: the control points of the Legendre polynomials P_0 (all one) and P_n
        // (the binomials with alternating signs), the smoothest and the roughest.
        for n in [2, 5, 9] {
            let rule = crate::quadrature::Gauss::new(n + 1);
            let quotient = |b: &[f64]| {
                let mut all = vec![0.0; n + 1];
                let square = rule.integrate(0.0, 1.0, |s| {
                    raise(n, 0, s, |_, _| (0.0, 1.0), &mut all);
                    b.iter().zip(&all).map(|(b, v)| b * v).sum::<f64>().powi(2)
                });
                square / b.iter().map(|b| b * b).sum::<f64>()
            };
            let mut rough = vec![1.0; n + 1];
            for i in 0..n {
                rough[i + 1] = -rough[i] * (n - i) as f64 / (i + 1) as f64;
            }
            let exact = quotient(&vec![1.0; n + 1]) / quotient(&rough);
            let found = Bezier::new(1.0, 1, n, Field::Transverse).unwrap().conditioning().number;
            assert!((found / exact - 1.0).abs() < 1e-10, "n {n}: {found} for {exact}");
        }
    }

    #[test]
    fn one_curve_bends_with_spectral_accuracy() {
        let mut last = 100.0_f64;
        for (degree, bound) in [(2, 0.3), (4, 1e-3), (6, 1e-6), (8, 1e-8)] {
            let basis = Bezier::new(10.0, 1, degree, Field::Transverse).unwrap();
            let (_, frequency) = checks::cantilever_errors(&basis);
            assert!(
                frequency.abs() < bound && frequency.abs() < 0.01 * last.max(1e-10),
                "n {degree}: {frequency:e}"
            );
            last = frequency.abs();
        }
    }

    #[test]
    fn what_makes_no_curve_is_refused() {
        for (elements, degree, field) in [
            (0, 3, Field::Axial),
            (1, 0, Field::Axial),
            (1, 1, Field::Transverse),
            (1, 28, Field::Transverse),
            (1, usize::MAX, Field::Axial),
        ] {
            assert!(matches!(Bezier::new(1.0, elements, degree, field), Err(BasisError::Invalid(_))));
        }
        assert!(Bezier::new(f64::NAN, 1, 3, Field::Axial).is_err());
        let most = Bezier::new(1.0, 1, MOST_DEGREE, Field::Transverse).unwrap().conditioning().number;
        assert!(most * f64::EPSILON < 1.0);
        assert!(most * 4.0 * f64::EPSILON > 1.0, "a degree more would be no better than singular");
    }
}
