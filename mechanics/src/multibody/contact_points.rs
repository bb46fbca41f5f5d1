//! Points of bodies and beams that may touch obstacles.

use super::beam::Beam;
use super::marker::MOST;
use super::system::Multibody;
use crate::contact::{Curve, Obstacle, PointMotion, Points, Variation};
use crate::linalg::{Matrix, Vec3};
use crate::system::State;

impl Multibody {
    /// Number of the marker of contact point `k`, which is placed.
    fn contact(&mut self, k: usize, s: &State) -> usize {
        self.place(s);
        self.poses.len() - self.constants.model.points.len() + k
    }

    /// The beam of which contact point `k` is any point, and where its coordinates and velocities begin.
    fn struck(&self, k: usize) -> Option<(&Beam, [usize; 2])> {
        let beam = self.constants.model.points[k].beam()?;
        Some((&self.constants.model.beams[beam].beam, self.constants.beams[beam]))
    }
}

impl Points for Multibody {
    fn approach(&mut self, k: usize, s: &State, obstacle: &dyn Obstacle) {
        let mut nearest = std::mem::take(&mut self.nearest[k]);
        if let Some((beam, [q, _])) = self.struck(k) {
            nearest.find(beam, &s.q[q..], obstacle, s.time());
        }
        self.nearest[k] = nearest;
    }

    fn station(&self, k: usize) -> Option<f64> {
        self.struck(k).map(|(beam, _)| self.nearest[k].station(beam))
    }

    fn motion(&mut self, k: usize, s: &State) -> PointMotion {
        let radius = self.constants.model.points[k].radius;
        if let Some((beam, [q, v])) = self.struck(k) {
            let nearest = &self.nearest[k];
            let [position, slope, curvature] = nearest.shape(beam, &s.q[q..]);
            let ([velocity, slope_rate], [acceleration, _]) =
                (nearest.rates(beam, &s.v[v..]), nearest.rates(beam, &s.a[v..]));
            let curve = nearest.inside.then_some(Curve { slope, curvature, slope_rate });
            return PointMotion { position, velocity, acceleration, radius, curve, ..PointMotion::default() };
        }
        let marker = self.contact(k, s);
        let pose = &self.poses[marker];
        PointMotion {
            position: pose.position,
            velocity: pose.velocity,
            acceleration: pose.acceleration,
            radius,
            spin: pose.spin,
            spin_rate: pose.spin_rate,
            ..PointMotion::default()
        }
    }

    fn variations(&mut self, k: usize, s: &State, out: &mut Vec<Variation>) {
        out.clear();
        if let Some((beam, [_, v])) = self.struck(k) {
            self.nearest[k].unknowns(beam, |i, position, slope| {
                out.push(Variation { unknown: v + i, position, slope, ..Variation::default() });
            });
            return;
        }
        let marker = self.contact(k, s);
        self.poses[marker].transport();
        let pose = &self.poses[marker];
        let column = |of: &[[f64; MOST]; 6], first: usize, j: usize| [0, 1, 2].map(|i| of[first + i][j]);
        out.extend((0..pose.count).map(|j| Variation {
            unknown: pose.numbers[j],
            position: Vec3(column(&pose.jacobian, 0, j)),
            velocity: Vec3(column(&pose.transport, 0, j)),
            rotation: Vec3(column(&pose.jacobian, 3, j)),
            spin: Vec3(column(&pose.transport, 3, j)),
            ..Variation::default()
        }));
    }

    fn add_curvature(&mut self, k: usize, s: &State, [force, moment]: [Vec3; 2], w: f64, out: &mut Matrix) {
        if self.struck(k).is_some() {
            // Its point is linear in the coordinates.
            return;
        }
        let marker = self.contact(k, s);
        let pose = &self.poses[marker];
        let mut block = [[0.0; MOST]; MOST];
        pose.add_curvature(w, force, moment, 0, &mut block);
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
