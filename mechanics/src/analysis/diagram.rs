//! What a Campbell diagram is asked for, and what it holds.

use super::mesh_error;
use super::modes::{Mode, NoModes};
use super::rotation::NoRotation;

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Speeds [rad/s], ascending.
    pub speeds: Vec<f64>,
    /// Number of modes, the lowest at the first speed.
    pub count: usize,
    /// Stations of the shapes \[m\].
    pub stations: Vec<f64>,
    /// Whether the hub keeps its speed, or is free to rotate about it.
    pub hub: HubState,
    /// Lines ω = k Ω whose crossings are looked for, from 1 to this k.
    pub revolutions: u32,
}

/// What the hub does while the beam vibrates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HubState {
    /// It keeps its speed: modes of the beam on a hub of infinite inertia.
    Held,
    /// It rotates with the beam, under its torques.
    Free,
}

/// A mode at a speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Speed [rad/s].
    pub speed: f64,
    /// The mode.
    pub mode: Mode,
    /// Its place among the modes at this speed, ascending in |λ|, from 0.
    pub number: usize,
    /// Assurance against the mode at the speed before, with gyroscopic forces in their inner product; 1 at the first.
    pub assurance: f64,
}

/// One mode over the speeds; it ends where it leaves the modes computed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Branch {
    /// The mode at each speed of the diagram.
    pub points: Vec<Point>,
}

/// A crossing of a branch with a line ω = k Ω: resonance with an excitation k times a revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Number of the branch, from 0.
    pub branch: usize,
    /// k
    pub revolutions: u32,
    /// Speed Ω [rad/s].
    pub speed: f64,
}

/// A speed at which the stiffness is singular in the rotating frame: there is a shape that rotates with the frame, forward, once a
/// revolution, with no restoring force. Unbalance is in resonance with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Critical {
    /// Speed Ω [rad/s], to six digits.
    pub speed: f64,
    /// Number of directions whose stiffness changes its sign: two of a round shaft in round bearings, one of others.
    pub directions: usize,
}

/// Where motions grow.
#[derive(Clone, Debug, PartialEq)]
pub enum Instability {
    /// The damping of a branch becomes negative between the two speeds [rad/s].
    Flutter {
        /// Number of the branch, from 0.
        branch: usize,
        /// Last stable speed.
        from: f64,
        /// First unstable speed.
        to: f64,
        /// First speed at which it decays again, unless it grows to the end of the branch.
        until: Option<f64>,
    },
    /// Motions leave the steady rotation without vibrating.
    Divergence {
        /// The speed at which that begins [rad/s], to six digits; the first one if there is no stable one below.
        speed: f64,
        /// The speed at which it ends, unless it lasts to the end of the diagram.
        until: Option<f64>,
    },
    /// No steady rotation, or no modes, were found beyond a speed.
    Lost {
        /// Speed that was reached [rad/s].
        speed: f64,
        /// The message.
        reason: String,
    },
}

/// A Campbell diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Campbell {
    /// Speeds [rad/s]: those asked for, and those inserted.
    pub speeds: Vec<f64>,
    /// The modes, ascending in their frequency at the first speed.
    pub branches: Vec<Branch>,
    /// Crossings with the lines of whole revolutions.
    pub crossings: Vec<Crossing>,
    /// Critical speeds of forward whirl, ascending.
    pub criticals: Vec<Critical>,
    /// Instabilities.
    pub instabilities: Vec<Instability>,
    /// Why frequencies have no errors by the mesh from some speed on, where modes of a finer mesh were not found.
    pub unestimated: Option<NoCampbell>,
}

impl Campbell {
    /// Notes the modes that a finer mesh has at each of the speeds, ascending, as far as there are any: the [differences](mesh_error) of their
    /// frequencies times `safety` estimate the errors by the mesh.
    pub fn compare<'a>(&mut self, finer: impl Iterator<Item = &'a [Mode]>, safety: f64) {
        for (number, finer) in finer.enumerate() {
            let points = self.branches.iter_mut().filter_map(|branch| branch.points.get_mut(number));
            mesh_error::compare(points.map(|point| &mut point.mode), finer, safety);
        }
    }

    /// The largest estimated error of a frequency by the mesh, over the frequency or the speed, whichever is larger: number of its branch,
    /// its point, and the relative error. A whirl has almost no frequency in the rotating frame near its critical speed, and that of the
    /// rotation seen from the ground.
    pub fn coarsest(&self) -> Option<(usize, &Point, f64)> {
        let points = self.branches.iter().enumerate().flat_map(|(k, b)| b.points.iter().map(move |p| (k, p)));
        let vibrating = points.filter(|(_, p)| p.mode.frequency() > 0.0);
        let relative = |p: &Point| Some(p.mode.mesh? / p.mode.frequency().max(p.speed.abs()));
        let errors = vibrating.filter_map(|(k, p)| Some((k, p, relative(p)?)));
        errors.max_by(|a, b| a.2.total_cmp(&b.2))
    }
}

/// Why there is no diagram.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoCampbell {
    /// The speeds make no axis.
    #[error("a Campbell diagram needs at least two ascending speeds of at least zero")]
    Speeds,
    /// There is no steady rotation at the first speed, or the system does not rotate.
    #[error(transparent)]
    Rotation(#[from] NoRotation),
    /// The modes at a speed.
    #[error("at {speed} rad/s: {source}")]
    Modes {
        /// The speed [rad/s].
        speed: f64,
        /// Why.
        source: NoModes,
    },
    /// It was stopped.
    #[error("stopped before the last speed")]
    Stopped,
}
