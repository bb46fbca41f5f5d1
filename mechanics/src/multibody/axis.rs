//! Axes about which a model can rotate steadily, and what on the ground allows it.

use super::force::Axes;
use super::joint::{Drive, Joint, Kind};
use super::marker::{Marker, Part};
use super::model::Model;
use super::rotation::about;
use crate::linalg::{Mat3, Vec3};
use crate::profile::{Constant, Motion, changes};
use crate::system::Frame;
use std::sync::Arc;

/// Sine of the angle between directions that count as one.
const ANGLE: f64 = 1e-6;
/// Distance of points that count as one, over the distance of the axis from the origin and 1 m \[m\].
const DISTANCE: f64 = 1e-6;

/// A line in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// A point of it \[m\].
    pub point: Vec3,
    /// Its direction, a unit vector.
    pub direction: Vec3,
}

impl Axis {
    /// The axis through a point; `None` for a direction without length, or numbers that are not finite.
    pub fn new(point: impl Into<Vec3>, direction: impl Into<Vec3>) -> Option<Axis> {
        let (point, direction) = (point.into(), direction.into());
        let length = direction.norm();
        let valid = length > 0.0 && length.is_finite() && point.is_finite();
        valid.then(|| Axis { point: Vec3(point.0), direction: 1.0 / length * direction })
    }

    fn is_parallel(&self, direction: Vec3) -> bool {
        self.direction.cross(direction).norm() <= ANGLE
    }

    fn holds(&self, point: Vec3) -> bool {
        let off = self.direction.cross(point - self.point).norm();
        off <= DISTANCE * f64::max(1.0, self.point.norm())
    }
}

fn on_ground(joint: &Joint) -> bool {
    joint.from.part == Part::Ground || joint.to.part == Part::Ground
}

fn is_hinge(joint: &Joint) -> bool {
    matches!(joint.kind, Kind::Revolute | Kind::Cylindrical)
}

impl Model {
    /// The axis of a revolute or cylindrical joint.
    pub fn axis_of(&self, joint: &str) -> Option<Axis> {
        let joint = self.joints.iter().find(|j| j.name == joint).filter(|j| is_hinge(j))?;
        let frame = self.in_space(&joint.from)?;
        Axis::new(frame.position, frame.rotation.column(2))
    }

    /// Names of the revolute and cylindrical joints with the ground, in their order.
    pub fn hinges(&self) -> Vec<&str> {
        let hinges = self.joints.iter().filter(|joint| on_ground(joint) && is_hinge(joint));
        hinges.map(|joint| joint.name.as_str()).collect()
    }

    /// The joint with the ground that turns about an axis: the first that is driven, or else the first.
    pub fn hinge_about(&self, axis: &Axis) -> Option<&str> {
        let names = self.hinges();
        let about = |name: &&str| self.axis_of(name).is_some_and(|of| coaxial(axis, &of));
        let driven =
            |name: &&str| self.joints.iter().any(|j| j.name == **name && !matches!(j.drive, Drive::None));
        let found: Vec<&str> = names.into_iter().filter(about).collect();
        found.iter().copied().find(driven).or(found.first().copied())
    }

    /// Names of the joints and springs that fix a part to the ground in a way that a rotation about the axis changes: they
    /// rotate only if the ground does.
    pub fn against(&self, axis: &Axis) -> Vec<&str> {
        let allows = |joint: &Joint| {
            let ground = if joint.from.part == Part::Ground { &joint.from } else { &joint.to };
            let Some(frame) = self.in_space(ground) else { return false };
            let (on_it, along) = (axis.holds(frame.position), axis.is_parallel(frame.rotation.column(2)));
            match joint.kind {
                Kind::Revolute | Kind::Cylindrical => on_it && along,
                Kind::Spherical => on_it,
                Kind::Planar => along,
                Kind::Fixed | Kind::Prismatic | Kind::Universal => false,
            }
        };
        let joints = self.joints.iter().filter(|joint| on_ground(joint) && !allows(joint));
        let off = |marker: &Marker| {
            marker.part == Part::Ground && self.in_space(marker).is_some_and(|f| !axis.holds(f.position))
        };
        let springs = self.springs.iter().filter(|spring| off(&spring.from) || off(&spring.to));
        joints.map(|joint| joint.name.as_str()).chain(springs.map(|s| s.name.as_str())).collect()
    }

    /// Names of the joints whose prescribed motion has a speed at the start.
    pub fn moving(&self) -> Vec<&str> {
        let moves = |joint: &&Joint| match &joint.drive {
            Drive::Prescribed(motion) => motion.at(0.0).speed != 0.0,
            Drive::None | Drive::Actuated(_) => false,
        };
        self.joints.iter().filter(moves).map(|joint| joint.name.as_str()).collect()
    }

    /// Speed about an axis with which the prescribed motion of a joint of this axis begins or, where it begins at rest, its mean speed up to
    /// the time `until` \[s\] [rad/s]; zero for other joints.
    pub fn prescribed_speed(&self, joint: &str, axis: &Axis, until: f64) -> f64 {
        let found = self.joints.iter().find(|j| j.name == joint);
        let (Some(Drive::Prescribed(motion)), Some(own)) = (found.map(|j| &j.drive), self.axis_of(joint))
        else {
            return 0.0;
        };
        let start = motion.at(0.0);
        let speed = if start.speed == 0.0 && until > 0.0 {
            (motion.at(until).angle - start.angle) / until
        } else {
            start.speed
        };
        // The joint turns its second part against its first.
        let ground_turns = found.is_some_and(|j| j.to.part == Part::Ground);
        own.direction.dot(axis.direction) * if ground_turns { -speed } else { speed }
    }

    /// Whether the motion of a joint is prescribed.
    pub fn prescribes(&self, joint: &str) -> bool {
        self.joints.iter().any(|j| j.name == joint && matches!(j.drive, Drive::Prescribed(_)))
    }

    /// Makes a revolute or cylindrical joint keep the angle that it has at the start in the place of its drive, as long as the
    /// [rigid motions](crate::system::Steady::hold) are held: free, it has its motor, spring, damper and controller, or nothing where its motion
    /// is prescribed.
    pub fn keep_angle(&mut self, joint: &str) {
        let Some(number) = self.joints.iter().position(|j| j.name == joint && is_hinge(j)) else { return };
        let of = &self.joints[number];
        let (Some(a), Some(b)) = (self.in_space(&of.from), self.in_space(&of.to)) else { return };
        let along = |j: usize| a.rotation.column(j).dot(b.rotation.column(0));
        let angle = libm::atan2(along(1), along(0));
        if let Ok(profile) = Constant::new(angle) {
            let joint = &mut self.joints[number];
            joint.kept = Some(Motion::Angle(Arc::new(profile)));
            if matches!(joint.drive, Drive::Prescribed(_)) {
                joint.drive = Drive::None;
            }
        }
    }

    /// Takes from gravity and from the loads of a fixed direction what lies across an axis, whose mean over a revolution is
    /// zero; the names of what is changed.
    pub fn keep_along(&mut self, axis: &Axis) -> Vec<String> {
        let e = axis.direction;
        let mut names = Vec::new();
        let mut keep = |name: &str, vectors: &mut [&mut Vec3]| {
            let mut changed = false;
            for x in vectors {
                changed |= e.cross(**x).norm() > ANGLE * x.norm();
                **x = e.dot(**x) * e;
            }
            if changed {
                names.push(name.to_owned());
            }
        };
        keep("gravity", &mut [&mut self.gravity]);
        for load in self.loads.iter_mut().filter(|load| load.axes == Axes::Dead) {
            keep(&format!("`{}`", load.name), &mut [&mut load.force, &mut load.moment]);
        }
        for load in self.line_loads.iter_mut().filter(|load| load.axes == Axes::Dead) {
            keep(&format!("`{}`", load.name), &mut [&mut load.force]);
        }
        names
    }

    /// Whether a load of a fixed direction changes its size up to the time `until` \[s\].
    pub fn load_changes(&self, until: f64) -> bool {
        let loads = self.loads.iter().map(|load| (load.axes, &load.amplitude));
        let lines = self.line_loads.iter().map(|load| (load.axes, &load.amplitude));
        let dead = loads.chain(lines).filter(|(axes, _)| *axes == Axes::Dead);
        dead.filter_map(|(_, amplitude)| amplitude.as_deref()).any(|profile| changes(profile, until))
    }

    /// Turns gravity and the loads of a fixed direction about an axis.
    pub(super) fn turn_loads(&mut self, axis: &Axis, angle: f64) {
        let turn = about(angle * axis.direction);
        self.gravity = turn * self.gravity;
        for load in self.loads.iter_mut().filter(|load| load.axes == Axes::Dead) {
            (load.force, load.moment) = (turn * load.force, turn * load.moment);
        }
        for load in self.line_loads.iter_mut().filter(|load| load.axes == Axes::Dead) {
            load.force = turn * load.force;
        }
    }

    /// A marker at the start, in the axes of space.
    fn in_space(&self, marker: &Marker) -> Option<Frame> {
        let part = self.frame(marker.part)?;
        let rotation: Mat3 = part.rotation * marker.frame.rotation;
        let position = part.position + part.rotation * marker.frame.position;
        Some(Frame { position, rotation })
    }
}

fn coaxial(a: &Axis, b: &Axis) -> bool {
    a.is_parallel(b.direction) && a.holds(b.point)
}
