//! The stiffness of a place: forces and couples that hold it, by its displacements and rotations.

use super::VibrationError;
use super::linear::forces_of_load;
use crate::reading::Reading;
use flexion::analysis::equilibrium::stable_equilibrium;
use flexion::analysis::linearization::{Table, linearize};
use std::ops::ControlFlow;

/// The stiffness K of a place, F = K u of small displacements and rotations u about the equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceStiffness {
    /// Names of the components: forces along and couples about the axes of space.
    pub components: &'static [&'static str],
    /// K [N/m, N, N·m].
    pub matrix: Table,
    /// Warnings.
    pub warnings: Vec<String>,
}

/// Components and the loads that are them, in space and in the plane.
const NAMES: [&str; 6] = ["force.x", "force.y", "force.z", "couple.x", "couple.y", "couple.z"];
const LOADS: [&str; 6] = [
    "force = [1, 0, 0]",
    "force = [0, 1, 0]",
    "force = [0, 0, 1]",
    "couple = [1, 0, 0]",
    "couple = [0, 1, 0]",
    "couple = [0, 0, 1]",
];
const NAMES_IN_PLANE: [&str; 3] = ["force.x", "force.y", "couple.z"];
const LOADS_IN_PLANE: [&str; 3] = ["force = [1, 0]", "force = [0, 1]", "couple = 1"];

impl Reading {
    /// The stiffness of a place, `tip`, `beam@2 m` or a body, about the equilibrium of the case at rest under its loads, the hub held: the inverse of
    /// the displacements and rotations by unit forces and couples there, one solution with the tangent each.
    ///
    /// # Errors
    /// [`VibrationError`]: no such place, no equilibrium, a mechanism, or a place that is held.
    pub fn stiffness_at(&self, place: &str) -> Result<PlaceStiffness, VibrationError> {
        let (components, loads): (&'static [&'static str], Vec<&str>) = match self.case.space() {
            None => (&NAMES_IN_PLANE, LOADS_IN_PLANE.to_vec()),
            Some(_) if self.build()?.system.across().is_empty() => (&NAMES, LOADS.to_vec()),
            Some(_) => (&NAMES_IN_PLANE, vec![LOADS[0], LOADS[1], LOADS[5]]),
        };
        let table = |load: &&str| format!("{{on = {}, {load}}}", serde_json::Value::from(place));
        let loads: Vec<String> = loads.iter().map(table).collect();
        let acted_on = |acting: Option<usize>| {
            let silent = loads.iter().enumerate().map(|(i, load)| (load.clone(), acting != Some(i)));
            self.with_loads(&silent.collect::<Vec<_>>())
        };
        let reading = acted_on(None)?;
        let mut system = reading.build()?.system;
        let mut state = system.initial();
        self.at_rest(&state.v, "initial", "its stiffness depends on the speed: `linearize` has it")?;
        system.hold(true);
        let found = stable_equilibrium(system.as_mut(), &mut state, &mut |_| ControlFlow::Continue(()))
            .map_err(VibrationError::not_found)?;
        let motions = linearize(system.as_mut(), &state).map_err(VibrationError::not_found)?;
        let mut forces = Vec::new();
        for i in 0..loads.len() {
            let mut acted = acted_on(Some(i))?.build()?.system;
            acted.hold(true);
            forces.push(motions.force(&forces_of_load([system.as_mut(), acted.as_mut()], &state)));
        }
        let matrix = motions.stiffness_against(&forces).map_err(|error| {
            VibrationError::NotFound(format!("the place `{place}` has no stiffness: {error}"))
        })?;
        let mut warnings: Vec<String> = found
            .stability
            .filter(|found| !found.is_stable())
            .map(|found| format!("the equilibrium is {found}"))
            .into_iter()
            .collect();
        warnings.extend(found.left.map(|left| format!("growing loads alone lead to an equilibrium that is {left}; the stiffness is that about the first stable one on the path of the loads")));
        if self.case.has_contacts() {
            warnings.push("contacts that are closed are held, those that are open stay open".to_owned());
        }
        Ok(PlaceStiffness { components, matrix, warnings })
    }
}
