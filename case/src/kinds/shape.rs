//! Shapes of homogeneous sections, by the dimensions that a case gives.

use crate::fault::{Fault, Made};
use crate::values::Values;
use flexion::section::Shape;

/// Reads a shape; `end` stands before the name of each of its keys: "", "root-" or "tip-".
pub(super) type Read = fn(&Values, &str) -> Made<Shape>;

pub(super) fn rectangle(v: &Values, end: &str) -> Made<Shape> {
    let at = |name: &str| v.number(&format!("{end}{name}"));
    Ok(Shape::Rectangle { width: at("width")?, height: at("height")? })
}

pub(super) fn circle(v: &Values, end: &str) -> Made<Shape> {
    Ok(Shape::Circle { radius: v.number(&format!("{end}radius"))? })
}

pub(super) fn tube(v: &Values, end: &str) -> Made<Shape> {
    let inner = format!("{end}inner-radius");
    let (outer_radius, inner_radius) = (v.number(&format!("{end}outer-radius"))?, v.number(&inner)?);
    if inner_radius >= outer_radius {
        let message = format!("must be less than the outer radius {outer_radius} m, but is {inner_radius} m");
        return Err(Fault::new(inner, message).into());
    }
    Ok(Shape::Tube { outer_radius, inner_radius })
}
