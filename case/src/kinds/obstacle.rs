//! Contacts of a system in space: points of bodies and beams, and the obstacles that they may touch.

use super::contact::{LAW, MOST_POINTS, MOTION, motion};
use super::spatial::{name, optional_vector, vector};
use crate::declaration::{Bound::*, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Made, both};
use crate::kind::{Choice, Context, Kind, Table};
use crate::units::{FACTOR, LENGTH};
use crate::values::Values;
use flexion::contact::{Circle, Law, Obstacle, Plane, Sphere};
use flexion::multibody::rotation::{Vector, times};
use std::sync::Arc;

type Shared = Arc<dyn Obstacle>;

/// The kinds of obstacle in space.
pub static OBSTACLE: Choice<Shared> = Choice {
    name: "obstacle in space",
    path: "contact.obstacle",
    summary: "rigid obstacle that a point of a system in space may touch",
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
                    "direction out of the obstacle, [0, 0, 1] if left out",
                ),
                MOTION,
            ],
            example: "contact=[{on='bar', obstacle={kind='plane', point=[0, 0, '-1 mm']}, law={kind='hertz', stiffness=1e4}}]",
            make: plane,
        },
        Kind {
            name: "cylinder",
            summary: "circular cylinder, or the outside of a hole",
            source: "",
            keys: &[
                key(
                    "centre",
                    Type::Quantities(&LENGTH, Any),
                    Empty,
                    "a point of its axis, the origin if left out",
                ),
                key(
                    "axis",
                    Type::Quantities(&FACTOR, Any),
                    Empty,
                    "direction of its axis, [0, 0, 1] if left out",
                ),
                key("radius", Quantity(&LENGTH, Positive), Required, "radius"),
                key("inside", Type::Boolean, Default::Boolean(false), "the point is inside, in a hole"),
                MOTION,
            ],
            example: "contact=[{on='bar', at=[1, 0, 0], obstacle={kind='cylinder', centre=[0, '1 mm', 0], radius='1001 mm', inside=true}, law={kind='hertz', stiffness=1e4}}]\nbody=[{name='bar', mass=2, position=[0.5, 0, 0], velocity=[0.1, 0, 0], inertia={kind='sphere', radius=0.1}}]\njoint=[]",
            make: |v, c| {
                let ((centre, axis), motion) =
                    both(both(vector(v, "centre"), direction(v, "axis")), motion(v, c, vector))?;
                let (radius, hollow) = (v.number("radius")?, v.boolean("inside")?);
                Ok(Arc::new(Circle { centre, axis, radius, hollow, motion }))
            },
        },
        Kind {
            name: "sphere",
            summary: "ball, a stop of a beam for one, or the inside of a hollow one",
            source: "",
            keys: &[
                key("centre", Type::Quantities(&LENGTH, Any), Empty, "its centre, the origin if left out"),
                key("radius", Quantity(&LENGTH, Positive), Required, "radius"),
                key("inside", Type::Boolean, Default::Boolean(false), "the point is inside"),
                MOTION,
            ],
            example: "contact=[{on='bar', obstacle={kind='sphere', centre=[0, 0, '-51 mm'], radius='50 mm'}, law={kind='hertz', stiffness=1e4}}]",
            make: |v, c| {
                let (centre, motion) = both(vector(v, "centre"), motion(v, c, vector))?;
                let (radius, hollow) = (v.number("radius")?, v.boolean("inside")?);
                Ok(Arc::new(Sphere { centre, radius, hollow, motion }))
            },
        },
    ],
};

/// A unit vector, along z where the key is left out.
fn direction(v: &Values, key: &str) -> Made<Vector> {
    let vector = optional_vector(v, key)?.unwrap_or([0.0, 0.0, 1.0]);
    let size = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    if !(size > 0.0 && size.is_finite()) {
        let message =
            "has no direction: its components are all zero, or too large or too small to be squared";
        return Err(Fault::new(key, message).into());
    }
    Ok(times(1.0 / size, vector))
}

fn plane(v: &Values, c: &Context<'_>) -> Made<Shared> {
    let ((point, normal), motion) =
        both(both(vector(v, "point"), direction(v, "normal")), motion(v, c, vector))?;
    Ok(Arc::new(Plane { point, normal, motion }))
}

/// A point of a part and what it may touch.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Name; empty where none is given.
    pub name: String,
    /// Name of the part.
    pub on: String,
    /// The point, in space at the start \[m\].
    pub at: Option<Vector>,
    /// Radius of the ball about the point, or of the beam \[m\].
    pub radius: f64,
    /// Into how many equal parts its points cut a beam that may touch everywhere; the stiffness of a force is then one per length.
    pub points: Option<usize>,
    /// The obstacle.
    pub obstacle: Shared,
    /// What happens at a touch.
    pub law: Law,
}

/// The tables `[[contact]]` of a system in space.
pub static CONTACT: Table<Contact> = Table {
    key: key(
        "contact",
        Type::Tables(&[
            key(
                "name",
                Type::Text,
                Optional,
                "name, which begins the names of its columns: `contact`, `contact2`, … if left out",
            ),
            key(
                "on",
                Type::Text,
                Required,
                "body, place of a beam, or a beam, which touches where it is nearest to the obstacle, or with `points`: `ball`, `blade.tip`, \
                 `blade`",
            ),
            key(
                "at",
                Type::Quantities(&LENGTH, Any),
                Empty,
                "point of a body that may touch, in space at the start; its centre of mass if left out",
            ),
            key(
                "radius",
                Quantity(&LENGTH, NotNegative),
                Default::Number(0.0),
                "radius of the ball about the point, which slides and rolls on the obstacle, or of a beam that is round",
            ),
            key(
                "points",
                Type::Integer(1, MOST_POINTS),
                Optional,
                "of a beam that may touch at many places at once (`on` names it alone): number of equidistant points, the last at the tip, and one more at \
                 the root where no joint holds it",
            ),
            key("obstacle", Type::Kind(&OBSTACLE), Required, "rigid obstacle"),
            key("law", Type::Kind(&LAW), Required, "what happens at a touch"),
        ]),
        Empty,
        "points that may touch obstacles",
    ),
    example: "contact=[{name='floor', on='bar', at=[1, 0, 0], obstacle={kind='plane', point=[0, 0, '-2 mm'], normal=[0, 0.1, 1]}, law={kind='constraint', restitution=0.5}}]",
    make: |v, c| {
        let (obstacle, (law, massless)) = both(OBSTACLE.make(v, "obstacle", c), LAW.make(v, "law", c))?;
        if massless {
            let message = "only the tip of a planar beam can do without mass";
            let help = "write `law = { kind = \"constraint\", restitution = 0.5 }`";
            return Err(Fault::new("law.kind", message).help(help).into());
        }
        let (name, on) = (name(v, Some("contact"))?, v.text("on")?.to_owned());
        let points = if v.optional("points")?.is_some() { Some(v.count("points")?) } else { None };
        let (at, radius) = (optional_vector(v, "at")?, v.number("radius")?);
        Ok(Contact { name, on, at, radius, points, obstacle, law })
    },
};
