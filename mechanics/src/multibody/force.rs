//! Springs, dampers, actuators and loads: forces and moments on two markers, with their derivatives.

use super::joint::Coordinate;
use super::marker::{Marker, Pose};
use super::row::{Gradient, Row, Wrench, add_block};
use crate::drive::Actuator;
use crate::linalg::{Mat3, Vec3};
use crate::profile::{HubKinematics, Profile};
use std::sync::Arc;

/// In which directions a spring acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Directions {
    /// Along the line that joins its ends: F = k (ℓ − ℓ₀) + c ℓ̇.
    #[default]
    Line,
    /// Equally in all three, without a length of its own: the force k d + c ḋ with d from one end to the other.
    All,
}

/// A spring and a damper between two points.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// Name, unique in its model.
    pub name: String,
    /// One end; its axes are of no account.
    pub from: Marker,
    /// The other end.
    pub to: Marker,
    /// Stiffness k \[N/m\], ≥ 0.
    pub stiffness: f64,
    /// Damping c [N·s/m], ≥ 0.
    pub damping: f64,
    /// Length ℓ₀ without force \[m\], ≥ 0; 0 of one that acts in all directions.
    pub length: f64,
    /// In which directions it acts.
    pub directions: Directions,
}

/// What the components of a load refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// The inertial axes: the load keeps its direction in space.
    Dead,
    /// The axes of its marker: the load turns with the part.
    Follower,
}

/// A force and a couple on a marker.
#[derive(Clone, Debug)]
pub struct Load {
    /// Name, unique in its model.
    pub name: String,
    /// Where it acts.
    pub at: Marker,
    /// Force \[N\].
    pub force: Vec3,
    /// Couple [N·m].
    pub moment: Vec3,
    /// What the components refer to.
    pub axes: Axes,
    /// Factor f(t); 1 where there is none.
    pub amplitude: Option<Arc<dyn Profile>>,
}

/// A wrench with its derivatives by positions and rotations, and by velocities and angular velocities.
#[derive(Clone, Debug)]
pub(super) struct Interaction {
    pub(super) wrench: Wrench,
    pub(super) gradient: Gradient,
    pub(super) damping: Gradient,
    /// Whether `damping` is not zero.
    pub(super) damps: bool,
}

impl Interaction {
    pub(super) fn new() -> Interaction {
        let zero = [[0.0; 12]; 12];
        Interaction { wrench: [Vec3::ZERO; 4], gradient: zero, damping: zero, damps: false }
    }

    /// Sets the wrench to zero, and its derivatives if they are wanted.
    pub(super) fn clear(&mut self, differentiate: bool) {
        if differentiate {
            *self = Interaction::new();
        }
        self.wrench = [Vec3::ZERO; 4];
    }

    /// Adds c n to the wrench.
    pub(super) fn add(&mut self, c: f64, n: &Wrench) {
        for (out, n) in self.wrench.iter_mut().zip(n) {
            *out += c * *n;
        }
    }
}

/// The blocks of a wrench's derivatives by the distance of the ends: force on A and on B, by the place of A and of B.
const SIGNS: [(usize, usize, f64); 4] = [(0, 0, -1.0), (0, 2, 1.0), (2, 0, 1.0), (2, 2, -1.0)];

impl Spring {
    /// Length, unit vector from A to B and ℓ̇. A spring of no length has no direction and no force.
    fn stretched(a: &Pose, b: &Pose) -> (f64, Vec3, Vec3) {
        let d = b.position - a.position;
        let length = d.dot(d).sqrt();
        let n = if length > 0.0 { 1.0 / length * d } else { Vec3::ZERO };
        (length, n, b.velocity - a.velocity)
    }

    fn force(&self, length: f64, rate: f64) -> f64 {
        self.stiffness * (length - self.length) + self.damping * rate
    }

    /// The length ℓ \[m\] and the force F \[N\], positive where it pulls.
    pub(super) fn length_and_force(&self, a: &Pose, b: &Pose) -> [f64; 2] {
        let (length, n, velocity) = Spring::stretched(a, b);
        [length, self.force(length, n.dot(velocity))]
    }

    pub(super) fn energy(&self, a: &Pose, b: &Pose) -> f64 {
        let (length, ..) = Spring::stretched(a, b);
        0.5 * self.stiffness * (length - self.length) * (length - self.length)
    }

    /// c ℓ̇², or c |ḋ|²
    pub(super) fn dissipation(&self, a: &Pose, b: &Pose) -> f64 {
        let (_, n, velocity) = Spring::stretched(a, b);
        if self.directions == Directions::All {
            return self.damping * velocity.dot(velocity);
        }
        let rate = n.dot(velocity);
        self.damping * rate * rate
    }

    pub(super) fn interact(&self, a: &Pose, b: &Pose, out: &mut Interaction, differentiate: bool) {
        if self.directions == Directions::All {
            return self.interact_in_all_directions(a, b, out, differentiate);
        }
        let (length, n, velocity) = Spring::stretched(a, b);
        let rate = n.dot(velocity);
        let force = self.force(length, rate);
        let none = Vec3::ZERO;
        out.add(force, &[n, none, -n, none]);
        if !differentiate || length == 0.0 {
            return;
        }
        let across = velocity - rate * n;
        let (mut stiffness, mut damping) = (Mat3::ZERO, Mat3::ZERO);
        for i in 0..3 {
            for j in 0..3 {
                let slope = self.stiffness * n[j] + self.damping / length * across[j];
                stiffness[i][j] = n[i] * slope + force / length * (Mat3::IDENTITY[i][j] - n[i] * n[j]);
                damping[i][j] = self.damping * n[i] * n[j];
            }
        }
        for (i, j, sign) in SIGNS {
            add_block(&mut out.gradient, [i, j], sign, &stiffness);
            add_block(&mut out.damping, [i, j], sign, &damping);
        }
        out.damps |= self.damping != 0.0;
    }

    fn interact_in_all_directions(&self, a: &Pose, b: &Pose, out: &mut Interaction, differentiate: bool) {
        let force = self.stiffness * (b.position - a.position) + self.damping * (b.velocity - a.velocity);
        out.add(1.0, &[force, Vec3::ZERO, -force, Vec3::ZERO]);
        if differentiate {
            for (i, j, sign) in SIGNS {
                add_block(&mut out.gradient, [i, j], sign * self.stiffness, &Mat3::IDENTITY);
                add_block(&mut out.damping, [i, j], sign * self.damping, &Mat3::IDENTITY);
            }
            out.damps |= self.damping != 0.0;
        }
    }
}

impl Load {
    fn factor(&self, t: f64) -> f64 {
        self.amplitude.as_ref().map_or(1.0, |f| f.value(t))
    }

    /// On marker B.
    pub(super) fn interact(&self, b: &Pose, (t, part): (f64, f64), out: &mut Interaction) {
        let factor = part * self.factor(t);
        let (mut force, mut moment) = (factor * self.force, factor * self.moment);
        if self.axes == Axes::Follower {
            (force, moment) = (b.axes * force, b.axes * moment);
            add_block(&mut out.gradient, [2, 3], -1.0, &Mat3::skew(force));
            add_block(&mut out.gradient, [3, 3], -1.0, &Mat3::skew(moment));
        }
        out.add(1.0, &[Vec3::ZERO, Vec3::ZERO, force, moment]);
    }
}

/// The coordinate of a joint's third axis: x and ẋ = n·(velocities of the markers).
pub(super) struct Motion {
    pub(super) position: f64,
    pub(super) rate: f64,
    normal: Wrench,
}

/// Velocities of both markers, in the order of a wrench.
fn velocities(a: &Pose, b: &Pose) -> Wrench {
    [a.velocity, a.spin, b.velocity, b.spin]
}

impl Coordinate {
    /// The coordinate of two markers; an angle is `angle` where that has been counted on beyond a turn.
    pub(super) fn motion(self, a: &Pose, b: &Pose, angle: Option<f64>) -> Motion {
        let z = a.axis(2);
        let (position, normal) = match self {
            Coordinate::Angle => {
                let none = Vec3::ZERO;
                (angle.unwrap_or_else(|| principal(a, b)), [none, -z, none, z])
            }
            Coordinate::Displacement => {
                let d = b.position - a.position;
                (z.dot(d), Row::Along(2).normal(a, b, &HubKinematics::default()))
            }
        };
        let rate = normal.iter().zip(velocities(a, b)).map(|(n, v)| (*n).dot(v)).sum();
        Motion { position, rate, normal }
    }

    /// The force of an actuator.
    pub(super) fn interact(
        self,
        actuator: &Actuator,
        (a, b): (&Pose, &Pose),
        motion: &Motion,
        t: f64,
        out: &mut Interaction,
        differentiate: bool,
    ) {
        let kinematics = HubKinematics { angle: motion.position, speed: motion.rate, acceleration: 0.0 };
        let torque = actuator.torque(&kinematics, t);
        out.add(torque.value, &motion.normal);
        if !differentiate {
            return;
        }
        // ∂n, and the slope of the coordinate, which of an angle is n where the third axes coincide.
        let mut change: Gradient = [[0.0; 12]; 12];
        let mut slope: Vec12 = flat(&motion.normal);
        match self {
            Coordinate::Angle => {
                let z = Mat3::skew(a.axis(2));
                add_block(&mut change, [1, 1], 1.0, &z);
                add_block(&mut change, [3, 1], -1.0, &z);
                let (x, y, other) = (a.axis(0), a.axis(1), b.axis(0));
                let (cos, sin) = (x.dot(other), y.dot(other));
                let turned = cos * y - sin * x;
                let h = 1.0 / (cos * cos + sin * sin) * turned.cross(other);
                let none = Vec3::ZERO;
                slope = flat(&[none, h, none, -h]);
            }
            Coordinate::Displacement => {
                Row::Along(2).add_gradient(1.0, (a, b), &HubKinematics::default(), &mut change);
            }
        }
        let (n, v) = (flat(&motion.normal), flat(&velocities(a, b)));
        for j in 0..12 {
            let rate: f64 = (0..12).map(|i| v[i] * change[i][j]).sum();
            let by_position = torque.by_angle * slope[j] + torque.by_speed * rate;
            for i in 0..12 {
                out.gradient[i][j] += torque.value * change[i][j] + n[i] * by_position;
                out.damping[i][j] += n[i] * torque.by_speed * n[j];
            }
        }
        out.damps |= torque.by_speed != 0.0;
    }
}

type Vec12 = [f64; 12];

fn flat(w: &Wrench) -> Vec12 {
    let mut out = [0.0; 12];
    w.iter().flatten().zip(&mut out).for_each(|(x, out)| *out = *x);
    out
}

/// The angle from the first axis of A to that of B about the third axis, in (−π, π].
fn principal(a: &Pose, b: &Pose) -> f64 {
    angle_between(a.axis(0), a.axis(1), b.axis(0))
}

/// The angle of `other` in the plane of x and y.
pub(super) fn angle_between(x: Vec3, y: Vec3, other: Vec3) -> f64 {
    libm::atan2(y.dot(other), x.dot(other))
}
