//! Warning of a coarse mesh: its error, and the mesh that would do.
//!
//! With d₁ the largest difference of a column of the run and of its companion of twice the functions, and d₂ that of the companion and of
//! one of twice as many again, the observed order is p = log₂(d₁/d₂), and the error falls to a part r with r^(−1/p) times the
//! functions. A mesh is named only when a run with it has shown that it does; where it does not, steps are to blame too.

use super::impacts::until_impact;
use super::pair::{ColumnError, Pair, is_small, vanishes};
use super::{Mesh, Refinable, Variant};
use crate::analysis::recording::{Record, Watch};
use crate::analysis::transient::Ending;
use crate::system::Role;

/// Error over the largest value of a column from which a mesh is coarse.
pub const COARSE: f64 = 0.01;
/// The same of a column that is not among the principal ones: derived values are less accurate.
const DERIVED: f64 = 0.5;
/// Part of that bound which is aimed at.
const AIM: f64 = 0.7;
/// Lowest order at which errors are said to fall, and highest that is trusted.
const ORDERS: (f64, f64) = (0.5, 4.0);
/// Times the functions from which on no mesh is tried: a dense tangent is 4000 times as costly then.
const MOST: f64 = 16.0;
/// Factors on the functions that are tried, one after the other.
const TRIED: [f64; 2] = [1.0, 1.5];

/// A mesh, or steps, with which a principal column is off by more than [a hundredth](COARSE) of its largest value, or a secondary one by more
/// than half of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Coarse {
    /// The column that is off by the largest part of its largest value.
    pub column: String,
    /// That part.
    pub part: f64,
    /// What would do.
    pub remedy: Remedy,
}

/// What makes errors smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Remedy {
    /// Mesh and steps, which [`refine`](super::refine()) refines together: steps are fixed, or there is no mesh.
    MeshAndSteps,
    /// The same, for a finer mesh alone was tried and does not do.
    NotMeshAlone,
    /// This mesh, with which errors have been shown to be small enough, and the order at which they fall.
    Mesh(Mesh, f64),
    /// Twice the functions do not make errors smaller: the motion has waves that no mesh of this size follows.
    None,
}

/// What there is to say of a mesh that is too coarse; `fine` is the run of the companion `finer`.
pub(super) fn coarse<P: Refinable>(
    problem: &P,
    variant: &Variant,
    run: &Record,
    columns: &[ColumnError],
    (finer, fine): (&Variant, &Record),
    watch: &mut Watch<'_>,
) -> Option<Coarse> {
    let channels = run.trajectory.channels();
    let with = |role: Role| {
        let named = move |name: &str| channels.iter().any(|c| c.name == name && c.role == role);
        columns.iter().filter(move |error| named(&error.column))
    };
    let relative = |error: &ColumnError| {
        let index = fine.trajectory.index(&error.column)?;
        let part = error.discretization / fine.trajectory.extremes(index).largest();
        // A derived value that is small beside others of its unit is what the integration leaves.
        let primary = fine.trajectory.channels()[index].role == Role::Primary;
        let nothing = if primary { vanishes } else { is_small };
        (part.is_finite() && !nothing(&fine.trajectory, index, problem.size())).then_some(part)
    };
    let worst = |role: Role, bound: f64| {
        let parts = with(role).filter_map(|error| Some((error, relative(error)?)));
        parts.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|worst| worst.1 > bound)
    };
    let (worst, part) = worst(Role::Primary, COARSE).or_else(|| worst(Role::Secondary, DERIVED))?;
    let judged: Vec<&ColumnError> = with(Role::Primary).chain([worst]).collect();
    let remedy = remedy(problem, variant, run, &judged, (finer, fine), (&worst.column, part), watch);
    Some(Coarse { column: worst.column.clone(), part, remedy })
}

/// What would do where `column` is off by a `part` of its largest value.
fn remedy<P: Refinable>(
    problem: &P,
    variant: &Variant,
    run: &Record,
    columns: &[&ColumnError],
    (finer, fine): (&Variant, &Record),
    (column, part): (&str, f64),
    watch: &mut Watch<'_>,
) -> Remedy {
    // Companions of fixed steps are for those, and would follow every wave of a finer mesh.
    if !problem.has_mesh() || variant.fixed_step().is_some() {
        return Remedy::MeshAndSteps;
    }
    // A mesh may be beyond what a basis or an explicit step allows: then it is none that would do.
    let run_of = |mesh: Mesh, of: &Variant, watch: &mut Watch<'_>| {
        let run = until_impact(problem, &Variant { mesh, ..of.clone() }, watch).ok()?;
        (run.ending == Ending::Finished).then_some(run)
    };
    let Some(finest) = run_of(finer.mesh.halved(), finer, watch) else { return Remedy::NotMeshAlone };
    let off = |a: &Record, b: &Record| {
        Pair::new(&a.trajectory, &b.trajectory, column).map_or(f64::NAN, |pair| pair.largest())
    };
    let order = libm::log2(off(run, fine) / off(fine, &finest));
    if !(order >= ORDERS.0) {
        return Remedy::None;
    }
    let wanted = libm::pow(part / (AIM * COARSE), 1.0 / order.min(ORDERS.1));
    for factor in TRIED.map(|factor| factor * wanted).into_iter().filter(|factor| *factor < MOST) {
        let mesh = Mesh { factor: Some(factor), ..variant.mesh };
        let Some(candidate) = run_of(mesh, variant, watch) else { break };
        let holds = |error: &&ColumnError| {
            let pair = Pair::new(&candidate.trajectory, &finest.trajectory, &error.column);
            pair.is_none_or(|pair| problem.safety() * pair.largest() <= COARSE * pair.size())
        };
        if columns.iter().all(holds) {
            return Remedy::Mesh(mesh, order);
        }
    }
    Remedy::NotMeshAlone
}
