//! Stability of an equilibrium.
//!
//! Where K is symmetric the equilibrium is a stationary point of a potential. With n₋ the number of negative eigenvalues of
//! [K −Gᵀ; −G 0] and m that of the multipliers, the potential falls in n₋ − m independent directions that the rows allow: a minimum,
//! n₋ = m, is stable (Lagrange, Dirichlet). Elsewhere, with follower loads or with gyroscopic forces about a saddle, the eigenvalues
//! of λ² M + λ C + K of smallest size decide: a motion grows where Re λ > 0.
//!
//! Sources: H. Ziegler, *Principles of Structural Stability*, 2nd ed., Birkhäuser 1977 (follower and gyroscopic forces);
//! N. Gould, *Math. Program.* 32 (1985) 90–99, doi:10.1007/BF01585660 (inertia of matrices with multipliers).

use super::rigid::{BELOW, certain_directions, elastic_frequency};
use super::stiffness::{constrained, freedoms, matrices};
use crate::linalg::Matrix;
use crate::linalg::eigen::{EigenError, Pencil, UNCERTAIN, is_symmetric, negative_directions};
use crate::system::{State, System};
use std::fmt;

/// Eigenvalues that are asked for where the inertia does not decide.
const EIGENVALUES: usize = 12;
/// Growth Re λ/|λ| above which a motion counts as growing: where two frequencies meet, rounding makes about √ε of them.
pub(super) const GROWTH: f64 = 1e-7;

/// How motions about an equilibrium go on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stability {
    /// Directions in which motions leave it without vibrating: buckling, divergence.
    pub divergent: usize,
    /// Vibrations that grow: flutter.
    pub fluttering: usize,
}

impl Stability {
    /// Whether nothing grows.
    pub fn is_stable(&self) -> bool {
        *self == Stability::default()
    }

    /// Number of directions and vibrations that grow.
    pub fn unstable(&self) -> usize {
        self.divergent + self.fluttering
    }
}

impl fmt::Display for Stability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = |n: usize| if n == 1 { "" } else { "s" };
        match (self.divergent, self.fluttering) {
            (0, 0) => write!(f, "stable"),
            (n, 0) => write!(f, "unstable: {n} direction{}", plural(n)),
            (0, n) => write!(f, "unstable: {n} growing vibration{} (flutter)", plural(n)),
            (n, k) => {
                write!(f, "unstable: {n} direction{} and {k} growing vibration{}", plural(n), plural(k))
            }
        }
    }
}

/// Whether some motion about `state` that the rows allow has no stiffness but by rounding.
pub fn is_neutral(system: &mut dyn System, state: &State) -> bool {
    let (all, multipliers) = matrices(system, state);
    rounds(all, multipliers)
}

/// Whether rounding alone decides the softest motion: one that is rigid has no stiffness, of whatever sign rounding makes it.
fn rounds(all: [Matrix; 3], multipliers: usize) -> bool {
    Pencil::new(all, multipliers, 0.0).map_or(true, |mut pencil| pencil.doubts()[0])
}

/// Number of directions, allowed by the rows, in which xᵀKx is negative by more than rounding: a tangent with none is not singular,
/// symmetric or not. Behind a state of `known` directions about none of which rounding decided, it is taken to decide about none of as many.
pub(super) fn negative_parts(system: &mut dyn System, state: &State, known: &mut Option<usize>) -> usize {
    let (stiffness, multipliers) = constrained(system, state);
    let negative = negative_directions(&stiffness.symmetrized(), multipliers);
    if negative == 0 || *known == Some(negative) {
        return negative;
    }
    let (all, multipliers) = matrices(system, state);
    let certain = saddle(&symmetrized(&all), multipliers).unwrap_or(negative);
    *known = (certain == negative).then_some(negative);
    certain
}

/// The stability of `state`, which is taken for an equilibrium as it stands.
///
/// # Errors
/// [`EigenError`] where eigenvalues decide and are not found. A critical state, whose tangent is singular, counts as stable
/// where K is symmetric.
pub fn stability(system: &mut dyn System, state: &State) -> Result<Stability, EigenError> {
    judge(system, state).map(|(stability, _)| stability)
}

/// The stability of an equilibrium, and the number of directions in which the symmetric part of K is negative.
pub(super) fn judge(system: &mut dyn System, state: &State) -> Result<(Stability, usize), EigenError> {
    let (all, multipliers) = matrices(system, state);
    judge_by(system, &all, multipliers)
}

/// The same by the [matrices] of the equilibrium.
pub(super) fn judge_by(
    system: &dyn System,
    all: &[Matrix; 3],
    multipliers: usize,
) -> Result<(Stability, usize), EigenError> {
    let (damping, stiffness) = (&all[1], &all[2]);
    let symmetric = is_symmetric(stiffness);
    let saddle = if symmetric { saddle(all, multipliers)? } else { saddle(&symmetrized(all), multipliers)? };
    let mut gyroscopic = false;
    damping.mirrored(|a, b| gyroscopic |= a * b < 0.0);
    if symmetric && (saddle == 0 || !gyroscopic) {
        return Ok((Stability { divergent: saddle, fluttering: 0 }, saddle));
    }
    let count = EIGENVALUES.min(freedoms(system, &all[2]));
    let direct = Pencil::new(all.clone(), multipliers, 0.0);
    let mut pencil = match direct.map(|mut pencil| (!pencil.doubts()[0]).then_some(pencil)) {
        Ok(Some(pencil)) => pencil,
        Err(error) if !matches!(error, EigenError::Singular(_)) => return Err(error),
        _ => Pencil::new(all.clone(), multipliers, BELOW * elastic_frequency(all, multipliers, count)?)?,
    };
    let pairs = pencil.pairs(count, &[])?;
    let grows = |vibrates: bool| {
        let grown = pairs.iter().filter(|p| p.value.re > GROWTH * p.value.norm());
        // A rigid motion is none that grows, whatever rounding makes of its eigenvalue zero.
        let grown = grown.filter(|p| pencil.rounding(p.value, &p.vector) < UNCERTAIN);
        grown.filter(|p| (p.value.im > 0.0) == vibrates).count()
    };
    Ok((Stability { divergent: grows(false), fluttering: grows(true) }, saddle))
}

/// Number of directions in which a symmetric K is negative but for rounding. A direction that rounding decides need not be the softest: next
/// to a critical speed a free spin is not.
fn saddle(all: &[Matrix; 3], multipliers: usize) -> Result<usize, EigenError> {
    match negative_directions(&all[2], multipliers) {
        0 => Ok(0),
        negative => certain_directions(all, multipliers, negative),
    }
}

/// M, C and the symmetric part of K.
fn symmetrized([mass, damping, stiffness]: &[Matrix; 3]) -> [Matrix; 3] {
    [mass.clone(), damping.clone(), stiffness.symmetrized()]
}
