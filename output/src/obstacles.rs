//! Obstacles beside the shapes of the beam.

use flexion::contact::Obstacle;
use flexion::linalg::Vec3;
use flexion::system::Frame;
use std::sync::Arc;

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
    /// Whether it turns with the hub.
    pub on_hub: bool,
    /// The obstacle.
    pub obstacle: Arc<dyn Obstacle>,
}

impl Drawn {
    /// Its outline at time `t` \[s\] in inertial axes, seen from its station: `frames` are those of the root and of the station,
    /// `size` \[m\] is how far it is drawn.
    pub(super) fn outline(&self, frames: [&Frame; 2], t: f64, size: f64) -> Vec<Vec3> {
        let [root, at] = frames;
        if self.in_space {
            return self.obstacle.outline_in_space(at.position, t, size);
        }
        if !self.on_hub {
            return self.obstacle.outline(at.position, t, size);
        }
        // The root is clamped: its axes are those of the hub, whose axis is the origin.
        let axes = root.rotation;
        let outline = self.obstacle.outline(axes.transpose() * at.position, t, size);
        outline.into_iter().map(|p| axes * p).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexion::contact::Plane;
    use flexion::linalg::Mat3;

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
            on_hub: true,
            obstacle,
        };
        let rotation = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let [root, tip] =
            [0.0, 2.0].map(|x| Frame { position: Vec3([0.0, x, 0.0]), rotation: Mat3(rotation) });
        let outline = drawn.outline([&root, &tip], 0.0, 0.5);
        let mut ends: Vec<f64> = outline.iter().map(|p| p[1]).collect();
        ends.sort_by(f64::total_cmp);
        assert_eq!(ends, [1.5, 2.5]);
        assert!(outline.iter().all(|p| p[0] == -0.25), "{outline:?}");
    }
}
