//! Rigid bodies with joints: conformance, closed forms, published and independent solutions.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // in helpers of tests

mod beam_statics;
mod beams;
mod blades;
mod chain;
mod conformance;
mod contacts;
mod crowds;
mod damped;
mod extremes;
mod faults;
mod flexible;
mod free_motions;
mod heavy_top;
mod jumps;
mod mechanisms;
mod mounted;
mod neutral;
mod obstacles;
mod paths;
mod rotating;
mod rotors;
mod single;
mod statics;
mod turns;

use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient};
use flexion::integrator::{Integrator, Radau, Tolerance};
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::rotation::about;
use flexion::multibody::{Body, Multibody};
use flexion::system::{Observed, State, System};

/// Acceleration of gravity [m/s²].
pub const GRAVITY: f64 = 9.81;

/// A number without structure in (−1, 1).
pub fn wave(i: usize, k: f64) -> f64 {
    (1.3 * i as f64 + k).sin()
}

/// A rotation about no special axis.
pub fn odd_rotation(k: f64) -> Mat3 {
    about([1.1 * wave(0, k), 1.9 * wave(1, k), 1.4 * wave(2, k)])
}

/// A body of no symmetry.
pub fn odd_body(name: &str, k: f64) -> Body {
    let mut body = Body::new(name, 1.3 + 0.4 * wave(0, k), [0.0; 3]);
    let a = odd_rotation(k + 1.0);
    let principal = [0.21, 0.34, 0.29];
    for i in 0..3 {
        for j in 0..3 {
            body.inertia[i][j] = (0..3).map(|l| a[i][l] * principal[l] * a[j][l]).sum();
        }
    }
    for i in 0..3 {
        for j in 0..i {
            body.inertia[i][j] = body.inertia[j][i];
        }
    }
    body.centre = Vec3([0.2 * wave(3, k), 0.15 * wave(4, k), -0.1 * wave(5, k)]);
    body.frame.position = Vec3([wave(6, k), wave(7, k), wave(8, k)]);
    body.frame.rotation = odd_rotation(k + 2.0);
    body.velocity = Some(Vec3([wave(9, k), wave(10, k), wave(11, k)]));
    body.spin = Some(Vec3([1.5 * wave(12, k), wave(13, k), 1.2 * wave(14, k)]));
    body
}

/// The value of a channel.
pub fn channel(system: &mut Multibody, s: &State, name: &str) -> f64 {
    let mut values = vec![f64::NAN; system.channels().len()];
    system.record(s, &mut values);
    let at = system.channels().iter().position(|c| c.name == name);
    values[at.unwrap_or_else(|| panic!("no channel {name}"))]
}

pub fn radau(tolerance: f64) -> Radau {
    Radau::new(Tolerance::uniform(tolerance)).unwrap()
}

/// Calls a function at every sample, and keeps the largest imbalance of energy.
pub struct Watch<F> {
    pub each: F,
    pub imbalance: f64,
}

impl<F: FnMut(&mut dyn System, &State)> Observer for Watch<F> {
    fn wants_energy_balance(&self) -> bool {
        true
    }
    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        let imbalance = step.balance.unwrap().imbalance(system.energy(state).total());
        self.imbalance = self.imbalance.max(imbalance.abs());
        (self.each)(system, state);
    }
}

/// A run from the start; gives the end and the largest imbalance of energy.
pub fn run(
    system: &mut Multibody,
    method: &dyn Integrator,
    end: f64,
    step: Option<f64>,
    each: impl FnMut(&mut dyn System, &State),
) -> (State, f64) {
    let mut state = flexion::system::Dynamics::initial(system);
    let mut watch = Watch { each, imbalance: 0.0 };
    let plan =
        Plan { end, step, longest_step: None, break_steps: 1, contact_step: None, sample: end / 100.0 };
    let ending = transient(system, method, &mut state, &plan, &mut watch);
    assert_eq!(ending, Ending::Finished);
    (state, watch.imbalance)
}
