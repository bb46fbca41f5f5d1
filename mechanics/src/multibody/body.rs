//! A rigid body.

use super::rotation::{IDENTITY, Matrix3, Quaternion, Vector, apply, matrix, plus};
use crate::linalg::vector::{cross, inner};
use crate::system::Frame;

/// A rigid body as it stands at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Name, unique in its model.
    pub name: String,
    /// Mass m \[kg\], > 0.
    pub mass: f64,
    /// Centre of mass in the body's frame \[m\].
    pub centre: Vector,
    /// Inertia J about the centre of mass, in the axes of the body's frame [kg·m²]: symmetric, positive definite.
    pub inertia: Matrix3,
    /// The body's frame at the start.
    pub frame: Frame,
    /// Velocity of the frame's origin at the start, inertial axes \[m/s\]; where it is not given, that which the joints ask for.
    pub velocity: Option<Vector>,
    /// Angular velocity at the start, inertial axes [rad/s]; likewise.
    pub spin: Option<Vector>,
    /// Damping β [1/s] by forces −β m ṙ and moments −β J Ω.
    pub damping: f64,
}

impl Body {
    /// A body at rest with its frame at the origin, its centre of mass there, and the principal moments of inertia
    /// `inertia` [kg·m²].
    pub fn new(name: &str, mass: f64, inertia: [f64; 3]) -> Body {
        let mut tensor = [[0.0; 3]; 3];
        (0..3).for_each(|i| tensor[i][i] = inertia[i]);
        Body {
            name: name.to_owned(),
            mass,
            centre: [0.0; 3],
            inertia: tensor,
            frame: Frame { position: [0.0; 3], rotation: IDENTITY },
            velocity: None,
            spin: None,
            damping: 0.0,
        }
    }

    /// The same body with its frame at `position`.
    pub fn at(mut self, position: Vector) -> Body {
        self.frame.position = position;
        self
    }

    /// What is wrong with the numbers, if anything.
    pub(super) fn fault(&self) -> Option<String> {
        let j = &self.inertia;
        let motion = self.velocity.iter().chain(&self.spin).flatten();
        let numbers = j.iter().flatten().chain(&self.centre).chain(motion);
        let mut numbers = numbers.chain(&self.frame.position).chain(self.frame.rotation.iter().flatten());
        if !numbers.all(|x| x.is_finite()) {
            return Some("has a number that is not finite".to_owned());
        }
        if !(self.mass > 0.0 && self.mass.is_finite()) {
            return Some(format!(
                "has the mass {} kg and must have one > 0: join what has no mass to a body",
                self.mass
            ));
        }
        if !(self.damping >= 0.0 && self.damping.is_finite()) {
            return Some(format!("has the damping {} 1/s and must have one ≥ 0", self.damping));
        }
        let size = j.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let skew = (0..3).map(|i| (j[i][(i + 1) % 3] - j[(i + 1) % 3][i]).abs()).fold(0.0, f64::max);
        let minors = [j[0][0], j[0][0] * j[1][1] - j[0][1] * j[1][0], inner(j[0], cross(j[1], j[2]))];
        if skew > 1e-12 * size || !minors.iter().all(|x| *x > 0.0) {
            return Some("has an inertia tensor that is not symmetric and positive definite".to_owned());
        }
        // Principal moments obey J₁ ≤ J₂ + J₃: the tensor ½ tr(J) I − J of ∫ x xᵀ dm has no negative eigenvalue.
        let half = 0.5 * (j[0][0] + j[1][1] + j[2][2]);
        let second = nalgebra::Matrix3::from_fn(|i, k| if i == k { half - j[i][i] } else { -j[i][k] });
        let least = second.symmetric_eigenvalues().min();
        if least < -1e-9 * half {
            return Some(format!(
                "has principal moments of inertia of which one exceeds the sum of the others by {:.3e} kg·m²",
                -2.0 * least
            ));
        }
        let r = &self.frame.rotation;
        let defect = (0..3).flat_map(|i| (0..3).map(move |k| (i, k)));
        let defect = defect.map(|(i, k)| (inner(r[i], r[k]) - IDENTITY[i][k]).abs()).fold(0.0, f64::max);
        if defect > 1e-9 || inner(r[0], cross(r[1], r[2])) < 0.0 {
            return Some(format!("has axes that are no rotation (R Rᵀ − I = {defect:.1e})"));
        }
        None
    }
}

/// Velocity of the origin of a part and its angular velocity, in the axes of space.
pub(super) type Twist = [Vector; 2];

/// A body at a state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub(super) position: Vector,
    pub(super) rotation: Matrix3,
    pub(super) velocity: Vector,
    /// Ω, body axes.
    pub(super) spin: Vector,
    pub(super) acceleration: Vector,
    pub(super) spin_rate: Vector,
}

impl Default for Placed {
    fn default() -> Placed {
        let zero = [0.0; 3];
        Placed {
            position: zero,
            rotation: IDENTITY,
            velocity: zero,
            spin: zero,
            acceleration: zero,
            spin_rate: zero,
        }
    }
}

/// Three entries from `i` on.
#[inline(always)]
pub(super) fn three(x: &[f64], i: usize) -> Vector {
    [x[i], x[i + 1], x[i + 2]]
}

/// The quaternion in the entries from `i` on.
#[inline(always)]
pub(super) fn four(x: &[f64], i: usize) -> Quaternion {
    [x[i], x[i + 1], x[i + 2], x[i + 3]]
}

impl Placed {
    /// From the entries of q, v and a that belong to the body.
    #[inline]
    pub(super) fn new(q: &[f64], v: &[f64], a: &[f64]) -> Placed {
        Placed {
            position: three(q, 0),
            rotation: matrix(four(q, 3)),
            velocity: three(v, 0),
            spin: three(v, 3),
            acceleration: three(a, 0),
            spin_rate: three(a, 3),
        }
    }

    /// The body's frame, whose origin is at −`centre` from the centre of mass.
    pub(super) fn frame(&self, centre: Vector) -> Frame {
        Frame { position: plus(self.position, -1.0, apply(&self.rotation, centre)), rotation: self.rotation }
    }
}
