//! A case, computed in several ways: what the [variants](Variant) of its run change in it.

use super::Run;
use crate::change::{Change, Settable, Setting};
use crate::keys::Field;
use crate::kinds::basis::FiniteElements;
use crate::kinds::integrator::{CONTACT_STEP, Controlled, STEP, Steps};
use crate::layout::{self, BASIS, INTEGRATOR, MODEL_ON_HUB, ModelOnHub, OUTPUT, RUN, Recorded};
use crate::problem::Problems;
use crate::reading::Reading;
use crate::values::Value;
use flexion::analysis::disturb;
use flexion::analysis::error::{Disturbance, Mesh, Refinable, SAFETY, Variant};
use flexion::analysis::recording::{Record, Watch};
use flexion::analysis::transient::Plan;
use flexion::integrator::Tolerance;
use flexion::system::State;
use std::borrow::Cow;

/// Elements of the exact coupling where the case has no elements.
const ELEMENTS: usize = 24;

impl Refinable for Reading {
    type Run = Run;
    type Fault = Problems;

    fn variant(&self) -> Variant {
        let plan = Plan::new(self.case.duration, self.case.output.step);
        match self.case.steps {
            Steps::Fixed { step, contact } => {
                Variant::new(Plan { step: Some(step), contact_step: contact, ..plan })
            }
            Steps::Controlled { tolerance, absolute_tolerance, first, longest, contact, breaks } => {
                let plan = Plan {
                    step: first,
                    longest_step: longest,
                    contact_step: contact,
                    break_steps: breaks,
                    ..plan
                };
                Variant::new(plan)
                    .with_tolerance(Tolerance { relative: tolerance, absolute: absolute_tolerance })
            }
        }
    }

    fn run(&self, variant: &Variant, watch: &mut Watch<'_>) -> Result<Run, Problems> {
        Ok(self.at(variant)?.prepare_watched(&mut |_| watch(&State::default()))?.run(watch))
    }

    fn record(&self, variant: &Variant, watch: &mut Watch<'_>) -> Result<Record, Problems> {
        // Pictures are those of the run itself.
        let changes = self.changes(variant)?;
        let case = self.changed(&changes)?;
        let prepared = match variant.disturbance {
            None => case.prepare_watched(&mut |_| watch(&State::default())),
            // Its work is counted in steps, and its start is that of the run.
            Some(_) => case.prepare(),
        };
        let mut prepared = prepared?.without_pictures();
        if let Some(Disturbance { energy, period }) = variant.disturbance {
            // What cannot be disturbed moves as it did.
            let _ = disturb(prepared.live.system.as_mut(), &mut prepared.state, energy, period);
        }
        Ok(prepared.run(watch).into())
    }

    fn has_mesh(&self) -> bool {
        !self.case.finer().is_empty()
    }

    fn has_reference(&self) -> bool {
        self.case.hub_beam().is_some_and(|beam| !beam.coupling.whole_curve)
    }

    fn size(&self) -> f64 {
        self.case.size()
    }

    fn safety(&self) -> f64 {
        self.case.hub_beam().map_or(SAFETY, |beam| beam.bases.safety)
    }
}

impl Reading {
    /// The case of a variant.
    pub(super) fn at(&self, variant: &Variant) -> Result<Reading, Problems> {
        self.changed(&self.changes(variant)?)
    }

    /// What a variant changes in the case. The exact coupling has the elements of the mesh, or elements of its own in place of another
    /// basis.
    fn changes(&self, variant: &Variant) -> Result<Vec<Change>, Problems> {
        let (own, plan) = (self.variant(), &variant.plan);
        let mut changes = self.mesh_changes(variant.mesh)?;
        if variant.reference {
            let elements = self.altered(&changes)?.case.hub_beam().and_then(|beam| beam.bases.elements);
            let elements = elements.map_or(ELEMENTS, |(elements, _)| elements);
            changes.push(MODEL_ON_HUB.change((ModelOnHub::coupling.key.name, Setting::Name("exact"))));
            changes.push(BASIS.change_kind("finite-elements", vec![FiniteElements::elements.to(elements)]));
        }
        if plan.end != own.plan.end {
            // The recording interval that is left out is a part of the duration.
            changes.push(RUN.change(layout::Run::duration.to(plan.end)));
            changes.push(OUTPUT.change(Recorded::step.to(plan.sample)));
        }
        let Some(Tolerance { relative, absolute }) = variant.tolerance else {
            changes.extend(other(&STEP, plan.step, own.plan.step));
            changes.extend(other(&CONTACT_STEP, plan.contact_step, own.plan.contact_step));
            return Ok(changes);
        };
        match own.tolerance {
            Some(before) => {
                changes.extend(other(&Controlled::tolerance, Some(relative), Some(before.relative)));
                changes.extend(other(&Controlled::absolute_tolerance, Some(absolute), Some(before.absolute)));
                changes.extend(other(&Controlled::initial_step, plan.step, own.plan.step));
                changes.extend(other(&Controlled::max_step, plan.longest_step, own.plan.longest_step));
                changes.extend(other(&CONTACT_STEP, plan.contact_step, own.plan.contact_step));
            }
            None => {
                let contact = plan.contact_step.map(|step| Controlled::contact_step.to(step));
                let tolerances =
                    [Controlled::tolerance.to(relative), Controlled::absolute_tolerance.to(absolute)];
                changes
                    .push(INTEGRATOR.change_kind("radau", tolerances.into_iter().chain(contact).collect()));
            }
        }
        if plan.break_steps != own.plan.break_steps {
            changes.push(INTEGRATOR.change(Controlled::break_steps.to(plan.break_steps as usize)));
        }
        Ok(changes)
    }

    /// The changes that make a mesh.
    pub(super) fn mesh_changes(&self, mesh: Mesh) -> Result<Vec<Change>, Problems> {
        let mut changes = Vec::new();
        for _ in 0..mesh.halvings {
            changes = self.altered(&changes)?.case.finer();
        }
        if let Some(factor) = mesh.factor {
            changes.extend(self.altered(&changes)?.case.with_functions(factor));
        }
        Ok(changes)
    }

    fn altered(&self, changes: &[Change]) -> Result<Cow<'_, Reading>, Problems> {
        if changes.is_empty() { Ok(Cow::Borrowed(self)) } else { self.changed(changes).map(Cow::Owned) }
    }

    /// The case with twice the functions.
    ///
    /// # Errors
    /// [`Problems`] when there are too many.
    pub fn with_finer_mesh(&self) -> Result<Reading, Problems> {
        self.changed(&self.case.finer())
    }

    /// The mesh and the steps of the case, as changes.
    pub(super) fn mesh_and_steps(&self) -> Vec<Change> {
        let now = |Change { path, .. }: Change| {
            let (tables, name) = path.rsplit_once('.')?;
            let mut within = &self.values;
            for table in tables.split('.') {
                within = within.inner(table)?;
            }
            let Value::Integer(count) = within.get(name)?.value else { return None };
            Some(Change { to: Setting::Integer(count), path })
        };
        let mut changes: Vec<Change> = self.case.finer().into_iter().filter_map(now).collect();
        let steps = match self.case.steps {
            Steps::Fixed { step, .. } => vec![STEP.to(step)],
            Steps::Controlled { tolerance, first, longest, breaks, .. } => {
                let first = first.map(|first| Controlled::initial_step.to(first));
                let longest = longest.map(|longest| Controlled::max_step.to(longest));
                let breaks = (breaks != 1).then(|| Controlled::break_steps.to(breaks as usize));
                [Controlled::tolerance.to(tolerance)]
                    .into_iter()
                    .chain(first)
                    .chain(longest)
                    .chain(breaks)
                    .collect()
            }
        };
        changes.extend(steps.into_iter().map(|key| INTEGRATOR.change(key)));
        changes
    }
}

/// The change of a key of the integrator, if it is to have another value.
fn other<T: Settable<Value = f64>>(
    field: &Field<T>,
    value: Option<f64>,
    before: Option<f64>,
) -> Option<Change> {
    value.filter(|_| value != before).map(|value| INTEGRATOR.change(field.to(value)))
}

/// Changes as a case says them, between backticks but for the first and the last.
pub(crate) fn said(changes: &[Change]) -> String {
    let texts: Vec<String> = changes.iter().map(Change::to_string).collect();
    texts.join("` and `").replace('=', " = ")
}
