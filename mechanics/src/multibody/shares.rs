//! What a small motion moves: for the shares of a mode.
//!
//! Seen without an axis of rotation displacements are along x, y and z. About an axis those of a beam are along its tangent, across it
//! towards the axis of rotation (flap), and across both (chord); those of a body are along the radius, the axis and the
//! circumference.

use super::axis::Axis;
use super::body::three;
use super::rotation::{Vector, plus, times};
use super::slender::ELEMENT_VELOCITIES;
use super::system::Multibody;
use crate::linalg::vector::inner;
use crate::system::{Direction, State};

/// Sine of the angle with the axis of rotation below which a direction across a beam is no more one of flap than one of chord.
const ALONG: f64 = 0.05;

impl Multibody {
    /// Calls `add` with the parts of xᵀ(Mx) by direction.
    pub(super) fn shares_about(
        &self,
        s: &State,
        axis: Option<&Axis>,
        [x, mx]: [&[f64]; 2],
        add: &mut dyn FnMut(Direction, f64),
    ) {
        let mut point = |at: usize, along: Vector| {
            let (u, mu) = (three(x, at), three(mx, at));
            let Some(axis) = axis else {
                let names = [Direction::X, Direction::Y, Direction::Z];
                names.into_iter().enumerate().for_each(|(k, direction)| add(direction, u[k] * mu[k]));
                return;
            };
            let e = axis.direction;
            let across = plus(e, -inner(e, along), along);
            let size = inner(across, across).sqrt();
            let flap = if size > ALONG { times(1.0 / size, across) } else { [0.0; 3] };
            let part = |d: Vector| inner(u, d) * inner(mu, d);
            add(Direction::Axial, part(along));
            add(Direction::Flap, part(flap));
            add(Direction::Chord, inner(u, mu) - part(along) - part(flap));
        };
        for i in 0..self.placed.len() {
            let radial = axis.map_or([0.0; 3], |axis| {
                let arm = plus(three(&s.q, 7 * i), -1.0, axis.point);
                let arm = plus(arm, -inner(arm, axis.direction), axis.direction);
                let length = inner(arm, arm).sqrt();
                if length > 0.0 { times(1.0 / length, arm) } else { [0.0; 3] }
            });
            point(6 * i, radial);
        }
        for (of, &[q, v]) in self.constants.model.beams.iter().zip(&self.constants.beams) {
            for node in 0..of.beam.nodes().len() {
                let tangent = of.beam.node(node, &s.q[q..]).1.tangent;
                let at = v + ELEMENT_VELOCITIES * node;
                point(at, tangent);
                point(at + 3, tangent);
            }
        }
        for i in 0..self.placed.len() {
            add(Direction::Rotation, inner(three(x, 6 * i + 3), three(mx, 6 * i + 3)));
        }
        for (of, &[_, v]) in self.constants.model.beams.iter().zip(&self.constants.beams) {
            for node in 0..of.beam.nodes().len() {
                let at = v + ELEMENT_VELOCITIES * node;
                let end = (at + 8).min(v + of.beam.velocities());
                (at + 6..end).for_each(|i| add(Direction::Torsion, x[i] * mx[i]));
            }
        }
    }
}
