//! The hub: a rigid body that rotates about a fixed axis, by a prescribed motion or under torques.

use crate::profile::{HubKinematics, Motion, Profile, jumping_derivative};
use crate::system::{Break, Jump};
use std::sync::Arc;

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

/// The drive of the hub.
#[derive(Clone, Debug)]
pub enum Drive {
    /// A prescribed motion θ(t): the torque follows.
    Prescribed(Motion),
    /// Torques: θ is an unknown.
    Free(FreeHub),
}

/// A hub under torques:
///
/// ```text
/// τ = f(t) − c θ̇ − k (θ − θ_k) + sat[ K_p (θ_r(t) − θ) + K_d (θ̇_r(t) − θ̇) ]
/// ```
#[derive(Clone, Debug)]
pub struct FreeHub {
    /// Angle at the start \[rad\].
    pub angle: f64,
    /// Speed at the start [rad/s].
    pub speed: f64,
    /// Torque f(t) [N·m].
    pub torque: Arc<dyn Profile>,
    /// Viscous restraint c [N·m·s/rad].
    pub damping: f64,
    /// Spring restraint k [N·m/rad].
    pub stiffness: f64,
    /// Angle θ_k at which the spring is at rest \[rad\].
    pub rest_angle: f64,
    /// Controller of the angle.
    pub controller: Option<Controller>,
}

/// Proportional–derivative control of the hub's angle.
#[derive(Clone, Debug)]
pub struct Controller {
    /// Gain K_p [N·m/rad].
    pub proportional: f64,
    /// Gain K_d [N·m·s/rad].
    pub derivative: f64,
    /// Reference motion θ_r(t).
    pub reference: Motion,
    /// Largest torque the actuator gives [N·m]; infinite without a limit.
    pub limit: f64,
}

/// A torque with its derivatives by θ and θ̇.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Torque {
    /// τ [N·m]
    pub value: f64,
    /// ∂τ/∂θ [N·m/rad]
    pub by_angle: f64,
    /// ∂τ/∂θ̇ [N·m·s/rad]
    pub by_speed: f64,
}

impl Hub {
    /// A hub that moves as prescribed.
    pub fn prescribed(radius: f64, inertia: f64, motion: Motion) -> Hub {
        Hub { radius, inertia, drive: Drive::Prescribed(motion) }
    }

    /// Number of unknowns of the hub.
    pub fn unknowns(&self) -> usize {
        usize::from(matches!(self.drive, Drive::Free(_)))
    }
}

impl Controller {
    fn torque(&self, hub: &HubKinematics, t: f64) -> Torque {
        let reference = self.reference.at(t);
        let asked = self.proportional * (reference.angle - hub.angle)
            + self.derivative * (reference.speed - hub.speed);
        if asked.abs() > self.limit {
            return Torque { value: self.limit.copysign(asked), ..Torque::default() };
        }
        Torque { value: asked, by_angle: -self.proportional, by_speed: -self.derivative }
    }
}

impl FreeHub {
    /// The torque on the hub at time `t` \[s\].
    pub fn torque(&self, hub: &HubKinematics, t: f64) -> Torque {
        let controlled = self.controller.as_ref().map_or(Torque::default(), |c| c.torque(hub, t));
        Torque {
            value: self.torque.value(t)
                - self.damping * hub.speed
                - self.stiffness * (hub.angle - self.rest_angle)
                + controlled.value,
            by_angle: controlled.by_angle - self.stiffness,
            by_speed: controlled.by_speed - self.damping,
        }
    }

    /// What motor and controller give of [`FreeHub::torque`] [N·m]: all but spring and damper.
    pub fn driving_torque(&self, hub: &HubKinematics, t: f64) -> f64 {
        self.torque.value(t) + self.controller.as_ref().map_or(0.0, |c| c.torque(hub, t).value)
    }

    /// Energy of the spring \[J\].
    pub fn spring_energy(&self, angle: f64) -> f64 {
        0.5 * self.stiffness * (angle - self.rest_angle).powi(2)
    }

    /// Times at which torque or reference are not smooth.
    pub fn breaks(&self) -> Vec<Break> {
        let torque = self
            .torque
            .breaks()
            .iter()
            .map(|&time| Break { time, jump: force_jump(jumping_derivative(self.torque.as_ref(), time)) });
        let reference = self.controller.iter().flat_map(|controller| {
            let reference = &controller.reference;
            reference
                .breaks()
                .iter()
                .map(|&time| Break { time, jump: force_jump(reference.jumping_derivative(time)) })
        });
        torque.chain(reference).collect()
    }
}

/// What jumps in the motion where the derivative `k` of a force jumps.
pub(super) fn force_jump(k: usize) -> Jump {
    [Jump::Acceleration, Jump::Slope, Jump::Curvature][k.min(2)]
}
