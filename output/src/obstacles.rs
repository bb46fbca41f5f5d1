//! Obstacles beside the shapes of the beam.

use flexion::contact::Obstacle;
use flexion::linalg::{Mat3, Vec3};
use flexion::system::{Frame, State, System};
use std::sync::Arc;

/// What carries an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carrier {
    /// The ground.
    Ground,
    /// The hub of a beam in the plane.
    Hub,
    /// A body, or a beam at a station \[m\]: its number among what is drawn.
    Part(usize, f64),
}

/// An obstacle to be drawn.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Its name.
    pub name: String,
    /// Number of the body that may touch it.
    pub body: usize,
    /// Station of the beam that may touch it \[m\]; one in the middle where there are several.
    pub station: f64,
    /// Stations of its contacts `NAME.1`, `NAME.2`, …, where there are several \[m\].
    pub points: Vec<f64>,
    /// Size of the system \[m\].
    pub size: f64,
    /// Whether the system moves in space and not in a plane.
    pub in_space: bool,
    /// What carries it.
    pub carrier: Carrier,
    /// The obstacle.
    pub obstacle: Arc<dyn Obstacle>,
}

impl Drawn {
    /// Its outline in a state of the system, in inertial axes and seen from its station; `size` \[m\] is how far it is drawn.
    pub(super) fn outline(&self, system: &mut dyn System, state: &State, size: f64) -> Vec<Vec3> {
        let mut frame = |body: usize, station: f64| {
            let mut frames = [Frame::default()];
            system.frames(body, state, &[station], &mut frames);
            frames[0]
        };
        let at = frame(self.body, self.station).position;
        let carrier = match self.carrier {
            Carrier::Ground => Frame { position: Vec3::ZERO, rotation: Mat3::IDENTITY },
            // The root is clamped: its axes are those of the hub, whose axis is the origin.
            Carrier::Hub => Frame { position: Vec3::ZERO, ..frame(self.body, 0.0) },
            Carrier::Part(body, station) => frame(body, station),
        };
        self.placed(&carrier, at, state.t, size)
    }

    /// The outline that its carrier has in this frame, as seen from `at`.
    fn placed(&self, carrier: &Frame, at: Vec3, t: f64, size: f64) -> Vec<Vec3> {
        let (axes, seen) = (carrier.rotation, carrier.rotation.transpose() * (at - carrier.position));
        let outline = if self.in_space {
            self.obstacle.outline_in_space(seen, t, size)
        } else {
            self.obstacle.outline(seen, t, size)
        };
        outline.into_iter().map(|p| carrier.position + axes * p).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexion::contact::Plane;

    /// A stop over the beam stands to the left of one that points upwards.
    #[test]
    fn an_obstacle_on_the_hub_turns_with_it() {
        let plane = Plane { point: Vec3([0.0, 0.25, 0.0]), normal: Vec3([0.0, -1.0, 0.0]), motion: None };
        let name = "stop".to_owned();
        let obstacle = Arc::new(plane);
        let drawn = Drawn {
            name,
            body: 0,
            station: 2.0,
            points: Vec::new(),
            size: 1.0,
            in_space: false,
            carrier: Carrier::Hub,
            obstacle,
        };
        let rotation = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let hub = Frame { position: Vec3::ZERO, rotation: Mat3(rotation) };
        let outline = drawn.placed(&hub, Vec3([0.0, 2.0, 0.0]), 0.0, 0.5);
        let mut ends: Vec<f64> = outline.iter().map(|p| p[1]).collect();
        ends.sort_by(f64::total_cmp);
        assert_eq!(ends, [1.5, 2.5]);
        assert!(outline.iter().all(|p| p[0] == -0.25), "{outline:?}");
    }
}
