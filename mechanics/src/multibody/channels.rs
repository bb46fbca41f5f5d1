//! Names of the recorded quantities.

use super::joint::{Coordinate, Drive};
use super::model::Model;
use crate::system::{Channel, Role};

/// The recorded quantities, in the order in which they are written.
pub(super) fn channels(model: &Model, coordinates: &[Option<Coordinate>]) -> Vec<Channel> {
    let mut channels = Vec::new();
    let mut add = |role, name: String, unit: &'static str, meaning: String| {
        channels.push(Channel { name, unit, meaning, role });
    };
    let axes = ["x", "y", "z"];
    for body in &model.bodies {
        let name = &body.name;
        for (quantity, unit, what) in [
            ("position", "m", "position of the frame"),
            ("velocity", "m/s", "velocity of the frame"),
            ("spin", "rad/s", "angular velocity"),
        ] {
            let role = if quantity == "position" { Role::Primary } else { Role::Detail };
            for axis in axes {
                add(
                    role,
                    format!("{name}.{quantity}.{axis}"),
                    unit,
                    format!("{what} of {name}, along {axis}"),
                );
            }
        }
        for part in ["w", "x", "y", "z"] {
            let meaning = format!("rotation of {name}: component {part} of the unit quaternion");
            add(Role::Detail, format!("{name}.rotation.{part}"), "", meaning);
        }
    }
    for (joint, coordinate) in model.joints.iter().zip(coordinates) {
        let name = &joint.name;
        for (quantity, unit) in [("force", "N"), ("moment", "N*m")] {
            for axis in axes {
                let meaning = format!("{quantity} of joint {name} on its second part, along {axis}");
                add(Role::Detail, format!("{name}.{quantity}.{axis}"), unit, meaning);
            }
        }
        if let Some(coordinate) = coordinate {
            let (quantity, units, drive) = match coordinate {
                Coordinate::Angle => ("angle", ["rad", "rad/s", "N*m"], "torque"),
                Coordinate::Displacement => ("displacement", ["m", "m/s", "N"], "thrust"),
            };
            add(
                Role::Secondary,
                format!("{name}.{quantity}"),
                units[0],
                format!("{quantity} of joint {name}"),
            );
            add(Role::Secondary, format!("{name}.speed"), units[1], format!("rate of {name}.{quantity}"));
            if !matches!(joint.drive, Drive::None) {
                add(
                    Role::Secondary,
                    format!("{name}.{drive}"),
                    units[2],
                    format!("{drive} of the drive of {name}"),
                );
            }
        }
    }
    for axis in axes {
        add(
            Role::Detail,
            format!("momentum.{axis}"),
            "kg*m/s",
            format!("momentum of all bodies along {axis}"),
        );
    }
    for axis in axes {
        let meaning = format!("angular momentum of all bodies about the origin, along {axis}");
        add(Role::Detail, format!("angular_momentum.{axis}"), "kg*m^2/s", meaning);
    }
    add(Role::Energy, "energy.kinetic".into(), "J", "kinetic energy of all bodies".into());
    add(Role::Energy, "energy.strain".into(), "J", "energy of springs".into());
    add(Role::Energy, "energy.gravity".into(), "J", "potential energy, zero at the origin".into());
    channels
}
