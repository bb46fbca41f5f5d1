//! What a mesh that is too coarse is told: its error, and the mesh that would do.
//!
//! With d₁ the largest difference of a column of the run and of its companion of twice the functions, and d₂ that of the companion and of
//! one of twice as many again, the observed order is p = log₂(d₁/d₂), and the error falls to a part r with r^(−1/p) times the
//! functions. A mesh is named only when a run with it has shown that it does; where it does not, steps are to blame too.

use super::Run;
use super::difference::{Pair, vanishes};
use crate::problem::Problems;
use crate::reading::Reading;
use flexion::analysis::recording::Watch;
use flexion_results::{ColumnError, Status};

/// Error over the largest value of a column from which a mesh is coarse.
pub(crate) const COARSE: f64 = 0.01;
/// Part of that bound which is aimed at.
const AIM: f64 = 0.7;
/// Lowest order at which errors are said to fall, and highest that is trusted.
const ORDERS: (f64, f64) = (0.5, 4.0);
/// Times the functions from which on no mesh is tried: a dense tangent is 4000 times as costly then.
const MOST: f64 = 16.0;
/// Factors on the functions that are tried, one after the other.
const TRIED: [f64; 2] = [1.0, 1.5];

impl Reading {
    /// A warning of a mesh with which a principal column is off by more than a hundredth of its largest value. `columns` are the principal
    /// columns with their errors, `fine` is the run of the companion `finer`.
    pub(super) fn coarse(
        &self,
        run: &Run,
        columns: &[&ColumnError],
        (finer, fine): (&Reading, &Run),
        safety: f64,
        watch: &mut Watch<'_>,
    ) -> Option<String> {
        let relative = |error: &ColumnError| {
            let index = fine.trajectory.index(&error.column)?;
            let largest = fine.trajectory.extremes(index).largest();
            let part = Some(error.discretization / largest).filter(|part| part.is_finite());
            part.filter(|_| !vanishes(&fine.trajectory, index, self.case.size()))
        };
        let worst = columns.iter().filter_map(|error| Some((error.column.as_str(), relative(error)?)));
        let (column, part) = worst.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|worst| worst.1 > COARSE)?;
        Some(self.told(run, columns, (finer, fine), (column, part), safety, watch))
    }

    /// What is said of a mesh with which `column` is off by a `part` of its largest value.
    fn told(
        &self,
        run: &Run,
        columns: &[&ColumnError],
        (finer, fine): (&Reading, &Run),
        (column, part): (&str, f64),
        safety: f64,
        watch: &mut Watch<'_>,
    ) -> String {
        let said =
            format!("mesh and steps are coarse: the error of {column} {} of its largest value", much(part));
        let more = finer.case.finer();
        // Companions of fixed steps are for those, and would follow every wave of a finer mesh.
        if more.is_empty() || self.case.steps.step().is_some() {
            return format!("{said}; `--tolerance {COARSE}` refines them");
        }
        // A mesh may be beyond what its basis or an explicit step allows: that is no fault of the case.
        let run_of = |reading: Result<Reading, Problems>, watch: &mut Watch<'_>| {
            let mut run = reading.and_then(|reading| reading.prepare()).ok()?.run(watch);
            self.cut_at_impact(&mut run);
            (run.status == Status::Finished).then_some(run)
        };
        let both = format!(
            "{said}, and a finer mesh alone does not bring it down: `--tolerance {COARSE}` refines mesh and steps"
        );
        let Some(finest) = run_of(finer.with(&more), watch) else { return both };
        let off = |a: &Run, b: &Run, column: &str| {
            Pair::new(&a.trajectory, &b.trajectory, column).map_or(f64::NAN, |pair| pair.largest())
        };
        let order = (off(run, fine, column) / off(fine, &finest, column)).log2();
        if !(order >= ORDERS.0) {
            return format!(
                "{said}, and twice the functions do not bring it down: the motion has waves that no mesh of this size follows; \
                 let loads set in more slowly, damp it, or ask for a shorter time"
            );
        }
        let wanted = (part / (AIM * COARSE)).powf(1.0 / order.min(ORDERS.1));
        for factor in TRIED.map(|factor| factor * wanted).into_iter().filter(|factor| *factor < MOST) {
            let changes = self.case.with_functions(factor);
            let Some(candidate) = run_of(self.with(&changes), watch) else { break };
            let holds = |error: &&ColumnError| {
                let pair = Pair::new(&candidate.trajectory, &finest.trajectory, &error.column);
                pair.is_none_or(|pair| safety * pair.largest() <= COARSE * pair.size())
            };
            if columns.iter().all(holds) {
                let changes = changes.join("` and `").replace('=', " = ");
                return format!("{said}; with `{changes}` it is below 1 % (observed order {order:.1})");
            }
        }
        both
    }
}

/// How large a part of a value is, in words.
pub(crate) fn much(part: f64) -> String {
    match (100.0 * part).ceil() {
        percent if percent < 100.0 => format!("is {percent:.0} %"),
        _ => "is as large as all".to_owned(),
    }
}
