//! Multipliers that lie in their sets: the cone problem of all contacts at once.
//!
//! Given W (symmetric, positive semidefinite, m × m) and b, find u = b + W Λ with, row by row,
//!
//! ```text
//! free         u = 0
//! unilateral   u ≥ 0,  Λ ≥ 0,  u Λ = 0
//! friction     |Λ| ≤ μ Λₙ,  u = 0 where |Λ| < μ Λₙ,  u opposite to Λ where |Λ| = μ Λₙ
//! slip         Λ = −s Λₙ
//! ```
//!
//! Friction rows that stand together and share their normal row form a disc. The rows are relaxed one after the other
//! (projected Gauss–Seidel), Λᵢ ← proj(Λᵢ − uᵢ/Wᵢᵢ), a disc as one vector, until no multiplier changes by more than rounding. For
//! contacts without friction the limit is the solution of the linear complementarity problem, unique in u.
//!
//! Where rows follow from each other W is singular, and b, with its rounding and the error of the step, lies beside the range of W. The part beside it moves Λ by the
//! same amount in every sweep, along multipliers that make no motion, until a contact opens or slips for nothing. Relaxation ends there, once the motion WΛ is at rest.
//!
//! Source: Jean (1999, doi 10.1016/S0045-7825(98)00383-1).

/// What a row is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RowLaw {
    /// u = 0
    Free,
    /// u ≥ 0 ⟂ Λ ≥ 0
    Unilateral,
    /// |Λ| ≤ μ Λₙ
    Friction {
        /// μ
        coefficient: f64,
        /// Number of the row n.
        normal: usize,
    },
    /// Λ = −s Λₙ
    Slip {
        /// s = ±μ
        slope: f64,
        /// Number of the row n.
        normal: usize,
    },
}

/// The relaxation did not settle.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the contact forces of {rows} rows did not settle: after {sweeps} sweeps they still change by {change:.1e} of the largest"
)]
pub struct Unresolved {
    /// Number of rows.
    pub rows: usize,
    /// Sweeps done.
    pub sweeps: usize,
    /// Largest change in the last sweep, over the largest multiplier.
    pub change: f64,
}

/// Parts are pressed into each other that cannot give way.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "no finite {contact} stops what closes it: prescribed motions, or contacts on both sides that friction may jam, press what cannot give way; use a force or \
     a spring, end the motion before, or take less friction and restitution"
)]
pub struct Driven {
    /// The unknown of the contact.
    pub contact: String,
}

/// Rows up to which W is formed and relaxed: of more, see [`super::Augmented`].
pub const FEW: usize = 12;

/// Sweeps allowed.
pub(super) const SWEEPS: usize = 200_000;
/// Change over the largest multiplier at which the relaxation ends: rounding, which may go to and fro for ever.
const SETTLED: f64 = 4.0 * f64::EPSILON;
/// Change that must be reached in all sweeps.
const TOLERABLE: f64 = 1e-12;

/// Sweeps after which it is looked whether multipliers change that make no motion.
const LOOK: usize = 64;
/// Change by multipliers that make no motion, over the largest: what of b no multipliers can take away.
const BESIDE: f64 = 1e-5;

/// Solves for Λ, in place and from the values it has, by so many sweeps at most: `w` holds W by rows, `last` is memory. Gives the number of sweeps.
///
/// # Errors
/// [`Unresolved`].
pub(super) fn relax(
    laws: &[RowLaw],
    (w, b): (&[f64], &[f64]),
    lambda: &mut [f64],
    allowed: usize,
    last: &mut Vec<f64>,
) -> Result<usize, Unresolved> {
    let m = laws.len();
    let mut change = 0.0;
    for sweep in 1..=allowed {
        let (mut moved, mut largest) = (0.0_f64, f64::MIN_POSITIVE);
        let look = sweep % LOOK == 0;
        if look {
            last.clear();
            last.extend_from_slice(lambda);
        }
        let mut i = 0;
        while i < m {
            // A disc of friction is relaxed as a whole.
            let mut rows = 1;
            if let RowLaw::Friction { normal, .. } = laws[i] {
                let same = |law: &RowLaw| matches!(law, RowLaw::Friction { normal: n, .. } if *n == normal);
                rows = laws[i..].iter().take_while(|law| same(law)).count();
            }
            let mut before = [0.0; 3];
            let rows = rows.min(before.len());
            before[..rows].copy_from_slice(&lambda[i..i + rows]);
            // The rows of a disc step together, by the velocities at the same multipliers: one after the other they would end where
            // friction is not opposite to sliding. The largest sum of a row of the block bounds its largest eigenvalue.
            let stiffest = (i..i + rows)
                .map(|k| w[k * m + i..k * m + i + rows].iter().map(|w| w.abs()).sum::<f64>())
                .fold(0.0_f64, f64::max);
            let mut u = [0.0; 3];
            for (u, k) in u[..rows].iter_mut().zip(i..) {
                *u = b[k] + w[k * m..(k + 1) * m].iter().zip(&*lambda).map(|(w, x)| w * x).sum::<f64>();
            }
            if stiffest > 0.0 {
                lambda[i..i + rows].iter_mut().zip(u).for_each(|(x, u)| *x -= u / stiffest);
            }
            match laws[i] {
                RowLaw::Free => {}
                RowLaw::Unilateral => lambda[i] = lambda[i].max(0.0),
                RowLaw::Slip { slope, normal } => lambda[i] = -slope * lambda[normal],
                RowLaw::Friction { coefficient, normal } => {
                    let size = lambda[i..i + rows].iter().map(|x| x * x).sum::<f64>().sqrt();
                    let radius = coefficient * lambda[normal];
                    if size > radius {
                        lambda[i..i + rows].iter_mut().for_each(|x| *x *= radius / size);
                    }
                }
            }
            for (now, before) in lambda[i..i + rows].iter().zip(before) {
                moved = moved.max((now - before).abs());
                largest = largest.max(now.abs());
            }
            i += rows;
        }
        change = moved / largest;
        if change <= SETTLED || moved <= f64::MIN_POSITIVE {
            return Ok(sweep);
        }
        if look && change <= BESIDE && is_still(w, lambda, last, largest) {
            return Ok(sweep);
        }
    }
    if change <= TOLERABLE { Ok(allowed) } else { Err(Unresolved { rows: m, sweeps: allowed, change }) }
}

/// Whether the motion W(Λ − Λ′) is rounding.
fn is_still(w: &[f64], lambda: &[f64], last: &[f64], largest: f64) -> bool {
    w.chunks_exact(lambda.len()).all(|row| {
        let (mut moved, mut size) = (0.0, 0.0);
        for ((w, now), before) in row.iter().zip(lambda).zip(last) {
            moved += w * (now - before);
            size += w.abs();
        }
        moved.abs() <= SETTLED * size * largest
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solve(laws: &[RowLaw], w: &[f64], b: &[f64], lambda: &mut [f64]) -> Result<usize, Unresolved> {
        relax(laws, (w, b), lambda, SWEEPS, &mut Vec::new())
    }

    /// A mass on a wall and on another mass: W of two contacts in series, both closing, and one pulling.
    #[test]
    fn complementarity_holds_row_by_row() {
        let w = [2.0, -1.0, 0.3, -1.0, 2.0, 0.1, 0.3, 0.1, 1.0];
        let b = [-1.0, -2.0, 0.5];
        let mut x = [0.0; 3];
        solve(&[RowLaw::Unilateral; 3], &w, &b, &mut x).unwrap();
        for i in 0..3 {
            let u: f64 = b[i] + (0..3).map(|j| w[3 * i + j] * x[j]).sum::<f64>();
            assert!(x[i] >= 0.0 && u > -1e-14 && (u * x[i]).abs() < 1e-14, "{i}: {u} {}", x[i]);
        }
        assert!(x[2] == 0.0 && x[0] > 0.0);
    }

    /// Two contacts at one place, of which one is told to close faster by 1e-9: it takes a billion sweeps until the other is open.
    #[test]
    fn contacts_that_contradict_each_other_by_little_end_with_the_motion() {
        let mut x = [0.0; 2];
        let sweeps = solve(&[RowLaw::Unilateral; 2], &[1.0; 4], &[-1.0, -1.0 - 1e-9], &mut x).unwrap();
        assert!(sweeps <= LOOK && (x[0] + x[1] - 1.0).abs() <= 1.1e-9, "{sweeps} {x:?}");
        // By much they do not: what is asked for is found.
        solve(&[RowLaw::Unilateral; 2], &[1.0; 4], &[-1.0, -1.1], &mut x).unwrap();
        assert!(x[0] == 0.0 && (x[1] - 1.1).abs() < 1e-15, "{x:?}");
    }

    #[test]
    fn friction_sticks_inside_the_disc_and_slides_on_its_rim() {
        let w = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let laws = |coefficient| {
            let friction = RowLaw::Friction { coefficient, normal: 0 };
            [RowLaw::Unilateral, friction, friction]
        };
        let mut x = [0.0; 3];
        solve(&laws(1.0), &w, &[-2.0, 0.6, 0.8], &mut x).unwrap();
        assert_eq!(x, [2.0, -0.6, -0.8]);
        solve(&laws(0.25), &w, &[-2.0, 0.6, 0.8], &mut x).unwrap();
        assert!((x[1] + 0.3).abs() < 1e-15 && (x[2] + 0.4).abs() < 1e-15, "{x:?}");
    }

    /// A body that slides obliquely, W of which couples the two directions and the normal: u = b + W Λ is opposite to Λ on the rim.
    #[test]
    fn friction_of_a_disc_with_coupled_rows_is_opposite_to_sliding() {
        let w = [1.0, 0.2, -0.1, 0.2, 2.0, 0.9, -0.1, 0.9, 1.0];
        let b = [-2.0, 1.5, -2.5];
        let friction = RowLaw::Friction { coefficient: 0.3, normal: 0 };
        let mut x = [0.0; 3];
        solve(&[RowLaw::Unilateral, friction, friction], &w, &b, &mut x).unwrap();
        let u: Vec<f64> = (0..3).map(|i| b[i] + (0..3).map(|j| w[3 * i + j] * x[j]).sum::<f64>()).collect();
        assert!(x[0] > 0.0 && u[0].abs() < 1e-14, "{x:?} {u:?}");
        assert!((x[1].hypot(x[2]) - 0.3 * x[0]).abs() < 1e-14, "{x:?}");
        assert!((x[1] * u[2] - x[2] * u[1]).abs() < 1e-14 && x[1] * u[1] + x[2] * u[2] < 0.0, "{x:?} {u:?}");
    }
}
