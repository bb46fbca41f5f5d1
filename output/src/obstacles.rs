//! Obstacles beside the shapes of the beam.

use flexion::contact::Obstacle;
use flexion::system::{Frame, State, System};
use std::sync::Arc;

/// An obstacle to be drawn.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Station of the beam that may touch it \[m\].
    pub station: f64,
    /// Whether it turns with the hub.
    pub on_hub: bool,
    /// The obstacle.
    pub obstacle: Arc<dyn Obstacle>,
}

impl Drawn {
    /// Its outline in inertial axes, seen from its station; `size` \[m\] is that of the system.
    pub(super) fn outline(&self, system: &mut dyn System, state: &State, size: f64) -> Vec<[f64; 3]> {
        let mut frames = [Frame::default(); 2];
        system.frames(0, state, &[0.0, self.station], &mut frames);
        let [root, at] = frames;
        if !self.on_hub {
            return self.obstacle.outline(at.position, state.t, size);
        }
        // The root is clamped: its axes are those of the hub, whose axis is the origin.
        let axes = root.rotation;
        let into_hub = |p: [f64; 3]| [0, 1, 2].map(|j| (0..3).map(|i| axes[i][j] * p[i]).sum());
        let out_of_hub = |p: [f64; 3]| axes.map(|row| row.iter().zip(p).map(|(a, x)| a * x).sum());
        let outline = self.obstacle.outline(into_hub(at.position), state.t, size);
        outline.into_iter().map(out_of_hub).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexion::contact::Plane;
    use flexion::system::{Dynamics, Events, Observed, Size, Steady, Weights};

    /// A rigid beam whose hub has turned by a right angle.
    struct Turned;

    impl Dynamics for Turned {
        fn size(&self) -> Size {
            Size::default()
        }
        fn scales(&self) -> &[f64] {
            &[]
        }
        fn residual(&mut self, _: &State, _: &mut [f64]) {}
        fn tangent(&mut self, _: &State, _: Weights<'_>, _: &mut flexion::linalg::Matrix) {}
    }
    impl Events for Turned {}
    impl Steady for Turned {}
    impl Observed for Turned {
        fn frames(&mut self, _: usize, _: &State, stations: &[f64], out: &mut [Frame]) {
            for (x, frame) in stations.iter().zip(out) {
                let rotation = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
                *frame = Frame { position: [0.0, *x, 0.0], rotation };
            }
        }
    }

    /// A stop over the beam stands to the left of one that points upwards.
    #[test]
    fn an_obstacle_on_the_hub_turns_with_it() {
        let plane = Plane { point: [0.0, 0.25, 0.0], normal: [0.0, -1.0, 0.0], motion: None };
        let drawn = Drawn { station: 2.0, on_hub: true, obstacle: Arc::new(plane) };
        let outline = drawn.outline(&mut Turned, &State::default(), 0.5);
        let mut ends: Vec<f64> = outline.iter().map(|p| p[1]).collect();
        ends.sort_by(f64::total_cmp);
        assert_eq!(ends, [1.5, 2.5]);
        assert!(outline.iter().all(|p| p[0] == -0.25), "{outline:?}");
    }
}
