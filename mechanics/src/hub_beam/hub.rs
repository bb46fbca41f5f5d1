//! The hub: a rigid body that rotates about a fixed axis, by a prescribed motion or under torques.

use crate::drive::Actuator;
use crate::profile::{HubKinematics, Motion};

/// The hub.
#[derive(Clone, Debug)]
pub struct Hub {
    /// Radius a at which the beam is clamped \[m\].
    pub radius: f64,
    /// Moment of inertia about the axis [kg·m²].
    pub inertia: f64,
    /// Its drive.
    pub drive: Drive,
}

/// The motion of the hub at recent times: a step evaluates it repeatedly at a few times.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recent {
    entries: [(f64, HubKinematics); 4],
    oldest: usize,
}

impl Recent {
    /// Nothing yet.
    pub(super) fn new() -> Recent {
        Recent { entries: [(f64::NAN, HubKinematics::default()); 4], oldest: 0 }
    }

    /// `motion` at time `t`, stored or computed.
    #[inline]
    pub(super) fn at(&mut self, motion: &Motion, t: f64) -> HubKinematics {
        if let Some((_, hub)) = self.entries.iter().find(|(time, _)| *time == t) {
            return *hub;
        }
        let hub = motion.at(t);
        self.entries[self.oldest] = (t, hub);
        self.oldest = (self.oldest + 1) % self.entries.len();
        hub
    }
}

/// The absolute acceleration p̈ + 2ωJṗ + ω̇Jp − ω²p of a point at p in the frame of the hub.
#[inline(always)]
pub(super) fn absolute(p: [f64; 2], v: [f64; 2], a: [f64; 2], hub: &HubKinematics) -> [f64; 2] {
    let (w, w1) = (hub.speed, hub.acceleration);
    [a[0] - 2.0 * w * v[1] - w1 * p[1] - w * w * p[0], a[1] + 2.0 * w * v[0] + w1 * p[0] - w * w * p[1]]
}

/// The drive of the hub.
#[derive(Clone, Debug)]
pub enum Drive {
    /// A prescribed motion θ(t): the torque follows.
    Prescribed(Motion),
    /// Torques: θ is an unknown.
    Free(FreeHub),
}

/// A hub under the torques of an actuator.
#[derive(Clone, Debug)]
pub struct FreeHub {
    /// Angle at the start \[rad\].
    pub angle: f64,
    /// Speed at the start [rad/s].
    pub speed: f64,
    /// What turns it.
    pub actuator: Actuator,
}

impl Hub {
    /// A hub that moves as prescribed.
    pub fn prescribed(radius: f64, inertia: f64, motion: Motion) -> Hub {
        Hub { radius, inertia, drive: Drive::Prescribed(motion) }
    }

    /// Its speed at t = 0 [rad/s].
    pub fn speed_at_start(&self) -> f64 {
        match &self.drive {
            Drive::Prescribed(motion) => motion.at(0.0).speed,
            Drive::Free(free) => free.speed,
        }
    }

    /// The angle that its controller wants at time `t` \[s\], if it has one \[rad\].
    pub(super) fn target(&self, t: f64) -> Option<f64> {
        let Drive::Free(free) = &self.drive else { return None };
        free.actuator.controller.as_ref().map(|controller| controller.reference.at(t).angle)
    }

    /// Number of unknowns of the hub.
    pub fn unknowns(&self) -> usize {
        usize::from(matches!(self.drive, Drive::Free(_)))
    }
}
