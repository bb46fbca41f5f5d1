//! The state at the start of a run: kinds, keys and makers.

use crate::declaration::Bound::*;
use crate::fault::{Fault, Made};
use crate::keys::{keys, path, quantities};
use crate::kind::{Choice, Context, Is, Kind, Of};
use crate::units::{LENGTH, VELOCITY};
use flexion::analysis::superposition::Vibration;
use flexion::integrator::Checkpoint;
use flexion_results::read_state;
use std::io::Cursor;
use std::sync::Arc;

/// The state at t = 0.
#[derive(Clone, Debug)]
pub enum Initial {
    /// Undeformed, moving with the hub.
    Undeformed,
    /// In steady rotation at the initial speed of the hub: in equilibrium, or in periodic motion under loads that keep their direction in space.
    SteadyRotation,
    /// In static equilibrium under the loads at t = 0, the hub held.
    Static,
    /// The last state of an earlier run of the same model, whose time goes on.
    Restart(Arc<Earlier>),
    /// Vibrating in modes about the equilibrium of the start: what each mode does, in the order of their frequencies, as
    /// displacement \[m\] and velocity \[m/s\] of the tip.
    Modes(Vec<Vibration>),
}

/// The state in which an earlier run ended.
#[derive(Debug)]
pub struct Earlier {
    /// The state, with the history of the integrator.
    pub checkpoint: Checkpoint,
    /// What the state belongs to: a line `key = value` for all that makes model and integrator.
    pub identity: String,
}

keys! {
    struct Restart {
        /// state.npz of the earlier run, or the folder of its results
        file: String = path();
    }

    struct InModes {
        /// displacement of the tip in each mode, the lowest mode first
        amplitudes: Vec<f64> = quantities(&LENGTH, Any).or_empty();
        /// velocity of the tip in each mode, the lowest mode first
        velocities: Vec<f64> = quantities(&VELOCITY, Any).or_empty();
    }
}

/// The kinds of initial state.
pub static INITIAL: Choice<Initial> = Choice {
    name: "initial",
    path: "initial",
    summary: "state at the start",
    kinds: &[
        Kind {
            name: "undeformed",
            summary: "undeformed, moving with the hub",
            source: "",
            example: "initial.kind=undeformed",
            make: &Is(Initial::Undeformed),
        },
        Kind {
            name: "steady-rotation",
            summary: "steady rotation at the initial speed of the hub, or of all parts about one axis: in equilibrium, and under gravity across the axis in the motion that repeats itself",
            source: "",
            example: "initial.kind=steady-rotation\nhub.motion={kind='constant', speed='4 rad/s'}",
            make: &Is(Initial::SteadyRotation),
        },
        Kind {
            name: "static",
            summary: "static equilibrium under the loads of the start, the hub at rest and held",
            source: "",
            example: "initial.kind=static\ngravity=[0, -9.81]",
            make: &Is(Initial::Static),
        },
        Kind {
            name: "restart",
            summary: "last state of an earlier run of the same model, whose time goes on",
            source: "",
            example: "initial={kind='restart', file='state.npz'}",
            make: &Of(restart),
        },
        Kind {
            name: "modes",
            summary: "vibrating in given modes about the equilibrium of the start",
            source: "",
            example: "initial={kind='modes', amplitudes=['1 mm', 0], velocities=[0, '3 mm/s']}",
            make: &Of(modes),
        },
    ],
};

fn restart(Restart { file: name }: Restart, c: &Context<'_>) -> Made<Initial> {
    let refuse = |message: String| Fault::new("file", message);
    let bytes = c.files.bytes(&name).map_err(|reason| {
        refuse(format!("{reason}; a path begins at the folder of the case, unless it is absolute"))
    })?;
    let (checkpoint, identity) = read_state(Cursor::new(&*bytes))
        .map_err(|reason| refuse(format!("{name} is not the state of a run: {reason}")))?;
    checkpoint.check_format().map_err(|error| refuse(format!("{name}: {error}")))?;
    Ok(Initial::Restart(Arc::new(Earlier { checkpoint, identity })))
}

/// A list that is left out is one of zeros.
fn modes(InModes { amplitudes, velocities }: InModes, _: &Context<'_>) -> Made<Initial> {
    match (amplitudes.len(), velocities.len()) {
        (0, 0) => {
            let message = "no mode is given an amplitude or a velocity; write `amplitudes`, `velocities` or both, one \
                           number for each mode";
            return Err(Fault::new("amplitudes", message).into());
        }
        (a, v) if a > 0 && v > 0 && a != v => {
            let message = format!(
                "the numbers of velocities and amplitudes are {v} and {a}; give each mode both, 0 where it has none"
            );
            return Err(Fault::new("velocities", message).into());
        }
        _ => {}
    }
    let at = |list: &[f64], mode: usize| list.get(mode).copied().unwrap_or(0.0);
    let vibration = |mode| Vibration { displacement: at(&amplitudes, mode), velocity: at(&velocities, mode) };
    Ok(Initial::Modes((0..amplitudes.len().max(velocities.len())).map(vibration).collect()))
}
