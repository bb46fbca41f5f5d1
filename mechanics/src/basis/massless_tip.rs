//! A basis as the inertia of a beam sees it whose tip has no mass.
//!
//! The displacement of the tip alone, coefficient of one function φ_t, is taken out of the kinetic energy: the mass of its part
//! of the beam follows the other coefficients c by a rule that is exact for rigid motion,
//!
//! ```text
//! q_t → Σ cⱼ qⱼ:   φ̃ⱼ = φⱼ + cⱼ φ_t,   φ̃_t = 0
//! ```
//!
//! so that mass, centre of mass and moment of inertia stay, and the mass matrix is singular in φ_t alone (mass redistribution:
//! Khenous, Laborde & Renard 2008, doi 10.1016/j.euromechsol.2008.01.001; for modes a massless boundary: arXiv
//! 2207.00795). The rule of a basis is [`Basis::tip`].

use super::{Basis, Conditioning, Role, Support, Tip};
use std::sync::Arc;

/// The functions φ̃ of a basis. Their formulas head the source file.
#[derive(Clone, Debug)]
pub struct MasslessTip {
    basis: Arc<dyn Basis>,
    tip: Tip,
}

impl MasslessTip {
    /// `None` for a basis without a function that moves the tip alone.
    pub fn new(basis: Arc<dyn Basis>) -> Option<MasslessTip> {
        let tip = basis.tip()?;
        Some(MasslessTip { basis, tip })
    }
}

impl Basis for MasslessTip {
    fn len(&self) -> usize {
        self.basis.len()
    }

    fn cells(&self) -> &[f64] {
        self.basis.cells()
    }

    fn points_per_cell(&self) -> usize {
        self.basis.points_per_cell()
    }

    fn support(&self, cell: usize) -> Support {
        self.basis.support(cell)
    }

    fn eval(&self, cell: usize, x: f64, derivative: usize, out: &mut [f64]) -> Support {
        let support = self.basis.eval(cell, x, derivative, out);
        if support.contains(&self.tip.function) {
            let k = self.tip.function - support.start;
            let phi = std::mem::take(&mut out[k]);
            for &(j, c) in &self.tip.follows {
                out[j - support.start] += c * phi;
            }
        }
        support
    }

    fn anchor(&self, i: usize) -> f64 {
        self.basis.anchor(i)
    }

    fn role(&self, i: usize) -> Role {
        self.basis.role(i)
    }

    fn conditioning(&self) -> Conditioning {
        self.basis.conditioning()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Field, Hermite, Modes};
    use super::*;

    /// Rigid rotation of the clamp's frame is no displacement; what must stay are the functions x² (and with the axial field x)
    /// that the elements hold.
    #[test]
    fn elements_keep_quadratic_displacements_and_lose_the_tip() {
        for (field, power) in [(Field::Axial, 1), (Field::Axial, 2), (Field::Transverse, 2)] {
            let basis = Arc::new(Hermite::on(vec![0.0, 0.4, 1.1, 1.5], field).unwrap());
            let (n, cells) = (basis.len(), basis.cells().to_vec());
            let q: Vec<f64> = (0..n)
                .map(|i| {
                    let x = basis.anchor(i);
                    match basis.role(i) {
                        Role::Slope => f64::from(power) * x.powi(power - 1),
                        _ => x.powi(power),
                    }
                })
                .collect();
            let massless = MasslessTip::new(basis).unwrap();
            for cell in 0..3 {
                let x = 0.3 * cells[cell] + 0.7 * cells[cell + 1];
                let mut out = vec![0.0; 4];
                let support = massless.eval(cell, x, 0, &mut out);
                let sum: f64 = support.zip(&out).map(|(i, phi)| q[i] * phi).sum();
                assert!((sum - x.powi(power)).abs() < 1e-14, "{field:?} {power} {cell}");
            }
        }
    }

    #[test]
    fn the_residual_shape_of_modes_has_no_inertia_and_no_stiffness_with_them() {
        let basis = Modes::with_residual(1.3, 3).unwrap();
        let mut phi = [0.0; 4];
        basis.eval(0, 1.3, 0, &mut phi);
        assert!((phi[3] - 1.0).abs() < 1e-12);
        let gauss = crate::quadrature::Gauss::new(12);
        for i in 0..3 {
            let form: f64 = basis
                .cells()
                .windows(2)
                .enumerate()
                .flat_map(|(c, ends)| gauss.on(ends[0], ends[1]).map(move |at| (c, at)))
                .map(|(c, (x, w))| {
                    basis.eval(c, x, 2, &mut phi);
                    w * phi[i] * phi[3]
                })
                .sum();
            let own: f64 = 3.0 / (1.3_f64.powi(3));
            assert!(form.abs() < 1e-8 * own, "{i}: {form:e}");
        }
        let massless = MasslessTip::new(Arc::new(basis)).unwrap();
        massless.eval(2, 1.2, 1, &mut phi);
        assert_eq!(phi[3], 0.0);
    }
}
