//! A blade in space: small vibrations about the steady state of constant rotation.
//!
//! The blade's axis leaves the axis of rotation at an angle of 90° less the precone β, and the root is at the
//! distance a along it. In the blade's frame e₁ points to the tip, e₂ in the direction of motion, e₃ = e₁ × e₂
//! towards the vector of rotation; the frame rotates with Ω (sin β, 0, cos β). The displacement is
//! axial u, chordwise v, flapwise w and torsion φ; sections are rotated about e₁ by pitch and twist.
//!
//! | strain energy | kept | fails when |
//! |---|---|---|
//! | [`Linear`](StrainEnergy::Linear) | axial strain and curvature to second order, foreshortening | the strain of the rotation is not small against 1 |
//! | [`Coupled`](StrainEnergy::Coupled) | terms of the Green strain besides, each by choice | as above: see the theory page |
//! | [`Exact`](StrainEnergy::Exact) | everything but shear and warping | strains leave the elastic range |
//!
//! Left out: offsets of mass centre and shear centre from the axis, shear, warping, damping, gravity.

mod element;
mod frame;
mod jet;
mod matrices;
mod mesh;
mod model;
mod straight;
mod system;
mod tension;
mod terms;
#[cfg(test)]
mod tests;

pub use mesh::Component;
pub use model::{BladeError, Body, Model, Setting, StrainEnergy, Terms, Tip};
pub use system::Blade;
