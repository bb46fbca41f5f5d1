//! Rotary inertia of lumped masses on the exact coupling: a [`SectionRotation`] at each mass.

use super::beam::Mass;
use super::fields::{Fields, Point};
use super::inertia::{Border, Totals};
use super::section_rotation::SectionRotation;
use crate::linalg::Storage;
use crate::profile::HubKinematics;
use crate::system::{State, Weights};

/// The rotary inertia j of a mass on the axis.
#[derive(Debug)]
pub struct LumpedRotation {
    inertia: f64,
    /// a + x
    origin: f64,
    point: Point,
}

impl LumpedRotation {
    /// Those of `masses` that have rotary inertia; `radius` is the hub's \[m\].
    pub fn of(fields: &Fields, masses: &[Mass], radius: f64) -> Vec<LumpedRotation> {
        let rotating = masses.iter().filter(|m| m.inertia != 0.0);
        rotating
            .map(|m| LumpedRotation {
                inertia: m.inertia,
                origin: radius + m.station,
                point: fields.point(m.station, 1.0),
            })
            .collect()
    }

    fn rotation(&self, s: &State, hub: &HubKinematics) -> SectionRotation {
        let (x, y) = (&self.point.axial, &self.point.transverse);
        let at = |d: usize, u: &[f64]| [x.field(d, u), y.field(d, u)];
        let [u, v] = at(0, &s.q);
        let [u1, v1] = at(1, &s.q);
        SectionRotation::new(
            [self.origin + u, v],
            [1.0 + u1, v1],
            [at(0, &s.v), at(1, &s.v)],
            [at(0, &s.a), at(1, &s.a)],
            hub,
        )
    }

    /// Adds the forces to `r`.
    pub fn add_forces(&self, s: &State, hub: &HubKinematics, r: &mut [f64]) {
        let (_, on_slope) = self.rotation(s, hub).force(self.inertia, 0.0);
        self.scatter(on_slope, r);
    }

    /// Adds a force on p′ to a vector.
    fn scatter(&self, on_slope: [f64; 2], out: &mut [f64]) {
        for (shapes, c) in [&self.point.axial, &self.point.transverse].into_iter().zip(on_slope) {
            for (&i, slope) in shapes.index.iter().zip(&shapes.value[1]) {
                out[i] += c * slope;
            }
        }
    }

    /// Adds the tangent of [`LumpedRotation::add_forces`] to `out`.
    pub fn add_tangent(&self, s: &State, hub: &HubKinematics, w: &Weights<'_>, out: &mut Storage<f64>) {
        let rotation = self.rotation(s, hub);
        let shapes = [&self.point.axial, &self.point.transverse];
        for (c, columns) in shapes.iter().enumerate() {
            let (_, by) = rotation.derivative(unit(c), true, hub, w, self.inertia, 0.0);
            for (rows, by) in shapes.iter().zip(by) {
                for (&i, row) in rows.index.iter().zip(&rows.value[1]) {
                    for (&j, column) in columns.index.iter().zip(&columns.value[1]) {
                        out.add(i, j, by * row * column);
                    }
                }
            }
        }
    }

    /// Kinetic energy, angular momentum and torque.
    pub fn totals(&self, s: &State, hub: &HubKinematics) -> Totals {
        self.rotation(s, hub).totals(self.inertia, 0.0, hub)
    }

    /// Adds to the border of a free hub.
    pub fn add_border(&self, s: &State, hub: &HubKinematics, w: &Weights<'_>, out: &mut Border) {
        let rotation = self.rotation(s, hub);
        let (_, slope, torque) = rotation.by_hub(hub, w, self.inertia, 0.0);
        self.scatter(slope, &mut out.column);
        out.corner += torque;
        let row = [0, 1].map(|c| rotation.torque_derivative(unit(c), true, hub, w, self.inertia, 0.0));
        self.scatter(row, &mut out.row);
    }
}

fn unit(c: usize) -> [f64; 2] {
    let mut seed = [0.0; 2];
    seed[c] = 1.0;
    seed
}
