//! A force at a station.

use super::group::Group;
use super::site::Share;
use super::{Amplitude, Axes, Load, Site};

/// A force f(t) F at one station of the axis.
#[derive(Clone, Debug)]
pub struct Force {
    /// Station \[m\].
    pub station: f64,
    /// Components F \[N\].
    pub force: [f64; 2],
    /// What they refer to.
    pub axes: Axes,
    /// Factor f(t).
    pub amplitude: Amplitude,
}

impl Load for Force {
    fn at_point(&self) -> Option<(Force, f64)> {
        Some((self.clone(), 0.0))
    }

    fn group(&self, site: &Site<'_>) -> Option<Group> {
        let share = Share { density: &|_| 0.0, points: &[(self.station, 1.0)], cells: site.fields.cells() };
        Some(site.group(&share, self.force, self.axes, self.amplitude.clone()))
    }
}
