//! What a small motion moves: for the shares of a mode.
//!
//! Seen without an axis of rotation displacements are along x, y and z. About an axis those of a beam are along its tangent, across it
//! towards the axis of rotation (flap), and across both (chord), or, of a shaft along the axis, across it (bending), and rotations of its sections
//! count by how they move their direction; those of a body are along the radius, the axis and the circumference. What a beam moves is also told along the axes of its sections.

use super::axis::Axis;
use super::system::Multibody;
use crate::linalg::Vec3;
use crate::system::{Direction, State};

/// Sine of the angle with the axis of rotation up to which a beam is a shaft.
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
        let mut vector = |[u, mu]: [Vec3; 2], along: Vec3, is_beam: bool| {
            let Some(axis) = axis else {
                let names = [Direction::X, Direction::Y, Direction::Z];
                names.into_iter().enumerate().for_each(|(k, direction)| add(direction, u[k] * mu[k]));
                return;
            };
            let e = axis.direction;
            let across = e - e.dot(along) * along;
            let size = across.dot(across).sqrt();
            let part = |d: Vec3| u.dot(d) * mu.dot(d);
            add(Direction::Axial, part(along));
            if is_beam && size <= ALONG {
                add(Direction::Bending, u.dot(mu) - part(along));
                return;
            }
            let flap = if size > 0.0 { 1.0 / size * across } else { Vec3::ZERO };
            add(Direction::Flap, part(flap));
            add(Direction::Chord, u.dot(mu) - part(along) - part(flap));
        };
        let both = |at: usize| [Vec3::at(x, at), Vec3::at(mx, at)];
        for i in 0..self.placed.len() {
            let radial = axis.map_or(Vec3::ZERO, |axis| {
                let arm = Vec3::at(&s.q, 7 * i) - axis.point;
                let arm = arm - arm.dot(axis.direction) * axis.direction;
                let length = arm.dot(arm).sqrt();
                if length > 0.0 { 1.0 / length * arm } else { Vec3::ZERO }
            });
            vector(both(6 * i), radial, false);
        }
        let mut section = [0.0; 3];
        for (of, &[q, v]) in self.constants.model.beams.iter().zip(&self.constants.beams) {
            for node in 0..of.beam.nodes().len() {
                let axes = of.beam.node(node, &s.q[q..]).rotation;
                let at = v + of.beam.place(node)[1];
                // A rotation φ moves the direction of the section by φ × t.
                let swing = |of: Vec3| axes * of.cross(Vec3::AXES[0]);
                let slope = if of.beam.has_shear() { both(at + 3).map(swing) } else { both(at + 3) };
                for moved in [both(at), slope] {
                    vector(moved, axes.column(0), true);
                    let local = moved.map(|u| axes.transpose() * u);
                    (0..3).for_each(|k| section[k] += local[0][k] * local[1][k]);
                }
            }
        }
        section.into_iter().enumerate().for_each(|(axis, part)| add(Direction::Section(axis), part));
        for i in 0..self.placed.len() {
            add(Direction::Rotation, Vec3::at(x, 6 * i + 3).dot(Vec3::at(mx, 6 * i + 3)));
        }
        for (of, &[_, v]) in self.constants.model.beams.iter().zip(&self.constants.beams) {
            for node in 0..of.beam.nodes().len() {
                let at = v + of.beam.place(node)[1];
                let about = if of.beam.has_shear() {
                    at + 3..at + 4
                } else {
                    at + 6..(v + of.beam.place(node + 1)[1]).min(v + of.beam.velocities())
                };
                about.for_each(|i| add(Direction::Torsion, x[i] * mx[i]));
            }
        }
    }
}
