//! The recorded quantities: what they are, and their values at a state.

use super::body::Body;
use super::flexible::Flexible;
use super::force::{Interaction, Spring};
use super::joint::{Coordinate, Drive, Joint};
use super::root_axes::put_seen;
use super::rotation::Quaternion;
use super::system::Multibody;
use crate::linalg::Vec3;
use crate::profile::HubKinematics;
use crate::system::{Channel, Frame, Kind, Role, Sink, State};

const AXES: [&str; 3] = ["x", "y", "z"];
const PARTS: [&str; 4] = ["w", "x", "y", "z"];

impl Multibody {
    /// Puts all recorded quantities of a state into a sink.
    pub(super) fn put(&mut self, s: &State, sink: &mut Sink<'_>) {
        let [linear, angular] = self.momenta(s);
        let constants = &*self.constants;
        let model = &constants.model;
        for (body, &place) in model.bodies.iter().zip(&constants.place) {
            let placed = &self.placed[place];
            let spin = placed.rotation * placed.spin;
            let arm = placed.rotation * body.centre;
            let velocity = placed.velocity - spin.cross(arm);
            put_body(body, &placed.frame(body.centre), [velocity, spin], sink);
        }
        for (of, &[i, j]) in model.beams.iter().zip(&constants.beams) {
            let (q, v) = (&s.q[i..], &s.v[j..]);
            for &station in &of.stations {
                if of.in_root_axes {
                    put_seen(of, station, [q, v], model.beams.len() == 1, sink);
                }
                put_station(of, station, [q, v], sink);
            }
            for fibre in &of.fibres {
                sink.put(of.fibre_strain(q, fibre), || {
                    let ([y, z], s, beam) = (fibre.place, fibre.station, &of.name);
                    let meaning = format!("axial strain of {beam} at s = {s} m, y = {y} m, z = {z} m");
                    Channel::new(Role::Secondary, format!("{beam}.{}.strain", fibre.name), "", meaning)
                });
            }
        }
        let mut work = Interaction::new();
        for (k, joint) in model.joints.iter().enumerate() {
            self.interact_joint(s, k, false, &mut work);
            put_joint(joint, [work.wrench[2], work.wrench[3]], sink);
            let (Some(coordinate), Some(motion)) = (constants.coordinates[k], self.coordinate(s, k)) else {
                continue;
            };
            let (position, rate) = motion;
            let effort = match &joint.drive {
                Drive::None => None,
                // The prescribed motion is the last row.
                Drive::Prescribed(_) => {
                    let last = constants.of_joint[k].clone().next_back();
                    let driving = last.filter(|i| constants.rows[*i].1.is_prescribed());
                    Some(driving.map_or(0.0, |i| s.lambda[i]))
                }
                Drive::Actuated(actuator) => {
                    let motion = HubKinematics { angle: position, speed: rate, acceleration: 0.0 };
                    Some(actuator.torque(&motion, s.time()).value)
                }
            };
            put_coordinate(joint, coordinate, motion, effort, sink);
        }
        for (k, spring) in model.springs.iter().enumerate() {
            let (a, b) = self.spring_ends(k);
            put_spring(spring, spring.length_and_force(a, b), sink);
        }
        sink.put_all(linear.0, AXES, |axis| {
            let meaning = format!("momentum of all bodies and beams along {axis}");
            Channel::new(Role::Detail, format!("momentum.{axis}"), "kg*m/s", meaning)
        });
        sink.put_all(angular.0, AXES, |axis| {
            let meaning = format!("angular momentum of all bodies and beams about the origin, along {axis}");
            Channel::new(Role::Detail, format!("angular_momentum.{axis}"), "kg*m^2/s", meaning)
        });
        let energy = self.energies(s);
        let mut put = |value, kind, name, meaning| {
            sink.put(value, || Channel::new(Role::Energy, name, "J", meaning).with_kind(kind));
        };
        put(energy.kinetic, Kind::KineticEnergy, "energy.kinetic", "kinetic energy of all bodies and beams");
        put(energy.strain, Kind::StrainEnergy, "energy.strain", "energy of beams and springs");
        put(energy.gravity, Kind::Real, "energy.gravity", "potential energy, zero at the origin");
    }
}

fn put_body(body: &Body, frame: &Frame, [velocity, spin]: [Vec3; 2], sink: &mut Sink<'_>) {
    let name = &body.name;
    let mut put = |values: Vec3, role, quantity, unit: &'static str, what| {
        sink.put_all(values.0, AXES, |axis| {
            let meaning = format!("{what} of {name}, along {axis}");
            Channel::new(role, format!("{name}.{quantity}.{axis}"), unit, meaning)
        });
    };
    put(frame.position, Role::Primary, "position", "m", "position of the frame");
    put(velocity, Role::Detail, "velocity", "m/s", "velocity of the frame");
    put(spin, Role::Detail, "spin", "rad/s", "angular velocity");
    sink.put_all(Quaternion::from(frame.rotation).0, PARTS, |part| {
        let meaning = format!("rotation of {name}: component {part} of the unit quaternion");
        Channel::new(Role::Detail, format!("{name}.rotation.{part}"), "", meaning).with_kind(Kind::Quaternion)
    });
}

fn put_station(of: &Flexible, station: f64, [q, v]: [&[f64]; 2], sink: &mut Sink<'_>) {
    let (frame, start) = (of.frame(q, station), of.frame(of.beam.initial(), station));
    let name = |quantity: &str| format!("{}.{}.{quantity}", of.name, of.station_name(station));
    let at = || format!("of {} at s = {station} m", of.name);
    let mut put = |values: Vec3, role, quantity: &str, unit: &'static str, what: &str| {
        sink.put_all(values.0, AXES, |axis| {
            let meaning = format!("{what} {}, along {axis}", at());
            Channel::new(role, name(&format!("{quantity}.{axis}")), unit, meaning)
        });
    };
    put(frame.position, Role::Detail, "position", "m", "position");
    let displacement = frame.position - start.position;
    let role = if of.in_root_axes { Role::Detail } else { Role::Primary };
    put(displacement, role, "displacement", "m", "displacement since the state without stress");
    put(of.beam.velocity(v, station), Role::Detail, "velocity", "m/s", "velocity");
    sink.put_all(Quaternion::from(frame.rotation).0, PARTS, |part| {
        let meaning = format!("rotation of the section {}: component {part} of the unit quaternion", at());
        Channel::new(Role::Detail, name(&format!("rotation.{part}")), "", meaning).with_kind(Kind::Quaternion)
    });
    let sample = of.beam.sample(q, station);
    let [strain, shear_n, shear_b, torsion, about_n, about_b] = sample.strain;
    let [force, force_n, force_b, torque, moment_n, moment_b] = sample.stress;
    let mut put = |value, quantity: &str, unit: &'static str, what: &str| {
        sink.put(value, || Channel::new(Role::Detail, name(quantity), unit, format!("{what} {}", at())));
    };
    put(force, "axial_force", "N", "axial force N");
    put(torque, "torque", "N*m", "torque M₁ about the tangent");
    put(moment_n, "moment.n", "N*m", "bending moment M₂ about the second axis of the section");
    put(moment_b, "moment.b", "N*m", "bending moment M₃ about the third axis of the section");
    put(strain, "axial_strain", "", "axial strain ε");
    put(torsion, "torsion", "1/m", "torsion κ₁");
    put(about_n, "curvature.n", "1/m", "curvature κ₂ about the second axis of the section");
    put(about_b, "curvature.b", "1/m", "curvature κ₃ about the third axis of the section");
    if of.beam.has_shear() {
        put(force_n, "shear_force.n", "N", "shear force Q₂ along the second axis of the section");
        put(force_b, "shear_force.b", "N", "shear force Q₃ along the third axis of the section");
        put(shear_n, "shear.n", "", "shear strain γ₂ along the second axis of the section");
        put(shear_b, "shear.b", "", "shear strain γ₃ along the third axis of the section");
    }
}

fn put_joint(joint: &Joint, [force, moment]: [Vec3; 2], sink: &mut Sink<'_>) {
    let name = &joint.name;
    for (values, quantity, unit) in [(force, "force", "N"), (moment, "moment", "N*m")] {
        sink.put_all(values.0, AXES, |axis| {
            let meaning = format!("{quantity} of joint {name} on its second part, along {axis}");
            Channel::new(Role::Detail, format!("{name}.{quantity}.{axis}"), unit, meaning)
        });
    }
}

fn put_coordinate(
    joint: &Joint,
    coordinate: Coordinate,
    (position, rate): (f64, f64),
    effort: Option<f64>,
    sink: &mut Sink<'_>,
) {
    let name = &joint.name;
    let (quantity, units, drive) = match coordinate {
        Coordinate::Angle => ("angle", ["rad", "rad/s", "N*m"], "torque"),
        Coordinate::Displacement => ("displacement", ["m", "m/s", "N"], "thrust"),
    };
    let channel = |quantity, unit: &'static str, meaning| {
        Channel::new(Role::Secondary, format!("{name}.{quantity}"), unit, meaning)
    };
    sink.put(position, || channel(quantity, units[0], format!("{quantity} of joint {name}")));
    sink.put(rate, || channel("speed", units[1], format!("rate of {name}.{quantity}")));
    if let Some(effort) = effort {
        sink.put(effort, || channel(drive, units[2], format!("{drive} of the drive of {name}")));
    }
}

fn put_spring(spring: &Spring, [length, force]: [f64; 2], sink: &mut Sink<'_>) {
    let name = &spring.name;
    sink.put(length, || {
        Channel::new(Role::Secondary, format!("{name}.length"), "m", format!("length of {name}"))
    });
    sink.put(force, || {
        let meaning = format!("force of {name}, positive where it pulls its ends together");
        Channel::new(Role::Secondary, format!("{name}.force"), "N", meaning)
    });
}
