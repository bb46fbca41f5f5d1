//! Velocities at the start: those that are given, and of what is left out those of rigid motions that the joints ask for.
//!
//! A beam that a joint turns begins to turn with it as a rigid body, and not at rest behind a root that moves: every part has
//! the twist (velocity of its origin, angular velocity) of least kinetic energy among those that obey the joints, and of what is given of it
//! it keeps all that the joints allow. What then is left of the rates of the rows goes to the nearest velocities.

use super::body::{Body, Twist};
use super::constants::Constants;
use super::error::ModelError;
use super::flexible::Flexible;
use super::marker::{Marker, Part};
use super::model::Model;
use super::{consistency, joint::Joint};
use crate::linalg::{Mat3, Vec3};
use crate::system::{Dynamics, Frame, RowWeights, State};
use std::sync::Arc;

/// Mass and inertia of what is given, over those of what is left out: it gives way only where the joints leave nothing else.
const GIVEN: f64 = 1e12;

/// Part of the largest rate of a row, and of the largest velocity, that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// A system of a model, if it has one, with its constants.
pub(super) type Assembled = (Box<dyn Dynamics>, Arc<Constants>);

/// The velocities of the start, and what the joints have changed of those given. `assemble` makes the system of a model of rigid bodies.
pub(super) fn velocities(
    system: &mut dyn Dynamics,
    constants: &Constants,
    assemble: impl Fn(Model) -> Option<Assembled>,
) -> Result<(Vec<f64>, Vec<String>), ModelError> {
    let given = constants.start(&[]);
    let start = if obeys(system, &given) {
        given
    } else {
        match rigid(&constants.model, assemble) {
            Some(twists) => constants.start(&twists),
            None => given,
        }
    };
    let used = consistency::velocities(system, &start)?;
    let changes = consistency::changes(constants, &start, &used);
    Ok((used, changes))
}

/// Whether velocities obey the rows of the joints.
fn obeys(system: &mut dyn Dynamics, s: &State) -> bool {
    let mut rates = vec![0.0; s.lambda.len()];
    system.constraint(s, RowWeights::VELOCITY, &mut rates);
    let largest = |x: &[f64]| x.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    largest(&rates) <= ROUNDING * largest(&s.v)
}

/// The twists of bodies and beams, if all were rigid; `None` where joints then contradict each other.
fn rigid(model: &Model, assemble: impl Fn(Model) -> Option<Assembled>) -> Option<Vec<Twist>> {
    let mut rigid = Model { drop_redundant: true, ..Model::new() };
    rigid.bodies.extend(model.bodies.iter().map(weighted));
    rigid.bodies.extend(model.beams.iter().map(as_body));
    let marker = |of: Marker| match of.part {
        Part::Section { beam, .. } => {
            let section = model.frame(of.part)?;
            let position = section.position + section.rotation * of.frame.position;
            let rotation = section.rotation * of.frame.rotation;
            rigid.marker(Part::Body(model.bodies.len() + beam), Frame { position, rotation })
        }
        _ => Some(of),
    };
    let mut joints = Vec::with_capacity(model.joints.len());
    for joint in &model.joints {
        let (from, to) = (marker(joint.from)?, marker(joint.to)?);
        if from.part != to.part {
            joints.push(Joint { from, to, ..joint.clone() });
        }
    }
    rigid.joints = joints;
    let (mut system, constants) = assemble(rigid)?;
    let mut twists = Vec::new();
    // The second time for what the weights have taken of what is given.
    for _ in 0..2 {
        let v = consistency::velocities(system.as_mut(), &constants.start(&twists)).ok()?;
        let twist = |(body, place): (&Body, &usize)| {
            let r = body.frame.rotation;
            let spin = r * Vec3::at(&v, 6 * place + 3);
            [Vec3::at(&v, 6 * place) - spin.cross(r * body.centre), spin]
        };
        twists = constants.model.bodies.iter().zip(&constants.place).map(twist).collect();
    }
    Some(twists)
}

/// A body that keeps what is given.
fn weighted(body: &Body) -> Body {
    let weight = |given: Option<Vec3>| if given.is_some() { GIVEN } else { 1.0 };
    let inertia = weight(body.spin) * body.inertia;
    Body { mass: weight(body.velocity) * body.mass, inertia, ..body.clone() }
}

/// A beam as a rigid body with its frame at the root, in the axes of space. What is given is of the root, and so are then mass and inertia.
fn as_body(of: &Flexible) -> Body {
    let q = of.beam.initial();
    let root = of.beam.node(0, q).position;
    let mass = of.beam.mass();
    let given = of.velocity.is_some() || of.spin.is_some();
    let centre = if given { root } else { 1.0 / mass * of.beam.first_moment(q) };
    let arm = root - centre;
    let mut v = vec![0.0; of.beam.velocities()];
    let inertia = Mat3(Vec3::AXES.map(|spin| {
        of.beam.move_rigidly(spin.cross(arm), spin, q, &mut v);
        let [momentum, angular] = of.beam.momenta(q, &v);
        (angular - centre.cross(momentum)).0
    }));
    weighted(&Body {
        centre: -arm,
        inertia,
        frame: Frame { position: root, rotation: Mat3::IDENTITY },
        velocity: of.velocity,
        spin: of.spin,
        ..Body::new(&of.name, mass, [1.0; 3])
    })
}
