//! Assumed modes: the vibration modes of the uniform clamped–free beam (transverse) or rod (axial).
//!
//! ```text
//! axial       φᵢ = √2 (−1)ⁱ⁺¹ sin((2i−1)πx/(2L))
//! transverse  φᵢ = (−1)ⁱ⁺¹ [cosh βx − cos βx − σ (sinh βx − sin βx)],   σ = (cosh z + cos z)/(sinh z + sin z),  z = βL
//! ```
//!
//! both with ∫φᵢφⱼ dx = L δᵢⱼ and positive at the tip (√2 and 2). Written as it stands the transverse mode
//! cancels beyond order 10; here
//!
//! ```text
//! cosh βx − σ sinh βx = a e^{β(x−L)} + (1 − a e^{−z}) e^{−βx},   a = (sin z − cos z − e^{−z})/(1 − e^{−2z} + 2e^{−z} sin z)
//! ```
//!
//! in which nothing overflows or cancels at any order. Source: R. D. Blevins, *Formulas for Natural
//! Frequency and Mode Shape* (1979), table 8-1.
//!
//! Behind the modes may stand the residual shape, what they leave of the deflection ψ under a force at the tip:
//!
//! ```text
//! ψ = x²(3L − x)/(2L³),   ψ_r = ψ − Σ 3φᵢ(L) φᵢ/(βᵢL)⁴,   φ = ψ_r/ψ_r(L),   ∫φ″φᵢ″ dx = 0
//! ```

use super::{Basis, BasisError, Conditioning, Field, Role, Support, Tip, uniform_cells};
use crate::exact::cantilever::{alternate, eigenvalue};
use std::f64::consts::{FRAC_PI_2, SQRT_2};

/// Residual of the tip's compliance below which its rounding error exceeds a millionth.
const SMALLEST_RESIDUAL: f64 = 1e-9;

/// The first modes of a clamped–free beam or rod. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct Modes {
    cells: Vec<f64>,
    shapes: Vec<Shape>,
    field: Field,
    /// Residual of the deflection under a force at the tip, behind the modes: 1/ψ_r(L), if it is there.
    residual: Option<f64>,
}

/// One mode: wave number β [1/m], and for bending its constants.
#[derive(Clone, Copy, Debug)]
struct Shape {
    sign: f64,
    beta: f64,
    /// a
    tip: f64,
    /// 1 − a e^{−z}
    root: f64,
    /// σ
    sigma: f64,
}

impl Modes {
    /// The first `count` modes of a beam of the given length \[m\].
    ///
    /// # Errors
    /// [`BasisError::Invalid`] if the length is not positive and finite or if there is no mode.
    pub fn new(length: f64, count: usize, field: Field) -> Result<Modes, BasisError> {
        // About one cell for each half wave of the highest mode.
        let cells = uniform_cells(length, count)?;
        let shapes = (1..=count)
            .map(|mode| {
                let sign = alternate(mode);
                if field == Field::Axial {
                    let beta = (2.0 * mode as f64 - 1.0) * FRAC_PI_2 / length;
                    return Shape { sign: sign * SQRT_2, beta, tip: 0.0, root: 0.0, sigma: 0.0 };
                }
                let z = eigenvalue(mode);
                let decay = libm::exp(-z);
                let tip = (libm::sin(z) - libm::cos(z) - decay)
                    / (1.0 - decay * decay + 2.0 * decay * libm::sin(z));
                let root = 1.0 - tip * decay;
                Shape { sign, beta: z / length, tip, root, sigma: root - tip * decay }
            })
            .collect();
        Ok(Modes { cells, shapes, field, residual: None })
    }

    /// The first `count` bending modes, and behind them the residual shape.
    ///
    /// # Errors
    /// As [`Modes::new`], and where the modes leave no residual above rounding.
    pub fn with_residual(length: f64, count: usize) -> Result<Modes, BasisError> {
        let modes = Modes::new(length, count, Field::Transverse)?;
        let left = 1.0 - (1..=count).map(|i| 12.0 / eigenvalue(i).powi(4)).sum::<f64>();
        if left < SMALLEST_RESIDUAL {
            return Err(BasisError::Invalid(format!(
                "{count} modes leave {left:.0e} of the tip's compliance: a massless tip needs fewer modes, or elements"
            )));
        }
        Ok(Modes { residual: Some(1.0 / left), ..modes })
    }

    /// Derivative of the residual shape from the modes `phi` there.
    fn residual(&self, scale: f64, x: f64, derivative: usize, phi: &[f64]) -> f64 {
        let length = self.cells[self.cells.len() - 1];
        let s = x / length;
        let cubic = match derivative {
            0 => 0.5 * s * s * (3.0 - s),
            1 => 1.5 * s * (2.0 - s) / length,
            2 => 3.0 * (1.0 - s) / length.powi(2),
            3 => -3.0 / length.powi(3),
            _ => 0.0,
        };
        let modes = phi.iter().zip(&self.shapes);
        let part: f64 = modes.map(|(phi, shape)| 6.0 * phi / (shape.beta * length).powi(4)).sum();
        scale * (cubic - part)
    }
}

impl Basis for Modes {
    fn len(&self) -> usize {
        self.shapes.len() + usize::from(self.residual.is_some())
    }

    fn cells(&self) -> &[f64] {
        &self.cells
    }

    /// Over a cell, half a wave of the highest mode, the product of two is integrated to 1e-15 with 10 points, and that of
    /// four, as the energies of the coupling `high` have it, to 1e-12, with 12 to 3e-16.
    fn points_per_cell(&self) -> usize {
        10
    }

    fn support(&self, _cell: usize) -> Support {
        0..self.len()
    }

    fn eval(&self, _cell: usize, x: f64, derivative: usize, out: &mut [f64]) -> Support {
        let length = self.cells[self.cells.len() - 1];
        for (shape, out) in self.shapes.iter().zip(out.iter_mut()) {
            let scale = shape.sign * shape.beta.powi(derivative as i32);
            let (s, c) = libm::sincos(shape.beta * x);
            *out = scale
                * match self.field {
                    Field::Axial => [s, c, -s, -c][derivative % 4],
                    Field::Transverse => {
                        let growing = shape.tip * libm::exp(shape.beta * (x - length));
                        let decaying = shape.root * libm::exp(-shape.beta * x);
                        match derivative % 4 {
                            0 => growing + decaying - c + shape.sigma * s,
                            1 => growing - decaying + s + shape.sigma * c,
                            2 => growing + decaying + c - shape.sigma * s,
                            _ => growing - decaying - s - shape.sigma * c,
                        }
                    }
                };
        }
        if let Some(scale) = self.residual {
            let (modes, last) = out.split_at_mut(self.shapes.len());
            last[0] = self.residual(scale, x, derivative, modes);
        }
        0..self.len()
    }

    /// The residual shape, which the mass does not follow.
    fn tip(&self) -> Option<Tip> {
        self.residual.map(|_| Tip { function: self.shapes.len(), follows: Vec::new() })
    }

    /// The tip, where every mode is largest.
    fn anchor(&self, _i: usize) -> f64 {
        self.cells[self.cells.len() - 1]
    }

    fn role(&self, _i: usize) -> Role {
        Role::Amplitude
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
            for count in [1, 3, 12] {
                checks::all(&Modes::new(3.7, count, field).unwrap(), field);
            }
        }
    }

    type Row = (f64, [f64; 4]);

    /// Mode, [x/L, φ⁽ᵈ⁾/βᵈ for d = 0 … 3], computed with 250 digits from the formula with cosh and sinh.
    const LONG_ARITHMETIC: [(usize, [Row; 3]); 4] = [
        (
            1,
            [
                (0.1, [0.03354699961660878, 0.34921367821338356, 1.7247990866913805, -1.4660690191230608]),
                (0.75, [1.3154946086017087, 1.4368052981799173, 0.19457161670742362, -0.7765895015624631]),
                (
                    0.9985,
                    [1.9958704835511956, 1.4681910201046477, 7.905589563037771e-06, -0.0056195047513102605],
                ),
            ],
        ),
        (
            5,
            [
                (0.003, [0.0017733067935021567, 0.08302427945403851, 1.915177379971733, -1.99997194080719]),
                (0.37, [-1.3586041116384726, -0.37838681149809994, 1.3695741356452156, 0.3679588536770336]),
                (
                    0.9985,
                    [1.9575885730987703, 1.9999939384397682, 0.00044650531881250725, -0.04196182195358579],
                ),
            ],
        ),
        (
            40,
            [
                (0.003, [-0.12140023703307648, -0.6060777890529134, -1.2569240149081111, 1.984402040994101]),
                (0.37, [-1.2889188746091245, -0.5819691870506102, 1.2889188746091245, 0.5819691870506102]),
                (0.9985, [1.6278175858953103, 1.99795025945842, 0.03249819849101383, -0.33763447507209576]),
            ],
        ),
        (
            100,
            [
                (0.003, [-0.6061487400859347, -1.0063275581840747, -0.17685467102554597, 1.7893309692955555]),
                (0.75, [-1.3065629648763766, -0.541196100146197, 1.3065629648763766, 0.541196100146197]),
                (0.9985, [1.0658848543695922, 1.9696645680113507, 0.18551708834224542, -0.7182626252995132]),
            ],
        ),
    ];

    #[test]
    fn bending_modes_agree_with_long_arithmetic_up_to_order_100() {
        let length = 2.5;
        let basis = Modes::new(length, 100, Field::Transverse).unwrap();
        let mut out = vec![0.0; 100];
        for (mode, rows) in LONG_ARITHMETIC {
            let beta = eigenvalue(mode) / length;
            for (x, expected) in rows {
                for d in 0..4 {
                    basis.eval(basis.locate(x * length), x * length, d, &mut out);
                    let found = out[mode - 1] / beta.powi(d as i32);
                    // The argument βx itself is rounded to 1e-16 of up to 314.
                    let error = (found - expected[d]).abs();
                    assert!(error < 2e-13, "mode {mode} x/L {x} derivative {d}: {error:.1e}");
                }
            }
        }
    }

    #[test]
    fn modes_are_orthogonal_in_mass_and_in_stiffness() {
        for (field, order) in [(Field::Axial, 1), (Field::Transverse, 2)] {
            let (length, n) = (2.5, 100);
            let basis = Modes::new(length, n, field).unwrap();
            let mass = checks::gram(&basis, 0, basis.points_per_cell(), |_| 1.0);
            let stiffness = checks::gram(&basis, order, basis.points_per_cell(), |_| 1.0);
            for i in 0..n {
                for j in 0..n {
                    let unit = if i == j { 1.0 } else { 0.0 };
                    let m = mass[i * n + j] / length;
                    assert!((m - unit).abs() < 1e-12, "{field:?} mass {i} {j}: {m:e}");
                    let waves = |i: usize| match field {
                        Field::Axial => (2.0 * i as f64 + 1.0) * FRAC_PI_2 / length,
                        Field::Transverse => (eigenvalue(i + 1) / length).powi(2),
                    };
                    let k = stiffness[i * n + j] / (length * waves(i) * waves(j));
                    assert!((k - unit).abs() < 1e-12, "{field:?} stiffness {i} {j}: {k:e}");
                }
            }
        }
    }

    #[test]
    fn the_tip_is_free_and_positive_and_the_root_clamped() {
        let (length, n) = (2.5, 100);
        let basis = Modes::new(length, n, Field::Transverse).unwrap();
        let mut out = vec![0.0; n];
        for (x, derivative, expected) in
            [(0.0, 0, 0.0), (0.0, 1, 0.0), (length, 0, 2.0), (length, 2, 0.0), (length, 3, 0.0)]
        {
            basis.eval(basis.locate(x), x, derivative, &mut out);
            for i in 0..n {
                let found = out[i] / (eigenvalue(i + 1) / length).powi(derivative as i32);
                assert!(
                    (found - expected).abs() < 2e-13,
                    "mode {} at {x}: φ^({derivative}) = {found:e}",
                    i + 1
                );
            }
        }
    }
}
