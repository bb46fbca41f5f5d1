//! The state at the start of a run.

use super::declaration::{Bound::*, Kind, Presence as Default, Presence::*, Seam, Type, key};
use super::problem::{Problem, Problems};
use super::restart;
use super::units::{LENGTH, VELOCITY};
use super::values::Values;
use flexion::analysis::superposition::Vibration;
use std::path::{Path, PathBuf};

/// The state at t = 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Initial {
    /// Undeformed, moving with the hub.
    Undeformed,
    /// In the equilibrium of steady rotation at the initial speed of the hub.
    SteadyRotation,
    /// In static equilibrium under the loads at t = 0, the hub held.
    Static,
    /// The last state of an earlier run of the same model, whose time goes on.
    Restart {
        /// `state.npz` of that run.
        file: PathBuf,
    },
    /// Vibrating in modes about the equilibrium of the start.
    Modes {
        /// What each mode does, in the order of their frequencies: displacement \[m\] and velocity \[m/s\] of the tip.
        vibrations: Vec<Vibration>,
    },
}

pub(super) static SEAM: Seam = Seam {
    name: "initial",
    path: "initial",
    summary: "state at the start",
    kinds: &[
        Kind { name: "undeformed", summary: "undeformed, moving with the hub", source: "", keys: &[] },
        Kind {
            name: "steady-rotation",
            summary: "equilibrium of steady rotation at the initial speed of the hub",
            source: "",
            keys: &[],
        },
        Kind {
            name: "static",
            summary: "static equilibrium under the loads of the start, the hub at rest and held",
            source: "",
            keys: &[],
        },
        Kind {
            name: "restart",
            summary: "last state of an earlier run of the same model, whose time goes on",
            source: "",
            keys: &[key(
                "file",
                Type::Path,
                Required,
                "state.npz of the earlier run, or the folder of its results",
            )],
        },
        Kind {
            name: "modes",
            summary: "vibrating in given modes about the equilibrium of the start",
            source: "",
            keys: &[
                key(
                    "amplitudes",
                    Type::Quantities(&LENGTH, Any),
                    Default::Empty,
                    "displacement of the tip in each mode, the lowest mode first",
                ),
                key(
                    "velocities",
                    Type::Quantities(&VELOCITY, Any),
                    Default::Empty,
                    "velocity of the tip in each mode, the lowest mode first",
                ),
            ],
        },
    ],
};

/// The initial state of a case; paths are relative to `folder`.
pub(super) fn read(kind: &Kind, values: &Values, folder: &Path, problems: &mut Problems) -> Option<Initial> {
    Some(match kind.name {
        "steady-rotation" => Initial::SteadyRotation,
        "static" => Initial::Static,
        "restart" => Initial::Restart { file: restart::state_file(&folder.join(values.text("file")?)) },
        "modes" => Initial::Modes { vibrations: vibrations(values, problems)? },
        _ => Initial::Undeformed,
    })
}

/// The vibrations of the initial state `modes`; a list that is left out is one of zeros.
fn vibrations(values: &Values, problems: &mut Problems) -> Option<Vec<Vibration>> {
    let (amplitudes, velocities) = (values.numbers("amplitudes")?, values.numbers("velocities")?);
    let mut refuse = |key: &str, message: String| {
        problems.push(Problem::new(format!("initial.{key}"), values.place(key), message));
    };
    match (amplitudes.len(), velocities.len()) {
        (0, 0) => {
            let message = "no mode is given an amplitude or a velocity; write `amplitudes`, `velocities` or both, one \
                           number for each mode";
            refuse("amplitudes", message.to_owned());
        }
        (a, v) if a > 0 && v > 0 && a != v => {
            refuse(
                "velocities",
                format!(
                    "the numbers of velocities and amplitudes are {v} and {a}; give each mode both, 0 where it has none"
                ),
            );
        }
        _ => {}
    }
    let at = |list: &[f64], mode: usize| list.get(mode).copied().unwrap_or(0.0);
    let count = amplitudes.len().max(velocities.len());
    Some(
        (0..count)
            .map(|mode| Vibration { displacement: at(amplitudes, mode), velocity: at(velocities, mode) })
            .collect(),
    )
}
