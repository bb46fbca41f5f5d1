//! Rigid obstacles.

use super::amplitude::{CHANGE, amplitude};
use super::vector::{unit, vector};
use crate::declaration::{Bound::*, Key, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Faults, Made, both};
use crate::kind::{Choice, Context, Kind};
use crate::units::{ANGLE, FACTOR, LENGTH};
use crate::values::Values;
use flexion::contact::{Circle, Obstacle, Plane, Sphere, Translation};
use flexion::linalg::Vec3;
use flexion::profile::jumping_derivative;
use std::sync::Arc;

/// An obstacle.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Its surface, in axes of what it is fixed to.
    pub obstacle: Arc<dyn Obstacle>,
    /// Whether its part in the plane of x and y is all that a point of this plane sees of it.
    pub planar: bool,
    /// Whether it is a stop beside the beam, which the hub carries.
    pub stop: bool,
    /// The key of a direction that is left out, and then taken as in the plane of x and y.
    pub assumed: Option<&'static str>,
}

/// The motion of an obstacle; `None` for one at rest.
fn motion(v: &Values, c: &Context<'_>) -> Made<Option<Translation>> {
    let Some(_) = v.optional("motion")? else { return Ok(None) };
    let v = v.table("motion")?;
    let made = || {
        let (direction, profile) = both(vector(v, "displacement"), amplitude(v, c))?;
        let Some(displacement) = profile else {
            let message = "a constant amplitude is no motion: the obstacle keeps its place";
            let help =
                "give the amplitude as a `ramp`, a `table` or an `expression`, or leave the motion out";
            return Err(Fault::new(CHANGE.name, message).help(help).into());
        };
        let duration = c.duration()?;
        let within = |t: &&f64| **t > 0.0 && **t <= duration;
        let jumps = |t: &&f64| jumping_derivative(displacement.as_ref(), **t) == 0;
        if let Some(time) = displacement.breaks().iter().filter(within).find(jumps) {
            let message =
                format!("the displacement of the obstacle jumps at t = {time} s, which no motion does");
            return Err(Fault::new(CHANGE.name, message).into());
        }
        Ok(Some(Translation { direction, displacement }))
    };
    made().map_err(|faults: Faults| faults.within("motion"))
}

/// Keys of the motion of an obstacle.
static MOVED: [Key; 2] = [
    key(
        "displacement",
        Type::Quantities(&LENGTH, Any),
        Required,
        "components of the displacement at the amplitude 1",
    ),
    CHANGE,
];
const MOTION: Key = key(
    "motion",
    Type::Table(&MOVED),
    Optional,
    "prescribed translation of the obstacle, at rest if left out",
);

/// An obstacle that is fixed where its mount is said.
fn placed(
    obstacle: Arc<dyn Obstacle>,
    motion: &Option<Translation>,
    planar: bool,
    assumed: Option<&'static str>,
) -> Placed {
    let stays = motion.as_ref().is_none_or(|motion| motion.direction[2] == 0.0);
    Placed { obstacle, planar: planar && stays, stop: false, assumed }
}

const CENTRE: &str = "centre";

/// The kinds of obstacle.
pub static OBSTACLE: Choice<Placed> = Choice {
    name: "obstacle",
    path: "contact.obstacle",
    summary: "rigid obstacle that a point may touch",
    kinds: &[
        Kind {
            name: "plane",
            summary: "half-space behind a plane",
            source: "",
            keys: &[
                key(
                    "point",
                    Type::Quantities(&LENGTH, Any),
                    Empty,
                    "a point of the plane, the origin if left out",
                ),
                key(
                    "normal",
                    Type::Quantities(&FACTOR, Any),
                    Empty,
                    "direction out of the obstacle; [0, 1, 0] if left out for a beam on a hub",
                ),
                key(
                    "angle",
                    Quantity(&ANGLE, Any),
                    Optional,
                    "angle about z from the x axis to the plane, in the place of `normal`; the free side is to its left",
                ),
                MOTION,
            ],
            example: "contact=[{obstacle={kind='plane', point=[0, '1 mm'], angle='180 deg'}, law={kind='hertz', stiffness=1e5}}]",
            make: |v, c| {
                let (point, motion) = both(vector(v, "point"), motion(v, c))?;
                let plane = match (unit(v, "normal")?, v.optional_number("angle")?) {
                    (Some(_), Some(_)) => {
                        let fault = Fault::new("angle", "says the same as `normal`: leave one of them out");
                        return Err(fault.into());
                    }
                    (Some(normal), None) => Plane { point, normal, motion: motion.clone() },
                    (None, angle) => Plane::inclined(point, angle.unwrap_or(0.0), motion.clone()),
                };
                let planar = plane.normal[2] == 0.0;
                let assumed = !(v.is_written("normal") || v.has("angle"));
                Ok(placed(Arc::new(plane), &motion, planar, assumed.then_some("normal")))
            },
        },
        Kind {
            name: "cylinder",
            summary: "circular cylinder, or the outside of a hole; in the plane a disc",
            source: "",
            keys: &[
                key(
                    CENTRE,
                    Type::Quantities(&LENGTH, Any),
                    Empty,
                    "a point of its axis, the origin if left out",
                ),
                key(
                    "axis",
                    Type::Quantities(&FACTOR, Any),
                    Empty,
                    "direction of its axis; [0, 0, 1] if left out for a beam on a hub",
                ),
                key("radius", Quantity(&LENGTH, Positive), Required, "radius"),
                key("inside", Type::Boolean, Default::Boolean(false), "the point is inside, in a hole"),
                MOTION,
            ],
            example: "contact=[{obstacle={kind='cylinder', centre=[2, '501 mm'], radius='500 mm'}, law={kind='hertz', stiffness=1e5}}]",
            make: |v, c| {
                let ((centre, axis), motion) = both(both(vector(v, CENTRE), unit(v, "axis")), motion(v, c))?;
                let assumed = axis.is_none().then_some("axis");
                let axis = axis.unwrap_or(Vec3([0.0, 0.0, 1.0]));
                let (radius, hollow) = (v.number("radius")?, v.boolean("inside")?);
                let cylinder = Circle { centre, axis, radius, hollow, motion: motion.clone() };
                Ok(placed(Arc::new(cylinder), &motion, axis[0] == 0.0 && axis[1] == 0.0, assumed))
            },
        },
        Kind {
            name: "sphere",
            summary: "ball, or the inside of a hollow one",
            source: "",
            keys: &[
                key(CENTRE, Type::Quantities(&LENGTH, Any), Empty, "its centre, the origin if left out"),
                key("radius", Quantity(&LENGTH, Positive), Required, "radius"),
                key("inside", Type::Boolean, Default::Boolean(false), "the point is inside"),
                MOTION,
            ],
            example: "contact=[{obstacle={kind='sphere', centre=[1.9, '-51 mm'], radius='50 mm'}, law={kind='hertz', stiffness=1e4}}]",
            make: |v, c| {
                let (centre, motion) = both(vector(v, CENTRE), motion(v, c))?;
                let (radius, hollow) = (v.number("radius")?, v.boolean("inside")?);
                let sphere = Sphere { centre, radius, hollow, motion: motion.clone() };
                Ok(placed(Arc::new(sphere), &motion, centre[2] == 0.0, None))
            },
        },
        Kind {
            name: "stop",
            summary: "stop beside the beam, fixed to the hub: bounds the deflection of the station",
            source: "",
            keys: &[key(
                "offset",
                Quantity(&LENGTH, Any),
                Required,
                "height of the stop over the axis of the undeformed beam: positive on the side of y, negative on the other",
            )],
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='hertz', stiffness=1e5}}]",
            make: |v, _| {
                let offset = v.number("offset")?;
                if offset == 0.0 {
                    let message = "a stop at the offset 0 is on neither side of the beam";
                    let help =
                        "for a stop that touches the undeformed beam take a `plane` with the mount `hub`";
                    return Err(Fault::new("offset", message).help(help).into());
                }
                let plane = Plane {
                    point: Vec3([0.0, offset, 0.0]),
                    normal: Vec3([0.0, -offset.signum(), 0.0]),
                    motion: None,
                };
                Ok(Placed { obstacle: Arc::new(plane), planar: true, stop: true, assumed: None })
            },
        },
    ],
};
