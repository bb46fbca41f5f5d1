//! Points of bodies and beams that may touch obstacles.

use super::marker::MOST;
use super::system::Multibody;
use crate::contact::{PointMotion, Points, Variation};
use crate::linalg::Matrix;
use crate::system::State;

impl Multibody {
    /// Number of the marker of contact point `k`, which is placed.
    fn contact(&mut self, k: usize, s: &State) -> usize {
        self.place(s);
        self.poses.len() - self.constants.model.points.len() + k
    }
}

impl Points for Multibody {
    fn motion(&mut self, k: usize, s: &State) -> PointMotion {
        let marker = self.contact(k, s);
        let pose = &self.poses[marker];
        PointMotion {
            position: pose.position,
            velocity: pose.velocity,
            acceleration: pose.acceleration,
            prescribed: [0.0; 3],
        }
    }

    fn variations(&mut self, k: usize, s: &State, out: &mut Vec<Variation>) {
        let marker = self.contact(k, s);
        self.poses[marker].transport();
        let pose = &self.poses[marker];
        out.clear();
        out.extend((0..pose.count).map(|j| Variation {
            unknown: pose.numbers[j],
            position: [0, 1, 2].map(|i| pose.jacobian[i][j]),
            velocity: [0, 1, 2].map(|i| pose.transport[i][j]),
        }));
    }

    fn add_curvature(&mut self, k: usize, s: &State, force: [f64; 3], w: f64, out: &mut Matrix) {
        let marker = self.contact(k, s);
        let pose = &self.poses[marker];
        let mut block = [[0.0; MOST]; MOST];
        pose.add_curvature(w, force, [0.0; 3], 0, &mut block);
        for i in 3..pose.count {
            for j in 3..pose.count {
                out.add(pose.numbers[i], pose.numbers[j], block[i][j]);
            }
        }
    }

    fn is_local(&self, _k: usize) -> bool {
        true
    }

    fn directions(&self) -> usize {
        2
    }
}
