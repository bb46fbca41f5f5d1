//! Conformance checks of what a user writes: a model, a basis, a section.
//!
//! | function | check | equation |
//! |---|---|---|
//! | [`dynamics()`] | tangent | ∂r/∂a, ∂r/∂v, ∂r/∂q against differences of r |
//! | | multipliers | r(λ + δ) − r(λ) = −Gᵀ δ |
//! | | jacobian | ġ(v + δ) − ġ(v) = G δ |
//! | | rates of constraints | ġ = dg/dt, g̈ = dġ/dt along a motion |
//! | | configuration | (q ⊞ d) ⊟ q = d |
//! | | rate | q ⊞ (d + ḋ dt) = (q ⊞ d) ⊞ v dt with ḋ = T(d)⁻¹ v |
//! | | power | dE/dt = P along the motion that the equations ask for |
//! | [`basis()`] | cells, supports, anchors | ascending, in [0, L], together all functions |
//! | | derivatives | φ⁽ᵈ⁺¹⁾ against differences of φ⁽ᵈ⁾ |
//! | | clamp | φ(0) = 0, transverse φ′(0) = 0 |
//! | | continuity | φ, transverse φ′, across cells |
//! | | quadrature | ∫ φᵢ⁽ᵈ⁾ φⱼ⁽ᵈ⁾ w dx with the points that the basis asks for |
//! | [`section()`] | energies | ρA, EA, EI > 0, ES² < EA EI, ρS² ≤ ρA ρI |
//! | | breaks, jumps | ascending, in [0, L], together all places where the resultants are not smooth |
//! | | fibres | lower fibre below the upper |
//!
//! A model is checked at a few states that are not special (no zeros, no symmetry).

mod basis;
mod dynamics;
mod section;

pub use basis::basis;
pub use dynamics::dynamics;
pub use section::section;

use std::fmt;

/// A check that is not passed.
#[derive(Clone, Debug, PartialEq)]
pub struct Defect {
    /// Which check.
    pub check: &'static str,
    /// Where: the names of the unknowns, the function or the station concerned.
    pub place: String,
    /// What was found.
    pub found: f64,
    /// What it should be: by differences, or the bound that it passes.
    pub expected: f64,
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Defect { check, place, found, expected } = self;
        write!(f, "{check}: {place} is {found:e} and should be {expected:e}")
    }
}

/// Relative error of a difference that is allowed: truncation and rounding of a formula of order 4.
const ALLOWED: f64 = 2e-6;
