//! Linear algebra of the hot loop: a bordered band matrix with its own LU, and a dense fallback.
//!
//! The matrices of a beam are narrow bands with a few dense rows and columns (the hub angle, and
//! later multipliers). General sparse solvers pay for that border; here it is eliminated.

mod band;
mod bordered;
mod dense;
pub mod eigen;
mod equilibration;
mod inertia;
mod matrix;
mod null_space;
mod scalar;
mod space;
#[cfg(test)]
mod tests;
pub mod vector;

pub use band::Band;
pub use bordered::Bordered;
pub use dense::Dense;
pub use inertia::{negative_pivots, negative_pivots_of};
pub use matrix::{Matrix, Stamp, Storage, Structure};
pub use null_space::NullSpace;
pub use scalar::Scalar;
pub use space::{Mat3, Vec3};

/// A pivot that is none: the inverse of a smaller number is infinite. Entries of one matrix have different units, and none is small beside
/// another: a beam of 1 µm has masses of 1e-19 kg and inertias of sections of 1e-33 kg·m² beside rows of joints of one.
const NOTHING: f64 = f64::MIN_POSITIVE;

/// A matrix that cannot be factored: its pivot is zero, or no number, at unknown `index`.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("matrix is singular to working precision at unknown {index} (relative pivot {pivot:.1e})")]
pub struct Singular {
    /// Index of the unknown at which elimination broke down.
    pub index: usize,
    /// Size of the pivot over the largest entry of the matrix.
    pub pivot: f64,
}
