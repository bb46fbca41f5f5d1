//! Rigid bodies in space.

use super::damping::RIGID;
use super::name::name;
use super::vector::{MARKED, direction, optional_vector, vector};
use crate::declaration::{Bound::*, Key, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Made};
use crate::kind::{Choice, Context, Kind, Table};
use crate::units::{ANGULAR_SPEED, INERTIA as MOMENT, LENGTH, MASS, VELOCITY};
use crate::values::Values;
use flexion::linalg::Mat3;
use flexion::multibody;

/// The inertia tensor about the centre of mass of a body with this mass [kg·m²].
pub type Tensor = Box<dyn Fn(f64) -> Mat3>;

fn diagonal([x, y, z]: [f64; 3]) -> Mat3 {
    Mat3([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]])
}

const fn moments(doc: &'static str) -> Key {
    key("moments", Type::Quantities(&MOMENT, Positive), Required, doc)
}

fn three(v: &Values, key: &str) -> Made<[f64; 3]> {
    let list = v.numbers(key)?;
    list.try_into().map_err(|_| Fault::new(key, format!("takes 3 numbers, not {}", list.len())).into())
}

/// The inertia of a body.
pub static INERTIA: Choice<Tensor> = Choice {
    name: "inertia",
    path: "body.inertia",
    summary: "moments of inertia of a body about its centre of mass, in its axes",
    kinds: &[
        Kind {
            name: "principal",
            summary: "the axes of the body are principal axes",
            source: "",
            keys: &[moments("principal moments of inertia about the first, second and third axis")],
            example: "body=[{name='bar', mass=2, position=[0.5, 0, 0], spin=[1, 2, 3], inertia={kind='principal', moments=[0.1, 0.4, '0.5 kg*m^2']}}]",
            make: |v, _| {
                let moments = three(v, "moments")?;
                Ok(Box::new(move |_| diagonal(moments)))
            },
        },
        Kind {
            name: "full",
            summary: "moments and products of inertia in the axes of the body",
            source: "",
            keys: &[
                moments("moments of inertia J₁₁, J₂₂, J₃₃"),
                key(
                    "products",
                    Type::Quantities(&MOMENT, Any),
                    Required,
                    "entries J₂₃, J₁₃, J₁₂ of the tensor, −∫ y z dm, −∫ x z dm, −∫ x y dm",
                ),
            ],
            example: "body=[{name='bar', mass=2, position=[0.5, 0, 0], spin=[1, 2, 3], inertia={kind='full', moments=[0.1, 0.4, 0.45], products=[0.02, 0, -0.03]}}]",
            make: |v, _| {
                let ([xx, yy, zz], [yz, xz, xy]) = (three(v, "moments")?, three(v, "products")?);
                Ok(Box::new(move |_| Mat3([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])))
            },
        },
        Kind {
            name: "box",
            summary: "a homogeneous box",
            source: "",
            keys: &[key("size", Type::Quantities(&LENGTH, Positive), Required, "edges along the three axes")],
            example: "body=[{name='bar', mass=2, position=[0.5, 0, 0], spin=[1, 2, 3], inertia={kind='box', size=['1 m', '2 cm', 0.1]}}]",
            make: |v, _| {
                let [a, b, c] = three(v, "size")?.map(|x| x * x / 12.0);
                Ok(Box::new(move |mass| diagonal([mass * (b + c), mass * (a + c), mass * (a + b)])))
            },
        },
        Kind {
            name: "cylinder",
            summary: "a homogeneous cylinder about the third axis",
            source: "",
            keys: &[
                key("radius", Quantity(&LENGTH, Positive), Required, "radius"),
                key("length", Quantity(&LENGTH, Positive), Required, "length along the third axis"),
            ],
            example: "body=[{name='bar', mass=2, position=[0.5, 0, 0], spin=[1, 2, 3], axis=[0, 1, 1], inertia={kind='cylinder', radius='5 cm', length=1}}]",
            make: |v, _| {
                let (radius, length) = (v.number("radius")?, v.number("length")?);
                let across = radius * radius / 4.0 + length * length / 12.0;
                let along = radius * radius / 2.0;
                Ok(Box::new(move |mass| diagonal([mass * across, mass * across, mass * along])))
            },
        },
        Kind {
            name: "sphere",
            summary: "a homogeneous sphere",
            source: "",
            keys: &[key("radius", Quantity(&LENGTH, Positive), Required, "radius")],
            example: "body=[{name='bar', mass=2, position=[0.5, 0, 0], spin=[1, 2, 3], inertia={kind='sphere', radius='10 cm'}}]",
            make: |v, _| {
                let radius = v.number("radius")?;
                Ok(Box::new(move |mass| diagonal([0.4 * mass * radius * radius; 3])))
            },
        },
    ],
};

/// The tables `[[body]]`.
pub static BODY: Table<multibody::Body> = Table {
    key: key(
        "body",
        Type::Tables(&[
            key("name", Type::Text, Required, "name, which begins the names of its columns"),
            key("mass", Quantity(&MASS, Positive), Required, "mass"),
            key("inertia", Type::Kind(&INERTIA), Required, "inertia about the centre of mass"),
            key(
                "position",
                Type::Quantities(&LENGTH, Any),
                Empty,
                "centre of mass at the start, the origin if left out",
            ),
            MARKED[0],
            MARKED[1],
            key(
                "velocity",
                Type::Quantities(&VELOCITY, Any),
                Empty,
                "velocity of the centre of mass at the start; what the joints and the spin ask for, if left out",
            ),
            key(
                "spin",
                Type::Quantities(&ANGULAR_SPEED, Any),
                Empty,
                "angular velocity at the start, in the axes of space; what the joints ask for, if left out",
            ),
            key("damping", Type::Table(&RIGID), Empty, "damping against the ground"),
        ]),
        Empty,
        "rigid bodies, as they stand and move at the start",
    ),
    example: "body=[{name='bar', mass=2, position=[0.5, 0, 0], across=[1, 1, 0], inertia={kind='sphere', radius=0.1}, velocity=[0, '1 m/s', 0], spin=['10 deg/s', 0, 2], damping={mass='0.1 1/s'}}]\n\
              joint=[{kind='spherical', between=['ground', 'bar'], at=[0, 0, 0]}]",
    make: body,
};

fn body(v: &Values, c: &Context<'_>) -> Made<multibody::Body> {
    let mass = v.number("mass")?;
    let tensor = INERTIA.make(v, "inertia", c)?;
    let mut body = multibody::Body::new(name(v, &["ground"])?.as_str(), mass, [1.0; 3]);
    body.inertia = tensor(mass);
    body.frame.position = vector(v, "position")?;
    body.frame.rotation = direction(v)?;
    body.velocity = optional_vector(v, "velocity")?;
    body.spin = optional_vector(v, "spin")?;
    body.damping = v.table("damping")?.number("mass")?;
    Ok(body)
}
