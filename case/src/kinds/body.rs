//! Rigid bodies in space.

use super::damping::Rigid;
use super::name::name;
use super::vector::{ACROSS, AXIS, direction};
use crate::declaration::Bound::*;
use crate::fault::Made;
use crate::keys::{keys, kind, quantities, quantity, table, text, vector};
use crate::kind::{Choice, Context, Kind, Of, Table};
use crate::units::{ANGULAR_SPEED, INERTIA as MOMENT, LENGTH, MASS, VELOCITY};
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody;

/// The inertia tensor about the centre of mass of a body with this mass [kg·m²].
pub type Tensor = Box<dyn Fn(f64) -> Mat3>;

fn tensor(of: impl Fn(f64) -> Mat3 + 'static) -> Made<Tensor> {
    Ok(Box::new(of))
}

fn diagonal([x, y, z]: [f64; 3]) -> Mat3 {
    Mat3([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]])
}

keys! {
    struct Principal {
        /// principal moments of inertia about the first, second and third axis
        moments: [f64; 3] = quantities(&MOMENT, Positive);
    }

    struct Full {
        /// moments of inertia J₁₁, J₂₂, J₃₃
        moments: [f64; 3] = quantities(&MOMENT, Positive);
        /// entries J₂₃, J₁₃, J₁₂ of the tensor, −∫ y z dm, −∫ x z dm, −∫ x y dm
        products: [f64; 3] = quantities(&MOMENT, Any);
    }

    struct Edges {
        /// edges along the three axes
        size: [f64; 3] = quantities(&LENGTH, Positive);
    }

    struct Cylinder {
        /// radius
        radius: f64 = quantity(&LENGTH, Positive);
        /// length along the third axis
        length: f64 = quantity(&LENGTH, Positive);
    }

    struct Sphere {
        /// radius
        radius: f64 = quantity(&LENGTH, Positive);
    }
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
            example: "body=[{name='bar', mass=2, position=[0.5, 0, 0], spin=[1, 2, 3], inertia={kind='principal', moments=[0.1, 0.4, '0.5 kg*m^2']}}]",
            make: &Of(|k: Principal, _| tensor(move |_| diagonal(k.moments))),
        },
        Kind {
            name: "full",
            summary: "moments and products of inertia in the axes of the body",
            source: "",
            example: "body=[{name='bar', mass=2, position=[0.5, 0, 0], spin=[1, 2, 3], inertia={kind='full', moments=[0.1, 0.4, 0.45], products=[0.02, 0, -0.03]}}]",
            make: &Of(|Full { moments: [xx, yy, zz], products: [yz, xz, xy] }, _| {
                tensor(move |_| Mat3([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
            }),
        },
        Kind {
            name: "box",
            summary: "a homogeneous box",
            source: "",
            example: "body=[{name='bar', mass=2, position=[0.5, 0, 0], spin=[1, 2, 3], inertia={kind='box', size=['1 m', '2 cm', 0.1]}}]",
            make: &Of(|k: Edges, _| {
                let [a, b, c] = k.size.map(|x| x * x / 12.0);
                tensor(move |mass| diagonal([mass * (b + c), mass * (a + c), mass * (a + b)]))
            }),
        },
        Kind {
            name: "cylinder",
            summary: "a homogeneous cylinder about the third axis",
            source: "",
            example: "body=[{name='bar', mass=2, position=[0.5, 0, 0], spin=[1, 2, 3], axis=[0, 1, 1], inertia={kind='cylinder', radius='5 cm', length=1}}]",
            make: &Of(|Cylinder { radius, length }, _| {
                let across = radius * radius / 4.0 + length * length / 12.0;
                let along = radius * radius / 2.0;
                tensor(move |mass| diagonal([mass * across, mass * across, mass * along]))
            }),
        },
        Kind {
            name: "sphere",
            summary: "a homogeneous sphere",
            source: "",
            example: "body=[{name='bar', mass=2, position=[0.5, 0, 0], spin=[1, 2, 3], inertia={kind='sphere', radius='10 cm'}}]",
            make: &Of(|Sphere { radius }, _| tensor(move |mass| diagonal([0.4 * mass * radius * radius; 3]))),
        },
    ],
};

keys! {
    /// What a case says of a body.
    struct Written {
        /// name, which begins the names of its columns
        name: String = text();
        /// mass
        mass: f64 = quantity(&MASS, Positive);
        /// inertia about the centre of mass
        inertia: Tensor = kind(&INERTIA);
        /// centre of mass at the start, the origin if left out
        position: Vec3 = vector(&LENGTH);
        axis: Option<Vec3> = AXIS;
        across: Option<Vec3> = ACROSS;
        /// velocity of the centre of mass at the start; what the joints and the spin ask for, if left out
        velocity: Option<Vec3> = vector(&VELOCITY);
        /// angular velocity at the start, in the axes of space; what the joints ask for, if left out
        spin: Option<Vec3> = vector(&ANGULAR_SPEED);
        /// damping against the ground
        damping: Rigid = table();
    }
}

/// The tables `[[body]]`.
pub static BODY: Table<multibody::Body> = Table::list(
    "body",
    "rigid bodies, as they stand and move at the start",
    "body=[{name='bar', mass=2, position=[0.5, 0, 0], across=[1, 1, 0], inertia={kind='sphere', radius=0.1}, velocity=[0, '1 m/s', 0], spin=['10 deg/s', 0, 2], damping={mass='0.1 1/s'}}]\n\
     joint=[{kind='spherical', between=['ground', 'bar'], at=[0, 0, 0]}]",
    &Of(body),
);

fn body(k: Written, _: &Context<'_>) -> Made<multibody::Body> {
    let mut body = multibody::Body::new(name(Some(k.name), &["ground"])?.as_str(), k.mass, [1.0; 3]);
    body.inertia = (k.inertia)(k.mass);
    body.frame.position = k.position;
    body.frame.rotation = direction(k.axis, k.across)?;
    body.velocity = k.velocity;
    body.spin = k.spin;
    body.damping = k.damping.mass;
    Ok(body)
}
