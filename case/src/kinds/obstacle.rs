//! Rigid obstacles.

use super::amplitude::CHANGE;
use super::vector::unit;
use crate::declaration::Bound::*;
use crate::fault::{Fault, Made, both};
use crate::keys::{Field, boolean, keys, quantity, table, vector};
use crate::kind::{Choice, Context, Kind, Of};
use crate::units::{ANGLE, FACTOR, LENGTH};
use flexion::contact::{Circle, Obstacle, Plane, Sphere, Translation};
use flexion::hub_beam::load::Amplitude;
use flexion::linalg::Vec3;
use flexion::profile::jumping_derivative;
use std::sync::Arc;

/// An obstacle.
#[derive(Clone, Debug)]
pub struct Mounted {
    /// Its surface, in axes of what it is fixed to.
    pub obstacle: Arc<dyn Obstacle>,
    /// Whether its part in the plane of x and y is all that a point of this plane sees of it.
    pub planar: bool,
    /// Whether it is a stop beside the beam, which the hub carries.
    pub stop: bool,
    /// The key of a direction that is left out, and then taken as in the plane of x and y.
    pub assumed: Option<&'static str>,
}

keys! {
    /// What a case says of the motion of an obstacle.
    struct Moved {
        /// components of the displacement at the amplitude 1
        displacement: Vec3 = vector(&LENGTH).required();
        amplitude: Amplitude = CHANGE;
    }
}

const MOTION: Field<Option<Moved>> =
    table().called("motion", "prescribed translation of the obstacle, at rest if left out");

/// The motion of an obstacle; `None` for one at rest.
fn motion(moved: Option<Moved>, c: &Context<'_>) -> Made<Option<Translation>> {
    let Some(Moved { displacement: direction, amplitude }) = moved else { return Ok(None) };
    let key = "motion.amplitude";
    let Some(displacement) = amplitude else {
        let message = "a constant amplitude is no motion: the obstacle keeps its place";
        let help = "give the amplitude as a `ramp`, a `table` or an `expression`, or leave the motion out";
        return Err(Fault::new(key, message).help(help).into());
    };
    let duration = c.duration()?;
    let within = |t: &&f64| **t > 0.0 && **t <= duration;
    let jumps = |t: &&f64| jumping_derivative(displacement.as_ref(), **t) == 0;
    if let Some(time) = displacement.breaks().iter().filter(within).find(jumps) {
        let message = format!("the displacement of the obstacle jumps at t = {time} s, which no motion does");
        return Err(Fault::new(key, message).into());
    }
    Ok(Some(Translation { direction, displacement }))
}

/// An obstacle that is fixed where its mount is said.
fn mounted(
    obstacle: Arc<dyn Obstacle>,
    motion: &Option<Translation>,
    planar: bool,
    assumed: Option<&'static str>,
) -> Mounted {
    let stays = motion.as_ref().is_none_or(|motion| motion.direction[2] == 0.0);
    Mounted { obstacle, planar: planar && stays, stop: false, assumed }
}

keys! {
    struct Flat {
        /// a point of the plane, the origin if left out
        point: Vec3 = vector(&LENGTH);
        /// direction out of the obstacle; [0, 1, 0] if left out for a beam on a hub
        normal: Option<Vec3> = vector(&FACTOR);
        /// angle about z from the x axis to the plane, in the place of `normal`; the free side is to its left
        angle: Option<f64> = quantity(&ANGLE, Any);
        motion: Option<Moved> = MOTION;
    }

    struct Cylinder {
        /// a point of its axis, the origin if left out
        centre: Vec3 = vector(&LENGTH);
        /// direction of its axis; [0, 0, 1] if left out for a beam on a hub
        axis: Option<Vec3> = vector(&FACTOR);
        /// radius
        radius: f64 = quantity(&LENGTH, Positive);
        /// the point is inside, in a hole
        inside: bool = boolean().or_false();
        motion: Option<Moved> = MOTION;
    }

    struct Ball {
        /// its centre, the origin if left out
        centre: Vec3 = vector(&LENGTH);
        /// radius
        radius: f64 = quantity(&LENGTH, Positive);
        /// the point is inside
        inside: bool = boolean().or_false();
        motion: Option<Moved> = MOTION;
    }

    pub(crate) struct Stop {
        /// height of the stop over the axis of the undeformed beam: positive on the side of y, negative on the other
        offset: f64 = quantity(&LENGTH, Any);
    }
}

/// The kinds of obstacle.
pub static OBSTACLE: Choice<Mounted> = Choice {
    name: "obstacle",
    path: "contact.obstacle",
    summary: "rigid obstacle that a point may touch",
    kinds: &[
        Kind {
            name: "plane",
            summary: "half-space behind a plane",
            source: "",
            example: "contact=[{obstacle={kind='plane', point=[0, '1 mm'], angle='180 deg'}, law={kind='hertz', stiffness=1e5}}]",
            make: &Of(|Flat { point, normal, angle, motion: moved }, c| {
                let (motion, assumed) = (motion(moved, c)?, normal.is_none() && angle.is_none());
                let plane = match (unit(normal, "normal")?, angle) {
                    (Some(_), Some(_)) => {
                        let fault = Fault::new("angle", "says the same as `normal`: leave one of them out");
                        return Err(fault.into());
                    }
                    (Some(normal), None) => Plane { point, normal, motion: motion.clone() },
                    (None, angle) => Plane::inclined(point, angle.unwrap_or(0.0), motion.clone()),
                };
                let planar = plane.normal[2] == 0.0;
                Ok(mounted(Arc::new(plane), &motion, planar, assumed.then_some("normal")))
            }),
        },
        Kind {
            name: "cylinder",
            summary: "circular cylinder, or the outside of a hole; in the plane a disc",
            source: "",
            example: "contact=[{obstacle={kind='cylinder', centre=[2, '501 mm'], radius='500 mm'}, law={kind='hertz', stiffness=1e5}}]",
            make: &Of(|Cylinder { centre, axis, radius, inside: hollow, motion: moved }, c| {
                let (axis, motion) = both(unit(axis, "axis"), motion(moved, c))?;
                let assumed = axis.is_none().then_some("axis");
                let axis = axis.unwrap_or(Vec3([0.0, 0.0, 1.0]));
                let cylinder = Circle { centre, axis, radius, hollow, motion: motion.clone() };
                Ok(mounted(Arc::new(cylinder), &motion, axis[0] == 0.0 && axis[1] == 0.0, assumed))
            }),
        },
        Kind {
            name: "sphere",
            summary: "ball, or the inside of a hollow one",
            source: "",
            example: "contact=[{obstacle={kind='sphere', centre=[1.9, '-51 mm'], radius='50 mm'}, law={kind='hertz', stiffness=1e4}}]",
            make: &Of(|Ball { centre, radius, inside: hollow, motion: moved }, c| {
                let motion = motion(moved, c)?;
                let sphere = Sphere { centre, radius, hollow, motion: motion.clone() };
                Ok(mounted(Arc::new(sphere), &motion, centre[2] == 0.0, None))
            }),
        },
        Kind {
            name: "stop",
            summary: "stop beside the beam, fixed to the hub: bounds the deflection of the station",
            source: "",
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='hertz', stiffness=1e5}}]",
            make: &Of(|Stop { offset }, _| {
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
                Ok(Mounted { obstacle: Arc::new(plane), planar: true, stop: true, assumed: None })
            }),
        },
    ],
};
