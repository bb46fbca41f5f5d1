//! Forces and couples at points of the beam, as they are drawn.

use super::coupling::Coupling;
use super::hub::Drive;
use super::load::{Axes, Force};
use super::system::HubBeam;
use crate::linalg::{Mat3, Vec3};
use crate::system::{Frame, Observed, PointForce, State};

impl<C: Coupling> HubBeam<C> {
    /// The torque by which the hub is driven.
    pub(super) fn driving_torque(&mut self, s: &State) -> PointForce {
        let contact =
            if matches!(self.hub().drive, Drive::Prescribed(_)) { self.contact_torque } else { 0.0 };
        let moment = Vec3([0.0, 0.0, self.torque(s) - contact]);
        PointForce { name: "hub".to_owned(), moment, transmitted: true, ..PointForce::default() }
    }

    /// The loads at points, by their number among these.
    pub(super) fn loads_at_points(&mut self, s: &State) -> Vec<PointForce> {
        if self.loads.points().is_empty() {
            return Vec::new();
        }
        let stations: Vec<f64> = self.loads.points().iter().map(|(force, _)| force.station).collect();
        let mut frames = vec![Frame::default(); stations.len()];
        // Their stations do not take the place of those that are drawn.
        std::mem::swap(&mut self.shown, &mut self.loaded);
        self.frames(0, s, &stations, &mut frames);
        std::mem::swap(&mut self.shown, &mut self.loaded);
        let (hub, part) = (about_third(self.kinematics(s).angle), self.loads.part());
        let drawn = |(i, ((force, couple), frame)): (usize, (&(Force, f64), &Frame))| {
            let axes = match force.axes {
                Axes::Dead => Mat3::IDENTITY,
                Axes::Hub => hub,
                Axes::Follower => frame.rotation,
            };
            let factor = part * force.amplitude.as_ref().map_or(1.0, |f| f.value(s.time()));
            let [x, y] = force.force;
            let force = axes * (factor * Vec3([x, y, 0.0]));
            let moment = Vec3([0.0, 0.0, factor * couple]);
            let name = format!("load{}", i + 1);
            PointForce { name, place: frame.position, force, moment, ..PointForce::default() }
        };
        self.loads.points().iter().zip(&frames).enumerate().map(drawn).collect()
    }
}

/// The rotation by an angle about the third axis.
pub(super) fn about_third(angle: f64) -> Mat3 {
    let (sin, cos) = libm::sincos(angle);
    Mat3([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
}
