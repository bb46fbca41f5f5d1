//! Trajectories for tests.

use super::Trajectory;
use flexion::system::{Channel, Role};

pub(super) fn channel(name: &str, unit: &'static str) -> Channel {
    Channel::new(Role::Detail, name, unit, format!("the {name}"))
}

/// Two channels: a cosine with its lowest point at t = 2 s, and a constant.
pub(super) fn sample() -> Trajectory {
    let mut t = Trajectory::new(vec![channel("tip.deflection", "m"), channel("hub.speed", "rad/s")]);
    for i in 0..=4 {
        let time = f64::from(i);
        t.push(time, |row| {
            row.copy_from_slice(&[(std::f64::consts::FRAC_PI_2 * time).cos(), 4.0]);
        });
    }
    t
}
