//! A viscous damper between a station of the beam and the ground.
//!
//! ```text
//! F = −c ṙ;   in the hub's frame v = (Ẋ − θ̇ Y, Ẏ + θ̇ X),   X = a + x + g_xᵀq,   Y = g_yᵀq
//! Q_q = −c (v_x g_x + v_y g_y),   Q_θ = −c (X v_y − Y v_x),   loss c |v|²
//! ```
//!
//! The displacement of the station is its linear part: exact without foreshortening and on a curve, and to first order in q
//! with foreshortening.

use super::Site;
use crate::hub_beam::fields::Shapes;
use crate::hub_beam::inertia::Border;
use crate::linalg::Storage;
use crate::profile::HubKinematics;
use crate::system::{State, Weights};

/// A damper, ready to be evaluated.
#[derive(Clone, Debug)]
pub struct Damper {
    /// c [N·s/m]
    coefficient: f64,
    /// a + x
    origin: f64,
    /// Functions of both fields at the station.
    shapes: [Shapes; 2],
}

impl Damper {
    /// A damper of coefficient c [N·s/m] at `station` \[m\].
    pub(super) fn new(site: &Site<'_>, station: f64, coefficient: f64) -> Damper {
        let point = site.fields.point(station, 1.0);
        Damper { coefficient, origin: site.radius + station, shapes: [point.axial, point.transverse] }
    }

    /// (X, Y) and v.
    fn moving(&self, s: &State, hub: &HubKinematics) -> ([f64; 2], [f64; 2]) {
        let [x, y] = [self.origin + self.shapes[0].field(0, &s.q), self.shapes[1].field(0, &s.q)];
        let [along, across] = [0, 1].map(|k: usize| self.shapes[k].field(0, &s.v));
        ([x, y], [along - hub.speed * y, across + hub.speed * x])
    }

    /// out += factor Q_q
    pub(super) fn add_force(&self, s: &State, hub: &HubKinematics, factor: f64, out: &mut [f64]) {
        let (_, v) = self.moving(s, hub);
        for (shapes, v) in self.shapes.iter().zip(v) {
            shapes.add(-factor * self.coefficient * v, out);
        }
    }

    /// Q_θ
    pub(super) fn torque(&self, s: &State, hub: &HubKinematics) -> f64 {
        let ([x, y], v) = self.moving(s, hub);
        -self.coefficient * (x * v[1] - y * v[0])
    }

    /// c |v|² \[W\]
    pub(super) fn dissipated(&self, s: &State, hub: &HubKinematics) -> f64 {
        let (_, v) = self.moving(s, hub);
        self.coefficient * (v[0] * v[0] + v[1] * v[1])
    }

    /// out += factor (w.v ∂Q_q/∂q̇ + w.q ∂Q_q/∂q)
    pub(super) fn add_tangent(
        &self,
        hub: &HubKinematics,
        w: &Weights<'_>,
        factor: f64,
        out: &mut Storage<f64>,
    ) {
        let c = factor * self.coefficient;
        let turning = c * w.q * hub.speed;
        let weights = [[-c * w.v, turning], [-turning, -c * w.v]];
        for (row, weights) in self.shapes.iter().zip(weights) {
            for (column, weight) in self.shapes.iter().zip(weights) {
                for (&i, a) in row.index.iter().zip(&row.value[0]) {
                    for (&j, b) in column.index.iter().zip(&column.value[0]) {
                        out.add(i, j, weight * a * b);
                    }
                }
            }
        }
    }

    /// Adds factor times the derivatives of Q_q by θ and of Q_θ by q and θ, weighted.
    pub(super) fn add_border(
        &self,
        s: &State,
        hub: &HubKinematics,
        w: &Weights<'_>,
        factor: f64,
        out: &mut Border,
    ) {
        let ([x, y], v) = self.moving(s, hub);
        let c = factor * self.coefficient;
        let (along, across) = (-c * w.q * (v[1] + hub.speed * x), -c * w.q * (hub.speed * y - v[0]));
        for (shapes, arm, by_place) in [(&self.shapes[0], -y, along), (&self.shapes[1], x, across)] {
            shapes.add(-c * w.v * arm, &mut out.column);
            shapes.add(-c * w.v * arm + by_place, &mut out.row);
        }
        out.corner -= c * w.v * (x * x + y * y);
    }
}
