//! Points of bodies and beams that may touch obstacles.

use super::beam::Beam;
use super::body::Placed;
use super::constants::Constants;
use super::marker::{MOST, Part, Pose};
use super::mounted::{Mounted, add_cross_curvature, relative, vary};
use super::system::Multibody;
use crate::contact::{Curve, Obstacle, PointMotion, Points, Variation};
use crate::linalg::{Mat3, Matrix, Vec3};
use crate::system::{Frame, State};

impl Multibody {
    /// Number of the marker of contact point `k`.
    fn contact(&self, k: usize) -> usize {
        self.constants.first_point + k
    }

    /// The beam on whose axis contact point `k` is, and where its coordinates and velocities begin.
    fn struck(&self, k: usize) -> Option<(&Beam, [usize; 2])> {
        let beam = self.constants.model.points[k].beam()?;
        Some((&self.constants.model.beams[beam].beam, self.constants.beams[beam]))
    }

    /// What carries the obstacle of contact point `k`.
    fn carrier(&self, k: usize) -> Option<&Pose> {
        self.constants.carriers[k].map(|marker| &self.poses[marker])
    }

    /// Motion of contact point `k` in space.
    fn motion_in_space(&self, k: usize, s: &State) -> PointMotion {
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

    /// Writes the derivatives of the motion of contact point `k` in space.
    fn variations_in_space(&mut self, k: usize, out: &mut Vec<Variation>) {
        out.clear();
        if let Some((beam, [_, v])) = self.struck(k) {
            self.on_axis[k].unknowns(beam, |i, position, slope| {
                out.push(Variation { unknown: v + i, position, slope, ..Variation::default() });
            });
            return;
        }
        let marker = self.contact(k);
        self.poses[marker].transport();
        out.extend(self.poses[marker].variations());
    }
}

/// Places a marker for which `poses` have room.
fn place(constants: &Constants, poses: &mut [Pose], marker: usize, s: &State) {
    let (pose, (part, frame)) = (&mut poses[marker], &constants.markers[marker]);
    match part {
        Part::Ground => {}
        Part::Body(i) => {
            let i = constants.place[*i];
            pose.place(&Placed::new(&s.q[7 * i..], &s.v[6 * i..], &s.a[6 * i..]), frame);
        }
        Part::Section { beam, node } => {
            let [q, v] = constants.beams[*beam];
            let of = &constants.model.beams[*beam].beam;
            of.place_marker(*node, [&s.q[q..], &s.v[v..], &s.a[v..]], frame, pose);
        }
    }
}

/// A point of a body or a section is placed when it [approaches](Points::approach) its obstacle, and not with the markers of the model: an evaluation
/// costs the same for each point, however many there are.
impl Points for Multibody {
    fn approach(&mut self, k: usize, s: &State, obstacle: &dyn Obstacle) {
        let Multibody { constants, on_axis, poses, .. } = self;
        let Constants { model, beams, first_point, carriers, .. } = &**constants;
        let carrier = carriers[k];
        if let Some(carrier) = carrier {
            place(constants, poses, carrier, s);
        }
        let Some(beam) = model.points[k].beam() else { return place(constants, poses, first_point + k, s) };
        let (of, q) = (&model.beams[beam].beam, &s.q[beams[beam][0]..]);
        match carrier {
            None => on_axis[k].find(of, q, obstacle, s.time()),
            Some(carrier) => on_axis[k].find(of, q, &Mounted::new(obstacle, &poses[carrier]), s.time()),
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
        Some((self.carrier(k).map_or(position, |carrier| carrier.within(position)), radius))
    }

    fn motion(&mut self, k: usize, s: &State) -> PointMotion {
        let motion = self.motion_in_space(k, s);
        self.carrier(k).map_or(motion, |carrier| relative(&motion, carrier))
    }

    fn variations(&mut self, k: usize, s: &State, out: &mut Vec<Variation>) {
        self.variations_in_space(k, out);
        let Some(carrier) = self.constants.carriers[k] else { return };
        let motion = self.motion_in_space(k, s);
        self.poses[carrier].transport();
        vary(&motion, &self.poses[carrier], out);
    }

    fn add_curvature(&mut self, k: usize, s: &State, [force, moment]: [Vec3; 2], w: f64, out: &mut Matrix) {
        let carrier = self.constants.carriers[k];
        let to_space = |x: Vec3| carrier.map_or(x, |carrier| self.poses[carrier].axes * x);
        let wrench = [force, moment].map(to_space);
        // A point of an axis is linear in the coordinates.
        if self.struck(k).is_none() {
            add_own_curvature(&self.poses[self.contact(k)], wrench, w, out);
        }
        let Some(carrier) = carrier else { return };
        let mut moved = std::mem::take(&mut self.moved);
        self.variations_in_space(k, &mut moved);
        let (position, carrier) = (self.motion_in_space(k, s).position, &self.poses[carrier]);
        let back = (position - carrier.position).cross(wrench[0]) + wrench[1];
        add_own_curvature(carrier, [wrench[0], back], -w, out);
        add_cross_curvature((&moved, position), carrier, wrench, w, out);
        self.moved = moved;
    }

    fn is_local(&self, _k: usize) -> bool {
        true
    }

    fn directions(&self) -> usize {
        2
    }

    fn frame(&mut self, k: usize, _s: &State) -> Frame {
        let ground = Frame { position: Vec3::ZERO, rotation: Mat3::IDENTITY };
        self.carrier(k).map_or(ground, |on| Frame { position: on.position, rotation: on.axes })
    }
}

/// Adds w ∂(Jᵀ w)/∂q of a marker and a wrench in space.
fn add_own_curvature(pose: &Pose, [force, moment]: [Vec3; 2], w: f64, out: &mut Matrix) {
    let mut block = [[0.0; MOST]; MOST];
    pose.add_curvature(w, force, moment, 0, &mut block);
    for i in 3..pose.count {
        for j in 3..pose.count {
            out.add(pose.numbers[i], pose.numbers[j], block[i][j]);
        }
    }
}
