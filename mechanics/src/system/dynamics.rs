//! What an integrator sees of a model.

use super::{Corotation, RowWeights, Set, Size, State};
use crate::linalg::eigen::Sparse;
use crate::linalg::vector::dot;
use crate::linalg::{Matrix, Structure};

/// Scalar weights of the tangent w.a M + w.v C + w.q K.
#[derive(Clone, Copy, Debug)]
pub struct Weights<'a> {
    /// Weight of K = ∂r/∂q.
    pub q: f64,
    /// Weight of C = ∂r/∂v.
    pub v: f64,
    /// Weight of M = ∂r/∂a.
    pub a: f64,
    /// The increment since the last step at which the configuration is retracted, for systems
    /// whose configuration is not a vector space; `None` where it is zero or irrelevant.
    pub increment: Option<&'a [f64]>,
}

impl Weights<'_> {
    /// Weights without an increment.
    pub fn new(a: f64, v: f64, q: f64) -> Weights<'static> {
        Weights { q, v, a, increment: None }
    }
}

/// xᵀ (∂r/∂q) x of a motion x, its strain energy summed strain by strain.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StiffnessForm {
    /// The form.
    pub value: f64,
    /// Bound of its error by the rounding of what is no strain, ε |x|ᵀ|K||x| with that part K of the stiffness.
    pub rounding: f64,
}

impl StiffnessForm {
    /// Those of the part of a stiffness that is no strain.
    pub fn of(rest: &Matrix, vectors: &[Vec<f64>]) -> Vec<StiffnessForm> {
        let entries = Sparse::of(rest);
        let sizes = entries.clone().sizes();
        let form = |of: &Sparse, x: &[f64]| {
            let mut product = vec![0.0; x.len()];
            of.multiply(x, &mut product);
            dot(x, &product)
        };
        let of = |x: &Vec<f64>| {
            let size: Vec<f64> = x.iter().map(|x| x.abs()).collect();
            StiffnessForm { value: form(&entries, x), rounding: f64::EPSILON * form(&sizes, &size) }
        };
        vectors.iter().map(of).collect()
    }
}

/// Receives a row of the jacobian G: its number, the numbers of the velocities, and the entries there.
pub type VisitRow<'a> = dyn FnMut(usize, &[usize], &[f64]) + 'a;

/// The equations of motion of a model, as an integrator needs them. See the [module documentation](super).
pub trait Dynamics: Send {
    /// Numbers of coordinates, velocities and multipliers.
    fn size(&self) -> Size;

    /// Structure of the matrix of the unknowns (v), (v, λ) or (v, λ, μ) with no, one or two multipliers a row. The
    /// default is that of a dense matrix. Integrators use the numbers of the unknowns only: a model places multipliers
    /// inside its band by an [order](Structure::Ordered) of its own; the matrix of the velocities alone has none.
    fn structure(&self, multipliers: usize) -> Structure {
        let size = self.size();
        Structure::dense(size.v + multipliers * size.lambda)
    }

    /// Whether the matrix of the unknowns has room for GᵀG of each contact, with its row of G and those of its friction.
    fn contacts_are_local(&self) -> bool {
        false
    }

    /// Whether the direction of a row of friction turns about the normal of its contact by itself, as the tangents of a sphere do.
    fn twists(&self, _row: usize) -> bool {
        false
    }

    /// The size (> 0) by which errors and increments of each velocity's unknown are measured: `Size::v` entries, a
    /// length in metres for displacements, 1 for angles and slopes.
    fn scales(&self) -> &[f64];

    /// The length by which displacements are measured \[m\]: the largest of the [scales](Dynamics::scales) but those of angles, which are 1.
    fn length(&self) -> f64 {
        let lengths = self.scales().iter().filter(|scale| **scale != 1.0);
        lengths.copied().reduce(f64::max).unwrap_or(1.0)
    }

    /// The largest of the velocities `v` [m/s], angular ones and those of slopes as at the [length](Dynamics::length): what velocities of any unit
    /// are measured by. Likewise of accelerations.
    fn fastest(&self, v: &[f64]) -> f64 {
        self.length()
            * v.iter().zip(self.scales()).fold(0.0_f64, |most, (v, scale)| most.max((v / scale).abs()))
    }

    /// Name of unknown `i` for messages: a velocity, or behind them a multiplier.
    fn unknown(&self, i: usize) -> String {
        format!("unknown {i}")
    }

    /// The state at t = 0 without deformation, its accelerations still to be found.
    fn initial(&self) -> State {
        State::zeros(self.size(), 0.0)
    }

    /// The velocities across the plane in which a system stays: modes, stability and disturbances leave them out.
    fn across(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Whether r is affine in (q, v, a) at fixed t: Newton's method then needs one iteration.
    fn is_affine(&self) -> bool {
        false
    }

    /// Whether the configuration is a vector space, q ⊞ d = q + d.
    fn is_vector_space(&self) -> bool {
        true
    }

    /// `out` = q ⊞ d: the configuration q moved by the increment d (`Size::v` entries).
    fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        for ((out, q), d) in out.iter_mut().zip(q).zip(d) {
            *out = q + d;
        }
    }

    /// `d` = `to` ⊟ `from`: the increment with `from` ⊞ d = `to`.
    fn difference(&self, from: &[f64], to: &[f64], d: &mut [f64]) {
        for ((d, from), to) in d.iter_mut().zip(from).zip(to) {
            *d = to - from;
        }
    }

    /// `out` = ḋ, the rate of the increment d in q₀ ⊞ d(t) where the velocity is v: ḋ = T(q₀, d)⁻¹ v. On a vector space v.
    fn rate(&self, _from: &[f64], _d: &[f64], v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(v);
    }

    /// `r` = M a − f − Gᵀ λ, `Size::v` entries.
    fn residual(&mut self, s: &State, r: &mut [f64]);

    /// Writes c₀ g + c₁ ġ + c₂ g̈ of every row, active or not, `Size::lambda` entries.
    fn constraint(&mut self, _s: &State, _c: RowWeights, _g: &mut [f64]) {}

    /// Largest |g|, |ġ| and |g̈| of constraints that the model leaves out because they follow from its rows.
    fn dropped(&mut self, _s: &State) -> [f64; 3] {
        [0.0; 3]
    }

    /// The set of each multiplier.
    fn rows(&self) -> &[Set] {
        &[]
    }

    /// Shows the rows of the jacobian G = ∂g/∂q, in the sense that ġ = G v + ∂g/∂t.
    fn jacobian(&mut self, _s: &State, _visit: &mut VisitRow<'_>) {}

    /// Writes w.a ∂r/∂a + w.v ∂r/∂v + w.q ∂r/∂q into the part of `out` that belongs to the velocities; its former
    /// content is discarded and the rest is zero. A model without rows may leave a factored `out` as it is when it
    /// recognises, by the matrix's [stamp](crate::linalg::Matrix::stamp), that it already holds the very same tangent.
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix);

    /// Writes how the sections rotate from `before` to `now`: with the rotations R, ∂r/∂q(now) is near
    /// R ∂r/∂q(before) Rᵀ though the axial stiffness of a slender beam outweighs all others. Nothing for a system whose
    /// stiffness does not rotate with its sections. Multipliers, numbered behind the velocities, may rotate too.
    fn corotate(&self, _before: &State, _now: &State, out: &mut Corotation) {
        out.clear();
    }

    /// xᵀ (∂r/∂q) x of each of the vectors, the strain energy summed strain by strain, Σ w (bᵀx)². `None` for a model that
    /// has its stiffness as a matrix only.
    ///
    /// The condition number of the stiffness of n bending elements grows like n⁴, and with the square of the slenderness where shear or the axis is stiff:
    /// its entries, rounded to doubles, lose the lowest frequencies, but not the strains, which lose n²ε.
    fn stiffness_forms(&mut self, _s: &State, _vectors: &[Vec<f64>]) -> Option<Vec<StiffnessForm>> {
        None
    }
}
