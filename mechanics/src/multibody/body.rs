//! A rigid body.

use super::error::PartFault;
use super::rotation::Quaternion;
use crate::linalg::{Mat3, Vec3};
use crate::system::Frame;

/// A rigid body as it stands at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Name, unique in its model.
    pub name: String,
    /// Mass m \[kg\], > 0.
    pub mass: f64,
    /// Centre of mass in the body's frame \[m\].
    pub centre: Vec3,
    /// Inertia J about the centre of mass, in the axes of the body's frame [kg·m²]: symmetric, positive definite.
    pub inertia: Mat3,
    /// The body's frame at the start.
    pub frame: Frame,
    /// Velocity of the frame's origin at the start, inertial axes \[m/s\]; where it is not given, that which the joints ask for.
    pub velocity: Option<Vec3>,
    /// Angular velocity at the start, inertial axes [rad/s]; likewise.
    pub spin: Option<Vec3>,
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
            centre: Vec3::ZERO,
            inertia: Mat3(tensor),
            frame: Frame { position: Vec3::ZERO, rotation: Mat3::IDENTITY },
            velocity: None,
            spin: None,
            damping: 0.0,
        }
    }

    /// The same body with its frame at `position`.
    pub fn at(mut self, position: impl Into<Vec3>) -> Body {
        self.frame.position = position.into();
        self
    }

    /// What is wrong with the numbers, if anything.
    pub(super) fn fault(&self) -> Option<PartFault> {
        let j = &self.inertia;
        let mut vectors = self.velocity.iter().chain(&self.spin).chain([&self.centre, &self.frame.position]);
        if !(vectors.all(|x| x.is_finite()) && j.is_finite() && self.frame.rotation.is_finite()) {
            return Some(PartFault::NotFinite("number"));
        }
        if !(self.mass > 0.0 && self.mass.is_finite()) {
            return Some(PartFault::NoMass(self.mass));
        }
        if !(self.damping >= 0.0 && self.damping.is_finite()) {
            return Some(PartFault::Negative { what: "damping", value: self.damping, unit: "1/s" });
        }
        let size = j.0.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let skew = (0..3).map(|i| (j[i][(i + 1) % 3] - j[(i + 1) % 3][i]).abs()).fold(0.0, f64::max);
        let minors = [j[0][0], j[0][0] * j[1][1] - j[0][1] * j[1][0], j.determinant()];
        if skew > 1e-12 * size || !minors.iter().all(|x| *x > 0.0) {
            return Some(PartFault::Inertia);
        }
        // Principal moments obey J₁ ≤ J₂ + J₃: the tensor ½ tr(J) I − J of ∫ x xᵀ dm has no negative eigenvalue.
        let half = 0.5 * (j[0][0] + j[1][1] + j[2][2]);
        let second = nalgebra::Matrix3::from_fn(|i, k| if i == k { half - j[i][i] } else { -j[i][k] });
        let least = second.symmetric_eigenvalues().min();
        if least < -1e-9 * half {
            return Some(PartFault::Moments(-2.0 * least));
        }
        let r = &self.frame.rotation;
        let product = *r * r.transpose();
        let defect = (0..3).flat_map(|i| (0..3).map(move |k| (i, k)));
        let defect = defect.map(|(i, k)| (product[i][k] - Mat3::IDENTITY[i][k]).abs()).fold(0.0, f64::max);
        if defect > 1e-9 || r.determinant() < 0.0 {
            return Some(PartFault::Axes(defect));
        }
        None
    }
}

/// Velocity of the origin of a part and its angular velocity, in the axes of space.
pub(super) type Twist = [Vec3; 2];

/// A body at a state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub(super) position: Vec3,
    pub(super) rotation: Mat3,
    pub(super) velocity: Vec3,
    /// Ω, body axes.
    pub(super) spin: Vec3,
    pub(super) acceleration: Vec3,
    pub(super) spin_rate: Vec3,
}

impl Default for Placed {
    fn default() -> Placed {
        let zero = Vec3::ZERO;
        Placed {
            position: zero,
            rotation: Mat3::IDENTITY,
            velocity: zero,
            spin: zero,
            acceleration: zero,
            spin_rate: zero,
        }
    }
}

impl Placed {
    /// From the entries of q, v and a that belong to the body.
    #[inline]
    pub(super) fn new(q: &[f64], v: &[f64], a: &[f64]) -> Placed {
        Placed {
            position: Vec3::at(q, 0),
            rotation: Quaternion::at(q, 3).matrix(),
            velocity: Vec3::at(v, 0),
            spin: Vec3::at(v, 3),
            acceleration: Vec3::at(a, 0),
            spin_rate: Vec3::at(a, 3),
        }
    }

    /// The body's frame, whose origin is at −`centre` from the centre of mass.
    pub(super) fn frame(&self, centre: Vec3) -> Frame {
        Frame { position: self.position - self.rotation * centre, rotation: self.rotation }
    }
}
