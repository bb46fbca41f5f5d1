//! Small motions of a case about its equilibrium, with named inputs and outputs, for control.

use super::VibrationError;
use crate::problem::Problems;
use crate::reading::Reading;
use flexion::analysis::campbell::HubState;
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::linearization::{Linearization, Outputs, Table, linearize};
use flexion::analysis::rotation::rotate_stably;
use flexion::system::{Fork, Parameter, State, System};
use flexion_results::nearest;

/// Part of the largest entry of the forces below which an input does not act.
const ACTS: f64 = 1e-12;

/// Name of the input that is the torque of a free hub.
const HUB: &str = "hub.torque";

/// What is asked of the equations of small motions.
#[derive(Clone, Debug, Default)]
pub struct LinearRequest {
    /// Speed of rotation \[rad/s\], zero or positive.
    pub speed: f64,
    /// Whether the hub is free to rotate with the beam under its torques; otherwise it keeps its speed.
    pub free_hub: bool,
    /// Names of the inputs, and of each the load that it is the amplitude of, as a table of TOML: `{on = "tip", force = [0, 1], axes = "hub"}`.
    /// The input `hub.torque` of a free hub needs none.
    pub inputs: Vec<(String, Option<String>)>,
    /// Columns that are the outputs.
    pub outputs: Vec<String>,
}

/// The equations of small motions, M ẍ + (D + G) ẋ + K x = B u, y = P x + V ẋ + A ẍ.
#[derive(Clone, Debug)]
pub struct Linear {
    /// The coordinates x and the matrices M, D, G, K, J, Z.
    pub motions: Linearization,
    /// B, a column for each input.
    pub input: Table,
    /// P, V and A.
    pub outputs: Outputs,
    /// Units of the outputs.
    pub units: Vec<String>,
    /// Values of the outputs at the equilibrium.
    pub at: Vec<f64>,
    /// Warnings.
    pub warnings: Vec<String>,
}

/// The forces of a load on the velocities at a state: r of the system without it, less r of the same system with it.
pub(super) fn forces_of_load([without, with]: [&mut dyn System; 2], state: &State) -> Vec<f64> {
    let residual = |system: &mut dyn System| {
        let mut r = vec![0.0; state.v.len()];
        system.residual(state, &mut r);
        r
    };
    let (without, with) = (residual(without), residual(with));
    without.iter().zip(&with).map(|(a, b)| a - b).collect()
}

impl Reading {
    /// The equations of small motions about the equilibrium of the case, at rest or in steady rotation, which replaces its motion. An input
    /// is the amplitude of a load.
    ///
    /// # Errors
    /// [`VibrationError`]: as for [modes](Reading::modes); an input that does not act, an output that is no function of the motion.
    pub fn linearize(&self, request: &LinearRequest) -> Result<Linear, VibrationError> {
        self.fits_modes()?;
        let speed = request.speed;
        if !(speed.is_finite() && speed >= 0.0) {
            return Err(VibrationError::Request(format!(
                "the speed is {speed} rad/s and must be zero or positive"
            )));
        }
        let free = self.case.hub_state(request.free_hub)? == HubState::Free;
        // All loads of amplitude zero, so that places that cut elements are the same for all.
        let (mut system, warnings) = self.acted_on(request, None)?.case.vibrates(speed > 0.0)?;
        let mut state = State::zeros(system.size(), 0.0);
        if self.case.space().is_some() {
            state = system.initial();
        }
        if self.case.space().is_some() && speed == 0.0 {
            equilibrium(system.as_mut(), &mut state).map_err(VibrationError::not_found)?;
        } else {
            rotate_stably(system.as_mut(), &mut state, 0.0, speed).map_err(VibrationError::not_found)?;
        }
        if free {
            system.hold(false);
            state.v = system.initial().v;
        }
        let motions = linearize(system.as_mut(), &state).map_err(VibrationError::not_found)?;
        let mut columns = Vec::new();
        for (number, (name, load)) in request.inputs.iter().enumerate() {
            let forces = match load {
                None => self.of_hub(system.as_ref(), name, free)?,
                Some(_) => {
                    let (mut acted, _) = self.acted_on(request, Some(number))?.case.vibrates(speed > 0.0)?;
                    acted.set(Parameter::Speed, speed).map_err(VibrationError::not_found)?;
                    acted.hold(!free);
                    forces_of_load([system.as_mut(), acted.as_mut()], &state)
                }
            };
            let column = motions.force(&forces);
            let largest = column.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            if !(largest > ACTS) {
                return Err(VibrationError::Request(format!(
                    "the input `{name}` does not act on small motions: it pushes what is held, or it has a direction fixed in space and \
                     is periodic as seen from a hub that rotates; give it the axes `hub` or `follower`"
                )));
            }
            columns.push(column);
        }
        let input = Table::from_fn(motions.order(), columns.len(), |i, j| columns[j][i]);
        let channels = system.channels();
        let mut chosen = Vec::new();
        for name in &request.outputs {
            let found = channels.iter().position(|channel| channel.name == *name);
            chosen.push(found.ok_or_else(|| {
                let near = nearest(name, channels.iter().map(|channel| channel.name.as_str()));
                let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
                VibrationError::Request(format!("the case has no column `{name}`{near}; those of a run alone, as `energy.total`, are no functions of the \
                     motion"))
            })?);
        }
        let outputs = motions.outputs(system.as_mut(), &state, &chosen).map_err(|dependent| {
            let names: Vec<&str> = dependent.iter().map(|i| channels[*i].name.as_str()).collect();
            VibrationError::Request(format!("reactions are no functions of the motion: {}", names.join(", ")))
        })?;
        let mut row = vec![0.0; channels.len()];
        system.record(&state, &mut row);
        let at = chosen.iter().map(|i| row[*i]).collect();
        let units = chosen.iter().map(|i| channels[*i].unit.to_string()).collect();
        Ok(Linear { motions, input, outputs, units, at, warnings })
    }

    /// The unit torque on a free hub.
    fn of_hub(&self, system: &dyn Fork, name: &str, free: bool) -> Result<Vec<f64>, VibrationError> {
        let hub = system.size().v.checked_sub(1).filter(|_| free && self.case.hub_beam().is_some());
        match hub {
            Some(hub) if name == HUB => Ok((0..=hub).map(|i| f64::from(u8::from(i == hub))).collect()),
            None if name == HUB && self.case.hub_beam().is_some() => Err(VibrationError::Request(format!(
                "the input `{name}` needs a free hub, and the hub keeps its speed: ask for one that is free (`free_hub=True` in Python)"
            ))),
            _ => Err(VibrationError::Request(format!(
                "the input `{name}` needs a load, `{{on = \"tip\", force = [0, 1], axes = \"hub\"}}`; `{HUB}` is that of a beam on a free \
                 hub alone"
            ))),
        }
    }

    /// The case with the loads that are inputs, all of amplitude zero but one.
    fn acted_on(&self, request: &LinearRequest, acting: Option<usize>) -> Result<Reading, Problems> {
        let loads = request.inputs.iter().enumerate().filter_map(|(i, (_, load))| Some((i, load.as_ref()?)));
        let silent = |(i, load): (usize, &String)| (load.clone(), acting != Some(i));
        self.with_loads(&loads.map(silent).collect::<Vec<_>>())
    }
}
