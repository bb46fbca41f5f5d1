//! Stations of the beam that may touch obstacles, in inertial axes or in the hub's frame.
//!
//! ```text
//! p = X e_X + Y e_Y,   ∂p/∂q = e_X ∂X/∂qᵀ + e_Y ∂Y/∂qᵀ,   ∂p/∂θ = X e_Y − Y e_X
//! X = a + x + g_xᵀq − ½ qᵀHq,   Y = g_yᵀq,   H = ∫₀ˣ φ′φ′ᵀ dξ with foreshortening, 0 without and on a curve
//! ```
//!
//! e_X and e_Y rotate with the hub; for an obstacle fixed to the hub they are constant, and θ does not appear.

use super::coupling::Coupling;
use super::fields::{Fields, Shapes};
use super::hub::Drive;
use super::load::Kinematics;
use super::system::HubBeam;
use crate::contact::{PointMotion, Points, Variation};
use crate::linalg::Matrix;
use crate::profile::HubKinematics;
use crate::system::State;
use std::sync::Arc;

/// What an obstacle is fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mount {
    /// The ground.
    Ground,
    /// The hub.
    Hub,
}

/// A station that may touch an obstacle.
#[derive(Clone, Debug)]
pub struct ContactPoint {
    mount: Mount,
    /// a + x
    origin: f64,
    /// Functions of both fields at the station.
    shapes: Arc<[Shapes; 2]>,
    /// w₂′ at the quadrature points between root and station, with foreshortening.
    slopes: Arc<[(f64, Shapes)]>,
    /// ∂X/∂q and ∂Ẋ/∂q with foreshortening.
    by: [Vec<f64>; 2],
}

/// X, Y and their rates, and the axes e_X, e_Y.
struct Place {
    x: [f64; 3],
    y: [f64; 3],
    axes: [[f64; 2]; 2],
    speed: f64,
    acceleration: f64,
}

impl ContactPoint {
    /// The station `x` \[m\], a boundary of cells; `radius` is that of the hub \[m\].
    pub(super) fn new(
        fields: &Fields,
        kinematics: Kinematics,
        radius: f64,
        (x, mount): (f64, Mount),
    ) -> ContactPoint {
        let point = fields.point(x, 1.0);
        let mut slopes = Vec::new();
        if kinematics == Kinematics::Foreshortened {
            fields.integrate(|point| {
                if point.x < x {
                    slopes.push((point.weight, point.transverse.clone()));
                }
            });
        }
        let n = if slopes.is_empty() { 0 } else { fields.len() };
        let by = [vec![0.0; n], vec![0.0; n]];
        let shapes = Arc::new([point.axial, point.transverse]);
        ContactPoint { mount, origin: radius + x, shapes, slopes: slopes.into(), by }
    }

    fn place(&self, s: &State, hub: &HubKinematics) -> Place {
        let field = |k: usize, q: &[f64]| self.shapes[k].field(0, q);
        let mut x = [self.origin + field(0, &s.q), field(0, &s.v), field(0, &s.a)];
        for (weight, shapes) in self.slopes.iter() {
            let [q, v, a] = [&s.q, &s.v, &s.a].map(|q| shapes.field(1, q));
            x[0] -= 0.5 * weight * q * q;
            x[1] -= weight * q * v;
            x[2] -= weight * (q * a + v * v);
        }
        let y = [&s.q, &s.v, &s.a].map(|q| field(1, q));
        let (axes, speed, acceleration) = match self.mount {
            Mount::Hub => ([[1.0, 0.0], [0.0, 1.0]], 0.0, 0.0),
            Mount::Ground => {
                let (sin, cos) = libm::sincos(hub.angle);
                ([[cos, sin], [-sin, cos]], hub.speed, hub.acceleration)
            }
        };
        Place { x, y, axes, speed, acceleration }
    }
}

impl Place {
    /// x e_X + y e_Y
    fn vector(&self, x: f64, y: f64) -> [f64; 3] {
        let [along, across] = self.axes;
        [x * along[0] + y * across[0], x * along[1] + y * across[1], 0.0]
    }

    /// (Ẋ − ωY, Ẏ + ωX)
    fn velocity(&self) -> [f64; 2] {
        [self.x[1] - self.speed * self.y[0], self.y[1] + self.speed * self.x[0]]
    }
}

impl<C: Coupling> HubBeam<C> {
    /// The same system with stations \[m\] that may touch obstacles, which are boundaries of cells: they are the
    /// points of [`Points`], in this order.
    pub fn with_contact_points(mut self, stations: &[(f64, Mount)]) -> HubBeam<C> {
        let (fields, kinematics) = (self.coupling().fields(), self.coupling().kinematics());
        let radius = self.hub().radius;
        let points = stations.iter().map(|&at| ContactPoint::new(fields, kinematics, radius, at)).collect();
        self.contact_points = points;
        self
    }

    /// Number of the hub's angle among the velocities, where it is an unknown that moves.
    fn angle(&self) -> Option<usize> {
        let free = matches!(self.hub().drive, Drive::Free(_)) && !self.held;
        free.then(|| self.coupling().fields().len())
    }
}

impl<C: Coupling> Points for HubBeam<C> {
    fn motion(&mut self, k: usize, s: &State) -> PointMotion {
        let hub = self.kinematics(s);
        let place = self.contact_points[k].place(s, &hub);
        let ([x, _, x2], [y, _, y2]) = (place.x, place.y);
        let [along, across] = place.velocity();
        let (w, dw) = (place.speed, place.acceleration);
        let prescribed = match self.angle() {
            None => place.vector(-w * y, w * x),
            Some(_) => [0.0; 3],
        };
        PointMotion {
            position: place.vector(x, y),
            velocity: place.vector(along, across),
            acceleration: place
                .vector(x2 - dw * y - w * (place.y[1] + across), y2 + dw * x + w * (place.x[1] + along)),
            prescribed,
        }
    }

    fn variations(&mut self, k: usize, s: &State, out: &mut Vec<Variation>) {
        out.clear();
        let (hub, angle) = (self.kinematics(s), self.angle());
        let point = &mut self.contact_points[k];
        let place = point.place(s, &hub);
        let w = place.speed;
        let [by_x, by_rate] = &mut point.by;
        let (axial, transverse) = (&point.shapes[0], &point.shapes[1]);
        let mut push = |unknown: usize, x: f64, y: f64, rate: f64| {
            let (position, velocity) = (place.vector(x, y), place.vector(rate - w * y, w * x));
            out.push(Variation { unknown, position, velocity });
        };
        if point.slopes.is_empty() {
            axial.index.iter().zip(&axial.value[0]).for_each(|(&i, phi)| push(i, *phi, 0.0, 0.0));
            transverse.index.iter().zip(&transverse.value[0]).for_each(|(&i, phi)| push(i, 0.0, *phi, 0.0));
        } else {
            by_x.fill(0.0);
            by_rate.fill(0.0);
            for (weight, shapes) in point.slopes.iter() {
                let (q, v) = (shapes.field(1, &s.q), shapes.field(1, &s.v));
                for (&i, slope) in shapes.index.iter().zip(&shapes.value[1]) {
                    by_x[i] -= weight * q * slope;
                    by_rate[i] -= weight * v * slope;
                }
            }
            for (&i, phi) in axial.index.iter().zip(&axial.value[0]) {
                by_x[i] += phi;
            }
            // Transverse functions at the station are few, and their unknowns ascend.
            let mut at = transverse.index.iter().zip(&transverse.value[0]).peekable();
            for (i, (&x, &rate)) in by_x.iter().zip(by_rate.iter()).enumerate() {
                let y = at.next_if(|(number, _)| **number == i).map_or(0.0, |(_, phi)| *phi);
                if x != 0.0 || y != 0.0 || rate != 0.0 {
                    push(i, x, y, rate);
                }
            }
        }
        if let (Some(unknown), Mount::Ground) = (angle, point.mount) {
            let [along, across] = place.velocity();
            let position = place.vector(-place.y[0], place.x[0]);
            out.push(Variation { unknown, position, velocity: place.vector(-across, along) });
        }
    }

    fn add_curvature(&mut self, k: usize, s: &State, force: [f64; 3], w: f64, out: &mut Matrix) {
        let (hub, angle) = (self.kinematics(s), self.angle());
        let point = &self.contact_points[k];
        let place = point.place(s, &hub);
        let [fx, fy] = place.axes.map(|axis| w * (force[0] * axis[0] + force[1] * axis[1]));
        for (weight, shapes) in point.slopes.iter() {
            for (&i, a) in shapes.index.iter().zip(&shapes.value[1]) {
                for (&j, b) in shapes.index.iter().zip(&shapes.value[1]) {
                    out.add(i, j, -fx * weight * a * b);
                }
            }
        }
        let (Some(n), Mount::Ground) = (angle, point.mount) else { return };
        out.add(n, n, -fx * place.x[0] - fy * place.y[0]);
        let mut cross = |i: usize, x: f64| {
            out.add(i, n, x);
            out.add(n, i, x);
        };
        let [axial, transverse] = &*point.shapes;
        axial.index.iter().zip(&axial.value[0]).for_each(|(&i, phi)| cross(i, fy * phi));
        transverse.index.iter().zip(&transverse.value[0]).for_each(|(&i, phi)| cross(i, -fx * phi));
        for (weight, shapes) in point.slopes.iter() {
            let slope = shapes.field(1, &s.q);
            for (&i, a) in shapes.index.iter().zip(&shapes.value[1]) {
                cross(i, -fy * weight * slope * a);
            }
        }
    }

    fn is_local(&self, k: usize) -> bool {
        self.contact_points[k].slopes.is_empty()
    }

    fn begin_forces(&mut self) {
        self.contact_torque = 0.0;
    }

    fn add_force(&mut self, k: usize, s: &State, force: [f64; 3]) {
        let hub = self.kinematics(s);
        let point = &self.contact_points[k];
        if point.mount == Mount::Ground {
            let place = point.place(s, &hub);
            let [fx, fy] = place.axes.map(|axis| force[0] * axis[0] + force[1] * axis[1]);
            self.contact_torque += place.x[0] * fy - place.y[0] * fx;
        }
    }
}
