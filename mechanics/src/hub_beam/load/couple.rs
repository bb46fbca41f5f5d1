//! A couple on a section.

use super::group::Group;
use super::{Amplitude, Axes, Force, Kinematics, Load, Site};
use crate::hub_beam::fields::add_vector;

/// A couple f(t) M about the normal of the plane of motion, on the section at one station. In the plane it does the
/// work f M δ(θ + φ), φ the rotation of the section, whether it is thought of as dead or as following.
#[derive(Clone, Debug)]
pub struct Couple {
    /// Station \[m\].
    pub station: f64,
    /// Moment M [N·m], counterclockwise.
    pub couple: f64,
    /// Factor f(t).
    pub amplitude: Amplitude,
}

impl Load for Couple {
    fn at_point(&self) -> Option<(Force, f64)> {
        let (station, amplitude) = (self.station, self.amplitude.clone());
        Some((Force { station, force: [0.0; 2], axes: Axes::Dead, amplitude }, self.couple))
    }

    fn group(&self, site: &Site<'_>) -> Option<Group> {
        let point = site.fields.point(self.station, 1.0);
        let mut group = Group::new(site.fields.len(), [0.0; 2], Axes::Hub, self.amplitude.clone());
        if site.kinematics == Kinematics::Curve {
            group.push_couple(&point, self.couple, site.radius);
        } else {
            add_vector(&mut group.m, &point.transverse, 1, self.couple);
            group.moment = self.couple;
        }
        Some(group)
    }
}
