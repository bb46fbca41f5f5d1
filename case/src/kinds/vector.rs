//! Axes in the tables of a case.

use crate::fault::{Fault, Made};
use crate::keys::{Field, vector};
use crate::units::FACTOR;
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::rotation::frame;

/// The third axis of a body or joint.
pub(super) const AXIS: Field<Option<Vec3>> =
    vector(&FACTOR).called("axis", "direction of the third axis, [0, 0, 1] if left out");

/// The first axis of a body or joint.
pub(super) const ACROSS: Field<Option<Vec3>> = vector(&FACTOR).called(
    "across",
    "direction to which the first axis points, as far as the third allows; chosen if left out",
);

/// The axes that `axis` and `across` describe.
pub(super) fn direction(axis: Option<Vec3>, across: Option<Vec3>) -> Made<Mat3> {
    let axis = axis.unwrap_or(Vec3([0.0, 0.0, 1.0]));
    let fault =
        |key: &str| Fault::new(key, "has no direction: one of its components must not be zero").into();
    if across == Some(Vec3::ZERO) {
        return Err(fault("across"));
    }
    frame(axis, across).ok_or_else(|| fault("axis"))
}

/// The unit vector along that of `key`, if it is given.
pub(super) fn unit(vector: Option<Vec3>, key: &str) -> Made<Option<Vec3>> {
    let Some(vector) = vector else { return Ok(None) };
    let size = vector.norm();
    if !(size > 0.0 && size.is_finite()) {
        let message =
            "has no direction: its components are all zero, or too large or too small to be squared";
        return Err(Fault::new(key, message).into());
    }
    Ok(Some(1.0 / size * vector))
}
