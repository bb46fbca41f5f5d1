//! Estimated errors of the columns of a run.

use flexion::analysis::error::{ColumnError, Unstable};
use flexion::analysis::recording::Trajectory;
use serde_json::{Map, Value, json};

/// A run of a sequence that is refined until its error is small enough.
#[derive(Clone, Debug, PartialEq)]
pub struct Rung {
    /// Its mesh and steps, as changes of the case, `basis.elements=20`.
    pub changes: Vec<String>,
    /// The quantity that is farthest from its bound.
    pub quantity: String,
    /// Its value, where it is one.
    pub value: Option<f64>,
    /// Its error.
    pub error: f64,
    /// Observed order p: log₂ of the error of the run before over this, where that had the same quantity.
    pub order: Option<f64>,
}

/// Estimated errors of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Errors {
    /// One entry for each column but those about the integrator.
    pub columns: Vec<ColumnError>,
    /// What could not be estimated, and why.
    pub warnings: Vec<String>,
    /// Time \[s\] until which the errors of the principal columns stay below a tenth of their largest values.
    pub trusted: f64,
    /// The column whose error exceeds that first, where one does.
    pub distrusted: Option<String>,
    /// How a small disturbance grows, where it does.
    pub unstable: Option<Unstable>,
    /// What the finer companion recorded, until the first impact at the latest.
    pub finer: Trajectory,
    /// By how much the difference from it is multiplied.
    pub safety: f64,
    /// The runs that led to this one, which is the last, where the case was refined.
    pub sequence: Vec<Rung>,
    /// Why there is no estimate, where there is none.
    pub unknown: Option<String>,
}

impl Errors {
    /// No estimate, and why.
    pub fn none(why: String) -> Errors {
        Errors { unknown: Some(why), ..Errors::default() }
    }

    /// The entry of a column for the summary.
    pub(super) fn of(&self, column: &str) -> Option<Value> {
        let error = self.columns.iter().find(|error| error.column == column)?;
        let ColumnError { min, max, last, discretization, model, .. } = error;
        Some(json!({
            "min": min, "max": max, "final": last, "discretization": discretization, "model": model,
        }))
    }

    /// The entry `trust` of the summary.
    pub(super) fn trust(&self) -> Map<String, Value> {
        let mut out = Map::new();
        out.insert("estimated".into(), self.unknown.is_none().into());
        out.insert("reason".into(), self.unknown.clone().into());
        out.insert("until".into(), self.unknown.is_none().then_some(self.trusted).into());
        out.insert("column".into(), self.distrusted.clone().into());
        if let Some(Unstable { size, column, from, until }) = &self.unstable {
            let entry = json!({ "disturbance": size, "column": column, "from": from, "until": until });
            out.insert("unstable".into(), entry);
        }
        if !self.sequence.is_empty() {
            out.insert("refinement".into(), self.sequence.iter().map(Rung::to_json).collect());
        }
        out
    }
}

impl Rung {
    fn to_json(&self) -> Value {
        let Rung { changes, quantity, value, error, order } = self;
        json!({ "case": changes, "quantity": quantity, "value": value, "error": error, "order": order })
    }
}
