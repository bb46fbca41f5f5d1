//! A few eigenpairs (λ² M + λ C + K) x = 0 of large narrow bands, those of smallest |λ − σ|.
//!
//! The eigenvalues next to the shift σ are the largest of an inverse, which a Krylov space finds in some tens of
//! solutions with one factorisation of Q(σ) = σ² M + σ C + K. Three spaces, by what the matrices are:
//!
//! | matrices | operator | inner product | projected |
//! |---|---|---|---|
//! | C = 0, M and K symmetric | K⁻¹ M | xᵀ M x′ | symmetric |
//! | C skew, M ≥ 0 and K > 0 symmetric | (x, y) ↦ (−K⁻¹(C x + M y), x) | xᵀ K x′ + yᵀ M y′ | skew |
//! | others | (x, y) ↦ (−Q(σ)⁻¹(C x + M (σ x + y)), x + σ·…) | s² xᵀ M x′ + yᵀ M y′ | Hessenberg |
//!
//! with y = λ x. In the energy product of the second row the inverse of a conservative gyroscopic system is skew:
//! its eigenvalues stay on the imaginary axis to the last digit. K enters through its inverse only, and the dual
//! K x of a vector is known before x is: nothing is ever multiplied by K.
//!
//! **Fine meshes.** The stiffness of n bending elements has a condition number of n⁴: stored in doubles, it
//! has lost the lowest frequency at 10 000 elements before anything is solved. [`Pencil`] therefore
//! holds K in [`Double`] numbers (106 bits); a model that can say K as Σ w b bᵀ of strains has it summed there.
//! A solution then is right to the last digit of a double.
//!
//! Sources: Y. Saad, *Numerical Methods for Large Eigenvalue Problems*, 2nd ed., SIAM 2011,
//! doi:10.1137/1.9781611970739 (chapters 6 and 8); L. Meirovitch, *AIAA J.* 12 (1974) 1337–1342,
//! doi:10.2514/3.49486 (gyroscopic systems); F. Tisseur & K. Meerbergen, *SIAM Review* 43 (2001) 235–286,
//! doi:10.1137/S0036144500381988 (quadratic problems).

mod krylov;
mod operators;
mod pencil;
mod small;
#[cfg(test)]
mod tests;

pub use pencil::{Kind, Pencil, each, negative_eigenvalues, widen};

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
pub enum EigenError {
    /// The shifted matrix cannot be factored.
    #[error("the {0}")]
    Singular(#[from] Singular),
    /// The Krylov space was exhausted or grew too large.
    #[error("{converged} of {wanted} eigenvalues converged in a Krylov space of dimension {dimension}")]
    NotConverged {
        /// How many were wanted.
        wanted: usize,
        /// How many converged.
        converged: usize,
        /// Dimension of the space.
        dimension: usize,
    },
    /// The projected problem was not solved.
    #[error(
        "the eigenvalues of the projected matrix of order {0} were not found: it holds numbers that are not finite"
    )]
    Projection(usize),
}
