//! A force per length.

use super::group::Group;
use super::site::Share;
use super::{Amplitude, Axes, Load, Site};
use crate::profile::Profile;
use std::sync::Arc;

/// A force per length f(t) p(x) F along the axis.
#[derive(Clone, Debug)]
pub struct DistributedForce {
    /// Components F \[N/m\].
    pub force: [f64; 2],
    /// What they refer to.
    pub axes: Axes,
    /// Share p as a function of the station x \[m\]; 1 everywhere where there is none.
    pub distribution: Option<Arc<dyn Profile>>,
    /// First and last station of the load \[m\].
    pub range: (f64, f64),
    /// Factor f(t).
    pub amplitude: Amplitude,
}

impl DistributedForce {
    /// Stations at which cells must end: ends of the load and breaks of its distribution \[m\].
    pub fn stations(&self) -> Vec<f64> {
        let mut stations = vec![self.range.0, self.range.1];
        stations.extend(self.distribution.iter().flat_map(|p| p.breaks()));
        stations
    }
}

impl Load for DistributedForce {
    fn group(&self, site: &Site<'_>) -> Group {
        let density = |x: f64| {
            if x < self.range.0 || x > self.range.1 {
                return 0.0;
            }
            self.distribution.as_ref().map_or(1.0, |p| p.value(x))
        };
        site.group(&Share { density: &density, points: &[] }, self.force, self.axes, self.amplitude.clone())
    }
}
