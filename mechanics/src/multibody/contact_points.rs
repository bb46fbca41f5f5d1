//! Points of bodies that may touch obstacles.

use super::body::Placed;
use super::system::Multibody;
use crate::contact::{PointMotion, Points, Variation};
use crate::linalg::Matrix;
use crate::system::State;

impl Multibody {
    /// Number of the marker of contact point `k`, and the place of its body, which are placed.
    fn contact(&mut self, k: usize, s: &State) -> (usize, Placed) {
        self.place(s);
        let marker = self.poses.len() - self.constants.model.points.len() + k;
        let body = self.poses[marker].numbers[0] / 6;
        (marker, self.placed[body])
    }
}

impl Points for Multibody {
    fn motion(&mut self, k: usize, s: &State) -> PointMotion {
        let (marker, _) = self.contact(k, s);
        let pose = &self.poses[marker];
        PointMotion {
            position: pose.position,
            velocity: pose.velocity,
            acceleration: pose.acceleration,
            prescribed: [0.0; 3],
        }
    }

    fn variations(&mut self, k: usize, s: &State, out: &mut Vec<Variation>) {
        let (marker, body) = self.contact(k, s);
        self.poses[marker].transport(&body);
        let pose = &self.poses[marker];
        out.clear();
        out.extend((0..pose.count).map(|j| Variation {
            unknown: pose.numbers[j],
            position: [0, 1, 2].map(|i| pose.jacobian[i][j]),
            velocity: [0, 1, 2].map(|i| pose.transport[i][j]),
        }));
    }

    fn add_curvature(&mut self, k: usize, s: &State, force: [f64; 3], w: f64, out: &mut Matrix) {
        let (marker, _) = self.contact(k, s);
        let pose = &self.poses[marker];
        let mut block = [[0.0; 6]; 6];
        pose.add_curvature(w, force, [0.0; 3], 0, &mut block);
        for i in 3..6 {
            for j in 3..6 {
                out.add(pose.numbers[i], pose.numbers[j], block[i][j]);
            }
        }
    }

    fn is_local(&self, _k: usize) -> bool {
        true
    }
}
