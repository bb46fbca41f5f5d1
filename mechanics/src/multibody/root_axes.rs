//! A beam as its root sees it: the displacements of a planar beam on a hub, and those across its plane.
//!
//! With the root at r₀, its axes [t, n, b] = Λ₀ and its angular velocity ω₀, a station at r is displaced by
//!
//! ```text
//! (u, v, w) = Λ₀ᵀ (r − r₀) − the same without stress,     d/dt = Λ₀ᵀ (ṙ − ṙ₀ − ω₀ × (r − r₀))
//! ```
//!
//! and its section is rotated in the plane of t and n by the angle of its first axis, less that without stress. The angle is followed
//! from node to node along the beam, so that it may pass π.

use super::flexible::Flexible;
use crate::linalg::{Mat3, Vec3};
use crate::system::{Channel, Frame, Role, Sink};
use std::f64::consts::TAU;

/// What the root sees of a section.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Seen {
    /// Displacements u, v, w along t, n and b \[m\].
    displacement: Vec3,
    /// Their rates \[m/s\].
    velocity: Vec3,
    /// Rotation of the section in the plane of t and n \[rad\], and its rate \[rad/s\].
    rotation: [f64; 2],
}

/// The angle next to `to` that differs from `angle` by whole turns.
fn nearest(angle: f64, to: f64) -> f64 {
    angle + TAU * ((to - angle) / TAU).round()
}

impl Flexible {
    /// Place of the root, and Λ₀ᵀ, of which the axes across are turned by half a turn where the root sees the other side of its section.
    fn root(&self, q: &[f64]) -> (Vec3, Mat3) {
        let Frame { position, rotation } = self.beam.node(0, q);
        let [t, n, b] = [0, 1, 2].map(|k| rotation.column(k));
        let side = if self.turned { -1.0 } else { 1.0 };
        (position, Mat3::columns([t, side * n, side * b]).transpose())
    }

    /// Place of the station at the arc length `s` and angle of its tangent, in the axes of the root.
    fn placed(&self, q: &[f64], s: f64) -> (Vec3, f64) {
        let (origin, root) = self.root(q);
        let angle = |tangent: Vec3| {
            let Vec3([along, across, _]) = root * tangent;
            libm::atan2(across, along)
        };
        let (mut followed, frame) = (0.0, self.frame(q, s));
        for (node, at) in self.beam.nodes().iter().enumerate().skip(1) {
            if *at > s {
                break;
            }
            followed = nearest(angle(self.beam.node(node, q).rotation.column(0)), followed);
        }
        let tangent = frame.rotation.column(0);
        (root * (frame.position - origin), nearest(angle(tangent), followed))
    }

    /// What the root sees of the station at the arc length `s`.
    fn seen(&self, [q, v]: [&[f64]; 2], s: f64) -> Seen {
        let ((origin, root), spin) = (self.root(q), self.beam.root_spin(q, v));
        let (place, angle) = self.placed(q, s);
        let (straight, without) = self.placed(self.beam.initial(), s);
        let frame = self.frame(q, s);
        let relative = self.beam.velocity(v, s) - Vec3::at(v, 0) - spin.cross(frame.position - origin);
        let [slope, rate] = self.beam.direction([q, v], s);
        let (slope, rate) = (root * slope, root * (rate - spin.cross(slope)));
        let square = slope[0] * slope[0] + slope[1] * slope[1];
        Seen {
            displacement: place - straight,
            velocity: root * relative,
            rotation: [angle - without, (slope[0] * rate[1] - slope[1] * rate[0]) / square],
        }
    }
}

/// Puts what the root of a beam sees of one of its stations, by the names that it has in the plane; `alone` where the model has no
/// other beam, which leaves its name out.
pub(super) fn put_seen(of: &Flexible, station: f64, motion: [&[f64]; 2], alone: bool, sink: &mut Sink<'_>) {
    let seen = of.seen(motion, station);
    let tip = of.station_name(station) == "tip";
    let mut put = |value, role, quantity, unit: &'static str, what: &str| {
        sink.put(value, || {
            let of_beam = if alone { String::new() } else { format!("{}.", of.name) };
            let place = if tip { "tip".to_owned() } else { format!("x={station}") };
            let meaning = format!("{what} of {} at s = {station} m, in the axes of its root", of.name);
            let role = if tip { role } else { Role::Detail };
            Channel::new(role, format!("{of_beam}{place}.{quantity}"), unit, meaning)
        });
    };
    let [u, v, w] = seen.displacement.0;
    put(v, Role::Primary, "deflection", "m", "displacement along the height of the section");
    put(u, Role::Primary, "axial", "m", "axial displacement");
    put(w, Role::Secondary, "across", "m", "displacement across the height of the section");
    put(
        seen.rotation[0],
        Role::Secondary,
        "rotation",
        "rad",
        "rotation of the section in the plane of axis and height",
    );
    let [u, v, w] = seen.velocity.0;
    put(v, Role::Secondary, "deflection_velocity", "m/s", "rate of the deflection");
    put(u, Role::Secondary, "axial_velocity", "m/s", "rate of the axial displacement");
    put(w, Role::Detail, "across_velocity", "m/s", "rate of the displacement across");
    put(seen.rotation[1], Role::Secondary, "rotation_velocity", "rad/s", "rate of the rotation");
}
