//! Markers: frames fixed to parts, and all that joints and forces know of a part.
//!
//! A section of a beam rotates by δθ = B (δr′, δΘ) = r′ × δr′/|r′|² + t δΘ. With the arm p = Λ s of a marker,
//!
//! ```text
//! ω  = w t + σ,  σ = r′ × ṙ′/|r′|²      δω = W δr′,  W = w (1 − t tᵀ)/|r′| − [ṙ′]×/|r′|² − 2 σ tᵀ/|r′|
//! ẋ  = ṙ + ω × p                        δẋ = −[p]× W δr′ − [ω]× [p]× δθ
//! Jᵀ(f, m) = (f, Bᵀ M),  M = p × f + m  δ(Bᵀ M) = (∂B)ᵀ M + Bᵀ [f]× [p]× δθ
//! ```

use super::body::Placed;
use super::rotation::{frame, tangent};
use super::slender::Triad;
use crate::contact::Variation;
use crate::linalg::{Mat3, Vec3};
use crate::system::Frame;

/// Largest number of velocities that move a marker: a node of a beam has seven.
pub(super) const MOST: usize = 7;

/// What a marker is fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The inertial frame.
    Ground,
    /// The body of this number.
    Body(usize),
    /// The section at a node of a beam: its origin on the centreline, its axes Λ = [t, n, b]. What is fixed to it
    /// rotates with r′ and does not hold the length of r′.
    Section {
        /// Number of the beam.
        beam: usize,
        /// Number of the node.
        node: usize,
    },
}

/// A frame fixed to a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marker {
    /// What it is fixed to.
    pub part: Part,
    /// Position and axes in the part's frame.
    pub frame: Frame,
}

impl Marker {
    /// A marker with the axes of its part at `position` \[m\] in the part's frame.
    pub fn new(part: Part, position: impl Into<Vec3>) -> Marker {
        Marker { part, frame: Frame { position: position.into(), rotation: Mat3::IDENTITY } }
    }

    /// The same with its third axis along `axis`, in the part's frame, and its first axis towards `first` as far as the
    /// third allows. `None` for an axis without direction.
    pub fn with_axis(mut self, axis: impl Into<Vec3>, first: Option<Vec3>) -> Option<Marker> {
        self.frame.rotation = frame(axis.into(), first)?;
        Some(self)
    }
}

/// A marker at a state, with the velocities u that move it:
///
/// ```text
/// ⎡δx⎤         ⎡ẋ⎤
/// ⎣δθ⎦ = J δ,  ⎣ω⎦ = J u,   B = ∂(J u)/∂δ
/// ```
#[derive(Clone, Debug)]
pub(super) struct Pose {
    pub(super) position: Vec3,
    /// The axes are its columns.
    pub(super) axes: Mat3,
    pub(super) velocity: Vec3,
    pub(super) spin: Vec3,
    pub(super) acceleration: Vec3,
    pub(super) spin_rate: Vec3,
    /// Numbers of the velocities that move it.
    pub(super) numbers: [usize; MOST],
    pub(super) count: usize,
    pub(super) jacobian: [[f64; MOST]; 6],
    pub(super) transport: [[f64; MOST]; 6],
    carrier: Carrier,
}

/// The part that carries a marker.
#[derive(Clone, Copy, Debug)]
enum Carrier {
    Ground,
    /// From the centre of mass to the marker, rotation and Ω, in the body's axes.
    Body {
        arm: Vec3,
        rotation: Mat3,
        spin: Vec3,
    },
    /// From the centreline to the marker in space, axes, ṙ′ and w.
    Section {
        arm: Vec3,
        triad: Triad,
        slope_rate: Vec3,
        spin: f64,
    },
}

impl Default for Pose {
    fn default() -> Pose {
        let zero = Vec3::ZERO;
        Pose {
            position: zero,
            axes: Mat3::IDENTITY,
            velocity: zero,
            spin: zero,
            acceleration: zero,
            spin_rate: zero,
            numbers: [0; MOST],
            count: 0,
            jacobian: [[0.0; MOST]; 6],
            transport: [[0.0; MOST]; 6],
            carrier: Carrier::Ground,
        }
    }
}

impl Pose {
    /// Of a marker on the ground.
    pub(super) fn grounded(frame: Frame) -> Pose {
        Pose { position: frame.position, axes: frame.rotation, ..Pose::default() }
    }

    /// Of a marker that `count` velocities from `first` on move: six of a body, seven of a node of a beam.
    pub(super) fn moved(first: usize, count: usize) -> Pose {
        let mut pose = Pose { count, ..Pose::default() };
        (0..count).for_each(|i| pose.numbers[i] = first + i);
        (0..3).for_each(|i| pose.jacobian[i][i] = 1.0);
        pose
    }

    /// Moves a marker on a body: ẋ = ṙ + R (Ω × s), ω = R Ω and so on, with its frame (s, A) from the centre of mass.
    #[inline]
    pub(super) fn place(&mut self, body: &Placed, marker: &Frame) {
        let (r, s, spin) = (body.rotation, marker.position, body.spin);
        self.carrier = Carrier::Body { arm: s, rotation: r, spin };
        self.position = body.position + r * s;
        self.axes = r * marker.rotation;
        let swept = spin.cross(s);
        self.velocity = body.velocity + r * swept;
        self.spin = r * spin;
        let bent = body.spin_rate.cross(s) + spin.cross(swept);
        self.acceleration = body.acceleration + r * bent;
        self.spin_rate = r * body.spin_rate;
        // −R s̃ and R; −R (Ω × s)~ and −R Ω̃.
        let lever = r * Mat3::skew(s);
        for i in 0..3 {
            for j in 0..3 {
                self.jacobian[i][3 + j] = -lever[i][j];
                self.jacobian[3 + i][3 + j] = r[i][j];
            }
        }
    }

    /// Moves a marker on the section of a node, whose q, v and a begin at those of the slices.
    #[inline]
    pub(super) fn place_on_section(&mut self, [q, v, a]: [&[f64]; 3], marker: &Frame) {
        let triad = Triad::new(Vec3::at(q, 3), Vec3::at(q, 6));
        let axes = triad.rotation();
        let arm = axes * marker.position;
        self.carrier = Carrier::Section { arm, triad, slope_rate: Vec3::at(v, 3), spin: v[6] };
        let rates = |x: &[f64]| [x[3], x[4], x[5], x[6]];
        [self.spin, self.spin_rate] = triad.angular_motion(rates(v), rates(a));
        self.position = Vec3::at(q, 0) + arm;
        self.axes = axes * marker.rotation;
        let swept = self.spin.cross(arm);
        self.velocity = Vec3::at(v, 0) + swept;
        let bent = self.spin_rate.cross(arm) + self.spin.cross(swept);
        self.acceleration = Vec3::at(a, 0) + bent;
        let rotation = triad.rotation_jacobian();
        let lever = levered(arm, &rotation);
        for i in 0..3 {
            for j in 0..4 {
                self.jacobian[i][3 + j] = -lever[i][j];
                self.jacobian[3 + i][3 + j] = rotation[i][j];
            }
        }
    }

    /// Writes B of a marker that has been placed.
    pub(super) fn transport(&mut self) {
        match self.carrier {
            Carrier::Ground => {}
            Carrier::Body { arm, rotation, spin } => {
                let lever = rotation * Mat3::skew(spin.cross(arm));
                let turn = rotation * Mat3::skew(spin);
                for i in 0..3 {
                    for j in 0..3 {
                        self.transport[i][3 + j] = -lever[i][j];
                        self.transport[3 + i][3 + j] = -turn[i][j];
                    }
                }
            }
            Carrier::Section { arm, triad, slope_rate, spin } => {
                let (inverse, t) = (1.0 / triad.length, triad.tangent);
                let swing = inverse * t.cross(slope_rate);
                let rate = Mat3::skew(-inverse * inverse * slope_rate);
                let mut turn = [[0.0; 4]; 3];
                for i in 0..3 {
                    for j in 0..3 {
                        let across = spin * (Mat3::IDENTITY[i][j] - t[i] * t[j]);
                        turn[i][j] = inverse * (across - 2.0 * swing[i] * t[j]) + rate[i][j];
                    }
                }
                let by_arm = levered(self.spin, &levered(arm, &triad.rotation_jacobian()));
                let lever = levered(arm, &turn);
                for i in 0..3 {
                    for j in 0..4 {
                        self.transport[i][3 + j] = -lever[i][j] - by_arm[i][j];
                        self.transport[3 + i][3 + j] = turn[i][j];
                    }
                }
            }
        }
    }

    /// Axis j.
    #[inline(always)]
    pub(super) fn axis(&self, j: usize) -> Vec3 {
        self.axes.column(j)
    }

    /// A point of space in its axes, from its position.
    #[inline]
    pub(super) fn within(&self, x: Vec3) -> Vec3 {
        self.axes.transpose() * (x - self.position)
    }

    /// Its motion by each velocity that moves it, of a marker whose [transport](Pose::transport) was written.
    pub(super) fn variations(&self) -> impl Iterator<Item = Variation> {
        let column =
            |of: &[[f64; MOST]; 6], first: usize, j: usize| Vec3([0, 1, 2].map(|i| of[first + i][j]));
        (0..self.count).map(move |j| Variation {
            unknown: self.numbers[j],
            position: column(&self.jacobian, 0, j),
            velocity: column(&self.transport, 0, j),
            rotation: column(&self.jacobian, 3, j),
            spin: column(&self.transport, 3, j),
            ..Variation::default()
        })
    }

    /// Adds c Jᵀ w of the force and moment w.
    #[inline]
    pub(super) fn add_force(&self, c: f64, force: Vec3, moment: Vec3, r: &mut [f64]) {
        for k in 0..self.count {
            let column = |i: usize| self.jacobian[i][k];
            let sum = force[0] * column(0) + force[1] * column(1) + force[2] * column(2);
            let turn = moment[0] * column(3) + moment[1] * column(4) + moment[2] * column(5);
            r[self.numbers[k]] += c * (sum + turn);
        }
    }

    /// Adds c ∂(Jᵀ w)/∂δ of the force and moment w, held fixed, to the block of a matrix at (`at`, `at`).
    pub(super) fn add_curvature<const N: usize>(
        &self,
        c: f64,
        force: Vec3,
        moment: Vec3,
        at: usize,
        out: &mut [[f64; N]; N],
    ) {
        match self.carrier {
            Carrier::Ground => {}
            Carrier::Body { arm, rotation, .. } => {
                // The generalized moment s × Rᵀf + Rᵀm changes by s̃ (Rᵀf)~ + (Rᵀm)~ with the body's rotation.
                let force = Mat3::skew(rotation.transpose() * force);
                let moment = Mat3::skew(rotation.transpose() * moment);
                let lever = Mat3::skew(arm) * force;
                for i in 0..3 {
                    for j in 0..3 {
                        out[at + 3 + i][at + 3 + j] += c * (lever[i][j] + moment[i][j]);
                    }
                }
            }
            Carrier::Section { arm, triad, .. } => {
                let fixed = triad.moment_derivative(moment + arm.cross(force));
                let rotation = triad.rotation_jacobian();
                let carried = levered(force, &levered(arm, &rotation));
                for i in 0..4 {
                    for j in 0..4 {
                        let swept: f64 = (0..3).map(|k| rotation[k][i] * carried[k][j]).sum();
                        out[at + 3 + i][at + 3 + j] += c * (fixed[i][j] + swept);
                    }
                }
            }
        }
    }

    /// Replaces derivatives by variations of the part, in the columns from `at` on, by those by the increment d since the
    /// configuration that was retracted.
    #[inline]
    pub(super) fn follow<const N: usize>(&self, d: &[f64], at: usize, rows: &mut [[f64; N]]) {
        match self.carrier {
            Carrier::Ground => {}
            Carrier::Body { .. } => {
                let chart = tangent(Vec3::at(d, self.numbers[3]));
                for row in rows {
                    let turned = chart.transpose() * Vec3::at(row, at + 3);
                    turned.put(row, at + 3);
                }
            }
            Carrier::Section { triad, .. } => {
                let turn = triad.spin_by_slope(Vec3::at(d, self.numbers[3]));
                for row in rows {
                    (0..3).for_each(|k| row[at + 3 + k] += row[at + 6] * turn[k]);
                }
            }
        }
    }
}

/// [x]× A
#[inline(always)]
fn levered(x: Vec3, a: &[[f64; 4]; 3]) -> [[f64; 4]; 3] {
    let mut out = [[0.0; 4]; 3];
    for j in 0..4 {
        let swept = x.cross(Vec3([a[0][j], a[1][j], a[2][j]]));
        (0..3).for_each(|i| out[i][j] = swept[i]);
    }
    out
}
