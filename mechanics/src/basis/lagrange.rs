//! Lagrange finite elements of degree 1 or 2: C⁰, for axial fields.
//!
//! In an element [x₀, x₀ + l], s = (x − x₀)/l,
//!
//! ```text
//! degree 1:  N = (1 − s, s)
//! degree 2:  N = ((1 − s)(1 − 2s), 4s(1 − s), s(2s − 1))      nodes at s = 0, ½, 1
//! ```
//!
//! Unknowns are the displacements [m] of the nodes along x, without the clamped one at x = 0.

use super::{Basis, BasisError, Conditioning, Role, Support, check_cells, uniform_cells};

/// Lagrange finite elements on [0, L] with φ(0) = 0. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct Lagrange {
    cells: Vec<f64>,
    degree: usize,
}

impl Lagrange {
    /// `elements` equal elements of degree `degree` (1 or 2) on [0, `length`], in metres.
    ///
    /// # Errors
    /// [`BasisError::Invalid`] if the length is not positive and finite, if there is no element, or if
    /// the degree is neither 1 nor 2.
    pub fn new(length: f64, elements: usize, degree: usize) -> Result<Lagrange, BasisError> {
        Lagrange::on(uniform_cells(length, elements)?, degree)
    }

    /// Elements between the given ascending boundaries, the first of which is 0 \[m\].
    ///
    /// # Errors
    /// As [`Lagrange::new`], and if the boundaries do not ascend from 0.
    pub fn on(cells: Vec<f64>, degree: usize) -> Result<Lagrange, BasisError> {
        check_cells(&cells)?;
        if !(1..=2).contains(&degree) {
            return Err(BasisError::Invalid(format!(
                "degree {degree} of the Lagrange elements must be 1 or 2"
            )));
        }
        Ok(Lagrange { cells, degree })
    }
}

impl Basis for Lagrange {
    fn len(&self) -> usize {
        self.degree * (self.cells.len() - 1)
    }

    fn cells(&self) -> &[f64] {
        &self.cells
    }

    fn points_per_cell(&self) -> usize {
        self.degree + 1
    }

    fn support(&self, cell: usize) -> Support {
        let end = self.degree * (cell + 1);
        // Node n has function n − 1; the root node has none.
        (end - self.degree).saturating_sub(1)..end
    }

    fn eval(&self, cell: usize, x: f64, derivative: usize, out: &mut [f64]) -> Support {
        let l = self.cells[cell + 1] - self.cells[cell];
        let s = (x - self.cells[cell]) / l;
        let shapes = if self.degree == 1 {
            match derivative {
                0 => [1.0 - s, s, 0.0],
                1 => [-1.0 / l, 1.0 / l, 0.0],
                _ => [0.0; 3],
            }
        } else {
            match derivative {
                0 => [(1.0 - s) * (1.0 - 2.0 * s), 4.0 * s * (1.0 - s), s * (2.0 * s - 1.0)],
                1 => [(4.0 * s - 3.0) / l, (4.0 - 8.0 * s) / l, (4.0 * s - 1.0) / l],
                2 => [4.0 / (l * l), -8.0 / (l * l), 4.0 / (l * l)],
                _ => [0.0; 3],
            }
        };
        let support = self.support(cell);
        let all = self.degree + 1;
        out[..support.len()].copy_from_slice(&shapes[all - support.len()..all]);
        support
    }

    fn anchor(&self, i: usize) -> f64 {
        let (element, inner) = ((i + 1) / self.degree, (i + 1) % self.degree);
        match inner {
            0 => self.cells[element],
            _ => 0.5 * (self.cells[element] + self.cells[element + 1]),
        }
    }

    fn role(&self, _i: usize) -> Role {
        Role::Value
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
    fn it_is_a_basis_of_an_axial_field() {
        for degree in [1, 2] {
            for elements in [1, 2, 7] {
                checks::all(&Lagrange::new(3.7, elements, degree).unwrap(), super::super::Field::Axial);
            }
        }
    }

    #[test]
    fn it_reproduces_polynomials_of_its_degree_that_vanish_at_the_root() {
        for degree in [1, 2] {
            let basis = Lagrange::new(2.0, 5, degree).unwrap();
            let field = |x: f64| 3.0 * x + if degree == 2 { 0.7 * x * x } else { 0.0 };
            let nodal: Vec<f64> = (0..basis.len()).map(|i| field(basis.anchor(i))).collect();
            checks::reproduces(&basis, &nodal, [&field]);
        }
    }

    #[test]
    fn it_refuses_what_makes_no_mesh() {
        for (length, elements, degree) in
            [(0.0, 3, 1), (f64::NAN, 3, 1), (1.0, 0, 1), (1.0, 3, 3), (1.0, 3, 0)]
        {
            assert!(Lagrange::new(length, elements, degree).is_err(), "{length} {elements} {degree}");
        }
        assert!(Lagrange::on(vec![0.0, 1.0, 1.0], 1).is_err());
        assert!(Lagrange::on(vec![0.1, 1.0], 1).is_err());
    }
}
