//! The components of a force in the hub's frame, at one time.

use crate::profile::{HubKinematics, Profile};
use std::sync::Arc;

/// What the components of a force refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// The inertial axes: the force keeps its direction in space.
    Dead,
    /// The hub's axes, radial and transverse: the force rotates with the hub.
    Hub,
    /// Tangent and normal of the section it acts on: the force rotates with the section.
    Follower,
}

/// How a load changes with time: a factor f(t), or 1 where there is none.
pub type Amplitude = Option<Arc<dyn Profile>>;

/// f d, f ∂d/∂θ, and f, with the symbols of the [parent module](super).
pub(super) struct Components {
    pub d: [f64; 2],
    pub by_angle: [f64; 2],
    pub factor: f64,
}

impl Components {
    /// Those of the force F with the amplitude `factor`; of a follower F itself, which refers to the section.
    pub(super) fn new(force: [f64; 2], axes: Axes, factor: f64, hub: &HubKinematics) -> Components {
        let [x, y] = force.map(|c| factor * c);
        if axes == Axes::Dead {
            let (sin, cos) = libm::sincos(hub.angle);
            let d = [x * cos + y * sin, y * cos - x * sin];
            return Components { d, by_angle: [d[1], -d[0]], factor };
        }
        Components { d: [x, y], by_angle: [0.0; 2], factor }
    }
}
