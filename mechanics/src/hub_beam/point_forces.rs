//! Forces and couples at points of the beam and forces per length, as they are drawn.

use super::coupling::Coupling;
use super::hub::Drive;
use super::load::{Axes, DistributedForce, Force};
use super::system::HubBeam;
use crate::linalg::{Mat3, Vec3};
use crate::system::{Frame, LineForce, Observed, PointForce, State};

impl<C: Coupling> HubBeam<C> {
    /// The torque by which the hub is driven.
    pub(super) fn driving_torque(&mut self, s: &State) -> PointForce {
        let contact =
            if matches!(self.hub().drive, Drive::Prescribed(_)) { self.contact_torque } else { 0.0 };
        let moment = Vec3([0.0, 0.0, self.torque(s) - contact]);
        PointForce { name: "hub".to_owned(), moment, transmitted: true, ..PointForce::default() }
    }

    /// Sections at the stations of loads at points, and behind them at those at which forces per length are drawn.
    fn loaded_sections(&mut self, s: &State) -> Vec<Frame> {
        let points = self.loads.points().iter().map(|(force, _)| force.station);
        let stations: Vec<f64> = points
            .chain(self.loads.lines().iter().flat_map(|(_, stations)| stations.iter().copied()))
            .collect();
        let mut frames = vec![Frame::default(); stations.len()];
        // Their stations do not take the place of those that are drawn.
        std::mem::swap(&mut self.shown, &mut self.loaded);
        self.frames(0, s, &stations, &mut frames);
        std::mem::swap(&mut self.shown, &mut self.loaded);
        frames
    }

    /// The axes that the components of a load at a section refer to.
    fn axes_of(&mut self, s: &State) -> impl Fn(Axes, &Frame) -> Mat3 + use<C> {
        let hub = about_third(self.kinematics(s).angle);
        move |axes, frame| match axes {
            Axes::Dead => Mat3::IDENTITY,
            Axes::Hub => hub,
            Axes::Follower => frame.rotation,
        }
    }

    /// The loads at points, by their number among these.
    pub(super) fn loads_at_points(&mut self, s: &State) -> Vec<PointForce> {
        if self.loads.points().is_empty() {
            return Vec::new();
        }
        let (frames, axes_of, part) = (self.loaded_sections(s), self.axes_of(s), self.loads.part());
        let drawn = |(i, ((force, couple), frame)): (usize, (&(Force, f64), &Frame))| {
            let factor = part * force.amplitude.as_ref().map_or(1.0, |f| f.value(s.time()));
            let [x, y] = force.force;
            let moment = Vec3([0.0, 0.0, factor * couple]);
            let (name, place) = (format!("load{}", i + 1), frame.position);
            let force = axes_of(force.axes, frame) * (factor * Vec3([x, y, 0.0]));
            PointForce { name, place, force, moment, ..PointForce::default() }
        };
        self.loads.points().iter().zip(&frames).enumerate().map(drawn).collect()
    }

    /// The forces per length, by their number among these.
    pub(super) fn loads_along(&mut self, s: &State) -> Vec<LineForce> {
        if self.loads.lines().is_empty() {
            return Vec::new();
        }
        let (frames, axes_of, part) = (self.loaded_sections(s), self.axes_of(s), self.loads.part());
        let mut frames = frames.iter().skip(self.loads.points().len());
        let lines = self.loads.lines().iter().enumerate();
        let drawn = |(i, (load, stations)): (usize, &(DistributedForce, Vec<f64>))| {
            let at = |(station, frame): (&f64, &Frame)| {
                [frame.position, axes_of(load.axes, frame) * (part * load.at(*station, s.time()))]
            };
            LineForce {
                name: format!("load{}", i + 1),
                points: stations.iter().zip(&mut frames).map(at).collect(),
            }
        };
        lines.map(drawn).collect()
    }
}

/// The rotation by an angle about the third axis.
pub(super) fn about_third(angle: f64) -> Mat3 {
    let (sin, cos) = libm::sincos(angle);
    Mat3([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
}
