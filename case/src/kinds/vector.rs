//! Vectors, axes and places in the tables of a case.

use crate::declaration::{Bound::*, Key, Presence::*, Type, key};
use crate::fault::{Fault, Made};
use crate::units::FACTOR;
use crate::values::Values;
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::rotation::frame;

/// The keys of the axes of a body or joint.
pub(super) const MARKED: [Key; 2] = [
    key("axis", Type::Quantities(&FACTOR, Any), Empty, "direction of the third axis, [0, 0, 1] if left out"),
    key(
        "across",
        Type::Quantities(&FACTOR, Any),
        Empty,
        "direction to which the first axis points, as far as the third allows; chosen if left out",
    ),
];

/// Components along x, y and z, or zeros where the key is left out.
pub(crate) fn vector(v: &Values, key: &str) -> Made<Vec3> {
    Ok(optional_vector(v, key)?.unwrap_or_default())
}

/// Components along x, y and z, if the key is given; z is 0 where two are given.
pub(crate) fn optional_vector(v: &Values, key: &str) -> Made<Option<Vec3>> {
    match *v.numbers(key)? {
        [] => Ok(None),
        [x, y] => Ok(Some(Vec3([x, y, 0.0]))),
        [x, y, z] => Ok(Some(Vec3([x, y, z]))),
        ref other => {
            let message =
                format!("has 2 components in the plane of x and y, or 3 in space, and not {}", other.len());
            Err(Fault::new(key, message).into())
        }
    }
}

/// A moment: one number is about z.
pub(super) fn moment(v: &Values, key: &str) -> Made<Vec3> {
    match *v.numbers(key)? {
        [] => Ok(Vec3::ZERO),
        [z] => Ok(Vec3([0.0, 0.0, z])),
        [x, y, z] => Ok(Vec3([x, y, z])),
        ref other => {
            let message = format!("is one number, about z, or has 3 components, and not {}", other.len());
            Err(Fault::new(key, message).into())
        }
    }
}

/// The axes that `axis` and `across` describe.
pub(super) fn direction(v: &Values) -> Made<Mat3> {
    let axis = optional_vector(v, "axis")?.unwrap_or(Vec3([0.0, 0.0, 1.0]));
    let across = optional_vector(v, "across")?;
    let fault =
        |key: &str| Fault::new(key, "has no direction: one of its components must not be zero").into();
    if across == Some(Vec3::ZERO) {
        return Err(fault("across"));
    }
    frame(axis, across).ok_or_else(|| fault("axis"))
}

/// The unit vector at `key`, if it is given.
pub(super) fn unit(v: &Values, key: &str) -> Made<Option<Vec3>> {
    let Some(vector) = optional_vector(v, key)? else { return Ok(None) };
    let size = vector.norm();
    if !(size > 0.0 && size.is_finite()) {
        let message =
            "has no direction: its components are all zero, or too large or too small to be squared";
        return Err(Fault::new(key, message).into());
    }
    Ok(Some(1.0 / size * vector))
}
