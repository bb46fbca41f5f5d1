//! A run with what is asked of it, the same for every door: to its end or to a time, with its errors, or refined to a tolerance.

use super::refine::{RefineError, Refinement, Target};
use super::{Prepared, Run};
use crate::reading::Reading;
use flexion::analysis::error::Effort;
use flexion_results::{Rung, Status};
use std::borrow::Cow;
use std::ops::ControlFlow;

/// What is asked of a run. By default it goes to its end, and its errors are estimated where that costs a few times the run.
#[derive(Clone, Debug)]
pub struct Request {
    /// It stops behind the step that reaches this time \[s\].
    pub until: f64,
    /// What the estimate of its errors may cost; `None` estimates none.
    pub effort: Option<Effort>,
    /// Mesh and steps are refined until this holds; without it, until the accuracy that the case asks for holds.
    pub target: Option<Target>,
}

impl Default for Request {
    fn default() -> Request {
        Request { until: f64::INFINITY, effort: Some(Effort::Auto), target: None }
    }
}

/// How far a calculation is.
#[derive(Debug)]
pub enum Stage<'a> {
    /// A stable equilibrium to begin with is looked for, at this load factor.
    Search(f64),
    /// The run, a companion or a refined run has reached this time \[s\].
    Time(f64),
    /// A refined run has ended.
    Refined(&'a Rung),
}

/// A run, and how what was asked of it went.
pub struct Calculation<'r> {
    /// The case, refined where a tolerance was asked.
    pub reading: Cow<'r, Reading>,
    /// Its run.
    pub run: Run,
    /// Whether it was stopped at the time that was asked.
    pub reached: bool,
    /// Why a tolerance was not reached, or errors that were asked are not known.
    pub refused: Option<String>,
}

impl Reading {
    /// Runs a prepared case as `request` asks. `watch` is called after every step and every refined run, and stops by `Break`: what was
    /// computed until then is kept.
    ///
    /// # Errors
    /// [`RefineError`] where nothing can be refined.
    pub fn calculate(
        &self,
        prepared: Prepared,
        request: &Request,
        watch: &mut dyn FnMut(Stage<'_>) -> ControlFlow<()>,
    ) -> Result<Calculation<'_>, RefineError> {
        let of_case = self.case.accuracy.clone();
        let of_case = of_case.map(|(tolerance, quantity)| Target::new(format!("{tolerance:e}"), quantity));
        if let Some(target) = request.target.clone().or(of_case) {
            let watch = std::cell::RefCell::new(watch);
            let refined =
                self.refine(&target, &mut |state| watch.borrow_mut()(Stage::Time(state.t)), &mut |rung| {
                    // A refinement ends at a step.
                    let _ = watch.borrow_mut()(Stage::Refined(rung));
                });
            let Refinement { reading, run, refused } = refined?;
            return Ok(Calculation { reading: Cow::Owned(reading), run, reached: false, refused });
        }
        let mut reached = false;
        let mut run = prepared.run(&mut |state| {
            reached = state.t >= request.until;
            if reached { ControlFlow::Break(()) } else { watch(Stage::Time(state.t)) }
        });
        reached &= run.status == Status::Stopped;
        if reached {
            run.message = Some(format!("stopped at t = {:.6} s, as asked", run.state.t));
        }
        let mut refused = None;
        // What a run that was stopped holds has no end to compare.
        if let Some(effort) = request.effort.filter(|_| run.status == Status::Finished) {
            run.errors = Some(self.estimate_errors(&run, effort, &mut |state| {
                let flow = watch(Stage::Time(state.t));
                if flow.is_break() {
                    refused = Some(STOPPED.to_owned());
                }
                flow
            }));
        }
        Ok(Calculation { reading: Cow::Borrowed(self), run, reached, refused })
    }
}

const STOPPED: &str =
    "stopped by the user while errors were estimated: the run is finished, its errors are not known";
