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
    for beam in &model.beams {
        for &station in &beam.stations {
            let name = format!("{}.{}", beam.name, beam.station_name(station));
            let at = format!("of {} at s = {station} m", beam.name);
            for (quantity, unit, what) in [
                ("position", "m", "position"),
                ("displacement", "m", "displacement since the state without stress"),
                ("velocity", "m/s", "velocity"),
            ] {
                let role = if quantity == "displacement" { Role::Primary } else { Role::Detail };
                for axis in axes {
                    add(
                        role,
                        format!("{name}.{quantity}.{axis}"),
                        unit,
                        format!("{what} {at}, along {axis}"),
                    );
                }
            }
            for part in ["w", "x", "y", "z"] {
                let meaning =
                    format!("rotation of the section {at}: component {part} of the unit quaternion");
                add(Role::Detail, format!("{name}.rotation.{part}"), "", meaning);
            }
            for (quantity, unit, what) in [
                ("axial_force", "N", "axial force N"),
                ("torque", "N*m", "torque M₁ about the tangent"),
                ("moment.n", "N*m", "bending moment M₂ about the second axis of the section"),
                ("moment.b", "N*m", "bending moment M₃ about the third axis of the section"),
                ("axial_strain", "", "axial strain ε"),
                ("torsion", "1/m", "torsion κ₁"),
                ("curvature.n", "1/m", "curvature κ₂ about the second axis of the section"),
                ("curvature.b", "1/m", "curvature κ₃ about the third axis of the section"),
            ] {
                add(Role::Detail, format!("{name}.{quantity}"), unit, format!("{what} {at}"));
            }
        }
        for fibre in &beam.fibres {
            let ([y, z], s) = (fibre.place, fibre.station);
            let meaning = format!("axial strain of {} at s = {s} m, y = {y} m, z = {z} m", beam.name);
            add(Role::Secondary, format!("{}.{}.strain", beam.name, fibre.name), "", meaning);
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
    for spring in &model.springs {
        let name = &spring.name;
        add(Role::Secondary, format!("{name}.length"), "m", format!("length of {name}"));
        add(
            Role::Secondary,
            format!("{name}.force"),
            "N",
            format!("force of {name}, positive where it pulls its ends together"),
        );
    }
    for axis in axes {
        add(
            Role::Detail,
            format!("momentum.{axis}"),
            "kg*m/s",
            format!("momentum of all bodies and beams along {axis}"),
        );
    }
    for axis in axes {
        let meaning = format!("angular momentum of all bodies and beams about the origin, along {axis}");
        add(Role::Detail, format!("angular_momentum.{axis}"), "kg*m^2/s", meaning);
    }
    add(Role::Energy, "energy.kinetic".into(), "J", "kinetic energy of all bodies and beams".into());
    add(Role::Energy, "energy.strain".into(), "J", "energy of beams and springs".into());
    add(Role::Energy, "energy.gravity".into(), "J", "potential energy, zero at the origin".into());
    channels
}
