//! Points of bodies and beams that may touch obstacles.

use super::beam::Beam;
use super::body::Placed;
use super::constants::Constants;
use super::marker::{MOST, Part};
use super::system::Multibody;
use crate::contact::{Curve, Obstacle, PointMotion, Points, Variation};
use crate::linalg::{Matrix, Vec3};
use crate::system::State;

impl Multibody {
    /// Number of the marker of contact point `k`.
    fn contact(&self, k: usize) -> usize {
        self.poses.len() - self.constants.model.points.len() + k
    }

    /// The beam on whose axis contact point `k` is, and where its coordinates and velocities begin.
    fn struck(&self, k: usize) -> Option<(&Beam, [usize; 2])> {
        let beam = self.constants.model.points[k].beam()?;
        Some((&self.constants.model.beams[beam].beam, self.constants.beams[beam]))
    }
}

/// A point of a body or a section is placed when it [approaches](Points::approach) its obstacle, and not with the markers of the model: an evaluation
/// costs the same for each point, however many there are.
impl Points for Multibody {
    fn approach(&mut self, k: usize, s: &State, obstacle: &dyn Obstacle) {
        let Multibody { constants, on_axis, poses, .. } = self;
        let Constants { model, beams, place, markers, .. } = &**constants;
        if let Some(beam) = model.points[k].beam() {
            on_axis[k].find(&model.beams[beam].beam, &s.q[beams[beam][0]..], obstacle, s.time());
            return;
        }
        let marker = poses.len() - model.points.len() + k;
        let (pose, (part, frame)) = (&mut poses[marker], &markers[marker]);
        match part {
            Part::Ground => {}
            Part::Body(i) => {
                let i = place[*i];
                pose.place(&Placed::new(&s.q[7 * i..], &s.v[6 * i..], &s.a[6 * i..]), frame);
            }
            Part::Section { beam, node } => {
                let [q, v] = beams[*beam];
                let of = &model.beams[*beam].beam;
                of.place_marker(*node, [&s.q[q..], &s.v[v..], &s.a[v..]], frame, pose);
            }
        }
    }

    fn station(&self, k: usize) -> Option<f64> {
        let point = &self.on_axis[k];
        self.struck(k).filter(|_| point.is_sought()).map(|(beam, _)| point.station(beam))
    }

    fn position(&mut self, k: usize, s: &State) -> Option<(Vec3, f64)> {
        let radius = self.constants.model.points[k].radius;
        let position = match self.struck(k) {
            Some((beam, [q, _])) => self.on_axis[k].position(beam, &s.q[q..]),
            None => self.poses[self.contact(k)].position,
        };
        Some((position, radius))
    }

    fn motion(&mut self, k: usize, s: &State) -> PointMotion {
        let radius = self.constants.model.points[k].radius;
        if let Some((beam, [q, v])) = self.struck(k) {
            let point = &self.on_axis[k];
            let [position, slope, curvature] = point.shape(beam, &s.q[q..]);
            let ([velocity, slope_rate], [acceleration, _]) =
                (point.rates(beam, &s.v[v..]), point.rates(beam, &s.a[v..]));
            let curve = point.inside.then_some(Curve { slope, curvature, slope_rate });
            return PointMotion { position, velocity, acceleration, radius, curve, ..PointMotion::default() };
        }
        let pose = &self.poses[self.contact(k)];
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

    fn variations(&mut self, k: usize, _s: &State, out: &mut Vec<Variation>) {
        out.clear();
        if let Some((beam, [_, v])) = self.struck(k) {
            self.on_axis[k].unknowns(beam, |i, position, slope| {
                out.push(Variation { unknown: v + i, position, slope, ..Variation::default() });
            });
            return;
        }
        let marker = self.contact(k);
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

    fn add_curvature(&mut self, k: usize, _s: &State, [force, moment]: [Vec3; 2], w: f64, out: &mut Matrix) {
        if self.struck(k).is_some() {
            // Its point is linear in the coordinates.
            return;
        }
        let pose = &self.poses[self.contact(k)];
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
