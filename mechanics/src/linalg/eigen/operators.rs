//! The inverse operators whose largest eigenvalues are computed. The dual of a vector gives the inner product.

use super::{Pencil, Sparse};
use crate::linalg::vector::{axpy, dot, noise, scale};

/// A linear operator with an inner product ⟨z, z′⟩ = z · dual(z′).
pub trait Operator {
    /// Length of its vectors.
    fn dimension(&self) -> usize;

    /// w = A z, and what [`Operator::dual`] does not give of the dual of w.
    fn apply(&mut self, z: &[f64], dual: &[f64], w: &mut [f64], dual_w: &mut [f64]);

    /// The dual of z, as far as [`Operator::apply`] needs it.
    fn dual(&mut self, z: &[f64], dual: &mut [f64]);

    /// Whether that is the whole dual.
    fn knows_duals(&self) -> bool {
        true
    }
}

/// x ↦ K⁻¹ M x with the dual M x.
pub(super) struct Symmetric<'a>(pub &'a mut Pencil);

impl Operator for Symmetric<'_> {
    fn dimension(&self) -> usize {
        self.0.order()
    }

    fn apply(&mut self, _z: &[f64], dual: &[f64], w: &mut [f64], _dual_w: &mut [f64]) {
        w.copy_from_slice(dual);
        self.0.solve(w);
    }

    fn dual(&mut self, z: &[f64], dual: &mut [f64]) {
        self.0.mass().multiply(z, dual);
    }
}

/// (x, y) ↦ (−K⁻¹(C x + M y), x) with the dual (K x, M y).
pub(super) struct Gyroscopic<'a>(pub &'a mut Pencil);

impl Operator for Gyroscopic<'_> {
    fn dimension(&self) -> usize {
        2 * self.0.order()
    }

    fn apply(&mut self, z: &[f64], dual: &[f64], w: &mut [f64], dual_w: &mut [f64]) {
        let n = self.0.order();
        let (wx, wy) = w.split_at_mut(n);
        let kx = &mut dual_w[..n];
        self.0.damping().multiply(&z[..n], kx);
        for (f, my) in kx.iter_mut().zip(&dual[n..]) {
            *f = -*f - my;
        }
        wx.copy_from_slice(kx);
        self.0.solve(wx);
        wy.copy_from_slice(&z[..n]);
    }

    fn knows_duals(&self) -> bool {
        false
    }

    fn dual(&mut self, z: &[f64], dual: &mut [f64]) {
        let n = self.0.order();
        self.0.mass().multiply(&z[n..], &mut dual[n..]);
    }
}

/// (x, y) ↦ (w, x + σ w) with Q(σ) w = −(C x + M (σ x + y)), and the dual (s² M x + s D x, M y) with the dissipation D, the symmetric
/// part of C where its diagonal is not negative: M alone does not bound C x of directions that are damped and have little mass.
pub(super) struct General<'a> {
    pencil: &'a mut Pencil,
    dissipation: Option<Sparse>,
    /// s², about the square of the lowest frequency: makes both halves of a vector comparable.
    scale: f64,
}

impl<'a> General<'a> {
    pub(super) fn new(pencil: &'a mut Pencil) -> General<'a> {
        let n = pencil.order();
        let (mut x, mut mx) = (noise(n, 7), vec![0.0; n]);
        let mut scale = 1.0;
        for _ in 0..3 {
            pencil.mass().multiply(&x, &mut mx);
            let before = dot(&x, &mx);
            x.copy_from_slice(&mx);
            pencil.solve(&mut x);
            pencil.mass().multiply(&x, &mut mx);
            scale = (before / dot(&x, &mx)).sqrt();
        }
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        let dissipation = if pencil.is_conservative() { None } else { pencil.dissipation() };
        General { pencil, dissipation, scale }
    }

    fn duals(&self, w: &[f64], dual: &mut [f64]) {
        let n = self.pencil.order();
        let (dual_x, dual_y) = dual.split_at_mut(n);
        self.pencil.mass().multiply(&w[..n], dual_x);
        scale(self.scale, dual_x);
        if let Some(dissipation) = &self.dissipation {
            dissipation.multiply(&w[..n], dual_y);
            axpy(self.scale.sqrt(), dual_y, dual_x);
        }
        self.pencil.mass().multiply(&w[n..], dual_y);
    }
}

impl Operator for General<'_> {
    fn dimension(&self) -> usize {
        2 * self.pencil.order()
    }

    fn apply(&mut self, z: &[f64], dual: &[f64], w: &mut [f64], _dual_w: &mut [f64]) {
        let n = self.pencil.order();
        let shift = self.pencil.shift();
        let (wx, wy) = w.split_at_mut(n);
        self.pencil.damping().multiply(&z[..n], wx);
        if shift != 0.0 {
            self.pencil.mass().multiply(&z[..n], wy);
            axpy(shift, wy, wx);
        }
        for (f, my) in wx.iter_mut().zip(&dual[n..]) {
            *f = -(*f + my);
        }
        self.pencil.solve(wx);
        for ((wy, wx), x) in wy.iter_mut().zip(wx.iter()).zip(&z[..n]) {
            *wy = x + shift * wx;
        }
    }

    fn dual(&mut self, z: &[f64], dual: &mut [f64]) {
        self.duals(z, dual);
    }
}
