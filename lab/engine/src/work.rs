//! Counted work, and what is shown of it.

use crate::memory;
use flexion_case::Reading;
use serde_json::{Value, json};
use std::ops::ControlFlow;

/// What is shown of a request while it is answered.
pub type Progress<'p> = dyn FnMut(&str) + Send + 'p;

/// Work between two notices, steps times unknowns: some tens of milliseconds.
const NOTICE: f64 = 3e4;

/// Counts the work of a request, shows how far it is, and ends it at its limits.
pub(crate) struct Work<'p> {
    done: f64,
    limit: f64,
    shown: f64,
    /// Why it was given up.
    pub given_up: Option<String>,
    progress: &'p mut (dyn FnMut(&str) + Send),
}

impl<'p> Work<'p> {
    pub(crate) fn new(limit: f64, progress: &'p mut Progress<'_>) -> Work<'p> {
        Work { done: 0.0, limit, shown: 0.0, given_up: None, progress }
    }

    /// Counts work, shows it now and then, and ends it beyond a limit.
    pub(crate) fn add(&mut self, work: f64, said: impl FnOnce() -> Value) -> ControlFlow<()> {
        self.done += work;
        if self.done - self.shown > NOTICE {
            self.shown = self.done;
            (self.progress)(&said().to_string());
        }
        let over = memory::exceeded();
        if self.given_up.is_none() && (over || self.done > self.limit) {
            let why = if over { "the memory that it may take" } else { "the work that it may take" };
            self.given_up = Some(format!("given up at the limit of {why}"));
        }
        if self.given_up.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// All that is wrong with a case.
pub(crate) fn problems(problems: &flexion_case::Problems) -> Value {
    let one = |problem: &flexion_case::Problem| {
        let place = problems.line_and_column(problem);
        let source = problem.place.as_ref().map_or(0, |place| place.source);
        let set = (source > 0).then(|| problems.sources.get(source).map(|source| source.name.clone()));
        json!({
            "line": place.filter(|_| source == 0).map(|place| place.0),
            "column": place.filter(|_| source == 0).map(|place| place.1),
            "set": set, "key": problem.key, "message": problem.message, "label": problem.label,
            "help": problem.help, "severity": "error",
        })
    };
    problems.list.iter().map(one).collect()
}

/// The reply to a case that is rejected.
pub(crate) fn rejected(of: &flexion_case::Problems) -> Value {
    json!({ "status": "rejected", "message": of.reason(), "problems": problems(of) })
}

/// What was found, or the reply in its place.
pub(crate) type Found<T> = Result<T, Value>;

/// The reply to a request that is wrong.
pub(crate) fn refused(message: impl Into<String>) -> Value {
    json!({ "status": "refused", "message": message.into() })
}

/// Number of unknowns of a case.
pub(crate) fn unknowns(reading: &Reading) -> f64 {
    reading.case.system().map_or(1, |system| system.size().v.max(1)) as f64
}
