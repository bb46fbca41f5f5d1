//! Cubic Hermite finite elements: C¹, values and slopes at the nodes.
//!
//! In an element [x₀, x₀ + l], s = (x − x₀)/l,
//!
//! ```text
//! N = (1 − 3s² + 2s³,  l(s − 2s² + s³),  3s² − 2s³,  l(s³ − s²))
//! ```
//!
//! multiply value [m] and slope dw/dx \[1\] of the left node, then of the right one. For a transverse
//! field the clamp removes value and slope at x = 0; for an axial field it removes the value only, and
//! the slope (the strain) at the root is the first unknown.

use super::{Basis, BasisError, Conditioning, Field, Role, Support, Tip, check_cells, uniform_cells};

/// Cubic Hermite finite elements on [0, L]. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct Hermite {
    cells: Vec<f64>,
    /// Number of nodal unknowns removed by the clamp.
    clamped: usize,
}

impl Hermite {
    /// `elements` equal elements on [0, `length`], in metres.
    ///
    /// # Errors
    /// [`BasisError::Invalid`] if the length is not positive and finite or if there is no element.
    pub fn new(length: f64, elements: usize, field: Field) -> Result<Hermite, BasisError> {
        Hermite::on(uniform_cells(length, elements)?, field)
    }

    /// Elements between the given ascending boundaries, the first of which is 0 \[m\].
    ///
    /// # Errors
    /// [`BasisError::Invalid`] if the boundaries do not ascend from 0.
    pub fn on(cells: Vec<f64>, field: Field) -> Result<Hermite, BasisError> {
        check_cells(&cells)?;
        let clamped = match field {
            Field::Axial => 1,
            Field::Transverse => 2,
        };
        Ok(Hermite { cells, clamped })
    }
}

impl Basis for Hermite {
    fn len(&self) -> usize {
        2 * self.cells.len() - self.clamped
    }

    fn cells(&self) -> &[f64] {
        &self.cells
    }

    fn points_per_cell(&self) -> usize {
        4
    }

    fn support(&self, cell: usize) -> Support {
        (2 * cell).saturating_sub(self.clamped)..2 * cell + 4 - self.clamped
    }

    fn eval(&self, cell: usize, x: f64, derivative: usize, out: &mut [f64]) -> Support {
        let l = self.cells[cell + 1] - self.cells[cell];
        let s = (x - self.cells[cell]) / l;
        let shapes = match derivative {
            0 => {
                let (u, ss) = (1.0 - s, s * s);
                [(1.0 + 2.0 * s) * u * u, l * s * u * u, ss * (3.0 - 2.0 * s), -l * ss * u]
            }
            1 => {
                let bump = 6.0 * s * (1.0 - s) / l;
                [-bump, (1.0 - s) * (1.0 - 3.0 * s), bump, s * (3.0 * s - 2.0)]
            }
            2 => {
                let bend = (12.0 * s - 6.0) / (l * l);
                [bend, (6.0 * s - 4.0) / l, -bend, (6.0 * s - 2.0) / l]
            }
            3 => {
                let (shear, twist) = (12.0 / (l * l * l), 6.0 / (l * l));
                [shear, twist, -shear, twist]
            }
            _ => [0.0; 4],
        };
        let support = self.support(cell);
        out[..support.len()].copy_from_slice(&shapes[4 - support.len()..]);
        support
    }

    fn anchor(&self, i: usize) -> f64 {
        self.cells[(i + self.clamped) / 2]
    }

    fn role(&self, i: usize) -> Role {
        if (i + self.clamped).is_multiple_of(2) { Role::Value } else { Role::Slope }
    }

    /// w(L) = w₀ + ½l (w₀′ + w′(L)) with the last node before the tip: exact for parabolas.
    fn tip(&self) -> Option<Tip> {
        let n = self.len();
        let l = self.cells[self.cells.len() - 1] - self.cells[self.cells.len() - 2];
        let rule = [(Some(n - 1), 0.5 * l), (n.checked_sub(3), 0.5 * l), (n.checked_sub(4), 1.0)];
        let follows = rule.into_iter().filter_map(|(i, c)| Some((i?, c))).collect();
        Some(Tip { function: n - 2, follows })
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
    fn a_mesh_has_nodes_at_all_stations() {
        use super::super::mesh;
        let near = |found: Vec<f64>, expected: &[f64]| {
            let same = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
            assert!(found.len() == expected.len() && same, "{found:?} for {expected:?}");
        };
        near(mesh(2.0, 4, &[]).unwrap(), &[0.0, 0.5, 1.0, 1.5, 2.0]);
        near(mesh(2.0, 4, &[0.5 + 1e-13, 2.0, 0.0]).unwrap(), &[0.0, 0.5, 1.0, 1.5, 2.0]);
        near(mesh(2.0, 4, &[0.73]).unwrap(), &[0.0, 0.5, 0.73, 1.0, 1.5, 2.0]);
        near(mesh(2.0, 4, &[0.65, 1.99, 1.2, 1.201]).unwrap(), &[0.0, 0.65, 1.2, 1.201, 1.5, 1.99, 2.0]);
        near(mesh(2.0, 4, &[1.2, 1.2 + 1e-10]).unwrap(), &[0.0, 0.5, 1.2, 1.5, 2.0]);
        for elements in 1..40 {
            let stations: Vec<f64> = (0..30).map(|k| (f64::from(k * k) * 0.37) % 2.0).collect();
            let cells = mesh(2.0, elements, &stations).unwrap();
            let h = 2.0 / elements as f64;
            assert!(Hermite::on(cells.clone(), Field::Transverse).is_ok());
            assert!(cells.windows(2).all(|c| c[1] > c[0] && c[1] - c[0] < 1.81 * h), "{cells:?}");
            for x in stations {
                assert!(cells.iter().any(|cell| (cell - x).abs() < 1e-9), "{x} in {cells:?}");
            }
        }
    }

    #[test]
    fn it_is_a_basis_of_its_field() {
        for field in [Field::Axial, Field::Transverse] {
            for elements in [1, 2, 7] {
                checks::all(&Hermite::new(3.7, elements, field).unwrap(), field);
            }
            checks::all(&Hermite::on(vec![0.0, 0.3, 1.1, 1.2], field).unwrap(), field);
        }
    }

    #[test]
    fn it_reproduces_clamped_cubics() {
        for field in [Field::Axial, Field::Transverse] {
            let basis = Hermite::on(vec![0.0, 0.3, 1.1, 1.2], field).unwrap();
            let c = if field == Field::Axial { 0.4 } else { 0.0 };
            let derivatives: [&dyn Fn(f64) -> f64; 4] = [
                &|x| c * x + 2.0 * x * x - 0.7 * x * x * x,
                &|x| c + 4.0 * x - 2.1 * x * x,
                &|x| 4.0 - 4.2 * x,
                &|_| -4.2,
            ];
            let nodal: Vec<f64> = (0..basis.len())
                .map(|i| derivatives[(basis.role(i) == Role::Slope) as usize](basis.anchor(i)))
                .collect();
            checks::reproduces(&basis, &nodal, derivatives);
        }
    }

    #[test]
    fn the_axial_field_keeps_the_root_strain_as_its_first_unknown() {
        let basis = Hermite::new(1.0, 2, Field::Axial).unwrap();
        assert_eq!((basis.role(0), basis.anchor(0), basis.len()), (Role::Slope, 0.0, 5));
        let mut out = [0.0; 4];
        basis.eval(0, 0.0, 1, &mut out);
        assert_eq!(out[..3], [1.0, 0.0, 0.0]);
    }

    #[test]
    fn cubic_deflection_under_a_tip_load_is_exact() {
        // w = P x² (3L − x)/(6EI): K d = P e_tip, checked as the residual of the exact nodal values.
        let (length, p, ei) = (1.7, 3.0, 5.0);
        let basis = Hermite::new(length, 4, Field::Transverse).unwrap();
        let k = checks::gram(&basis, 2, basis.points_per_cell(), |_| ei);
        let n = basis.len();
        let nodal: Vec<f64> = (0..n)
            .map(|i| {
                let x = basis.anchor(i);
                match basis.role(i) {
                    Role::Slope => p * x * (2.0 * length - x) / (2.0 * ei),
                    _ => p * x * x * (3.0 * length - x) / (6.0 * ei),
                }
            })
            .collect();
        for i in 0..n {
            let force: f64 = (0..n).map(|j| k[i * n + j] * nodal[j]).sum();
            let load = if i == n - 2 { p } else { 0.0 };
            assert!((force - load).abs() < 1e-11, "row {i}: {force} for {load}");
        }
    }
}
