//! Prescribed motion of the hub: its angle, speed and acceleration from one profile.

use super::{Profile, ProfileError, covers, jumping_derivative};
use std::sync::Arc;

/// Angle, speed and acceleration of the hub at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HubKinematics {
    /// Angle θ \[rad\].
    pub angle: f64,
    /// Speed θ̇ [rad/s].
    pub speed: f64,
    /// Acceleration θ̈ [rad/s²].
    pub acceleration: f64,
}

/// How the motion of the hub is prescribed.
#[derive(Clone, Debug)]
pub enum Motion {
    /// The speed: θ = θ₀ + ∫ f, θ̇ = f, θ̈ = f′.
    Speed {
        /// Speed f [rad/s] against time.
        profile: Arc<dyn Profile>,
        /// Angle θ₀ at t = 0 \[rad\].
        initial_angle: f64,
    },
    /// The angle: θ = f, θ̇ = f′, θ̈ = f″.
    Angle(Arc<dyn Profile>),
}

impl Motion {
    /// Angle, speed and acceleration at time `t` \[s\].
    pub fn at(&self, t: f64) -> HubKinematics {
        match self {
            Motion::Speed { profile, initial_angle } => HubKinematics {
                angle: initial_angle + profile.integral(t),
                speed: profile.value(t),
                acceleration: profile.rate(t),
            },
            Motion::Angle(profile) => HubKinematics {
                angle: profile.value(t),
                speed: profile.rate(t),
                acceleration: profile.acceleration(t),
            },
        }
    }

    /// Times at which the motion loses smoothness, ascending \[s\].
    pub fn breaks(&self) -> &[f64] {
        self.profile().breaks()
    }

    /// Largest |θ̇| [rad/s] from 0 to `duration` \[s\], among 4096 equal intervals, the breaks and the times of the resolution.
    pub fn max_speed(&self, duration: f64) -> f64 {
        let speed = |t: f64| self.at(t).speed.abs();
        let samples = self.samples(duration).chain(self.seen(duration)).map(speed);
        // On both sides of a break, where the speed may jump.
        let sides = self.breaks().iter().filter(|t| (0.0..=duration).contains(*t));
        let breaks = sides.flat_map(|t| [t.next_down().max(0.0), *t]).map(speed);
        samples.chain(breaks).fold(0.0, f64::max)
    }

    /// Whether the motion is given, and finite, all through a run from 0 to `duration` \[s\].
    ///
    /// # Errors
    /// [`ProfileError::OutOfRange`], [`ProfileError::Motion`] with what is not finite and when, or
    /// [`ProfileError::AngleJumps`].
    pub fn validate(&self, duration: f64) -> Result<(), ProfileError> {
        covers(self.profile().as_ref(), duration)?;
        if let Motion::Angle(profile) = self {
            for &time in profile.breaks().iter().filter(|t| (0.0..=duration).contains(*t)) {
                if jumping_derivative(profile.as_ref(), time) == 0 {
                    let size = profile.value(time) - profile.value(time.next_down());
                    return Err(ProfileError::AngleJumps { time, size });
                }
            }
        }
        for t in self.samples(duration).chain(self.seen(duration)) {
            let hub = self.at(t);
            for (quantity, value) in [
                ("prescribed angle of the hub [rad]", hub.angle),
                ("prescribed speed of the hub [rad/s]", hub.speed),
                ("prescribed acceleration of the hub [rad/s²]", hub.acceleration),
            ] {
                if !value.is_finite() {
                    return Err(ProfileError::Motion { quantity, value, time: t });
                }
            }
        }
        Ok(())
    }

    /// The lowest derivative of the speed that jumps at a break at time `t` \[s\].
    pub fn jumping_derivative(&self, t: f64) -> usize {
        match self {
            Motion::Speed { profile, .. } => jumping_derivative(profile.as_ref(), t),
            Motion::Angle(profile) => jumping_derivative(profile.as_ref(), t).saturating_sub(1),
        }
    }

    /// The first time \[s\] up to `until` at which the hub is faster than `speed` [rad/s], found on a grid of 1000 intervals and
    /// then by bisection; `until` if there is none.
    pub fn first_time_above(&self, speed: f64, until: f64) -> f64 {
        let above = |t: f64| self.at(t).speed.abs() > speed;
        let grid = 1000;
        let at = |i: usize| until * i as f64 / grid as f64;
        let hit = (0..=grid).find(|&i| above(at(i))).unwrap_or(grid);
        let (mut low, mut high) = (at(hit.saturating_sub(1)), at(hit));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if above(middle) { high = middle } else { low = middle }
        }
        high
    }

    /// Times at which steps should end to see the motion, ascending \[s\].
    pub fn resolution(&self) -> &[f64] {
        self.profile().resolution()
    }

    fn seen(&self, duration: f64) -> impl Iterator<Item = f64> {
        self.resolution().iter().copied().filter(move |t| *t <= duration)
    }

    fn profile(&self) -> &Arc<dyn Profile> {
        match self {
            Motion::Speed { profile, .. } | Motion::Angle(profile) => profile,
        }
    }

    fn samples(&self, duration: f64) -> impl Iterator<Item = f64> {
        let parts = self.profile().parts();
        (0..=parts).map(move |k| duration * (k as f64 / parts as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Expression, SpinUp};
    use super::*;

    #[test]
    fn prescribing_the_speed_or_its_integral_as_angle_is_the_same_motion() {
        let speed = Motion::Speed { profile: Arc::new(SpinUp::new(4.0, 15.0).unwrap()), initial_angle: 0.25 };
        let text = "0.25 + 2/15*t^2 + 4*15/(4*pi^2)*(cos(2*pi*t/15) - 1)";
        let angle = Motion::Angle(Arc::new(Expression::new(text, "t", 15.0).unwrap()));
        for k in 0..=15 {
            let (a, b) = (speed.at(k as f64), angle.at(k as f64));
            for (a, b) in [(a.angle, b.angle), (a.speed, b.speed), (a.acceleration, b.acceleration)] {
                assert!((a - b).abs() < 1e-13, "{a} {b}");
            }
        }
    }

    #[test]
    fn largest_speed_is_seen_inside_the_run_and_before_a_jump() {
        let of = |text: &str| Motion::Speed {
            profile: Arc::new(Expression::new(text, "t", 2.0).unwrap()),
            initial_angle: 0.0,
        };
        assert!((of("-3*sin(pi*t)").max_speed(2.0) - 3.0).abs() < 1e-6);
        let jump = of("if(t < 0.12345, 100*t, 0)").max_speed(2.0);
        assert!((jump - 12.345).abs() < 1e-10, "{jump}");
    }

    #[test]
    fn a_motion_that_is_not_finite_is_refused() {
        let text = "t^1.5";
        let profile: Arc<dyn Profile> = Arc::new(Expression::new(text, "t", 2.0).unwrap());
        let speed = Motion::Speed { profile: profile.clone(), initial_angle: 0.0 };
        assert!(speed.validate(2.0).is_ok());
        let message = Motion::Angle(profile).validate(2.0).unwrap_err().to_string();
        assert!(message.contains("acceleration of the hub"), "{message}");
    }
}
