//! B-splines of any degree on equal spans: C^{p−1}, clamped by leaving out the first functions.
//!
//! ```text
//! N_{i,0} = 1 in [tᵢ, tᵢ₊₁),   N_{i,p} = (x − tᵢ)/(tᵢ₊ₚ − tᵢ) N_{i,p−1} + (tᵢ₊ₚ₊₁ − x)/(tᵢ₊ₚ₊₁ − tᵢ₊₁) N_{i+1,p−1}
//! N′_{i,p} = p [ N_{i,p−1}/(tᵢ₊ₚ − tᵢ) − N_{i+1,p−1}/(tᵢ₊ₚ₊₁ − tᵢ₊₁) ]
//! ```
//!
//! over the open knots 0 (p + 1 times), L/m, 2L/m, …, L (p + 1 times), m: number of spans. The functions
//! are not negative and sum to one. At x = 0 only N₀ has a value and only N₀, N₁ a slope, so the axial field
//! leaves out N₀ and the transverse field N₀ and N₁. Each coefficient is the displacement \[m\] of a control
//! point, which is at its Greville abscissa (tᵢ₊₁ + … + tᵢ₊ₚ)/p; the beam passes near the control
//! points and, at the tip, through the last one.
//!
//! On a smooth problem the bending frequencies converge with order 2(p − 1) in the length of a span, and the
//! deflection (in the mean square) with order p + 1, or 2 if p = 2.
//!
//! Sources: C. de Boor, *J. Approx. Theory* 6 (1972) 50–62, doi:10.1016/0021-9045(72)90080-9; M. G. Cox,
//! *IMA J. Appl. Math.* 10 (1972) 134–149, doi:10.1093/imamat/10.2.134; for rotating beams J. H. Fan & D. G.
//! Zhang, *J. Mech. Eng.* 48(23) (2012) 59–64, doi:10.3901/JME.2012.23.059.

use super::{Basis, BasisError, Conditioning, Field, Role, Support, uniform_cells};

/// Highest degree: the condition number of the functions grows like p 2ᵖ, and nothing is gained beyond.
const MOST_DEGREE: usize = 15;

/// B-splines on [0, L]. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct BSpline {
    cells: Vec<f64>,
    degree: usize,
    /// Functions left out for the clamp.
    clamped: usize,
}

impl BSpline {
    /// B-splines of degree `degree` p on `elements` equal spans of a beam of the given length \[m\]: m + p − 1
    /// functions for the axial field, m + p − 2 for the transverse one.
    ///
    /// # Errors
    /// [`BasisError::Invalid`] if the length is not positive and finite, if there is no span, or if the
    /// degree is not within 1 to 15 (axial: C⁰ at least) or 2 to 15 (transverse: C¹ at least).
    pub fn new(length: f64, elements: usize, degree: usize, field: Field) -> Result<BSpline, BasisError> {
        let cells = uniform_cells(length, elements)?;
        let (clamped, name) = match field {
            Field::Axial => (1, "axial"),
            Field::Transverse => (2, "transverse"),
        };
        // A field clamped k times needs k − 1 continuous derivatives: degree k.
        if !(clamped..=MOST_DEGREE).contains(&degree) {
            return Err(BasisError::Invalid(format!(
                "degree {degree} of the {name} B-splines must be from {clamped} to {MOST_DEGREE}; 3 to 5 serve well"
            )));
        }
        Ok(BSpline { cells, degree, clamped })
    }

    /// Knot t_k.
    fn knot(&self, k: usize) -> f64 {
        self.cells[k.saturating_sub(self.degree).min(self.cells.len() - 1)]
    }
}

/// Raises 1 to the `degree` + 1 B-splines that do not vanish in a span, or to a derivative of them: `knots`
/// gives for step `j` and function `r` the ends (tᵢ, tᵢ₊ⱼ) of the support of a function of degree j − 1.
///
/// The last `derivative` steps of the recursion differentiate, all before it evaluate; each needs the
/// functions of one degree less only, and they stay in place in `out`.
pub(super) fn raise(
    degree: usize,
    derivative: usize,
    x: f64,
    knots: impl Fn(usize, usize) -> (f64, f64),
    out: &mut [f64],
) {
    out[0] = if derivative > degree { 0.0 } else { 1.0 };
    for j in 1..=degree {
        let differentiate = j + derivative > degree;
        let mut saved = 0.0;
        for r in 0..j {
            let (start, end) = knots(j, r);
            let share = out[r] / (end - start);
            let (left, right) = match differentiate {
                true => (-(j as f64) * share, j as f64 * share),
                false => ((end - x) * share, (x - start) * share),
            };
            out[r] = saved + left;
            saved = right;
        }
        out[j] = saved;
    }
}

impl Basis for BSpline {
    fn len(&self) -> usize {
        self.cells.len() - 1 + self.degree - self.clamped
    }

    fn cells(&self) -> &[f64] {
        &self.cells
    }

    fn points_per_cell(&self) -> usize {
        self.degree + 1
    }

    fn support(&self, cell: usize) -> Support {
        cell.saturating_sub(self.clamped)..cell + self.degree + 1 - self.clamped
    }

    fn eval(&self, cell: usize, x: f64, derivative: usize, out: &mut [f64]) -> Support {
        let mut all = [0.0; MOST_DEGREE + 1];
        let last = cell + self.degree;
        let knots = |j: usize, r: usize| (self.knot(last + 1 + r - j), self.knot(last + 1 + r));
        raise(self.degree, derivative, x, knots, &mut all);
        let support = self.support(cell);
        let first = self.degree + 1 - support.len();
        out[..support.len()].copy_from_slice(&all[first..=self.degree]);
        support
    }

    fn anchor(&self, i: usize) -> f64 {
        let i = i + self.clamped;
        (i + 1..=i + self.degree).map(|k| self.knot(k)).sum::<f64>() / self.degree as f64
    }

    fn role(&self, _i: usize) -> Role {
        Role::Control
    }

    fn conditioning(&self) -> Conditioning {
        Conditioning::none()
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks;
    use super::*;

    #[test]
    fn it_is_a_basis_of_its_field() {
        for field in [Field::Axial, Field::Transverse] {
            for degree in if field == Field::Axial { 1..=8 } else { 2..=8 } {
                for elements in [1, 2, 3, 11] {
                    checks::all(&BSpline::new(3.7, elements, degree, field).unwrap(), field);
                }
            }
        }
    }

    #[test]
    fn it_sums_to_one_before_the_clamp_and_is_never_negative() {
        for degree in 1..=MOST_DEGREE {
            for elements in [1, 2, 7] {
                let basis = BSpline::new(3.7, elements, degree, Field::Axial).unwrap();
                let basis = BSpline { clamped: 0, ..basis };
                let mut out = vec![0.0; degree + 1];
                for cell in 0..elements {
                    for s in [0.0, 0.2, 0.71, 1.0] {
                        let (a, b) = (basis.cells[cell], basis.cells[cell + 1]);
                        let x = a + s * (b - a);
                        basis.eval(cell, x, 0, &mut out);
                        assert!((out.iter().sum::<f64>() - 1.0).abs() < 4e-15, "{degree} {x}: {out:?}");
                        assert!(out.iter().all(|&v| v >= 0.0), "{degree} {x}: {out:?}");
                        for derivative in 1..4 {
                            basis.eval(cell, x, derivative, &mut out);
                            let size = out.iter().map(|v| v.abs()).sum::<f64>();
                            assert!(out.iter().sum::<f64>().abs() <= 4e-15 * size, "{degree} {x}: {out:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn derivatives_below_the_degree_are_continuous() {
        for degree in 2..=6 {
            let basis = BSpline::new(3.7, 8, degree, Field::Transverse).unwrap();
            let (mut left, mut right) = (vec![0.0; degree + 1], vec![0.0; degree + 1]);
            for derivative in 0..degree.min(4) {
                let scale = checks::largest(&basis, derivative);
                for c in 1..8 {
                    let x = basis.cells()[c];
                    let before = basis.eval(c - 1, x, derivative, &mut left);
                    let after = basis.eval(c, x, derivative, &mut right);
                    for i in after.start..before.end {
                        let jump = left[i - before.start] - right[i - after.start];
                        assert!(
                            jump.abs() <= 1e-13 * scale,
                            "degree {degree} derivative {derivative}: {jump:e}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn the_cubic_over_equal_knots_is_that_of_the_handbook() {
        // Inside: (1 − s)³/6, (4 − 6s² + 3s³)/6, (1 + 3s + 3s² − 3s³)/6, s³/6.
        let basis = BSpline::new(8.0, 8, 3, Field::Transverse).unwrap();
        let (mut out, s) = ([0.0; 4], 0.3_f64);
        assert_eq!(basis.eval(4, 4.0 + s, 0, &mut out), 2..6);
        let t = 1.0 - s;
        let exact = [
            t.powi(3) / 6.0,
            (4.0 - 6.0 * s * s + 3.0 * s.powi(3)) / 6.0,
            (1.0 + 3.0 * s + 3.0 * s * s - 3.0 * s.powi(3)) / 6.0,
            s.powi(3) / 6.0,
        ];
        for (found, exact) in out.into_iter().zip(exact) {
            assert!((found - exact).abs() < 1e-15, "{found} for {exact}");
        }
    }

    #[test]
    fn greville_abscissae_give_a_line_and_marsdens_identity_a_parabola() {
        for degree in [1, 2, 3, 7] {
            let basis = BSpline::new(2.0, 5, degree, Field::Axial).unwrap();
            let line: Vec<f64> = (0..basis.len()).map(|i| 3.0 * basis.anchor(i)).collect();
            checks::reproduces(&basis, &line, [&|x: f64| 3.0 * x, &|_| 3.0]);
        }
        // Marsden's identity: x² has the mean of products of two of the p knots as its coefficients.
        for degree in [2, 3, 5] {
            let basis = BSpline::new(2.0, 5, degree, Field::Transverse).unwrap();
            let square = |i: usize| {
                let knots: Vec<f64> = (i + 3..i + 3 + degree).map(|k| basis.knot(k)).collect();
                let (sum, squares): (f64, f64) = (knots.iter().sum(), knots.iter().map(|t| t * t).sum());
                (sum * sum - squares) / (degree * (degree - 1)) as f64
            };
            let parabola: Vec<f64> = (0..basis.len()).map(square).collect();
            checks::reproduces(&basis, &parabola, [&|x: f64| x * x, &|x| 2.0 * x, &|_| 2.0]);
        }
    }

    #[test]
    fn what_makes_no_spline_is_refused() {
        for (length, elements, degree, field) in [
            (0.0, 3, 3, Field::Axial),
            (1.0, 0, 3, Field::Axial),
            (1.0, 3, 0, Field::Axial),
            (1.0, 3, 1, Field::Transverse),
            (1.0, 3, 16, Field::Transverse),
            (1.0, 3, usize::MAX, Field::Axial),
        ] {
            assert!(matches!(BSpline::new(length, elements, degree, field), Err(BasisError::Invalid(_))));
        }
    }
}
