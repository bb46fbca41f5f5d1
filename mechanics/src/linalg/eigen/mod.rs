//! A few eigenpairs (λ² M + λ C + K) x = 0 of large narrow bands, those of smallest |λ − σ|.
//!
//! The eigenvalues next to the shift σ are the largest of an inverse, which a Krylov space finds in some tens of
//! solutions with one factorisation of Q(σ) = σ² M + σ C + K. Three spaces, by the form of the matrices:
//!
//! | matrices | operator | inner product | projected |
//! |---|---|---|---|
//! | C = 0, M and K symmetric | K⁻¹ M | xᵀ M x′ | symmetric |
//! | C skew, M ≥ 0 and K > 0 symmetric | (x, y) ↦ (−K⁻¹(C x + M y), x) | xᵀ K x′ + yᵀ M y′ | skew |
//! | others | (x, y) ↦ (−Q(σ)⁻¹(C x + M (σ x + y)), x + σ·…) | xᵀ (s² M + s D) x′ + yᵀ M y′ | Hessenberg |
//!
//! with y = λ x and D = ½ (C + Cᵀ). In the energy product of the second row the inverse of a conservative gyroscopic system is skew:
//! its eigenvalues stay on the imaginary axis to the last digit. The dual K x of a vector is known before x is, so
//! that K itself multiplies nothing.
//!
//! **Near pairs.** A space may begin with a sum of approximate eigenvectors. What it finds is counted by inertia; of damped vibrations, which no
//! inertia counts, the start has a share of noise too, and those of the system without the symmetric part of C are counted.
//!
//! **Fine meshes.** The condition number of the stiffness of n bending elements is of the order of n⁴, and a rounding
//! of its entries, K + δK with |δK| ≤ ε|K|, moves an eigenvalue by |δλ|/|λ| ≤ ½ε |x|ᵀ|K||x|/|λ|², which
//! [`Pencil::rounding`] gives. Residuals and counts are right to that bound.
//!
//! Sources: Y. Saad, *Numerical Methods for Large Eigenvalue Problems*, 2nd ed., SIAM 2011,
//! doi:10.1137/1.9781611970739 (chapters 6 and 8); L. Meirovitch, *AIAA J.* 12 (1974) 1337–1342,
//! doi:10.2514/3.49486 (gyroscopic systems); F. Tisseur & K. Meerbergen, *SIAM Review* 43 (2001) 235–286,
//! doi:10.1137/S0036144500381988 (quadratic problems).

mod krylov;
mod operators;
mod pairs;
mod pencil;
mod schur;
mod small;
mod sparse;

pub use krylov::largest;
pub use operators::Operator;
pub use pencil::{Kind, Pencil, Softest, UNCERTAIN, is_symmetric, negative_directions};
pub use sparse::{Sparse, each};

use super::Singular;
use num_complex::Complex64;

/// An eigenpair (λ² M + λ C + K) x = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Eigenvalue λ [1/s], Im λ ≥ 0.
    pub value: Complex64,
    /// Eigenvector x, of any size.
    pub vector: Vec<Complex64>,
    /// |Q(σ)⁻¹ Q(λ) x| / |x| in the norm of M: zero for an exact pair.
    pub residual: f64,
}

/// Why eigenpairs were not found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EigenError {
    /// The shifted matrix cannot be factored.
    #[error("the {0}")]
    Singular(#[from] Singular),
    /// The Krylov space was exhausted or grew too large.
    #[error(
        "{converged} of {wanted} eigenvalues converged in a Krylov space of dimension {dimension}: ask for fewer, or lower the damping where it is so strong that \
         most motions decay without vibrating"
    )]
    NotConverged {
        /// Number requested.
        wanted: usize,
        /// Number that converged.
        converged: usize,
        /// Dimension of the space.
        dimension: usize,
    },
    /// The projected problem was not solved.
    #[error(
        "the eigenvalues of the projected matrix of order {0} were not found: it holds numbers that are not finite"
    )]
    Projection(usize),
    /// The iteration for the projected problem did not end.
    #[error("the iteration for the eigenvalues of the projected matrix of order {0} does not end")]
    Iterations(usize),
}
