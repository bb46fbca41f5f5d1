//! The hub–beam as a model whose points may touch obstacles: the variations and curvatures of its contact points. Symbols and
//! equations as in [`super::contact_point`].

use super::contact_point::{ContactPoint, Mount};
use super::coupling::Coupling;
use super::hub::Drive;
use super::point_forces::about_third;
use super::system::HubBeam;
use crate::contact::{PointMotion, Points, Variation};
use crate::linalg::{Mat3, Matrix, Vec3};
use crate::system::{Frame, State};

impl<C: Coupling> HubBeam<C> {
    /// The same system with stations \[m\] that may touch obstacles, which are boundaries of cells: they are the
    /// points of [`Points`], in this order.
    #[must_use]
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
            position: Vec3(place.vector(x, y)),
            velocity: Vec3(place.vector(along, across)),
            acceleration: Vec3(
                place.vector(x2 - dw * y - w * (place.y[1] + across), y2 + dw * x + w * (place.x[1] + along)),
            ),
            prescribed: Vec3(prescribed),
            ..PointMotion::default()
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
            out.push(Variation {
                unknown,
                position: Vec3(position),
                velocity: Vec3(velocity),
                ..Variation::default()
            });
        };
        if point.shortening.is_empty() {
            axial.index.iter().zip(&axial.value[0]).for_each(|(&i, phi)| push(i, *phi, 0.0, 0.0));
            transverse.index.iter().zip(&transverse.value[0]).for_each(|(&i, phi)| push(i, 0.0, *phi, 0.0));
        } else {
            by_x.fill(0.0);
            by_rate.fill(0.0);
            for part in point.shortening.iter() {
                part.multiply([&s.q, &s.v], |i, [hq, hv]| {
                    by_x[i] -= hq;
                    by_rate[i] -= hv;
                });
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
            let velocity = place.vector(-across, along);
            out.push(Variation {
                unknown,
                position: Vec3(position),
                velocity: Vec3(velocity),
                ..Variation::default()
            });
        }
    }

    fn add_curvature(&mut self, k: usize, s: &State, [force, _]: [Vec3; 2], w: f64, out: &mut Matrix) {
        let (hub, angle) = (self.kinematics(s), self.angle());
        let point = &self.contact_points[k];
        let place = point.place(s, &hub);
        let [fx, fy] = place.axes.map(|axis| w * (force[0] * axis[0] + force[1] * axis[1]));
        for part in point.shortening.iter() {
            part.each(|i, j, h| out.add(i, j, -fx * h));
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
        for part in point.shortening.iter() {
            part.multiply([&s.q], |i, [hq]| cross(i, -fy * hq));
        }
    }

    fn is_local(&self, k: usize) -> bool {
        self.contact_points[k].shortening.is_empty()
    }

    fn frame(&mut self, k: usize, s: &State) -> Frame {
        let rotation = match self.contact_points[k].mount {
            Mount::Ground => Mat3::IDENTITY,
            Mount::Hub => about_third(self.kinematics(s).angle),
        };
        Frame { position: Vec3::ZERO, rotation }
    }

    fn begin_forces(&mut self) {
        self.contact_torque = 0.0;
    }

    fn add_force(&mut self, k: usize, s: &State, force: Vec3) {
        let hub = self.kinematics(s);
        let point = &self.contact_points[k];
        if point.mount == Mount::Ground {
            let place = point.place(s, &hub);
            let [fx, fy] = place.axes.map(|axis| force[0] * axis[0] + force[1] * axis[1]);
            self.contact_torque += place.x[0] * fy - place.y[0] * fx;
        }
    }
}
