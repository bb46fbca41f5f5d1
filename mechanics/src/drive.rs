//! What drives an axis, of a hub or of a joint: a motor, a spring, a damper, a controller.

use crate::profile::{HubKinematics, Motion, Profile, jumping_derivative};
use crate::system::{Break, Jump, ordered};
use std::sync::Arc;

/// The torque about an axis at the angle θ, or the force along it at the displacement θ:
///
/// ```text
/// τ = f(t) − c θ̇ − k (θ − θ_k) + sat[ K_p (θ_r(t) − θ) + K_d (θ̇_r(t) − θ̇) ]
/// ```
#[derive(Clone, Debug)]
pub struct Actuator {
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

/// Proportional–derivative control of the angle.
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

impl Actuator {
    /// The torque at time `t` \[s\].
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

    /// What motor and controller give of [`Actuator::torque`] [N·m]: all but spring and damper.
    pub fn driving_torque(&self, hub: &HubKinematics, t: f64) -> f64 {
        self.torque.value(t) + self.controller.as_ref().map_or(0.0, |c| c.torque(hub, t).value)
    }

    /// Energy of the spring \[J\].
    pub fn spring_energy(&self, angle: f64) -> f64 {
        0.5 * self.stiffness * (angle - self.rest_angle).powi(2)
    }

    /// Times at which torque or reference are not smooth.
    pub fn breaks(&self) -> Vec<Break> {
        let mut breaks = force_breaks(self.torque.as_ref());
        if let Some(Controller { reference, .. }) = &self.controller {
            let jump = |time| force_jump(reference.jumping_derivative(time));
            breaks.extend(times(reference.breaks(), reference.resolution(), jump));
        }
        breaks
    }
}

/// The breaks of a force that changes like `profile`.
pub fn force_breaks(profile: &dyn Profile) -> Vec<Break> {
    let jump = |time| force_jump(jumping_derivative(profile, time));
    times(profile.breaks(), profile.resolution(), jump)
}

/// Breaks with what jumps there, and the times of a resolution.
fn times(breaks: &[f64], resolution: &[f64], jump: impl Fn(f64) -> Jump) -> Vec<Break> {
    let smooth = resolution.iter().map(|&time| Break { time, jump: Jump::Nothing });
    breaks.iter().map(|&time| Break { time, jump: jump(time) }).chain(smooth).collect()
}

/// What jumps in the motion where the derivative `k` of a force jumps.
fn force_jump(k: usize) -> Jump {
    [Jump::Acceleration, Jump::Slope, Jump::Curvature][k.min(2)]
}

/// The breaks of a prescribed motion: a speed that jumps is an impulse.
pub fn motion_breaks(motion: &Motion) -> Vec<Break> {
    let kinds = [Jump::Velocity, Jump::Acceleration, Jump::Slope, Jump::Curvature];
    let jump = |time| kinds[motion.jumping_derivative(time).min(3)];
    ordered(times(motion.breaks(), motion.resolution(), jump))
}
