//! Markers: frames fixed to parts, and all that joints and forces know of a part.

use super::body::Placed;
use super::rotation::{
    IDENTITY, Matrix3, Vector, apply, apply_transposed, column, frame, plus, product, skew,
};
use crate::linalg::vector::cross;
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
    pub fn new(part: Part, position: Vector) -> Marker {
        Marker { part, frame: Frame { position, rotation: IDENTITY } }
    }

    /// The same with its third axis along `axis`, in the part's frame, and its first axis towards `first` as far as the
    /// third allows. `None` for an axis without direction.
    pub fn with_axis(mut self, axis: Vector, first: Option<Vector>) -> Option<Marker> {
        self.frame.rotation = frame(axis, first)?;
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
    pub(super) position: Vector,
    /// The axes are its columns.
    pub(super) axes: Matrix3,
    pub(super) velocity: Vector,
    pub(super) spin: Vector,
    pub(super) acceleration: Vector,
    pub(super) spin_rate: Vector,
    /// Numbers of the velocities that move it.
    pub(super) numbers: [usize; MOST],
    pub(super) count: usize,
    pub(super) jacobian: [[f64; MOST]; 6],
    pub(super) transport: [[f64; MOST]; 6],
    /// From the part's centre of mass to the marker, and the part's rotation.
    arm: Vector,
    rotation: Matrix3,
}

impl Default for Pose {
    fn default() -> Pose {
        let zero = [0.0; 3];
        Pose {
            position: zero,
            axes: IDENTITY,
            velocity: zero,
            spin: zero,
            acceleration: zero,
            spin_rate: zero,
            numbers: [0; MOST],
            count: 0,
            jacobian: [[0.0; MOST]; 6],
            transport: [[0.0; MOST]; 6],
            arm: zero,
            rotation: IDENTITY,
        }
    }
}

impl Pose {
    /// Of a marker on the ground.
    pub(super) fn grounded(frame: Frame) -> Pose {
        Pose { position: frame.position, axes: frame.rotation, ..Pose::default() }
    }

    /// Of a marker on a body whose velocities begin at `first`; it stands at `arm` from the centre of mass.
    pub(super) fn on_body(first: usize) -> Pose {
        let mut pose = Pose { count: 6, ..Pose::default() };
        (0..6).for_each(|i| pose.numbers[i] = first + i);
        (0..3).for_each(|i| pose.jacobian[i][i] = 1.0);
        pose
    }

    /// Moves a marker on a body: ẋ = ṙ + R (Ω × s), ω = R Ω and so on, with its frame (s, A) from the centre of mass.
    #[inline]
    pub(super) fn place(&mut self, body: &Placed, marker: &Frame) {
        let (r, s, spin) = (&body.rotation, marker.position, body.spin);
        self.arm = s;
        self.rotation = *r;
        self.position = plus(body.position, 1.0, apply(r, s));
        self.axes = product(r, &marker.rotation);
        let swept = cross(spin, s);
        self.velocity = plus(body.velocity, 1.0, apply(r, swept));
        self.spin = apply(r, spin);
        let bent = plus(cross(body.spin_rate, s), 1.0, cross(spin, swept));
        self.acceleration = plus(body.acceleration, 1.0, apply(r, bent));
        self.spin_rate = apply(r, body.spin_rate);
        // −R s̃ and R; −R (Ω × s)~ and −R Ω̃.
        let lever = product(r, &skew(s));
        for i in 0..3 {
            for j in 0..3 {
                self.jacobian[i][3 + j] = -lever[i][j];
                self.jacobian[3 + i][3 + j] = r[i][j];
            }
        }
    }

    /// Writes B of a marker that has been placed.
    pub(super) fn transport(&mut self, body: &Placed) {
        let lever = product(&body.rotation, &skew(cross(body.spin, self.arm)));
        let turn = product(&body.rotation, &skew(body.spin));
        for i in 0..3 {
            for j in 0..3 {
                self.transport[i][3 + j] = -lever[i][j];
                self.transport[3 + i][3 + j] = -turn[i][j];
            }
        }
    }

    /// Axis j.
    #[inline(always)]
    pub(super) fn axis(&self, j: usize) -> Vector {
        column(&self.axes, j)
    }

    /// Adds c ∂(Jᵀ w)/∂δ of the force and moment w, held fixed, to the block of a matrix at (`at`, `at`).
    pub(super) fn add_curvature<const N: usize>(
        &self,
        c: f64,
        force: Vector,
        moment: Vector,
        at: usize,
        out: &mut [[f64; N]; N],
    ) {
        if self.count == 0 {
            return;
        }
        // The generalized moment s × Rᵀf + Rᵀm changes by s̃ (Rᵀf)~ + (Rᵀm)~ with the body's rotation.
        let force = skew(apply_transposed(&self.rotation, force));
        let moment = skew(apply_transposed(&self.rotation, moment));
        let lever = product(&skew(self.arm), &force);
        for i in 0..3 {
            for j in 0..3 {
                out[at + 3 + i][at + 3 + j] += c * (lever[i][j] + moment[i][j]);
            }
        }
    }
}
