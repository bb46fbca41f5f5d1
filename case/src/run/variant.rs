//! A case, computed in several ways: what the [variants](Variant) of its run change in it.

use super::Run;
use crate::kinds::integrator::Steps;
use crate::problem::Problems;
use crate::reading::Reading;
use flexion::analysis::disturb;
use flexion::analysis::error::{Disturbance, Mesh, Refinable, SAFETY, Variant};
use flexion::analysis::recording::{Record, Watch};
use flexion::analysis::transient::Plan;
use flexion::integrator::Tolerance;
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
        Ok(self.at(variant)?.prepare()?.run(watch))
    }

    fn record(&self, variant: &Variant, watch: &mut Watch<'_>) -> Result<Record, Problems> {
        // Shapes are those of the run itself.
        let changes = [self.changes(variant)?, vec!["output.vtk=false".to_owned()]].concat();
        let mut prepared = self.with(&changes)?.prepare()?;
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
        self.with(&self.changes(variant)?)
    }

    /// What a variant changes in the case. The exact coupling has the elements of the mesh, or elements of its own in place of another
    /// basis.
    fn changes(&self, variant: &Variant) -> Result<Vec<String>, Problems> {
        let (own, plan) = (self.variant(), &variant.plan);
        let mut changes = self.mesh_changes(variant.mesh)?;
        if variant.reference {
            let elements = self.changed(&changes)?.case.hub_beam().and_then(|beam| beam.bases.elements);
            let elements = elements.map_or(ELEMENTS, |(elements, _)| elements);
            changes.push("model.coupling=exact".to_owned());
            changes.push(format!("basis={{kind='finite-elements',elements={elements}}}"));
        }
        if plan.end != own.plan.end {
            // The recording interval that is left out is a part of the duration.
            changes.push(format!("run.duration={:e}", plan.end));
            changes.push(format!("output.step={:e}", plan.sample));
        }
        let mut set = |key: &str, value: Option<f64>, before: Option<f64>| {
            let other = value.filter(|_| value != before);
            changes.extend(other.map(|value| format!("integrator.{key}={value:e}")));
        };
        let Some(Tolerance { relative, absolute }) = variant.tolerance else {
            set("step", plan.step, own.plan.step);
            set("contact-step", plan.contact_step, own.plan.contact_step);
            return Ok(changes);
        };
        match own.tolerance {
            Some(before) => {
                set("tolerance", Some(relative), Some(before.relative));
                set("absolute-tolerance", Some(absolute), Some(before.absolute));
                set("max-step", plan.longest_step, own.plan.longest_step);
            }
            None => changes.push(format!(
                "integrator={{kind='radau',tolerance={relative:e},absolute-tolerance={absolute:e}}}"
            )),
        }
        if plan.break_steps != own.plan.break_steps {
            changes.push(format!("integrator.break-steps={}", plan.break_steps));
        }
        Ok(changes)
    }

    /// The changes that make a mesh.
    pub(super) fn mesh_changes(&self, mesh: Mesh) -> Result<Vec<String>, Problems> {
        let mut changes = Vec::new();
        for _ in 0..mesh.halvings {
            changes = self.changed(&changes)?.case.finer();
        }
        if let Some(factor) = mesh.factor {
            changes.extend(self.changed(&changes)?.case.with_functions(factor));
        }
        Ok(changes)
    }

    fn changed(&self, changes: &[String]) -> Result<Cow<'_, Reading>, Problems> {
        if changes.is_empty() { Ok(Cow::Borrowed(self)) } else { self.with(changes).map(Cow::Owned) }
    }

    /// The case with twice the functions: of the blade, or else of the bases.
    ///
    /// # Errors
    /// [`Problems`] when there are too many.
    pub fn with_finer_mesh(&self) -> Result<Reading, Problems> {
        let changes = match self.case.hub_beam().and_then(|beam| beam.blade.as_ref()) {
            Some(blade) => vec![format!("blade.elements={}", 2 * blade.elements())],
            None => self.case.finer(),
        };
        self.with(&changes)
    }

    /// The mesh and the steps of the case, as changes.
    pub(super) fn mesh_and_steps(&self) -> Vec<String> {
        let now = |change: String| {
            let (key, _) = change.split_once('=')?;
            let (tables, name) = key.rsplit_once('.')?;
            let mut within = &self.values;
            for table in tables.split('.') {
                within = within.inner(table)?;
            }
            Some(format!("{key}={}", within.to_json().get(name)?))
        };
        let mut changes: Vec<String> = self.case.finer().into_iter().filter_map(now).collect();
        changes.extend(match self.case.steps {
            Steps::Fixed { step, .. } => vec![format!("integrator.step={step:e}")],
            Steps::Controlled { tolerance, breaks: 1, .. } => {
                vec![format!("integrator.tolerance={tolerance:e}")]
            }
            Steps::Controlled { tolerance, breaks, .. } => {
                vec![
                    format!("integrator.tolerance={tolerance:e}"),
                    format!("integrator.break-steps={breaks}"),
                ]
            }
        });
        changes
    }
}
